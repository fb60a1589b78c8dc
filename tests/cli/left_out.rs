//! Thin components at faces of the box that composites of CT leave out, and what stays.

use crate::person::Folder;
use std::fs;

const N: i32 = 48;

/// A CT of `hounsfield` at each voxel, as MetaImage.
fn ct(folder: &Folder, name: &str, hounsfield: impl Fn([f64; 3]) -> i16) {
    let header = format!(
        "ObjectType = Image\nNDims = 3\nDimSize = {N} {N} {N}\nElementSpacing = 1 1 1\nElementType = MET_SHORT\nElementDataFile = LOCAL\n"
    );
    let mut bytes = header.into_bytes();
    for i in 0..N * N * N {
        let at = [i % N, i / N % N, i / N / N].map(|c| f64::from(c) + 0.5);
        // A little of each number, so that they are no labels.
        let noise = (i * 7919 % 61) as i16 - 30;
        bytes.extend((hounsfield(at) + noise).to_le_bytes());
    }
    fs::write(folder.path(name), bytes).expect("a file");
}

fn is_in(at: [f64; 3], center: [f64; 3], radii: [f64; 3]) -> bool {
    (0..3)
        .map(|k| ((at[k] - center[k]) / radii[k]).powi(2))
        .sum::<f64>()
        < 1.0
}

/// A head with bone inside, and under it a curved plate through the box where `has_plate`.
fn head([x, y, z]: [f64; 3], has_plate: bool) -> i16 {
    let at = [x, y, z];
    let plate = 42.0 - 0.008 * (x - 24.0).powi(2);
    match () {
        () if is_in(at, [24.0, 20.0, 24.0], [10.0; 3]) => 900,
        () if is_in(at, [24.0, 20.0, 24.0], [15.0; 3]) => 40,
        () if has_plate && (y - plate).abs() < 1.0 => 100,
        () => -970,
    }
}

/// A file of [`head`] with the plate.
pub fn with_plate(folder: &Folder, name: &str) {
    ct(folder, name, |at| head(at, true));
}

/// A trunk that fills the box and is cut by its faces, lungs with vessels that the lower face cuts, ribs, and an arm.
fn thorax(at: [f64; 3]) -> i16 {
    let [x, y, z] = at;
    let lungs = [14.0, 34.0].map(|lung| is_in(at, [lung, 24.0, 4.0], [8.0, 14.0, 36.0]));
    let trunk = ((x - 24.0) / 22.0).powi(2) + ((y - 24.0) / 24.5).powi(2);
    let is_rib = (0.8..0.9).contains(&trunk) && z % 8.0 < 3.0;
    match () {
        () if lungs.contains(&true)
            && (y - 24.0).abs() < 0.6
            && z < 20.0
            && (x - 14.0).abs() < 6.0 =>
        {
            30
        }
        () if lungs.contains(&true) => -860,
        () if is_rib => 700,
        () if trunk < 1.0 => 40,
        () if is_in(at, [46.0, 4.0, 24.0], [4.0, 5.0, 90.0]) => 40,
        () => -970,
    }
}

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    fs::read(folder.path(name)).expect("a picture")
}

#[test]
fn a_table_under_a_head_is_left_out_and_keep_all_draws_it() {
    let folder = Folder::new();
    ct(&folder, "table.mha", |at| head(at, true));
    ct(&folder, "head.mha", |at| head(at, false));
    let draw = |words: &str| {
        let ran = folder.run(&format!("render {words} --size 64x48 --frame box"));
        ran.assert_done();
        ran.err
    };
    let note = draw("table.mha --half-gradient 1 -o table.png --save-scene table.json");
    assert!(note.contains("left out are thin components"), "{note}");
    // The head is number 1, whichever is met first.
    for words in ["number 2 of 2 by size", "[0, ", "--keep-all"] {
        assert!(note.contains(words), "{note}");
    }
    let film = folder.run("animate table.mha --turntable 3 --size 16x12 -o film.gif");
    film.assert_done();
    assert_eq!(film.err.matches("left out").count(), 1, "{film:?}");
    assert!(!draw("head.mha --half-gradient 1 -o head.png").contains("left out"));
    assert!(is_close(&folder));
    assert!(!draw("table.mha --half-gradient 1 --keep-all -o all.png").contains("left out"));
    assert!(bytes(&folder, "all.png") != bytes(&folder, "table.png"));
    folder
        .run("render --scene table.json -o again.png")
        .assert_done();
    assert!(bytes(&folder, "again.png") == bytes(&folder, "table.png"));
    for words in ["--look plain", "--mode mip", "--aov depth"] {
        let note = draw(&format!("table.mha {words} -o a.exr --force"));
        assert!(!note.contains("left out"), "{words}");
    }
}

/// Whether both pictures are the same within two codes: what was the plate has no noise, and is unseen as air is.
fn is_close(folder: &Folder) -> bool {
    let [a, b] = ["table.png", "head.png"].map(|name| {
        image::open(folder.path(name))
            .expect("a picture")
            .to_rgba8()
    });
    a.iter().zip(b.iter()).all(|(a, b)| a.abs_diff(*b) <= 2)
}

#[test]
fn nothing_of_a_thorax_that_fills_its_box_goes() {
    let folder = Folder::new();
    ct(&folder, "thorax.mha", thorax);
    let ran = folder.run("render thorax.mha --size 64x48 -o auto.png");
    ran.assert_done();
    assert!(!ran.err.contains("left out"), "{ran:?}");
    folder
        .run("render thorax.mha --size 64x48 --keep-all -o all.png")
        .assert_done();
    assert!(bytes(&folder, "auto.png") == bytes(&folder, "all.png"));
}
