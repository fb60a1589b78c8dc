//! Colour by one number, opacity by another, as a person says it.

use crate::person::Folder;
use std::fs;

const DRAW: &str = "--size 24x16 --device reference --force";

/// 8-bit voxels in steps of this many, 6 x 5 x 4 of spacing 1, of one number each.
fn nrrd(spacing: f64, sizes: [usize; 3], voxel: impl Fn(usize) -> u8) -> Vec<u8> {
    let [x, y, z] = sizes;
    let header = format!(
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: {x} {y} {z}\nencoding: raw\n\
         space: right-anterior-superior\nspace directions: ({spacing},0,0) (0,{spacing},0) (0,0,{spacing})\n\n"
    );
    let mut bytes = header.into_bytes();
    bytes.extend((0..x * y * z).map(voxel));
    bytes
}

const RED: &str =
    r#"{"stratavox_transfer_function": 1, "color": [[0, 1, 0, 0]], "opacity": [[0, 1]]}"#;
const HALF: &str = r#"{"stratavox_transfer_function": 1, "color": [[0, 0, 1, 0]], "opacity": [[99, 0], [100, 0.5]]}"#;

/// What these words draw, and what is said meanwhile.
fn picture(folder: &Folder, words: &str) -> (Vec<u8>, String) {
    let ran = folder.run(&format!("render {words} -o p.npy {DRAW}"));
    ran.assert_done();
    (fs::read(folder.path("p.npy")).expect("a file"), ran.err)
}

/// Linear premultiplied numbers.
fn pixels(bytes: &[u8]) -> Vec<[f32; 4]> {
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (numbers, _) = bytes[start..].as_chunks::<4>();
    let numbers: Vec<f32> = numbers.iter().map(|b| f32::from_le_bytes(*b)).collect();
    numbers.as_chunks::<4>().0.to_vec()
}

#[test]
fn another_file_says_how_opaque_the_colours_are_and_a_scene_carries_it() {
    let folder = Folder::new();
    folder.file("ct.nrrd", nrrd(1.0, [6, 4, 4], |i| i as u8));
    // The same place in voxels of half the side: the half of it with x over 3 is opaque.
    let pet = |i: usize| if i % 12 < 6 { 0 } else { 100 };
    folder.file("pet.nrrd", nrrd(0.5, [12, 8, 8], pet));
    folder.file("red.json", RED);
    folder.file("half.json", HALF);
    let words = "ct.nrrd --tf red.json --opacity-from pet.nrrd --opacity-tf half.json";
    let (bytes, said) = picture(&folder, &format!("{words} --save-scene s.json"));
    assert!(said.contains("opaque by pet.nrrd"), "{said}");
    assert!(said.contains("another grid"), "{said}");
    let all = pixels(&bytes);
    let drawn = all.iter().filter(|p| p[3] > 0.2).count();
    assert!((20..300).contains(&drawn), "{drawn} pixels are drawn");
    for pixel in &all {
        assert_eq!(
            [pixel[1], pixel[2]],
            [0.0; 2],
            "the colour is not of the CT"
        );
        assert!((pixel[0] - pixel[3]).abs() < 1e-6, "{pixel:?}");
    }
    let (again, _) = picture(&folder, "--scene s.json");
    assert_eq!(again, bytes);
    let (plain, _) = picture(&folder, "ct.nrrd --tf red.json");
    assert_ne!(plain, bytes);
}

#[test]
fn weather_is_coloured_by_one_variable_and_opaque_by_another() {
    let folder = Folder::new();
    let storm = "phantom:storm,n=12 --variable temperature";
    let (cold, _) = picture(&folder, storm);
    let words = format!("{storm} --opacity-variable cloud");
    let (clouds, said) = picture(&folder, &words);
    assert!(said.contains("opaque by cloud"), "{said}");
    assert_ne!(clouds, cold);
    let (near, _) = picture(&folder, &format!("{words} --opacity-window 0.1,0.2"));
    assert_ne!(near, clouds);
    let (two, said) = picture(
        &folder,
        "phantom:cells,n=12 --component 0 --opacity-component 1",
    );
    assert!(said.contains("number 1 of phantom:cells"), "{said}");
    assert!(pixels(&two).iter().any(|p| p[3] > 0.0));
}

#[test]
fn what_cannot_be_opaque_by_other_numbers_says_so() {
    let folder = Folder::new();
    let contour = r#"{"stratavox_transfer_function": 1, "widgets": [
        {"shape": "contour", "value": 5, "opacity": 0.2, "color": [1, 1, 1]}]}"#;
    folder.file("widgets.json", contour);
    folder.file("far.nrrd", nrrd(1e-3, [2, 2, 2], |i| i as u8));
    let storm = "phantom:storm,n=8 --variable temperature";
    let by = "--opacity-variable cloud";
    for (words, code, said) in [
        (format!("{storm} {by} --mode mip"), 2, "--mode composite"),
        (
            format!("{storm} {by} --preintegrated"),
            2,
            "--preintegrated",
        ),
        (format!("{storm} {by} --filter cubic"), 2, "--filter"),
        (format!("{storm} {by} --tf widgets.json"), 2, "widgets"),
        (
            format!("{storm} {by} --opacity-tf widgets.json"),
            2,
            "--opacity-tf",
        ),
        (
            format!("{storm} --opacity-variable temperature"),
            2,
            "needs no word",
        ),
        (format!("{storm} --opacity-variable hail"), 3, "hail"),
        // What is wrong with these words is not said of those for INPUT.
        (
            "phantom:head,n=8 --opacity-from phantom:storm,n=8".to_owned(),
            2,
            "choose one with --opacity-variable NAME",
        ),
        (
            format!("{storm} {by} --opacity-window 5,5"),
            2,
            "--opacity-window 5,5",
        ),
        (
            format!("{storm} --opacity-window 0,1"),
            2,
            "--opacity-window",
        ),
        (
            format!("{storm} --opacity-component 1"),
            2,
            "--opacity-component",
        ),
        (
            "phantom:cells,n=8 --opacity-component 1".to_owned(),
            2,
            "--component 0",
        ),
        (format!("{storm} --opacity-from far.nrrd"), 3, "overlap"),
        (format!("{storm} --opacity-from none.nrrd"), 3, "none.nrrd"),
    ] {
        let ran = folder.run(&format!("render {words} -o x.npy {DRAW}"));
        assert_eq!(ran.code, code, "{words}: {}", ran.err);
        assert!(ran.err.contains(said), "{words}: {}", ran.err);
    }
}
