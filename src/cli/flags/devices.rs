//! `--device`, once or several times; in a scene file a word, or a list of them.

use super::{Error, SceneFlags};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[derive(Deserialize)]
#[serde(untagged)]
enum Words {
    One(String),
    Several(Vec<String>),
}

pub(super) fn serialize<S: Serializer>(words: &[String], to: S) -> Result<S::Ok, S::Error> {
    match words {
        [one] => one.serialize(to),
        several => several.serialize(to),
    }
}

pub(super) fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<Vec<String>, D::Error> {
    Ok(match Words::deserialize(from)? {
        Words::One(one) => vec![one],
        Words::Several(several) => several,
    })
}

impl SceneFlags {
    /// The one device that the words name, if they do.
    pub fn one_device(&self) -> Result<Option<&str>, Error> {
        match self.device.as_slice() {
            [] => Ok(None),
            [one] => Ok(Some(one)),
            several => Err(Error::usage(
                format!(
                    "--device: {} are named, and one picture is drawn by one",
                    several.len()
                ),
                "animate and thumbnails share frames and volumes out among several",
            )),
        }
    }

    /// Every device that the words name, the default one where they name none.
    pub fn devices(&self) -> Vec<Option<&str>> {
        match self.device.as_slice() {
            [] => vec![None],
            words => words.iter().map(|word| Some(word.as_str())).collect(),
        }
    }
}
