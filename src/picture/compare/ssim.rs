//! Structural similarity: Wang, Bovik, Sheikh & Simoncelli, "Image quality assessment", IEEE Transactions on
//! Image Processing 13(4), 2004.
//!
//! ```text
//! ssim = (2 ma mb + C1) (2 sab + C2) / ((ma^2 + mb^2 + C1) (sa^2 + sb^2 + C2))
//! ```
//!
//! Means, variances and covariance of luma under an 11 x 11 Gaussian of deviation 1.5; C1 = 0.01^2,
//! C2 = 0.03^2. The mean is over the pixels whose window lies inside the picture, or, where there are none,
//! over all pixels with the outermost ones repeated.

use super::flip::convolve;

const RADIUS: usize = 5;
const DEVIATION: f64 = 1.5;
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

/// Mean SSIM of two pictures of sRGB numbers.
pub(super) fn mean(pictures: &[Vec<[f64; 3]>; 2], [width, height]: [usize; 2]) -> f64 {
    // Rec. 601, as the paper's own program takes it from colours.
    let luma = |p: &[f64; 3]| 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
    let a: Vec<f64> = pictures[0].iter().map(luma).collect();
    let b: Vec<f64> = pictures[1].iter().map(luma).collect();
    let weights: Vec<f64> = (0..=2 * RADIUS)
        .map(|i| (i as f64 - RADIUS as f64) / DEVIATION)
        .map(|x| (-x * x / 2.0).exp())
        .collect();
    let total: f64 = weights.iter().sum();
    let weights: Vec<f64> = weights.iter().map(|w| w / total).collect();
    let blur = |numbers: &[f64]| convolve(numbers, width, &weights, &weights);
    let product =
        |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a * b).collect() };
    let (mean_a, mean_b) = (blur(&a), blur(&b));
    let (aa, bb, ab) = (
        blur(&product(&a, &a)),
        blur(&product(&b, &b)),
        blur(&product(&a, &b)),
    );
    let at = |i: usize| {
        let (ma, mb) = (mean_a[i], mean_b[i]);
        let covariance = ab[i] - ma * mb;
        let variances = aa[i] - ma * ma + bb[i] - mb * mb;
        (2.0 * ma * mb + C1) * (2.0 * covariance + C2)
            / ((ma * ma + mb * mb + C1) * (variances + C2))
    };
    let inside = width > 2 * RADIUS && height > 2 * RADIUS;
    let margin = if inside { RADIUS } else { 0 };
    let rows = margin..height - margin;
    let pixels = rows.flat_map(|y| (margin..width - margin).map(move |x| y * width + x));
    let (sum, count) = pixels.fold((0.0, 0), |(sum, count), i| (sum + at(i), count + 1));
    sum / f64::from(count)
}
