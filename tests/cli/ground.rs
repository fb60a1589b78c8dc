//! The ground in pictures: `ground.nc` rises by 20 m a degree to the east, where it is a kelvin warmer a degree.

use crate::person::Folder;
use std::fs;

const SIDE: usize = 100;
/// 10 degrees are 20 pixels, 15 degrees east and the equator lie in the middle.
const VIEW: &str = "--look plain --hide-volume --projection orthographic --view-height 5559.755 --size 100x100 --background none";
const ABOVE: &str = "--eye 1667.9264,0,9999 --target 1667.9264,0,0 --up 0,1,0";

fn ground() -> String {
    format!(
        "{}/tests/fixtures/netcdf/ground.nc",
        env!("CARGO_MANIFEST_DIR")
    )
}

fn pixels(folder: &Folder, words: &str) -> Vec<[f32; 4]> {
    let ran = folder.run(&format!(
        "render {} --variable ua {words} {VIEW} -o a.npy --force",
        ground()
    ));
    ran.assert_done();
    read(folder, "a.npy")
}

fn read(folder: &Folder, name: &str) -> Vec<[f32; 4]> {
    let bytes = fs::read(folder.path(name)).expect("a picture");
    let numbers = &bytes[bytes.len() - 16 * SIDE * SIDE..];
    let number = |b: &[u8]| f32::from_le_bytes(b.try_into().expect("four bytes"));
    let pixel = |b: &[u8]| [0, 4, 8, 12].map(|i| number(&b[i..i + 4]));
    numbers.chunks(16).map(pixel).collect()
}

/// Linear light of an sRGB grey.
fn linear(grey: f64) -> f64 {
    if grey <= 0.04045 {
        grey / 12.92
    } else {
        ((grey + 0.055) / 1.055).powf(2.4)
    }
}

#[test]
fn the_ground_has_the_colours_of_its_numbers() {
    let folder = Folder::new();
    for (time, warmer) in [(0, 0.0), (1, 10.0)] {
        let words = format!(
            "--ground t2m --ground-colormap grey --ground-range 270,330 --time {time} {ABOVE}"
        );
        let found = pixels(&folder, &words);
        for (i, [r, g, b, a]) in found.iter().enumerate() {
            let [x, y] = [i % SIDE, i / SIDE].map(|n| n as f64 + 0.5);
            // The box goes from 5 degrees west to 35 degrees east, 40 degrees up.
            let degrees = 15.0 + 0.5 * (x - 50.0);
            let is_inside = (-5.0..=35.0).contains(&degrees) && (10.0..=90.0).contains(&y);
            assert_eq!(*a, if is_inside { 1.0 } else { 0.0 }, "pixel {i}");
            if !is_inside {
                continue;
            }
            // Between columns colours are mixed in linear light.
            let column = ((degrees.clamp(0.0, 30.0) / 10.0).floor()).min(2.0);
            let part = degrees.clamp(0.0, 30.0) / 10.0 - column;
            let of = |column: f64| linear((10.0 + warmer + 10.0 * column) / 60.0);
            let wanted = (1.0 - part) * of(column) + part * of(column + 1.0);
            for c in [r, g, b] {
                assert!(
                    (f64::from(*c) - wanted).abs() < 3e-3,
                    "pixel {i}: {c}, {wanted}"
                );
            }
        }
    }
}

#[test]
fn levels_of_a_volume_colour_the_ground_too() {
    let folder = Folder::new();
    let of = |word: &str| {
        pixels(
            &folder,
            &format!("--ground {word} --ground-colormap grey --ground-range 0,40 {ABOVE}"),
        )
    };
    let knots = |knots: f64| linear(knots * 1852.0 / 3600.0 / 40.0);
    for (word, wanted) in [
        ("ua", knots(25.0)),
        ("ua,1", knots(50.0)),
        ("ua,500m", knots(37.5)),
        ("ua,1.25km", knots(2.0)),
    ] {
        let found = f64::from(of(word)[50 * SIDE + 50][1]);
        assert!((found - wanted).abs() < 3e-3, "{word}: {found}, {wanted}");
    }
}

#[test]
fn terrain_is_as_high_as_the_ground_is_and_lines_lie_on_it() {
    let folder = Folder::new();
    // From the south, a pixel 55.59755 km; heights of 600 m are 1800 km.
    let south = "--eye 1667.9264,-99999,0 --target 1667.9264,0,0 --up 0,0,1 --exaggerate 3000";
    let top = |found: &[[f32; 4]], x: usize| (0..SIDE).find(|y| found[y * SIDE + x][3] > 0.0);
    let terrain = pixels(&folder, &format!("--map terrain {south}"));
    let lined = pixels(&folder, &format!("--map graticule=10,terrain {south}"));
    for x in 0..SIDE {
        let degrees = 15.0 + 0.5 * (x as f64 + 0.5 - 50.0);
        let found = top(&terrain, x);
        if !(-5.0..=35.0).contains(&degrees) {
            assert_eq!(found, None, "column {x}");
            continue;
        }
        let kilometres = 0.02 * degrees.clamp(0.0, 30.0) * 3000.0;
        let wanted = 50.0 - kilometres / 55.597_55;
        let Some(found) = found else {
            assert!(kilometres < 60.0, "column {x}");
            continue;
        };
        let found = found as f64;
        // Level ground at sea level is seen from its edge.
        assert!(
            (found - wanted).abs() <= 1.0 || kilometres < 60.0,
            "column {x}: {found}, {wanted}"
        );
        // Parallels lie on it: no higher than they are thick.
        let lined = top(&lined, x).expect("ground") as f64;
        assert!(
            (found - lined).abs() <= 2.0 || kilometres < 120.0,
            "column {x}: {found}, {lined}"
        );
    }
    // Below the ground there is a wall down to the sea, and nothing under that.
    assert!(terrain[45 * SIDE + 70][3] == 1.0 && terrain[55 * SIDE + 70][3] == 0.0);
}

#[test]
fn barbs_whose_level_lies_below_the_ground_stand_on_it() {
    let folder = Folder::new();
    let south = "--eye 1667.9264,-99999,0 --target 1667.9264,0,0 --up 0,0,1 --exaggerate 3000";
    let found = pixels(&folder, &format!("--barbs=0 {south}"));
    let rows = |x: usize| {
        (0..SIDE)
            .filter(|y| found[y * SIDE + x][3] > 0.0)
            .collect::<Vec<_>>()
    };
    // Level 0 lies at 250 m, 13.5 pixels up; the ground of 20 and 30 degrees east at 400 and 600 m, 21.6 and 32.4.
    for (x, wanted) in [(18, 36.5), (38, 36.5), (58, 28.4), (78, 17.6)] {
        let rows = rows(x);
        assert!(!rows.is_empty(), "column {x}");
        assert!(
            rows.iter().all(|&y| (y as f64 + 0.5 - wanted).abs() < 2.0),
            "column {x}: {rows:?}"
        );
    }
}

#[test]
fn a_film_has_one_range_for_all_its_times_and_frames_between_them() {
    let folder = Folder::new();
    let words = format!("--ground t2m --ground-colormap grey {VIEW} {ABOVE}");
    let ran = folder.run(&format!(
        "animate {} --variable ua {words} --times --between 1 -o f%d.npy --force",
        ground()
    ));
    ran.assert_done();
    assert!(
        ran.err
            .contains("the ground is coloured by t2m, from 280 to 320 K"),
        "{ran:#?}"
    );
    for (frame, warmer) in [(0, 0.0), (1, 5.0), (2, 10.0)] {
        let found = f64::from(read(&folder, &format!("f{frame}.npy"))[50 * SIDE + 40][1]);
        // A quarter of a degree east of a column.
        let of = |kelvins: f64| linear((kelvins + warmer) / 40.0);
        let wanted = 0.975 * of(10.0) + 0.025 * of(20.0);
        assert!(
            (found - wanted).abs() < 4e-3,
            "frame {frame}: {found}, {wanted}"
        );
    }
}

#[test]
fn the_ground_has_a_bar_of_its_own() {
    let folder = Folder::new();
    let words =
        "--look plain --variable ua --hide-volume --ground t2m --size 240x160 --background black";
    for (name, annotate) in [("a.png", "--annotate bar"), ("b.png", "")] {
        folder
            .run(&format!("render {} {words} {annotate} -o {name}", ground()))
            .assert_done();
    }
    let read = |name: &str| fs::read(folder.path(name)).expect(name);
    assert_ne!(read("a.png"), read("b.png"));
}

#[test]
fn a_ground_that_is_not_there_is_refused_by_name() {
    let folder = Folder::new();
    let theta = format!(
        "{}/tests/fixtures/netcdf/theta.nc",
        env!("CARGO_MANIFEST_DIR")
    );
    for (input, words, wanted) in [
        (ground(), "--ground nothing", "nothing"),
        (
            ground(),
            "--ground t2m,850hPa",
            "heights of the input are no pressures",
        ),
        (
            ground(),
            "--ground ua,7",
            "--ground 7: wanted a level from 0 to 2",
        ),
        (ground(), "--ground ua,9km", "there are no data"),
        (
            ground(),
            "--ground t2m,x",
            "wanted a level such as 0, or a height",
        ),
        (ground(), "--ground-range 0,1", "--ground"),
        (
            ground(),
            "--ground t2m --ground-range 303,301",
            "--ground-range 303,301: wanted LO,HI",
        ),
        (
            ground(),
            "--ground t2m --ground-colormap jet",
            "no colour map",
        ),
        (
            theta,
            "--variable pot --map terrain",
            "no height of the ground in the input",
        ),
    ] {
        let variable = if words.contains("--variable") {
            ""
        } else {
            "--variable ua"
        };
        let ran = folder.run(&format!(
            "render {input} {variable} {words} -o a.png --size 20x20"
        ));
        assert!([2, 3].contains(&ran.code), "{words}: {ran:#?}");
        assert!(ran.err.contains(wanted), "{words}: {ran:#?}");
    }
}
