//! The exact law of classification, its table and its search, `sampling.md` 4.

#[allow(dead_code, reason = "each file of tests uses some of it")]
use crate::transfer_shared;

use stratavox::color::{ColorSpace, decode_srgb, encode_srgb};
use stratavox::transfer::{
    Absorption, ColorPoint, Interpolation, MAX_OPACITY, OpacityPoint, Points, Table,
    TransferFunction, classify_by_points, classify_by_table, extinction, opacity_over,
};
use transfer_shared::{Random, function};

const OPACITY: Absorption = Absorption::Opacity;

fn opacity_points(points: &[(f64, f64)], interpolation: Interpolation) -> TransferFunction {
    let opacity = points
        .iter()
        .map(|&(value, opacity)| OpacityPoint { value, opacity });
    TransferFunction {
        color: vec![],
        opacity: opacity.collect(),
        reference_length: None,
        interpolation,
        gradient_transfer: None,
        medium: None,
    }
}

#[test]
fn opacity_is_a_straight_line_between_points_and_constant_beyond_them() {
    let tf = opacity_points(&[(10.0, 0.2), (20.0, 0.6)], Interpolation::Linear);
    for (value, wanted) in [
        (-1e9, 0.2),
        (10.0, 0.2),
        (12.5, 0.3),
        (20.0, 0.6),
        (1e9, 0.6),
    ] {
        let found = tf.opacity(value);
        assert!(
            (found - wanted).abs() < 1e-15,
            "at {value}: {found}, not {wanted}"
        );
    }
}

#[test]
fn at_equal_values_the_later_point_wins() {
    for interpolation in [Interpolation::Linear, Interpolation::Step] {
        let tf = opacity_points(
            &[(0.0, 0.1), (5.0, 0.1), (5.0, 0.7), (5.0, 0.9)],
            interpolation,
        );
        assert_eq!(tf.opacity(5.0), 0.9, "{interpolation:?}");
        assert_eq!(tf.opacity(5.0_f64.next_down()), 0.1, "{interpolation:?}");
    }
}

#[test]
fn a_step_holds_the_left_point() {
    let tf = opacity_points(&[(0.0, 0.1), (5.0, 0.7), (9.0, 0.3)], Interpolation::Step);
    for (value, wanted) in [
        (-1.0, 0.1),
        (4.999, 0.1),
        (5.0, 0.7),
        (8.9, 0.7),
        (9.0, 0.3),
    ] {
        assert_eq!(tf.opacity(value), wanted, "at {value}");
    }
}

#[test]
fn color_is_mixed_in_srgb_numbers_and_decoded_afterwards() {
    let point = |value, level| ColorPoint {
        value,
        srgb: [level; 3],
    };
    let tf = TransferFunction {
        color: vec![point(0.0, 0.0), point(1.0, 1.0)],
        ..opacity_points(&[], Interpolation::Linear)
    };
    // (0.5 + 0.055) / 1.055 to the 2.4; mixing linear light would give 0.5.
    let wanted = 0.214_041_140_482_232_55;
    let [found, ..] = tf.color(0.5, ColorSpace::Linear);
    assert!((found - wanted).abs() < 1e-15, "{found}");
    assert_eq!(tf.color(0.5, ColorSpace::Display), [0.5; 3]);
}

#[test]
fn srgb_numbers_come_back_from_linear_light() {
    for i in 0..=4096 {
        let s = f64::from(i) / 4096.0;
        // The standard's two thresholds differ in the 5th digit: its own gap is below 2e-7 of light.
        let back = encode_srgb(decode_srgb(s));
        assert!((back - s).abs() < 5e-8, "{s} came back as {back}");
        let back = encode_srgb(decode_srgb(s as f32));
        assert!(
            (back - s as f32).abs() < 5e-7,
            "f32: {s} came back as {back}"
        );
    }
    assert!((decode_srgb(0.04045_f64) - 0.04045 / 12.92).abs() < 1e-18);
    assert_eq!(decode_srgb(1.0_f64), 1.0);
}

#[test]
fn a_segment_of_the_reference_length_has_the_opacity_of_the_point() {
    for i in 0..4096 {
        let opacity = f64::from(i) / 4096.0;
        let sigma = extinction(opacity, 0.7);
        let found = opacity_over(sigma, 0.7);
        // The series leaves out x^4/24; x < 0.01.
        assert!((found - opacity).abs() < 5e-10, "{opacity} became {found}");
        let halves = opacity_over(sigma, 0.35);
        let twice = 1.0 - (1.0 - halves) * (1.0 - halves);
        assert!(
            (twice - opacity).abs() < 1e-9,
            "two halves of {opacity} are {twice}"
        );
    }
    assert_eq!(extinction(1.0, 1.0), extinction(MAX_OPACITY, 1.0));
    assert!(extinction(1.0_f32, 1.0).is_finite());
}

#[test]
fn thin_segments_keep_their_digits_in_f32() {
    for x in [1e-6_f64, 1e-5, 1e-4, 1e-3, 9.9e-3] {
        let exact = -(-x).exp_m1();
        let found = f64::from(opacity_over(x as f32, 1.0));
        let relative = (found / exact - 1.0).abs();
        // x^3/24 of the series, and four roundings of f32.
        assert!(relative < 5e-8 + 4.0 * 6e-8, "x = {x}: off by {relative}");
    }
}

#[test]
fn searching_the_points_is_the_law() {
    let mut random = Random(1);
    for round in 0..200 {
        let tf = function(&mut random);
        for space in [ColorSpace::Linear, ColorSpace::Display] {
            let points = Points::new(&tf, OPACITY, space);
            for value in transfer_shared::values(&tf, &mut random) {
                let [r, g, b] = tf.color(value, space);
                let wanted = [r, g, b, tf.opacity(value)];
                let exact = classify_by_points(&points, value);
                let single = classify_by_points(&points, value as f32).map(f64::from);
                for c in 0..4 {
                    let (wanted, exact, single) = (wanted[c], exact[c], single[c]);
                    // Points are kept in f32.
                    assert!(
                        (exact - wanted).abs() < 2e-7,
                        "{round}: {exact}, not {wanted}"
                    );
                    assert!(
                        (single - wanted).abs() < 2e-6,
                        "{round}: {single}, not {wanted}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_table_is_within_a_4096th_of_the_law() {
    let mut random = Random(2);
    let mut sizes = std::collections::BTreeSet::new();
    let mut checked = 0;
    for round in 0..100 {
        let tf = function(&mut random);
        let table = Table::new(&tf, OPACITY, ColorSpace::Linear);
        sizes.insert(table.entries.len());
        let cell = 1.0 / f64::from(table.scale);
        assert!(table.entries.len().is_power_of_two());
        assert!(
            table.off_by <= 1.0 / 4096.0,
            "{round}: off by {}",
            table.off_by
        );
        for value in transfer_shared::values(&tf, &mut random) {
            let inside = |jump: f64| (value - jump).abs() <= cell && (jump / cell).fract() != 0.0;
            if transfer_shared::jumps(&tf).into_iter().any(inside) {
                continue;
            }
            checked += 1;
            let found = classify_by_table(&table, value as f32);
            let same = classify_by_table(&table, value).map(|x| x as f32);
            for (c, wanted) in tf
                .srgb(value)
                .into_iter()
                .chain([tf.opacity(value)])
                .enumerate()
            {
                for found in [found[c], same[c]] {
                    let found = f64::from(found);
                    let found = if c < 3 { encode_srgb(found) } else { found };
                    // f32 entries: 12.92 half units in the last place of light below 1.
                    let off = (found - wanted).abs();
                    assert!(off <= 1.0 / 4096.0 + 1e-6, "{round}, {value}: off by {off}");
                }
            }
        }
    }
    println!("{checked} values, tables of {sizes:?}");
    assert!(
        checked > 5_000 && sizes.len() > 3,
        "{checked} values, {sizes:?}"
    );
}

#[test]
fn a_label_never_takes_its_neighbours_color() {
    for (from, to) in [(0, 29), (-3, 4), (100, 100), (0, 4095), (-1024, 64_000)] {
        let points: Vec<_> = (from..=to)
            .map(|k: i32| (f64::from(k), f64::from(k.rem_euclid(97)) / 97.0))
            .collect();
        let tf = opacity_points(&points, Interpolation::Step);
        let table = Table::new(&tf, OPACITY, ColorSpace::Linear);
        for k in from - 2..=to + 2 {
            let [.., found] = classify_by_table(&table, k as f32);
            assert_eq!(
                found,
                tf.opacity(k.into()) as f32,
                "label {k} of {from} to {to}"
            );
        }
    }
}

#[test]
fn a_threshold_at_a_single_value_is_exact() {
    // f32 has no numbers just below 0 that a device may not take for 0.
    let just_below = |at: f32| if at == 0.0 { -1e-30 } else { at.next_down() };
    for at in [0.0, 100.0, -0.37_f32, 1e6, 1.5e-5] {
        let tf = opacity_points(&[(at.into(), 0.0), (at.into(), 1.0)], Interpolation::Linear);
        let table = Table::new(&tf, OPACITY, ColorSpace::Linear);
        for (value, wanted) in [
            (at, 1.0),
            (just_below(at), 0.0),
            (at + 1e7, 1.0),
            (at - 1e7, 0.0),
        ] {
            let [.., found] = classify_by_table(&table, value);
            assert_eq!(found, wanted, "{value} against the threshold {at}");
        }
    }
}

#[test]
fn senseless_points_still_make_a_table() {
    let senseless = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        -f64::MAX,
        1e-310,
        0.0,
    ];
    for a in senseless {
        for b in senseless {
            let tf = opacity_points(&[(a, 0.5), (b, b)], Interpolation::Linear);
            let table = Table::new(&tf, OPACITY, ColorSpace::Linear);
            assert!(
                table.entries.len() <= 262_144 && table.scale > 0.0,
                "{a}, {b}"
            );
            classify_by_table(&table, 1.0_f32);
        }
    }
}
