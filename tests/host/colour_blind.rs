//! The colours that the program chooses by itself, as eyes without red or green cones see them.
//!
//! ```text
//! protanopia, deuteranopia   matrices on linear sRGB for severity 1: Machado, Oliveira & Fernandes, "A Physiologically-
//!                            based Model for Simulation of Color Vision Deficiency", IEEE TVCG 15(6), 2009, table 1
//! L*a*b*                     CIE 15:2004 under D65; its Euclidean distance, of which 2.3 is just noticeable
//!                            (Mahy, Van Eycken & Oosterlinck, Color Research and Application 19(2), 1994)
//! ```
//!
//! What is asked, of every eye:
//!
//! - rising colours grow lighter all the way, by 50 of L* at least: what is more is lighter;
//! - colours about a middle are lightest there, and two values equally far from it, half of the way or more, are 40 apart;
//! - of every map, values a quarter of the range apart are 10 apart, four times what is just noticeable;
//! - channels are 25 apart, each from each, and labels whose numbers follow one another 20.

use stratavox::color::decode_srgb;
use stratavox::transfer::{
    CHANNEL_COLORS, Classified, Colormap, Kind, MEANINGS, Preset, TransferFunction, ValueSummary,
    automatic,
};

type Matrix = [[f64; 3]; 3];

const EYES: [(&str, Matrix); 3] = [
    (
        "three cones",
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    ),
    (
        "protanopia",
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ],
    ),
    (
        "deuteranopia",
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ],
    ),
];

/// Half a code up or down in all channels is what rounding to bytes may do to a table; a code of grey is 100/255 of L*.
const CODE: f64 = 100.0 / 255.0;
const COLORS: usize = 256;

fn times(matrix: &Matrix, v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| (0..3).map(|k| row[k] * v[k]).sum())
}

fn lab(eye: &Matrix, srgb: [f64; 3]) -> [f64; 3] {
    // IEC 61966-2-1, and the white that its primaries make.
    const XYZ: Matrix = [
        [0.4124564, 0.3575761, 0.1804375],
        [0.2126729, 0.7151522, 0.0721750],
        [0.0193339, 0.1191920, 0.9503041],
    ];
    const WHITE: [f64; 3] = [0.95047, 1.0, 1.08883];
    let seen = times(eye, srgb.map(decode_srgb)).map(|c: f64| c.clamp(0.0, 1.0));
    let xyz = times(&XYZ, seen);
    let [x, y, z] = [0, 1, 2].map(|k| {
        let t: f64 = xyz[k] / WHITE[k];
        match t > 216.0 / 24389.0 {
            true => t.cbrt(),
            false => (24389.0 / 27.0 * t + 16.0) / 116.0,
        }
    });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

fn of_map(name: &str) -> Vec<[f64; 3]> {
    let map: Colormap = name.parse().expect("a map");
    let colors = map.colors().into_iter();
    colors
        .map(|rgb| rgb.map(|c| f64::from(c) / 255.0))
        .collect()
}

/// The colours of a function from one value to another.
fn of_function(function: &TransferFunction, [low, high]: [f64; 2]) -> Vec<[f64; 3]> {
    let at = |i: usize| low + (high - low) * i as f64 / (COLORS - 1) as f64;
    (0..COLORS).map(|i| function.srgb(at(i))).collect()
}

/// The same between its outermost colours.
fn of_all(function: &TransferFunction) -> Vec<[f64; 3]> {
    let ends = [function.color.first(), function.color.last()];
    of_function(function, ends.map(|point| point.expect("colours").value))
}

/// Whole numbers over all of `range`.
fn summary([low, high]: [i32; 2], hounsfield: bool) -> ValueSummary {
    let count = (high - low) as usize + 1;
    let range = [low, high].map(f64::from);
    ValueSummary::of(count, range, 512.0, hounsfield, |i| {
        Some(f64::from(low) + i as f64)
    })
}

fn preset(preset: Preset) -> TransferFunction {
    preset.function(&summary([-1000, 3000], true), Classified::Samples, None)
}

fn seen<'a>(eye: &'a Matrix, colors: &'a [[f64; 3]]) -> Vec<[f64; 3]> {
    colors.iter().map(|&srgb| lab(eye, srgb)).collect()
}

fn assert_rises(colors: &[[f64; 3]], least: f64, what: &str) {
    for (eye, matrix) in &EYES {
        let seen = seen(matrix, colors);
        let mut lightest = f64::NEG_INFINITY;
        for [lightness, ..] in &seen {
            assert!(
                *lightness > lightest - CODE,
                "{what}, {eye}: {lightness} after {lightest}"
            );
            lightest = lightest.max(*lightness);
        }
        let rise = lightest - seen[0][0];
        assert!(rise >= least, "{what}, {eye}: rises by {rise}");
    }
}

fn assert_quarters_differ(colors: &[[f64; 3]], what: &str) {
    for (eye, matrix) in &EYES {
        let seen = seen(matrix, colors);
        for (i, a) in seen.iter().enumerate() {
            for (j, b) in seen.iter().enumerate().skip(i + COLORS / 4) {
                let found = apart(*a, *b);
                assert!(
                    found >= 10.0,
                    "{what}, {eye}: {i} and {j} are {found} apart"
                );
            }
        }
    }
}

#[test]
fn colours_that_rise_grow_lighter_for_every_eye() {
    for name in ["viridis", "cividis", "plasma", "inferno", "batlow", "wind"] {
        assert_rises(&of_map(name), 50.0, name);
    }
    for chosen in [Preset::Mri, Preset::Microscopy] {
        assert_rises(&of_all(&preset(chosen)), 50.0, chosen.name());
    }
    // Skin lies over bone in colours of its own; from 110 HU on it is bone alone.
    let ct = automatic(&summary([-1000, 3000], true), Classified::Samples, None);
    assert_rises(&of_function(&ct, [110.0, 1800.0]), 50.0, "ct");
    // Under a quarter of the uptake lies a faint bluish body.
    let uptake = preset(Preset::Pet);
    let [low, high] = [uptake.color[0].value, uptake.color[6].value];
    let quarter = low + (0.25 - 0.03) / 0.97 * (high - low);
    assert_rises(&of_function(&uptake, [quarter, high]), 50.0, "uptake");
}

#[test]
fn colours_about_a_middle_tell_its_sides_apart_for_every_eye() {
    let both_sides = summary([-500, 500], false);
    assert_eq!(Kind::of(&both_sides), Kind::Signed);
    let signed = automatic(&both_sides, Classified::Samples, None);
    for (what, colors) in [
        ("roma,reverse", of_map("roma,reverse")),
        ("below and above zero", of_all(&signed)),
    ] {
        let half = COLORS / 2;
        for (eye, matrix) in &EYES {
            let seen = seen(matrix, &colors);
            for i in 0..half / 2 {
                let found = apart(seen[i], seen[COLORS - 1 - i]);
                assert!(
                    found >= 40.0,
                    "{what}, {eye}: {i} is {found} from its mirror"
                );
            }
            for i in [0, COLORS - 1] {
                let rise = seen[half][0] - seen[i][0];
                assert!(rise >= 30.0, "{what}, {eye}: the middle is {rise} lighter");
            }
        }
    }
}

#[test]
fn values_a_quarter_of_the_range_apart_differ_for_every_eye() {
    // Whatever a quantity is drawn in by itself, the rainbow of radar among them.
    for meaning in MEANINGS {
        assert_quarters_differ(&of_map(meaning.colors), meaning.colors);
    }
}

#[test]
fn channels_and_labels_that_follow_one_another_differ_for_every_eye() {
    for (eye, matrix) in &EYES {
        let seen = seen(matrix, &CHANNEL_COLORS);
        for (i, a) in seen.iter().enumerate() {
            for (j, b) in seen.iter().enumerate().skip(i + 1) {
                let found = apart(*a, *b);
                assert!(
                    found >= 25.0,
                    "{eye}: channels {i} and {j} are {found} apart"
                );
            }
        }
    }
    // Runs of 13 labels that jump by 5.
    let label = |i: usize| (i / 100 * 5 % 13) as f64;
    let summary = ValueSummary::of(1300, [0.0, 12.0], 512.0, false, |i| Some(label(i)));
    assert_eq!(Kind::of(&summary), Kind::Labels);
    let labels = automatic(&summary, Classified::Samples, None);
    let colors: Vec<_> = (1..=12).map(|k| labels.srgb(f64::from(k))).collect();
    for (eye, matrix) in &EYES {
        for (k, pair) in seen(matrix, &colors).windows(2).enumerate() {
            let found = apart(pair[0], pair[1]);
            assert!(
                found >= 20.0,
                "{eye}: labels {} and {} are {found} apart",
                k + 1,
                k + 2
            );
        }
    }
}
