//! Scattered points as spheres.

use crate::person::Folder;
use std::fs;

const SIDE: usize = 60;
/// A pixel a unit of the world, seen from above.
const VIEW: &str = "--target 0,0,0 --projection orthographic --view-height 60 --size 60x60 --background none --eye 0,0,100 \
                    --up 0,1,0 --look plain";

fn alphas(folder: &Folder, words: &str) -> Vec<f32> {
    let ran = folder.run(&format!(
        "render p.csv --points-as spheres {VIEW} {words} -o a.npy --force"
    ));
    ran.assert_done();
    let bytes = fs::read(folder.path("a.npy")).expect("a picture");
    let pixels = bytes[bytes.len() - 16 * SIDE * SIDE..].chunks(16);
    let alpha = |pixel: &[u8]| f32::from_le_bytes(pixel[12..].try_into().expect("four bytes"));
    pixels.map(alpha).collect()
}

#[test]
fn a_sphere_is_as_wide_as_its_value_says() {
    let folder = Folder::new();
    folder.file("p.csv", "x,y,z,v\n-15,0,0,1\n15,10,3,2\n0,-20,-3,3\n");
    let drawn = alphas(&folder, "--sphere-size 12");
    let spheres = [
        (-15.0, 0.0, 0.3 * 6.0),
        (15.0, 10.0, 0.65 * 6.0),
        (0.0, -20.0, 6.0),
    ];
    for (i, &alpha) in drawn.iter().enumerate() {
        let [x, y] = [
            (i % SIDE) as f64 + 0.5 - 30.0,
            30.0 - ((i / SIDE) as f64 + 0.5),
        ];
        let covers = |&(a, b, radius): &(f64, f64, f64)| (x - a).hypot(y - b) < radius;
        assert_eq!(alpha == 1.0, spheres.iter().any(covers), "{x} {y}: {alpha}");
        assert!(
            alpha == 0.0 || alpha == 1.0,
            "nothing else is drawn: {alpha} at {x} {y}"
        );
    }
    let count = |words: &str| {
        alphas(&folder, words)
            .iter()
            .filter(|&&alpha| alpha > 0.0)
            .count()
    };
    assert!(count("") > count("--sphere-size 12"));
    // A plane takes those away whose middles it cuts off, and leaves the others whole.
    let cut = alphas(&folder, "--sphere-size 12 --clip 1,0,0,-1");
    for (i, (&cut, &whole)) in cut.iter().zip(&drawn).enumerate() {
        let is_left = i % SIDE < 20;
        assert_eq!(cut, if is_left { 0.0 } else { whole }, "pixel {i}");
    }
}

#[test]
fn a_saved_scene_of_spheres_draws_the_same_picture() {
    let folder = Folder::new();
    folder.file("p.csv", "x,y,z,v\n-15,0,0,1\n15,10,3,2\n0,-20,-3,3\n");
    folder
        .run(
            "render p.csv --points-as spheres --annotate --size 80x60 -o a.png --save-scene s.json",
        )
        .assert_done();
    folder.run("render --scene s.json -o b.png").assert_done();
    let read = |name| fs::read(folder.path(name)).expect("a picture");
    assert!(read("a.png") == read("b.png"));
}

#[test]
fn what_spheres_do_not_go_with_is_refused_by_name() {
    let folder = Folder::new();
    folder.file("p.csv", "x,y,z,v\n-15,0,0,1\n15,10,3,2\n0,-20,-3,3\n");
    for (words, said) in [
        ("p.csv --points-as spheres --mode mip", "--mode mip"),
        (
            "p.csv --points-as spheres --technique splat",
            "and --technique splat",
        ),
        (
            "p.csv --points-as spheres --labels p.csv",
            "scattered points",
        ),
        ("p.csv --points-as spheres --section axial", "--section"),
        ("p.csv --points-as spheres --sphere-size 0", "--sphere-size"),
        (
            "p.csv --points-as spheres --sphere-size 21",
            "at most 20 pixels",
        ),
        ("p.csv --points-as spheres --jitter", "and --jitter"),
        (
            "p.csv --points-as spheres --preintegrated",
            "and --preintegrated",
        ),
        ("p.csv --points-as spheres --filter cubic", "and --filter"),
        (
            "p.csv --points-as spheres --shading phong",
            "and --shading phong",
        ),
        (
            "p.csv --points-as spheres --ambient-occlusion 1",
            "and --ambient-occlusion",
        ),
        ("p.csv --points-as cubes", "cubes"),
        ("p.csv --sphere-size 3", "--points-as spheres"),
        ("phantom:sphere,n=8 --points-as spheres", "--points-as"),
    ] {
        let ran = folder.run(&format!("render {words} -o q.png --size 20x20"));
        ran.assert_refused(2, &[said]);
    }
}
