//! Degrees and pressures as lengths on the Earth.
//!
//! ```text
//! x = R cos(middle latitude) longitude,   y = R latitude        (equirectangular, in radians)
//! ```

/// The mean radius of the Earth, km (IUGG).
pub(crate) const RADIUS_KM: f64 = 6371.0088;

/// Beyond it, towards a pole, the formula has no width left.
pub(crate) const WIDEST_LATITUDE: f64 = 80.0;

/// Kilometres of a degree of longitude at a middle latitude, which is brought into [`WIDEST_LATITUDE`], and of a degree of
/// latitude.
pub(crate) fn kilometres_of_degree(middle_latitude: f64) -> [f64; 2] {
    let middle = middle_latitude.clamp(-WIDEST_LATITUDE, WIDEST_LATITUDE);
    let along_y = RADIUS_KM.to_radians();
    [along_y * middle.to_radians().cos(), along_y]
}

/// Standard acceleration of free fall, m s-2: what makes geopotential a height.
pub(crate) const GRAVITY: f64 = 9.80665;

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
}
