//! Units of coordinates: what they measure, and how much of it one unit is.

/// What a coordinate's unit measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Measure {
    /// Degrees on the sphere.
    Degrees,
    /// Metres for one unit.
    Length(f64),
    /// Pascals for one unit.
    Pressure(f64),
    /// Geopotential in m2 s-2: metres when divided by the acceleration of free fall.
    Geopotential,
    /// A number of a level, a fraction, or no unit at all.
    Plain,
}

/// What `units` measures, in the spellings that UDUNITS takes and models write.
pub(crate) fn measure(units: &str) -> Measure {
    let compact: String = units
        .chars()
        .filter(|c| !c.is_whitespace() && !matches!(c, '*' | '^' | '.'))
        .collect();
    match compact.as_str() {
        "m" | "meter" | "meters" | "metre" | "metres" | "gpm" => Measure::Length(1.0),
        "km" | "kilometer" | "kilometers" | "kilometre" | "kilometres" => Measure::Length(1e3),
        "dam" | "gpdam" => Measure::Length(10.0),
        "dm" => Measure::Length(0.1),
        "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => Measure::Length(1e-2),
        "mm" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => Measure::Length(1e-3),
        "um" | "micron" | "microns" | "micrometer" | "micrometers" | "µm" => Measure::Length(1e-6),
        "nm" | "nanometer" | "nanometers" | "nanometre" | "nanometres" => Measure::Length(1e-9),
        "ft" | "foot" | "feet" => Measure::Length(0.3048),
        "Pa" | "pascal" | "pascals" | "Pascal" => Measure::Pressure(1.0),
        "hPa" | "mb" | "mbar" | "millibar" | "millibars" | "hectopascal" | "hectopascals" => {
            Measure::Pressure(100.0)
        }
        "kPa" => Measure::Pressure(1e3),
        "bar" => Measure::Pressure(1e5),
        "m2s-2" | "m2/s2" => Measure::Geopotential,
        _ if is_degrees(&compact) => Measure::Degrees,
        _ => Measure::Plain,
    }
}

/// `degrees_north`, `degree_E`, `degreeN` and so on; degrees of temperature are none.
fn is_degrees(units: &str) -> bool {
    is_east(units)
        || is_north(units)
        || matches!(units, "degree" | "degrees" | "deg" | "arc_degree")
}

/// A unit that CF gives to longitudes alone.
pub(crate) fn is_east(units: &str) -> bool {
    matches!(
        units,
        "degrees_east" | "degree_east" | "degree_E" | "degrees_E" | "degreeE" | "degreesE"
    )
}

/// A unit that CF gives to latitudes alone.
pub(crate) fn is_north(units: &str) -> bool {
    matches!(
        units,
        "degrees_north" | "degree_north" | "degree_N" | "degrees_N" | "degreeN" | "degreesN"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known_in_their_spellings() {
        assert_eq!(measure("degrees_north"), Measure::Degrees);
        assert_eq!(measure("hPa"), Measure::Pressure(100.0));
        assert_eq!(measure("millibars"), Measure::Pressure(100.0));
        assert_eq!(measure("m**2 s**-2"), Measure::Geopotential);
        assert_eq!(measure("m2 s-2"), Measure::Geopotential);
        assert_eq!(measure("km"), Measure::Length(1000.0));
        for plain in ["1", "level", "degC", "sigma_level", ""] {
            assert_eq!(measure(plain), Measure::Plain, "{plain}");
        }
    }
}
