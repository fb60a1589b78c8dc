//! How fast a place that keeps its pressure moves in a world whose heights are those of the standard atmosphere.
//!
//! ```text
//! dz/dp = -R T / (g p)        layer from h0: T = T0 + L (h - h0),
//!                             p = p0 (T / T0)^(-g / (R L)),  and where L is 0  p = p0 exp(-g (h - h0) / (R T0))
//! ```
//!
//! US Standard Atmosphere 1976 (NOAA-S/T 76-1562), table 4. The last layer goes on above 84.852 km, the first under 0.

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

/// Standard acceleration of free fall, m s-2.
const GRAVITY: f64 = 9.80665;

/// Temperature in K and pressure in Pa at a height in m.
fn state(height: f64) -> [f64; 2] {
    let layer = LAYERS.iter().rev().find(|layer| height >= layer[0]);
    let [bottom, warmth, lapse, pressure] = *layer.unwrap_or(&LAYERS[0]);
    // Over the last layer temperatures would reach 0.
    let temperature = (warmth + lapse * (height - bottom)).max(1.0);
    let pressure = match lapse == 0.0 {
        true => pressure * (-GRAVITY * (height - bottom) / (AIR * warmth)).exp(),
        false => pressure * (temperature / warmth).powf(-GRAVITY / (AIR * lapse)),
    };
    [temperature, pressure]
}

/// Metres that a rise of the pressure by one pascal lifts a place at a height in m: negative.
pub(super) fn metres_per_pascal(height: f64) -> f64 {
    let [temperature, pressure] = state(height);
    -AIR * temperature / (GRAVITY * pressure)
}

/// Height in m of a pressure in Pa in the standard atmosphere; `None` where it is not over 0.
///
/// ```text
/// h = h0 + T0/L ((p/p0)^(-R L / g) - 1),   and where L is 0   h = h0 - R T0 / g ln(p/p0)
/// ```
pub fn height_of_pressure(pressure: f64) -> Option<f64> {
    if !(pressure > 0.0 && pressure.is_finite()) {
        return None;
    }
    let layer = LAYERS.iter().rev().find(|layer| pressure <= layer[3]);
    let [bottom, warmth, lapse, at_bottom] = *layer.unwrap_or(&LAYERS[0]);
    let ratio = pressure / at_bottom;
    Some(match lapse == 0.0 {
        true => bottom - AIR * warmth / GRAVITY * ratio.ln(),
        false => bottom + warmth / lapse * (ratio.powf(-AIR * lapse / GRAVITY) - 1.0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Heights of pressures by the same layers, the other way round.
    #[cfg(feature = "files")]
    #[test]
    fn speeds_are_the_derivative_of_the_heights_that_volumes_are_placed_by() {
        use crate::format::earth::standard_height;
        for pressure in [
            95_000.0, 50_000.0, 30_000.0, 20_000.0, 10_000.0, 3_000.0, 500.0, 20.0,
        ] {
            let step = 1e-4 * pressure;
            let height = |p: f64| standard_height(p).expect("a pressure");
            let slope = (height(pressure + step) - height(pressure - step)) / (2.0 * step);
            let found = metres_per_pascal(height(pressure));
            // The difference quotient leaves step²/6 of the third derivative, 2/p² of the first: 4e-9; pressures at the
            // borders of layers are rounded to 7 digits.
            assert!(
                (found / slope - 1.0).abs() < 1e-6,
                "{pressure} Pa: {found} {slope}"
            );
        }
    }

    #[test]
    fn the_height_of_a_pressure_has_that_pressure() {
        for pressure in [
            101_325.0, 95_000.0, 50_000.0, 15_000.0, 3_000.0, 500.0, 20.0,
        ] {
            let height = height_of_pressure(pressure).expect("a height");
            assert!(
                (state(height)[1] / pressure - 1.0).abs() < 1e-5,
                "{pressure}"
            );
        }
        assert_eq!(height_of_pressure(0.0), None);
    }

    #[test]
    fn a_pascal_a_second_at_500_hectopascals_is_some_fifteen_centimetres() {
        // h(500 hPa) = 5574.4 m; -R T / (g p) = -287.05287 * 251.916 / (9.80665 * 50000) m/Pa.
        let found = metres_per_pascal(5574.4);
        assert!((found + 0.147_48).abs() < 1e-4, "{found}");
        assert!((state(5574.4)[0] - 251.916).abs() < 1e-3);
    }
}
