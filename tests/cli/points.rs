//! Scattered points from a file to a picture. Drawn by the CPU reference.

use crate::person::{Folder, Ran};

const SMALL: &str = "--size 40x30 --device reference --force";

/// Points on a spiral; the later, the larger the value.
fn table(separator: char) -> String {
    let row = |i: u32| {
        let t = f64::from(i);
        let numbers = [(0.3 * t).cos() * t, (0.3 * t).sin() * t, 0.5 * t, t];
        numbers.map(|n| format!("{n}")).join(&separator.to_string())
    };
    let names = ["x", "y", "z", "strength"].join(&separator.to_string());
    let rows: Vec<_> = [names].into_iter().chain((0..60).map(row)).collect();
    rows.join("\n")
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.file("p.csv", table(','));
    folder
}

/// How many pixels of a picture are drawn.
fn drawn(folder: &Folder, words: &str) -> (usize, Ran) {
    let ran = folder.run(&format!("render --look plain {words} -o p.npy {SMALL}"));
    ran.assert_done();
    let bytes = std::fs::read(folder.path("p.npy")).expect("a picture");
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let alphas = bytes[start..].chunks_exact(16).map(|pixel| &pixel[12..]);
    let alphas = alphas.map(|b| f32::from_le_bytes(b.try_into().expect("four")));
    (alphas.filter(|&alpha| alpha > 1e-3).count(), ran)
}

#[test]
fn points_are_splatted_without_a_flag_and_what_was_chosen_is_said() {
    let folder = folder();
    let (count, ran) = drawn(&folder, "p.csv");
    assert!(count > 100, "{count}");
    for words in [
        "the value of a point is strength",
        "60 points were read",
        "by the distances of neighbours",
    ] {
        assert!(ran.err.contains(words), "{}", ran.err);
    }
    folder.file("p.tsv", table('\t'));
    assert_eq!(drawn(&folder, "p.tsv").0, count);
    folder.file("semicolons.csv", table(';'));
    assert_eq!(drawn(&folder, "semicolons.csv").0, count);
    let (wide, ran) = drawn(&folder, "p.csv --splat-std 4");
    assert!(
        wide > count && !ran.err.contains("distances"),
        "{wide} {count}"
    );
    let (other, _) = drawn(&folder, "p.csv --point-columns x=z,y=x,z=y,value=x");
    assert!(other > 100, "{other}");
    // The header of version 1.0 and six rows of four floats.
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (6, 4), }";
    let mut npy = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    npy.extend(format!("{header:<117}\n").bytes());
    let numbers = (0..24).map(|i| (i * i % 17) as f32);
    npy.extend(numbers.flat_map(f32::to_le_bytes));
    folder.file("p6.npy", npy);
    assert!(drawn(&folder, "p6.npy --points").0 > 10);
    // Without the word it is an image, and both ways to that mistake say the word.
    let (_, image) = drawn(&folder, "p6.npy");
    let note = "--points takes them as scattered points";
    assert!(image.err.contains(note), "{}", image.err);
    folder
        .run(&format!(
            "render p6.npy --points-as splats -o p.npy {SMALL}"
        ))
        .assert_refused(2, &["--points takes the rows of an array"]);
    for mode in ["mip", "minip", "average", "xray"] {
        assert!(
            drawn(&folder, &format!("p.csv --mode {mode}")).0 > 50,
            "{mode}"
        );
    }
}

#[test]
fn many_points_are_framed_by_their_box_and_few_by_what_is_seen() {
    let folder = folder();
    let framed = |name: &str| {
        let ran = folder.run(&format!("render {name} -o q.png {SMALL}"));
        ran.assert_done();
        ran.err
    };
    assert!(framed("p.csv").contains("framed to what is visible"));
    let row = |i: u32| format!("{},{},{},1\n", i % 37, i % 41, i % 43);
    let rows: String = (0..50_001).map(row).collect();
    folder.file("many.csv", format!("x,y,z,v\n{rows}"));
    let said = framed("many.csv");
    assert!(said.contains("framed to the box"), "{said}");
}

#[test]
fn where_a_volume_is_told_it_is_said_that_it_is_one_of_means() {
    let folder = folder();
    let ran = folder.run("info p.csv");
    ran.assert_done();
    let all = format!("{}{}", ran.out, ran.err);
    assert!(all.contains("volume of their means"), "{all}");
    let (_, ran) = drawn(&folder, "p.csv");
    assert!(!ran.err.contains("volume of their means"), "{}", ran.err);
    let ran = folder.run(&format!("render p.csv --clip 1,0,0,1000 -o e.png {SMALL}"));
    ran.assert_done();
    assert!(
        ran.err.contains("is cut away") || ran.err.contains("no point"),
        "{}",
        ran.err
    );
}

#[test]
fn a_saved_scene_of_points_draws_the_same_picture() {
    let folder = folder();
    folder
        .run(&format!(
            "render p.csv -o a.png --save-scene s.json {SMALL}"
        ))
        .assert_done();
    folder
        .run("render --scene s.json -o b.png --device reference")
        .assert_done();
    let read = |name| std::fs::read(folder.path(name)).expect("a picture");
    assert!(read("a.png") == read("b.png"));
}

#[test]
fn what_points_do_not_have_is_refused_by_name() {
    let folder = folder();
    for (words, said) in [
        ("p.csv --technique raycast", "scattered points are splatted"),
        ("p.csv --section axial", "--section"),
        ("p.csv --labels p.csv", "--labels"),
        ("p.csv --component 0", "--component"),
        ("p.csv --with v.nrrd", "--with is for volumes"),
        (
            "p.csv --opacity-from p.csv",
            "--opacity-from is for volumes",
        ),
        ("p.csv --preclassified", "--preclassified is for volumes"),
        ("p.csv --sheets axis", "sheets axis"),
        ("p.csv --shading phong", "not lit"),
        ("p.csv --untrusted", "--untrusted"),
        ("p.csv --mode mip --aov depth", "--aov depth"),
        ("p.csv --point-columns x=", "--point-columns"),
        ("phantom:sphere,n=8 --points", "--points"),
        ("p.csv --map", "--points-as spheres"),
    ] {
        let ran = folder.run(&format!("render {words} -o q.exr {SMALL}"));
        ran.assert_refused(2, &[said]);
    }
    let ran = folder.run(&format!(
        "render p.csv --point-columns value=weight -o q.png {SMALL}"
    ));
    ran.assert_refused(3, &["p.csv", "weight", "strength"]);
    assert_eq!(folder.names(), ["p.csv"]);
}

#[test]
fn thumbnails_and_sheets_splat_points_too() {
    let folder = folder();
    let ran = folder.run("thumbnails p.csv -o t --size 40x30 --device reference");
    ran.assert_done();
    assert!(!ran.err.contains("hold no data"), "{}", ran.err);
    let ran = folder.run("sheet p.csv -o s.png --device reference");
    ran.assert_done();
    assert!(!ran.err.contains("hold no data"), "{}", ran.err);
}

#[test]
fn points_over_the_date_line_are_one_box_and_files_say_what_they_do_not_keep() {
    let folder = Folder::new();
    let row = |i: u32| {
        let longitude = 170.0 + f64::from(i);
        let wrapped = if longitude > 180.0 {
            longitude - 360.0
        } else {
            longitude
        };
        format!(
            "{wrapped},{},{},{i}",
            -20.0 + f64::from(i % 5),
            10.0 * f64::from(i % 3)
        )
    };
    let rows: Vec<_> = ["lon,lat,depth_km,magnitude".to_owned()]
        .into_iter()
        .chain((0..20).map(row))
        .collect();
    folder.file("q.csv", rows.join("\n"));
    let ran = folder.run("convert q.csv -o q.nrrd --grid 20x8x4 --interpolate idw");
    ran.assert_done();
    for words in [
        "longitudes go over the date line: they count from 170.00 to 189.00",
        "the file does not keep that the world is a piece of the Earth",
    ] {
        assert!(ran.err.contains(words), "{ran:#?}");
    }
    let info = folder.run("info q.nrrd --json");
    let info: serde_json::Value = serde_json::from_str(&info.out).expect("JSON");
    let spacing = info["spacing"][0].as_f64().expect("a length");
    // 19 degrees at 18 south: 111.195 km cos 18 each, and a voxel's edge.
    let extent = 19.0 * 111.195 * 18_f64.to_radians().cos();
    assert!(
        (extent / 20.0..=extent / 18.0).contains(&spacing),
        "{spacing}"
    );
    folder
        .run("convert q.csv -o r.nrrd --interpolate natural")
        .assert_refused(2, &["--interpolate natural: not built yet", "shepard, idw"]);
}
