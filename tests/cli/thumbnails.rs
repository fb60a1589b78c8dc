//! `stratavox thumbnails`: a folder of volumes to pictures, each of them what `render` draws with the same flags.
//! Most are drawn by the CPU references, so that no device is needed.

use crate::person::Folder;
use serde_json::Value;
use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

const SMALL: &str = "--size 24x18 --device reference";

/// An NRRD of `side`^3 bytes that no other seed has.
pub fn nrrd(side: usize, seed: usize) -> Vec<u8> {
    let header = format!(
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: {side} {side} {side}\nencoding: raw\n\n"
    );
    [header.as_bytes(), &voxels(side, seed)].concat()
}

fn voxels(side: usize, seed: usize) -> Vec<u8> {
    let voxel = |i: usize| (i * (7 + seed) % 251) as u8;
    (0..side.pow(3)).map(voxel).collect()
}

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures")
        .join(name)
}

/// A folder as people have them: volumes of many formats, voxels apart from their headers, what is no volume, and two
/// that are broken.
fn scans(folder: &Folder) {
    for inner in [
        "scans",
        "scans/series",
        "scans/stack",
        "scans/store.zarr",
        "scans/more",
    ] {
        fs::create_dir(folder.path(inner)).expect("a folder");
    }
    let file = |name: &str, bytes: &[u8]| drop(folder.file(&format!("scans/{name}"), bytes));
    let copy = |from: &str, to: &str| {
        fs::copy(fixture(from), folder.path("scans").join(to)).expect("a copy");
    };
    file("a.nrrd", &nrrd(5, 1));
    file(
        "b.mhd",
        b"ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nElementByteOrderMSB = False\nElementDataFile = b.raw\n",
    );
    file("b.raw", &voxels(4, 2));
    file(
        "c.nhdr",
        b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: c.bin.img\n",
    );
    file("c.bin.img", &voxels(4, 3));
    file("d.raw", &voxels(3, 4));
    file(
        "d.json",
        br#"{ "file": "d.raw", "dims": [3, 3, 3], "type": "u8" }"#,
    );
    copy("npy/i2-le.npy", "e.npy");
    copy("vtk/type-uint8-binary-51.vtk", "f.vtk");
    copy("vti/type-float32.vti", "g.vti");
    copy("dicom/enhanced_ct.dcm", "series/one");
    for slice in 0..4 {
        let name = format!("s{slice}.tif");
        copy(&format!("tiff/slices/{name}"), &format!("stack/{name}"));
    }
    file(
        "store.zarr/.zarray",
        br#"{"zarr_format":2,"shape":[4,4,4],"chunks":[4,4,4],"dtype":"|u1","compressor":null,"fill_value":0,"order":"C","filters":null}"#,
    );
    file("store.zarr/0.0.0", &voxels(4, 5));
    file("more/deep.nrrd", &nrrd(4, 6));
    file("broken.nrrd", &nrrd(9, 7)[..100]);
    file("empty.nii", b"");
    file("README.txt", b"no volume");
    file(".hidden.nrrd", &nrrd(4, 8));
}

/// Where each volume of [`scans`] lies, by the name of its picture.
const PICTURES: [(&str, &str); 9] = [
    ("a", "a.nrrd"),
    ("b", "b.mhd"),
    ("c", "c.nhdr"),
    ("d", "d.raw"),
    ("e", "e.npy"),
    ("f", "f.vtk"),
    ("g", "g.vti"),
    ("series", "series"),
    ("stack", "stack"),
];

pub fn pictures(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).expect("a folder");
    let named = entries.map(|entry| {
        let entry = entry.expect("an entry");
        let name = entry.file_name().to_string_lossy().into_owned();
        (name, fs::read(entry.path()).expect("a file"))
    });
    named.collect()
}

#[test]
fn a_folder_of_many_formats_is_drawn_as_render_draws_each_and_bad_files_are_named() {
    let folder = Folder::new();
    scans(&folder);
    let ran = folder.run(&format!(
        "thumbnails scans -o out --index out/index.json {SMALL}"
    ));
    assert_eq!(ran.code, 3, "{ran:#?}");
    for word in [
        "scans/broken.nrrd: ",
        "scans/empty.nii: ",
        "10 drawn, 2 failed",
        "are left alone",
    ] {
        assert!(ran.err.contains(word), "no {word:?}: {ran:#?}");
    }
    let mut found = pictures(&folder.path("out"));
    let index = found.remove("index.json").expect("an index");
    let mut wanted: Vec<String> = PICTURES
        .iter()
        .map(|(name, _)| format!("{name}.png"))
        .collect();
    wanted.push("store.png".to_owned());
    assert_eq!(found.keys().cloned().collect::<Vec<_>>(), wanted);
    for (name, input) in PICTURES.iter().chain(&[("store", "store.zarr")]) {
        let words = format!("render scans/{input} -o one.png --force {SMALL}");
        folder.run(&words).assert_done();
        let one = fs::read(folder.path("one.png")).expect("a picture");
        assert!(
            found[&format!("{name}.png")] == one,
            "{name} is not that of {input}"
        );
    }

    let index: Value = serde_json::from_slice(&index).expect("JSON");
    assert_eq!((&index["drawn"], &index["failed"]), (&10.into(), &2.into()));
    let rows = index["volumes"].as_array().expect("rows");
    let row = |input: &str| {
        let found = rows.iter().find(|row| row["input"] == input);
        found.unwrap_or_else(|| panic!("no {input} in {index}"))
    };
    assert_eq!(row("scans/a.nrrd")["dims"], serde_json::json!([5, 5, 5]));
    assert_eq!(row("scans/a.nrrd")["picture"], "a.png");
    let broken = row("scans/broken.nrrd");
    assert!(
        broken["picture"].is_null() && broken["became"] == "failed",
        "{broken}"
    );
    assert!(
        broken["error"]
            .as_str()
            .expect("why")
            .contains("broken.nrrd"),
        "{broken}"
    );

    // Folders inside are looked into when that is asked for, and what is there stays.
    let ran = folder.run(&format!(
        "thumbnails scans -o out --recursive --resume {SMALL}"
    ));
    assert_eq!(ran.code, 3, "{ran:#?}");
    assert!(ran.err.contains("1 drawn, 10 kept, 2 failed"), "{ran:#?}");
    assert!(folder.path("out/deep.png").is_file());
}

#[test]
fn each_series_of_a_folder_and_each_variable_of_a_file_has_its_picture() {
    let folder = Folder::new();
    fs::create_dir(folder.path("study")).expect("a folder");
    let mut file = fs::read(fixture("dicom/enhanced_ct.dcm")).expect("a file");
    folder.file("study/one.dcm", &file);
    // Another UID of the series (0020,000E): its last digit.
    let tag = [0x20, 0, 0x0e, 0, b'U', b'I'];
    let at = file.windows(6).position(|bytes| bytes == tag);
    let at = at.expect("a series") + 8;
    let length = usize::from(file[at - 2]);
    let last = file[at..at + length].iter().rposition(|byte| *byte != 0);
    let last = at + last.expect("a digit");
    file[last] = if file[last] == b'9' { b'8' } else { b'9' };
    folder.file("study/two.dcm", &file);
    fs::copy(fixture("hdf5/latest.h5"), folder.path("one.h5")).expect("a copy");
    let ran = folder.run("info one.h5 --json");
    ran.assert_done();
    let info: Value = serde_json::from_str(&ran.out).expect("JSON");
    let variables = info["variables"].as_array().expect("a list").len();
    assert!(variables > 1, "{info}");
    let ran = folder.run(&format!(
        "thumbnails study one.h5 -o out --variable all --index index.json {SMALL}"
    ));
    let index = fs::read(folder.path("index.json")).expect("an index");
    let index: Value = serde_json::from_slice(&index).expect("JSON");
    let rows = index["volumes"].as_array().expect("rows");
    assert_eq!(rows.len(), 2 + variables, "{index} {ran:#?}");
    for row in rows.iter().filter(|row| row["became"] == "drawn") {
        let part = match (&row["series"], &row["variable"]) {
            (Value::String(uid), _) => format!("--series {uid}"),
            (_, Value::String(name)) => format!("--variable {name}"),
            _ => panic!("{row} is no part"),
        };
        let input = row["input"].as_str().expect("a name");
        folder
            .run(&format!("render {input} {part} -o one.png --force {SMALL}"))
            .assert_done();
        let picture = row["picture"].as_str().expect("a name");
        let same = fs::read(folder.path("out").join(picture)).ok()
            == fs::read(folder.path("one.png")).ok();
        assert!(same, "{picture} is not that of {input} {part}");
    }
    let drawn = rows.iter().filter(|row| row["became"] == "drawn").count();
    assert!(drawn > 3, "{index}");
    // A word takes one.
    let name = info["variables"][0].as_str().expect("a name");
    let ran = folder.run(&format!(
        "thumbnails one.h5 --variable {name} -o few {SMALL}"
    ));
    ran.assert_done();
    assert_eq!(pictures(&folder.path("few")).len(), 1);
}

#[test]
fn of_several_variables_the_first_is_drawn_as_render_draws_it_and_plain_draws_each() {
    let folder = Folder::new();
    fs::copy(fixture("netcdf/wrf.nc"), folder.path("wrf.nc")).expect("a copy");
    let words = format!("thumbnails wrf.nc phantom:storm,n=8 -o out --index index.json {SMALL}");
    let ran = folder.run(&words);
    ran.assert_done();
    let others = ran.err.matches("--variable takes another").count();
    assert_eq!(others, 2, "{ran:#?}");
    assert_eq!(
        pictures(&folder.path("out"))
            .into_keys()
            .collect::<Vec<_>>(),
        ["phantom-storm-n-8.png", "wrf.png"]
    );
    // The file begins with where its levels lie.
    for words in ["", "--variable T"] {
        folder
            .run(&format!("render wrf.nc {words} -o one.png --force {SMALL}"))
            .assert_done();
        let [same, one] = ["out/wrf.png", "one.png"].map(|name| fs::read(folder.path(name)).ok());
        assert!(same.is_some() && same == one, "not that of render {words}");
    }
    let index = fs::read_to_string(folder.path("index.json")).expect("an index");
    assert!(index.contains("\"variable\": \"T\""), "{index}");
    let ran = folder.run(&format!("thumbnails wrf.nc --look plain -o each {SMALL}"));
    ran.assert_done();
    let each = pictures(&folder.path("each"));
    assert!(
        each.len() > 2 && each.contains_key("wrf-T.png"),
        "{:?}",
        each.keys()
    );
}

#[test]
fn flags_are_those_of_render_and_hold_for_every_volume() {
    let folder = Folder::new();
    let flags = "--mode mip --view left --window 10,200 --background 0,0.2,0.4 --bit-depth 16 --size 20x16 --device reference";
    for seed in 0..3 {
        folder.file(&format!("v{seed}.nrrd"), nrrd(5, seed));
    }
    folder.file("w.raw", voxels(4, 9));
    folder
        .run(&format!(
            "thumbnails v0.nrrd v1.nrrd v2.nrrd w.raw phantom:fog,n=8 --raw 4x4x4,u8 -o out {flags}"
        ))
        .assert_done();
    for (picture, input) in [
        ("v0", "v0.nrrd"),
        ("v1", "v1.nrrd"),
        ("v2", "v2.nrrd"),
        ("w", "w.raw --raw 4x4x4,u8"),
        ("phantom-fog-n-8", "phantom:fog,n=8"),
    ] {
        folder
            .run(&format!("render {input} -o one.png --force {flags}"))
            .assert_done();
        let read = |name: &str| fs::read(folder.path(name)).expect("a picture");
        assert!(
            read(&format!("out/{picture}.png")) == read("one.png"),
            "{picture}"
        );
    }
}

#[test]
fn pictures_that_are_there_are_kept_unless_forced() {
    let folder = Folder::new();
    folder.file("a.nrrd", nrrd(4, 1));
    folder.file("a.vol.nrrd", nrrd(4, 2));
    let words = format!("thumbnails a.nrrd a.vol.nrrd -o out {SMALL}");
    folder.run(&words).assert_done();
    let first = pictures(&folder.path("out"));
    folder
        .run(&words)
        .assert_refused(4, &["2 of 2 pictures are there", "--resume", "--force"]);
    fs::remove_file(folder.path("out/a.png")).expect("removed");
    folder.file("out/a.vol.png", "somebody's");
    let ran = folder.run(&format!("{words} --resume"));
    ran.assert_done();
    assert!(ran.err.contains("1 drawn, 1 kept, 0 failed"), "{ran:#?}");
    assert_eq!(
        fs::read(folder.path("out/a.vol.png")).expect("a file"),
        b"somebody's"
    );
    folder.run(&format!("{words} --force")).assert_done();
    assert!(pictures(&folder.path("out")) == first);
    // No force puts a folder in the place of a file.
    let ran = folder.run(&format!("thumbnails a.nrrd -o a.nrrd --force {SMALL}"));
    ran.assert_refused(
        4,
        &["a.nrrd", "it is a file", "into a folder", "-o pictures"],
    );
    assert!(!ran.err.contains("--force"), "{ran:?}");
    // Never over what is read.
    fs::create_dir(folder.path("own")).expect("a folder");
    folder.file("own/b.png", nrrd(4, 3));
    let ran = folder.run(&format!("thumbnails own/b.png -o own --force {SMALL}"));
    assert!(
        ran.code == 4 || folder.path("own/b.png.png").is_file(),
        "{ran:#?}"
    );
    assert_eq!(
        fs::read(folder.path("own/b.png")).expect("a file"),
        nrrd(4, 3)
    );
}

#[test]
fn words_that_cannot_be_followed_are_refused_before_anything_is_drawn() {
    let folder = Folder::new();
    folder.file("a.nrrd", nrrd(4, 1));
    fs::create_dir_all(folder.path("x/s")).expect("a folder");
    fs::create_dir_all(folder.path("y/s")).expect("a folder");
    fs::create_dir(folder.path("none")).expect("a folder");
    for name in ["x/s/a.nrrd", "y/s/a.nrrd", "none/letter.txt"] {
        folder.file(name, nrrd(4, 2));
    }
    folder.file("none/letter.txt", "dear");
    for (words, code, said) in [
        ("a.nrrd -o no/where", 4, "there is no folder"),
        ("x/s y/s -o out", 2, "would both be drawn into s-a.nrrd.png"),
        ("none -o out", 3, "holds no volume"),
        ("a.nrrd -o out --aov depth", 2, "no room for the layers"),
        (
            "a.nrrd -o out --mode xray --iso 3 --preset nonsense",
            2,
            "nonsense",
        ),
        ("a.nrrd -o out --stream", 2, "--stream is for one volume"),
        ("a.nrrd -o out --device nobodys-card", 5, "nobodys-card"),
        ("a.nrrd -o out --path a.nrrd", 2, "--path"),
        ("-o out", 2, "INPUT"),
    ] {
        let ran = folder.run(&format!("thumbnails {words}"));
        assert_eq!(ran.code, code, "{words}: {ran:#?}");
        assert!(ran.err.contains(said), "{words}: {ran:#?}");
        let out = folder.path("out");
        assert!(!out.exists() || pictures(&out).is_empty(), "{words}");
    }
    let ran = folder.run("thumbnails none a.nrrd -o out");
    assert_eq!(ran.code, 3, "{ran:#?}");
    assert!(ran.err.contains("holds no volume"), "{ran:#?}");
    assert_eq!(pictures(&folder.path("out")).len(), 1, "the other is drawn");
    let ran = folder.run("render a.nrrd -o a.png --device reference --device reference");
    ran.assert_refused(2, &["--device", "2 are named", "thumbnails"]);
    let ran = folder.run("bench a.nrrd --device 0 --device 0 --json a.json");
    ran.assert_refused(2, &["--device", "2 are named"]);
}

#[test]
fn progress_names_volumes_in_their_order() {
    let folder = Folder::new();
    for seed in 0..6 {
        folder.file(&format!("v{seed}.nrrd"), nrrd(4 + seed % 3, seed));
    }
    folder.file("v3.nrrd", "NRRD0004\n");
    let ran = folder.run(&format!("thumbnails . -o out --progress json {SMALL}"));
    assert_eq!(ran.code, 3, "{ran:#?}");
    let lines = ran.err.lines().filter(|line| line.starts_with('{'));
    let lines: Vec<Value> = lines
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    let done = lines.iter().filter(|line| line["stage"] == "volumes");
    let done: Vec<u64> = done
        .map(|line| line["done"].as_u64().expect("a count"))
        .collect();
    assert_eq!(done, [0, 1, 2, 3, 4, 5, 6]);
    let volumes: Vec<&Value> = lines
        .iter()
        .filter(|line| line["volume"].is_string())
        .collect();
    for (k, line) in volumes.iter().enumerate() {
        assert_eq!(line["volume"], format!("./v{k}.nrrd"));
        assert_eq!(line["error"].is_null(), k != 3, "{line}");
    }
    assert_eq!(volumes.len(), 6);
}

#[test]
fn a_volume_too_large_is_drawn_with_fewer_voxels_and_the_others_as_they_are() {
    const SIDE: u64 = 160;
    let folder = Folder::new();
    let file = fs::File::create(folder.path("large.raw")).expect("a file");
    file.set_len(SIDE.pow(3) * 2).expect("a length");
    folder.file("small.nrrd", nrrd(5, 1));
    let ran = folder.run(&format!(
        "thumbnails small.nrrd large.raw --raw {SIDE}x{SIDE}x{SIDE},u16 --max-memory 5M --mode mip -o out --index i.json {SMALL}"
    ));
    ran.assert_done();
    assert!(
        ran.err.contains("large.raw: ") && ran.err.contains("to 80 x 80 x 80"),
        "{ran:#?}"
    );
    let index: Value =
        serde_json::from_slice(&fs::read(folder.path("i.json")).expect("a file")).expect("JSON");
    assert_eq!(index["volumes"][0]["dims"], serde_json::json!([5, 5, 5]));
    assert_eq!(index["volumes"][1]["dims"], serde_json::json!([80, 80, 80]));
}
