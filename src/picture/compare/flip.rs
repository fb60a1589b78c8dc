//! FLIP for pictures of low dynamic range: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom & Fairchild,
//! "FLIP: A Difference Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020.
//!
//! ```text
//! flip = C^(1 - F)
//! C    colours blurred as an eye blurs them, in L*a*b* after the Hunt effect, HyAB apart, brought to 0..1
//! F    edges and points that one picture has and the other has not, 0..1
//! ```
//!
//! Section and equation numbers below are the paper's. All filters are products of one for rows and one for
//! columns; the outermost pixels are repeated.

use glam::{DMat3, DVec3};

/// A monitor of 3840 pixels and 0.7 m, seen from 0.7 m (section 6): what the authors' programs use.
pub const PIXELS_PER_DEGREE: f64 = 0.7 * 3840.0 / 0.7 * std::f64::consts::PI / 180.0;

/// Exponents of colour and feature differences, and the bend that maps HyAB to 0..1 (sections 4.1.4, 4.2).
const COLOR_EXPONENT: f64 = 0.7;
const FEATURE_EXPONENT: f64 = 0.5;
const BEND_AT: f64 = 0.4;
const BEND_TO: f64 = 0.95;
/// Peak to trough of the eye's edge filter in degrees (section 4.2).
const EDGE_WIDTH: f64 = 0.082;

/// FLIP of each pixel of two pictures of sRGB numbers from 0 to 1, rows of `width` pixels.
pub fn flip_map(
    wanted: &[[f64; 3]],
    found: &[[f64; 3]],
    width: usize,
    pixels_per_degree: f64,
) -> Vec<f64> {
    let seen = [wanted, found].map(|picture| Seen::new(picture, width, pixels_per_degree));
    let [a, b] = &seen;
    // The largest distance there is: pure green from pure blue (equation 5).
    let largest = hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])).powf(COLOR_EXPONENT);
    let bend = BEND_AT * largest;
    (0..wanted.len())
        .map(|i| {
            let distance = hyab(a.lab[i], b.lab[i]).powf(COLOR_EXPONENT);
            let color = if distance < bend {
                BEND_TO / bend * distance
            } else {
                BEND_TO + (distance - bend) / (largest - bend) * (1.0 - BEND_TO)
            };
            let feature = (a.edges[i] - b.edges[i])
                .abs()
                .max((a.points[i] - b.points[i]).abs());
            let feature = (feature / std::f64::consts::SQRT_2).powf(FEATURE_EXPONENT);
            color.powf(1.0 - feature)
        })
        .collect()
}

/// One picture after the eye.
struct Seen {
    /// Hunt-adjusted L*a*b*, blurred.
    lab: Vec<[f64; 3]>,
    /// Strength of edges and of points, 0 to 1.
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl Seen {
    fn new(picture: &[[f64; 3]], width: usize, pixels_per_degree: f64) -> Self {
        let opponent: Vec<[f64; 3]> = picture
            .iter()
            .map(|pixel| opponent_of_linear(pixel.map(crate::color::decode_srgb)))
            .collect();
        let channel = |c: usize| opponent.iter().map(|pixel| pixel[c]).collect::<Vec<f64>>();
        let blurred =
            [0, 1, 2].map(|c| blur(&channel(c), width, SENSITIVITY[c], pixels_per_degree));
        let linear_of_xyz = linear_of_xyz();
        let lab = (0..picture.len())
            .map(|i| {
                let pixel = [blurred[0][i], blurred[1][i], blurred[2][i]];
                hunt_lab(linear_of_opponent(pixel, linear_of_xyz).map(|c| c.clamp(0.0, 1.0)))
            })
            .collect();
        let luminance: Vec<f64> = opponent
            .iter()
            .map(|pixel| (pixel[0] + 16.0) / 116.0)
            .collect();
        let deviation = 0.5 * EDGE_WIDTH * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as usize;
        let gauss = sampled(radius, |x| (-x * x / (2.0 * deviation * deviation)).exp());
        let edge = sampled(radius, |x| {
            -x * (-x * x / (2.0 * deviation * deviation)).exp()
        });
        let point = sampled(radius, |x| {
            (x * x / (deviation * deviation) - 1.0) * (-x * x / (2.0 * deviation * deviation)).exp()
        });
        let smooth = balanced(&gauss);
        let strength = |derivative: &[f64]| -> Vec<f64> {
            let along_x = convolve(&luminance, width, derivative, &smooth);
            let along_y = convolve(&luminance, width, &smooth, derivative);
            along_x
                .iter()
                .zip(&along_y)
                .map(|(x, y)| x.hypot(*y))
                .collect()
        };
        Self {
            lab,
            edges: strength(&balanced(&edge)),
            points: strength(&balanced(&point)),
        }
    }
}

/// Contrast sensitivity of each opponent channel: sum of `a sqrt(pi/b) exp(-pi^2 r^2 / b)`, r in degrees
/// (table 1).
const SENSITIVITY: [&[(f64, f64)]; 3] = [
    &[(1.0, 0.0047)],
    &[(1.0, 0.0053)],
    &[(34.1, 0.04), (13.5, 0.025)],
];

fn blur(
    numbers: &[f64],
    width: usize,
    sensitivity: &[(f64, f64)],
    pixels_per_degree: f64,
) -> Vec<f64> {
    use std::f64::consts::PI;
    // Three deviations of the widest of all filters, for all of them.
    let radius = (3.0 * (0.04 / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as usize;
    let terms: Vec<(f64, Vec<f64>)> = sensitivity
        .iter()
        .map(|&(a, b)| {
            let row = sampled(radius, |x| {
                let degrees = x / pixels_per_degree;
                (-PI * PI * degrees * degrees / b).exp()
            });
            (a * (PI / b).sqrt(), row)
        })
        .collect();
    let volume = |(scale, row): &(f64, Vec<f64>)| scale * row.iter().sum::<f64>().powi(2);
    let total: f64 = terms.iter().map(volume).sum();
    let mut blurred = vec![0.0; numbers.len()];
    for (scale, row) in &terms {
        let part = convolve(numbers, width, row, row);
        for (sum, part) in blurred.iter_mut().zip(part) {
            *sum += scale / total * part;
        }
    }
    blurred
}

/// A filter's numbers at -radius to radius.
fn sampled(radius: usize, filter: impl Fn(f64) -> f64) -> Vec<f64> {
    let radius = radius as i32;
    (-radius..=radius).map(|x| filter(x.into())).collect()
}

/// Positive numbers that sum to 1, negative ones that sum to -1.
fn balanced(filter: &[f64]) -> Vec<f64> {
    let positive: f64 = filter.iter().filter(|&&w| w > 0.0).sum();
    let negative: f64 = filter.iter().filter(|&&w| w < 0.0).sum();
    let scaled = |&w: &f64| if w > 0.0 { w / positive } else { w / -negative };
    filter
        .iter()
        .map(|w| if *w == 0.0 { 0.0 } else { scaled(w) })
        .collect()
}

/// Filters the rows with `along_x` and the columns with `along_y`, as correlations; the outermost pixels are
/// repeated.
pub(super) fn convolve(
    numbers: &[f64],
    width: usize,
    along_x: &[f64],
    along_y: &[f64],
) -> Vec<f64> {
    let height = numbers.len() / width;
    let reach = |filter: &[f64]| filter.len() / 2;
    let mut rows = vec![0.0; numbers.len()];
    for y in 0..height {
        let row = &numbers[y * width..(y + 1) * width];
        for x in 0..width {
            let near = |k: usize| (x + k).saturating_sub(reach(along_x)).min(width - 1);
            let taps = along_x.iter().enumerate();
            rows[y * width + x] = taps.map(|(k, weight)| weight * row[near(k)]).sum();
        }
    }
    let mut filtered = vec![0.0; numbers.len()];
    for y in 0..height {
        for (k, weight) in along_y.iter().enumerate() {
            let near = (y + k).saturating_sub(reach(along_y)).min(height - 1);
            let from = &rows[near * width..(near + 1) * width];
            for (sum, number) in filtered[y * width..(y + 1) * width].iter_mut().zip(from) {
                *sum += weight * number;
            }
        }
    }
    filtered
}

/// Linear sRGB to CIE XYZ under D65, exact fractions of the primaries' chromaticities.
const XYZ_OF_LINEAR: [[f64; 3]; 3] = [
    [
        10_135_552.0 / 24_577_794.0,
        8_788_810.0 / 24_577_794.0,
        4_435_075.0 / 24_577_794.0,
    ],
    [
        2_613_072.0 / 12_288_897.0,
        8_788_810.0 / 12_288_897.0,
        887_015.0 / 12_288_897.0,
    ],
    [
        1_425_312.0 / 73_733_382.0,
        8_788_810.0 / 73_733_382.0,
        70_074_185.0 / 73_733_382.0,
    ],
];

/// XYZ over that of white.
fn xyz_of_linear(linear: [f64; 3]) -> [f64; 3] {
    XYZ_OF_LINEAR.map(|row| {
        let white: f64 = row.iter().sum();
        let xyz: f64 = row.iter().zip(linear).map(|(m, c)| m * c).sum();
        xyz / white
    })
}

/// Linear sRGB to YCxCz, a linear relative of L*a*b* (section 4.1.1).
fn opponent_of_linear(linear: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = xyz_of_linear(linear);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Back to linear sRGB, given the matrix of [`linear_of_xyz`].
fn linear_of_opponent([y, cx, cz]: [f64; 3], linear_of_xyz: DMat3) -> [f64; 3] {
    let y = (y + 16.0) / 116.0;
    let xyz = DVec3::new(y + cx / 500.0, y, y - cz / 200.0);
    (linear_of_xyz * xyz).to_array()
}

/// The inverse of [`xyz_of_linear`].
fn linear_of_xyz() -> DMat3 {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let [x, y, z] = axes.map(|axis| DVec3::from_array(xyz_of_linear(axis.to_array())));
    DMat3::from_cols(x, y, z).inverse()
}

/// L*a*b* (CIE 1976) of linear sRGB, a* and b* times L/100: colours in the dark count less (Hunt; 4.1.3).
fn hunt_lab(linear: [f64; 3]) -> [f64; 3] {
    let delta: f64 = 6.0 / 29.0;
    let [x, y, z] = xyz_of_linear(linear).map(|t| {
        if t > delta.powi(3) {
            t.cbrt()
        } else {
            t / (3.0 * delta * delta) + 4.0 / 29.0
        }
    });
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    [lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z)]
}

/// Lightness apart, plus colour apart (Abasi et al. 2020).
fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}
