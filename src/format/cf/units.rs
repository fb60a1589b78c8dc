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
    /// Geopotential in m2 s-2: metres when divided by [`GRAVITY`].
    Geopotential,
    /// A number of a level, a fraction, or no unit at all.
    Plain,
}

/// Standard acceleration of free fall, m s-2: what makes geopotential a height.
pub(crate) const GRAVITY: f64 = 9.80665;

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

/// Height in metres of a pressure in pascals, by the US Standard Atmosphere 1976 (NOAA-S/T 76-1562), table 4:
/// layers of constant lapse rate, each beginning at a geopotential height, a temperature and a pressure.
///
/// ```text
/// h = h0 + T0/L ((p/p0)^(-R L / g) - 1),   and where L is 0   h = h0 - R T0 / g ln(p/p0)
/// ```
///
/// The last layer goes on above 84.852 km. `None` for a pressure that is not above 0.
pub(crate) fn standard_height(pressure: f64) -> Option<f64> {
    /// Height in m, temperature in K, lapse in K/m, pressure in Pa at the bottom of a layer.
    const LAYERS: [[f64; 4]; 7] = [
        [0.0, 288.15, -0.0065, 101_325.0],
        [11_000.0, 216.65, 0.0, 22_632.06],
        [20_000.0, 216.65, 0.001, 5_474.889],
        [32_000.0, 228.65, 0.0028, 868.018_7],
        [47_000.0, 270.65, 0.0, 110.906_3],
        [51_000.0, 270.65, -0.0028, 66.938_87],
        [71_000.0, 214.65, -0.002, 3.956_42],
    ];
    /// Gas constant of air, J kg-1 K-1.
    const AIR: f64 = 287.052_87;
    if !(pressure > 0.0 && pressure.is_finite()) {
        return None;
    }
    let layer = LAYERS.iter().rev().find(|layer| pressure <= layer[3]);
    let [height, temperature, lapse, bottom] = *layer.unwrap_or(&LAYERS[0]);
    let ratio = pressure / bottom;
    Some(if lapse == 0.0 {
        height - AIR * temperature / GRAVITY * ratio.ln()
    } else {
        height + temperature / lapse * (ratio.powf(-AIR * lapse / GRAVITY) - 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_are_those_of_the_standard_atmosphere() {
        // The table's own pressures at its geopotential heights, NOAA-S/T 76-1562, table 1 (in hPa).
        for (height, hectopascals) in [
            (0.0, 1013.25),
            (1_000.0, 898.7457),
            (5_000.0, 540.1988),
            (11_000.0, 226.3206),
            (15_000.0, 120.4457),
            (20_000.0, 54.74889),
            (30_000.0, 11.71867),
            (40_000.0, 2.775_216),
        ] {
            let found = standard_height(hectopascals * 100.0).unwrap();
            // The last printed digit of the pressure leaves open some centimetres.
            assert!(
                (found - height).abs() < 0.5,
                "{hectopascals} hPa: {found} m"
            );
        }
        for none in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(standard_height(none), None);
        }
    }

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
