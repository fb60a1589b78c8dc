//! What a picture without flags is fitted to and seen from, and that its note says flags that draw the same.

use crate::look::{box_of, picture};
use crate::person::Folder;
use std::fs;

const SMALL: &str = "--size 96x72 --device reference";

/// Bytes as NRRD; `space` is empty, or the lines that say how axes lie.
fn nrrd(
    folder: &Folder,
    name: &str,
    [x, y, z]: [usize; 3],
    space: &str,
    voxel: impl Fn([usize; 3]) -> u8,
) {
    let mut bytes = format!(
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: {x} {y} {z}\n{space}encoding: raw\n\n"
    )
    .into_bytes();
    bytes.extend((0..x * y * z).map(|i| voxel([i % x, i / x % y, i / x / y])));
    folder.file(name, bytes);
}

/// Opaque from 50 on, in greys.
fn opaque(folder: &Folder) {
    let tf = r#"{"stratavox_transfer_function":1,"color":[[0,0,0,0],[255,1,1,1]],
                 "opacity":[[49,0],[50,1],[255,1]]}"#;
    folder.file("tf.json", tf);
}

/// The sentence about the fit, and the flags behind its colon.
fn fit(err: &str) -> (&str, &str) {
    let line = err.lines().find(|line| line.contains("framed to"));
    let line = line.unwrap_or_else(|| panic!("no fit: {err}"));
    line.rsplit_once(": ").expect("flags")
}

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    fs::read(folder.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// How much of the frame the larger side of what is seen fills, and how far it is from the middle.
fn filled(folder: &Folder, name: &str) -> [f64; 2] {
    let picture = picture(folder, name);
    let [width, height] = [picture.width(), picture.height()].map(f64::from);
    let [left, top, right, bottom] = box_of(&picture);
    let off = [
        0.5 * (left + right) / width - 0.5,
        0.5 * (top + bottom) / height - 0.5,
    ];
    let larger = ((right - left) / width).max((bottom - top) / height);
    [larger, off[0].abs().max(off[1].abs())]
}

/// A cube whose faces to -x and -y have a pattern, and its other faces one grey.
fn patterned(folder: &Folder, name: &str, space: &str) {
    nrrd(folder, name, [24; 3], space, |[x, y, z]| {
        match x < 2 || y < 2 {
            true => (50 + (x * 31 + y * 57 + z * 101) % 206) as u8,
            false => 120,
        }
    });
}

const RAS: &str = "space: right-anterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n";

#[test]
fn the_flags_of_the_note_draw_the_same_picture() {
    let folder = Folder::new();
    opaque(&folder);
    patterned(&folder, "pattern.nrrd", "");
    nrrd(&folder, "slab.nrrd", [32, 32, 6], "", |[x, y, _]| {
        (60 + x + 2 * y) as u8
    });
    for (name, words, side) in [
        (
            "pattern",
            "pattern.nrrd --tf tf.json",
            "--azimuth 240 --elevation 15 ",
        ),
        ("slab", "slab.nrrd --tf tf.json", "--view superior "),
        ("head", "phantom:head,n=24", ""),
        ("left", "phantom:head,n=24 --view left", ""),
    ] {
        let ran = folder.run(&format!("render {words} {SMALL} -o {name}.png"));
        ran.assert_done();
        let (_, flags) = fit(&ran.err);
        assert!(
            flags.starts_with(&format!("{side}--target ")),
            "{name}: {ran:?}"
        );
        let again = folder.run(&format!(
            "render {words} {flags} {SMALL} -o again-{name}.png"
        ));
        again.assert_done();
        assert!(!again.err.contains("framed"), "{name}: {again:?}");
        assert!(
            bytes(&folder, &format!("{name}.png")) == bytes(&folder, &format!("again-{name}.png")),
            "{name}"
        );
    }
    // The side that was chosen is another one than that of plain pictures.
    folder
        .run(&format!(
            "render pattern.nrrd --tf tf.json --azimuth 60 --elevation 15 {SMALL} -o usual.png"
        ))
        .assert_done();
    assert!(bytes(&folder, "pattern.png") != bytes(&folder, "usual.png"));
}

#[test]
fn sheets_and_thumbnails_say_what_they_framed_of_each_input() {
    let folder = Folder::new();
    nrrd(&folder, "slab.nrrd", [32, 32, 6], "", |[x, y, _]| {
        (60 + x + 2 * y) as u8
    });
    let ran = folder.run("sheet phantom:head,n=24 slab.nrrd --tile 48x36 -o s.png");
    ran.assert_done();
    for words in [
        "phantom:head,n=24: framed to what is visible: --target",
        "slab.nrrd: framed to what is visible: --view superior --target",
    ] {
        assert!(ran.err.contains(words), "{words}: {ran:?}");
    }
    let ran = folder.run("thumbnails phantom:head,n=24 slab.nrrd -o small");
    ran.assert_done();
    for words in [
        "phantom:head,n=24: framed to what is visible: --target",
        "slab.nrrd: framed to what is visible: --view superior --target",
    ] {
        assert!(ran.err.contains(words), "{words}: {ran:?}");
    }
    let ran = folder.run("thumbnails slab.nrrd -o views --views left,front");
    ran.assert_done();
    for view in ["left", "front"] {
        let words = format!("slab.nrrd: --view {view}: framed to what is visible: --target");
        assert!(ran.err.contains(&words), "{words}: {ran:?}");
    }
}

#[test]
fn what_is_no_composite_of_one_volume_is_fitted_to_its_box() {
    let folder = Folder::new();
    opaque(&folder);
    nrrd(&folder, "blob.nrrd", [32; 3], "", |at| {
        if at.iter().all(|c| (4..10).contains(c)) {
            200
        } else {
            0
        }
    });
    for (words, same, said) in [
        ("--mode xray", "--mode xray --frame box", "the box"),
        (
            "--tf tf.json --crop 2,30,2,14,2,14",
            "--tf tf.json --crop 2,30,2,14,2,14 --frame box",
            "the cropped box",
        ),
        (
            "--tf tf.json --clip 1,0,0,20",
            "--tf tf.json --clip 1,0,0,20 --frame box --azimuth 60 --elevation 15",
            "the box, because nothing is visible",
        ),
    ] {
        let ran = folder.run(&format!(
            "render blob.nrrd {words} {SMALL} --force -o a.png"
        ));
        ran.assert_done();
        let (sentence, _) = fit(&ran.err);
        assert!(
            sentence.ends_with(&format!("framed to {said}")),
            "{words}: {ran:?}"
        );
        folder
            .run(&format!("render blob.nrrd {same} {SMALL} --force -o b.png"))
            .assert_done();
        assert!(
            bytes(&folder, "a.png") == bytes(&folder, "b.png"),
            "{words}"
        );
    }
    // The crop box itself fills the frame.
    let all = r#"{"stratavox_transfer_function":1,"color":[[0,1,1,1]],"opacity":[[0,1],[255,1]]}"#;
    folder.file("all.json", all);
    folder
        .run(&format!(
            "render blob.nrrd --tf all.json --crop 2,30,2,14,2,14 {SMALL} -o crop.png"
        ))
        .assert_done();
    let [larger, off] = filled(&folder, "crop.png");
    assert!(
        (0.86..0.94).contains(&larger) && off < 0.03,
        "{larger} {off}"
    );
}

#[test]
fn a_section_shows_its_plane_and_has_no_fit() {
    let folder = Folder::new();
    let section = format!("render phantom:head,n=24 --section axial {SMALL}");
    let ran = folder.run(&format!("{section} -o a.png"));
    ran.assert_done();
    assert!(!ran.err.contains("framed"), "{ran:?}");
    folder
        .run(&format!(
            "{section} --look plain --background #18181c -o b.png"
        ))
        .assert_done();
    assert!(bytes(&folder, "a.png") == bytes(&folder, "b.png"));
    let ran = folder.run(&format!("{section} --frame visible -o c.png"));
    ran.assert_done();
    assert!(
        ran.err.contains("--frame has no effect with --section"),
        "{ran:?}"
    );
    assert!(bytes(&folder, "a.png") == bytes(&folder, "c.png"));
}

#[test]
fn several_volumes_are_framed_together() {
    let folder = Folder::new();
    opaque(&folder);
    let blob = |from: usize| {
        move |at: [usize; 3]| {
            if at.iter().all(|c| (from..from + 6).contains(c)) {
                200
            } else {
                0
            }
        }
    };
    nrrd(&folder, "low.nrrd", [32; 3], RAS, blob(4));
    nrrd(&folder, "labels.nrrd", [32; 3], RAS, |at| {
        blob(22)(at) / 100
    });
    let words = format!("render low.nrrd --tf tf.json --view front {SMALL}");
    let ran = folder.run(&format!("{words} -o alone.png"));
    ran.assert_done();
    let alone = fit(&ran.err).1.to_owned();
    let ran = folder.run(&format!("{words} --labels labels.nrrd -o both.png"));
    ran.assert_done();
    assert!(fit(&ran.err).1 != alone, "{ran:?}");
    let [larger, off] = filled(&folder, "both.png");
    assert!(
        (0.85..0.95).contains(&larger) && off < 0.03,
        "{larger} {off}"
    );
    // Each of them is a small part of that frame: a left one, and a right one above it.
    let pixels = picture(&folder, "both.png");
    let [left, top, right, bottom] = box_of(&pixels);
    let is_dark = |x: f64, y: f64| pixels.get_pixel(x as u32, y as u32).0[..3] == [24, 24, 28];
    assert!(is_dark(left + 2.0, top + 2.0) || is_dark(right - 3.0, top + 2.0));
    assert!(
        is_dark(0.5 * (left + right), 0.5 * (top + bottom)),
        "nothing in the middle"
    );
}

#[test]
fn a_volume_in_bricks_is_fitted_by_its_overview() {
    let folder = Folder::new();
    let bytes: Vec<u8> = (0..96 * 96 * 96_usize)
        .flat_map(|i| {
            let at = [i % 96, i / 96 % 96, i / 96 / 96];
            let is_blob = at.iter().all(|c| (8..40).contains(c));
            (if is_blob {
                3000_u16 + (i % 7) as u16
            } else {
                0
            })
            .to_le_bytes()
        })
        .collect();
    folder.file("blob.raw", bytes);
    let words = "render blob.raw --raw 96x96x96,u16 --preset grey --window 1000,4000 --size 96x72";
    let ran = folder.run(&format!(
        "{words} --stream --device-memory 24M -o bricks.png"
    ));
    ran.assert_done();
    assert!(
        fit(&ran.err).0.ends_with("framed to what is visible"),
        "{ran:?}"
    );
    let [larger, off] = filled(&folder, "bricks.png");
    assert!(
        (0.84..0.97).contains(&larger) && off < 0.04,
        "{larger} {off}"
    );
}

#[test]
fn slabs_are_seen_face_on_the_earth_from_the_south_and_patients_are_never_turned() {
    let folder = Folder::new();
    opaque(&folder);
    nrrd(&folder, "slab.nrrd", [30, 30, 6], "", |_| 200);
    folder
        .run(&format!(
            "render slab.nrrd --tf tf.json --projection orthographic {SMALL} -o slab.png"
        ))
        .assert_done();
    // A square in the middle: its height fills the frame.
    let pixels = picture(&folder, "slab.png");
    let [left, top, right, bottom] = box_of(&pixels);
    assert!(
        ((right - left) - (bottom - top)).abs() <= 2.0,
        "{left} {top} {right} {bottom}"
    );
    assert!(
        (0.86..0.94).contains(&((bottom - top) / 72.0)),
        "{top} {bottom}"
    );
    // Slices of a patient are seen from the feet.
    nrrd(&folder, "axial.nrrd", [30, 30, 6], RAS, |_| 200);
    let ran = folder.run(&format!(
        "render axial.nrrd --tf tf.json {SMALL} -o axial.png"
    ));
    assert!(fit(&ran.err).1.starts_with("--view inferior "), "{ran:?}");

    let earth = format!(
        "{}/tests/fixtures/netcdf/wrf.nc --variable T",
        env!("CARGO_MANIFEST_DIR")
    );
    let ran = folder.run(&format!("render {earth} {SMALL} -o earth.png"));
    ran.assert_done();
    assert!(fit(&ran.err).1.starts_with("--target "), "{ran:?}");
    folder
        .run(&format!(
            "render {earth} --azimuth -60 --elevation 25 {SMALL} -o south.png"
        ))
        .assert_done();
    assert!(bytes(&folder, "earth.png") == bytes(&folder, "south.png"));

    // Without names of axes another side of this cube is taken.
    patterned(&folder, "patient.nrrd", RAS);
    let ran = folder.run(&format!(
        "render patient.nrrd --tf tf.json {SMALL} -o patient.png"
    ));
    ran.assert_done();
    assert!(fit(&ran.err).1.starts_with("--target "), "{ran:?}");
    folder
        .run(&format!(
            "render patient.nrrd --tf tf.json --azimuth 60 --elevation 15 {SMALL} -o usual.png"
        ))
        .assert_done();
    assert!(bytes(&folder, "patient.png") == bytes(&folder, "usual.png"));
}
