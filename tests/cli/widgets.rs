//! Functions of value and gradient, and colour and opacity from two files, as a person says them.

use crate::person::Folder;
use std::fs;

const HEAD: &str = "phantom:head,n=16 --size 16x16 --device reference --force";

/// Skin and bone.
const CONTOURS: &str = r#"{"stratavox_transfer_function": 1, "widgets": [
    {"shape": "contour", "value": -300, "opacity": 0.2, "color": [0.9, 0.7, 0.6]},
    {"shape": "contour", "value": 400, "opacity": 0.9, "color": [1, 1, 0.9]}]}"#;

fn tf(color: &str, opacity: &str) -> String {
    format!(r#"{{"stratavox_transfer_function": 1, "color": {color}, "opacity": {opacity}}}"#)
}

#[test]
fn colour_and_opacity_of_two_files_draw_what_one_file_of_both_draws() {
    let folder = Folder::new();
    let (color, opacity) = ("[[0,1,0,0],[900,0,0,1]]", "[[-200,0],[300,0.6]]");
    folder.file("color.json", tf(color, "[[0,1]]"));
    folder.file("opacity.json", tf("[[0,0,1,0]]", opacity));
    folder.file("both.json", tf(color, opacity));
    let words =
        format!("render --look plain {HEAD} --color-tf color.json --opacity-tf opacity.json");
    folder
        .run(&format!("{words} -o two.npy --save-scene scene.json"))
        .assert_done();
    folder
        .run(&format!(
            "render --look plain {HEAD} --tf both.json -o one.npy"
        ))
        .assert_done();
    folder
        .run("render --scene scene.json -o scene.npy --device reference")
        .assert_done();
    let bytes = |name: &str| fs::read(folder.path(name)).expect(name);
    assert_eq!(bytes("two.npy"), bytes("one.npy"));
    assert_eq!(bytes("two.npy"), bytes("scene.npy"));
    folder
        .run(&format!(
            "render --look plain {HEAD} --preset ct-bone --color-tf color.json -o preset.npy"
        ))
        .assert_done();
    assert_ne!(bytes("preset.npy"), bytes("one.npy"));
}

#[test]
fn widgets_are_drawn_shown_and_carried_in_scenes() {
    let folder = Folder::new();
    folder.file("tf.json", CONTOURS);
    folder
        .run(&format!(
            "render --look plain {HEAD} --tf tf.json -o a.npy --save-scene scene.json"
        ))
        .assert_done();
    folder
        .run("render --scene scene.json -o b.npy --device reference")
        .assert_done();
    let bytes = |name: &str| fs::read(folder.path(name)).expect(name);
    assert_eq!(bytes("a.npy"), bytes("b.npy"));
    let shown = folder.run("preset show boundaries phantom:head,n=32");
    shown.assert_done();
    assert!(shown.out.contains("contour of"), "{}", shown.out);
}

#[test]
fn what_cannot_draw_widgets_says_so() {
    let folder = Folder::new();
    folder.file("tf.json", CONTOURS);
    for (words, said) in [
        ("--mode mip --tf tf.json", "need --mode composite"),
        ("--mode mip --preset boundaries", "need --mode composite"),
        ("--tf tf.json --labels labels.nrrd", "--labels"),
    ] {
        folder
            .run(&format!("render --look plain {HEAD} -o x.npy {words}"))
            .assert_refused(2, &[said]);
    }
    folder.file("bad.json", CONTOURS.replace("400", "\"bone\""));
    folder
        .run(&format!(
            "render --look plain {HEAD} -o x.npy --tf bad.json"
        ))
        .assert_refused(3, &["bad.json", "widgets[1].value", "\"bone\""]);
    let keys = format!(
        r#"{{"stratavox_keyframes": 1, "frames": 2, "keys": [{{"at": 0, "tf": {CONTOURS}}}, {{"at": 1}}]}}"#
    );
    folder.file("keys.json", keys);
    let film = "animate --look plain phantom:head,n=8 --size 8x8 --device reference --keyframes keys.json -o film.apng";
    let refused = folder.run(film);
    assert!(
        refused.err.contains("keys[0].tf: widgets"),
        "{}",
        refused.err
    );
}
