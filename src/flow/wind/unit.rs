//! Units of a velocity.
//!
//! ```text
//! 1 km/h = 1 / 3.6 m/s      1 knot = 1852 / 3600 m/s      1 cm/s = 0.01 m/s      1 hPa/s = 100 Pa/s
//! ```

use crate::flow::metric::Vertical;

/// What makes m/s, or Pa/s, of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindUnit {
    /// Times the number.
    pub factor: f64,
    /// Of what it is then.
    pub kind: Vertical,
}

/// A unit of something else.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name} has unit {found}, wanted m s-1, km h-1, knots, cm s-1{}", if *.is_up { " or Pa s-1" } else { "" })]
pub struct UnitError {
    /// The variable.
    pub name: String,
    /// Its unit.
    pub found: String,
    /// Whether it is the upward component.
    pub is_up: bool,
}

impl WindUnit {
    /// Of the unit of a variable, as a file words it; a file that is silent means m/s.
    ///
    /// # Errors
    /// [`UnitError`] where it is no velocity, and where one of pressures is not the upward one.
    pub fn of(name: &str, unit: Option<&str>, is_up: bool) -> Result<Self, UnitError> {
        let metres = |factor| Self {
            factor,
            kind: Vertical::Metres,
        };
        let pascals = |factor| Self {
            factor,
            kind: Vertical::Pascals,
        };
        let plain = unit.unwrap_or("m s-1").replace("**", "").replace('^', "");
        match (plain.trim().to_lowercase().as_str(), is_up) {
            ("m s-1" | "m/s" | "m.s-1" | "m sec-1" | "meter second-1" | "metre second-1", _)
            | ("meters/second" | "meter/second" | "metres/second" | "m/sec", _) => Ok(metres(1.0)),
            ("km h-1" | "km/h" | "km hr-1" | "km/hr" | "kph", _) => Ok(metres(1.0 / 3.6)),
            ("knot" | "knots" | "kt" | "kts" | "kn", _) => Ok(metres(1852.0 / 3600.0)),
            ("cm s-1" | "cm/s" | "cm/sec" | "cm sec-1", _) => Ok(metres(0.01)),
            ("pa s-1" | "pa/s", true) => Ok(pascals(1.0)),
            ("hpa s-1" | "hpa/s", true) => Ok(pascals(100.0)),
            _ => Err(UnitError {
                name: name.to_owned(),
                found: unit.unwrap_or_default().escape_debug().to_string(),
                is_up,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocities_are_converted_and_all_else_is_refused_by_name() {
        let factor = |unit: &str| WindUnit::of("w", Some(unit), true).map(|unit| unit.factor);
        assert_eq!(factor("m s**-1"), Ok(1.0));
        assert_eq!(factor("km/h"), Ok(1.0 / 3.6));
        assert!((factor("knots").expect("knots") - 0.514_444).abs() < 1e-6);
        assert_eq!(factor("cm s-1"), Ok(0.01));
        let omega = WindUnit::of("w", Some("Pa s**-1"), true);
        assert_eq!(
            omega.map(|unit| (unit.factor, unit.kind)),
            Ok((1.0, Vertical::Pascals))
        );
        assert_eq!(
            WindUnit::of("u", None, false).map(|unit| unit.factor),
            Ok(1.0)
        );
        let said = |name, unit, is_up| {
            let error = WindUnit::of(name, Some(unit), is_up).expect_err(unit);
            error.to_string()
        };
        assert_eq!(
            said("w", "K", true),
            "w has unit K, wanted m s-1, km h-1, knots, cm s-1 or Pa s-1"
        );
        assert!(said("u", "Pa s-1", false).ends_with("wanted m s-1, km h-1, knots, cm s-1"));
    }
}
