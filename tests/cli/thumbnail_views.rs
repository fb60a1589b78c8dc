//! Several views of each volume of a batch: every picture is that of `--view` alone, and the volume is read once.

use crate::person::Folder;
use crate::thumbnails::{nrrd, pictures};
use serde_json::{Value, json};
use std::fs;

const SMALL: &str = "--size 24x18 --device reference";

fn json_of(folder: &Folder, name: &str) -> Value {
    serde_json::from_slice(&fs::read(folder.path(name)).expect("a file")).expect("JSON")
}

#[test]
fn each_view_is_the_picture_of_that_view_alone() {
    let folder = Folder::new();
    for seed in 0..2 {
        folder.file(&format!("v{seed}.nrrd"), nrrd(5 + seed % 2, seed));
    }
    // The window of an X-ray is that of each picture, the stack of slices that of each view.
    for (word, flags) in [
        ("ray", "--roll 30 --device reference"),
        ("x", "--mode xray --device reference"),
        ("flat", "--technique slices-2d --projection orthographic"),
    ] {
        let flags = format!("--size 24x18 {flags}");
        let views = "anterior,left,superior,inferior";
        let batch = format!("thumbnails v0.nrrd v1.nrrd --views {views} {flags}");
        folder.run(&format!("{batch} -o {word}")).assert_done();
        let mut found = pictures(&folder.path(word));
        assert_eq!(found.len(), 8);
        for view in views.split(',') {
            let one = format!("{word}-{view}");
            folder
                .run(&format!(
                    "thumbnails v0.nrrd v1.nrrd --view {view} {flags} -o {one}"
                ))
                .assert_done();
            for (name, alone) in pictures(&folder.path(&one)) {
                let name = name.replace(".png", &format!("-{view}.png"));
                let same = found.remove(&name).is_some_and(|found| found == alone);
                assert!(same, "{word}/{name} is not that of --view {view}");
            }
        }
        assert!(found.is_empty());
    }
}

#[test]
fn a_volume_is_read_once_for_all_its_views_and_rows_are_of_pictures() {
    let folder = Folder::new();
    folder.file("a.nrrd", nrrd(4, 1));
    folder.file("broken.nrrd", &nrrd(9, 7)[..100]);
    let batch = format!(
        "thumbnails a.nrrd broken.nrrd --views left,right -o out --progress json {SMALL} --index i.json"
    );
    let ran = folder.run(&batch);
    assert_eq!(ran.code, 3, "{ran:#?}");
    assert!(ran.err.contains("2 drawn, 2 failed"), "{ran:#?}");
    // What cannot be read is said once.
    let said = ran.err.lines();
    let said = said.filter(|line| line.starts_with("{\"note\":\"broken.nrrd: "));
    let said = said.count();
    assert_eq!(said, 1, "{ran:#?}");
    let lines = ran.err.lines().filter(|line| line.starts_with('{'));
    let lines: Vec<Value> = lines
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    let done = lines.iter().filter(|line| line["stage"] == "volumes");
    let done: Vec<&Value> = done.map(|line| &line["done"]).collect();
    assert_eq!(
        done,
        [&json!(0), &json!(1), &json!(2)],
        "volumes, not pictures"
    );
    let told = lines.iter().filter(|line| line["volume"] == "a.nrrd");
    let told: Vec<[&Value; 2]> = told.map(|line| [&line["view"], &line["picture"]]).collect();
    let wanted = ["left", "right"].map(|view| [json!(view), json!(format!("a-{view}.png"))]);
    assert_eq!(told, wanted.each_ref().map(|row| row.each_ref()));

    let index = json_of(&folder, "i.json");
    let rows = index["volumes"].as_array().expect("rows");
    let became: Vec<String> = rows
        .iter()
        .map(|row| {
            let words = [&row["input"], &row["view"], &row["became"]];
            words.map(|word| word.as_str().expect("a word")).join(" ")
        })
        .collect();
    let wanted = [
        "a.nrrd left drawn",
        "a.nrrd right drawn",
        "broken.nrrd left failed",
        "broken.nrrd right failed",
    ];
    assert_eq!(became, wanted);
    assert!(rows[3]["picture"].is_null() && rows[3]["error"].is_string());

    // A view that is missing is drawn, the others of the volume stay.
    fs::remove_file(folder.path("out/a-right.png")).expect("removed");
    folder.file("out/a-left.png", "somebody's");
    let ran = folder.run(&format!(
        "thumbnails a.nrrd --views left,right,superior -o out --resume {SMALL}"
    ));
    ran.assert_done();
    assert!(ran.err.contains("2 drawn, 1 kept, 0 failed"), "{ran:#?}");
    let left = fs::read(folder.path("out/a-left.png")).expect("a file");
    assert_eq!(left, b"somebody's");
}

#[test]
fn words_that_say_where_to_stand_are_refused_beside_several_views() {
    let folder = Folder::new();
    folder.file("a.nrrd", nrrd(4, 1));
    for (words, said) in [
        ("--views left,up", "possible values"),
        ("--views left,right,left", "--views names left twice"),
        ("--views left --view right", "cannot be used with"),
        ("--views left --azimuth 3", "cannot be used with"),
        ("--views left --eye 1,2,3", "cannot be used with"),
        ("--views left --section axial", "cannot be used with"),
    ] {
        let ran = folder.run(&format!("thumbnails a.nrrd -o out {words} {SMALL}"));
        ran.assert_refused(2, &[said]);
        assert!(!folder.path("out").exists(), "{words}");
    }
    // Of a scene the side alone gives way, and a section has but one.
    folder
        .run(&format!(
            "render a.nrrd -o a.png --view left --fov 20 {SMALL} --save-scene s.json"
        ))
        .assert_done();
    folder
        .run("thumbnails a.nrrd -o out --scene s.json --views right --device reference")
        .assert_done();
    folder
        .run(&format!(
            "render a.nrrd -o b.png --view right --fov 20 {SMALL}"
        ))
        .assert_done();
    let read = |name: &str| fs::read(folder.path(name)).expect("a picture");
    assert!(read("out/a-right.png") == read("b.png"));
    folder
        .run(&format!(
            "render a.nrrd -o c.png --section axial {SMALL} --save-scene c.json"
        ))
        .assert_done();
    folder
        .run("thumbnails a.nrrd -o more --scene c.json --views right")
        .assert_refused(2, &["--section", "--views"]);
}
