//! Grids of latitudes and longitudes whose pole is moved: where the map lies on them, and which winds they take.

use crate::netcdf::{Variable, netcdf};
use crate::person::Folder;
use std::fs;

/// Latitude and longitude of the grid's pole.
const POLE: [f64; 2] = [39.25, -162.0];
const LONGITUDES: [f64; 7] = [-6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0];
const LATITUDES: [f64; 5] = [-4.0, -2.0, 0.0, 2.0, 4.0];
const SIDE: usize = 60;
/// Kilometres.
const DEGREE: f64 = 111.195_080_234;
const PIXEL: f64 = 20.0;

/// Longitude and latitude on the Earth of a place of the grid: its vector, turned about the axis across the pole's meridian.
fn on_earth(longitude: f64, latitude: f64) -> [f64; 2] {
    let (l, p, a) = (
        longitude.to_radians(),
        latitude.to_radians(),
        POLE[0].to_radians(),
    );
    let [x, y, z] = [p.cos() * l.cos(), p.cos() * l.sin(), p.sin()];
    let [x, z] = [a.sin() * x - a.cos() * z, a.sin() * z + a.cos() * x];
    let turned = y.atan2(x).to_degrees() + POLE[1] + 180.0;
    [turned, z.asin().to_degrees()]
}

/// The file: its own latitudes off by so much, with the name of what says where the pole is, and winds of these standard names.
fn file(off: f64, mapping: &str, winds: [&str; 2]) -> Vec<u8> {
    let places = LATITUDES.iter().flat_map(|&latitude| {
        LONGITUDES
            .iter()
            .map(move |&longitude| on_earth(longitude, latitude))
    });
    let [longitudes, latitudes]: [Vec<f64>; 2] = [0, 1].map(|k| {
        places
            .clone()
            .map(|place| place[k] + off * k as f64)
            .collect()
    });
    let axis = |name, texts, values: &[f64], dimension| Variable {
        name,
        dimensions: dimension,
        texts,
        numbers: &[],
        values: values.to_vec(),
    };
    let of_grid = |name, texts, value: f64| Variable {
        name,
        dimensions: &[0, 1, 2],
        texts,
        numbers: &[],
        values: (0..70).map(|i| value + f64::from(i)).collect(),
    };
    let wind = |standard| {
        [
            ("units", "m s-1"),
            ("grid_mapping", mapping),
            ("coordinates", "lon lat"),
            ("standard_name", standard),
        ]
    };
    let winds = winds.map(wind);
    netcdf(
        &[("height", 2), ("rlat", 5), ("rlon", 7)],
        &[],
        &[
            axis(
                "height",
                &[("units", "m"), ("axis", "Z"), ("positive", "up")],
                &[0.0, 1000.0],
                &[0],
            ),
            axis(
                "rlat",
                &[("units", "degrees"), ("standard_name", "grid_latitude")],
                &LATITUDES,
                &[1],
            ),
            axis(
                "rlon",
                &[("units", "degrees"), ("standard_name", "grid_longitude")],
                &LONGITUDES,
                &[2],
            ),
            axis("lat", &[("units", "degrees_north")], &latitudes, &[1, 2]),
            axis("lon", &[("units", "degrees_east")], &longitudes, &[1, 2]),
            Variable {
                name: "pole",
                dimensions: &[],
                texts: &[("grid_mapping_name", "rotated_latitude_longitude")],
                numbers: &[
                    ("grid_north_pole_latitude", POLE[0]),
                    ("grid_north_pole_longitude", POLE[1]),
                ],
                values: vec![0.0],
            },
            of_grid(
                "ta",
                &[
                    ("units", "K"),
                    ("grid_mapping", mapping),
                    ("coordinates", "lon lat"),
                ],
                280.0,
            ),
            of_grid("u", &winds[0], 5.0),
            of_grid("v", &winds[1], 3.0),
        ],
    )
}

const ALONG_ROWS: [&str; 2] = ["x_wind", "y_wind"];

#[test]
fn a_coast_lies_on_a_grid_with_a_moved_pole_where_the_earth_has_it() {
    let folder = Folder::new();
    folder.file("a.nc", file(0.0, "pole", ALONG_ROWS));
    let info = folder.run("info a.nc");
    info.assert_done();
    assert!(
        info.out
            .contains("north pole at latitude 39.25, longitude -162"),
        "{info:#?}"
    );
    // A parallel of the grid, a degree north of its middle, and a line on the other side of the Earth.
    let parallel: Vec<[f64; 2]> = (-20..=20)
        .map(|i| on_earth(0.25 * f64::from(i), 1.0))
        .collect();
    let far = [[-170.0, -50.0], [-160.0, -52.0]];
    folder.file(
        "c.geojson",
        format!(r#"{{"type":"MultiLineString","coordinates":[{parallel:?},{far:?}]}}"#),
    );
    let ran = folder.run(
        "render a.nc --variable ta --map coast --coast c.geojson --hide-volume --look plain --background none --eye 0,0,9999 \
         --target 0,0,0 --up 0,1,0 --projection orthographic --view-height 1200 --size 60x60 -o a.npy",
    );
    ran.assert_done();
    let bytes = fs::read(folder.path("a.npy")).expect("a picture");
    let pixels = &bytes[bytes.len() - 16 * SIDE * SIDE..];
    let row = 30.0 - DEGREE / PIXEL;
    let reach = 5.0 * DEGREE / PIXEL;
    let (mut on, mut off) = (0, 0);
    for (i, pixel) in pixels.chunks(16).enumerate() {
        let [x, y] = [i % SIDE, i / SIDE].map(|n| n as f64 + 0.5);
        let is_drawn = f32::from_le_bytes(pixel[12..].try_into().expect("four bytes")) > 0.0;
        let [along, across] = [(x - 30.0).abs(), (y - row).abs()];
        // Two pixels wide, straight in degrees of the Earth from place to place: less than a hundredth of a pixel off.
        if along < reach && across < 0.99 {
            assert!(is_drawn, "{x} {y}");
            on += 1;
        }
        if along > reach + 1.1 || across > 1.01 {
            assert!(!is_drawn, "{x} {y}");
            off += 1;
        }
    }
    assert!(on > 100 && off > 3000, "{on} {off}");
}

/// Columns are two degrees apart: between them the file's longitudes and latitudes are off by half of f'' (1 degree)^2, a
/// kilometre, and three times as much where they go on for half a step.
#[test]
fn a_coast_by_the_latitudes_of_the_file_ends_with_the_grid() {
    let folder = Folder::new();
    // Without the place of the pole, and with one whose map would be refused.
    folder.file("none.nc", file(0.0, "nothing", ALONG_ROWS));
    folder.file("other.nc", file(0.5, "pole", ALONG_ROWS));
    let parallel = |off: f64| -> Vec<[f64; 2]> {
        let places = (-45..=45).map(|i| on_earth(0.25 * f64::from(i), 1.0));
        places.map(|[x, y]| [x, y + off]).collect()
    };
    for (name, off, words) in [("none.nc", 0.0, ""), ("other.nc", 0.5, "--coast-by arrays")] {
        let line = parallel(off);
        folder.file(
            "c.geojson",
            format!(r#"{{"type":"LineString","coordinates":{line:?}}}"#),
        );
        let ran = folder.run(&format!(
            "render {name} --variable ta --map coast --coast c.geojson {words} --hide-volume --look plain --background none \
             --eye 0,0,9999 --target 0,0,0 --up 0,1,0 --projection orthographic --view-height 2400 --size 60x60 -o a.npy --force"
        ));
        ran.assert_done();
        let said = "the map is placed by lat and lon of each column, and ends with the grid";
        assert_eq!(ran.err.contains(said), words.is_empty(), "{}", ran.err);
        let bytes = fs::read(folder.path("a.npy")).expect("a picture");
        let pixels = &bytes[bytes.len() - 16 * SIDE * SIDE..];
        let pixel_km = 2.0 * PIXEL;
        let row = 30.0 - DEGREE / pixel_km;
        // The grid has seven columns.
        let reach = 7.0 * DEGREE / pixel_km;
        let (mut on, mut beside) = (0, 0);
        for (i, pixel) in pixels.chunks(16).enumerate() {
            let [x, y] = [i % SIDE, i / SIDE].map(|n| n as f64 + 0.5);
            let is_drawn = f32::from_le_bytes(pixel[12..].try_into().expect("four bytes")) > 0.0;
            let [along, across] = [(x - 30.0).abs(), (y - row).abs()];
            if along < reach - 0.1 && across < 0.9 {
                assert!(is_drawn, "{name}: {x} {y}");
                on += 1;
            }
            // The round end of a line two pixels wide.
            if along > reach + 1.1 || across > 1.1 {
                assert!(!is_drawn, "{name}: {x} {y}");
                beside += 1;
            }
        }
        assert!(on > 60 && beside > 3000, "{on} {beside}");
    }
    for (words, wanted) in [
        ("other.nc --map coast", "--coast-by arrays places the map"),
        (
            "none.nc --map coast --coast-by projection",
            "no place on the Earth",
        ),
        ("none.nc --coast-by arrays", "--map coast draws them"),
    ] {
        let (name, words) = words.split_once(' ').expect("a file");
        folder
            .run(&format!(
                "render {name} --variable ta {words} --size 16x12 --force -o a.png"
            ))
            .assert_refused(2, &[wanted]);
    }
    folder
        .run("render phantom:storm,n=8 --variable vapor --map coast --coast-by arrays --size 16x12 -o b.png")
        .assert_refused(2, &["--coast-by arrays: wanted variables of two dimensions", "found none"]);
}

#[test]
fn what_a_moved_pole_leaves_unknown_is_refused() {
    let folder = Folder::new();
    folder.file("other.nc", file(0.5, "pole", ALONG_ROWS));
    folder.file("none.nc", file(0.0, "nothing", ALONG_ROWS));
    folder.file(
        "east.nc",
        file(0.0, "pole", ["eastward_wind", "northward_wind"]),
    );
    folder.file("rows.nc", file(0.0, "pole", ALONG_ROWS));
    let render = |name: &str, words: &str| {
        folder.run(&format!(
            "render {name} --variable ta {words} --size 16x12 --force -o a.png"
        ))
    };
    render("other.nc", "--map coast").assert_refused(2, &["differ by 55.6", "at a corner"]);
    render("none.nc", "--map coast --coast-by projection")
        .assert_refused(2, &["no place on the Earth", "grid_mapping"]);
    render("east.nc", "--flow stream")
        .assert_refused(2, &["u is eastward_wind", "wanted x_wind and y_wind"]);
    render("rows.nc", "--flow stream").assert_done();
    // Bricks keep no pole: they have no place on the Earth.
    folder
        .run("convert rows.nc --variable ta -o rows.svb")
        .assert_done();
    folder
        .run("render rows.svb --map coast --size 16x12 --force -o a.png")
        .assert_refused(2, &["no place on the Earth"]);
}

/// The middle of the grid, as far from the moved pole as from its latitude 0.
#[test]
fn seeds_and_lines_have_degrees_of_the_earth() {
    let folder = Folder::new();
    folder.file("rows.nc", file(0.0, "pole", ALONG_ROWS));
    folder.file("other.nc", file(0.5, "pole", ALONG_ROWS));
    folder.file("seeds.csv", "lon,lat,height\n18,50.75,100\n");
    let convert = |name: &str, seeds: &str| {
        folder.run(&format!(
            "convert {name} -o a.csv --force --flow stream --flow-direction forward --flow-seeds {seeds}"
        ))
    };
    convert("rows.nc", "seeds.csv").assert_done();
    let first = || -> Vec<f64> {
        let text = fs::read_to_string(folder.path("a.csv")).expect("lines");
        let row = text.lines().nth(1).expect("a vertex");
        row.split(',')
            .map(|n| n.parse().unwrap_or(f64::NAN))
            .collect()
    };
    for (found, wanted) in first()[2..8]
        .iter()
        .zip([0.0, 0.0, 0.1, 18.0, 50.75, 100.0])
    {
        assert!((found - wanted).abs() < 1e-6, "{:?}", first());
    }
    // Where the file disagrees with itself there are no degrees.
    convert("other.nc", "random:3").assert_done();
    assert!(first()[5].is_nan() && first()[6].is_nan());
    let refused = convert("other.nc", "seeds.csv");
    assert!(
        refused.code == 3 && refused.err.contains("its map differ"),
        "{refused:#?}"
    );
}
