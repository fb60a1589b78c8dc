//! Several numbers a voxel, vectors, colours and label maps from words to pictures. Drawn by the CPU references on the CPU.

use crate::person::Folder;
use std::fs;

const SMALL: &str = "--size 24x16 --device reference";

/// A file of 8-bit voxels, 6 x 5 x 4 of them, of so many numbers each.
fn nrrd(kind: &str, components: usize, spacing: f64, voxel: impl Fn(usize) -> Vec<u8>) -> Vec<u8> {
    let (dimension, kinds, first) = match components {
        1 => (3, String::new(), String::new()),
        n => (
            4,
            format!("kinds: {kind} domain domain domain\n"),
            format!("{n} "),
        ),
    };
    let none = if components == 1 { "" } else { "none " };
    let header = format!(
        "NRRD0004\ntype: uchar\ndimension: {dimension}\nsizes: {first}6 5 4\n{kinds}encoding: raw\n\
         space: right-anterior-superior\nspace directions: {none}({spacing},0,0) (0,{spacing},0) (0,0,{spacing})\n\n"
    );
    let mut bytes = header.into_bytes();
    bytes.extend((0..6 * 5 * 4).flat_map(voxel));
    bytes
}

/// Linear premultiplied numbers, as `.npy` files hold them.
struct Picture {
    pixels: Vec<[f32; 4]>,
}

fn read_npy(bytes: &[u8]) -> Picture {
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (numbers, _) = bytes[start..].as_chunks::<4>();
    let numbers: Vec<f32> = numbers.iter().map(|b| f32::from_le_bytes(*b)).collect();
    let (pixels, _) = numbers.as_chunks::<4>();
    assert_eq!(pixels.len(), 24 * 16);
    Picture {
        pixels: pixels.to_vec(),
    }
}

/// What these words draw, and what is said meanwhile.
fn picture(folder: &Folder, words: &str) -> (Picture, String) {
    let ran = folder.run(&format!(
        "render --look plain {words} -o p.npy --force {SMALL}"
    ));
    ran.assert_done();
    let bytes = fs::read(folder.path("p.npy")).expect("a file");
    (read_npy(&bytes), ran.err)
}

fn drawn(picture: &Picture) -> usize {
    picture.pixels.iter().filter(|p| p[3] > 1e-4).count()
}

#[test]
fn channels_are_drawn_together_and_each_is_said() {
    let folder = Folder::new();
    let (all, said) = picture(&folder, "phantom:cells,n=16");
    assert!(drawn(&all) > 20, "{} pixels are drawn", drawn(&all));
    for word in ["channel 0 (nuclei)", "channel 2 (mitochondria)", "over"] {
        assert!(said.contains(word), "no {word:?}: {said}");
    }
    let (two, _) = picture(
        &folder,
        "phantom:cells,n=16 --channel 1,color=red,window=0:1 --channel 0,color=0:0:1,window=0:1",
    );
    assert!(two.pixels.iter().all(|p| p[1] == 0.0), "red and blue alone");
    assert!(two.pixels.iter().any(|p| p[0] > 0.01) && two.pixels.iter().any(|p| p[2] > 0.01));
    let (mip, _) = picture(&folder, "phantom:cells,n=16 --mode mip --channels 0,1");
    assert!(
        mip.pixels
            .iter()
            .flatten()
            .all(|&x| (0.0..=1.0).contains(&x))
    );
    let (one, _) = picture(&folder, "phantom:cells,n=16 --component 0");
    assert!(drawn(&one) > 5);
}

#[test]
fn a_volume_of_one_colour_is_drawn_in_it() {
    let folder = Folder::new();
    let color = [200, 100, 50];
    folder.file("rgb.nrrd", nrrd("RGB-color", 3, 1.0, |_| color.to_vec()));
    folder.file(
        "rgba.nrrd",
        nrrd("RGBA-color", 4, 1.0, |i| {
            vec![color[0], color[1], color[2], (i * 2) as u8]
        }),
    );
    for (name, said_wanted) in [("rgb.nrrd", "luma"), ("rgba.nrrd", "alpha")] {
        let (found, said) = picture(&folder, name);
        assert!(said.contains(said_wanted), "{said}");
        assert!(drawn(&found) > 50, "{name}");
        for pixel in found.pixels.iter().filter(|p| p[3] > 0.01) {
            for (c, &byte) in color.iter().enumerate() {
                let wanted = stratavox::color::decode_srgb(f64::from(byte) / 255.0);
                let straight = f64::from(pixel[c] / pixel[3]);
                assert!((straight - wanted).abs() < 1e-4, "{name}: {pixel:?}");
            }
        }
    }
    let (mip, said) = picture(&folder, "rgb.nrrd --mode mip");
    assert!(said.contains("one by one"), "{said}");
    let brightest = mip.pixels.iter().fold(0.0, |most: f32, p| most.max(p[0]));
    let wanted = stratavox::color::decode_srgb(200.0 / 255.0);
    assert!((f64::from(brightest) - wanted).abs() < 1e-4, "{brightest}");
}

#[test]
fn vectors_are_drawn_by_their_length_and_that_is_said() {
    let folder = Folder::new();
    // 3, 4, 12: of length 13.
    let vector = |i: usize| vec![3 * (i as u8 % 4), 4 * (i as u8 % 4), 12 * (i as u8 % 4)];
    folder.file("flow.nrrd", nrrd("vector", 3, 1.0, vector));
    let (by_default, said) = picture(&folder, "flow.nrrd --mode mip");
    assert!(said.contains("its length is taken"), "{said}");
    let (asked, _) = picture(&folder, "flow.nrrd --mode mip --component magnitude");
    assert_eq!(by_default.pixels, asked.pixels);
    let info = folder.run("info flow.nrrd --component magnitude --json");
    info.assert_done();
    assert!(info.out.contains("\"max\": 39.0"), "{info:#?}");
    let (one, said) = picture(&folder, "flow.nrrd --mode mip --component 2");
    assert!(drawn(&one) > 0 && !said.contains("length"), "{said}");
}

#[test]
fn labels_lie_over_a_volume_and_cut_it() {
    let folder = Folder::new();
    folder.file("v.nrrd", nrrd("", 1, 1.0, |i| vec![100 + (i % 60) as u8]));
    folder.file("l.nrrd", nrrd("", 1, 1.0, |i| vec![u8::from(i % 6 >= 3)]));
    folder.file("l.txt", "1 255 0 0 1 1 1 \"right half\"\n");
    folder.file(
        "mask.json",
        r#"{"stratavox_transfer_function":1,"mask":true,"labels":[[1,"right half",1,0,0,0.9]]}"#,
    );
    let (plain, _) = picture(&folder, "v.nrrd --preset grey");
    let (over, said) = picture(
        &folder,
        "v.nrrd --preset grey --labels l.nrrd --label-tf l.txt",
    );
    assert!(said.contains("1 labels are drawn: 1 right half"), "{said}");
    let reddest = |p: &Picture| p.pixels.iter().fold(0.0, |m: f32, p| m.max(p[0] - p[1]));
    assert!(reddest(&plain) < 1e-6 && reddest(&over) > 0.5);
    let (shown, _) = picture(
        &folder,
        "v.nrrd --preset grey --labels l.nrrd --label-show 1",
    );
    let (hidden, _) = picture(
        &folder,
        "v.nrrd --preset grey --labels l.nrrd --label-hide 0",
    );
    assert_eq!(shown.pixels, hidden.pixels, "the same labels are left");
    assert!(drawn(&shown) < drawn(&plain) && drawn(&shown) > 10);
    assert!(reddest(&shown) < 1e-6, "no label is drawn");
    let (none, _) = picture(&folder, "v.nrrd --labels l.nrrd --label-hide 0,1");
    assert_eq!(drawn(&none), 0);
    let (masked, _) = picture(
        &folder,
        "v.nrrd --preset grey --labels l.nrrd --label-tf mask.json",
    );
    assert_eq!(
        drawn(&masked),
        drawn(&shown),
        "what is not labelled is hidden"
    );
}

#[test]
fn labels_lie_over_sections_and_projections_and_cut_them() {
    let folder = Folder::new();
    folder.file("v.nrrd", nrrd("", 1, 1.0, |i| vec![100 + (i % 60) as u8]));
    folder.file("l.nrrd", nrrd("", 1, 1.0, |i| vec![u8::from(i % 6 >= 3)]));
    folder.file("l.txt", "1 255 0 0 1 1 1 \"right half\"\n");
    let red = |p: &Picture| p.pixels.iter().filter(|p| p[0] - p[1] > 0.05).count();
    for words in ["--section coronal", "--mode mip", "--mode iso --iso 90"] {
        let of = |more: &str| picture(&folder, &format!("v.nrrd {words} {more}")).0;
        let over = "--labels l.nrrd --label-tf l.txt";
        let [plain, half, whole, none] = [
            "",
            over,
            &format!("{over} --label-opacity 1"),
            &format!("{over} --label-opacity 0"),
        ]
        .map(of);
        assert_eq!(red(&plain), 0, "{words}");
        assert_eq!(none.pixels, plain.pixels, "{words}");
        assert!(red(&half) > 10 && red(&half) == red(&whole), "{words}");
        let pixels = |p: &Picture| p.pixels.as_flattened().to_vec();
        let ends = pixels(&plain).into_iter().zip(pixels(&whole));
        for ((plain, whole), half) in ends.zip(pixels(&half)) {
            assert!((half - 0.5 * (plain + whole)).abs() < 1e-5, "{words}");
        }
    }
    let of = |words: &str| picture(&folder, &format!("v.nrrd --mode mip {words}")).0;
    let [whole, left] = ["", "--labels l.nrrd --label-hide 1"].map(of);
    assert!(
        drawn(&left) > 10 && drawn(&left) < drawn(&whole),
        "half is hidden"
    );
    assert_eq!(red(&left), 0, "no label is drawn");
}

#[test]
fn labels_are_dimmed_by_words_and_by_their_file() {
    let folder = Folder::new();
    folder.file("v.nrrd", nrrd("", 1, 1.0, |i| vec![100 + (i % 60) as u8]));
    folder.file("l.nrrd", nrrd("", 1, 1.0, |i| vec![u8::from(i % 6 >= 3)]));
    folder.file(
        "dim.json",
        r#"{"stratavox_transfer_function":1,"dim":[1],"dim_share":0.1,"labels":[[1,"right half",1,0,0,0.9]]}"#,
    );
    let opacity = |p: &Picture| p.pixels.iter().map(|p| p[3]).sum::<f32>();
    let (plain, _) = picture(&folder, "v.nrrd --preset grey");
    let of = |words: &str| {
        let words = format!("v.nrrd --preset grey --labels l.nrrd {words}");
        picture(&folder, &words).0
    };
    let dimmed = of("--label-dim 1:0.1");
    let hidden = of("--label-hide 1");
    assert!(opacity(&dimmed) < opacity(&plain) && opacity(&dimmed) > opacity(&hidden));
    let by_default = [of("--label-dim 0-1"), of("--label-dim 0-1:0.2")];
    assert_eq!(by_default[0].pixels, by_default[1].pixels);
    // Nothing taken is nothing changed, but for how a mixture of one rounds.
    let whole = of("--label-dim 0-1:1");
    let pairs = whole
        .pixels
        .iter()
        .flatten()
        .zip(plain.pixels.iter().flatten());
    assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-5));
    // The same words by the file of the labels, whose colours are then drawn too.
    let [by_file, by_word] =
        ["", "--label-dim 1:0.1"].map(|words| of(&format!("--label-tf dim.json {words}")));
    assert!(drawn(&by_file) > 0);
    assert_eq!(by_file.pixels, by_word.pixels);
    // A volume of labels by itself.
    let alone = |words: &str| picture(&folder, &format!("l.nrrd --label-tf dim.json {words}")).0;
    let (faint, full) = (alone(""), alone("--label-dim 7"));
    assert!(opacity(&faint) < opacity(&full) && opacity(&faint) > 0.0);
    assert_eq!(drawn(&alone("--label-hide 1")), 0);
    folder
        .run("render --look plain v.nrrd --label-dim 7 --preset grey -o x.png --device reference")
        .assert_refused(2, &["--label-dim", "--labels FILE"]);
}

#[test]
fn a_label_map_on_another_grid_is_brought_over_and_one_elsewhere_is_refused() {
    let folder = Folder::new();
    folder.file("v.nrrd", nrrd("", 1, 1.0, |i| vec![100 + (i % 60) as u8]));
    folder.file("fine.nrrd", nrrd("", 1, 0.5, |_| vec![1]));
    let (_, said) = picture(&folder, "v.nrrd --labels fine.nrrd");
    assert!(
        said.contains("another grid") && said.contains("covers 1"),
        "{said}"
    );
    let far = String::from_utf8_lossy(&nrrd("", 1, 1.0, |_| vec![1]))
        .replace("(0,0,1)\n", "(0,0,1)\nspace origin: (500,0,0)\n");
    folder.file("far.nrrd", far);
    folder
        .run(&format!(
            "render --look plain v.nrrd -o a.png --labels far.nrrd {SMALL}"
        ))
        .assert_refused(3, &["far.nrrd", "do not overlap"]);
    assert!(!folder.path("a.png").exists());
}

#[test]
fn a_label_map_by_itself_takes_its_colours_from_a_table() {
    let folder = Folder::new();
    folder.file("l.nrrd", nrrd("", 1, 1.0, |i| vec![(i % 5) as u8]));
    folder.file("l.ctbl", "# a table\n1 one 0 255 0 255\n");
    let (found, _) = picture(&folder, "l.nrrd --label-tf l.ctbl");
    assert!(drawn(&found) > 20);
    assert!(
        found.pixels.iter().all(|p| p[0] == 0.0 && p[2] == 0.0),
        "green"
    );
}

#[test]
fn a_scene_keeps_channels_and_labels() {
    let folder = Folder::new();
    folder.file("v.nrrd", nrrd("", 1, 1.0, |i| vec![100 + (i % 60) as u8]));
    folder.file("l.nrrd", nrrd("", 1, 1.0, |i| vec![(i % 3) as u8]));
    for words in [
        "v.nrrd --labels l.nrrd --label-hide 2",
        "v.nrrd --labels l.nrrd --mode mip",
        "v.nrrd --labels l.nrrd --section coronal --label-opacity 0.3",
        "phantom:cells,n=12 --channel 2,color=orange --channel 0,window=0:0.5",
        "phantom:cells,n=12 --component all",
    ] {
        folder
            .run(&format!(
                "render --look plain {words} -o a.npy --force --save-scene s.json {SMALL}"
            ))
            .assert_done();
        folder
            .run(&format!("render --scene s.json -o b.npy --force {SMALL}"))
            .assert_done();
        let [a, b] = ["a.npy", "b.npy"].map(|name| fs::read(folder.path(name)).expect("a file"));
        assert!(a == b, "{words}");
        fs::remove_file(folder.path("s.json")).expect("a file");
    }
}

#[test]
fn words_that_do_not_go_together_are_refused_by_name() {
    let folder = Folder::new();
    folder.file("v.nrrd", nrrd("", 1, 1.0, |i| vec![i as u8]));
    folder.file("list.nrrd", nrrd("list", 5, 1.0, |i| vec![i as u8; 5]));
    folder.file("rgb.nrrd", nrrd("RGB-color", 3, 1.0, |i| vec![i as u8; 3]));
    folder.file("bad.txt", "1 2 3\n");
    for (words, code, said) in [
        ("list.nrrd", 2, &["--component all"][..]),
        ("list.nrrd --component all", 2, &["at most 4"]),
        ("list.nrrd --channels 0,9", 2, &["channel 9"]),
        ("list.nrrd --channels 1,1", 2, &["twice"]),
        ("list.nrrd --channel 0 --channels 1", 2, &["--channel"]),
        (
            "list.nrrd --channels 1,2 --component 1",
            2,
            &["--component"],
        ),
        ("list.nrrd --channels 1,2 --preset mri", 2, &["--preset"]),
        (
            "list.nrrd --channels 1,2 --mode xray",
            2,
            &["xray", "window"],
        ),
        ("list.nrrd --channel 0,color=puce", 2, &["puce"]),
        (
            "list.nrrd --channels 0,1 --mode mip --aov value",
            2,
            &["--aov value"],
        ),
        ("rgb.nrrd --preset mri", 2, &["--preset"]),
        ("rgb.nrrd --labels v.nrrd", 2, &["--labels"]),
        (
            "v.nrrd --labels v.nrrd --label-dim 1 --mode mip",
            2,
            &["--label-dim", "composite", "--label-hide"],
        ),
        (
            "v.nrrd --labels v.nrrd --filter cubic",
            2,
            &["--filter cubic", "--filter linear"],
        ),
        (
            "list.nrrd --channels 1,2 --filter catmull-rom",
            2,
            &["--filter catmull-rom", "--filter linear"],
        ),
        (
            "rgb.nrrd --filter quadratic-smooth",
            2,
            &["--filter quadratic-smooth", "--filter linear"],
        ),
        ("v.nrrd --label-show 1", 2, &["--labels"]),
        ("v.nrrd --labels v.nrrd --label-show 1-", 2, &["1,2,5-9"]),
        ("v.nrrd --labels rgb.nrrd", 3, &["one number a voxel"]),
        ("v.nrrd --labels v.nrrd --label-tf bad.txt", 3, &["line 1"]),
        ("v.nrrd --labels none.nrrd", 3, &["none.nrrd"]),
    ] {
        let words = format!("render --look plain {words} -o a.npy {SMALL}");
        folder.run(&words).assert_refused(code, said);
        assert!(!folder.path("a.npy").exists(), "{words}");
    }
}
