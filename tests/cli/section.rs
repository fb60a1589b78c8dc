//! Cuts through a volume: the very voxels, where radiologists look for them. Drawn by the CPU references and by a device.

use crate::person::Folder;
use std::fs;

pub const SIDE: usize = 5;

/// A number that tells every voxel from its neighbours on all sides.
pub fn value([x, y, z]: [usize; 3]) -> f32 {
    (x + 10 * y + 100 * z) as f32
}

/// 5 x 5 x 5 voxels of size 1, world from 0 to 5.
pub fn volume(folder: &Folder) {
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
pub fn values(folder: &Folder, words: &str) -> Vec<f32> {
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
pub fn seen(section: &str, [x, y]: [usize; 2], depth: usize) -> [usize; 3] {
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
        (
            "--section axial --technique splat",
            "--section takes its samples on the cut",
        ),
        ("--section axial --mode iso", "--thickness"),
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

/// The numbers of a picture.
pub fn picture(folder: &Folder, words: &str, [width, height]: [usize; 2]) -> Vec<[f32; 4]> {
    let fixed = format!("-o a.npy --size {width}x{height} --force");
    let ran = folder.run(&format!("render v.nrrd {fixed} {words}"));
    ran.assert_done();
    assert!(!ran.err.contains("no effect"), "{}", ran.err);
    let bytes = fs::read(folder.path("a.npy")).expect("a picture");
    let numbers = &bytes[bytes.len() - 16 * width * height..];
    let number = |b: &[u8]| f32::from_le_bytes(b.try_into().expect("four bytes"));
    let pixel = |b: &[u8]| [0, 4, 8, 12].map(|i| number(&b[i..i + 4]));
    numbers.chunks(16).map(pixel).collect()
}

#[test]
fn planes_of_a_stack_lie_evenly_from_the_eye_on() {
    let folder = Folder::new();
    volume(&folder);
    for section in ["axial", "coronal", "sagittal"] {
        for nth in 1..=SIDE {
            // Seen from below, from anterior and from the left.
            let depth = match section {
                "axial" => nth - 1,
                "coronal" => SIDE - nth,
                _ => nth - 1,
            };
            // A target moves the plane sideways alone.
            for words in ["", "--target 2.5,2.5,2.5"] {
                let found = values(
                    &folder,
                    &format!("--section {section}:{nth}/{SIDE} {words}"),
                );
                for (i, found) in found.into_iter().enumerate() {
                    let wanted = value(seen(section, [i % SIDE, i / SIDE], depth));
                    assert!((found - wanted).abs() < 1e-3, "{section} {nth}, pixel {i}");
                }
            }
        }
    }
    let (window, size) = ("--window 0,444 --background 0,0,1", [116, 16]);
    let all = picture(&folder, &format!("--section axial:5 {window}"), size);
    let words = (1..=5)
        .map(|nth| format!("axial:{nth}/5"))
        .collect::<Vec<_>>();
    let one_by_one = picture(
        &folder,
        &format!("--section {} {window}", words.join(",")),
        size,
    );
    assert_eq!(all, one_by_one);
    assert!(all.iter().any(|pixel| pixel[0] > 0.5) && all[0] != all[100]);
}

#[test]
fn several_planes_are_those_of_single_pictures_at_one_scale() {
    let folder = Folder::new();
    volume(&folder);
    let planes = ["axial", "coronal", "sagittal"];
    let window = "--window 0,444 --background 0,0,1";
    // In a row, in a column, and two by two where that is largest.
    for ([width, height], corners) in [
        ([56, 16], [[0, 0], [20, 0], [40, 0]]),
        ([16, 60], [[0, 0], [0, 21], [0, 42]]),
        ([44, 44], [[0, 0], [24, 0], [0, 24]]),
    ] {
        let all = picture(
            &folder,
            &format!("--section {} {window}", planes.join(",")),
            [width, height],
        );
        let panel = if width == 16 {
            [16, 17]
        } else {
            [height.min(20), height.min(20)]
        };
        // The box is 5 across.
        let view_height = 5.0 * panel[1] as f64 / panel[0] as f64;
        let mut inside = vec![false; width * height];
        for (plane, [left, top]) in planes.iter().zip(corners) {
            let words = format!("--section {plane} --view-height {view_height} {window}");
            let alone = picture(&folder, &words, panel);
            for (i, wanted) in alone.iter().enumerate() {
                let at = (top + i / panel[0]) * width + left + i % panel[0];
                inside[at] = true;
                assert_eq!(&all[at], wanted, "{plane} of {width} x {height}, pixel {i}");
            }
        }
        let outside = all.iter().zip(&inside).filter(|(_, inside)| !**inside);
        for (pixel, _) in outside {
            assert_eq!(pixel, &[0.0, 0.0, 1.0, 1.0], "between the planes");
        }
    }
    // Layers lie as the pictures do, with nothing between.
    let layer = |words: &str, extent: [usize; 2]| {
        picture(
            &folder,
            &format!("{words} {window} --annotate orientation"),
            extent,
        );
        let bytes = fs::read(folder.path("a.annotation.npy")).expect("a layer");
        let numbers = bytes[bytes.len() - 16 * extent[0] * extent[1]..].chunks(16);
        numbers.map(<[u8]>::to_vec).collect::<Vec<_>>()
    };
    let all = layer("--section axial,sagittal", [204, 100]);
    for (plane, left) in [("axial", 0), ("sagittal", 104)] {
        let alone = layer(&format!("--section {plane} --view-height 5"), [100, 100]);
        assert!(alone.iter().any(|pixel| *pixel != alone[0]), "{plane}");
        for (i, wanted) in alone.iter().enumerate() {
            let at = i / 100 * 204 + left + i % 100;
            assert_eq!(&all[at], wanted, "{plane}, pixel {i}");
        }
    }
    // A scene file says them, and draws the same.
    let words = format!("--section axial,coronal,sagittal {window}");
    let first = picture(&folder, &format!("{words} --save-scene s.json"), [56, 16]);
    assert_eq!(picture(&folder, "--scene s.json", [56, 16]), first);
    for (command, words, text) in [
        (
            "render",
            "--section axial,coronal --aov value -o b.npy",
            "--aov is of one view",
        ),
        (
            "render",
            "--section axial,coronal --size 17x17 -o b.png",
            "no room",
        ),
        (
            "render",
            "--section axial,flat -o b.png",
            "wanted axial, coronal, sagittal",
        ),
        ("render", "--section axial:0 -o b.png", "wanted axial"),
        ("render", "--section axial:4/3 -o b.png", "wanted axial"),
        (
            "render",
            "--section axial:40,coronal:40 -o b.png",
            "at most 64 planes, found 80",
        ),
        ("animate", "--section axial:3 -o b.gif", "several planes"),
        (
            "animate",
            "--section axial,coronal -o b.gif",
            "several planes",
        ),
    ] {
        folder
            .run(&format!("{command} v.nrrd {words}"))
            .assert_refused(2, &[text]);
    }
}
