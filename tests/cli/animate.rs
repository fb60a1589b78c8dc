//! Films from words: each frame is the picture that `render` draws with the flags of its moment, and what is
//! refused is refused before anything is written. Drawn by the CPU references, so that no device is needed.

use crate::person::Folder;
use std::fs;

const SMALL: &str = "--size 24x18 --device reference";

/// Fails unless the file `frame` is byte for byte what `render` with these words writes.
#[track_caller]
fn assert_frame_is(folder: &Folder, frame: &str, words: &str) {
    let picture = format!("wanted_{frame}");
    folder
        .run(&format!(
            "render --look plain {words} -o {picture} {SMALL} --force"
        ))
        .assert_done();
    let read = |name: &str| fs::read(folder.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    assert!(
        read(frame) == read(&picture),
        "{frame} is not that of {words}"
    );
}

#[test]
fn frame_k_of_a_turn_is_the_picture_from_azimuth_k() {
    let folder = Folder::new();
    folder
        .run(&format!(
            "animate --look plain phantom:head,n=16 --turntable 5 -o %d.png {SMALL}"
        ))
        .assert_done();
    for (k, azimuth) in [(0, 60), (1, 132), (2, 204), (3, 276), (4, 348)] {
        let words = format!("phantom:head,n=16 --azimuth {azimuth} --elevation 15");
        assert_frame_is(&folder, &format!("{k}.png"), &words);
    }
    // Views and rolls turn too; arrays of floats with their layers.
    folder
        .run(&format!(
            "animate --look plain phantom:head,n=16 --mode mip --view left --roll 7 --turntable 4 --aov value -o f/%02d.npy {SMALL}"
        ))
        .assert_done();
    folder
        .run(&format!(
            "render --look plain phantom:head,n=16 --mode mip --azimuth 450 --elevation 0 --roll 7 --aov value -o a.npy {SMALL}"
        ))
        .assert_done();
    for (frame, wanted) in [("f/03.npy", "a.npy"), ("f/03.value.npy", "a.value.npy")] {
        let same = fs::read(folder.path(frame)).ok() == fs::read(folder.path(wanted)).ok();
        assert!(same, "{frame}");
    }
}

#[test]
fn every_time_is_the_picture_of_that_time_under_one_window() {
    let folder = Folder::new();
    let storm = "phantom:storm,n=16,variable=u,times=3 --mode mip";
    folder
        .run(&format!(
            "animate --look plain {storm} --window -20,30 --times -o %d.png {SMALL}"
        ))
        .assert_done();
    for k in 0..3 {
        let words = format!("{storm} --window -20,30 --time {k}");
        assert_frame_is(&folder, &format!("{k}.png"), &words);
    }
    // Noise is taken out of each time.
    let smooth = "--window -20,30 --denoise gaussian";
    folder
        .run(&format!(
            "animate --look plain {storm} {smooth} --times -o n%d.png {SMALL}"
        ))
        .assert_done();
    for k in 0..3 {
        let words = format!("{storm} {smooth} --time {k}");
        assert_frame_is(&folder, &format!("n{k}.png"), &words);
    }
    // Without a window it is the range of all times: that of any one of them is narrower.
    let ran = folder.run(&format!(
        "animate --look plain {storm} --times -o all%d.png {SMALL}"
    ));
    ran.assert_done();
    assert!(ran.err.contains("chosen for all 3 times"), "{ran:?}");
    let info = folder.run("info phantom:storm,n=16,variable=u,times=3 --json");
    let info: serde_json::Value = serde_json::from_str(&info.out).expect("JSON");
    for k in 0..3 {
        let words = format!(
            "{storm} --window {},{} --time {k}",
            info["min"], info["max"]
        );
        assert_frame_is(&folder, &format!("all{k}.png"), &words);
    }
}

/// Two times of 2 x 2 x 2 floats, the second one `step` more everywhere.
fn two_times(folder: &Folder, name: &str, begin: f32, step: f32, kind: &str) {
    let mut bytes = format!(
        "NRRD0004\ntype: float\ndimension: 4\nsizes: 2 2 2 {kind}\nkinds: domain domain domain time\n\
         endian: little\nencoding: raw\n\n"
    )
    .into_bytes();
    let times = kind.parse::<u16>().expect("a count");
    for time in 0..times {
        for voxel in 0..8_u16 {
            let value = begin + f32::from(voxel) + step * f32::from(time);
            bytes.extend(value.to_le_bytes());
        }
    }
    folder.file(name, bytes);
}

#[test]
fn between_two_times_lies_the_volume_between() {
    let folder = Folder::new();
    two_times(&folder, "two.nrrd", 1.0, 4.0, "2");
    folder.file(
        "k.json",
        r#"{"stratavox_keyframes":1,"frames":5,"keys":[{"at":0,"time":0},{"at":1,"time":1}]}"#,
    );
    let words = "--mode mip --window 0,16 --view left";
    folder
        .run(&format!(
            "animate --look plain two.nrrd {words} --keyframes k.json -o %d.png {SMALL}"
        ))
        .assert_done();
    for (k, begin) in [1.0, 2.0, 3.0, 4.0, 5.0].into_iter().enumerate() {
        let name = format!("at{k}.nrrd");
        two_times(&folder, &name, begin, 0.0, "1");
        assert_frame_is(&folder, &format!("{k}.png"), &format!("{name} {words}"));
    }
    // A turn while time runs: as many frames as times show each of them.
    folder
        .run(&format!(
            "animate --look plain two.nrrd --mode mip --window 0,16 --times --turntable 2 -o t%d.png {SMALL}"
        ))
        .assert_done();
    assert_frame_is(
        &folder,
        "t1.png",
        "two.nrrd --mode mip --window 0,16 --time 1 --azimuth 240 --elevation 15",
    );
}

#[test]
fn keyframes_move_everything_that_a_flag_can_say() {
    let folder = Folder::new();
    for (name, level, value) in [
        ("a.json", 0.25, 100),
        ("b.json", 0.75, 300),
        ("mid.json", 0.5, 200),
    ] {
        folder.file(
            name,
            format!(
                r#"{{"stratavox_transfer_function":1,"color":[[{value},{level},0.5,1]],
                    "opacity":[[-1000,0],[{value},{level}]],"reference_length":2}}"#
            ),
        );
    }
    folder.file(
        "k.json",
        r#"{"stratavox_keyframes":1,"frames":3,"keys":[
            {"frame":0,"azimuth":10,"elevation":-20,"roll":4,"zoom":1,"fov":30,"tf":"a.json",
             "crop":[0,16,0,16,2,10],"clip":[[1,0,0,-90],[0,0,-1,-50]]},
            {"at":1,"azimuth":50,"elevation":20,"roll":8,"zoom":4,"fov":40,"tf":"b.json",
             "crop":[4,16,0,12,2,14],"clip":[[1,0,0,-30],[0,0,-1,-20]]}]}"#,
    );
    folder
        .run(&format!(
            "animate --look plain phantom:head,n=16 --keyframes k.json -o %d.png {SMALL}"
        ))
        .assert_done();
    for (frame, words) in [
        (
            "0.png",
            "--azimuth 10 --elevation -20 --roll 4 --zoom 1 --fov 30 --tf a.json --crop 0,16,0,16,2,10 --clip 1,0,0,-90 --clip 0,0,-1,-50",
        ),
        (
            "1.png",
            "--azimuth 30 --elevation 0 --roll 6 --zoom 2 --fov 35 --tf mid.json --crop 2,16,0,14,2,12 --clip 1,0,0,-60 --clip 0,0,-1,-35",
        ),
        (
            "2.png",
            "--azimuth 50 --elevation 20 --roll 8 --zoom 4 --fov 40 --tf b.json --crop 4,16,0,12,2,14 --clip 1,0,0,-30 --clip 0,0,-1,-20",
        ),
    ] {
        assert_frame_is(&folder, frame, &format!("phantom:head,n=16 {words}"));
    }
    folder.file(
        "eye.json",
        r#"{"stratavox_keyframes":1,"seconds":0.5,"keys":[
            {"at":0,"eye":[600,0,100],"target":[0,0,90],"up":[0,0,1],"window":[0,400]},
            {"at":1,"eye":[600,400,100],"target":[0,0,110],"up":[0,1,1],"window":[100,800]}]}"#,
    );
    folder
        .run(&format!(
            "animate --look plain phantom:head,n=16 --mode mip --keyframes eye.json --fps 6 -o e%d.png {SMALL}"
        ))
        .assert_done();
    let words = "phantom:head,n=16 --mode mip --eye 600,200,100 --target 0,0,100 --up 0,0.5,1 --window 50,600";
    assert_frame_is(&folder, "e1.png", words);
    assert!(
        !folder.path("e3.png").exists(),
        "half a second at 6 a second are 3 frames"
    );
}

#[test]
fn an_xray_has_the_window_of_its_first_frame() {
    let folder = Folder::new();
    let xray = "phantom:fog,n=8 --mode xray --elevation 0";
    let ran = folder.run(&format!(
        "animate --look plain {xray} --turntable 4 -o %d.png {SMALL}"
    ));
    ran.assert_done();
    let window = ran
        .err
        .split_once("the window of the first: ")
        .expect(&ran.err)
        .1
        .trim();
    let words = format!("{xray} --azimuth 90 --window {window}");
    assert_frame_is(&folder, "1.png", &words);
}

#[test]
fn a_film_that_cannot_be_is_refused_before_anything_is_written() {
    let folder = Folder::new();
    folder.file(
        "k.json",
        r#"{"stratavox_keyframes":1,"frames":2,"keys":[{"at":0,"zoom":0}]}"#,
    );
    folder.file(
        "t.json",
        r#"{"stratavox_keyframes":1,"frames":2,"keys":[{"at":0,"time":9}]}"#,
    );
    folder.file(
        "c.json",
        r#"{"stratavox_keyframes":1,"frames":3,"keys":[{"at":0,"clip":[[1,0,0,0]]},{"at":1,"clip":[[-1,0,0,0]]}]}"#,
    );
    folder.file(
        "e.json",
        r#"{"stratavox_keyframes":1,"frames":3,"keys":[{"at":0,"eye":[-9,0,0],"target":[0,0,0]},{"at":1,"eye":[9,0,0]}]}"#,
    );
    folder.file("2.png", "a holiday");
    let before = folder.names();
    for (words, code, said) in [
        ("phantom:head,n=8 -o a.gif", 2, &["--turntable 120"][..]),
        ("phantom:head,n=8 -o a.gif --times", 2, &["one time"]),
        (
            "phantom:storm,n=8,variable=u -o a.gif --times --time 3",
            2,
            &["--times", "--time"],
        ),
        (
            "phantom:head,n=8 -o a.png --turntable 3",
            2,
            &["one number", "frames/%04d.png"],
        ),
        (
            "phantom:head,n=8 -o a.avi --turntable 3",
            2,
            &["the ending"],
        ),
        (
            "phantom:head,n=8 -o a.gif --turntable 0",
            2,
            &["--turntable"],
        ),
        (
            "phantom:head,n=8 -o a.gif --turntable 3 --keyframes k.json",
            2,
            &["cannot be used with"],
        ),
        (
            "phantom:head,n=8 -o a.gif --turntable 3 --fps fast",
            2,
            &["frames a second"],
        ),
        (
            "phantom:head,n=8 -o a.gif --turntable 3 --aov depth",
            2,
            &["no room", "--aov"],
        ),
        (
            "phantom:head,n=8 -o a.gif --turntable 3 --bit-depth 16",
            2,
            &["--bit-depth 16"],
        ),
        (
            "phantom:head,n=8 -o - --turntable 3 --resume",
            2,
            &["--resume"],
        ),
        (
            "phantom:head,n=8 -o a.gif --keyframes k.json",
            3,
            &["k.json", "keys[0].zoom"],
        ),
        (
            "phantom:head,n=8 -o a.gif --keyframes none.json",
            3,
            &["none.json"],
        ),
        (
            "phantom:head,n=8 -o a.gif --keyframes t.json",
            2,
            &["frame 0 of the keyframes", "time 9"],
        ),
        (
            "phantom:head,n=8 -o a.gif --keyframes c.json",
            2,
            &["frame 1 of the keyframes", "direction"],
        ),
        (
            "phantom:head,n=8 -o a.gif --keyframes e.json",
            2,
            &["frame 1 of the keyframes", "same point"],
        ),
        (
            "phantom:head,n=8 -o a.gif --turntable 200000",
            6,
            &["at most 100000"],
        ),
        (
            "phantom:head,n=8 -o no/where/%d.png --turntable 3",
            4,
            &["there is no folder"],
        ),
        (
            "phantom:head,n=8 -o %d.png --turntable 3",
            4,
            &["2.png", "exists", "--force"],
        ),
        (
            "phantom:head,n=8 -o %d.png --turntable 3 --resume",
            4,
            &["2.png", "exists"],
        ),
    ] {
        let ran = folder.run(&format!("animate --look plain {words} {SMALL}"));
        ran.assert_refused(code, said);
        assert_eq!(folder.names(), before, "{words}");
    }
    // Nothing is behind the folders of PATH.
    let mut command = folder.command(&format!(
        "animate --look plain phantom:head,n=8 --turntable 3 -o a.mp4 {SMALL}"
    ));
    let output = command.env("PATH", "").output().expect("the program runs");
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{err}");
    assert!(err.contains("ffmpeg") && err.contains(".y4m"), "{err}");
    assert_eq!(folder.names(), before);
}

#[test]
fn progress_counts_frames_and_says_how_long_it_will_take() {
    let folder = Folder::new();
    let ran = folder.run(&format!(
        "animate --look plain phantom:fog,n=8 --turntable 3 -o %d.png --progress json {SMALL}"
    ));
    ran.assert_done();
    let lines = ran
        .err
        .lines()
        .map(|line| serde_json::from_str::<serde_json::Value>(line).expect(line));
    let frames: Vec<_> = lines.filter(|line| line["stage"] == "frames").collect();
    let done: Vec<_> = frames
        .iter()
        .map(|line| line["done"].as_u64().expect("a count"))
        .collect();
    assert_eq!(done, [0, 1, 2, 3], "{ran:?}");
    assert!(frames[1]["seconds_left"].as_f64() > Some(0.0), "{ran:?}");
    assert_eq!(frames[3]["seconds_left"].as_f64(), Some(0.0), "{ran:?}");
}

#[test]
fn grain_changes_from_frame_to_frame_and_nothing_else_does() {
    let folder = Folder::new();
    fs::write(
        folder.path("still.json"),
        r#"{"stratavox_keyframes":1,"frames":2,"keys":[{"at":0,"zoom":1}]}"#,
    )
    .expect("a file");
    let film = "animate --look plain phantom:head,n=16 --keyframes still.json";
    folder
        .run(&format!("{film} --jitter=5 -o g%d.png {SMALL}"))
        .assert_done();
    folder
        .run(&format!("{film} -o %d.png {SMALL}"))
        .assert_done();
    let read = |name: &str| fs::read(folder.path(name)).expect("a frame");
    assert!(read("g0.png") != read("g1.png"), "the same grain twice");
    assert!(read("0.png") == read("1.png"), "nothing moves");
    assert_frame_is(&folder, "g0.png", "phantom:head,n=16 --jitter=5");
}

#[test]
fn a_light_moves_from_key_to_key() {
    let folder = Folder::new();
    fs::write(
        folder.path("light.json"),
        r#"{"stratavox_keyframes":1,"frames":3,"keys":[{"at":0,"light":[2,0,0]},{"at":1,"light":[0,-1,0]}]}"#,
    )
    .expect("a file");
    let lit = "phantom:head,n=16 --shading phong";
    folder
        .run(&format!(
            "animate --look plain {lit} --light 0,0,1,1,0.5,0 --keyframes light.json -o %d.png {SMALL}"
        ))
        .assert_done();
    for (frame, light) in [("0.png", "1,0,0"), ("1.png", "1,-1,0"), ("2.png", "0,-1,0")] {
        assert_frame_is(&folder, frame, &format!("{lit} --light {light},1,0.5,0"));
    }
    for (words, wanted) in [
        ("phantom:head,n=16", "nothing is lit"),
        (
            "phantom:head,n=16 --shading phong --light 1,0,0 --light 0,1,0",
            "there are 2",
        ),
    ] {
        let run = folder.run(&format!(
            "animate --look plain {words} --keyframes light.json -o f%d.png {SMALL}"
        ));
        run.assert_refused(2, &["frame 0 of the keyframes", wanted]);
    }
    fs::write(
        folder.path("light.json"),
        r#"{"stratavox_keyframes":1,"frames":3,"keys":[{"at":0,"light":[2,0,0]},{"at":1,"light":[-1,0,0]}]}"#,
    )
    .expect("a file");
    let run = folder.run(&format!(
        "animate --look plain {lit} --keyframes light.json -o g%d.png {SMALL}"
    ));
    run.assert_refused(2, &["frame 1 of the keyframes", "opposite sides"]);
    assert!(!folder.path("g0.png").exists(), "a frame of no film");
}
