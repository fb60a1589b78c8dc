//! Scattered points on a grid: converted, and drawn as any volume is.

use crate::person::{Folder, Ran};
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

/// Points of a box of 4 by 3 by 2, none of them on a lattice, with a value that is linear in their places.
fn table(count: u32) -> String {
    let share = |i: u32, step: f64| (f64::from(i) * step).fract();
    let row = |i: u32| {
        let [x, y, z] = [
            4.0 * share(i, 0.7548),
            3.0 * share(i, 0.5698),
            2.0 * share(i, 0.3712),
        ];
        format!("{x},{y},{z},{}\n", 1.0 + x - 0.5 * y + 2.0 * z)
    };
    format!("x,y,z,v\n{}", (0..count).map(row).collect::<String>())
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.file("p.csv", table(80));
    folder
}

fn done(folder: &Folder, words: &str) -> Ran {
    let ran = folder.run(words);
    ran.assert_done();
    ran
}

#[test]
fn a_picture_of_points_on_a_grid_is_that_of_the_file_they_are_converted_to() {
    let folder = folder();
    for (words, picture) in [
        ("", ""),
        ("--grid 12x10x8", "--mode mip"),
        (
            "--grid 0.3 --interpolate idw --reach 1.5",
            "--mode iso --iso 3 --shading phong",
        ),
        (
            "--interpolate nearest --anisotropy 2",
            "--technique slices-2d",
        ),
        (
            "--interpolate kernel --reach 1.2",
            "--mode average --view left",
        ),
        ("--interpolate density", "--technique splat --mode xray"),
    ] {
        let said = done(&folder, &format!("convert p.csv -o f.nrrd --force {words}")).err;
        assert!(said.contains("interpolated by"), "{said}");
        let draw = |input: &str, output: &str| {
            let small = "--look plain --size 40x30 --device reference --force";
            done(
                &folder,
                &format!("render {input} {picture} {small} -o {output}"),
            )
            .err
        };
        let said = draw(&format!("p.csv --points-as grid {words}"), "a.npy");
        assert!(said.contains("interpolated by"), "{said}");
        draw("f.nrrd", "b.npy");
        let read = |name| fs::read(folder.path(name)).expect("a picture");
        assert!(read("a.npy") == read("b.npy"), "{words} {picture}");
    }
}

#[test]
fn a_linear_field_is_linear_on_the_grid() {
    let folder = folder();
    done(&folder, "convert p.csv -o f.npy --grid 9x7x5 --reach 100");
    let bytes = fs::read(folder.path("f.npy")).expect("an array");
    let floats = bytes[bytes.len() - 4 * 9 * 7 * 5..].chunks(4);
    let floats: Vec<f32> = floats
        .map(|b| f32::from_le_bytes(b.try_into().expect("four")))
        .collect();
    // Along each row, column and pile the same step everywhere.
    for step in [1, 9, 63] {
        let steps = |i: usize| floats[i + step] - floats[i];
        let is_inside = |i: usize| match step {
            1 => i % 9 < 8,
            9 => i / 9 % 7 < 6,
            _ => i / 63 < 4,
        };
        let wanted = steps(0);
        for i in (0..floats.len()).filter(|&i| is_inside(i)) {
            assert!(
                (steps(i) - wanted).abs() < 1e-5,
                "{i} {step}: {} {wanted}",
                steps(i)
            );
        }
    }
}

#[test]
fn the_grid_of_nobody_is_said_and_missing_data_are_none() {
    let folder = folder();
    folder.file(
        "two.csv",
        format!("{}90,0,0,5\n90,1,0,6\n91,0,1,6\n", table(80)),
    );
    let ran = done(&folder, "convert two.csv -o f.nrrd --interpolate idw");
    assert!(ran.err.contains("on 256 x"), "{}", ran.err);
    let info = done(&folder, "info f.nrrd");
    let all = format!("{}{}", info.out, info.err);
    assert!(all.contains("not finite"), "{all}");
    // One layer of what lies in one plane.
    let flat: String = table(80)
        .lines()
        .map(|line| {
            let fields: Vec<_> = line.split(',').collect();
            let z = if fields[2] == "z" { "z" } else { "5" };
            format!("{},{},{z},{}\n", fields[0], fields[1], fields[3])
        })
        .collect();
    folder.file("flat.csv", flat);
    let ran = done(
        &folder,
        "convert flat.csv -o flat.nrrd --grid 20x15x9 --interpolate idw",
    );
    assert!(ran.err.contains("one layer thick"), "{}", ran.err);
    assert!(ran.err.contains("20 x 15 x 1 voxels"), "{}", ran.err);
}

#[test]
fn a_saved_scene_keeps_the_grid() {
    let folder = folder();
    let words = "--grid 12x10x8 --interpolate idw --reach 2 --anisotropy 1.5";
    done(
        &folder,
        &format!(
            "render p.csv --points-as grid {words} --size 40x30 -o a.png --save-scene s.json --device reference"
        ),
    );
    let said = done(&folder, "render --scene s.json -o b.png --device reference").err;
    assert!(said.contains("by idw on 12 x 10 x 8"), "{said}");
    let read = |name| fs::read(folder.path(name)).expect("a picture");
    assert!(read("a.png") == read("b.png"));
    let text = String::from_utf8(read("s.json")).expect("text");
    assert!(
        text.contains("\"12x10x8\"") && text.contains("\"idw\""),
        "{text}"
    );
}

#[test]
fn films_sheets_and_surfaces_are_of_the_grid_too() {
    let folder = folder();
    done(
        &folder,
        "animate p.csv --points-as grid --grid 10x8x6 --turntable 2 --size 32x24 -o f.gif --device reference",
    );
    done(
        &folder,
        "thumbnails p.csv --points-as grid --grid 10x8x6 -o t --size 32x24 --device reference",
    );
    done(&folder, "convert p.csv -o s.ply --iso 3 --grid 10x8x6");
    assert!(fs::metadata(folder.path("s.ply")).expect("a surface").len() > 500);
}

#[test]
fn what_makes_no_grid_is_refused_by_name() {
    let folder = folder();
    folder.file("three.csv", "x,y,z,v\n0,0,0,1\n1,0,0,2\n0,1,0,3\n");
    folder.file("line.csv", "x,y,z,v\n0,0,0,1\n1,1,1,2\n2,2,2,3\n3,3,3,4\n");
    for (words, said) in [
        (
            "three.csv",
            &[
                "three.csv: 3 points: wanted at least 11 for shepard",
                "--interpolate idw",
            ][..],
        ),
        ("line.csv --interpolate idw", &["line.csv", "one line"]),
        (
            "p.csv --grid 1e-9",
            &["p.csv: a grid of", "TiB", "--grid auto"],
        ),
        (
            "p.csv --grid 400000x400000x400000",
            &["400000 x 400000 x 400000 voxels takes", "TiB"],
        ),
        ("p.csv --grid 4x4", &["--grid", "64x64x32"]),
        ("p.csv --grid 0", &["--grid"]),
        ("p.csv --interpolate cubic", &["cubic", "shepard"]),
        ("p.csv --reach 0", &["--reach"]),
        ("p.csv --anisotropy 0", &["--anisotropy"]),
        ("phantom:sphere,n=8 --grid auto", &["scattered points"]),
    ] {
        folder
            .run(&format!("convert {words} -o q.nrrd"))
            .assert_refused(2, said);
        let as_grid = format!("render {words} --points-as grid -o q.png --size 20x20");
        folder
            .run(&as_grid)
            .assert_refused(2, &said[..said.len().min(1)]);
    }
    for words in [
        "--grid auto",
        "--interpolate idw",
        "--reach 3",
        "--points-as splats --anisotropy 2",
    ] {
        let ran = folder.run(&format!("render p.csv {words} -o q.png --size 20x20"));
        ran.assert_refused(2, &["--points-as grid"]);
    }
    folder
        .run("render p.csv --points-as grid --grid 1e-9 --stream -o q.png")
        .assert_refused(2, &["TiB"]);
    assert_eq!(folder.names(), ["line.csv", "p.csv", "three.csv"]);
}

#[test]
fn it_is_told_how_far_the_grid_is_and_an_interrupt_leaves_no_file() {
    let folder = folder();
    // Some seconds of a core.
    let words = "convert p.csv -o f.nrrd --grid 200x200x200 --interpolate idw --progress json";
    let mut child = folder
        .command(words)
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let stderr = BufReader::new(child.stderr.take().expect("a pipe"));
    let line = stderr
        .lines()
        .map_while(Result::ok)
        .find(|line| line.contains("\"part\""));
    let line: serde_json::Value = serde_json::from_str(&line.expect("a part")).expect("JSON");
    assert_eq!(line["stage"], "interpolate");
    let part = line["part"].as_f64().expect("a number");
    assert!(part > 0.0 && part < 1.0, "{part}");
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.expect("kill runs").success());
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    assert_eq!(folder.names(), ["p.csv"]);
}
