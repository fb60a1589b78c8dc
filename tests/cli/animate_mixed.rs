//! Films of several numbers a voxel and of label maps: each frame is the picture that `render` draws. Drawn by the
//! CPU references.

use crate::person::Folder;
use std::fs;

const SMALL: &str = "--size 24x18 --device reference";

#[track_caller]
fn assert_frame_is(folder: &Folder, frame: &str, words: &str) {
    folder
        .run(&format!(
            "render --look plain {words} -o wanted.png {SMALL} --force"
        ))
        .assert_done();
    let read = |name: &str| fs::read(folder.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    assert!(
        read(frame) == read("wanted.png"),
        "{frame} is not that of {words}"
    );
}

/// 6 x 5 x 4 bytes, so many a voxel.
fn nrrd(folder: &Folder, name: &str, first_axis: &str, kinds: &str, bytes: usize) {
    let dimension = 3 + usize::from(!first_axis.is_empty());
    let header = format!(
        "NRRD0004\ntype: uchar\ndimension: {dimension}\nsizes: {first_axis} 6 5 4\n{kinds}encoding: raw\n\n"
    );
    let voxels = (0..120 * bytes).map(|i| (i * 7 % 251) as u8).collect();
    folder.file(name, [header.into_bytes(), voxels].concat());
}

fn labels(folder: &Folder, name: &str, of: impl Fn(usize) -> u8) {
    let header = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 6 5 4\nencoding: raw\n\n";
    let voxels = (0..120).map(of).collect();
    folder.file(name, [header.as_bytes().to_vec(), voxels].concat());
}

#[test]
fn a_turn_of_channels_is_the_picture_of_all_of_them_from_each_side() {
    let folder = Folder::new();
    for (name, words) in [
        (
            "two",
            "phantom:cells,n=12 --channel 0,color=cyan --channel 1,color=red,window=0:200",
        ),
        ("all", "phantom:cells,n=12"),
        ("mip", "phantom:cells,n=12 --mode mip --channels 2,0"),
    ] {
        folder
            .run(&format!(
                "animate --look plain {words} --turntable 3 -o {name}%d.png {SMALL}"
            ))
            .assert_done();
        for (k, azimuth) in [(0, 60), (2, 300)] {
            let words = format!("{words} --azimuth {azimuth} --elevation 15");
            assert_frame_is(&folder, &format!("{name}{k}.png"), &words);
        }
    }
}

#[test]
fn keyframes_move_camera_and_planes_around_colours_and_labels() {
    let folder = Folder::new();
    nrrd(
        &folder,
        "rgb.nrrd",
        "3",
        "kinds: RGB-color domain domain domain\n",
        3,
    );
    nrrd(&folder, "v.nrrd", "", "", 1);
    labels(&folder, "l.nrrd", |i| u8::from(i % 6 >= 3));
    folder.file("l.txt", "1 255 0 0 1 1 1 \"right half\"\n");
    folder.file(
        "k.json",
        r#"{"stratavox_keyframes":1,"frames":3,"keys":[
            {"at":0,"azimuth":0,"zoom":1,"clip":[[1,0,0,0]]},{"at":1,"azimuth":90,"zoom":4,"clip":[[1,0,0,4]]}]}"#,
    );
    for (name, words) in [
        ("rgb", "rgb.nrrd"),
        ("over", "v.nrrd --labels l.nrrd --label-tf l.txt"),
        ("cut", "v.nrrd --preset grey --labels l.nrrd --label-show 1"),
        ("names", "l.nrrd --label-tf l.txt"),
    ] {
        folder
            .run(&format!(
                "animate --look plain {words} --keyframes k.json -o {name}%d.png {SMALL}"
            ))
            .assert_done();
        let words = format!("{words} --azimuth 45 --zoom 2 --clip 1,0,0,2");
        assert_frame_is(&folder, &format!("{name}1.png"), &words);
    }
}

#[test]
fn a_film_of_times_shows_what_lies_beside_as_pictures_of_each_time_do() {
    let folder = Folder::new();
    labels(&folder, "l.nrrd", |i| u8::from(i % 6 >= 3));
    let storm = "phantom:storm,n=12,times=2 --variable vapor";
    folder
        .run("convert phantom:storm,n=12,variable=cloud -o cloud.nrrd")
        .assert_done();
    for words in [
        "--labels l.nrrd --window 0,9",
        "--with cloud.nrrd,color=white --window 0,9",
        // Of the same time.
        "--opacity-variable cloud --window 0,9",
        "--labels l.nrrd --mode mip --window 0,9",
    ] {
        folder
            .run(&format!(
                "animate --look plain {storm} {words} --times -o t%d.png {SMALL} --force"
            ))
            .assert_done();
        for time in [0, 1] {
            let words = format!("{storm} {words} --time {time}");
            assert_frame_is(&folder, &format!("t{time}.png"), &words);
        }
        let [first, second] = ["t0.png", "t1.png"].map(|name| fs::read(folder.path(name)));
        assert_ne!(first.expect("a file"), second.expect("a file"), "{words}");
        // Between two times all volumes are mixed: half way it is the picture of their means.
        folder
            .run(&format!(
                "animate --look plain {storm} {words} --times --between 1 -o b%d.png {SMALL} --force"
            ))
            .assert_done();
        let read = |name: &str| fs::read(folder.path(name)).expect(name);
        assert_eq!(
            [read("b0.png"), read("b2.png")],
            [read("t0.png"), read("t1.png")]
        );
        let middle = read("b1.png");
        assert!(
            middle != read("b0.png") && middle != read("b2.png"),
            "{words}"
        );
    }
    let refused = folder.run(&format!("animate {storm} --between 2 -o c.gif {SMALL}"));
    refused.assert_refused(2, &["--between", "--times"]);
}

#[test]
fn what_several_numbers_cannot_do_in_a_film_is_refused_by_name() {
    let folder = Folder::new();
    nrrd(&folder, "v.nrrd", "", "", 1);
    labels(&folder, "l.nrrd", |i| u8::from(i % 6 >= 3));
    folder.file("l.txt", "1 255 0 0 1 1 1 \"right half\"\n");
    folder.file(
        "w.json",
        r#"{"stratavox_keyframes":1,"frames":2,"keys":[{"at":0,"window":[0,9]}]}"#,
    );
    let before = folder.names();
    for (words, said) in [
        (
            "phantom:storm,n=8,variable=u,times=2 --label-tf l.txt --times",
            &["--label-tf", "--time N"][..],
        ),
        (
            "phantom:cells,n=8 --keyframes w.json",
            &["`window`", "keyframes", "--channel 0"],
        ),
        (
            "v.nrrd --labels l.nrrd --keyframes w.json",
            &["`window`", "keyframes"],
        ),
        (
            "phantom:cells,n=8 --channels 0,1 --preset grey --turntable 2",
            &["--preset", "--channel 0"],
        ),
        (
            "v.nrrd --labels l.nrrd --label-dim 1 --mode mip --turntable 2",
            &["--label-dim", "--mode composite"],
        ),
    ] {
        let ran = folder.run(&format!("animate --look plain {words} -o a.gif {SMALL}"));
        ran.assert_refused(2, said);
        assert_eq!(folder.names(), before, "{words}");
    }
}

#[test]
fn a_stopped_film_does_not_go_on_with_other_labels() {
    let folder = Folder::new();
    nrrd(&folder, "v.nrrd", "", "", 1);
    labels(&folder, "l.nrrd", |i| u8::from(i % 6 >= 3));
    let words =
        format!("animate --look plain v.nrrd --labels l.nrrd --turntable 2 -o %d.png {SMALL}");
    folder.run(&words).assert_done();
    labels(&folder, "l.nrrd", |i| u8::from(i % 6 >= 4));
    fs::remove_file(folder.path("1.png")).expect("a frame");
    let ran = folder.run(&format!("{words} --resume"));
    ran.assert_refused(2, &["labels.names"]);
}

#[test]
fn between_two_times_three_volumes_have_to_fit() {
    let folder = Folder::new();
    let storm = "phantom:storm,n=64,variable=u,times=2";
    let info = folder.run(&format!("info {storm} --json"));
    let info: serde_json::Value = serde_json::from_str(&info.out).expect("JSON");
    // Room for one volume and for two, of floats all of them, and not for three: nine tenths of it may be taken.
    let one = info["render_bytes"]["host"].as_u64().expect("a number");
    let words = format!(
        "animate --look plain {storm} --mode mip --window -20,30 --times --max-memory {} {SMALL}",
        5 * one / 2
    );
    folder
        .run(&format!("{words} --turntable 2 -o %d.png"))
        .assert_done();
    let ran = folder.run(&format!("{words} --turntable 3 -o b%d.png"));
    ran.assert_refused(6, &["of memory", "--fit"]);
    let ran = folder.run(&format!("{words} --turntable 3 -o b%d.png --fit"));
    ran.assert_done();
    assert!(ran.err.contains("reduced from 64 x 64"), "{}", ran.err);
}
