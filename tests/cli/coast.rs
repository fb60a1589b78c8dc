//! The coast of a map by a file.

use crate::flow_drawn::{SIDE, fixture};
use crate::person::Folder;
use crate::shapefile::{Lines, shapefile};
use std::fs;

/// 6371.0088 pi / 180 km, that of longitude times cos 51.5; it has 2 to 9 east, 49 to 53 north with its margin.
const DEGREE: [f64; 2] = [69.220_564_967, 111.195_080_234];
/// The middle of the picture, degrees, and a pixel, km.
const MIDDLE: [f64; 2] = [6.0, 51.0];
const PIXEL: f64 = 400.0 / 60.0;
/// Pixels across a line of the coast.
const WIDTH: f64 = 2.0;

fn view() -> String {
    let [x, y] = [0, 1].map(|k| MIDDLE[k] * DEGREE[k]);
    format!(
        "--eye {x},{y},9999 --target {x},{y},0 --up 0,1,0 --projection orthographic --view-height 400 --size 60x60 \
         --look plain --variable pot --hide-volume"
    )
}

/// Alphas of a map.
fn drawn(folder: &Folder, map: &str) -> Vec<bool> {
    let (file, view) = (fixture("theta.nc"), view());
    let words = format!("render {file} {view} --background none --map {map} -o a.npy --force");
    folder.run(&words).assert_done();
    let bytes = fs::read(folder.path("a.npy")).expect("a picture");
    let numbers = &bytes[bytes.len() - 16 * SIDE * SIDE..];
    let alpha = |pixel: &[u8]| f32::from_le_bytes(pixel[12..].try_into().expect("four bytes"));
    numbers.chunks(16).map(|pixel| alpha(pixel) > 0.0).collect()
}

/// A long line through the box, a hook, a line over the side of the box, and one on the other side of the Earth.
fn lines() -> Lines {
    vec![
        vec![[-60.0, 30.0], [72.0, 74.0]],
        vec![[5.0, 49.5], [7.0, 49.5], [7.0, 50.5]],
        vec![[3.5, 52.5], [3.5, 89.0]],
        vec![[150.0, 51.0], [-150.0, 51.0]],
    ]
}

fn geojson(lines: &Lines) -> String {
    format!(r#"{{"type":"MultiLineString","coordinates":{lines:?}}}"#)
}

/// How far a place lies from a piece of a line.
fn distance(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let [way, from] = [[b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]];
    let length = way[0].powi(2) + way[1].powi(2);
    let part = ((way[0] * from[0] + way[1] * from[1]) / length).clamp(0.0, 1.0);
    (from[0] - part * way[0]).hypot(from[1] - part * way[1])
}

#[test]
fn a_coast_lies_where_its_file_has_it() {
    let folder = Folder::new();
    let lines = lines();
    folder.file("c.geojson", geojson(&lines));
    folder.file(
        "c.shp",
        shapefile(3, &[lines[..2].to_vec(), lines[2..].to_vec()]),
    );
    let found = drawn(&folder, "coast --coast c.geojson");
    // The last one does not come near.
    let pixels = lines[..3]
        .iter()
        .flat_map(|line| line.windows(2))
        .map(|pair| {
            [pair[0], pair[1]].map(|place| {
                let [x, y] = [0, 1].map(|k| (place[k] - MIDDLE[k]) * DEGREE[k] / PIXEL);
                [0.5 * SIDE as f64 + x, 0.5 * SIDE as f64 - y]
            })
        });
    let pixels: Vec<[[f64; 2]; 2]> = pixels.collect();
    let (mut on, mut off) = (0, 0);
    for y in 0..SIDE {
        for x in 0..SIDE {
            let center = [x as f64 + 0.5, y as f64 + 0.5];
            let nearest = pixels.iter().map(|piece| distance(center, *piece));
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            let is_drawn = found[y * SIDE + x];
            // A line is f32 numbers of some 6000 km, 5e-4 km off at most: a ten thousandth of a pixel.
            // Lines end, with round ends, on the rectangle of the map, which has less than the picture in the west.
            if nearest < 0.5 * WIDTH - 1e-3 && x > 2 {
                assert!(is_drawn, "{x} {y}: {nearest}");
                on += 1;
            }
            if nearest > 0.5 * WIDTH + 1e-3 {
                assert!(!is_drawn, "{x} {y}: {nearest}");
                off += 1;
            }
        }
    }
    assert!(on > 150 && off > 3000, "{on} {off}");
    assert_eq!(drawn(&folder, "coast --coast c.shp"), found);
    // It is the coast and nothing else.
    let borders = drawn(&folder, "borders");
    let both = drawn(&folder, "coast,borders --coast c.shp");
    for i in 0..SIDE * SIDE {
        assert_eq!(both[i], found[i] || borders[i], "pixel {i}");
    }
}

#[test]
fn rings_of_polygons_are_drawn_however_longitudes_count() {
    let folder = Folder::new();
    // Longitudes may count from anywhere, and jump where they begin again.
    let ring = |turn: f64| {
        vec![vec![
            [4.0 + turn, 50.0],
            [8.0, 50.0],
            [8.0, 52.0],
            [4.0 + turn, 50.0],
        ]]
    };
    let of = |folder: &Folder, ring: Lines| {
        folder.file("c.shp", shapefile(5, &[ring]));
        drawn(folder, "coast --coast c.shp")
    };
    let found = of(&folder, ring(0.0));
    assert!(found.iter().filter(|is| **is).count() > 100);
    assert_eq!(of(&folder, ring(-360.0)), found);
}

#[test]
fn a_coast_is_refused_in_words() {
    let folder = Folder::new();
    folder.file(
        "metres.geojson",
        geojson(&vec![vec![[691_000.0, 5.7e6], [7e5, 5.7e6]]]),
    );
    folder.file("c.geojson", geojson(&lines()));
    let far = (0..6000).map(|i| {
        if i % 2 == 0 {
            [-170.0, 0.0]
        } else {
            [9.0, 0.0]
        }
    });
    folder.file("around.geojson", geojson(&vec![far.collect()]));
    let file = format!("{} --variable pot", fixture("theta.nc"));
    let wrf = fixture("wrf.nc");
    for (words, code, wanted) in [
        (
            format!("{file} --coast c.geojson"),
            2,
            "--coast FILE is the coast of --map",
        ),
        (
            format!("{file} --map graticule --coast c.geojson"),
            2,
            "--map coast draws it",
        ),
        (
            format!("{file} --map coast --coast none.shp"),
            3,
            "none.shp",
        ),
        (
            format!("{file} --map coast --coast metres.geojson"),
            3,
            "wanted a longitude from -360 to 360 degrees, found `691000`",
        ),
        (
            format!("{file} --map coast --coast {wrf}"),
            3,
            "wanted a shapefile (.shp), GeoJSON or TopoJSON",
        ),
        (
            format!("{file} --map coast --coast around.geojson"),
            3,
            "times around the Earth",
        ),
        (
            "phantom:head,n=8 --map coast --coast c.geojson".to_owned(),
            2,
            "no place on the Earth",
        ),
        (
            format!("{file} --map coast --coast c.geojson --save-scene c.geojson --force"),
            4,
            "c.geojson",
        ),
    ] {
        let ran = folder.run(&format!("render {words} -o a.png --size 20x20"));
        assert!(
            ran.code == code && ran.err.contains(wanted),
            "{words}: {ran:#?}"
        );
    }
    assert_eq!(
        fs::read_to_string(folder.path("c.geojson")).expect("kept"),
        geojson(&lines())
    );
}

#[test]
fn a_scene_finds_its_coast_beside_it() {
    let folder = Folder::new();
    fs::create_dir(folder.path("in")).expect("a folder");
    folder.file("in/c.geojson", geojson(&lines()));
    let (file, view) = (fixture("theta.nc"), view());
    folder
        .run(&format!(
            "render {file} {view} --map coast --coast in/c.geojson -o a.png --save-scene in/s.json"
        ))
        .assert_done();
    let scene = fs::read_to_string(folder.path("in/s.json")).expect("a scene");
    assert!(scene.contains("\"coast\": \"c.geojson\""), "{scene}");
    folder
        .run("render --scene in/s.json -o b.png")
        .assert_done();
    let bytes = |name: &str| fs::read(folder.path(name)).expect("a picture");
    assert_eq!(bytes("a.png"), bytes("b.png"));
}
