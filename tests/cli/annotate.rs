//! Words and marks over pictures: where they are kept, what they leave alone, and what they say.

use crate::person::Folder;
use std::fs;

const HEAD: &str = "phantom:head,n=24 --device reference --mode mip --window -1000,2000";

/// Rows of pixels, four numbers each, of a `.npy` of a picture.
fn pixels(folder: &Folder, name: &str, [width, height]: [usize; 2]) -> Vec<[f32; 4]> {
    let bytes = fs::read(folder.path(name)).expect("a file");
    let numbers = &bytes[bytes.len() - 16 * width * height..];
    let number = |b: &[u8]| f32::from_le_bytes(b.try_into().expect("four bytes"));
    let numbers: Vec<f32> = numbers.chunks(4).map(number).collect();
    numbers.as_chunks::<4>().0.to_vec()
}

#[test]
fn float_files_have_a_layer_of_their_own_and_the_picture_stays() {
    let folder = Folder::new();
    let all = "--annotate bar,scale,orientation,box,ticks,axes,source,title=Head --size 320x240";
    folder
        .run(&format!(
            "render --look plain {HEAD} --size 320x240 -o plain.npy"
        ))
        .assert_done();
    folder
        .run(&format!("render --look plain {HEAD} {all} -o a.npy"))
        .assert_done();
    let read = |name: &str| fs::read(folder.path(name)).expect("a file");
    assert!(read("plain.npy") == read("a.npy"), "the picture is another");
    let layer = pixels(&folder, "a.annotation.npy", [320, 240]);
    let covered = layer.iter().filter(|pixel| pixel[3] > 0.5).count();
    assert!(
        (400..layer.len() / 2).contains(&covered),
        "{covered} pixels have marks"
    );
    // A layer is premultiplied: no colour is above its opacity.
    assert!(layer.iter().all(|p| p.iter().all(|&c| c <= p[3] + 1e-6)));
    folder
        .run(&format!("render --look plain {HEAD} {all} -o a.exr"))
        .assert_done();
    let bytes = read("a.exr");
    for name in ["annotation.R", "annotation.A"] {
        let found = bytes
            .windows(name.len())
            .any(|part| part == name.as_bytes());
        assert!(found, "a.exr has no channel {name}");
    }
}

#[test]
fn the_bar_has_the_colours_of_the_picture() {
    let folder = Folder::new();
    folder
        .run(&format!(
            "render --look plain {HEAD} --size 320x240 --annotate bar -o a.npy"
        ))
        .assert_done();
    let layer = pixels(&folder, "a.annotation.npy", [320, 240]);
    // 45 % of 240 pixels, in the middle of the height but for the caption: black at the foot, white at the head.
    let column = |x: usize| (0..240).map(move |y| y * 320 + x);
    let opaque = |x: usize| column(x).filter(|&i| layer[i][3] > 0.999).count();
    let bar = (220..318).max_by_key(|&x| opaque(x)).expect("a column") - 2;
    let tall = 108;
    let first = column(bar)
        .position(|i| layer[i][3] > 0.999)
        .expect("a bar")
        .max(60);
    let grey = |row: usize| f64::from(layer[row * 320 + bar][0]);
    let linear = |s: f64| {
        if s <= 0.04045 {
            s / 12.92
        } else {
            ((s + 0.055) / 1.055).powf(2.4)
        }
    };
    // The row of the middle grey, from the colours alone; from there the others follow by the window.
    let middle = (first..first + tall)
        .find(|&row| grey(row) < linear(0.5))
        .expect("a middle");
    for off in [-40_isize, -20, 20, 40] {
        let row = middle.checked_add_signed(off).expect("a row");
        let wanted = linear(0.5 - (off as f64 + 0.5) / tall as f64);
        // A row is 1/108 of the window; codes are 8 bits.
        let slope = 2.2 / tall as f64 + 1.0 / 255.0;
        assert!(
            (grey(row) - wanted).abs() < slope,
            "{off}: {} {wanted}",
            grey(row)
        );
    }
}

#[test]
fn frames_and_thumbnails_are_the_pictures_that_render_draws() {
    let folder = Folder::new();
    let words =
        "--mode mip --window 0,4 --device reference --size 128x96 --annotate bar,time,scale,box";
    folder
        .run(&format!(
            "animate --look plain phantom:storm,n=16,variable=cloud,times=3 --times {words} -o f%02d.png"
        ))
        .assert_done();
    for time in 0..3 {
        folder
            .run(&format!(
                "render --look plain phantom:storm,n=16,variable=cloud,times=3 --time {time} {words} -o r{time}.png"
            ))
            .assert_done();
        let [frame, still] = [format!("f{time:02}.png"), format!("r{time}.png")]
            .map(|name| fs::read(folder.path(&name)).expect("a picture"));
        assert!(frame == still, "frame {time} is another picture");
    }
    let words = "--device reference --annotate";
    folder
        .run(&format!(
            "thumbnails --look plain phantom:head,n=16 {words} -o small"
        ))
        .assert_done();
    folder
        .run(&format!(
            "render --look plain phantom:head,n=16 --size 256x256 {words} -o one.png"
        ))
        .assert_done();
    let [small] = &fs::read_dir(folder.path("small"))
        .expect("a folder")
        .map(|e| e.expect("an entry").path())
        .collect::<Vec<_>>()[..]
    else {
        panic!("one picture");
    };
    assert!(
        fs::read(small).expect("a picture") == fs::read(folder.path("one.png")).expect("a picture")
    );
}

#[test]
fn a_film_that_goes_on_wants_the_same_marks() {
    let folder = Folder::new();
    let film = "animate --look plain phantom:fog,n=8 --turntable 2 --device reference --size 32x24 -o f%d.png";
    folder
        .run(&format!("{film} --annotate scale"))
        .assert_done();
    let ran = folder.run(&format!("{film} --annotate bar --resume"));
    assert_ne!(ran.code, 0, "{}", ran.err);
    folder
        .run(&format!("{film} --annotate scale --resume"))
        .assert_done();
}

#[test]
fn a_scene_keeps_the_marks_and_a_sheet_has_them() {
    let folder = Folder::new();
    folder
        .run(&format!(
            "render --look plain {HEAD} --size 64x48 --annotate title=Škoda,scale --annotate-size 12 --annotate-color 1:0:0 \
             --save-scene s.json -o a.png"
        ))
        .assert_done();
    folder
        .run("render --scene s.json -o b.png --device reference")
        .assert_done();
    assert!(
        fs::read(folder.path("a.png")).expect("a") == fs::read(folder.path("b.png")).expect("b")
    );
    let sheet = "sheet phantom:fog,n=8 --tile 96x72 --device reference";
    folder.run(&format!("{sheet} -o plain.png")).assert_done();
    folder
        .run(&format!("{sheet} --annotate -o marked.png"))
        .assert_done();
    let read = |name: &str| fs::read(folder.path(name)).expect("a sheet");
    assert!(
        read("plain.png") != read("marked.png"),
        "the sheet has no marks"
    );
}

#[test]
fn words_that_cannot_be_drawn_are_refused() {
    let folder = Folder::new();
    for (words, said) in [
        ("--annotate title=Жук", "--annotate title: no letter 'Ж'"),
        ("--annotate foo", "no mark \"foo\": wanted bar, time"),
        (
            "--annotate bar --colormap-scale log",
            "--colormap-scale log: wanted values above 0, found -1000",
        ),
    ] {
        let ran = folder.run(&format!(
            "render --look plain {HEAD} --size 16x16 -o a.png {words}"
        ));
        assert_eq!(ran.code, 2, "{words}: {}", ran.err);
        assert!(ran.err.contains(said), "{words}: {}", ran.err);
        assert!(!folder.path("a.png").exists(), "{words}");
    }
}
