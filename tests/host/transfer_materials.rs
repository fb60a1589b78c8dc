//! Named materials: control points against `docs/transfer-functions.md`.

#![cfg(feature = "json")]

#[allow(dead_code, reason = "each file of tests uses some of it")]
use crate::transfer_shared;

use stratavox::transfer::{
    FileProblem, Material, TransferFunction, transfer_function_from_json, transfer_function_to_json,
};
use transfer_shared::Random;

/// Membership as Drebin, Carpenter and Hanrahan draw it, away from corners.
fn membership(material: &Material, value: f64) -> f64 {
    let [v0, v1, v2, v3] = material.trapezoid;
    let rise = if v1 > v0 {
        (value - v0) / (v1 - v0)
    } else {
        f64::INFINITY
    };
    let fall = if v3 > v2 {
        (v3 - value) / (v3 - v2)
    } else {
        f64::INFINITY
    };
    if value <= v0 || value >= v3 {
        return 0.0;
    }
    rise.min(fall).min(1.0)
}

/// Up to five materials that hand over to one another, some at once: shares sum to one in between.
fn chain(random: &mut Random) -> Vec<Material> {
    let mut at = random.unit() * 100.0 - 50.0;
    let mut handover = [at, at + random.unit() * 10.0];
    let count = 1 + random.below(5);
    let material = |i| {
        at = handover[1] + random.unit() * 20.0;
        let width = if random.below(3) == 0 {
            0.0
        } else {
            1.0 + random.unit() * 10.0
        };
        let next = [at, at + width];
        let trapezoid = [handover[0], handover[1], next[0], next[1]];
        handover = next;
        Material {
            name: format!("m{i}"),
            srgb: std::array::from_fn(|_| random.unit()),
            opacity: if random.below(4) == 0 {
                0.0
            } else {
                random.unit()
            },
            trapezoid,
        }
    };
    (0..count).map(material).collect()
}

#[test]
fn opacity_is_the_sum_of_shares_and_colour_their_mean_within_a_4096th() {
    let mut random = Random(11);
    let mut looked = 0;
    for _ in 0..200 {
        let materials = chain(&mut random);
        let function = TransferFunction::of_materials(&materials, None).expect("shares of one");
        let [first, last] = [
            materials[0].trapezoid[0],
            materials[materials.len() - 1].trapezoid[3],
        ];
        for _ in 0..100 {
            let value = first - 5.0 + random.unit() * (last - first + 10.0);
            let weight = |m: &Material| membership(m, value) * m.opacity;
            let opacity: f64 = materials.iter().map(weight).sum();
            let found = function.opacity(value);
            assert!(
                (found - opacity).abs() < 1e-12,
                "{value}: {found}, not {opacity}"
            );
            if opacity < 1e-9 {
                continue;
            }
            looked += 1;
            let srgb = function.srgb(value);
            for (c, found) in srgb.into_iter().enumerate() {
                let light: f64 = materials.iter().map(|m| weight(m) * m.srgb[c]).sum();
                let off = (found - light / opacity).abs();
                assert!(
                    off <= 1.0 / 4096.0 + 1e-12,
                    "{value}: colour is off by {off}"
                );
            }
        }
    }
    assert!(looked > 5_000, "only {looked} values are opaque");
}

#[test]
fn equally_opaque_materials_have_a_point_at_each_corner_and_no_more() {
    let material = |name: &str, srgb, trapezoid| Material {
        name: name.to_owned(),
        srgb,
        opacity: 0.5,
        trapezoid,
    };
    let materials = [
        material("fat", [1.0, 1.0, 0.0], [-150.0, -100.0, -50.0, 0.0]),
        material("muscle", [1.0, 0.0, 0.0], [-50.0, 0.0, 100.0, 150.0]),
    ];
    let function = TransferFunction::of_materials(&materials, Some(1.0)).expect("shares of one");
    let opacity: Vec<_> = function
        .opacity
        .iter()
        .map(|p| (p.value, p.opacity))
        .collect();
    assert_eq!(
        opacity,
        [
            (-150.0, 0.0),
            (-100.0, 0.5),
            (-50.0, 0.5),
            (0.0, 0.5),
            (100.0, 0.5),
            (150.0, 0.0)
        ]
    );
    assert_eq!(function.srgb(-25.0), [1.0, 0.5, 0.0]);
    assert_eq!(function.reference_length, Some(1.0));
}

#[test]
fn a_binary_material_begins_with_its_first_value_and_ends_before_its_last() {
    let text = br#"{"stratavox_transfer_function": 1, "materials": [
        {"name": "soft", "color": [1, 0, 0], "opacity": 0.25, "trapezoid": [0, 0, 5, 5]},
        {"name": "hard", "color": [0, 0, 1], "opacity": 1, "trapezoid": [5, 5, 9, 9]}]}"#;
    let function = transfer_function_from_json(text).expect("materials");
    for (value, opacity) in [
        (-1e-9, 0.0),
        (0.0, 0.25),
        (5.0 - 1e-9, 0.25),
        (5.0, 1.0),
        (9.0, 0.0),
    ] {
        assert_eq!(function.opacity(value), opacity, "at {value}");
    }
    assert_eq!(function.srgb(4.999), [1.0, 0.0, 0.0]);
    assert_eq!(function.srgb(5.0), [0.0, 0.0, 1.0]);
    let back = transfer_function_from_json(transfer_function_to_json(&function).as_bytes());
    assert_eq!(back.expect("what was written"), function);
}

const GOOD: &str = r#"{"stratavox_transfer_function": 1, "materials": [
    {"name": "a", "color": [1, 0, 0], "opacity": 0.5, "trapezoid": [0, 1, 2, 3]},
    {"name": "b", "color": [0, 1, 0], "opacity": 1, "trapezoid": [2, 3, 4, 4]}]}"#;

#[test]
fn wrong_fields_of_materials_are_named_with_what_was_wanted_and_found() {
    transfer_function_from_json(GOOD.as_bytes()).expect("a good one");
    for (from, to, field, found) in [
        (
            "[2, 3, 4, 4]",
            "[1, 3, 4, 4]",
            "`materials`",
            "1.5 at 2 (a, b)",
        ),
        (
            "[2, 3, 4, 4]",
            "[2, 3, 4]",
            "`materials[1].trapezoid`",
            "[2,3,4]",
        ),
        (
            "[2, 3, 4, 4]",
            "[2, 3, 1, 4]",
            "`materials[1].trapezoid`",
            "[2.0,3.0,1.0,4.0]",
        ),
        (
            "[2, 3, 4, 4]",
            "[2, 2, 2, 2]",
            "`materials[1].trapezoid`",
            "the last above the first",
        ),
        (
            "[2, 3, 4, 4]",
            "[2, null, 4, 4]",
            "`materials[1].trapezoid[1]`",
            "null",
        ),
        (
            "[0, 1, 0]",
            "[0, 2, 0]",
            "`materials[1].color[1]`",
            "found 2",
        ),
        (
            "\"opacity\": 1,",
            "\"opacity\": -1,",
            "`materials[1].opacity`",
            "found -1",
        ),
        (
            "\"opacity\": 1,",
            "",
            "`materials[1].opacity`",
            "no such key",
        ),
        (
            "\"name\": \"b\"",
            "\"name\": 7",
            "`materials[1].name`",
            "found 7",
        ),
        (
            "\"name\": \"b\"",
            "\"name\": \"b\", \"hue\": 3",
            "`materials[1].hue`",
            "found 3",
        ),
        (
            "\"materials\"",
            "\"color\": [[0,0,0,0]], \"materials\"",
            "`color`",
            "beside `materials`",
        ),
    ] {
        let text = GOOD.replacen(from, to, 1);
        assert_ne!(text, GOOD, "{from} is not there");
        let error = transfer_function_from_json(text.as_bytes()).expect_err(to);
        let said = error.to_string();
        assert!(matches!(error, FileProblem::Field { .. }), "{said}");
        assert!(said.contains(field) && said.contains(found), "{to}: {said}");
    }
}
