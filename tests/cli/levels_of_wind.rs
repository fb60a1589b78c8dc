//! A wind on levels that are only numbers, and one on a grid of the whole Earth: what is said of places and winds, and by whom.

use crate::netcdf::{Variable, netcdf};
use crate::person::{Folder, Ran};
use std::fs;

/// Steps of both axes, degrees.
const STEP: f64 = 10.0;

/// Winds u, v and w over 4 levels, 7 latitudes from -30 and 9 longitudes from 0, the first level the highest.
fn file() -> Vec<u8> {
    let axis = |name, texts, values: Vec<f64>, dimension| Variable {
        name,
        dimensions: dimension,
        texts,
        numbers: &[],
        values,
    };
    let even = |first: f64, count: u32| (0..count).map(|i| first + STEP * f64::from(i)).collect();
    let wind = |name, texts, value: f64| Variable {
        name,
        dimensions: &[0, 1, 2],
        texts,
        numbers: &[],
        values: vec![value; 4 * 7 * 9],
    };
    netcdf(
        &[("hybrid", 4), ("lat", 7), ("lon", 9)],
        &[],
        &[
            axis(
                "hybrid",
                &[("long_name", "hybrid level"), ("positive", "down")],
                vec![1.0, 2.0, 3.0, 4.0],
                &[0],
            ),
            axis("lat", &[("units", "degrees_north")], even(-30.0, 7), &[1]),
            axis("lon", &[("units", "degrees_east")], even(0.0, 9), &[2]),
            wind("u", &[("units", "m s-1")], 10.0),
            wind("v", &[], 5.0),
            wind("w", &[("units", "m s-1")], 1.0),
        ],
    )
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.file("l.nc", file());
    folder
}

/// How often the program said it.
fn count(ran: &Ran, words: &str) -> usize {
    ran.err.matches(words).count()
}

#[test]
fn levels_without_heights_are_levels_in_words_files_and_pictures() {
    let folder = folder();
    let barbs = folder.run("render l.nc --variable u --barbs=1 -o b.png --size 80x60");
    barbs.assert_done();
    assert!(barbs.err.contains("50 kt, at level 1, every"), "{barbs:#?}");
    let metres = folder.run("render l.nc --variable u --barbs=500m -o c.png --size 80x60");
    let said = "--barbs 500m: levels of the input are only numbers: wanted one from 0 to 3";
    assert!(metres.code == 2 && metres.err.contains(said), "{metres:#?}");
    folder.file("seeds.csv", "lon,lat,level\n20,-10,2\n40,5,0.5\n");
    let lines = folder
        .run("convert l.nc -o l.csv --flow stream --flow-seeds seeds.csv --flow-direction forward");
    lines.assert_done();
    let left_out = "levels are only numbers: without heights the upward wind is left out";
    assert!(lines.err.contains(left_out), "{lines:#?}");
    let text = fs::read_to_string(folder.path("l.csv")).expect("lines");
    assert!(text.starts_with("line,time,x,y,z,lon,lat,level,value\n"));
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|row| {
            row.split(',')
                .map(|n| n.parse().expect("a number"))
                .collect()
        })
        .collect();
    for (line, seed) in [[20.0, -10.0, 2.0], [40.0, 5.0, 0.5]].iter().enumerate() {
        let mut own = rows.iter().filter(|row| row[0] == line as f64).peekable();
        let first = own.peek().expect("a line");
        for (found, wanted) in first[5..8].iter().zip(seed) {
            assert!((found - wanted).abs() < 1e-9, "{first:?}");
        }
        assert!(own.all(|row| (row[7] - seed[2]).abs() < 1e-9));
    }
    for (name, wanted) in [
        (
            "height",
            "it has heights, and levels of the wind are only numbers",
        ),
        ("pressure", "only numbers: lon,lat,level are wanted"),
    ] {
        folder.file("other.csv", format!("lon,lat,{name}\n20,-10,2\n"));
        let ran = folder.run("convert l.nc -o m.csv --flow stream --flow-seeds other.csv");
        assert!(ran.code == 3 && ran.err.contains(wanted), "{ran:#?}");
    }
}

#[test]
fn what_was_taken_as_the_wind_is_said_once_by_every_command() {
    let folder = folder();
    let wind = "--flow stream --flow-seeds random:9 --wind u,v,none";
    let small = "--variable u --size 40x30";
    for words in [
        format!("convert l.nc -o a.csv {wind}"),
        format!("render l.nc -o a.png {wind} {small}"),
        format!("render l.nc -o b.png {wind} --barbs=0 {small}"),
        format!("animate l.nc -o f%d.png --turntable 3 {wind} {small}"),
    ] {
        let ran = folder.run(&words);
        ran.assert_done();
        for said in [
            "the wind is u, v, without an upward variable: lines stay in their level",
            "without a unit, and taken as m s-1: v",
            "the world is in kilometres",
            "are only numbers: they are spread evenly",
        ] {
            assert_eq!(count(&ran, said), 1, "{words}: {said}: {ran:#?}");
        }
    }
}

#[test]
fn words_of_lines_go_with_a_scene_that_draws_lines_and_with_no_other() {
    let folder = folder();
    let storm = "phantom:storm,n=16";
    let small = "-o a.png --force --size 40x30";
    for show in ["wind", "both"] {
        let words = "--flow-seeds random:9 --flow-direction forward --flow-color w --flow-length 9 --flow-time 1h \
                     --flow-style tube --flow-width 2 --flow-range 0,5 --flow-colormap viridis";
        let ran = folder.run(&format!("render {storm} --show {show} {words} {small}"));
        ran.assert_done();
        assert!(ran.err.contains("9 lines of"), "{ran:#?}");
    }
    for word in [
        "--flow-seeds random:9",
        "--flow-direction forward",
        "--flow-color w",
        "--flow-length 9",
        "--flow-time 1h",
        "--flow-style tube",
        "--comet-time 1h",
        "--flow-width 2",
        "--flow-range 0,5",
        "--flow-colormap viridis",
    ] {
        let name = word.split(' ').next().unwrap_or_default();
        let wanted = [name, "none are drawn", "--flow stream"];
        folder
            .run(&format!("render {storm} --variable vapor {word} {small}"))
            .assert_refused(2, &wanted);
        folder
            .run(&format!("render {storm} --show vapor {word} {small}"))
            .assert_refused(2, &wanted);
    }
    folder
        .run("convert l.nc -o a.nrrd --variable u --flow-color u")
        .assert_refused(2, &["--flow-color is of lines", "--flow stream"]);
}

#[test]
fn a_surface_that_nobody_sees_is_said_beside_lines() {
    let folder = folder();
    let small = "-o a.png --force --size 60x40";
    let storm = "phantom:storm,n=16";
    let unseen = "nothing of the volume is seen: no ray meets the level 900; values run from";
    for show in ["vapor", "both"] {
        let ran = folder.run(&format!("render {storm} --show {show} --iso 900 {small}"));
        ran.assert_done();
        let empty = "the picture is empty: no ray meets the level 900; values run from";
        let wanted = if show == "both" { unseen } else { empty };
        assert!(ran.err.contains(wanted), "{ran:#?}");
    }
    let ran = folder.run(&format!(
        "render l.nc --variable u --mode iso --iso 900 --map graticule=10 {small}"
    ));
    ran.assert_done();
    assert!(ran.err.contains(unseen), "{ran:#?}");
    let film = folder.run(&format!(
        "animate {storm},times=3 --show both --iso 900 --between 0 -o f%d.png --size 60x40"
    ));
    film.assert_done();
    assert!(
        film.err
            .contains("3 of 3 frames show nothing of the volume, frame 0"),
        "{film:#?}"
    );
    // What is seen is not told of.
    let seen = folder.run(&format!("render {storm} --show both {small}"));
    assert!(!seen.err.contains("is seen:"), "{seen:#?}");
}

#[test]
fn work_without_end_is_refused_by_name() {
    let folder = folder();
    for (words, wanted) in [
        (
            "phantom:storm,n=16 --variable vapor --flow stream --flow-seeds even:1",
            "--flow-seeds even:1: wanted a distance of at least 1.",
        ),
        (
            "l.nc --variable u --map graticule=0.1",
            "--map graticule=0.1: wanted at most 360 meridians and parallels",
        ),
        (
            "phantom:storm,n=16 --variable vapor --flow stream --flow-width 17",
            "--flow-width 17: wanted at most 16 pixels of a picture of 40 rows",
        ),
        (
            "phantom:storm,n=16 --variable vapor --flow stream --flow-range 5,5",
            "--flow-range 5,5: wanted LO,HI",
        ),
        (
            "phantom:storm,n=16 --variable vapor --flow stream --flow-range 9,5",
            "--flow-range 9,5: wanted LO,HI",
        ),
        (
            "phantom:storm,n=16 --variable vapor --flow stream --wind u,u",
            "found u twice",
        ),
        (
            "phantom:storm,n=16 --variable vapor --flow stream --filter cubic",
            "--flow with --filter cubic: lines follow the linear field",
        ),
    ] {
        folder
            .run(&format!("render {words} -o a.png --size 60x40"))
            .assert_refused(2, &[wanted]);
    }
    assert_eq!(folder.names(), ["l.nc"]);
}

#[test]
fn a_variable_that_is_not_there_is_named_before_lines_are_traced() {
    let folder = folder();
    let ran = folder.run(
        "convert l.nc -o a.csv --flow stream --flow-seeds random:9 --flow-color nothing --progress json",
    );
    assert!(
        ran.code == 3 && ran.err.contains("found `nothing`"),
        "{ran:#?}"
    );
    assert!(!ran.err.contains("\"trace\""), "{ran:#?}");
}
