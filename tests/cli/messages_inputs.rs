//! What an error says of an input: it is called as the person called it, and the hint helps.

use crate::person::Folder;
use std::process::Stdio;

const SMALL: &str = "--size 16x16 --device reference";

#[test]
fn a_phantom_beyond_the_memory_has_a_hint_of_its_own() {
    let folder = Folder::new();
    let ran = folder.run(&format!(
        "render phantom:head,n=128 --max-memory 1M --fit -o a.png {SMALL}"
    ));
    ran.assert_refused(6, &["smaller n=", "--fit", "--max-memory"]);
    assert!(!ran.err.contains("--untrusted"), "{ran:#?}");
}

#[test]
fn what_the_standard_input_holds_is_called_by_that_name() {
    let folder = Folder::new();
    for flags in ["", "--untrusted"] {
        let mut command = folder.command(&format!("render - -o a.png {SMALL} {flags}"));
        let output = command.stdin(Stdio::null()).output().expect("it runs");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{said}");
        assert!(said.contains("cannot read the standard input"), "{said}");
        assert!(!said.contains("/stratavox-"), "{said}");
    }
}

#[test]
fn a_layout_of_another_size_is_blamed_and_no_header() {
    let folder = Folder::new();
    folder.file("a.bin", [0; 9]);
    let ran = folder.run("info a.bin --raw 2x2x2,u8");
    ran.assert_refused(
        3,
        &["the layout that was given promises 8 bytes", "hint: --raw"],
    );
    assert!(!ran.err.contains("header"), "{ran:#?}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_not_utf_8_is_left_out_and_the_others_are_drawn() {
    use std::{ffi::OsStr, fs, os::unix::ffi::OsStrExt};
    let folder = Folder::new();
    fs::create_dir(folder.path("in")).expect("a folder");
    folder
        .run("convert phantom:fog,n=8 -o in/good.nrrd")
        .assert_done();
    let bad = folder.path("in").join(OsStr::from_bytes(b"bad\xff.nrrd"));
    fs::copy(folder.path("in/good.nrrd"), &bad).expect("a copy");
    for (words, made) in [
        (
            "sheet in -o sheet.png --tile 16x16 --device reference",
            "sheet.png",
        ),
        (
            "thumbnails in -o out --size 16x16 --device reference",
            "out/good.png",
        ),
    ] {
        let ran = folder.run(words);
        assert_eq!(ran.code, 3, "{ran:#?}");
        assert!(ran.err.contains("left out: cannot read in/bad"), "{ran:#?}");
        assert!(ran.err.contains("its name is not UTF-8"), "{ran:#?}");
        assert!(folder.path(made).is_file(), "{ran:#?}");
    }
    fs::remove_file(folder.path("in/good.nrrd")).expect("it is there");
    folder
        .run("sheet in -o none.png")
        .assert_refused(3, &["its name is not UTF-8"]);
}
