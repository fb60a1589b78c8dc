//! `stratavox sheet`: many volumes in one picture.

use super::person::{Folder, assert_begins};
use crate::thumbnails::nrrd;
use std::fs;

/// Codes of the small picture of the first place.
fn first_tile(folder: &Folder, input: &str) -> Vec<[u8; 3]> {
    let words = format!("sheet {input} --tile 32x24 -o s.png --device reference --force");
    folder.run(&words).assert_done();
    let picture = image::open(folder.path("s.png"))
        .expect("a picture")
        .to_rgb8();
    let at = |i: u32| picture.get_pixel(6 + i % 32, 6 + i / 32).0;
    (0..32 * 24).map(at).collect()
}

#[test]
fn channels_are_drawn_together_as_render_draws_them() {
    let folder = Folder::new();
    let all = first_tile(&folder, "phantom:cells,n=12");
    let one = first_tile(&folder, "phantom:cells,n=12,component=0");
    assert!(all != one, "one channel is drawn");
    // Blue, green and orange: no grey picture of one channel has all three.
    for c in 0..3 {
        let others = [(c + 1) % 3, (c + 2) % 3];
        let is_of = |p: &&[u8; 3]| p[c] > 40 && others.iter().any(|&o| p[c] > p[o] + 12);
        assert!(
            all.iter().filter(is_of).count() > 2,
            "no pixel leans to {c}"
        );
    }
}

#[test]
fn a_sheet_has_a_place_for_each_input_and_says_which_could_not_be_drawn() {
    let folder = Folder::new();
    let words = "sheet phantom:fog,n=8 phantom:storm,n=8,variable=cloud phantom:sphere,n=8 --columns 2 --tile 32x24 -o a.png";
    let ran = folder.run(words);
    ran.assert_done();
    let wanted =
        "1 1 phantom:fog,n=8\n1 2 phantom:storm,n=8,variable=cloud\n2 1 phantom:sphere,n=8\n";
    assert_eq!(ran.out, wanted);
    let picture = image::open(folder.path("a.png"))
        .expect("a picture")
        .to_rgba8();
    assert_eq!(picture.dimensions(), (82, 102));
    // What is seen fills each small picture; the place without one keeps the background.
    let background = picture.get_pixel(0, 0);
    let differs = |left: u32, top: u32| {
        let inside = |i: u32| (left + i % 32, top + i / 32);
        (0..32 * 24).any(|i| picture.get_pixel(inside(i).0, inside(i).1) != background)
    };
    assert!(differs(6, 6) && differs(44, 6) && differs(6, 54) && !differs(44, 54));

    let ran = folder.run("sheet phantom:fog,n=8 missing.nrrd -o b.png --tile 16x16");
    ran.assert_refused(3, &["missing.nrrd is left out"]);
    assert_eq!(ran.out, "1 1 phantom:fog,n=8\n");
    assert_begins(&folder.path("b.png"), b"\x89PNG");
    let ran = folder.run("sheet phantom:fog,n=8 -o a.png");
    ran.assert_refused(4, &["a.png", "--force"]);
}

#[test]
fn a_sheet_that_is_not_named_as_a_png_is_refused_before_anything_is_read() {
    let folder = Folder::new();
    for (name, problem) in [
        ("x.jpg", "the ending says no kind of picture"),
        ("x.exr", "a sheet is a PNG"),
    ] {
        let ran = folder.run(&format!("sheet missing.nrrd -o {name}"));
        ran.assert_refused(2, &[&format!("-o {name}: {problem}"), ".png"]);
        assert!(!ran.err.contains("missing.nrrd"), "{ran:?}");
    }
    assert!(folder.names().is_empty());
}

#[test]
fn a_sheet_of_nothing_is_not_written() {
    let folder = Folder::new();
    let ran = folder.run("sheet missing.nrrd gone.nrrd -o s.png --tile 16x12");
    ran.assert_refused(3, &["missing.nrrd is left out", "gone.nrrd is left out"]);
    assert_eq!(ran.out, "");
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

#[test]
fn each_note_names_its_volume() {
    let folder = Folder::new();
    let words = "sheet phantom:fog,n=8 phantom:storm,n=8 -o s.png --tile 16x12 --device reference";
    let ran = folder.run(words);
    ran.assert_done();
    let notes = ran.err.lines();
    let mut notes = notes.filter(|note| note.contains("is taken") || note.contains("is drawn"));
    let first = notes.next().expect("a note on the times or variables");
    assert!(first.contains("phantom:storm,n=8: "), "{ran:?}");
    assert!(
        notes.all(|note| note.contains("phantom:storm,n=8: ")),
        "{ran:?}"
    );
}

#[test]
fn a_folder_is_the_volumes_in_it_in_the_order_of_their_names() {
    let folder = Folder::new();
    fs::create_dir_all(folder.path("scans/deep")).expect("folders");
    for (seed, name) in ["b.nrrd", "a.nrrd", "deep/c.nrrd"].into_iter().enumerate() {
        folder.file(&format!("scans/{name}"), nrrd(4, seed));
    }
    folder.file("scans/README.txt", "no volume");
    let words = "sheet scans phantom:fog,n=8 scans/a.nrrd --tile 16x12 --device reference";
    let ran = folder.run(&format!("{words} -o a.png"));
    ran.assert_done();
    assert_eq!(
        ran.out,
        "1 1 scans/a.nrrd\n1 2 scans/b.nrrd\n2 1 phantom:fog,n=8\n"
    );
    assert!(ran.err.contains("no volume are left alone"), "{ran:?}");
    let ran = folder.run(&format!("{words} --recursive --columns 9 -o b.png"));
    ran.assert_done();
    let row = "1 1 scans/a.nrrd\n1 2 scans/b.nrrd\n1 3 scans/deep/c.nrrd\n1 4 phantom:fog,n=8\n";
    assert_eq!(ran.out, row);
    fs::create_dir(folder.path("empty")).expect("a folder");
    let ran = folder.run("sheet empty -o c.png --tile 16x12");
    ran.assert_refused(3, &["empty", "no volume"]);
}

#[test]
fn look_and_keep_all_are_those_of_render() {
    let folder = Folder::new();
    crate::left_out::with_plate(&folder, "plate.mha");
    let tile = |words: &str| first_tile(&folder, &format!("plate.mha {words}"));
    let rendered = |words: &str| {
        let fixed = "--size 32x24 -o r.png --device reference --force";
        folder
            .run(&format!("render plate.mha {words} {fixed}"))
            .assert_done();
        let picture = image::open(folder.path("r.png")).expect("a picture");
        picture.to_rgb8().pixels().map(|p| p.0).collect::<Vec<_>>()
    };
    let tiles = ["", "--keep-all", "--look plain"].map(tile);
    assert!(tiles[0] != tiles[1] && tiles[0] != tiles[2] && tiles[1] != tiles[2]);
    let words = ["", "--keep-all", "--look plain --background #18181c"];
    for (tile, words) in tiles.iter().zip(words) {
        assert!(
            *tile == rendered(words),
            "{words}: not the picture of render"
        );
    }
}
