//! Transfer functions of other programs: the files of `fixtures/transfer`, held against what VTK makes of them
//! (`make.py` there) or against numbers worked out by hand; and files that must be refused.
#![cfg(all(feature = "json", feature = "files"))]

use serde_json::Value;
use std::{fs, path::PathBuf};
use stratavox::{
    picture::ColorSpace,
    transfer::{
        Absorption, FileProblem, Imported, Interpolation, Points, Scale, classify_by_points,
        import_transfer_function, transfer_function_from_bytes,
    },
};

fn path(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/transfer");
    folder.join(name)
}

fn read(name: &str) -> Imported {
    import_transfer_function(&path(name), None).unwrap_or_else(|error| panic!("{error}"))
}

fn at(found: &Imported, value: f64) -> [f64; 4] {
    let points = Points::new(&found.function, Absorption::Opacity, ColorSpace::Display);
    classify_by_points(&points, value)
}

#[track_caller]
fn assert_at(found: &Imported, value: f64, wanted: [f64; 4]) {
    let is = at(found, value);
    let off = (0..4)
        .map(|k| (is[k] - wanted[k]).abs())
        .fold(0.0, f64::max);
    assert!(off < 1e-6, "at {value}: {is:?}, not {wanted:?}");
}

#[test]
fn colours_and_opacities_are_those_that_vtk_computes() {
    let text = fs::read_to_string(path("expected.json")).expect("the table");
    let expected: Value = serde_json::from_str(&text).expect("JSON");
    let expected = expected.as_object().expect("an object");
    assert!(expected.len() >= 9, "{} files", expected.len());
    for (name, rows) in expected {
        let found = read(name);
        let mut worst = (0.0, 0.0);
        for row in rows.as_array().expect("rows") {
            let row: Vec<f64> = row
                .as_array()
                .expect("a row")
                .iter()
                .map(|n| n.as_f64().expect("a number"))
                .collect();
            // A fraction where the file has fractions; at a step either side is right.
            let sides = [
                row[0] - 1e-7 * row[0].abs(),
                row[0],
                row[0] + 1e-7 * row[0].abs(),
            ];
            let off = sides.map(|value| {
                let is = at(&found, value);
                (0..4)
                    .map(|k| (is[k] - row[k + 1]).abs())
                    .fold(0.0, f64::max)
            });
            let off = off.into_iter().fold(f64::INFINITY, f64::min);
            if off > worst.0 {
                worst = (off, row[0]);
            }
        }
        println!("{name}: off by at most {:.6} of 1", worst.0);
        // Half a code of eight bits; straight functions are exact but for the seven digits of the table.
        let is_straight = ["paraview-step.json", "slicer.vp"].contains(&name.as_str());
        let allowed = if is_straight { 1e-6 } else { 0.5 / 255.0 };
        assert!(
            worst.0 < allowed,
            "{name}: off by {} at {}",
            worst.0,
            worst.1
        );
    }
}

#[test]
fn a_slicer_property_keeps_its_unit_distance_and_says_what_is_left_out() {
    let found = read("slicer.vp.json");
    assert_eq!(found.function.reference_length, Some(0.75));
    assert_eq!(found.scale, Scale::Values);
    let left = found.left_out.join("; ");
    assert!(
        left.contains("gradient") && left.contains("light"),
        "{left}"
    );
    let found = read("slicer.vp");
    assert_eq!(found.function.reference_length, Some(1.0));
    assert_eq!(found.left_out, ["the light: ambient, diffuse and specular"]);
}

#[test]
fn one_of_several_functions_in_a_scene_is_taken_by_name() {
    let error = import_transfer_function(&path("slicer.mrml"), None).expect_err("two");
    let text = error.problem.to_string();
    assert!(text.contains("Own-Bone, Own-Air"), "{text}");
    let found = import_transfer_function(&path("slicer.mrml"), Some("Own-Air")).expect("one");
    assert_eq!(found.name.as_deref(), Some("Own-Air"));
    assert!(found.left_out.is_empty(), "{:?}", found.left_out);
    assert_at(&found, -750.0, [0.5, 0.0, 0.5, 0.0625]);
    let bone = import_transfer_function(&path("slicer.mrml"), Some("Own-Bone")).expect("one");
    assert_eq!(bone.left_out.len(), 2, "{:?}", bone.left_out);
    let error = import_transfer_function(&path("slicer.mrml"), Some("Skin")).expect_err("none");
    assert!(error.problem.to_string().contains("\"Skin\""), "{error}");
}

#[test]
fn an_inviwo_function_stands_at_fractions_and_is_transparent_outside_its_mask() {
    let found = read("inviwo.itf");
    assert_eq!(found.scale, Scale::Fractions);
    assert_at(&found, 0.249, [0.249, 0.3745, 0.5, 0.0]);
    assert_at(&found, 0.25, [0.25, 0.375, 0.5, 0.625]);
    assert_at(&found, 0.5, [0.5, 0.5, 0.5, 0.75]);
    assert_at(&found, 1.0, [1.0, 0.75, 0.5, 1.0]);
}

#[test]
fn a_voreen_function_stands_in_its_domain_and_jumps_where_a_key_is_split() {
    let found = read("voreen.tfi");
    assert_eq!(found.scale, Scale::Values);
    assert_eq!(found.left_out, ["the gamma value"]);
    assert_at(&found, -100.0, [0.0, 0.2, 1.0, 0.0]);
    assert_at(&found, 0.0, [0.1, 0.3, 0.8, 0.1]);
    // Intensity 1/2 of -100 to 300.
    assert_at(&found, 100.0 - 1e-6, [0.2, 0.4, 0.6, 0.2]);
    assert_at(&found, 100.0, [1.0, 0.0, 0.0, 0.8]);
    assert_at(&found, 300.0, [1.0; 4]);
}

#[test]
fn a_vapor_function_mixes_hues_by_the_shorter_way_and_scales_opacity() {
    let found = read("vapor.tf3");
    // -20 to 80, opacity 1/2 at a quarter of the way and halved by the scale; hue 0.9 to 0.1 through red, saturation
    // and value full.
    assert_at(&found, -20.0, [1.0, 0.0, 0.6, 0.0]);
    assert_at(&found, 5.0, [1.0, 0.0, 0.0, 0.25]);
    assert_at(&found, 30.0, [1.0, 0.6, 0.0, 1.0 / 3.0]);
    assert_at(&found, 80.0, [0.5, 0.5, 0.5, 0.5]);
}

#[test]
fn paraviews_older_xml_and_rows_of_a_script_are_read() {
    let found = read("paraview-old.xml");
    assert_eq!(
        (found.name.as_deref(), found.scale),
        (Some("Own old"), Scale::Values)
    );
    assert_at(&found, 1.0, [0.5, 0.25, 0.125, 0.25]);
    let found = read("rows.csv");
    assert_at(&found, 0.0, [0.5, 0.5, 0.5, 0.0625]);
    assert_eq!(found.function.interpolation, Interpolation::Linear);
    // Colours alone and opacities alone are filled up, and codes of 8 bits are told by their size.
    let found = transfer_function_from_bytes(b"0 0 0 0\n10 255 51 0\n", None).expect("colours");
    assert_at(&found, 10.0, [1.0, 0.2, 0.0, 0.05]);
    assert_eq!(found.left_out.len(), 2, "{:?}", found.left_out);
    let found = transfer_function_from_bytes(b"0 0\n10 0.5\n", None).expect("opacities");
    assert_at(&found, 5.0, [0.5, 0.5, 0.5, 0.25]);
}

#[test]
fn our_own_file_is_read_as_it_stands() {
    let text = br#"{"stratavox_transfer_function":1,"color":[[0,1,0,0]],"opacity":[[0,0],[9,1]],"interpolation":"step"}"#;
    let found = transfer_function_from_bytes(text, None).expect("ours");
    assert_eq!(found.function.interpolation, Interpolation::Step);
    assert!(found.left_out.is_empty() && found.name.is_none());
}

#[track_caller]
fn assert_refused(text: &str, words: &[&str]) {
    let error = match transfer_function_from_bytes(text.as_bytes(), None) {
        Err(error) => error.to_string(),
        Ok(found) => panic!("taken as {}", found.origin),
    };
    for word in words {
        assert!(error.contains(word), "no {word:?} in {error:?}");
    }
}

#[test]
fn what_cannot_be_taken_over_is_refused_by_name() {
    let vp = fs::read_to_string(path("slicer.vp")).expect("text");
    assert_refused(
        &vp.replace("8 -1000", "9 -1000"),
        &["scalar opacity promises 9", "8 follow"],
    );
    assert_refused(&vp.replace("0.25 1800", "nan 1800"), &["opacity is NaN"]);
    assert_refused(
        &vp.replace("0.25 1800", "x 1800"),
        &["scalar opacity", "\"x\""],
    );
    let paraview = fs::read_to_string(path("paraview-lab.json")).expect("text");
    assert_refused(
        &paraview.replace("\"Lab\"", "\"Lab/CIEDE2000\""),
        &["Lab/CIEDE2000"],
    );
    assert_refused(
        &paraview.replace("\"RGBPoints\"", "\"RGB\""),
        &["has no `RGBPoints`"],
    );
    assert_refused(r#"[{"IndexedColors":[1,0,0]}]"#, &["categories"]);
    assert_refused(r#"{"volumeProperties":[]}"#, &["empty"]);
    let vapor = fs::read_to_string(path("vapor.tf3")).expect("text");
    assert_refused(
        &vapor.replace("<Type Type=\"Long\">\n  0", "<Type Type=\"Long\">\n  1"),
        &["bell"],
    );
    assert_refused(
        &vapor.replace("-20 80", "80 -20"),
        &["DataBounds", "[80.0, -20.0]"],
    );
    let voreen = fs::read_to_string(path("voreen.tfi")).expect("text");
    assert_refused(&voreen.replace("Keys", "Primitives"), &["no `Keys`"]);
    assert_refused(
        "<Scene><Light/></Scene>",
        &["XML that begins with `Scene`", "Inviwo"],
    );
    assert_refused("what is this\nno numbers", &["line 2"]);
    assert_refused("", &["without a row"]);
    assert_refused("1e999 0.5\n", &["stands at inf"]);
    assert_refused(r#"{"color":[[0,0,0,0]]}"#, &["stratavox_transfer_function"]);
}

#[test]
fn xml_with_a_document_type_too_deep_or_unclosed_is_refused() {
    let bomb = "<?xml version=\"1.0\"?><!DOCTYPE a [<!ENTITY b \"bbbb\"><!ENTITY c \"&b;&b;\">]><MRML>&c;</MRML>";
    assert_refused(bomb, &["document type"]);
    let deep = "<a>".repeat(200) + &"</a>".repeat(200);
    assert_refused(&deep, &["levels"]);
    assert_refused(&"<a>".repeat(20), &["closed"]);
    assert_refused("<a/><b/>", &["one element"]);
    assert_refused("<a></b></a>", &["XML"]);
    let long = vec![b' '; 2 << 20];
    let found = transfer_function_from_bytes(&long, None);
    assert!(matches!(found, Err(FileProblem::TooLong)), "{found:?}");
}

/// A damaged file is refused or gives a function that can be drawn: points in order, numbers in range.
#[test]
fn damaged_files_never_panic_and_never_give_a_wrong_function() {
    const MUTATIONS: u64 = 20_000;
    let names = [
        "slicer.vp",
        "slicer.vp.json",
        "slicer.mrml",
        "paraview-hsvwrap.json",
        "paraview-grey.json",
        "paraview-old.xml",
        "inviwo.itf",
        "voreen.tfi",
        "vapor.tf3",
        "rows.csv",
    ];
    let files: Vec<Vec<u8>> = names
        .iter()
        .map(|name| fs::read(path(name)).expect("a file"))
        .collect();
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = |below: usize| {
        // xorshift64 (Marsaglia 2003).
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    let (mut taken, mut refused) = (0, 0);
    for tried in 0..MUTATIONS {
        let mut bytes = files[tried as usize % files.len()].clone();
        for _ in 0..=random(3) {
            let place = random(bytes.len());
            match random(6) {
                0 => bytes[place] = random(256) as u8,
                1 => bytes[place] ^= 1 << random(8),
                2 => bytes.truncate(place.max(1)),
                3 => drop(bytes.splice(place..place, *b"-1e308")),
                4 => drop(bytes.splice(place..(place + random(40)).min(bytes.len()), [])),
                _ => {
                    let copy = bytes[place..(place + random(60)).min(bytes.len())].to_vec();
                    drop(bytes.splice(place..place, copy));
                }
            }
            if bytes.is_empty() {
                bytes.push(b'0');
            }
        }
        match transfer_function_from_bytes(&bytes, None) {
            Err(_) => refused += 1,
            Ok(found) => {
                taken += 1;
                let function = found.function;
                assert!(!function.color.is_empty() && !function.opacity.is_empty());
                assert!(function.color.is_sorted_by(|a, b| a.value <= b.value));
                assert!(function.opacity.is_sorted_by(|a, b| a.value <= b.value));
                let shares = function.color.iter().flat_map(|p| p.srgb);
                let mut shares = shares.chain(function.opacity.iter().map(|p| p.opacity));
                assert!(shares.all(|share| (0.0..=1.0).contains(&share)));
                let mut values = function.opacity.iter().map(|p| p.value);
                assert!(values.all(|value| value.abs() <= f64::from(f32::MAX)));
            }
        }
    }
    println!("{MUTATIONS} damaged files: {taken} taken, {refused} refused");
    assert!(
        taken > 1000 && refused > 1000,
        "{taken} taken, {refused} refused"
    );
}
