//! What a column measures, by its name: `depth_km` is a depth in kilometres.

/// What the numbers of a column along an axis are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// Degrees east.
    Longitude,
    /// Degrees north.
    Latitude,
    /// A length upwards.
    Height,
    /// A length downwards.
    Depth,
    /// Of the air: less of it is higher.
    Pressure,
    /// A length along any axis.
    Length,
}

/// A unit that ends a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    Kilometres,
    Metres,
    Hectopascals,
}

impl Unit {
    /// As a person writes it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Kilometres => "km",
            Self::Metres => "m",
            Self::Hectopascals => "hPa",
        }
    }

    /// Metres of one, if it is a length.
    pub fn metres(self) -> Option<f64> {
        match self {
            Self::Kilometres => Some(1000.0),
            Self::Metres => Some(1.0),
            Self::Hectopascals => None,
        }
    }
}

/// A name taken apart: `depth_km` is `depth` and kilometres.
pub(super) fn without_unit(name: &str) -> (&str, Option<Unit>) {
    let units = [Unit::Kilometres, Unit::Metres, Unit::Hectopascals];
    name.rsplit_once('_')
        .filter(|(stem, _)| !stem.is_empty())
        .and_then(|(stem, end)| {
            let unit = units
                .into_iter()
                .find(|unit| unit.word().eq_ignore_ascii_case(end))?;
            Some((stem, Some(unit)))
        })
        .unwrap_or((name, None))
}

/// What a column called so measures.
pub(super) fn quantity(name: &str) -> Quantity {
    let (stem, _) = without_unit(name);
    match stem.to_ascii_lowercase().as_str() {
        "lon" | "longitude" => Quantity::Longitude,
        "lat" | "latitude" => Quantity::Latitude,
        "height" | "altitude" | "alt" => Quantity::Height,
        "depth" => Quantity::Depth,
        "pressure" => Quantity::Pressure,
        _ => Quantity::Length,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_a_quantity_and_its_unit() {
        assert_eq!(without_unit("depth_km"), ("depth", Some(Unit::Kilometres)));
        assert_eq!(without_unit("P_HPA"), ("P", Some(Unit::Hectopascals)));
        assert_eq!(without_unit("_km"), ("_km", None));
        assert_eq!(without_unit("a_b"), ("a_b", None));
        assert_eq!(without_unit("é_m"), ("é", Some(Unit::Metres)));
        assert_eq!(quantity("Depth_M"), Quantity::Depth);
        assert_eq!(quantity("longitude"), Quantity::Longitude);
        assert_eq!(quantity("depths"), Quantity::Length);
    }
}
