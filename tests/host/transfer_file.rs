//! Transfer functions in JSON.

#![cfg(feature = "json")]

#[allow(dead_code, reason = "each file of tests uses some of it")]
use crate::transfer_shared;

use stratavox::transfer::{
    ColorPoint, FileProblem, Interpolation, OpacityPoint, TransferFunction, read_transfer_function,
    transfer_function_from_json, transfer_function_to_json,
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
