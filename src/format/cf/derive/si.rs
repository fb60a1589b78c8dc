//! From the units of files to those of the formulas.
//!
//! ```text
//! value in SI = scale value + offset
//! ```

use super::super::units::{Measure, measure};

/// Scale and offset of a unit; `None` of one that measures something else.
pub(super) type ToSi = fn(&str) -> Option<[f64; 2]>;

/// A unit without blanks, stars and carets: `m s**-1` is `ms-1`.
fn compact(unit: &str) -> String {
    let kept = unit.chars().filter(|c| !matches!(c, ' ' | '*' | '^'));
    kept.collect()
}

/// Temperatures, to K.
pub(super) fn kelvins(unit: &str) -> Option<[f64; 2]> {
    match compact(unit).as_str() {
        "K" | "kelvin" | "Kelvin" => Some([1.0, 0.0]),
        "degC" | "celsius" | "Celsius" | "degrees_C" | "C" => Some([1.0, 273.15]),
        _ => None,
    }
}

/// Pressures, to Pa.
pub(super) fn pascals(unit: &str) -> Option<[f64; 2]> {
    match measure(unit) {
        Measure::Pressure(pascals) => Some([pascals, 0.0]),
        _ => None,
    }
}

/// Shares of mass, to kg/kg.
pub(super) fn shares(unit: &str) -> Option<[f64; 2]> {
    match compact(unit).as_str() {
        "kgkg-1" | "kg/kg" | "1" => Some([1.0, 0.0]),
        "gkg-1" | "g/kg" => Some([1e-3, 0.0]),
        _ => None,
    }
}

/// Shares, to %.
pub(super) fn percent(unit: &str) -> Option<[f64; 2]> {
    match compact(unit).as_str() {
        "%" | "percent" => Some([1.0, 0.0]),
        "1" => Some([100.0, 0.0]),
        _ => None,
    }
}

/// Speeds, to m/s.
pub(super) fn metres_a_second(unit: &str) -> Option<[f64; 2]> {
    let scale = match compact(unit).as_str() {
        "ms-1" | "m/s" | "msec-1" => 1.0,
        "cms-1" | "cm/s" => 0.01,
        "kmh-1" | "km/h" | "kmhr-1" => 1.0 / 3.6,
        "knot" | "knots" | "kt" | "kts" => 1852.0 / 3600.0,
        _ => return None,
    };
    Some([scale, 0.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_as_files_write_them() {
        let rows: [(ToSi, &str, f64, f64); 9] = [
            (kelvins, "K", 280.0, 280.0),
            (kelvins, "degC", 10.0, 283.15),
            (pascals, "hPa", 850.0, 85_000.0),
            (shares, "g kg-1", 8.0, 0.008),
            (shares, "kg kg**-1", 0.008, 0.008),
            (percent, "1", 0.5, 50.0),
            (metres_a_second, "m s**-1", 3.0, 3.0),
            (metres_a_second, "knots", 36.0, 18.52),
            (metres_a_second, "km/h", 36.0, 10.0),
        ];
        for (to_si, unit, value, wanted) in rows {
            let [scale, offset] = to_si(unit).expect(unit);
            let found = scale * value + offset;
            assert!((found - wanted).abs() < 1e-9 * wanted, "{unit}: {found}");
        }
        assert_eq!(kelvins("Pa"), None);
        assert_eq!(metres_a_second("Pa s-1"), None);
        assert_eq!(shares(""), None);
    }
}
