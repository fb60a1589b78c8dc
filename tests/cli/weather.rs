//! Files of models of the atmosphere: `info` tells what the file holds, a picture what can be drawn of it.

use crate::person::Folder;
use serde_json::Value;

fn fixture(name: &str) -> String {
    let folder = env!("CARGO_MANIFEST_DIR");
    format!("{folder}/tests/fixtures/{name}")
}

const DRAW: &str = "--device reference --size 24x16 -o a.npy --force";

#[test]
fn info_tells_the_grid_of_the_file_and_what_the_one_of_a_picture_needs() {
    let folder = Folder::new();
    let ran = folder.run(&format!(
        "info {} --variable T --json",
        fixture("netcdf/wrf.nc")
    ));
    ran.assert_done();
    let info: Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(info["format"], "netcdf");
    assert_eq!(info["dims"], serde_json::json!([5, 3, 4]));
    assert_eq!((&info["times"], &info["type"]), (&2.into(), &"f32".into()));
    assert!(ran.err.contains("levels follow the ground"), "{}", ran.err);
    let bytes = info["render_bytes"]["host"].as_u64().expect("a number");
    assert!(
        bytes > 5 * 3 * 4 * 5,
        "{bytes} for more levels than the file's"
    );
}

#[test]
fn a_file_of_several_variables_asks_for_one_by_name() {
    let folder = Folder::new();
    for (file, words) in [
        ("netcdf/wrf.nc", ["PHB, PH, T, W, U, V", "--variable"]),
        ("hdf5/latest.h5", ["a, g/b", "--variable"]),
    ] {
        let ran = folder.run(&format!("render {} --look plain {DRAW}", fixture(file)));
        ran.assert_refused(2, &words);
    }
    let drawn = format!(
        "render {} --variable /g/b {DRAW}",
        fixture("hdf5/latest.h5")
    );
    folder.run(&drawn).assert_done();
}

#[test]
fn heights_are_stretched_where_the_sheet_is_flat_and_it_is_said() {
    let folder = Folder::new();
    let draw = |words: &str| {
        let file = fixture("netcdf/classic.nc");
        let ran = folder.run(&format!("render {file} --variable t {words} {DRAW}"));
        ran.assert_done();
        (
            ran.err,
            std::fs::read(folder.path("a.npy")).expect("a picture"),
        )
    };
    let (said, stretched) = draw("");
    let factor = said
        .split_once("heights are exaggerated ")
        .and_then(|(_, rest)| rest.split_once(" times"))
        .map(|(factor, _)| factor.to_owned())
        .unwrap_or_else(|| panic!("{said}"));
    let (said, same) = draw(&format!("--exaggerate {factor}"));
    assert!(!said.contains("exaggerated"), "{said}");
    assert!(
        stretched == same,
        "--exaggerate {factor} is another picture"
    );
    let (_, flat) = draw("--exaggerate 1");
    assert!(flat != stretched, "--exaggerate 1 is the same picture");
    let ran = folder.run(&format!("render phantom:head,n=8 --exaggerate 0 {DRAW}"));
    ran.assert_refused(2, &["--exaggerate"]);
}

#[test]
fn the_earth_is_seen_from_the_south_unless_a_word_says_otherwise() {
    let folder = Folder::new();
    let file = format!("{} --variable t", fixture("netcdf/classic.nc"));
    let draw = |words: &str| {
        let ran = folder.run(&format!("render {file} --look plain {words} {DRAW}"));
        ran.assert_done();
        std::fs::read(folder.path("a.npy")).expect("a picture")
    };
    let by_default = draw("");
    assert!(by_default == draw("--azimuth -60 --elevation 25"));
    assert!(by_default != draw("--azimuth 60 --elevation 15"));
    let info = folder.run(&format!("info {file}"));
    info.assert_done();
    let line = "seen from    azimuth -60, elevation 25 degrees";
    assert!(info.out.contains(line), "{}", info.out);
    let small = "--size 24x16 --device reference";
    let film = format!("animate {file} --look plain --time 0 --turntable 2 -o f%d.npy {small}");
    folder.run(&film).assert_done();
    let frame = |name: &str| std::fs::read(folder.path(name)).expect("a frame");
    assert!(frame("f0.npy") == by_default);
    assert!(frame("f1.npy") == draw("--azimuth 120 --elevation 25"));
}
