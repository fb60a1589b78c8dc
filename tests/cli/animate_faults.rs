//! Films where nothing more can be written: exit code 4, no half file, and what was there before stays as it was.

use crate::person::{Folder, Ran};
use std::{fs, process::Command};

const FILM: &str = "phantom:fog,n=8 --turntable 3 --size 64x48 --device reference";
const SMALL: &str = "phantom:fog,n=8 --turntable 3 --size 8x6 --device reference";

/// The program under a limit of so many blocks a file, of 512 or 1024 bytes.
fn run_limited(folder: &Folder, blocks: u32, words: &str) -> Ran {
    let program = env!("CARGO_BIN_EXE_stratavox");
    let script = format!(
        "cd {}; ulimit -f {blocks}; exec {program} animate {words}",
        folder.path("").display()
    );
    let output = Command::new("sh").args(["-c", &script]).output();
    let output = output.expect("a shell");
    Ran {
        code: output.status.code().unwrap_or(-1),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

#[test]
fn frames_that_do_not_fit_leave_no_half_file_and_the_old_ones_as_they_were() {
    let folder = Folder::new();
    for ending in ["npy", "exr"] {
        let words = format!("{FILM} -o f%d.{ending}");
        run_limited(&folder, 2, &words).assert_refused(4, &[&format!("f0.{ending}")]);
        let old = format!("f0.{ending}");
        folder.file(&old, "before");
        run_limited(&folder, 2, &format!("{words} --force")).assert_refused(4, &[&old]);
        assert_eq!(fs::read(folder.path(&old)).expect("a file"), b"before");
        fs::remove_file(folder.path(&old)).expect("a file");
    }
    let halves = folder.names();
    let is_journal = |name: &String| name.ends_with(".journal");
    assert!(halves.iter().all(is_journal), "{halves:?}");
}

#[test]
fn a_film_that_does_not_fit_leaves_no_half_film_and_the_old_one_as_it_was() {
    let folder = Folder::new();
    // Frames of one colour pack well; an uncompressed film of them has 3 x 64 x 48 x 3 bytes.
    let words = format!("{FILM} -o a.y4m");
    let ran = run_limited(&folder, 40, &words);
    ran.assert_refused(4, &["a.y4m"]);
    assert_eq!(folder.names(), [".a.y4m.frames"], "{ran:#?}");
    let kept = fs::read_dir(folder.path(".a.y4m.frames")).expect("a folder");
    let kept = kept.map(|entry| entry.expect("an entry").file_name());
    let part = kept.filter(|name| name.to_string_lossy().ends_with(".part"));
    assert_eq!(part.count(), 0, "a part of the film is left");
    // All frames are there: without the limit the film is made of them.
    let ran = folder.run(&format!("animate {words} --resume"));
    ran.assert_done();
    assert!(ran.err.contains("all frames are there"), "{ran:#?}");
    let whole = fs::read(folder.path("a.y4m")).expect("a film");

    let ran = run_limited(&folder, 40, &format!("{words} --force"));
    ran.assert_refused(4, &["a.y4m"]);
    assert!(fs::read(folder.path("a.y4m")).expect("a film") == whole);
}

#[test]
fn a_film_that_is_there_is_kept_unless_forced() {
    let folder = Folder::new();
    for name in ["a.gif", "a.apng", "a.y4m"] {
        folder.file(name, "before");
        let ran = folder.run(&format!("animate {SMALL} -o {name}"));
        ran.assert_refused(4, &[name, "it exists", "--force"]);
        assert_eq!(fs::read(folder.path(name)).expect("a file"), b"before");
        folder
            .run(&format!("animate {SMALL} -o {name} --force"))
            .assert_done();
        assert!(fs::read(folder.path(name)).expect("a file").len() > 20);
    }
    assert_eq!(folder.names(), ["a.apng", "a.gif", "a.y4m"]);
    // A journal or times that cannot be written stop a film before it begins.
    folder.file("t.json", "before");
    let ran = folder.run(&format!("animate {SMALL} -o b.gif --timings t.json"));
    ran.assert_refused(4, &["t.json", "it exists"]);
    assert!(!folder.path("b.gif").exists() && !folder.path(".b.gif.frames").exists());
}

#[test]
fn a_folder_where_nothing_can_be_written_exits_4() {
    let folder = Folder::new();
    // Not even root may write where the system shows its devices.
    for output in ["/sys/a.gif", "/sys/%d.png", "/sys/new/%d.png", "/sys/a.y4m"] {
        let ran = folder.run(&format!("animate {SMALL} -o {output}"));
        ran.assert_refused(4, &["/sys/"]);
    }
    assert!(folder.names().is_empty());
}

#[test]
fn a_stream_into_a_full_device_exits_4() {
    let folder = Folder::new();
    let full = fs::OpenOptions::new().write(true).open("/dev/full");
    let mut command = folder.command(&format!("animate {SMALL} -o -"));
    let output = command.stdout(full.expect("/dev/full")).output();
    let output = output.expect("the program runs");
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{err}");
    assert!(err.contains("the standard output"), "{err}");
}
