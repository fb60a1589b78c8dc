//! Spheres and ribbons along lines, and widths in kilometres.

use crate::netcdf::{Variable, netcdf, netcdf_with};
use crate::person::Folder;
use std::fs;

/// Two pixels a kilometre.
const VIEW: &str = "--variable vapor --hide-volume --projection orthographic --view-height 30 --view top --size 60x60 --look plain \
                    --background none --device reference --force";
const LINE: &str =
    "phantom:storm,n=16 --flow stream --flow-seeds rake:-8,-8,4,8,8,4,3 --flow-color 1:0:0";

fn alphas(folder: &Folder, words: &str) -> (Vec<f32>, String) {
    let ran = folder.run(&format!("render {words} {VIEW} -o a.npy"));
    ran.assert_done();
    let bytes = fs::read(folder.path("a.npy")).expect("a picture");
    let pixels = bytes[bytes.len() - 16 * 3600..].chunks(16);
    let alpha = |pixel: &[u8]| f32::from_le_bytes(pixel[12..].try_into().expect("four bytes"));
    (pixels.map(alpha).collect(), ran.err)
}

fn count(alphas: &[f32]) -> usize {
    alphas.iter().filter(|&&alpha| alpha > 0.0).count()
}

#[test]
fn a_width_in_kilometres_is_that_on_the_ground_and_never_under_a_pixel() {
    let folder = Folder::new();
    let width = |width: &str| {
        alphas(
            &folder,
            &format!("{LINE} --flow-style tube --flow-width {width}"),
        )
        .0
    };
    assert_eq!(width("3km"), width("6"));
    assert_eq!(width("0.001km"), width("1.2"));
    assert!(count(&width("3km")) > 2 * count(&width("2")));
}

#[test]
fn spheres_lie_on_the_line_and_ribbons_are_flat() {
    let folder = Folder::new();
    let style = |style: &str| {
        alphas(
            &folder,
            &format!("{LINE} --flow-style {style} --flow-width 4"),
        )
    };
    let (tube, _) = style("tube");
    let (points, said) = style("points");
    assert!(said.contains("a sphere every "), "{said}");
    assert!(
        count(&points) > 20 && count(&points) < count(&tube),
        "{}",
        count(&points)
    );
    // From above no sphere covers what the tube of the same width does not.
    let beside = tube
        .iter()
        .zip(&points)
        .filter(|(tube, point)| **tube == 0.0 && **point > 0.0);
    assert_eq!(beside.count(), 0);
    // A ribbon that is turned is narrower than a tube seen from above, and never wider.
    let (ribbons, _) = style("ribbons");
    assert!(count(&ribbons) > count(&tube) / 4, "{}", count(&ribbons));
    assert!(count(&ribbons) <= count(&tube) + 20, "{}", count(&ribbons));
}

#[test]
fn styles_and_widths_that_mean_nothing_are_refused_by_name() {
    let folder = Folder::new();
    for (words, wanted) in [
        (
            "phantom:storm,n=16 --flow streak --flow-style points",
            "no particle goes along smoke",
        ),
        (
            "phantom:storm,n=16 --flow streak --flow-style ribbons",
            "no particle goes along smoke",
        ),
        (
            "phantom:storm,n=16 --flow stream --flow-width 50km",
            "--flow-width 50km: wanted over 0 and at most",
        ),
        (
            "phantom:flow,kind=saddle,n=16 --flow stream --flow-width 1km",
            "--flow-width 1km is of the Earth",
        ),
        (
            "phantom:storm,n=16 --flow stream --flow-width 1mile",
            "or a length such as 20km",
        ),
    ] {
        let ran = folder.run(&format!(
            "render {words} -o p.png --size 40x40 --device reference"
        ));
        assert_ne!(ran.code, 0, "{words}");
        assert!(ran.err.contains(wanted), "{words}: {}", ran.err);
    }
}

/// A wind along x that is twice as fast at the second time, on a grid of 16 x 8 x 2 points a kilometre apart.
fn faster() -> Vec<u8> {
    let axis = |name, texts, count: u32, dimension| Variable {
        name,
        dimensions: dimension,
        texts,
        numbers: &[],
        values: (0..count).map(f64::from).collect(),
    };
    let wind = |name, standard, speeds: [f64; 2]| Variable {
        name,
        dimensions: &[0, 1, 2, 3],
        texts: standard,
        numbers: &[],
        values: speeds.iter().flat_map(|&speed| [speed; 256]).collect(),
    };
    netcdf(
        &[("time", 2), ("height", 2), ("y", 8), ("x", 16)],
        &[],
        &[
            axis(
                "time",
                &[("units", "hours since 2000-01-01 00:00:00")],
                2,
                &[0],
            ),
            axis(
                "height",
                &[("units", "km"), ("axis", "Z"), ("positive", "up")],
                2,
                &[1],
            ),
            axis(
                "y",
                &[
                    ("units", "km"),
                    ("standard_name", "projection_y_coordinate"),
                ],
                8,
                &[2],
            ),
            axis(
                "x",
                &[
                    ("units", "km"),
                    ("standard_name", "projection_x_coordinate"),
                ],
                16,
                &[3],
            ),
            wind(
                "u",
                &[("units", "m s-1"), ("standard_name", "x_wind")],
                [5.0, 10.0],
            ),
            wind(
                "v",
                &[("units", "m s-1"), ("standard_name", "y_wind")],
                [0.0, 0.0],
            ),
        ],
    )
}

#[test]
fn spheres_of_a_film_are_as_many_seconds_apart_in_all_of_its_frames() {
    let folder = Folder::new();
    folder.file("f.nc", faster());
    let words = "f.nc --variable u --flow stream --flow-seeds rake:7.5,2,0.5,7.5,6,0.5,3 --flow-style points --flow-width 2 \
                 --flow-color 1:0:0 --hide-volume --look plain --background none --projection orthographic --view superior \
                 --size 120x80 --exaggerate 1 --device reference --force";
    let film = folder.run(&format!("animate {words} --times --between 0 -o f%d.npy"));
    film.assert_done();
    let still = folder.run(&format!("render {words} --time 1 -o s.npy"));
    still.assert_done();
    let drawn = |name: &str| {
        let bytes = fs::read(folder.path(name)).expect("a picture");
        let pixels = bytes[bytes.len() - 16 * 120 * 80..].chunks(16);
        let alpha = |pixel: &[u8]| f32::from_le_bytes(pixel[12..].try_into().expect("four bytes"));
        pixels.filter(|pixel| alpha(pixel) > 0.0).count()
    };
    // Lines are as long: as many spheres at twice the speed are twice as far apart, in a picture of its own half as many seconds.
    let [first, second, alone] = ["f0.npy", "f1.npy", "s.npy"].map(drawn);
    assert!(first > 60, "{first}");
    let share = second as f64 / first as f64;
    assert!((0.4..0.65).contains(&share), "{first} {second}");
    assert!(alone as f64 > 0.8 * first as f64, "{first} {alone}");
}

/// A map around latitude 39, whose opposite pole lies nowhere on it.
#[test]
fn points_without_a_place_on_the_map_are_told() {
    let folder = Folder::new();
    let values = (0..64).map(f64::from).collect();
    let wrf = netcdf_with(
        &[("bottom_top", 4), ("south_north", 4), ("west_east", 4)],
        &[],
        &[
            ("DX", 4000.0),
            ("DY", 4000.0),
            ("MAP_PROJ", 1.0),
            ("TRUELAT1", 30.0),
            ("TRUELAT2", 60.0),
            ("STAND_LON", -100.0),
            ("CEN_LAT", 39.0),
            ("CEN_LON", -100.0),
        ],
        &[Variable {
            name: "QVAPOR",
            dimensions: &[0, 1, 2],
            texts: &[("units", "kg kg-1")],
            numbers: &[],
            values,
        }],
    );
    folder.file("w.nc", wrf);
    folder.file(
        "p.csv",
        "lon,lat,height_km,value\n-100,39,1,1\n-100.01,39.01,1,2\n-100,-90,1,3\n",
    );
    let render = |words: &str| {
        let ran = folder.run(&format!(
            "render w.nc --variable QVAPOR {words} --size 40x30 --device reference --force -o a.png"
        ));
        ran.assert_done();
        ran.err
    };
    let said = render("--with p.csv");
    assert!(said.contains("with p.csv, 2 points"), "{said}");
    assert!(
        said.contains("points without a place on the map of the volume: 1; they are left out"),
        "{said}"
    );
    folder.file(
        "p.csv",
        "lon,lat,height_km,value\n-100,39,1,1\n-100.01,39.01,1,2\n",
    );
    let said = render("--with p.csv");
    assert!(!said.contains("without a place"), "{said}");
}

#[test]
fn lines_that_are_wider_than_asked_for_and_their_rays_are_told() {
    let folder = Folder::new();
    let words = "phantom:storm,n=8,times=2 --variable vapor --hide-volume --flow stream --flow-seeds random:3 --size 40x30 \
                 --device reference --force";
    let thin = "pixels where the camera is turned to, and lines are drawn 1.2 pixels wide";
    let rays = "four rays a pixel, for the edges of what lies beside the volume";
    for command in [
        format!("render {words} -o a.png"),
        format!("animate {words} --times --between 0 -o f%d.png"),
    ] {
        for (more, is_thin, is_chosen) in [
            ("--flow-width 0.001km", true, true),
            ("--flow-width 5km --aa 4", false, false),
            ("--look plain", false, false),
        ] {
            let ran = folder.run(&format!("{command} {more}"));
            ran.assert_done();
            assert_eq!(
                ran.err.contains(thin),
                is_thin,
                "{command} {more}: {}",
                ran.err
            );
            assert_eq!(
                ran.err.matches(rays).count(),
                usize::from(is_chosen),
                "{command} {more}: {}",
                ran.err
            );
        }
    }
}
