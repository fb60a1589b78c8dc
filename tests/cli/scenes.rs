//! The scenes of `--show` on a forecast: what a word shows, that its flags show the same, and films of it. Without the file
//! the tests are skipped.

use crate::person::Folder;
use crate::real::data;
use std::fs;
use std::path::PathBuf;

/// Hours 12 to 21 of a hurricane.
fn forecast() -> Option<PathBuf> {
    let found = data()?.join("met-wrf/wrf_ci.nc");
    if !found.is_file() {
        println!("skipped: no {}", found.display());
    }
    found.is_file().then_some(found)
}

const SIZE: [usize; 2] = [160, 120];

/// Rows of pixels, four numbers each.
fn pixels(folder: &Folder, name: &str) -> Vec<[f32; 4]> {
    let bytes = fs::read(folder.path(name)).expect(name);
    let numbers = &bytes[bytes.len() - 16 * SIZE[0] * SIZE[1]..];
    let number = |b: &[u8]| f32::from_le_bytes(b.try_into().expect("four bytes"));
    let numbers: Vec<f32> = numbers.chunks(4).map(number).collect();
    numbers.as_chunks::<4>().0.to_vec()
}

/// How many pixels differ, and the box around them.
fn difference(a: &[[f32; 4]], b: &[[f32; 4]]) -> (usize, [usize; 4]) {
    let (mut count, mut around) = (0, [SIZE[0], SIZE[1], 0, 0]);
    for (i, (a, b)) in a.iter().zip(b).enumerate() {
        if a != b {
            let [x, y] = [i % SIZE[0], i / SIZE[0]];
            let [left, top, right, bottom] = around;
            around = [left.min(x), top.min(y), right.max(x), bottom.max(y)];
            count += 1;
        }
    }
    (count, around)
}

/// A picture is not empty where this many of its pixels are not as the one in its corner.
fn assert_shows_something(picture: &[[f32; 4]], least: usize, what: &str) {
    let shown = picture.iter().filter(|pixel| **pixel != picture[0]).count();
    println!("{what}: {shown} pixels");
    assert!(shown >= least, "{what}: {shown} pixels show something");
}

#[test]
fn a_scene_of_a_forecast_has_a_bar_and_its_date_and_is_what_its_flags_show() {
    let Some(file) = forecast() else {
        return;
    };
    let folder = Folder::new();
    let fixed = format!("{} --size {}x{}", file.display(), SIZE[0], SIZE[1]);
    for word in ["vapor", "wind"] {
        let shown = folder.run(&format!("render {fixed} --show {word} -o {word}.npy"));
        shown.assert_done();
        let picture = pixels(&folder, &format!("{word}.npy"));
        assert_shows_something(&picture, 1000, word);

        let word_of = format!("--show {word}: ");
        let said = shown
            .err
            .lines()
            .find_map(|line| Some(line.split_once(&word_of)?.1));
        let said = said.unwrap_or_else(|| panic!("{shown:#?}"));
        // A title has spaces, and is told in quotes.
        let (flags, marks) = said.split_once(" --annotate").expect("marks");
        let marks = match marks.trim().trim_matches('\'') {
            "" => "bar,time,orientation,scale",
            marks => marks,
        };
        let draw = |marks: &str, out: &str| {
            let mut command = folder.command(&format!("render {fixed} {flags} -o {out} --force"));
            command.arg(format!("--annotate={marks}"));
            let ran = command.output().expect("the program runs");
            assert!(ran.status.success(), "{ran:?}");
        };
        draw(marks, "flags.npy");
        for kind in ["", ".annotation"] {
            let read =
                |name: &str| fs::read(folder.path(&format!("{name}{kind}.npy"))).expect(name);
            assert!(
                read(word) == read("flags"),
                "{word}{kind}.npy is another by its flags"
            );
        }

        // Without the bar, and without the date, the layer is another where they stand.
        let layer = pixels(&folder, &format!("{word}.annotation.npy"));
        let without = |left_out: &[&str]| {
            let others = marks.split(',').filter(|other| !left_out.contains(other));
            let others: Vec<&str> = others.collect();
            draw(&others.join(","), "without.npy");
            pixels(&folder, "without.annotation.npy")
        };
        let (bar, [left, ..]) = difference(&layer, &without(&["bar"]));
        // A line of the bar takes half of the width at most, an em of 11 pixels from the side, with two more of a halo.
        assert!(
            bar > 300 && left >= SIZE[0] / 2 - 13,
            "{word}: a bar of {bar} pixels from {left} on"
        );
        // A bar makes room for a date that reaches over it.
        let (date, [_, _, right, bottom]) =
            difference(&without(&["bar"]), &without(&["bar", "time"]));
        // Under a title of two lines, of 11 pixels and what is between them each.
        assert!(
            date > 300 && right < SIZE[0] && bottom < SIZE[1] / 3,
            "{word}: a date of {date} pixels down to {bottom}"
        );
    }
}

/// The first and the last of seven frames are times of the file; all have dates of their own.
#[test]
fn a_film_of_a_forecast_goes_through_its_dates() {
    let Some(file) = forecast() else {
        return;
    };
    let folder = Folder::new();
    for word in ["vapor", "wind"] {
        let fixed = format!("--size {}x{} --show {word}", SIZE[0], SIZE[1]);
        let film = format!(
            "animate {} {fixed} --between 1 -o {word}%d.npy",
            file.display()
        );
        folder.run(&film).assert_done();
        assert!(
            !folder.path(&format!("{word}7.npy")).exists(),
            "{word}: more than seven frames"
        );
        let frames: Vec<_> = (0..7)
            .map(|i| {
                let picture = pixels(&folder, &format!("{word}{i}.npy"));
                assert_shows_something(&picture, 1000, &format!("{word}, frame {i}"));
                (
                    picture,
                    pixels(&folder, &format!("{word}{i}.annotation.npy")),
                )
            })
            .collect();
        for pair in frames.windows(2) {
            assert!(pair[0].0 != pair[1].0, "{word}: two frames are the same");
            // Ink that is dark on light and light on dark may change below.
            let [before, after] = [&pair[0].1, &pair[1].1].map(|all| &all[..SIZE[0] * SIZE[1] / 4]);
            let (date, _) = difference(before, after);
            assert!(date > 10, "{word}: {date} pixels of dates differ");
        }
    }
}
