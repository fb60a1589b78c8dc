//! Rays through scattered points, from a file to a picture. Drawn by the CPU reference.

use crate::person::{Folder, Ran};

const SMALL: &str = "--size 40x30 --device reference --force";

/// Points on a spiral; the later, the larger the value.
fn folder() -> Folder {
    let row = |i: u32| {
        let t = f64::from(i);
        format!(
            "{},{},{},{t}",
            (0.3 * t).cos() * t,
            (0.3 * t).sin() * t,
            0.5 * t
        )
    };
    let rows: Vec<_> = ["x,y,z,strength".to_owned()]
        .into_iter()
        .chain((0..60).map(row))
        .collect();
    let folder = Folder::new();
    folder.file("p.csv", rows.join("\n"));
    folder
}

/// Alphas of the pixels of a picture.
fn drawn(folder: &Folder, words: &str) -> (Vec<f32>, Ran) {
    let ran = folder.run(&format!("render --look plain {words} -o p.npy {SMALL}"));
    ran.assert_done();
    let bytes = std::fs::read(folder.path("p.npy")).expect("a picture");
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let alphas = bytes[start..].chunks_exact(16).map(|pixel| &pixel[12..]);
    let alphas = alphas.map(|b| f32::from_le_bytes(b.try_into().expect("four")));
    (alphas.collect(), ran)
}

fn seen(alphas: &[f32]) -> usize {
    alphas.iter().filter(|&&alpha| alpha > 1e-3).count()
}

#[test]
fn a_field_is_drawn_by_its_word_or_by_that_of_points_and_its_radius_is_said() {
    let folder = folder();
    let (by_word, ran) = drawn(&folder, "p.csv --points-as field");
    assert!(seen(&by_word) > 100, "{}", seen(&by_word));
    for words in [
        "points reach",
        "twice the mean distance",
        "--field kernel:R",
    ] {
        assert!(ran.err.contains(words), "{}", ran.err);
    }
    assert!(!ran.err.contains("standard deviation"), "{}", ran.err);
    let (implied, _) = drawn(&folder, "p.csv --field kernel");
    assert_eq!(by_word, implied);
    let (wide, ran) = drawn(&folder, "p.csv --field kernel:12");
    assert!(
        wide != by_word && !ran.err.contains("points reach"),
        "{}",
        ran.err
    );
    let (splats, _) = drawn(&folder, "p.csv");
    assert_ne!(by_word, splats);
    for words in [
        "--field kernel:8,density",
        "--field kernel,density --mode xray",
        "--field kernel:8 --mode mip --jitter",
    ] {
        assert!(
            seen(&drawn(&folder, &format!("p.csv {words}")).0) > 60,
            "{words}"
        );
    }
}

#[test]
fn a_saved_scene_of_a_field_draws_the_same_picture() {
    let folder = folder();
    let first = format!("render p.csv --field kernel,density -o a.png --save-scene s.json {SMALL}");
    folder.run(&first).assert_done();
    let again = "render --scene s.json -o b.png --device reference";
    folder.run(again).assert_done();
    let read = |name| std::fs::read(folder.path(name)).expect("a picture");
    assert!(read("a.png") == read("b.png"));
}

#[test]
fn what_rays_through_points_do_not_have_is_refused_by_name() {
    let folder = folder();
    let hint = "--points-as grid makes a volume of them";
    for (words, said) in [
        (
            "p.csv --field kernel --technique slices-3d",
            "technique slices-3d",
        ),
        ("p.csv --field kernel --technique splat", "technique splat"),
        (
            "p.csv --field kernel --technique pathtrace",
            "technique pathtrace",
        ),
        ("p.csv --field kernel --mode lmip", "mode lmip"),
        ("p.csv --field kernel --mode iso --iso 3", "mode iso"),
        ("p.csv --field kernel --filter cubic", "the filter cubic"),
        (
            "p.csv --field kernel --lattice planes",
            "the lattice planes",
        ),
        ("p.csv --field kernel --preintegrated", "pre-integrated"),
        ("p.csv --field kernel --empty-space octree", "octree"),
        ("p.csv --field kernel --shading phong", "lights"),
        (
            "p.csv --field kernel --scattering single",
            "single scattering",
        ),
    ] {
        let ran = folder.run(&format!("render {words} -o q.png {SMALL}"));
        ran.assert_refused(2, &[said, hint]);
    }
    for (words, said) in [
        ("p.csv --field idw", "kernel:R"),
        ("p.csv --field kernel:0", "kernel:R"),
        (
            "p.csv --field kernel --points-as splats",
            "--field needs --points-as field",
        ),
        ("p.csv --field kernel --grid 8x8x8", "need --points-as grid"),
        (
            "p.csv --field kernel --labels p.csv",
            "--labels is for volumes",
        ),
        (
            "p.csv --field kernel --section axial",
            "--section is for volumes",
        ),
        ("p.csv --field kernel --stream", "--stream"),
        (
            "phantom:sphere,n=8 --field kernel",
            "--field is for scattered points",
        ),
        (
            "phantom:sphere,n=8 --points-as field",
            "--points-as is for scattered points",
        ),
    ] {
        let ran = folder.run(&format!("render {words} -o q.png {SMALL}"));
        ran.assert_refused(2, &[said]);
    }
    assert_eq!(folder.names(), ["p.csv"]);
}
