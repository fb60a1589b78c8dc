//! `histogram`: figures that can be read, numbers that add up.

use crate::person::{Folder, assert_begins};
use serde_json::Value;
use std::fs;

fn json(folder: &Folder, name: &str) -> Value {
    let text = fs::read_to_string(folder.path(name)).expect("a file");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn sum(value: &Value) -> u64 {
    match value {
        Value::Array(list) => list.iter().map(sum).sum(),
        number => number.as_u64().expect("a count"),
    }
}

#[test]
fn the_counts_of_both_kinds_are_as_many_as_there_are_voxels() {
    let folder = Folder::new();
    folder
        .run("histogram phantom:gauss,n=12 -o a.json --bins 10")
        .assert_done();
    let found = json(&folder, "a.json");
    assert_eq!(found["stratavox_histogram"], 1);
    assert_eq!(
        (sum(&found["counts"]), &found["voxels"]),
        (1728, &1728.into())
    );
    assert_eq!(found["edges"].as_array().map(Vec::len), Some(11), "{found}");
    assert_eq!(
        found["transfer_function"]["stratavox_transfer_function"], 1,
        "{found}"
    );
    folder
        .run("histogram phantom:gauss,n=12 -o b.json --joint --bins 10")
        .assert_done();
    let found = json(&folder, "b.json");
    assert_eq!(found["stratavox_joint_histogram"], 1);
    assert_eq!(sum(&found["counts"]), 1728);
    let rows = found["counts"].as_array().expect("rows").len();
    assert_eq!(
        found["gradient_edges"].as_array().map(Vec::len),
        Some(rows + 1)
    );
}

/// Two voxels of 1, one of 3, one without data: to the letter, as every run writes it.
#[test]
fn a_small_histogram_is_the_same_text_every_time() {
    let folder = Folder::new();
    let bytes: Vec<u8> = [1.0_f32, 1.0, 3.0, f32::NAN]
        .iter()
        .flat_map(|n| n.to_le_bytes())
        .collect();
    folder.file("a<b>&.bin", bytes);
    let words = "histogram a<b>&.bin --raw 2x2x1,f32 --preset grey";
    folder.run(&format!("{words} -o a.svg")).assert_done();
    folder.run(&format!("{words} -o b.svg")).assert_done();
    let text = fs::read_to_string(folder.path("a.svg")).expect("text");
    assert_eq!(
        text,
        fs::read_to_string(folder.path("b.svg")).expect("text")
    );
    for piece in [
        "<title>Histogram of a&lt;b&gt;&amp;.bin</title>",
        ">2 × 2 × 1 = 4 voxels, 1 without data</text>",
        ">opacity per smallest voxel spacing</text>",
        ">voxels</text>",
        ">value</text>",
        // Bins of one code around 1, 2 and 3 over 0.5 to 3.5, the middle one empty.
        "<polygon points=\"84,486 84,",
        " 866,486\" fill=\"#94aacc\"/>",
    ] {
        assert!(text.contains(piece), "no {piece:?} in {text}");
    }
    folder.run(&format!("{words} -o a.json")).assert_done();
    let found = json(&folder, "a.json");
    assert_eq!(found["edges"], serde_json::json!([0.5, 1.5, 2.5, 3.5]));
    assert_eq!(found["counts"], serde_json::json!([2, 0, 1]));
    assert_eq!(found["no_data"], 1);
}

/// Tags close in the order they opened, and attributes are quoted: a reader of XML is content.
#[test]
fn both_figures_are_valid_xml_with_their_unit() {
    let folder = Folder::new();
    for (words, name) in [("", "a.svg"), ("--joint", "b.svg")] {
        folder
            .run(&format!("histogram phantom:head,n=16 {words} -o {name}"))
            .assert_done();
        let text = fs::read_to_string(folder.path(name)).expect("text");
        let mut reader = quick_xml::Reader::from_str(&text);
        let (mut count, mut images) = (0, 0);
        loop {
            match reader
                .read_event()
                .unwrap_or_else(|error| panic!("{name}: {error}"))
            {
                quick_xml::events::Event::Eof => break,
                quick_xml::events::Event::Empty(tag) => {
                    for attribute in tag.attributes() {
                        attribute.unwrap_or_else(|error| panic!("{name}: {error}"));
                    }
                    images += u32::from(tag.name().0 == "image");
                }
                _ => {}
            }
            count += 1;
        }
        assert!(count > 50, "{name}: {count} events");
        assert_eq!(images, if words.is_empty() { 1 } else { 2 }, "{name}");
        assert!(text.contains("value (HU)"), "{name}: no unit");
    }
}

#[test]
fn a_png_shows_the_function_that_the_flags_choose() {
    let folder = Folder::new();
    let words = "histogram phantom:gauss,n=12";
    for (flags, name) in [
        ("", "a"),
        ("--preset grey", "b"),
        ("--preset grey --window 0.2,0.4", "c"),
        ("--joint", "d"),
    ] {
        folder
            .run(&format!("{words} {flags} -o {name}.png"))
            .assert_done();
        assert_begins(&folder.path(&format!("{name}.png")), b"\x89PNG");
    }
    for pair in ["a.png b.png", "b.png c.png", "c.png d.png"] {
        folder
            .run(&format!("compare {pair} --at-most 0"))
            .assert_refused(1, &["off by"]);
    }
    folder.run(&format!("{words} -o e.png")).assert_done();
    folder.run("compare a.png e.png --at-most 0").assert_done();
}

#[test]
fn a_figure_that_exists_is_kept_and_an_input_is_no_output() {
    let folder = Folder::new();
    folder.file("a.svg", "mine");
    folder
        .run("histogram phantom:fog,n=8 -o a.svg")
        .assert_refused(4, &["a.svg", "--force"]);
    assert_eq!(fs::read(folder.path("a.svg")).expect("a file"), b"mine");
    folder
        .run("histogram nowhere.nrrd -o no/a.svg")
        .assert_refused(4, &["there is no folder"]);
    folder.file("b.json", [0; 8]);
    folder
        .run("histogram b.json --raw 2x2x2,u8 -o b.json --force")
        .assert_refused(4, &["it is an input"]);
    folder
        .run("histogram nowhere.nrrd -o b.svg")
        .assert_refused(3, &["nowhere.nrrd"]);
    assert_eq!(folder.names(), ["a.svg", "b.json"]);
}

#[cfg(unix)]
#[test]
fn a_file_size_limit_exits_4_and_leaves_no_half_figure() {
    let folder = Folder::new();
    let program = env!("CARGO_BIN_EXE_stratavox");
    for name in ["a.svg", "a.png", "a.json"] {
        let out = folder.path(name);
        let script = format!(
            "ulimit -f 1; exec {program} histogram phantom:gauss,n=16 -o {}",
            out.display()
        );
        let output = std::process::Command::new("sh")
            .args(["-c", &script])
            .output();
        let output = output.expect("a shell");
        assert_eq!(output.status.code(), Some(4), "{name}: {output:?}");
        assert!(folder.names().is_empty(), "{:?}", folder.names());
    }
}

#[test]
fn a_volume_without_change_or_without_data_has_a_figure_too() {
    let folder = Folder::new();
    folder.file("flat.bin", [7; 8]);
    folder.file("none.bin", f32::NAN.to_le_bytes().repeat(8));
    for (name, layout) in [("flat.bin", "2x2x2,u8"), ("none.bin", "2x2x2,f32")] {
        for (flags, out) in [
            ("", "a.svg"),
            ("", "a.png"),
            ("", "a.json"),
            ("--joint", "b.svg"),
            ("--joint", "b.png"),
            ("--joint", "b.json"),
        ] {
            let words = format!("histogram {name} --raw {layout} {flags} -o {out} --force");
            folder.run(&words).assert_done();
        }
        let text = fs::read_to_string(folder.path("a.svg")).expect("text");
        assert!(
            !text.contains("NaN") && !text.contains("inf"),
            "{name}: {text}"
        );
        let text = fs::read_to_string(folder.path("b.svg")).expect("text");
        assert!(
            !text.contains("NaN") && !text.contains("inf"),
            "{name}: {text}"
        );
    }
}

#[test]
fn vectors_are_counted_by_their_length_as_they_are_drawn() {
    let folder = Folder::new();
    let header = "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 3 2 2 2\nkinds: vector domain domain domain\n\
                  encoding: raw\n\n";
    // 3, 4, 12: of length 13.
    let voxels = (0..8).flat_map(|i| [3 * i, 4 * i, 12 * i]).collect();
    folder.file("flow.nrrd", [header.as_bytes().to_vec(), voxels].concat());
    for words in ["-o a.json", "--component magnitude -o b.json"] {
        let ran = folder.run(&format!("histogram flow.nrrd {words}"));
        ran.assert_done();
    }
    let read = |name: &str| fs::read_to_string(folder.path(name)).expect("a file");
    assert_eq!(read("a.json"), read("b.json"));
}

#[test]
fn the_widgets_of_a_function_are_lines_over_the_joint_histogram() {
    let folder = Folder::new();
    let tf = r#"{"stratavox_transfer_function": 1, "steepest": 0.5, "widgets": [
        {"shape": "rectangle", "values": [0.2, 0.4], "gradients": [0, 0.1], "opacity": 1, "color": [1, 0, 0]},
        {"shape": "contour", "value": 0.5, "half_width": 2, "opacity": 1, "color": [0, 0, 1]}]}"#;
    folder.file("tf.json", tf);
    let words = "histogram phantom:gauss,n=12 --joint";
    for name in ["a.json", "a.svg", "a.png"] {
        let ran = folder.run(&format!("{words} --tf tf.json -o {name}"));
        ran.assert_done();
    }
    let found = json(&folder, "a.json");
    let outlines = found["outlines"].as_array().expect("outlines");
    assert_eq!(outlines.len(), 2, "{found}");
    assert_eq!(outlines[0]["shape"], "rectangle");
    // Gradients are fractions of the steepest.
    let lines = serde_json::json!([[[0.2, 0.0], [0.4, 0.0], [0.4, 0.05], [0.2, 0.05], [0.2, 0.0]]]);
    assert_eq!(outlines[0]["lines"], lines);
    assert_eq!(outlines[1]["lines"][0][1], serde_json::json!([0.5, 0.0]));
    assert_eq!(found["transfer_function"]["steepest"], 0.5);
    let svg = fs::read_to_string(folder.path("a.svg")).expect("text");
    assert!(
        svg.contains("#ff0000") && svg.contains("#0000ff"),
        "no lines in their colours"
    );
    folder.run(&format!("{words} -o b.svg")).assert_done();
    let plain = fs::read_to_string(folder.path("b.svg")).expect("text");
    assert!(!plain.contains("#ff0000"));
}
