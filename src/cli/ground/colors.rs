//! Colours of terrain: of heights, and by how it lies to a light in the north-west, as maps have it.
//!
//! ```text
//! colour = c(height) (a + (1 - a) max(0, n . l) / l_z)        level ground has its own colour
//! ```

use crate::color::decode_srgb;
use glam::DVec3;

/// Height in metres and sRGB: from green lowland over sand to grey and white.
const HEIGHTS: [(f64, [f64; 3]); 6] = [
    (0.0, [0.44, 0.55, 0.43]),
    (300.0, [0.55, 0.63, 0.47]),
    (1000.0, [0.70, 0.69, 0.54]),
    (2000.0, [0.66, 0.61, 0.53]),
    (3500.0, [0.72, 0.70, 0.68]),
    (5500.0, [0.93, 0.93, 0.93]),
];
/// Of the sea, sRGB.
const SEA: [f64; 3] = [0.36, 0.43, 0.50];
/// Of walls below the ground, sRGB.
pub const WALL: f64 = 0.33;
/// What is so near to 0 m is the sea, where no mask says it.
const SEA_METRES: f64 = 0.5;
/// What is left of a colour in the shade, and no slope is brighter than that.
const SHADE: f64 = 0.35;
const BRIGHTEST: f64 = 1.2;

/// The linear colour of a height, metres.
pub fn of_height(metres: f64, is_sea: Option<bool>) -> [f32; 3] {
    if is_sea.unwrap_or(metres.abs() < SEA_METRES) {
        return SEA.map(|c| decode_srgb(c as f32));
    }
    let above = HEIGHTS.partition_point(|(height, _)| *height <= metres);
    let [(from, a), (to, b)] =
        [above.saturating_sub(1), above.min(HEIGHTS.len() - 1)].map(|i| HEIGHTS[i]);
    let part = if to > from {
        (metres - from) / (to - from)
    } else {
        0.0
    };
    [0, 1, 2].map(|c| decode_srgb((a[c] + part * (b[c] - a[c])) as f32))
}

/// What light leaves of a colour where the ground has this unit normal.
pub fn shade(normal: DVec3) -> f64 {
    let light = DVec3::new(-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2);
    let facing = normal.dot(light).max(0.0) / light.z;
    (SHADE + (1.0 - SHADE) * facing).min(BRIGHTEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn level_ground_has_its_colour_and_slopes_to_the_north_west_are_brighter() {
        assert!((shade(DVec3::Z) - 1.0).abs() < 1e-15);
        let tilted = |x: f64, y: f64| shade(DVec3::new(x, y, 1.0).normalize());
        assert!(tilted(-0.3, 0.3) > 1.0 && tilted(0.3, -0.3) < 0.9);
        assert_eq!(shade(DVec3::new(0.8, -0.6, 0.0)), SHADE);
        assert!(tilted(-1.0, 1.0) <= BRIGHTEST);
    }

    #[test]
    fn heights_have_colours_between_those_of_the_table_and_the_sea_its_own() {
        let srgb =
            |metres| of_height(metres, None).map(|c| f64::from(crate::color::encode_srgb(c)));
        for (metres, wanted) in HEIGHTS
            .into_iter()
            .skip(1)
            .chain([(650.0, [0.625, 0.66, 0.505]), (9000.0, [0.93; 3])])
        {
            for (found, wanted) in srgb(metres).into_iter().zip(wanted) {
                assert!((found - wanted).abs() < 1e-4, "{metres}");
            }
        }
        assert!((srgb(0.1)[2] - SEA[2]).abs() < 1e-4);
        // Below the sea and dry.
        assert!((srgb(-30.0)[1] - HEIGHTS[0].1[1]).abs() < 1e-4);
        assert_eq!(of_height(800.0, Some(true)), of_height(0.0, None));
        assert_ne!(of_height(0.0, Some(false)), of_height(0.0, None));
    }
}
