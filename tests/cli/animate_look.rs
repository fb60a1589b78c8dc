//! Films under `--look auto`: what keys say wins over the look, one fit holds for all frames, and the scene keeps it.

use crate::person::Folder;
use std::fs;

const SMALL: &str = "--size 48x36 --device reference";

fn keys(folder: &Folder, frames: u32, keys: &str) {
    let text = format!(r#"{{"stratavox_keyframes":1,"frames":{frames},"keys":[{keys}]}}"#);
    folder.file("k.json", text);
}

#[track_caller]
fn assert_same(folder: &Folder, frame: &str, wanted: &str) {
    let read = |name: &str| fs::read(folder.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    assert!(read(frame) == read(wanted), "{frame} is not {wanted}");
}

#[test]
fn keys_that_place_the_camera_win_over_the_look() {
    let folder = Folder::new();
    let head = "phantom:head,n=24";
    for (at, (first, last, flags)) in [
        (
            r#""eye":[300,0,0]"#,
            r#""eye":[0,300,0]"#,
            ["--eye 300,0,0", "--eye 0,300,0"],
        ),
        (
            r#""target":[20,0,0]"#,
            r#""target":[0,0,30]"#,
            ["--target 20,0,0", "--target 0,0,30"],
        ),
        (r#""zoom":1"#, r#""zoom":2"#, ["--zoom 1", "--zoom 2"]),
        (
            r#""view_height":200"#,
            r#""view_height":300"#,
            ["--view-height 200", "--view-height 300"],
        ),
        (
            r#""target":[20,0,0],"azimuth":10"#,
            r#""target":[20,0,0],"azimuth":90"#,
            [
                "--target 20,0,0 --azimuth 10",
                "--target 20,0,0 --azimuth 90",
            ],
        ),
    ]
    .into_iter()
    .enumerate()
    {
        keys(
            &folder,
            2,
            &format!(r#"{{"at":0,{first}}},{{"at":1,{last}}}"#),
        );
        let lens = match first.contains("view_height") {
            true => "--projection orthographic",
            false => "",
        };
        // A film takes one sample a voxel, a still two.
        let words = format!("{head} {lens} --samples-per-voxel 1 {SMALL}");
        let ran = folder.run(&format!(
            "animate {words} --keyframes k.json -o f{at}-%d.png"
        ));
        ran.assert_done();
        assert!(!ran.err.contains("framed to"), "{first}: {ran:?}");
        for (k, flags) in flags.into_iter().enumerate() {
            folder
                .run(&format!("render {words} {flags} -o r{at}-{k}.png"))
                .assert_done();
            assert_same(
                &folder,
                &format!("f{at}-{k}.png"),
                &format!("r{at}-{k}.png"),
            );
        }
        folder
            .run(&format!(
                "animate {words} --keyframes k.json --frame visible -o no%d.png"
            ))
            .assert_refused(2, &["--frame", "`eye`", "`zoom`"]);
    }
}

/// A ramp of 64 x 64 x 64 bytes along x, from 0 to 252.
fn ramp(folder: &Folder) {
    let voxel = |i: usize| (i % 64 * 4) as u8;
    let mut bytes =
        b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 64 64 64\nencoding: raw\n\n".to_vec();
    bytes.extend((0..64 * 64 * 64).map(voxel));
    folder.file("ramp.nrrd", bytes);
}

/// A function that is opaque from one value to another.
fn slab([low, high]: [u32; 2]) -> String {
    format!(
        r#"{{"stratavox_transfer_function":1,"color":[[0,1,1,1]],
           "opacity":[[{low},0],[{low},0.9],[{high},0.9],[{high},0]]}}"#
    )
}

/// The box of pixels that are not the background, as shares of the width: left and right.
fn across(folder: &Folder, name: &str) -> [f64; 2] {
    let picture = image::open(folder.path(name)).expect(name).to_rgba8();
    let lit = picture
        .enumerate_pixels()
        .filter(|(_, _, pixel)| pixel.0[0] > 40);
    let xs: Vec<u32> = lit.map(|(x, ..)| x).collect();
    let width = f64::from(picture.width());
    let ends = [xs.iter().min(), xs.iter().max()];
    let [left, right] = ends.map(|x| f64::from(*x.unwrap_or_else(|| panic!("{name} is empty"))));
    [left / width, (right + 1.0) / width]
}

/// Of voxels that are classified first too: a cloud drifts and grows from the first time to the last.
#[test]
fn volumes_that_are_read_together_are_framed_at_all_times() {
    let folder = Folder::new();
    let ran = folder.run(
        "animate phantom:storm,n=16,times=3 --times --preclassified --view front --size 60x40 -o s%d.png",
    );
    ran.assert_done();
    for name in ["s0.png", "s2.png"] {
        let [left, right] = across(&folder, name);
        assert!(left > 0.0 && right < 1.0, "{name}: {left} {right}");
    }
}

#[test]
fn a_camera_that_stands_still_frames_what_is_visible_in_all_frames() {
    let folder = Folder::new();
    ramp(&folder);
    // What is seen wanders from the left end of the box to the right one.
    let words =
        "ramp.nrrd --view front --projection orthographic --size 200x100 --device reference";
    let ends = [slab([8, 40]), slab([208, 240])];
    keys(
        &folder,
        3,
        &format!(r#"{{"at":0,"tf":{}}},{{"at":1,"tf":{}}}"#, ends[0], ends[1]),
    );
    let ran = folder.run(&format!("animate {words} --keyframes k.json -o t%d.png"));
    ran.assert_done();
    let [first, last] = ["t0.png", "t2.png"].map(|name| across(&folder, name));
    // Both ends of the way, mirrored in the middle of the picture.
    let [low, high] = [first[0].min(last[0]), first[1].max(last[1])];
    assert!(low > 0.01 && high < 0.99, "{first:?} {last:?}");
    assert!((low + high - 1.0).abs() < 0.04, "{first:?} {last:?}");
    // The box is as high as it is wide, and the picture half as high: the height is what fills it.
    let wide = high - low;
    assert!((0.35..0.47).contains(&wide), "{first:?} {last:?}");
    let said = "framed to what is visible in any frame: --target";
    assert!(ran.err.contains(said), "{ran:?}");

    // Planes that move: what is left at the end is far from what is left first.
    let step = r#""clip":[[1,0,0,0],[-1,0,0,-8]]"#;
    let end = r#""clip":[[1,0,0,56],[-1,0,0,-64]]"#;
    keys(
        &folder,
        2,
        &format!(r#"{{"at":0,{step}}},{{"at":1,{end}}}"#),
    );
    let tf =
        r#"{"stratavox_transfer_function":1,"color":[[0,1,1,1]],"opacity":[[0,0.9],[255,0.9]]}"#;
    folder.file("all.json", tf);
    let ran = folder.run(&format!(
        "animate {words} --tf all.json --keyframes k.json -o c%d.png"
    ));
    ran.assert_done();
    let [first, last] = ["c0.png", "c1.png"].map(|name| across(&folder, name));
    let [low, high] = [first[0].min(last[0]), first[1].max(last[1])];
    assert!((low + high - 1.0).abs() < 0.04, "{first:?} {last:?}");
    assert!((0.4..0.47).contains(&(high - low)), "{first:?} {last:?}");

    // Boxes that are cropped: the box around both.
    keys(
        &folder,
        2,
        r#"{"at":0,"crop":[0,8,0,64,0,64]},{"at":1,"crop":[56,64,0,64,0,64]}"#,
    );
    let ran = folder.run(&format!(
        "animate {words} --tf all.json --keyframes k.json -o b%d.png"
    ));
    ran.assert_done();
    assert!(
        ran.err.contains("framed to the cropped box of all frames"),
        "{ran:?}"
    );
    let [first, last] = ["b0.png", "b1.png"].map(|name| across(&folder, name));
    let [low, high] = [first[0].min(last[0]), first[1].max(last[1])];
    assert!((low + high - 1.0).abs() < 0.02, "{first:?} {last:?}");
    assert!((0.42..0.47).contains(&(high - low)), "{first:?} {last:?}");
}

#[test]
fn a_turntable_frames_the_sphere_of_what_is_visible() {
    let folder = Folder::new();
    ramp(&folder);
    // A slab of 8 voxels at one end of the box, 64 by 64 wide: its sphere is nearly that of a square.
    folder.file("end.json", slab([224, 255]));
    let words = "ramp.nrrd --tf end.json --projection orthographic --elevation 0 --size 120x120 --device reference";
    folder
        .run(&format!("animate {words} --turntable 8 -o %d.png"))
        .assert_done();
    // From +x, the fourth of a turn later and so on: always in the middle, and never beyond the frame.
    let all: Vec<_> = (0..8)
        .map(|k| across(&folder, &format!("{k}.png")))
        .collect();
    for [left, right] in &all {
        assert!((left + right - 1.0).abs() < 0.05, "{all:?}");
        assert!(*left > 0.01 && *right < 0.99, "{all:?}");
    }
    let most = all
        .iter()
        .map(|[left, right]| right - left)
        .fold(0.0, f64::max);
    assert!((0.6..0.8).contains(&most), "{all:?}");
}

#[test]
fn a_scene_of_a_film_keeps_all_that_was_chosen() {
    let folder = Folder::new();
    folder
        .run("convert phantom:head,n=24 -o head.nrrd")
        .assert_done();
    keys(
        &folder,
        3,
        r#"{"at":0,"window":[-500,1500]},{"at":1,"window":[0,900]}"#,
    );
    let storm = "phantom:storm,n=16,variable=cloud,times=3";
    for (name, words, motion) in [
        ("head", "head.nrrd", "--turntable 3"),
        ("preset", "head.nrrd --preset ct-bone", "--turntable 3"),
        ("mip", "head.nrrd --mode mip", "--turntable 3"),
        ("xray", "head.nrrd --mode xray", "--turntable 3"),
        ("iso", "head.nrrd --mode iso", "--turntable 3"),
        (
            "mida",
            "head.nrrd --mode mida --window auto",
            "--turntable 3",
        ),
        ("window", "head.nrrd", "--keyframes k.json"),
        ("cells", "phantom:cells,n=16", "--turntable 3"),
        ("times", storm, "--times"),
        ("mips", &format!("{storm} --mode mip"), "--times"),
        ("deep", "head.nrrd --bit-depth 16", "--turntable 3"),
    ] {
        let film = format!("{motion} -o {name}-%d.png");
        folder
            .run(&format!(
                "animate {words} {SMALL} {film} --save-scene {name}.json"
            ))
            .assert_done();
        let text = fs::read_to_string(folder.path(&format!("{name}.json"))).expect("a scene");
        assert!(text.contains(r#""look": "plain""#), "{name}: {text}");
        for key in ["target", "zoom", "background", "samples_per_voxel"] {
            assert!(text.contains(key), "{name}, {key}: {text}");
        }
        let key = match name {
            "preset" => "ct-bone",
            "mip" | "xray" | "mips" => "window",
            "iso" => "iso_opacity",
            "cells" => "color=",
            _ => "transfer_function",
        };
        assert!(text.contains(key), "{name}, {key}: {text}");
        let ran = folder.run(&format!(
            "animate --scene {name}.json {motion} -o {name}-again-%d.png"
        ));
        ran.assert_done();
        assert!(!ran.err.contains("framed"), "{name}: {ran:?}");
        for k in 0..3 {
            assert_same(
                &folder,
                &format!("{name}-again-{k}.png"),
                &format!("{name}-{k}.png"),
            );
        }
    }
    // A scene has the pictures, not what moves.
    folder
        .run("animate --scene head.json -o none-%d.png")
        .assert_refused(
            2,
            &["not the motion", "--turntable", "--keyframes", "--fps"],
        );
    // Frames that are there already have a scene too.
    folder
        .run(&format!(
            "animate head.nrrd {SMALL} --turntable 3 -o head-%d.png --resume --save-scene late.json"
        ))
        .assert_done();
    assert_same(&folder, "late.json", "head.json");
}
