//! Volumes that are larger than the memory they may take.

use super::person::Folder;
use serde_json::Value;
use std::fs::{self, File};
use std::io::{Seek, SeekFrom, Write};

const SIDE: u64 = 400;

/// 122 MiB of zeros that take no room on the disk, with a ball of 40 voxels in the middle.
fn ball(folder: &Folder) {
    let mut file = File::create(folder.path("ball.raw")).expect("a file");
    file.set_len(SIDE * SIDE * SIDE * 2).expect("a length");
    let (middle, radius) = (SIDE / 2, 20);
    for z in middle - radius..middle + radius {
        for y in middle - radius..middle + radius {
            let row = (z * SIDE + y) * SIDE;
            for x in middle - radius..middle + radius {
                let square = |n: u64| (2 * n + 1).abs_diff(2 * middle).pow(2);
                if square(x) + square(y) + square(z) < 4 * radius * radius {
                    file.seek(SeekFrom::Start(2 * (row + x))).expect("a seek");
                    file.write_all(&(2000 + 10 * x as u16).to_le_bytes())
                        .expect("a voxel");
                }
            }
        }
    }
}

fn words(more: &str) -> String {
    format!(
        "render --look plain ball.raw --raw {SIDE}x{SIDE}x{SIDE},u16 --preset grey --window 1000,9000 --zoom 6 --size 64x64 --force {more}"
    )
}

fn peak(folder: &Folder) -> u64 {
    let text = fs::read_to_string(folder.path("t.json")).expect("timings");
    let timings: Value = serde_json::from_str(&text).expect("JSON");
    timings["peak_rss_bytes"].as_u64().expect("a peak")
}

/// The largest difference of two `.npy` pictures, and the largest number in the first.
fn apart(folder: &Folder, a: &str, b: &str) -> [f32; 2] {
    let numbers = |name: &str| {
        let bytes = fs::read(folder.path(name)).expect(name);
        let data = bytes[bytes.len() - 64 * 64 * 16..].as_chunks::<4>().0;
        data.iter()
            .map(|n| f32::from_le_bytes(*n))
            .collect::<Vec<_>>()
    };
    let (a, b) = (numbers(a), numbers(b));
    let pairs = a.iter().zip(&b);
    [
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max),
        a.iter().copied().fold(0.0, f32::max),
    ]
}

#[test]
fn a_volume_larger_than_its_memory_is_the_same_picture() {
    let folder = Folder::new();
    ball(&folder);
    folder
        .run(&words("-o whole.npy --timings t.json"))
        .assert_done();
    let whole = peak(&folder);
    let ran = folder.run(&words(
        "-o bricks.npy --max-memory 96M --device-memory 24M --timings t.json",
    ));
    ran.assert_done();
    assert!(ran.err.contains("in 64 bricks"), "{}", ran.err);
    let bricks = peak(&folder);
    let [apart, largest] = apart(&folder, "whole.npy", "bricks.npy");
    // Filters of the device see other coordinates in a brick: 2^-8 of a step of value at most, here far less.
    assert!(largest > 0.2 && apart < 0.01, "{apart} of {largest}");
    // A texture and voxels of 122 MiB each, and what every picture takes.
    assert!(whole > 250 << 20, "{whole}");
    assert!(bricks < 200 << 20, "{bricks}");
}

#[test]
fn bricks_on_the_disk_have_levels_and_are_refined() {
    let folder = Folder::new();
    ball(&folder);
    let raw = format!("ball.raw --raw {SIDE}x{SIDE}x{SIDE},u16");
    folder
        .run(&format!("convert {raw} -o ball.svb"))
        .assert_done();
    // Zeros take no room.
    let length = fs::metadata(folder.path("ball.svb")).expect("a file").len();
    assert!(length < 2 << 20, "{length}");
    let look = "--preset grey --window 1000,9000 --zoom 6 --size 64x64 --force";
    folder.run(&words("--stream -o raw.npy")).assert_done();
    folder
        .run(&format!(
            "render --look plain ball.svb --stream {look} -o svb.npy"
        ))
        .assert_done();
    assert_eq!(apart(&folder, "raw.npy", "svb.npy")[0], 0.0);
    let ran = folder.run(&format!(
        "render --look plain ball.svb --level 2 {look} -o coarse.npy"
    ));
    ran.assert_done();
    assert!(ran.err.contains("level 2 of 2"), "{}", ran.err);
    // Opacities are for the same length.
    let [apart_2, largest] = apart(&folder, "raw.npy", "coarse.npy");
    assert!(
        apart_2 > 0.0 && apart_2 < 0.5 * largest,
        "{apart_2} of {largest}"
    );
    let ran = folder.run(&format!(
        "render --look plain ball.svb --refine --stream {look} -o fine.npy"
    ));
    ran.assert_done();
    let told: Vec<_> = ["level 2 of 2", "level 1 of 2"]
        .iter()
        .map(|note| ran.err.find(note))
        .collect();
    assert!(told[0].is_some() && told[0] < told[1], "{}", ran.err);
    assert_eq!(apart(&folder, "svb.npy", "fine.npy")[0], 0.0);
    folder
        .run(&format!(
            "render --look plain ball.svb --level 3 {look} -o no.npy"
        ))
        .assert_refused(3, &["level", "0 to 2"]);
    folder
        .run(&words("--refine -o no.npy"))
        .assert_refused(2, &["--refine", "convert INPUT -o FILE.svb"]);
    // One brick has no coarser levels, in whatever file.
    folder
        .run("convert phantom:sphere,n=32 -o small.svb")
        .assert_done();
    for small in ["small.svb", "phantom:sphere,n=32"] {
        folder
            .run(&format!("render {small} --refine -o no.npy"))
            .assert_refused(2, &["one has one", "leave --refine out"]);
    }
}

#[test]
fn what_is_not_drawn_in_bricks_is_refused_by_name() {
    let folder = Folder::new();
    ball(&folder);
    for (more, word) in [
        ("--technique slices-3d", "--technique"),
        ("--filter cubic", "--filter"),
        ("--denoise median", "--denoise"),
        ("--device reference", "--device reference"),
        ("--ambient-occlusion 0.5", "--ambient-occlusion"),
    ] {
        let ran = folder.run(&words(&format!("--stream {more} -o a.png")));
        ran.assert_refused(2, &["--stream", word]);
    }
    folder
        .run("convert phantom:sphere,n=16 -o a.nii.gz")
        .assert_done();
    folder
        .run("render --look plain a.nii.gz --stream -o a.png")
        .assert_refused(2, &["compressed as a whole", "convert a.nii.gz -o a.svb"]);
    // 16^3 floats are 16 KiB, and as much again on the device.
    folder
        .run("render --look plain a.nii.gz --max-memory 20K -o a.png")
        .assert_refused(6, &["no memory", "convert a.nii.gz -o a.svb", "--fit"]);
}

#[test]
fn what_is_compressed_as_a_whole_is_decoded_once_and_becomes_bricks() {
    let folder = Folder::new();
    let make = |words: &str| folder.run(&format!("convert {words}")).assert_done();
    make("phantom:head,n=130 -o head.npy --type i16");
    let crop = "--force --crop 10,130,0,128,5,129";
    make(&format!("head.npy -o wanted.svb {crop}"));
    let look = "--stream --size 64x64 --force";
    folder
        .run(&format!(
            "render --look plain wanted.svb {look} -o wanted.npy"
        ))
        .assert_done();
    for packed in ["head.nii.gz", "head.nrrd"] {
        make(&format!("head.npy -o {packed}"));
        make(&format!("{packed} -o head.svb {crop}"));
        folder
            .run(&format!("render --look plain head.svb {look} -o found.npy"))
            .assert_done();
        let [apart, largest] = apart(&folder, "wanted.npy", "found.npy");
        assert!(
            apart == 0.0 && largest > 0.2,
            "{packed}: {apart} of {largest}"
        );
    }
    // Nothing is left of what was decoded.
    let left = fs::read_dir(folder.path(".")).expect("a folder").count();
    assert_eq!(left, 7, "files in the folder");
}

#[test]
fn frames_of_a_film_are_the_pictures_that_are_drawn_from_the_file() {
    let folder = Folder::new();
    folder
        .run("convert phantom:head,n=130 -o head.svb --type i16")
        .assert_done();
    let look = "head.svb --size 32x24 --force";
    let ran = folder.run(&format!(
        "animate --look plain {look} --stream --turntable 3 -o %d.npy"
    ));
    ran.assert_done();
    // One look for all frames: bricks that are there stay.
    assert_eq!(ran.err.matches("in 8 bricks").count(), 1, "{}", ran.err);
    let keys = r#"{ "stratavox_keyframes": 1, "frames": 2, "keys": [
        { "at": 0, "window": [0, 900], "azimuth": 10 }, { "at": 1, "window": [-400, 500], "azimuth": 200 } ] }"#;
    fs::write(folder.path("keys.json"), keys).expect("a file");
    // Where the memory is short nobody has to say it.
    let ran = folder.run(&format!(
        "animate --look plain {look} --mode mip --keyframes keys.json --max-memory 8M -o k%d.npy"
    ));
    ran.assert_done();
    assert!(ran.err.contains("in 8 bricks"), "{}", ran.err);
    for (frame, words) in [
        ("1.npy", "--azimuth 180 --elevation 15"),
        ("k0.npy", "--mode mip --window 0,900 --azimuth 10"),
        ("k1.npy", "--mode mip --window=-400,500 --azimuth 200"),
    ] {
        folder
            .run(&format!(
                "render --look plain {look} --stream {words} -o r.npy"
            ))
            .assert_done();
        let read = |name: &str| fs::read(folder.path(name)).expect(name);
        assert!(
            read(frame) == read("r.npy"),
            "{frame} is not that of {words}"
        );
    }
}

#[test]
fn each_time_of_a_film_is_the_picture_that_is_drawn_from_the_file() {
    let folder = Folder::new();
    folder
        .run("convert phantom:storm,n=130,variable=u,times=3 -o storm.svb")
        .assert_done();
    let look = "storm.svb --size 32x24 --force";
    let window = "--window=-10,40";
    let ran = folder.run(&format!(
        "animate --look plain {look} --stream --times {window} -o %d.npy"
    ));
    ran.assert_done();
    let said = ran
        .err
        .matches("each time is drawn from the file in")
        .count();
    assert_eq!(said, 1, "{}", ran.err);
    // Where the memory is short nobody has to say it.
    let ran = folder.run(&format!(
        "animate --look plain {look} --times {window} --max-memory 3M -o short%d.npy"
    ));
    ran.assert_done();
    assert!(ran.err.contains("drawn from the file"), "{}", ran.err);
    let read = |name: &str| fs::read(folder.path(name)).expect(name);
    for time in 0..3 {
        folder
            .run(&format!(
                "render --look plain {look} --stream --time {time} {window} -o r.npy"
            ))
            .assert_done();
        let wanted = read("r.npy");
        for frame in [format!("{time}.npy"), format!("short{time}.npy")] {
            assert!(read(&frame) == wanted, "{frame} is another picture");
        }
    }
    assert!(read("0.npy") != read("2.npy"), "nothing moves");
    // What nobody words is chosen for all times together.
    let ran = folder.run(&format!(
        "animate --look plain {look} --stream --times -o all%d.png"
    ));
    ran.assert_done();
    assert!(ran.err.contains("for all 3 times together"), "{}", ran.err);
    let keys = r#"{ "stratavox_keyframes": 1, "frames": 3, "keys": [{ "at": 0, "time": 0 }, { "at": 1, "time": 1 }] }"#;
    fs::write(folder.path("keys.json"), keys).expect("a file");
    folder
        .run(&format!(
            "animate --look plain {look} --stream --keyframes keys.json -o k%d.png"
        ))
        .assert_refused(2, &["frame 1", "0.5", "--stream"]);
}
