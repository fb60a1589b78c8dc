//! What pictures are without a flag: fitted, lit, from a file to a picture of its name, and kept by scene files.

use crate::person::Folder;
use image::RgbaImage;
use std::fs;
use std::io::Write;
use std::process::Stdio;

/// The picture of this name.
pub fn picture(folder: &Folder, name: &str) -> RgbaImage {
    image::open(folder.path(name))
        .expect("a picture")
        .to_rgba8()
}

/// The box of pixels that differ from the background by over two codes: left, top, right, bottom.
pub fn box_of(picture: &RgbaImage) -> [f64; 4] {
    let background = [24_i32, 24, 28];
    let mut found = [f64::INFINITY, f64::INFINITY, 0.0, 0.0];
    for (x, y, pixel) in picture.enumerate_pixels() {
        let off = |k: usize| (i32::from(pixel.0[k]) - background[k]).abs() > 2;
        if (0..3).any(off) {
            let [x, y] = [x, y].map(f64::from);
            found = [
                found[0].min(x),
                found[1].min(y),
                found[2].max(x + 1.0),
                found[3].max(y + 1.0),
            ];
        }
    }
    found
}

#[test]
fn what_is_visible_fills_the_frame_and_lies_in_its_middle() {
    let folder = Folder::new();
    for (name, words) in [
        ("head", "phantom:head,n=48"),
        ("ball", "phantom:sphere,n=32"),
        ("gauss", "phantom:gauss,n=32 --projection orthographic"),
        ("high", "phantom:head,n=48 --size 120x300"),
        ("slices", "phantom:head,n=48 --technique slices-3d"),
    ] {
        let size = if words.contains("--size") {
            ""
        } else {
            "--size 320x240"
        };
        let ran = folder.run(&format!("render {words} {size} -o {name}.png"));
        ran.assert_done();
        assert!(ran.err.contains("framed to what is visible"), "{ran:?}");
        let picture = picture(&folder, &format!("{name}.png"));
        let [width, height] = [picture.width(), picture.height()].map(f64::from);
        let [left, top, right, bottom] = box_of(&picture);
        let filled = ((right - left) / width).max((bottom - top) / height);
        assert!((0.85..=0.97).contains(&filled), "{name}: {filled}");
        let off = [
            0.5 * (left + right) / width - 0.5,
            0.5 * (top + bottom) / height - 0.5,
        ];
        assert!(off.iter().all(|off| off.abs() < 0.05), "{name}: {off:?}");
    }
}

#[test]
fn a_tile_of_a_sheet_has_the_pixels_of_render() {
    let folder = Folder::new();
    folder
        .run("sheet phantom:head,n=48 phantom:storm,n=32,variable=cloud --tile 96x72 --columns 2 -o sheet.png")
        .assert_done();
    folder
        .run("render phantom:head,n=48 --size 96x72 -o a.png")
        .assert_done();
    folder
        .run("render phantom:storm,n=32 --variable cloud --size 96x72 -o b.png")
        .assert_done();
    let sheet = picture(&folder, "sheet.png");
    for (name, left) in [("a.png", 6), ("b.png", 6 + 96 + 6)] {
        let tile = picture(&folder, name);
        for (x, y, pixel) in tile.enumerate_pixels() {
            assert_eq!(sheet.get_pixel(left + x, 6 + y), pixel, "{name} at {x} {y}");
        }
    }
}

#[test]
fn a_scene_keeps_all_that_was_chosen() {
    let folder = Folder::new();
    folder
        .run("convert phantom:head,n=40 -o head.nrrd")
        .assert_done();
    folder
        .run("convert phantom:sphere,n=40 -o ball.nrrd --type u8 --window 0,1")
        .assert_done();
    let head = "NRRD0004\ntype: uint8\nencoding: raw\n";
    let cube = |voxel: fn(usize) -> Vec<u8>| (0..12 * 12 * 12).flat_map(voxel).collect::<Vec<u8>>();
    let rgb =
        format!("{head}dimension: 4\nsizes: 3 12 12 12\nkinds: RGB-color domain domain domain\n\n");
    let colors = cube(|i| vec![(i % 12 * 20) as u8, (i / 12 % 12 * 20) as u8, 90]);
    folder.file("rgb.nrrd", [rgb.into_bytes(), colors].concat());
    let names = format!("{head}dimension: 3\nsizes: 12 12 12\n\n");
    let labels = cube(|i| vec![(i / 576) as u8]);
    folder.file("names.nrrd", [names.into_bytes(), labels].concat());
    for (name, words) in [
        ("head", "head.nrrd"),
        ("mip", "phantom:head,n=40 --mode mip"),
        ("preset", "phantom:head,n=40 --preset ct-bone"),
        ("labels", "phantom:head,n=40 --preset grey --zoom 1.5"),
        ("iso", "phantom:head,n=40 --mode iso"),
        ("xray", "head.nrrd --mode xray"),
        ("cells", "phantom:cells,n=24"),
        ("cells-mip", "phantom:cells,n=24 --mode mip"),
        ("over", "phantom:head,n=40 --labels ball.nrrd"),
        (
            "with",
            "phantom:head,n=40 --with phantom:gauss,n=12,preset=pet",
        ),
        (
            "opaque",
            "phantom:storm,n=24 --variable temperature --opacity-variable cloud",
        ),
        (
            "painted",
            "phantom:storm,n=24 --variable w --mode iso --iso-color-by vapor",
        ),
        ("rgb", "rgb.nrrd"),
        ("rgb-mip", "rgb.nrrd --mode mip"),
        ("names", "names.nrrd --label-hide 2"),
        ("classified", "head.nrrd --preclassified"),
        ("mida", "head.nrrd --mode mida --window auto"),
        ("deep", "head.nrrd --bit-depth 16"),
        (
            "mip-auto",
            "head.nrrd --mode mip --window auto --colormap viridis",
        ),
    ] {
        let ran = folder.run(&format!(
            "render {words} --size 80x60 -o {name}.png --save-scene {name}.json"
        ));
        ran.assert_done();
        let again = folder.run(&format!("render --scene {name}.json -o {name}-again.png"));
        again.assert_done();
        assert!(!again.err.contains("framed"), "{again:?}");
        let [first, again] = [name.to_owned(), format!("{name}-again")]
            .map(|name| fs::read(folder.path(&format!("{name}.png"))).expect("a picture"));
        assert!(first == again, "{name}");
        let text = fs::read_to_string(folder.path(&format!("{name}.json"))).expect("a scene");
        assert!(text.contains(r#""look": "plain""#), "{name}: {text}");
        let words: &[&str] = match name {
            "xray" | "mip" | "rgb-mip" => &["window"],
            "mida" => &["window", "transfer_function"],
            "cells" | "cells-mip" => &["0,color=", "1,color=", ",window="],
            "opaque" => &["transfer_function", "opacity_function"],
            "painted" => &["transfer_function", "iso_opacity"],
            "iso" => &["iso_color"],
            "preset" | "labels" => &["preset"],
            "mip-auto" => &["window", "viridis"],
            "deep" => &["transfer_function", "\"bit_depth\": 16"],
            _ => &["transfer_function"],
        };
        for word in words {
            assert!(text.contains(word), "{name}, {word}: {text}");
        }
        assert!(!text.contains(r#""auto""#), "{name}: {text}");
    }
    let text = fs::read_to_string(folder.path("head.json")).expect("a scene");
    for key in [
        "transfer_function",
        "target",
        "zoom",
        "material",
        "samples_per_voxel",
        "plain",
    ] {
        assert!(text.contains(key), "{key}: {text}");
    }
}

#[test]
fn scenes_of_version_1_are_drawn_plain() {
    let folder = Folder::new();
    folder.file(
        "old.json",
        r#"{"stratavox_scene":1,"input":{"path":"phantom:head,n=40"},"picture":{"size":"80x60"}}"#,
    );
    folder
        .run("render --scene old.json -o old.png")
        .assert_done();
    folder
        .run("render phantom:head,n=40 --look plain --size 80x60 -o plain.png")
        .assert_done();
    folder
        .run("render phantom:head,n=40 --size 80x60 -o auto.png")
        .assert_done();
    let bytes = |name| fs::read(folder.path(name)).expect("a picture");
    assert!(bytes("old.png") == bytes("plain.png"));
    assert!(bytes("auto.png") != bytes("plain.png"));
    // Plain is transparent, and the whole bounding sphere is seen.
    assert_eq!(picture(&folder, "plain.png").get_pixel(0, 0).0[3], 0);
    assert_eq!(
        picture(&folder, "auto.png").get_pixel(0, 0).0,
        [24, 24, 28, 255]
    );
}

#[test]
fn a_flag_wins_over_the_look() {
    let folder = Folder::new();
    for (at, words) in [
        "--shading none",
        "--samples-per-voxel 1 --shading none --background none --zoom 1",
        "--background white --frame box",
        "--look plain --frame visible",
    ]
    .into_iter()
    .enumerate()
    {
        let ran = folder.run(&format!(
            "render phantom:head,n=40 {words} --size 64x48 -o {at}.png --save-scene {at}.json"
        ));
        ran.assert_done();
    }
    let scene = |at| fs::read_to_string(folder.path(&format!("{at}.json"))).expect("a scene");
    assert!(!scene(0).contains("phong"), "{}", scene(0));
    let plain = picture(&folder, "1.png");
    folder
        .run("render phantom:head,n=40 --look plain --size 64x48 -o plain.png")
        .assert_done();
    assert!(plain == picture(&folder, "plain.png"));
    assert_eq!(picture(&folder, "2.png").get_pixel(0, 0).0, [255; 4]);
    assert!(scene(3).contains("zoom"), "{}", scene(3));
}

#[test]
fn a_file_alone_is_drawn_into_a_picture_of_its_name() {
    let folder = Folder::new();
    folder
        .run("convert phantom:head,n=24 -o scan.nii.gz")
        .assert_done();
    for wanted in ["scan.png", "scan-2.png", "scan-3.png"] {
        let ran = folder.run("scan.nii.gz --size 32x24");
        ran.assert_done();
        assert!(ran.err.contains(&format!("drawn into {wanted}")), "{ran:?}");
        assert!(folder.path(wanted).is_file(), "{wanted}");
    }
    // A verb wins over a file of its name.
    folder.file("info", "");
    assert_eq!(folder.run("info").code, 2);
}

#[test]
fn a_volume_comes_by_a_pipe_and_a_picture_goes_by_one() {
    let folder = Folder::new();
    folder
        .run("convert phantom:head,n=24 -o scan.nrrd")
        .assert_done();
    let mut child = folder
        .command("render - -o - --size 40x30")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let bytes = fs::read(folder.path("scan.nrrd")).expect("a volume");
    let mut input = child.stdin.take().expect("a pipe");
    input.write_all(&bytes).expect("it reads");
    drop(input);
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success(), "{output:?}");
    let piped = image::load_from_memory(&output.stdout).expect("a PNG");
    folder
        .run("render scan.nrrd --size 40x30 -o file.png")
        .assert_done();
    assert!(piped.to_rgba8() == picture(&folder, "file.png"));
}

#[test]
fn sides_have_the_words_that_all_know() {
    let folder = Folder::new();
    let earth = format!(
        "{}/tests/fixtures/netcdf/wrf.nc --variable T",
        env!("CARGO_MANIFEST_DIR")
    );
    let pairs = [
        ("phantom:head,n=24", "front", "anterior"),
        ("phantom:head,n=24", "back", "posterior"),
        ("phantom:head,n=24", "top", "superior"),
        ("phantom:head,n=24", "bottom", "inferior"),
        // The north is away on a map.
        (&earth, "front", "posterior"),
        (&earth, "back", "anterior"),
    ];
    for (at, (input, word, same)) in pairs.into_iter().enumerate() {
        for (name, word) in [("a", word), ("b", same)] {
            folder
                .run(&format!(
                    "render {input} --view {word} --size 32x24 -o {name}{at}.png"
                ))
                .assert_done();
        }
        let [a, b] = ["a", "b"].map(|name| picture(&folder, &format!("{name}{at}.png")));
        assert!(a == b, "{input} {word}");
    }
}

#[test]
fn the_first_of_several_variables_is_drawn_and_the_others_are_named() {
    let folder = Folder::new();
    let ran = folder.run("render phantom:storm,n=16 --size 32x24 -o a.png");
    ran.assert_done();
    assert!(ran.err.contains("--variable takes another"), "{ran:?}");
    let ran = folder.run("render phantom:storm,n=16 --look plain --size 32x24 -o b.png");
    ran.assert_refused(2, &["several variables"]);
    // The first of this file is a coordinate.
    let wrf = format!(
        "{}/tests/fixtures/netcdf/wrf.nc",
        env!("CARGO_MANIFEST_DIR")
    );
    for (name, words) in [("a", ""), ("b", "--variable T"), ("c", "--variable PHB")] {
        folder
            .run(&format!(
                "animate {wrf} {words} --turntable 2 --size 32x24 -o {name}.gif"
            ))
            .assert_done();
    }
    let [first, named, coordinate] =
        ["a", "b", "c"].map(|name| fs::read(folder.path(&format!("{name}.gif"))).expect("a film"));
    assert!(first == named && first != coordinate);
}

#[test]
fn a_film_of_which_nothing_moves_is_a_turntable() {
    let folder = Folder::new();
    let ran = folder.run("animate phantom:head,n=16 --size 16x12 -o film.gif");
    ran.assert_done();
    assert!(ran.err.contains("turntable of 72"), "{ran:?}");
}

#[test]
fn labels_are_lit_at_their_boundaries_and_opaque_enough_to_show_it() {
    let folder = Folder::new();
    folder
        .run("convert phantom:sphere,n=32 -o labels.nrrd --type u8 --window 0,1")
        .assert_done();
    folder
        .run("render labels.nrrd --size 64x48 -o a.png --save-scene a.json")
        .assert_done();
    let text = fs::read_to_string(folder.path("a.json")).expect("a scene");
    let scene: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    // A hundredth of a label over a voxel of 100 / 32.
    let half_gradient = scene["light"]["half_gradient"].as_f64().expect("a number");
    assert!((half_gradient - 0.01 / 3.125).abs() < 1e-12, "{text}");
    let opacity = &scene["classification"]["transfer_function"]["opacity"];
    let last = opacity.as_array().and_then(|points| points.last());
    assert_eq!(
        last.and_then(|point| point[1].as_f64()),
        Some(0.15),
        "{text}"
    );
}

#[test]
fn large_work_takes_one_sample_a_voxel_and_says_so() {
    let folder = Folder::new();
    // 2 x 200 samples through nearly 3000 x 3000 pixels of a ball are over 400 million.
    let ran = folder.run(
        "render phantom:gauss,n=200 --size 3000x3000 --view front --save-scene s.json -o big.png",
    );
    ran.assert_done();
    assert!(ran.err.contains("one sample a voxel"), "{ran:?}");
    let text = fs::read_to_string(folder.path("s.json")).expect("a scene");
    assert!(text.contains("\"samples_per_voxel\": 1.0"), "{text}");
}

/// A folder that is the volume has the name of its folder, wherever one stands.
#[test]
fn the_picture_of_a_folder_has_its_name_from_inside_too() {
    let folder = Folder::new();
    let inner = folder.path("study/inner");
    fs::create_dir_all(&inner).expect("folders");
    let slices = format!("{}/tests/fixtures/tiff/slices", env!("CARGO_MANIFEST_DIR"));
    for slice in 0..4 {
        let name = format!("s{slice}.tif");
        fs::copy(format!("{slices}/{name}"), folder.path("study").join(&name)).expect("a slice");
    }
    for (input, place, name) in [
        (".", "study", "study.png"),
        ("./", "study", "study-2.png"),
        ("..", "study/inner", "study.png"),
        ("inner/..", "study", "study-3.png"),
    ] {
        let mut command = folder.command(&format!("{input} --size 8x8 --device reference"));
        let ran = command.current_dir(folder.path(place)).output();
        let ran = ran.expect("the program runs");
        assert!(ran.status.success(), "{input}: {ran:?}");
        assert!(
            folder.path(place).join(name).is_file(),
            "{input}: no {name}"
        );
    }
}

#[test]
fn a_file_that_is_not_there_is_no_misspelt_verb_and_a_misspelt_verb_no_file() {
    let folder = Folder::new();
    for words in ["nosuch.nii.gz", "scans/one", "./scan --size 8x8"] {
        let name = words.split(' ').next().expect("a word");
        let ran = folder.run(words);
        ran.assert_refused(3, &[name]);
        assert!(!ran.err.contains("subcommand"), "{ran:?}");
    }
    folder
        .run("rendr phantom:fog")
        .assert_refused(2, &["rendr", "'render'", "hint: `stratavox --help`"]);
}

#[test]
fn more_lights_than_there_may_be_are_refused_without_other_flags() {
    let folder = Folder::new();
    let lights = "--light 1,0,0 ".repeat(5);
    let ran = folder.run(&format!("render phantom:head,n=8 -o a.png {lights}"));
    ran.assert_refused(2, &["at most 4"]);
}
