//! What an error or a note says: it blames what the person gave, and names the values or numbers that there are.

use crate::person::Folder;

const SMALL: &str = "--size 16x16 --device reference";

#[test]
fn an_error_about_a_section_names_it_where_no_mode_was_given() {
    let folder = Folder::new();
    folder
        .run("convert phantom:head,n=8 -o labels.nrrd")
        .assert_done();
    for (flags, blamed) in [
        ("--cut-faces --clip 1,0,0,0", "an opaque cut face"),
        ("--opacity-from labels.nrrd", "--opacity-from"),
        ("--shading phong", "--shading phong"),
        ("--ambient-occlusion 1", "--ambient-occlusion"),
    ] {
        let words = format!("render phantom:head,n=8 --section axial {flags} -o a.png {SMALL}");
        let ran = folder.run(&words);
        ran.assert_refused(2, &["--section", blamed, "--mode composite"]);
        assert!(!ran.err.contains("leave out --mode"), "{ran:#?}");
        // Where the mode is the person's own, the section is not to blame.
        let ran = folder.run(&format!("{words} --mode mip"));
        ran.assert_refused(2, &[blamed]);
        assert!(!ran.err.contains("--section"), "{ran:#?}");
    }
    // An error that has nothing to do with the mode stays as it is.
    let ran = folder.run(&format!(
        "render phantom:head,n=8 --section axial --technique slices-2d -o a.png {SMALL}"
    ));
    ran.assert_refused(2, &["leave out --technique"]);
    assert!(!ran.err.contains("--mode average"), "{ran:#?}");
}

#[test]
fn several_channels_in_a_mode_of_one_name_the_mode_and_the_channels() {
    let folder = Folder::new();
    let ran = folder.run(&format!(
        "render phantom:cells,n=8 --mode iso -o a.png {SMALL}"
    ));
    ran.assert_refused(2, &["--mode iso", "several channels", "--component 0"]);
    assert!(!ran.err.contains("phong"), "{ran:#?}");
}

#[test]
fn an_empty_picture_says_which_values_there_are() {
    let folder = Folder::new();
    folder.file("ramp.raw", (0..64).map(|i| 10 + 3 * i).collect::<Vec<u8>>());
    let render = "render ramp.raw --raw 4x4x4,u8";
    for (flags, said) in [
        ("--mode iso --iso 99999", "the level 99999"),
        ("--mode iso --iso 1,2", "the level 1 or 2"),
        ("--preset grey --window 5000,6000", "covers no value"),
    ] {
        let ran = folder.run(&format!("{render} {flags} -o a.png --force {SMALL}"));
        ran.assert_done();
        for words in [said, "values run from 10 to 199"] {
            assert!(ran.err.contains(words), "{flags}: {ran:#?}");
        }
    }
}

#[test]
fn a_limit_has_a_hint_that_helps_with_it() {
    let folder = Folder::new();
    let ran = folder.run("render phantom:fog,n=8 -o a.png --size 99999x99999");
    ran.assert_refused(6, &["99999x99999", "32768", "hint: --size "]);
    assert!(!ran.err.contains("--samples-per-voxel"), "{ran:#?}");
    let ran = folder.run("animate phantom:fog,n=8 -o %d.png --turntable 4000000000");
    assert!(!ran.err.contains("--samples-per-voxel"), "{ran:#?}");
}

#[test]
fn a_time_that_is_not_there_is_answered_with_those_that_are() {
    let folder = Folder::new();
    for (input, times, hint) in [
        (
            "phantom:storm,n=8 --variable vapor",
            "8 times",
            "--time 0 to --time 7",
        ),
        ("phantom:fog,n=8", "one time", "leave out --time"),
    ] {
        let ran = folder.run(&format!("render {input} --time 99 -o a.png {SMALL}"));
        ran.assert_refused(2, &["--time 99", times, hint]);
    }
    let ran = folder.run(&format!(
        "render phantom:storm,n=8 --variable vapor --time 1999-01-01 -o a.png {SMALL}"
    ));
    ran.assert_refused(2, &["1999-01-01", "--time 0 to --time 7"]);
}

#[test]
fn light_that_the_look_turns_on_is_not_called_idle() {
    let folder = Folder::new();
    for flag in [
        "--light 1,0,0",
        "--material 0.3,0.6,0.1,10",
        "--half-gradient 5",
    ] {
        let words = format!("phantom:head,n=16 {flag} {SMALL}");
        let said = |verb: &str, more: &str, output: &str| {
            let ran = folder.run(&format!("{verb} {words} {more} --force -o {output}"));
            ran.assert_done();
            ran.err.contains("has no effect without --shading phong")
        };
        for (verb, more, output) in [
            ("render", "", "a.png"),
            ("thumbnails", "", "small"),
            ("animate", "--turntable 2", "%d.png"),
        ] {
            assert!(!said(verb, more, output), "{verb} {flag}");
            let dark = format!("{more} --shading none");
            assert!(said(verb, &dark, output), "{verb} {flag}");
            let plain = format!("{more} --look plain");
            assert!(said(verb, &plain, output), "{verb} {flag}");
        }
    }
}

#[test]
fn splats_of_labels_are_refused_by_the_labels_and_not_by_a_filter() {
    let folder = Folder::new();
    let label = |i: usize| match [i % 16, i / 16 % 16, i / 256] {
        [x, y, _] if x < 3 || y < 3 => 0,
        [.., z] if z < 8 => 1,
        _ => 5,
    };
    folder.file("l.raw", (0..4096).map(label).collect::<Vec<u8>>());
    for command in ["render", "animate --turntable 2"] {
        let words = format!("{command} l.raw --raw 16x16x16,u8 --technique splat {SMALL} --force");
        let output = if command == "render" {
            "-o a.png"
        } else {
            "-o a%d.png"
        };
        let ran = folder.run(&format!("{words} {output}"));
        ran.assert_refused(2, &["the values are labels", "--technique raycast"]);
        assert!(!ran.err.contains("not for the filter"), "{ran:#?}");
        folder
            .run(&format!("{words} --filter linear {output}"))
            .assert_done();
    }
    // A filter of the person's own is to blame itself.
    folder
        .run(&format!(
            "render phantom:head,n=8 --technique splat --filter nearest {SMALL} -o b.png"
        ))
        .assert_refused(2, &["not for the filter nearest"]);
}

#[test]
fn an_intermediate_image_without_room_hints_at_the_finest_that_has() {
    let folder = Folder::new();
    let render = "render phantom:head,n=16 --technique shear-warp --size 32x24 -o a.png";
    let ran = folder.run(&format!("{render} --intermediate 5000"));
    ran.assert_refused(
        2,
        &["the view asks for an intermediate image of", "has room"],
    );
    let after = |words: &str| -> f64 {
        let rest = ran.err.split(words).nth(1).expect("the words");
        rest.split(' ')
            .next()
            .expect("a number")
            .parse()
            .expect("a number")
    };
    let (across, number) = (after("image of "), after("hint: --intermediate "));
    // As fine as that the image has no more pixels across than there is room for, and takes no more than a device has: 2 GiB at most.
    assert!(across * number / 5000.0 <= 16384.0, "{ran:#?}");
    assert!(number > 10.0, "{ran:#?}");
}

#[test]
fn two_words_about_empty_space_are_refused() {
    let folder = Folder::new();
    for command in ["render", "animate", "thumbnails", "bench"] {
        folder
            .run(&format!(
                "{command} phantom:head,n=8 --empty-space octree --no-skip"
            ))
            .assert_refused(2, &["cannot be used with", "--no-skip", "--empty-space"]);
    }
}
