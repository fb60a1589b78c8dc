//! `preset`, and transfer functions of other programs behind `--tf`.

use crate::person::Folder;
use serde_json::Value;
use std::fs;

const SMALL: &str = "--size 24x16 --device reference";

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn fixture(folder: &Folder, name: &str) {
    let path = format!(
        "{}/tests/fixtures/transfer/{name}",
        env!("CARGO_MANIFEST_DIR")
    );
    folder.file(
        name,
        fs::read(&path).unwrap_or_else(|error| panic!("{path}: {error}")),
    );
}

#[test]
fn the_list_names_every_word_of_the_flag() {
    let folder = Folder::new();
    let list = folder.run("preset list");
    list.assert_done();
    let names: Vec<&str> = list
        .out
        .lines()
        // Maps follow an empty line.
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    for name in [
        "ct-bone",
        "ct-soft-tissue",
        "ct-lung",
        "mri",
        "microscopy",
        "grey",
    ] {
        assert!(names.contains(&name), "{names:?}");
    }
    for name in &names {
        let words =
            format!("render --look plain phantom:gauss,n=8 -o {name}.png --preset {name} {SMALL}");
        folder.run(&words).assert_done();
        folder.run(&format!("preset show {name}")).assert_done();
    }
    let list = json(&folder.run("preset list --json").out);
    assert_eq!(list.as_array().map(Vec::len), Some(names.len()), "{list}");
}

#[test]
fn what_show_prints_for_a_volume_draws_the_same_picture_as_the_preset() {
    let folder = Folder::new();
    for name in ["ct-bone", "mri", "grey"] {
        let shown = folder.run(&format!("preset show {name} phantom:head,n=16 --json"));
        shown.assert_done();
        folder.file("tf.json", &shown.out);
        let words = format!("render --look plain phantom:head,n=16 {SMALL} --force");
        folder
            .run(&format!("{words} --preset {name} -o a.npy"))
            .assert_done();
        folder
            .run(&format!("{words} --tf tf.json -o b.npy"))
            .assert_done();
        folder.run("compare a.npy b.npy --at-most 0").assert_done();
    }
    let text = folder.run("preset show ct-bone").out;
    assert!(text.contains("         330  #964e30  0.14\n"), "{text}");
}

#[test]
fn an_imported_function_is_the_same_behind_tf() {
    let folder = Folder::new();
    for name in [
        "slicer.vp",
        "voreen.tfi",
        "vapor.tf3",
        "paraview-hsvwrap.json",
    ] {
        fixture(&folder, name);
        let ran = folder.run(&format!(
            "preset import {name} -o tf.json --force --window 0,1"
        ));
        ran.assert_done();
        assert!(ran.err.contains(" is a"), "{ran:#?}");
        let words = format!("render --look plain phantom:gauss,n=16 {SMALL} --force --window 0,1");
        folder
            .run(&format!("{words} --tf {name} -o a.npy"))
            .assert_done();
        folder
            .run(&format!("{words} --tf tf.json -o b.npy"))
            .assert_done();
        folder.run("compare a.npy b.npy --at-most 0").assert_done();
    }
}

#[test]
fn what_is_left_out_is_said_on_stderr_by_import_and_by_render() {
    let folder = Folder::new();
    fixture(&folder, "slicer.vp.json");
    let ran = folder.run("preset import slicer.vp.json");
    ran.assert_done();
    assert!(
        ran.err
            .contains("not taken over: the opacity by gradient magnitude"),
        "{ran:#?}"
    );
    assert_eq!(json(&ran.out)["reference_length"], 0.75, "{ran:#?}");
    let ran = folder.run(&format!(
        "render --look plain phantom:head,n=8 -o a.png --tf slicer.vp.json {SMALL}"
    ));
    ran.assert_done();
    assert!(ran.err.contains("not taken over: the light"), "{ran:#?}");
}

#[test]
fn fractions_are_spread_over_the_window_or_else_over_the_range_of_the_volume() {
    let folder = Folder::new();
    fixture(&folder, "inviwo.itf");
    let ran = folder.run("preset import inviwo.itf --window 100,300");
    ran.assert_done();
    // The mask begins at a quarter.
    assert_eq!(
        json(&ran.out)["opacity"][0],
        json("[150.0, 0.0]"),
        "{ran:#?}"
    );
    let ran = folder.run("preset import inviwo.itf");
    assert!(ran.err.contains("--window"), "{ran:#?}");
    // gauss, n=8 goes from its smallest to its largest value.
    let info = json(&folder.run("info phantom:gauss,n=8 --json").out);
    let words = format!("render --look plain phantom:gauss,n=8 --tf inviwo.itf {SMALL}");
    folder
        .run(&format!("{words} -o a.npy --save-scene s.json"))
        .assert_done();
    folder
        .run(&format!(
            "{words} -o b.npy --window {},{}",
            info["min"], info["max"]
        ))
        .assert_done();
    folder.run("compare a.npy b.npy --at-most 0").assert_done();
    // A scene keeps that they are fractions.
    folder.run("render --scene s.json -o c.npy").assert_done();
    folder.run("compare a.npy c.npy --at-most 0").assert_done();
    folder
        .run(&format!("{words} -o d.npy --mode xray"))
        .assert_refused(2, &["fractions", "--window"]);
}

#[test]
fn one_of_several_is_chosen_by_name_and_wrong_files_exit_3() {
    let folder = Folder::new();
    fixture(&folder, "slicer.mrml");
    folder
        .run("preset import slicer.mrml")
        .assert_refused(3, &["choose one by name", "Own-Bone, Own-Air"]);
    folder
        .run("preset import slicer.mrml --name Own-Bone -o tf.json")
        .assert_done();
    folder
        .run("preset import slicer.mrml --name Own-Bone -o tf.json")
        .assert_refused(4, &["tf.json", "--force"]);
    folder.file(
        "bomb.xml",
        "<!DOCTYPE a [<!ENTITY b \"b\">]><MRML>&b;</MRML>",
    );
    folder
        .run("preset import bomb.xml")
        .assert_refused(3, &["document type"]);
    folder.file("tf.txt", "0 1\n2 x\n");
    folder
        .run(&format!(
            "render --look plain phantom:fog,n=8 -o a.png --tf tf.txt {SMALL}"
        ))
        .assert_refused(3, &["tf.txt", "line 2"]);
    folder
        .run("preset import nowhere.vp")
        .assert_refused(3, &["nowhere.vp"]);
    folder
        .run("preset import tf.txt -o tf.txt --force")
        .assert_refused(4, &["it is an input"]);
}
