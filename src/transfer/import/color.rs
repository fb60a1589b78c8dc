//! Colours mixed in spaces other than sRGB numbers.
//!
//! CIE L*a*b* with the white of D65; hue, saturation and value (Smith 1978); and the diverging maps of
//! Moreland, "Diverging Color Maps for Scientific Visualization", ISVC 2009: polar L*a*b* (M its length, s its
//! angle to the L axis, h the hue), through white where two saturated colours are more than 60 degrees apart.

use crate::color::{decode_srgb, encode_srgb};
use std::f64::consts::PI;

/// Where colours are mixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Space {
    /// `wraps`: the hue goes the shorter way round.
    Hsv {
        wraps: bool,
    },
    Lab,
    Diverging,
}

/// The colour at the fraction `t` of the way from `left` to `right`, in sRGB numbers.
pub(super) fn mixed(space: Space, left: [f64; 3], right: [f64; 3], t: f64) -> [f64; 3] {
    match space {
        Space::Hsv { wraps } => {
            let (left, right) = hues(wraps, left, right);
            rgb_of_hsv(lerp(left, right, t))
        }
        Space::Lab => rgb_of_lab(lerp(lab(left), lab(right), t)),
        Space::Diverging => diverging(left, right, t),
    }
}

/// Fractions of the way from `left` to `right` where points are needed, the first end among them: `parts` equal
/// ones, and those where a hue passes a primary or secondary colour, at which the mixture has corners.
pub(super) fn places(space: Space, left: [f64; 3], right: [f64; 3], parts: usize) -> Vec<f64> {
    let mut places: Vec<f64> = (0..parts).map(|part| part as f64 / parts as f64).collect();
    if let Space::Hsv { wraps } = space {
        let (left, right) = hues(wraps, left, right);
        places.extend(corners(left[0], right[0]));
        places.sort_by(f64::total_cmp);
    }
    places
}

/// Where between two hues a sixth of the circle is passed.
pub(super) fn corners(left: f64, right: f64) -> impl Iterator<Item = f64> {
    let passed = (-6..=12).map(move |sixth| (f64::from(sixth) / 6.0 - left) / (right - left));
    passed.filter(|t| *t > 0.0 && *t < 1.0)
}

/// Both colours as hue, saturation and value, the hues so that the way between them is straight.
fn hues(wraps: bool, left: [f64; 3], right: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let (mut left, mut right) = (hsv(left), hsv(right));
    if wraps && (left[0] - right[0]).abs() > 0.5 {
        let lower = if left[0] < right[0] {
            &mut left
        } else {
            &mut right
        };
        lower[0] += 1.0;
    }
    (left, right)
}

fn lerp(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + t * (b[k] - a[k]))
}

/// sRGB from hue, saturation and value, all 0 to 1.
pub(super) fn rgb_of_hsv([hue, saturation, value]: [f64; 3]) -> [f64; 3] {
    [0.0, 4.0, 2.0].map(|offset| {
        let distance = ((6.0 * hue + offset).rem_euclid(6.0) - 3.0).abs() - 1.0;
        value * (1.0 - saturation * (1.0 - distance.clamp(0.0, 1.0)))
    })
}

fn hsv([r, g, b]: [f64; 3]) -> [f64; 3] {
    let (high, low) = (r.max(g).max(b), r.min(g).min(b));
    let chroma = high - low;
    if chroma == 0.0 {
        return [0.0, 0.0, high];
    }
    let sixths = if high == r {
        (g - b) / chroma
    } else if high == g {
        2.0 + (b - r) / chroma
    } else {
        4.0 + (r - g) / chroma
    };
    [(sixths / 6.0).rem_euclid(1.0), chroma / high, high]
}

/// XYZ of linear sRGB, rows (IEC 61966-2-1), and the white of D65.
const XYZ: [[f64; 3]; 3] = [
    [0.4124, 0.3576, 0.1805],
    [0.2126, 0.7152, 0.0722],
    [0.0193, 0.1192, 0.9505],
];
const RGB: [[f64; 3]; 3] = [
    [3.2406, -1.5372, -0.4986],
    [-0.9689, 1.8758, 0.0415],
    [0.0557, -0.2040, 1.0570],
];
const WHITE: [f64; 3] = [0.9505, 1.0, 1.089];

fn times(matrix: [[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn lab(srgb: [f64; 3]) -> [f64; 3] {
    let xyz = times(XYZ, srgb.map(decode_srgb));
    let f = |k: usize| {
        let share = xyz[k] / WHITE[k];
        if share > 0.008856 {
            share.cbrt()
        } else {
            7.787 * share + 16.0 / 116.0
        }
    };
    let [x, y, z] = [f(0), f(1), f(2)];
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn rgb_of_lab([l, a, b]: [f64; 3]) -> [f64; 3] {
    let y = (l + 16.0) / 116.0;
    let f = [y + a / 500.0, y, y - b / 200.0];
    let xyz: [f64; 3] = std::array::from_fn(|k| {
        let cube = f[k] * f[k] * f[k];
        let share = if cube > 0.008856 {
            cube
        } else {
            (f[k] - 16.0 / 116.0) / 7.787
        };
        share * WHITE[k]
    });
    times(RGB, xyz).map(|linear| encode_srgb(linear.clamp(0.0, 1.0)))
}

/// Below this angle a colour is as good as grey.
const GREY: f64 = 0.05;

fn diverging(left: [f64; 3], right: [f64; 3], t: f64) -> [f64; 3] {
    let (mut left, mut right, mut t) = (msh(left), msh(right), t);
    let turn = (left[2] - right[2]).abs();
    let apart = turn.min(2.0 * PI - turn);
    if left[1] > GREY && right[1] > GREY && apart > PI / 3.0 {
        let white = [left[0].max(right[0]).max(88.0), 0.0, 0.0];
        if t < 0.5 {
            (right, t) = (white, 2.0 * t);
        } else {
            (left, t) = (white, 2.0 * t - 1.0);
        }
    }
    if left[1] < GREY && right[1] > GREY {
        left[2] = adjusted_hue(right, left[0]);
    } else if right[1] < GREY && left[1] > GREY {
        right[2] = adjusted_hue(left, right[0]);
    }
    let [m, s, h] = lerp(left, right, t);
    rgb_of_lab([m * s.cos(), m * s.sin() * h.cos(), m * s.sin() * h.sin()])
}

fn msh(srgb: [f64; 3]) -> [f64; 3] {
    let [l, a, b] = lab(srgb);
    let m = (l * l + a * a + b * b).sqrt();
    let s = if m > 0.001 { (l / m).acos() } else { 0.0 };
    let h = if s > 0.001 { b.atan2(a) } else { 0.0 };
    [m, s, h]
}

/// The hue that a grey of length `grey` lends to a path towards a saturated colour.
fn adjusted_hue([m, s, h]: [f64; 3], grey: f64) -> f64 {
    if m >= grey - 0.1 {
        return h;
    }
    let spin = s * (grey * grey - m * m).sqrt() / (m * s.sin());
    // Away from purple.
    if h > -0.3 * PI { h + spin } else { h - spin }
}
