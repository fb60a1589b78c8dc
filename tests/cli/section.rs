//! Cuts through a volume: the very voxels, where radiologists look for them. Drawn by the CPU references and by a device.

use crate::person::Folder;
use std::fs;

const SIDE: usize = 5;

/// A number that tells every voxel from its neighbours on all sides.
fn value([x, y, z]: [usize; 3]) -> f32 {
    (x + 10 * y + 100 * z) as f32
}

/// 5 x 5 x 5 voxels of size 1, world from 0 to 5.
fn volume(folder: &Folder) {
    let mut bytes =
        b"NRRD0004\ntype: float\ndimension: 3\nsizes: 5 5 5\nendian: little\nencoding: raw\n\
        space: RAS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0.5,0.5,0.5)\n\n"
            .to_vec();
    for z in 0..SIDE {
        for y in 0..SIDE {
            for x in 0..SIDE {
                bytes.extend(value([x, y, z]).to_le_bytes());
            }
        }
    }
    fs::write(folder.path("v.nrrd"), bytes).expect("a file");
}

/// The layer `value` of a picture of 5 x 5 pixels, one a voxel.
fn values(folder: &Folder, words: &str) -> Vec<f32> {
    let fixed = "-o a.npy --aov value --size 5x5 --force";
    folder
        .run(&format!("render v.nrrd {fixed} {words}"))
        .assert_done();
    let bytes = fs::read(folder.path("a.value.npy")).expect("a layer");
    let numbers = &bytes[bytes.len() - 4 * SIDE * SIDE..];
    let number = |b: &[u8]| f32::from_le_bytes(b.try_into().expect("four bytes"));
    numbers.chunks(4).map(number).collect()
}

/// What is seen at column x, row y (down) of each cut.
fn seen(section: &str, [x, y]: [usize; 2], depth: usize) -> [usize; 3] {
    let (across, up) = (SIDE - 1 - x, SIDE - 1 - y);
    match section {
        // From below, anterior up: the patient's right, +x, on the left.
        "axial" => [across, up, depth],
        // From anterior, superior up.
        "coronal" => [across, depth, up],
        // From the left, superior up: anterior, +y, on the left.
        _ => [depth, across, up],
    }
}

fn compare(section: &str, words: &str, depth: usize) {
    let folder = Folder::new();
    volume(&folder);
    let found = values(&folder, &format!("--section {section} {words}"));
    for (i, found) in found.into_iter().enumerate() {
        let wanted = value(seen(section, [i % SIDE, i / SIDE], depth));
        // The eye is 9 away and numbers go to 444: f32 places the sample to 1e-6 of a voxel, of 111 a voxel.
        let off = (found - wanted).abs();
        assert!(off < 2e-4, "{section} {words}: {found}, not {wanted}");
    }
}

#[test]
fn a_cut_shows_the_voxels_that_lie_in_it() {
    for (section, beside) in [
        ("axial", "2.5,2.5,3.5"),
        ("coronal", "2.5,3.5,2.5"),
        ("sagittal", "3.5,2.5,2.5"),
    ] {
        compare(section, "--device reference", 2);
        compare(section, &format!("--target {beside} --device reference"), 3);
    }
    compare("axial", "", 2);
}

#[test]
fn a_thick_cut_shows_what_its_mode_makes_of_it() {
    for section in ["axial", "coronal", "sagittal"] {
        let thick = |mode: &str| format!("--thickness 3 --mode {mode} --device reference");
        compare(section, &thick("mip"), 3);
        compare(section, &thick("average"), 2);
        compare(section, &thick("minip"), 1);
    }
}

#[test]
fn a_cut_is_kept_in_a_scene_and_gives_way_to_a_view() {
    let folder = Folder::new();
    let small = "--size 12x9 --device reference --force";
    let saved =
        format!("render phantom:head,n=16 -o a.npy --section coronal --save-scene s.json {small}");
    folder.run(&saved).assert_done();
    let again = |out: &str, words: &str| {
        let words = format!("render --scene s.json -o {out} {small} {words}");
        folder.run(&words).assert_done();
        fs::read(folder.path(out)).expect("a picture")
    };
    let first = fs::read(folder.path("a.npy")).expect("a picture");
    assert!(again("b.npy", "") == first, "another picture");
    assert!(
        again("c.npy", "--section axial") != first,
        "the same picture"
    );
    assert!(again("d.npy", "--view left") != first, "the same picture");
}

#[test]
fn what_a_cut_cannot_be_is_refused() {
    let folder = Folder::new();
    for (words, wanted) in [
        ("--section flat", "axial, coronal, sagittal"),
        ("--section 0,0,0", "needs a direction"),
        ("--section axial --view left", "cannot be used with"),
        (
            "--section axial --technique slices-3d",
            "--section takes its samples on the cut",
        ),
        ("--thickness 3", "--section"),
    ] {
        let words = format!("render phantom:fog,n=8 -o a.png {words}");
        folder.run(&words).assert_refused(2, &[wanted]);
    }
}

/// Numbers of a picture of 32 x 32 pixels by the CPU references.
fn cut(folder: &Folder, words: &str) -> Vec<u8> {
    let fixed = "-o b.npy --size 32x32 --force --device reference --preset grey";
    folder
        .run(&format!("render v.nrrd {fixed} {words}"))
        .assert_done();
    fs::read(folder.path("b.npy")).expect("a picture")
}

#[test]
fn a_clip_box_is_six_clip_planes_and_its_faces_are_seen() {
    let folder = Folder::new();
    volume(&folder);
    let by_box = cut(&folder, "--clip-box 2,2.5,3,2,3,4");
    let planes = "--clip 1,0,0,1 --clip -1,0,0,-3 --clip 0,1,0,1 --clip 0,-1,0,-4 --clip 0,0,1,1 --clip 0,0,-1,-5";
    assert!(by_box == cut(&folder, planes), "the same six planes");
    let turned = cut(&folder, "--clip-box 2,2.5,3,2,3,4,0,0,30");
    assert!(by_box != turned && turned != cut(&folder, "--clip-box 2,2.5,3,2,3,4,0,0,-30"));
    // By a quarter the sides change places.
    let quarter = cut(
        &folder,
        "--clip-box 2,2.5,3,3,2,4,0,0,90 --color-space display",
    );
    assert_eq!(quarter.len(), by_box.len());
    let faced = cut(&folder, "--clip-box 2,2.5,3,2,3,4 --cut-faces");
    assert!(
        faced != by_box && faced != cut(&folder, "--clip-box 2,2.5,3,2,3,4 --cut-faces=50,300")
    );
    let many = |count| "--clip-box 2,2,2,1,1,1".to_owned() + &" --clip 1,0,0,1".repeat(count);
    for (words, wanted) in [
        ("--clip-box 2,2,2,1,0,1", "sizes over 0"),
        (
            "--clip-box 2,2,2,1,1,1 --clip-box 2,2,2,1,1,1",
            "multiple times",
        ),
        (
            "--cut-faces --crop 1,4,1,4,1,4 --technique slices-2d",
            "opaque cut face",
        ),
        ("--cut-faces=9,9 --crop 1,4,1,4,1,4", "LO under HI"),
        (
            "--cut-faces --mode mip --crop 1,4,1,4,1,4",
            "opaque cut face",
        ),
    ] {
        folder
            .run(&format!(
                "render v.nrrd -o c.png --device reference {words}"
            ))
            .assert_refused(2, &[wanted]);
    }
    for (words, wanted) in [
        (many(507), "at most 512"),
        (many(505) + " --section axial", "--section cuts with two"),
    ] {
        folder
            .run(&format!(
                "render v.nrrd -o c.png --device reference {words}"
            ))
            .assert_refused(6, &[wanted]);
    }
    let idle = folder.run("render v.nrrd -o c.png --size 8x8 --device reference --cut-faces");
    idle.assert_done();
    assert!(
        idle.err.contains("--cut-faces has no effect"),
        "{}",
        idle.err
    );
}
