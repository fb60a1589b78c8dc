//! Transfer functions in JSON.

#![cfg(feature = "json")]

#[allow(dead_code, reason = "each file of tests uses some of it")]
use crate::transfer_shared;

use stratavox::transfer::{
    ColorPoint, FileProblem, Interpolation, MediumPoint, OpacityPoint, Phase, TransferFunction,
    Window, read_transfer_function, transfer_function_from_json, transfer_function_to_json,
};
use transfer_shared::{Random, function};

#[test]
fn every_key_is_read() {
    let text = br#"{ "stratavox_transfer_function": 1,
        "color": [[-1000, 0, 0.25, 1], [400.5, 1, 1, 1]],
        "opacity": [[0, 0.5]],
        "reference_length": 0.75,
        "interpolation": "step" }"#;
    let wanted = TransferFunction {
        color: vec![
            ColorPoint {
                value: -1000.0,
                srgb: [0.0, 0.25, 1.0],
            },
            ColorPoint {
                value: 400.5,
                srgb: [1.0; 3],
            },
        ],
        opacity: vec![OpacityPoint {
            value: 0.0,
            opacity: 0.5,
        }],
        reference_length: Some(0.75),
        interpolation: Interpolation::Step,
        gradient_transfer: None,
        medium: None,
    };
    assert_eq!(transfer_function_from_json(text).unwrap(), wanted);
}

#[test]
fn left_out_keys_mean_linear_and_the_smallest_spacing() {
    let text = br#"{"stratavox_transfer_function":1,"color":[[0,0,0,0]],"opacity":[[0,1]]}"#;
    let function = transfer_function_from_json(text).unwrap();
    assert_eq!(function.interpolation, Interpolation::Linear);
    assert_eq!(function.reference_length, None);
}

#[test]
fn what_is_written_is_read_back_exactly() {
    let mut random = Random(3);
    for round in 0..300 {
        let mut tf = function(&mut random);
        if round % 3 == 0 {
            tf.reference_length = Some(random.unit() + 1e-300);
        }
        let text = transfer_function_to_json(&tf);
        let back = transfer_function_from_json(text.as_bytes());
        assert_eq!(back.unwrap(), tf, "{text}");
    }
}

#[test]
fn a_wrong_field_is_named_with_what_was_wanted_and_found() {
    let good = r#"{"stratavox_transfer_function":1,"color":[[0,0,0,0],[1,1,1,1]],"opacity":[[0,0],[1,1]]}"#;
    // (text to replace, by what, the field, what is said to be found)
    let cases = [
        (
            "function\":1",
            "function\":2",
            "`stratavox_transfer_function`",
            "found 2",
        ),
        (
            "function\":1",
            "function\":\"1\"",
            "`stratavox_transfer_function`",
            "found \"1\"",
        ),
        ("[1,1,1,1]", "[1,1,1]", "`color[1]`", "found [1,1,1]"),
        ("[1,1,1,1]", "[1,1,1.5,1]", "`color[1][2]`", "found 1.5"),
        ("[1,1,1,1]", "[1,1,null,1]", "`color[1][2]`", "found null"),
        ("[1,1,1,1]", "[-1,1,1,1]", "`color[1][0]`", "found -1"),
        ("[1,1,1,1]", "[1e39,1,1,1]", "`color[1][0]`", "found 1e+39"),
        ("[[0,0],[1,1]]", "[]", "`opacity`", "found []"),
        ("[[0,0],[1,1]]", "7", "`opacity`", "found 7"),
        (
            "[[0,0],[1,1]]",
            "[[0,-0.1]]",
            "`opacity[0][1]`",
            "found -0.1",
        ),
        (
            "\"opacity\"",
            "\"reference_length\":0,\"opacity\"",
            "`reference_length`",
            "found 0",
        ),
        (
            "\"opacity\"",
            "\"interpolation\":\"cubic\",\"opacity\"",
            "`interpolation`",
            "found \"cubic\"",
        ),
    ];
    for (from, to, field, found) in cases {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{from} is not there");
        let error = transfer_function_from_json(text.as_bytes()).unwrap_err();
        let said = error.to_string();
        assert!(matches!(error, FileProblem::Field { .. }), "{said}");
        assert!(said.contains(field) && said.contains(found), "{to}: {said}");
    }
}

const MEDIUM: &str = r#"{"stratavox_transfer_function":1,"color":[[0,0.5,0.5,0.5]],
    "extinction":[[0,0],[2,4,1,0.25],[3,1]],"albedo":[[0,0.25,1,0]],"emission":[[1,0,3,7]],"phase":{"f":0.5,"g1":0.9,"g2":-0.25}}"#;

#[test]
fn keys_of_a_medium_are_read_and_written() {
    let function = transfer_function_from_json(MEDIUM.as_bytes()).unwrap();
    let medium = function.medium.as_ref().expect("a medium");
    let point = |value, linear| MediumPoint { value, linear };
    let extinction = [
        point(0.0, [0.0; 3]),
        point(2.0, [4.0, 1.0, 0.25]),
        point(3.0, [1.0; 3]),
    ];
    assert_eq!(medium.extinction, extinction);
    assert!(medium.has_colored_extinction());
    assert_eq!(medium.albedo, [point(0.0, [0.25, 1.0, 0.0])]);
    assert_eq!(medium.emission, [point(1.0, [0.0, 3.0, 7.0])]);
    let g = [0.9, -0.25];
    assert_eq!(medium.phase, Some(Phase::TwoLobes { part: 0.5, g }));
    assert_eq!(medium.keys(), ["extinction", "albedo", "emission", "phase"]);
    let text = transfer_function_to_json(&function);
    assert_eq!(
        transfer_function_from_json(text.as_bytes()).unwrap(),
        function,
        "{text}"
    );
    for phase in ["\"rayleigh\"", "\"isotropic\"", "{\"g\":-0.5}"] {
        let text = MEDIUM.replace("{\"f\":0.5,\"g1\":0.9,\"g2\":-0.25}", phase);
        let function = transfer_function_from_json(text.as_bytes()).unwrap();
        let text = transfer_function_to_json(&function);
        assert_eq!(
            transfer_function_from_json(text.as_bytes()).unwrap(),
            function,
            "{text}"
        );
    }
}

/// The mean of the three over the reference length, which is the length behind which half is left where none is given.
#[test]
fn an_extinction_has_an_opacity() {
    let at = |function: &TransferFunction, value| {
        let length = function.reference_length.expect("one");
        -(-function.opacity(value)).ln_1p() / length
    };
    for text in [
        MEDIUM.to_owned(),
        MEDIUM.replace("\"emission\"", "\"reference_length\":2,\"emission\""),
    ] {
        let function = transfer_function_from_json(text.as_bytes()).unwrap();
        for (value, sigma) in [
            (0.0, 0.0),
            (1.0, 0.875),
            (2.0, 1.75),
            (2.5, 1.375),
            (4.0, 1.0),
        ] {
            let (found, length) = (at(&function, value), function.reference_length.unwrap());
            // Opacities are within 1/8192 of 1 - exp(-sigma d0).
            let bound = f64::exp(sigma * length) / length / 8192.0 + 1e-12;
            assert!(
                (found - sigma).abs() < bound,
                "{value}: {found}, wanted {sigma}"
            );
        }
    }
    let half = transfer_function_from_json(MEDIUM.as_bytes()).unwrap();
    assert!((half.opacity(2.0) - 0.5).abs() < 1e-12);
}

#[test]
fn a_wrong_medium_is_named() {
    for (from, to, field, found) in [
        (
            "[0,0.25,1,0]",
            "[0,0.25,1.5,0]",
            "albedo[0][2]",
            "albedo over 1 at value 0: light would grow",
        ),
        (
            "[2,4,1,0.25]",
            "[2,4,-1,0.25]",
            "extinction[1][2]",
            "found -1",
        ),
        (
            "[2,4,1,0.25]",
            "[2,4,1]",
            "extinction[1]",
            "[value, sigma] or [value, r, g, b]",
        ),
        ("[1,0,3,7]", "[1,7]", "emission[0]", "[value, r, g, b]"),
        (
            "[3,1]]",
            "[1,1]]",
            "extinction[2][0]",
            "a value not below the one before",
        ),
        ("0.9", "1", "phase.g1", "-0.99 to 0.99"),
        ("\"f\":0.5", "\"h\":0.5", "phase.f", "no such key"),
        (
            "{\"f\":0.5,\"g1\":0.9,\"g2\":-0.25}",
            "3",
            "phase",
            "\"rayleigh\"",
        ),
        (
            "\"albedo\"",
            "\"opacity\":[[0,1]],\"albedo\"",
            "opacity",
            "beside `extinction`",
        ),
        (
            "\"albedo\"",
            "\"gradient_opacity\":[[0,1]],\"albedo\"",
            "gradient_opacity",
            "beside `extinction`",
        ),
    ] {
        let text = MEDIUM.replacen(from, to, 1);
        assert_ne!(text, MEDIUM, "{from} is not there");
        let said = transfer_function_from_json(text.as_bytes())
            .unwrap_err()
            .to_string();
        assert!(
            said.contains(&format!("`{field}`")) && said.contains(found),
            "{to}: {said}"
        );
    }
}

/// Colours take the albedo along, opacity the rest.
#[test]
fn parts_of_a_function_take_their_part_of_a_medium() {
    let whole = transfer_function_from_json(MEDIUM.as_bytes()).unwrap();
    let plain = br#"{"stratavox_transfer_function":1,"color":[[0,0,0,0]],"opacity":[[0,1]]}"#;
    let plain = transfer_function_from_json(plain).unwrap();
    let keys = |function: TransferFunction| function.medium.map_or(Vec::new(), |m| m.keys());
    assert_eq!(keys(plain.with_color_of(&whole)), ["albedo"]);
    assert_eq!(
        keys(plain.with_opacity_of(&whole)),
        ["extinction", "emission", "phase"]
    );
    assert_eq!(
        keys(whole.with_color_of(&plain)),
        ["extinction", "emission", "phase"]
    );
    assert_eq!(keys(whole.with_opacity_of(&plain)), ["albedo"]);
    let spread = whole.spread_over(Window::new(10.0, 13.0).expect("a window"));
    let moved = spread.medium.expect("a medium").extinction;
    assert_eq!(
        moved.iter().map(|p| p.value).collect::<Vec<_>>(),
        [10.0, 12.0, 13.0]
    );
}

#[test]
fn unknown_doubled_and_missing_keys_are_refused_by_name() {
    let cases = [
        (
            r#"{"stratavox_transfer_function":1,"color":[[0,0,0,0]],"opacity":[[0,1]],"levoy":3}"#,
            "levoy",
        ),
        (
            r#"{"stratavox_transfer_function":1,"color":[[0,0,0,0]],"opacity":[[0,1]],"color":[]}"#,
            "color",
        ),
        (
            r#"{"stratavox_transfer_function":1,"color":[[0,0,0,0]]}"#,
            "opacity",
        ),
        (
            r#"{"color":[[0,0,0,0]],"opacity":[[0,1]]}"#,
            "stratavox_transfer_function",
        ),
        (r#"{"stratavox_transfer_function":1,"#, "line 1"),
        ("", "EOF"),
    ];
    for (text, word) in cases {
        let error = transfer_function_from_json(text.as_bytes()).unwrap_err();
        assert!(matches!(error, FileProblem::Json(_)), "{error}");
        assert!(error.to_string().contains(word), "{text}: {error}");
    }
}

#[test]
fn a_long_field_is_shown_by_its_beginning() {
    let long = "x".repeat(100_000);
    let text = format!(
        r#"{{"stratavox_transfer_function":1,"color":[[0,0,0,0]],"opacity":[["{long}",1]]}}"#
    );
    let said = transfer_function_from_json(text.as_bytes())
        .unwrap_err()
        .to_string();
    assert!(said.contains("opacity[0][0]") && said.len() < 200, "{said}");
}

#[test]
fn too_many_points_and_too_long_files_are_refused() {
    let points = vec!["[0,1]"; 4097].join(",");
    let text =
        format!(r#"{{"stratavox_transfer_function":1,"color":[[0,0,0,0]],"opacity":[{points}]}}"#);
    let said = transfer_function_from_json(text.as_bytes())
        .unwrap_err()
        .to_string();
    assert!(said.contains("at most 4096 points, found 4097"), "{said}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.json");
    std::fs::write(&path, vec![b' '; (1 << 20) + 1]).unwrap();
    let error = read_transfer_function(&path).unwrap_err();
    assert!(matches!(error.problem, FileProblem::TooLong), "{error}");
}

#[test]
fn errors_name_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("nowhere.json");
    let error = read_transfer_function(&missing).unwrap_err();
    assert!(matches!(error.problem, FileProblem::Io(_)));
    assert!(error.to_string().contains("nowhere.json"), "{error}");
    let there = folder.path().join("tf.json");
    let tf = function(&mut Random(9));
    std::fs::write(&there, transfer_function_to_json(&tf)).unwrap();
    assert_eq!(read_transfer_function(&there).unwrap(), tf);
}
