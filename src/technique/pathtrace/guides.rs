//! What tells detail from noise beside colours: what paths met first.
//!
//! ```text
//! g = albedo, normal, depth of first collisions: sums over paths / paths, 0 of paths that have none
//! ```
//!
//! Depths count from their mean over the picture, in standard deviations over it, so that all three are of the order of 1
//! and no unit matters.

use super::layers::PathMeans;

/// The images of [`PathMeans`] that guides are made of.
pub(crate) const GUIDE_IMAGES: [usize; 2] = [0, 1];

/// Of a pixel: albedo and the part of the paths that met something; normal and depth.
pub(crate) type Guide = [[f32; 4]; 2];

/// Of what paths leave.
pub(crate) fn guide_of(means: &PathMeans) -> Guide {
    GUIDE_IMAGES.map(|image| means[image])
}

/// How many numbers guide a pixel.
pub(super) const NUMBERS: usize = 7;

/// Albedo, normal and depth, as they are compared and fitted to.
pub(super) type Compared = [f32; NUMBERS];

/// Guides of two halves as they are compared.
pub(super) fn compared(halves: [&[Guide]; 2]) -> [Vec<Compared>; 2] {
    // Of depths: how many paths have one, their sum and that of their squares.
    let mut sums = [0.0_f64; 3];
    for &[[.., met], [.., depth]] in halves.into_iter().flatten() {
        let (met, depth) = (f64::from(met), f64::from(depth));
        if met > 0.0 {
            sums = [
                sums[0] + met,
                sums[1] + depth,
                sums[2] + depth * depth / met,
            ];
        }
    }
    let [count, sum, squares] = sums;
    let mean = if count > 0.0 { sum / count } else { 0.0 };
    let variance = (squares - mean * sum).max(0.0) / count.max(1.0);
    // Of a plane across the view nothing is left but rounding.
    let is_flat = variance <= 1e-10 * mean * mean;
    let scale = if is_flat { 0.0 } else { 1.0 / variance.sqrt() };
    let of = |&[[r, g, b, met], [x, y, z, depth]]: &Guide| {
        let depth = scale * (f64::from(depth) - mean * f64::from(met));
        [r, g, b, x, y, z, depth as f32]
    };
    halves.map(|half| half.iter().map(of).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_are_compared_without_a_unit() {
        let guides = |scale: f32| -> Vec<Guide> {
            let depths = [(1.0, 10.0), (0.5, 7.0), (0.0, 0.0), (1.0, 12.0)];
            let guide = |(met, depth)| [[0.2, 0.3, 0.4, met], [0.0, 0.6, 0.8, scale * depth]];
            depths.map(guide).to_vec()
        };
        let [metres, miles] = [1.0, 1000.0].map(guides);
        let [a, _] = compared([&metres, &metres]);
        let [b, _] = compared([&miles, &miles]);
        for (a, b) in a.iter().zip(&b) {
            assert!(
                (0..NUMBERS).all(|i| (a[i] - b[i]).abs() < 1e-5),
                "{a:?} {b:?}"
            );
        }
        // 29 over 2.5 paths is 11.6 deep; of paths that met nothing there is no depth.
        assert_eq!(a[2], [0.2, 0.3, 0.4, 0.0, 0.6, 0.8, 0.0]);
        assert!(a[0][6] < 0.0 && a[1][6] > 0.0 && a[3][6] > 0.0);
        let flat: Vec<Guide> = vec![[[0.5, 0.5, 0.5, 0.3], [0.0, 0.0, 1.0, 0.3 * 7.1]]; 9];
        assert!(
            compared([&flat, &flat])[0]
                .iter()
                .all(|guide| guide[6] == 0.0)
        );
    }
}
