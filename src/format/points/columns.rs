//! Which columns of a table hold what, as a person says it.

use std::str::FromStr;

/// Names of columns; those that are `None` are found by their names.
///
/// In words: `x=lon,y=lat,z=depth,value=mag`, each key at most once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PointColumns {
    /// Along x: a length, or a longitude.
    pub x: Option<String>,
    /// Along y: a length, or a latitude.
    pub y: Option<String>,
    /// Along z: a length, a height, a depth or a pressure.
    pub z: Option<String>,
    /// What is drawn.
    pub value: Option<String>,
    /// Standard deviations in world length.
    pub std: Option<String>,
    /// Weights.
    pub weight: Option<String>,
}

/// Why words name no columns.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoColumns {
    /// A part is no `key=name`.
    #[error("`{0}` names no column: wanted key=name, such as value=magnitude")]
    NoName(String),
    /// A key that there is not.
    #[error("`{0}` is no key of a column: wanted x, y, z, value, std or weight")]
    UnknownKey(String),
    /// A key that is there already.
    #[error("the column `{0}` is named twice")]
    Twice(&'static str),
}

impl FromStr for PointColumns {
    type Err = NoColumns;

    fn from_str(words: &str) -> Result<Self, NoColumns> {
        let mut columns = Self::default();
        for part in words.split(',') {
            let named = part
                .split_once('=')
                .map(|(key, name)| (key.trim(), name.trim()));
            let (key, name) = named
                .filter(|(key, name)| !key.is_empty() && !name.is_empty())
                .ok_or_else(|| NoColumns::NoName(part.trim().to_owned()))?;
            let (key, column) = match key {
                "x" => ("x", &mut columns.x),
                "y" => ("y", &mut columns.y),
                "z" => ("z", &mut columns.z),
                "value" => ("value", &mut columns.value),
                "std" => ("std", &mut columns.std),
                "weight" => ("weight", &mut columns.weight),
                _ => return Err(NoColumns::UnknownKey(key.to_owned())),
            };
            if column.replace(name.to_owned()).is_some() {
                return Err(NoColumns::Twice(key));
            }
        }
        Ok(columns)
    }
}

impl PointColumns {
    /// The key of a column that is named, if there is one.
    pub(super) fn first_named(&self) -> Option<&'static str> {
        let all = [
            ("x", &self.x),
            ("y", &self.y),
            ("z", &self.z),
            ("value", &self.value),
            ("std", &self.std),
            ("weight", &self.weight),
        ];
        all.into_iter()
            .find_map(|(key, name)| name.as_ref().map(|_| key))
    }
}
