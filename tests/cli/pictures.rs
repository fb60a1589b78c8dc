//! Pictures from words: what is written, that a scene file gives the same one again, that flags do what they
//! say. Drawn by the CPU references on the CPU, so that no device is needed.

use crate::person::{Folder, assert_begins};
use serde_json::Value;
use std::fs;

const SMALL: &str = "--size 24x16 --device reference";

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn each_kind_of_picture_is_written_with_its_own_first_bytes() {
    let folder = Folder::new();
    for (name, begins) in [
        ("a.png", &b"\x89PNG"[..]),
        ("a.exr", &b"\x76\x2f\x31\x01"[..]),
        ("a.npy", &b"\x93NUMPY"[..]),
    ] {
        folder
            .run(&format!("render phantom:fog,n=8 -o {name} {SMALL}"))
            .assert_done();
        assert_begins(&folder.path(name), begins);
    }
}

#[test]
fn layers_go_beside_an_array_under_their_names() {
    let folder = Folder::new();
    let words =
        format!("render phantom:gauss,n=8 -o a.npy --mode mip --aov value,depth,samples {SMALL}");
    folder.run(&words).assert_done();
    assert_eq!(
        folder.names(),
        ["a.depth.npy", "a.npy", "a.samples.npy", "a.value.npy"]
    );
    // Each is a picture that `compare` reads: 24 x 16 numbers of 4 bytes and a header.
    let bytes = fs::read(folder.path("a.value.npy")).expect("a file").len();
    assert!(
        bytes > 24 * 16 * 4 && bytes < 24 * 16 * 4 + 200,
        "{bytes} bytes"
    );
}

#[test]
fn a_noise_filter_changes_the_picture_and_is_kept_in_a_scene() {
    let folder = Folder::new();
    let draw = |words: &str, out: &str| {
        folder
            .run(&format!("render {words} -o {out} --mode mip {SMALL}"))
            .assert_done();
        fs::read(folder.path(out)).expect("a picture")
    };
    let plain = draw("phantom:head,n=12", "plain.npy");
    let saved = draw(
        "phantom:head,n=12 --denoise gaussian:1.5 --save-scene s.json",
        "a.npy",
    );
    assert!(plain != saved, "the filter changes nothing");
    assert!(draw("--scene s.json", "b.npy") == saved, "another picture");
    folder
        .run("render phantom:head,n=8 -o c.png --denoise blur")
        .assert_refused(2, &["gaussian[:SIGMA]"]);
}

#[test]
fn a_layer_that_a_mode_does_not_have_is_a_usage_error() {
    let folder = Folder::new();
    let words = format!("render phantom:fog,n=8 -o a.npy --aov value {SMALL}");
    folder
        .run(&words)
        .assert_refused(2, &["--aov value needs", "--mode mip"]);
}

#[test]
fn a_saved_scene_draws_the_same_picture_and_flags_win_over_it() {
    let folder = Folder::new();
    folder.file(
        "tf.json",
        r#"{"stratavox_transfer_function":1,"color":[[0,0.1,0.2,0.3],[1,0.9,0.8,0.7]],"opacity":[[0,0],[1,0.3]]}"#,
    );
    let words = "render phantom:gauss,n=12 --tf tf.json --azimuth 33.3 --elevation 0.1 --zoom 1.1 \
        --projection orthographic --samples-per-voxel 0.7 --clip 1,0.5,0.25,-3 --background 0.1,0.2,0.3 --aa 4";
    folder
        .run(&format!("{words} -o a.png --save-scene s.json {SMALL}"))
        .assert_done();
    fs::remove_file(folder.path("tf.json")).expect("the file is there");

    folder.run("render --scene s.json -o b.png").assert_done();
    let compared = folder.run("compare a.png b.png --at-most 0 --json");
    compared.assert_done();
    assert_eq!(json(&compared.out)["max"], 0.0, "{compared:?}");
    let same = fs::read(folder.path("a.png")).ok() == fs::read(folder.path("b.png")).ok();
    assert!(same, "the bytes differ");

    folder
        .run("render --scene s.json -o c.png --zoom 2")
        .assert_done();
    let compared = folder.run("compare a.png c.png --at-most 0");
    compared.assert_refused(1, &["off by"]);
}

#[test]
fn timings_have_a_frame_for_each_repeat() {
    let folder = Folder::new();
    let words = format!("render phantom:fog,n=8 -o a.npy --repeat 3 --timings t.json {SMALL}");
    folder.run(&words).assert_done();
    let timings = json(&fs::read_to_string(folder.path("t.json")).expect("a file"));
    assert_eq!(
        timings["frames"].as_array().map(Vec::len),
        Some(3),
        "{timings}"
    );
    assert!(timings["samples"].as_u64() > Some(0), "{timings}");
    assert!(
        timings["device"]
            .as_str()
            .is_some_and(|name| name.contains("reference")),
        "{timings}"
    );
}

#[test]
fn timings_say_how_large_the_intermediate_image_and_splats_were() {
    let folder = Folder::new();
    let timed = |words: &str| {
        let all = "render phantom:fog,n=8 --look plain -o a.npy --force --timings t.json";
        folder.run(&format!("{all} {words} {SMALL}")).assert_done();
        json(&fs::read_to_string(folder.path("t.json")).expect("a file"))
    };
    let rays = timed("");
    assert!(rays["intermediate"].is_null() && rays["splat"].is_null());
    let width = |q: &str| {
        let of = timed(&format!("--technique shear-warp --intermediate {q}"));
        assert_eq!(of["intermediate"]["per_voxel"].to_string(), q);
        let extent = &of["intermediate"]["extent_base_pixels"];
        extent[0].as_f64().expect("a width")
    };
    // Two base pixels a voxel are twice as many, but for the margin of two at each end.
    let (once, twice) = (width("1.0"), width("2.0"));
    assert!(
        (twice - 4.0 - 2.0 * (once - 4.0)).abs() <= 4.0,
        "{once}, {twice}"
    );
    let image = timed("--technique splat --splat-std 0.7");
    assert_eq!(image["splat"]["std_voxels"], 0.7);
    assert!(
        image["splat"]["open_sheets"].as_f64() > Some(5.0),
        "{image}"
    );
    let axis = timed("--technique splat --sheets axis");
    assert!(axis["splat"]["open_sheets"].is_null(), "{axis}");
}

#[test]
fn progress_as_json_is_one_object_a_line() {
    let folder = Folder::new();
    let ran = folder.run(&format!(
        "render phantom:fog,n=8 --look plain -o a.png --progress json --repeat 2 {SMALL}"
    ));
    ran.assert_done();
    let stages: Vec<String> = ran
        .err
        .lines()
        .map(|line| match json(line) {
            line if line["device"].is_string() => "a device".to_owned(),
            line => line["stage"].to_string(),
        })
        .collect();
    assert_eq!(
        stages,
        [
            "\"prepare\"",
            "\"read\"",
            "a device",
            "\"prepare\"",
            "\"draw\"",
            "\"draw\"",
            "\"write\""
        ]
    );
}

#[test]
fn an_empty_picture_is_written_and_its_reason_said() {
    let folder = Folder::new();
    for (at, (words, reason)) in [
        (
            "--eye 0,0,9000 --target 0,0,9999 --up 0,1,0",
            "camera sees no volume",
        ),
        ("--clip 1,0,0,100000", "cut away"),
        ("--crop 900,901,900,901,900,901", "cut away"),
        (
            "--preset grey --window 1000000,2000000",
            "covers no value of this volume",
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let ran = folder.run(&format!(
            "render phantom:gauss,n=8 -o {at}.png {words} {SMALL}"
        ));
        ran.assert_done();
        assert!(
            ran.err.contains("the picture is empty") && ran.err.contains(reason),
            "{words}: {ran:#?}"
        );
        assert_begins(&folder.path(&format!("{at}.png")), b"\x89PNG");
    }
    let ran = folder.run(&format!(
        "render phantom:gauss,n=8 --look plain -o full.png {SMALL}"
    ));
    ran.assert_done();
    assert!(ran.err.is_empty(), "{ran:#?}");
}

#[test]
fn compare_says_how_far_and_fails_over_its_limit() {
    let folder = Folder::new();
    for (name, preset) in [("a.png", "grey"), ("b.png", "mri")] {
        folder
            .run(&format!(
                "render phantom:gauss,n=8 --preset {preset} -o {name} {SMALL}"
            ))
            .assert_done();
    }
    let same = folder.run("compare a.png a.png --json --at-most 0");
    same.assert_done();
    let same = json(&same.out);
    assert_eq!(
        (&same["max"], &same["rmse"]),
        (&0.0.into(), &0.0.into()),
        "{same}"
    );
    assert!(same["psnr"].is_null(), "{same}");

    let apart = folder.run("compare a.png b.png --diff d.png --json");
    apart.assert_done();
    assert_begins(&folder.path("d.png"), b"\x89PNG");
    assert!(json(&apart.out)["max"].as_f64() > Some(0.0), "{apart:?}");
    folder
        .run("compare a.png b.png --at-most 0")
        .assert_refused(1, &["a.png", "b.png", "off by"]);

    folder
        .run("render phantom:gauss,n=8 -o c.png --size 8x8 --device reference")
        .assert_done();
    folder
        .run("compare a.png c.png")
        .assert_refused(1, &["24x16", "8x8"]);
}

#[test]
fn bench_over_cameras_gives_a_frame_for_each_view() {
    let folder = Folder::new();
    folder.file(
        "views.json",
        r#"[{"eye":[0,50,0],"target":[0,0,0],"up":[0,0,1],"fov":30},
            {"eye":[50,0,0],"target":[0,0,0],"up":[0,0,1],"view_height":20}]"#,
    );
    for mode in ["composite", "xray"] {
        let words = "bench phantom:gauss,n=8 --cameras views.json --json t.json --force";
        folder
            .run(&format!("{words} --mode {mode} {SMALL}"))
            .assert_done();
        let timings = json(&fs::read_to_string(folder.path("t.json")).expect("a file"));
        assert_eq!(
            timings["frames"].as_array().map(Vec::len),
            Some(2),
            "{timings}"
        );
    }
}

#[test]
fn info_has_the_promised_keys_and_exact_numbers() {
    let folder = Folder::new();
    let nrrd = "NRRD0004\ntype: short\ndimension: 3\nsizes: 2 2 1\nencoding: raw\nendian: little\n\
        space: right-anterior-superior\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (10,20,30)\n\n";
    let mut bytes = nrrd.as_bytes().to_vec();
    bytes.extend([1_i16, -2, 3, 8].iter().flat_map(|n| n.to_le_bytes()));
    folder.file("a.nrrd", bytes);
    let ran = folder.run("info a.nrrd --json");
    ran.assert_done();
    let mut info = json(&ran.out);
    let render_bytes = info["render_bytes"].take();
    assert!(render_bytes["host"].as_u64() >= Some(8), "{render_bytes}");
    assert!(render_bytes["device"].as_u64() >= Some(8), "{render_bytes}");
    // A cube of 4 x 4 x 4 texels of corners, of a word each.
    assert_eq!(info["software_device_bytes"].take(), 256);
    let wanted = json(
        r#"{"format":"nrrd","dims":[2,2,1],"components":1,"times":1,"type":"i16","spacing":[2.0,3.0,4.0],
            "world_from_voxel":[[2.0,0.0,0.0,10.0],[0.0,3.0,0.0,20.0],[0.0,0.0,4.0,30.0],[0.0,0.0,0.0,1.0]],
            "min":-2.0,"max":8.0,"mean":2.5,"non_finite":0,"fill_count":0,"variables":[],"derived":[],"map":null,"levels":1,"render_bytes":null,"software_device_bytes":null,"unit":null,"long_name":null,"meaning":"numbers",
            "channels":[],"time_names":[],"series":[],"notes":[]}"#,
    );
    assert_eq!(info, wanted);
    let text = folder.run("info a.nrrd");
    text.assert_done();
    assert!(text.out.contains("-2 to 8, mean 2.5"), "{text:#?}");
}

#[test]
fn raw_bytes_are_read_as_the_layout_says() {
    let folder = Folder::new();
    folder.file("a.bin", [0, 1, 0, 2, 0xff, 0xfd, 1, 0]);
    let ran = folder.run("info a.bin --json --raw 2x2x1,i16,1x2x3,be");
    ran.assert_done();
    let info = json(&ran.out);
    assert_eq!(
        (&info["min"], &info["max"]),
        (&(-3.0).into(), &256.0.into()),
        "{info}"
    );
    assert_eq!(info["spacing"], json("[1.0,2.0,3.0]"), "{info}");
    folder
        .run("info a.bin --raw 2x2,i16")
        .assert_refused(2, &["--raw 2x2,i16"]);
    folder
        .run("info a.bin --raw 2x2x2,i16")
        .assert_refused(3, &["a.bin", "16", "8"]);
}
