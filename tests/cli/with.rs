//! Several volumes in one picture, each on a grid of its own. Drawn by the CPU references on the CPU.

use crate::person::Folder;
use std::fs;

const SMALL: &str = "--size 24x16 --device reference --force";

/// Voxels of 8 bits in a cube of 12 world lengths around zero, `side` along each axis: a ball of this radius.
fn ball(side: usize, radius: f64) -> Vec<u8> {
    let spacing = 12.0 / side as f64;
    let first = 0.5 * spacing - 6.0;
    let header = format!(
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: {side} {side} {side}\nencoding: raw\n\
         space: right-anterior-superior\nspace origin: ({first},{first},{first})\n\
         space directions: ({spacing},0,0) (0,{spacing},0) (0,0,{spacing})\n\n"
    );
    let mut bytes = header.into_bytes();
    let at = |i: usize| first + spacing * i as f64;
    let voxel = |n: usize| {
        let [x, y, z] = [at(n % side), at(n / side % side), at(n / side / side)];
        if (x * x + y * y + z * z).sqrt() < radius {
            200
        } else {
            0
        }
    };
    bytes.extend((0..side.pow(3)).map(voxel));
    bytes
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.file("outer.nrrd", ball(16, 5.0));
    folder.file("inner.nrrd", ball(10, 2.5));
    folder
}

fn pixels(folder: &Folder, words: &str) -> (Vec<[f32; 4]>, String) {
    let ran = folder.run(&format!("render {words} -o p.npy {SMALL}"));
    ran.assert_done();
    let bytes = fs::read(folder.path("p.npy")).expect("a file");
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (numbers, _) = bytes[start..].as_chunks::<4>();
    let numbers: Vec<f32> = numbers.iter().map(|b| f32::from_le_bytes(*b)).collect();
    (numbers.as_chunks::<4>().0.to_vec(), ran.err)
}

/// Pixels that are more red than green.
fn red(pixels: &[[f32; 4]]) -> usize {
    pixels.iter().filter(|p| p[0] > p[1] + 0.05).count()
}

const BOTH: &str = "outer.nrrd --with inner.nrrd,color=red,window=0:100 --projection orthographic";

#[test]
fn another_volume_is_seen_inside_the_first_which_is_faint() {
    let folder = folder();
    // The inner ball is five voxels across: two samples in each say where it ends.
    let (both, said) = pixels(&folder, &format!("{BOTH} --samples-per-voxel 2"));
    let inside = red(&both);
    // Of 24 x 16 pixels the picture fits the outer ball in 16 rows: the inner one has a quarter of its area.
    assert!((20..100).contains(&inside), "{inside} pixels are red");
    for words in ["with inner.nrrd, from", "the volume is drawn faint"] {
        assert!(said.contains(words), "no {words:?}: {said}");
    }
    let (alone, _) = pixels(&folder, "outer.nrrd --projection orthographic");
    assert_eq!(red(&alone), 0);
    let (moved, said) = pixels(
        &folder,
        "outer.nrrd --with inner.nrrd,color=red,window=0:100,shift=9:0:0 --projection orthographic",
    );
    assert!(red(&moved) < inside / 2, "{} pixels are red", red(&moved));
    assert!(said.contains("the rest is not seen"), "{said}");
}

/// What a registration found, in LPS+, from INPUT to the volume that moves: a translation, and a quarter turn about a point.
/// A quarter turn leaves the voxels of a ball where they are, so both are moves.
#[test]
fn a_registration_moves_a_volume_as_a_shift_does() {
    let folder = folder();
    let transform = |name: &str, words: &str| {
        let text = format!("#Insight Transform File V1.0\n#Transform 0\nTransform: {words}\n");
        folder.file(name, text.into_bytes());
    };
    transform(
        "move.tfm",
        "TranslationTransform_double_3_3\nParameters: 1 -2 -1\nFixedParameters:",
    );
    // A (x - c) + c is the ball's middle at x = c - A^-1 c = (2, 2, 0).
    transform(
        "turn.tfm",
        "AffineTransform_double_3_3\nParameters: 0 -1 0 1 0 0 0 0 1 0 0 0\nFixedParameters: 2 0 0",
    );
    let picture = |words: &str| {
        let words = format!(
            "outer.nrrd --with inner.nrrd,color=red,window=0:100,{words} --projection orthographic"
        );
        pixels(&folder, &words).0
    };
    for (registered, shifted) in [
        ("transform=move.tfm", "shift=1:-2:1"),
        ("transform=turn.tfm", "shift=-2:-2:0"),
        ("shift=1:0:0,transform=turn.tfm", "shift=-1:-2:0"),
    ] {
        let [found, wanted] = [registered, shifted].map(picture);
        let off = found.iter().flatten().zip(wanted.iter().flatten());
        let off = off.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        // Places in voxels are products of other matrices, in single precision.
        assert!(off < 1e-4, "{registered}: {off}");
    }
    assert!(picture("shift=-2:-2:0") != picture("shift=0:0:0"));
    let words = "outer.nrrd --with inner.nrrd,color=red,window=0:100,transform=turn.tfm";
    let (wanted, _) = pixels(&folder, &format!("{words} --save-scene turned.json"));
    fs::remove_file(folder.path("turn.tfm")).expect("the file");
    assert!(pixels(&folder, "--scene turned.json").0 == wanted);
    // A scene may say anything.
    let scene = fs::read_to_string(folder.path("turned.json")).expect("a scene");
    let mut scene: serde_json::Value = serde_json::from_str(&scene).expect("JSON");
    let rows = &mut scene["with"]["with"][0]["transform"];
    assert!(rows.is_array(), "{rows}");
    rows[2] = serde_json::json!([0, 0, 0, 0]);
    folder.file("flat.json", scene.to_string().into_bytes());
    let ran = folder.run(&format!("render --scene flat.json -o p.npy {SMALL}"));
    ran.assert_refused(2, &["inner.nrrd", "no inverse"]);
}

#[test]
fn maxima_of_volumes_are_added_and_none_is_cut() {
    let folder = folder();
    let (mip, said) = pixels(
        &folder,
        "outer.nrrd --mode mip --with inner.nrrd,color=red,shift=7:0:0 --projection orthographic",
    );
    assert!(red(&mip) > 4, "{} pixels are red", red(&mip));
    assert!(!said.contains("is not seen"), "{said}");
}

#[test]
fn a_saved_scene_draws_the_same_picture() {
    let folder = folder();
    for (name, words) in [
        ("auto", BOTH.to_owned()),
        (
            "preset",
            "outer.nrrd --with inner.nrrd,preset=pet,window=0:300".to_owned(),
        ),
        (
            "map",
            "outer.nrrd --mode average --with inner.nrrd,colormap=viridis".to_owned(),
        ),
    ] {
        let (wanted, _) = pixels(&folder, &format!("{words} --save-scene {name}.json"));
        let (found, _) = pixels(&folder, &format!("--scene {name}.json"));
        assert!(wanted == found, "{name}");
    }
}

/// Of one volume under two names, the picture with a legend is another one.
#[test]
fn the_legend_names_the_volumes() {
    let folder = folder();
    folder.file("pet.nrrd", ball(10, 2.5));
    let picture = |name: &str, words: &str| {
        let words = format!("outer.nrrd --with {name},color=red --size 96x64 {words}");
        let ran = folder.run(&format!(
            "render {words} -o p.png --device reference --force"
        ));
        ran.assert_done();
        fs::read(folder.path("p.png")).expect("a file")
    };
    let [plain, marked] = ["", "--annotate bar"]
        .map(|words| picture("inner.nrrd", words) == picture("pet.nrrd", words));
    assert!(plain && !marked, "{plain} {marked}");
}

#[test]
fn a_film_turns_around_both() {
    let folder = folder();
    let ran = folder.run(&format!(
        "animate {BOTH} --turntable 2 -o f%02d.png {SMALL}"
    ));
    ran.assert_done();
    let [first, second] =
        ["f00.png", "f01.png"].map(|name| fs::read(folder.path(name)).expect("a frame"));
    assert!(!first.is_empty() && !second.is_empty());
}

#[test]
fn what_cannot_be_joined_is_refused_with_a_reason() {
    let folder = folder();
    for (words, wanted) in [
        (
            "outer.nrrd --with inner.nrrd,shift=99:0:0",
            "lies beside the volume",
        ),
        (
            "outer.nrrd --with inner.nrrd --mode iso",
            "--mode iso draws one",
        ),
        (
            "outer.nrrd --with inner.nrrd --technique slices-2d",
            "slices-2d",
        ),
        (
            "outer.nrrd --with inner.nrrd --with inner.nrrd --with inner.nrrd --with inner.nrrd",
            "at most 4",
        ),
        (
            "outer.nrrd --with inner.nrrd,transform=inner.nrrd",
            "wanted a transform of ITK",
        ),
        (
            "outer.nrrd --with inner.nrrd,transform=none.tfm",
            "none.tfm",
        ),
        (
            "outer.nrrd --with inner.nrrd,component=1",
            "--with inner.nrrd,component=",
        ),
        ("outer.nrrd --with nothing.nrrd", "nothing.nrrd"),
        (
            "outer.nrrd --with inner.nrrd --preclassified",
            "--with lies beside it",
        ),
        ("outer.nrrd --with inner.nrrd --mode xray", "window of each"),
        (
            "outer.nrrd --with inner.nrrd --preset boundaries",
            "gradient",
        ),
    ] {
        let ran = folder.run(&format!("render {words} -o p.npy {SMALL}"));
        assert_ne!(ran.code, 0, "{words}");
        assert!(
            ran.err.contains(wanted),
            "{words}: no {wanted:?}: {}",
            ran.err
        );
        assert!(!folder.path("p.npy").exists(), "{words}");
    }
}
