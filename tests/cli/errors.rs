//! Inputs that cannot be read and outputs that cannot be written: their exit codes, and nothing half done.

use crate::person::Folder;
use std::{fs, process::Stdio};

const SMALL: &str = "--size 8x8 --device reference";

#[test]
fn an_input_that_is_not_there_or_not_a_volume_exits_3() {
    let folder = Folder::new();
    folder.file("text.nrrd", "no volume at all");
    folder.file("bad.json", "{\"stratavox_scene\":1,\"camera\":{\"fow\":3}}");
    for (words, name) in [
        ("info nowhere.nrrd".to_owned(), "nowhere.nrrd"),
        ("info text.nrrd".to_owned(), "text.nrrd"),
        ("info phantom:nobody".to_owned(), "nobody"),
        (
            format!("render nowhere.nrrd -o a.png {SMALL}"),
            "nowhere.nrrd",
        ),
        (
            format!("render phantom:fog,n=8 -o a.png {SMALL} --tf nowhere.json"),
            "nowhere.json",
        ),
        (
            format!("render --scene nowhere.json -o a.png {SMALL}"),
            "nowhere.json",
        ),
        (format!("render --scene bad.json -o a.png {SMALL}"), "fow"),
        (
            "bench phantom:fog,n=8 --cameras nowhere.json".to_owned(),
            "nowhere.json",
        ),
        ("compare a.png b.png".to_owned(), "a.png"),
        (
            "info phantom:head,type=f64".to_owned(),
            "wanted one of u16, u8, f32,",
        ),
    ] {
        folder.run(&words).assert_refused(3, &[name]);
    }
    assert_eq!(folder.names(), ["bad.json", "text.nrrd"]);
}

#[test]
fn a_volume_beyond_the_limits_exits_6() {
    let folder = Folder::new();
    let header = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 60000 60000 60000\nencoding: raw\n\n";
    folder.file("huge.nrrd", header);
    let ran = folder.run("info huge.nrrd");
    assert!([3, 6].contains(&ran.code), "{ran:#?}");
    let ran = folder.run("render phantom:fog,n=8 -o a.png --size 40000x1");
    ran.assert_refused(6, &["40000x1"]);
}

#[test]
fn an_existing_output_is_kept_unless_forced() {
    let folder = Folder::new();
    folder.file("a.png", "mine");
    let words = format!("render phantom:fog,n=8 -o a.png {SMALL}");
    folder
        .run(&words)
        .assert_refused(4, &["a.png", "exists", "--force"]);
    assert_eq!(fs::read(folder.path("a.png")).expect("a file"), b"mine");
    folder.run(&format!("{words} --force")).assert_done();
    crate::person::assert_begins(&folder.path("a.png"), b"\x89PNG");
    assert_eq!(folder.names(), ["a.png"]);
}

#[test]
fn outputs_are_refused_before_the_work_begins() {
    let folder = Folder::new();
    folder.file("t.json", "mine");
    // The input does not exist: had the work begun, that would be the complaint.
    for (words, name) in [
        ("render nowhere.nrrd -o no/a.png", "there is no folder"),
        ("render nowhere.nrrd -o a.png --timings t.json", "t.json"),
        ("render nowhere.nrrd -o a.png --save-scene t.json", "t.json"),
        ("bench nowhere.nrrd --json t.json", "t.json"),
    ] {
        folder.run(words).assert_refused(4, &[name]);
    }
    assert_eq!(folder.names(), ["t.json"]);
}

#[test]
fn an_input_is_never_overwritten() {
    let folder = Folder::new();
    let npy = folder.file("a.npy", "mine");
    let words = format!("render a.npy -o ./a.npy --force --raw 1x1x4,u8 {SMALL}");
    folder.run(&words).assert_refused(4, &["it is an input"]);
    assert_eq!(fs::read(npy).expect("a file"), b"mine");
    folder.file(
        "s.json",
        "{\"stratavox_scene\":1,\"input\":{\"path\":\"phantom:fog,n=8\"}}",
    );
    let words = format!("render --scene s.json --save-scene s.json -o b.png --force {SMALL}");
    folder.run(&words).assert_refused(4, &["it is an input"]);
}

#[cfg(unix)]
#[test]
fn a_folder_that_may_not_be_written_exits_4_and_leaves_nothing() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let closed = folder.path("closed");
    fs::create_dir(&closed).expect("a folder");
    fs::set_permissions(&closed, fs::Permissions::from_mode(0o555)).expect("permissions");
    // Root may write anywhere: then there is nothing to show.
    if fs::write(closed.join("probe"), "").is_ok() {
        // Not even root may write where the system shows its devices.
        let ran = folder.run(&format!("render phantom:fog,n=8 -o /sys/a.png {SMALL}"));
        ran.assert_refused(4, &["/sys/a.png"]);
        return;
    }
    let ran = folder.run("render nowhere.nrrd -o closed/a.png");
    ran.assert_refused(4, &["closed/a.png"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_closed_standard_output_exits_4() {
    let folder = Folder::new();
    for words in ["info phantom:fog,n=8 --json", "--help"] {
        let full = fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .expect("/dev/full");
        let status = folder
            .command(words)
            .stdout(full)
            .stderr(Stdio::null())
            .status();
        assert_eq!(status.expect("the program runs").code(), Some(4), "{words}");

        // The reading end is gone before the program starts.
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let status = folder
            .command(words)
            .stdout(writer)
            .stderr(Stdio::null())
            .status();
        assert_eq!(status.expect("the program runs").code(), Some(4), "{words}");
    }
}

#[cfg(unix)]
#[test]
fn a_file_size_limit_exits_4_and_leaves_no_half_file() {
    let folder = Folder::new();
    let program = env!("CARGO_BIN_EXE_stratavox");
    // One block: 512 or 1024 bytes; the array has 64 x 64 x 16.
    let script = format!(
        "ulimit -f 1; exec {program} render phantom:fog,n=8 -o {}/a.npy --size 64x64 --device reference",
        folder.path("").display()
    );
    let output = std::process::Command::new("sh")
        .args(["-c", &script])
        .output()
        .expect("a shell");
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{err}");
    assert!(err.contains("a.npy"), "{err}");
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}
