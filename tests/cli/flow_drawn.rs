//! Lines along the wind in pictures and films.

use crate::person::Folder;
use crate::real::data;
use std::fs;

pub const STORM: &str = "phantom:storm,n=16";
pub const SIDE: usize = 60;
/// A pixel a unit of the world.
pub const VIEW: &str =
    "--target 0,0,0 --projection orthographic --view-height 60 --size 60x60 --background none";
const ABOVE: &str = "--eye 0,0,100 --up 0,1,0";
const SOUTH: &str = "--eye 0,-100,0 --up 0,0,1";

/// The numbers of a picture.
pub fn picture(folder: &Folder, words: &str) -> Vec<[f32; 4]> {
    let ran = folder.run(&format!("render {STORM} {words} -o a.npy --force"));
    ran.assert_done();
    let bytes = fs::read(folder.path("a.npy")).expect("a picture");
    let numbers = &bytes[bytes.len() - 16 * SIDE * SIDE..];
    let number = |b: &[u8]| f32::from_le_bytes(b.try_into().expect("four bytes"));
    let pixel = |b: &[u8]| [0, 4, 8, 12].map(|i| number(&b[i..i + 4]));
    numbers.chunks(16).map(pixel).collect()
}

/// Places of the vertices that `convert` writes.
pub fn places(folder: &Folder, words: &str) -> Vec<[f64; 3]> {
    folder
        .run(&format!("convert {STORM} {words} -o l.csv --force"))
        .assert_done();
    let text = fs::read_to_string(folder.path("l.csv")).expect("the lines");
    let place = |row: &str| {
        let numbers: Vec<f64> = row
            .split(',')
            .map(|n| n.parse().unwrap_or(f64::NAN))
            .collect();
        [numbers[2], numbers[3], numbers[4]]
    };
    text.lines().skip(1).map(place).collect()
}

#[test]
fn lines_are_drawn_where_they_are_written() {
    let folder = Folder::new();
    let seeds = "--flow stream --flow-seeds rake:-15,-15,2,15,15,9,6";
    let places = places(&folder, seeds);
    assert!(places.len() > 60, "{}", places.len());
    for (view, exaggerate) in [(ABOVE, 1), (ABOVE, 2), (SOUTH, 1), (SOUTH, 2)] {
        let drawn = picture(
            &folder,
            &format!(
                "{seeds} {VIEW} {view} --look plain --variable vapor --hide-volume --flow-style tube --flow-width 2 \
                 --flow-color 0:1:0 --exaggerate {exaggerate}"
            ),
        );
        // The place in the picture, and how far each pixel is from the next line.
        let at = |[x, y, z]: [f64; 3]| {
            let up = if view == ABOVE {
                y
            } else {
                f64::from(exaggerate) * z
            };
            [x + 0.5 * SIDE as f64, 0.5 * SIDE as f64 - up]
        };
        for place in &places {
            let [x, y] = at(*place).map(|n| n.floor() as usize);
            let [r, g, b, a] = drawn[y * SIDE + x];
            assert!(a == 1.0 && g > 0.2, "{view} {place:?}: {r} {g} {b}");
        }
        for (i, pixel) in drawn.iter().enumerate() {
            let center = [i % SIDE, i / SIDE].map(|n| n as f64 + 0.5);
            // Chords are as long as a cell, 3 pixels, at most, and lines a pixel to each side.
            let is_near = places.iter().any(|&place| {
                let [x, y] = at(place);
                (x - center[0]).hypot(y - center[1]) < 1.0 + 1.6
            });
            assert!(
                is_near || pixel[3] == 0.0,
                "{view}: pixel {i} is far from all lines"
            );
        }
    }
}

#[test]
fn a_volume_lies_before_and_behind_its_lines() {
    let folder = Folder::new();
    let lines = "--flow stream --flow-seeds grid:5,5,3 --flow-color 1:0:0";
    let words = format!("{VIEW} {ABOVE} --look plain --variable vapor");
    let [alone, hidden, both] = [
        words.clone(),
        format!("{words} {lines} --hide-volume"),
        format!("{words} {lines}"),
    ]
    .map(|words| picture(&folder, &words));
    let mut mixed = 0;
    for i in 0..SIDE * SIDE {
        let is_line = hidden[i][3] > 0.0;
        match is_line {
            // A ray that meets no line is the same to the bit.
            false => assert_eq!(both[i], alone[i], "pixel {i}"),
            // The volume takes some light and gives some.
            true => {
                assert!(both[i][3] == 1.0 && alone[i][3] < 1.0, "pixel {i}");
                assert!(both[i][0] <= hidden[i][0] + alone[i][0] + 1e-6);
                mixed += usize::from(both[i] != hidden[i]);
            }
        }
    }
    assert!(mixed > 100, "{mixed}");
    // Over a projection they lie whole.
    let over = picture(&folder, &format!("{words} {lines} --mode mip"));
    for (over, hidden) in over.iter().zip(&hidden) {
        assert!(hidden[3] == 0.0 || over == hidden);
    }
}

/// How much volume lies before them is for `tests/exact/geometry.rs` to say.
#[test]
fn other_techniques_and_the_references_show_the_same_lines() {
    let folder = Folder::new();
    let words = format!(
        "{VIEW} {SOUTH} --look plain --variable vapor --window 0,9 --flow stream --flow-seeds random:9,4 --flow-color 1:0:0 \
         --flow-width 3"
    );
    let alone = picture(&folder, &format!("{words} --hide-volume"));
    let rays = picture(&folder, &words);
    let on_lines = (0..alone.len()).filter(|&i| alone[i][3] == 1.0);
    let on_lines: Vec<_> = on_lines.collect();
    assert!(on_lines.len() > 100, "{}", on_lines.len());
    let found = picture(&folder, &format!("{words} --device reference"));
    for &i in &on_lines {
        let off = (0..4).map(|c| (found[i][c] - rays[i][c]).abs());
        let off = off.fold(0.0, f32::max);
        assert!(off < 1e-4, "pixel {i}: {off}");
    }
    for technique in ["slices-3d", "slices-2d", "splat"] {
        let found = picture(&folder, &format!("{words} --technique {technique}"));
        assert!(
            on_lines.iter().all(|&i| found[i][3] > 1.0 - 1e-6),
            "{technique}"
        );
        let mixed = on_lines.iter().filter(|&&i| found[i] != alone[i]).count();
        assert!(mixed > 50, "{technique}: {mixed}");
    }
}

#[test]
fn a_scene_keeps_lines_and_a_film_draws_them_at_each_time() {
    let folder = Folder::new();
    let words = "--variable vapor --flow stream --flow-seeds random:9,4 --flow-range 0,30 --flow-colormap viridis --flow-width 2";
    let fixed = "--size 40x30 --force";
    folder
        .run(&format!(
            "render {STORM} {words} -o a.png --save-scene s.json {fixed}"
        ))
        .assert_done();
    folder
        .run("render --scene s.json -o b.png --force")
        .assert_done();
    let read = |name: &str| fs::read(folder.path(name)).expect(name);
    assert_eq!(read("a.png"), read("b.png"));
    let plain = format!("--look plain {words} --mode mip --window 0,9 {fixed}");
    folder
        .run(&format!(
            "animate {STORM},times=3 {plain} --times -o f%d.png"
        ))
        .assert_done();
    folder
        .run(&format!(
            "render {STORM},times=3 {plain} --time 0 -o one.png"
        ))
        .assert_done();
    assert_eq!(read("f0.png"), read("one.png"));
    assert_ne!(read("f0.png"), read("f2.png"));
    // Lines that are as short as can be are their seeds, which stay: with no volume all frames are alike.
    let still = format!(
        "--look plain --variable vapor --flow stream --flow-seeds random:9,4 --flow-color 1:0:0 --flow-length 1e-3 {fixed}"
    );
    folder
        .run(&format!(
            "animate {STORM},times=3 {still} --hide-volume --times --between 1 -o s%d.npy"
        ))
        .assert_done();
    let number = |b: &[u8]| f32::from_le_bytes(b.try_into().expect("four bytes"));
    let numbers = |frame: u32| -> Vec<f32> {
        let bytes = read(&format!("s{frame}.npy"));
        let numbers = bytes[bytes.len() - 16 * 40 * 30..].chunks(4);
        numbers.map(number).collect()
    };
    let first = numbers(0);
    assert!(first.iter().step_by(4).any(|red| *red > 0.2));
    for frame in 1..5 {
        // Lines of a thousandth of the length of a pixel turn with the wind.
        let off = first.iter().zip(numbers(frame)).map(|(a, b)| (a - b).abs());
        let most = off.fold(0.0, f32::max);
        assert!(most < 2e-3, "frame {frame}: {most}");
    }
}

#[test]
fn what_lines_cannot_be_drawn_with_is_refused_by_name() {
    let folder = Folder::new();
    for (words, wanted) in [
        ("--technique shear-warp", "slices-3d"),
        ("--technique pathtrace", "not for pathtrace"),
        ("--aa 4 --aa-uneven", "--aa-uneven"),
        ("--hide-volume --mode mip", "--hide-volume"),
        ("--flow-width 0.5", "1.2 to 1000"),
        ("--flow-colormap jet", "a colour map"),
        ("--wind u,nothing", "nothing"),
    ] {
        let ran = folder.run(&format!(
            "render {STORM} --variable vapor --flow stream {words} -o a.png --size 20x20"
        ));
        assert!([2, 3].contains(&ran.code), "{words}: {ran:#?}");
        assert!(ran.err.contains(wanted), "{words}: {ran:#?}");
    }
    let ran = folder.run("render phantom:head,n=8 --flow stream -o a.png --size 20x20");
    assert!(ran.code != 0 && ran.err.contains("no wind"), "{ran:#?}");
    folder
        .run("render phantom:head,n=8 --hide-volume -o a.png")
        .assert_refused(2, &["--flow"]);
    folder.file("p.csv", "x,y,z,v\n0,0,0,1\n1,1,1,2\n");
    for input in ["p.csv", "phantom:head,n=8"] {
        let ran = folder.run(&format!("render {input} --show both -o a.png --size 20x20"));
        let wanted: &[&str] = match input {
            "p.csv" => &["--show: the input is scattered points"],
            _ => &[
                "--show: no water vapour",
                "found one variable without a name",
            ],
        };
        ran.assert_refused(2, wanted);
    }
}

/// The storm grows, and its wind with it.
#[test]
fn lines_of_a_film_have_the_colours_of_all_times() {
    let folder = Folder::new();
    let words = "--variable vapor --hide-volume --flow stream --flow-seeds random:30,4 --size 20x20 --force";
    let ends = |said: &str| -> f64 {
        let note = said
            .lines()
            .find(|line| line.contains("lines are coloured by speed, from 0 to "));
        let (_, high) = note
            .expect("a note")
            .split_once("from 0 to ")
            .expect("ends");
        high.strip_suffix(" m s-1")
            .expect("a unit")
            .parse()
            .expect("a number")
    };
    // The film's lines are as long as those of its first time, so that the fastest wind is not on them at others.
    let of_time = |time: u32| {
        let ran = folder.run(&format!(
            "render {STORM},times=3 {words} --time {time} -o a.png"
        ));
        ran.assert_done();
        ends(&ran.err)
    };
    let ran = folder.run(&format!("animate {STORM},times=3 {words} --times -o a.gif"));
    ran.assert_done();
    let of_film = ends(&ran.err);
    assert!(of_film > 1.02 * of_time(0), "{of_film}");
    assert!(of_film < 1.2 * of_time(2), "{of_film}");
    let ran = folder.run(&format!(
        "animate {STORM},times=3 {words} --flow-range 0,12 --times -o a.gif"
    ));
    assert_eq!(ends(&ran.err), 12.0);
}

#[test]
fn particles_that_go_nowhere_and_what_was_said_already_are_said_once() {
    let folder = Folder::new();
    let render = |words: &str| {
        let ran = folder.run(&format!("render {words} -o a.png --size 20x20 --force"));
        ran.assert_done();
        ran.err
    };
    let said = render("phantom:storm,n=16 --variable vapor --hide-volume --flow path --time 7");
    assert!(said.contains("no line goes anywhere"), "{said}");
    let why = "the picture is empty: no line, map or point is seen, and the volume is not drawn";
    assert!(said.contains(why), "{said}");
    let said = render("phantom:storm,n=16 --show vapor");
    let notes: Vec<&str> = said.lines().collect();
    for (at, note) in notes.iter().enumerate() {
        assert!(!notes[..at].contains(note), "twice: {note}");
    }
}

#[test]
fn one_word_stands_for_the_flags_that_it_says() {
    let folder = Folder::new();
    let read = |name: &str| fs::read(folder.path(name)).expect(name);
    let fixed = "--size 60x40 --force";
    for (word, wanted) in [
        (
            "vapor",
            "--variable vapor --mode iso --iso-color-by temperature --annotate \
             'bar,time,orientation,scale,title=Water vapor mixing ratio coloured by Temperature'",
        ),
        (
            "wind",
            "--variable vapor --hide-volume --flow stream --annotate",
        ),
        (
            "both",
            "--variable vapor --mode iso --iso-color-by temperature --flow stream --annotate \
             'bar,time,orientation,scale,title=Water vapor mixing ratio coloured by Temperature'",
        ),
    ] {
        let shown = folder.run(&format!("render {STORM} --show {word} -o a.png {fixed}"));
        shown.assert_done();
        let said = format!("--show {word}: {wanted}\n");
        assert!(shown.err.contains(&said), "{shown:#?}");
        let mut same = folder.command(&format!("render {STORM} -o b.png {fixed}"));
        for (nth, part) in wanted.split('\'').enumerate() {
            // Words between quotes are one.
            match nth % 2 {
                0 => same.args(part.split_whitespace()),
                _ => same.arg(part),
            };
        }
        assert!(same.output().expect("the program runs").status.success());
        assert_eq!(read("a.png"), read("b.png"), "{word}");
    }
    // A word that is said wins.
    let other = folder.run(&format!(
        "render {STORM} --show vapor --variable cloud -o a.png {fixed}"
    ));
    assert!(
        other.err.contains("--variable cloud --mode iso"),
        "{other:#?}"
    );
    let film = folder.run(&format!(
        "animate {STORM},times=3 --show vapor --between 1 -o f%d.png {fixed}"
    ));
    film.assert_done();
    assert!(folder.path("f4.png").exists() && !folder.path("f5.png").exists());
    folder
        .run(&format!(
            "render phantom:head,n=8 --show vapor -o c.png {fixed}"
        ))
        .assert_refused(2, &["--show", "no water vapour"]);
}

pub fn fixture(name: &str) -> String {
    format!(
        "{}/tests/fixtures/netcdf/{name}",
        env!("CARGO_MANIFEST_DIR")
    )
}

#[test]
fn meridians_parallels_and_coasts_lie_where_degrees_do() {
    let folder = Folder::new();
    // A degree is 69.2206 km by 111.1951 km there: the middle of the picture lies at 6 east, 51 north.
    let view = "--eye 415.3234,5670.9491,9999 --target 415.3234,5670.9491,0 --up 0,1,0 --projection orthographic \
                --view-height 400 --size 60x60 --background none --look plain --variable pot --hide-volume";
    let drawn = |map: &str| {
        let file = fixture("theta.nc");
        let ran = folder.run(&format!(
            "render {file} {view} --map {map} -o a.npy --force"
        ));
        ran.assert_done();
        let bytes = fs::read(folder.path("a.npy")).expect("a picture");
        let numbers = &bytes[bytes.len() - 16 * SIDE * SIDE..];
        let number = |b: &[u8]| f32::from_le_bytes(b.try_into().expect("four bytes"));
        let alphas = numbers.chunks(16).map(|pixel| number(&pixel[12..]) > 0.0);
        alphas.collect::<Vec<bool>>()
    };
    let lines = drawn("graticule=1");
    let is_line = |x: usize, y: usize| lines[y * SIDE + x];
    // The margin ends a pixel inside of the picture in the west.
    for along in 2..SIDE {
        // 6 and 5 east; 51 and 52 north. A pixel is 6.667 km.
        assert!(
            is_line(29, along) && is_line(30, along) && is_line(19, along),
            "{along}"
        );
        assert!(
            is_line(along, 29) && is_line(along, 30) && is_line(along, 13),
            "{along}"
        );
    }
    for [x, y] in [[25, 20], [35, 40], [10, 5], [45, 35]] {
        assert!(!is_line(x, y), "{x} {y}");
    }
    // From 2 to 9 east, 49 to 53 north: the coast of the Netherlands from the west, and no coast in the south east.
    let coast = drawn("coast");
    let count = |rows: std::ops::Range<usize>, columns: std::ops::Range<usize>| {
        rows.flat_map(|y| columns.clone().map(move |x| [x, y]))
            .filter(|&[x, y]| coast[y * SIDE + x])
            .count()
    };
    assert!(count(0..30, 0..30) > 30 && count(30..60, 30..60) == 0);
    let borders = drawn("borders");
    assert!(borders.iter().filter(|is| **is).count() > 60 && borders != coast);
    let all = drawn("coast,borders,graticule=1");
    for i in 0..SIDE * SIDE {
        assert_eq!(all[i], lines[i] || coast[i] || borders[i], "pixel {i}");
    }
}

#[test]
fn a_map_is_refused_where_there_is_no_place_or_the_file_disagrees_with_itself() {
    let folder = Folder::new();
    for (words, wanted) in [
        (
            format!("{STORM} --variable vapor --map"),
            "no place on the Earth",
        ),
        (
            "phantom:head,n=8 --map coast".to_owned(),
            "no place on the Earth",
        ),
        (
            "phantom:head,n=8 --map coast,rivers".to_owned(),
            "\"rivers\"",
        ),
        (
            "phantom:head,n=8 --map graticule=0".to_owned(),
            "0.1 to 90 degrees",
        ),
        (
            format!("{} --variable T --map", fixture("wrf_derived.nc")),
            "latitudes in the file and its projection differ by",
        ),
    ] {
        let ran = folder.run(&format!("render {words} -o a.png --size 20x20"));
        assert!(ran.code == 2 && ran.err.contains(wanted), "{ran:#?}");
    }
}

#[test]
fn a_forecast_is_shown_with_its_coast() {
    let Some(data) = data() else {
        println!("skipped: no data");
        return;
    };
    let folder = Folder::new();
    let file = data.join("met-wrf/wrf_ci.nc");
    let ran = folder.run(&format!(
        "render {} --show both -o a.png --size 120x80",
        file.display()
    ));
    ran.assert_done();
    let said = "--show both: --variable QVAPOR --mode iso --iso-color-by temperature --flow stream --map \
                coast,borders,graticule --annotate";
    assert!(ran.err.contains(said), "{ran:#?}");
}
