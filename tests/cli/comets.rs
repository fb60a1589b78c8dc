//! Ways of particles in films: up to the time of each frame, and as comets.

use crate::flow_drawn::{SIDE, fixture};
use crate::person::Folder;
use std::fs;

/// Pixels a unit of the world: a picture shows 12 of it.
const PIXELS: f64 = SIDE as f64 / 12.0;
/// Seconds between frames: the file has two times, three hours apart, and 47 frames between them.
const STEP: f64 = 10_800.0 / 48.0;
/// Seconds of tails, and what is left of the radius at their ends.
const TAIL: f64 = 300.0;
const POINT: f64 = 0.05;

/// Seconds and the place in the picture of a particle.
type Passed = (f64, [f64; 2]);

fn way(folder: &Folder, input: &str) -> Vec<Passed> {
    folder
        .run(&format!("convert {input} -o way.csv --force"))
        .assert_done();
    let text = fs::read_to_string(folder.path("way.csv")).expect("a way");
    let passed = |row: &str| {
        let number = |k: usize| -> f64 { row.split(',').nth(k).unwrap().parse().unwrap() };
        let middle = 0.5 * SIDE as f64;
        let place = [middle + PIXELS * number(2), middle - PIXELS * number(3)];
        (number(1), place)
    };
    text.lines().skip(1).map(passed).collect()
}

/// How deep a place lies inside of what is drawn of a way at a moment, pixels: circles of this radius at each place, linear
/// between those of the way.
fn depth(way: &[Passed], p: [f64; 2], radius: impl Fn(f64) -> Option<f64>) -> f64 {
    const FINE: usize = 400;
    let mut deepest = f64::NEG_INFINITY;
    for pair in way.windows(2) {
        let ((t0, a), (t1, b)) = (pair[0], pair[1]);
        for i in 0..=FINE {
            let part = i as f64 / FINE as f64;
            let Some(radius) = radius(t0 + part * (t1 - t0)) else {
                continue;
            };
            let [x, y] = [0, 1].map(|k| a[k] + part * (b[k] - a[k]));
            deepest = deepest.max(radius - (p[0] - x).hypot(p[1] - y));
        }
    }
    deepest
}

#[test]
fn a_film_shows_ways_up_to_its_times_and_comets_at_their_heads() {
    let folder = Folder::new();
    folder.file("seeds.csv", "-4,-2,0.5\n");
    let flow = "--flow path --flow-seeds seeds.csv --wind U,V,none";
    let input = format!("{} {flow}", fixture("wrf.nc"));
    let way = way(&folder, &input);
    let gone = way.last().expect("a way").0;
    assert!((900.0..1000.0).contains(&gone), "{gone}");
    let view = "--variable T --look plain --eye 0,0,100 --target 0,0,0 --up 0,1,0 --projection orthographic \
                --view-height 12 --size 60x60 --background none --hide-volume --flow-color 0:1:0 --force";
    for (style, is_comet) in [("tube", false), ("comets --comet-time 5min", true)] {
        folder
            .run(&format!(
                "animate {input} {view} --flow-style {style} --flow-width 6 --times --between 47 -o f%02d.npy"
            ))
            .assert_done();
        let mut drawn = 0;
        // The last of these comes when the tail is gone too.
        for frame in [0, 1, 2, 4, 5, 6] {
            let now = f64::from(frame) * STEP;
            let bytes = fs::read(folder.path(&format!("f{frame:02}.npy"))).expect("a frame");
            let pixels = bytes[bytes.len() - 16 * SIDE * SIDE..].chunks(16);
            let is_drawn: Vec<bool> = pixels.map(|pixel| pixel[12..] != [0; 4]).collect();
            let radius = |seconds: f64| {
                let since = if is_comet { now - TAIL } else { 0.0 };
                let is_shown = now > 0.0 && (since..=now).contains(&seconds);
                let share = if is_comet {
                    (seconds - since) / TAIL
                } else {
                    1.0
                };
                is_shown.then_some(3.0 * share)
            };
            for (i, &is_drawn) in is_drawn.iter().enumerate() {
                let center = [(i % SIDE) as f64 + 0.5, (i / SIDE) as f64 + 0.5];
                let depth = depth(&way, center, radius);
                // A point of the tail is a twentieth of the radius; between the places that are tried here, less than
                // 60 pixels / 400 apart, what lies beside misses 0.15^2 / 2 / 0.05 of that, and what lies before 0.15.
                if depth > 0.0 {
                    assert!(is_drawn, "{style}, {now} s, {center:?}: {depth}");
                } else if depth < -0.15 - 3.0 * POINT {
                    assert!(!is_drawn, "{style}, {now} s, {center:?}: {depth}");
                }
            }
            let count = is_drawn.iter().filter(|is| **is).count();
            assert_eq!(
                count > 0,
                now > 0.0 && !(is_comet && now > gone + TAIL),
                "{now} s"
            );
            drawn += count;
        }
        assert!(drawn > 150, "{drawn} pixels");
    }
}

#[test]
fn comets_are_refused_where_there_are_none() {
    let folder = Folder::new();
    let input = format!(
        "{} --wind U,V,none --variable T -o a.png --size 20x20",
        fixture("wrf.nc")
    );
    for (words, wanted) in [
        ("--flow streak --flow-style comets", "smoke has no heads"),
        ("--flow path --comet-time 1h", "--flow-style comets"),
        (
            "--flow path --flow-style comets --comet-time 0",
            "a time over 0",
        ),
    ] {
        let ran = folder.run(&format!("render {input} {words}"));
        assert!(
            ran.code == 2 && ran.err.contains(wanted),
            "{words}: {ran:#?}"
        );
    }
    // The whole of a stream line, from a point at its seed to its end.
    folder
        .run(&format!("render {input} --flow stream --flow-style comets"))
        .assert_done();
}
