//! An interrupt ends the program at once, with exit code 130 and without half a file; a bug of ours ends it
//! with a sentence.

use crate::person::Folder;
use std::{
    io::{BufRead, BufReader},
    process::{Command, Stdio},
    time::{Duration, Instant},
};

#[test]
fn an_interrupt_while_drawing_exits_130_and_leaves_no_file() {
    let folder = Folder::new();
    for signal in ["-INT", "-TERM"] {
        let mut child = folder
            .command("render phantom:fog,n=32 -o a.png --size 256x256 --repeat 1000000 --progress json --device reference")
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        // Some pictures are drawn: the signal comes in the middle of the work.
        let stderr = BufReader::new(child.stderr.take().expect("a pipe"));
        let drawing = stderr
            .lines()
            .map_while(Result::ok)
            .find(|line| line.contains("\"draw\""));
        assert!(drawing.is_some(), "the program draws nothing");
        let kill = Command::new("kill")
            .args([signal, &child.id().to_string()])
            .status();
        assert!(kill.expect("kill runs").success());
        let start = Instant::now();
        let status = child.wait().expect("an end");
        assert_eq!(status.code(), Some(130), "{signal}: {status:?}");
        assert!(
            start.elapsed() < Duration::from_secs(10),
            "it hangs for {:?}",
            start.elapsed()
        );
        assert!(folder.names().is_empty(), "{:?}", folder.names());
    }
}

#[test]
fn an_interrupt_in_the_middle_of_one_long_picture_does_not_wait_for_it() {
    let folder = Folder::new();
    let mut child = folder
        .command("render phantom:fog,n=32 -o a.png --size 2048x2048 --samples-per-voxel 64 --no-skip --progress json")
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let stderr = BufReader::new(child.stderr.take().expect("a pipe"));
    // Of the one picture that there is a part is done, and not yet half of it.
    let parts = stderr.lines().map_while(Result::ok);
    let part = parts
        .filter_map(|line| serde_json::from_str::<serde_json::Value>(&line).ok())
        .find_map(|line| {
            Some((
                line["part"].as_f64()?,
                line["done"].clone(),
                line["of"].clone(),
            ))
        });
    let (part, done, of) = part.expect("a part of the picture");
    assert!(part > 0.0 && part < 0.5, "{part}");
    assert_eq!((done, of), (0.into(), 1.into()));
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.expect("kill runs").success());
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

#[test]
#[ignore = "run by the test below in a process of its own: it panics"]
fn a_program_with_a_bug() {
    let code = stratavox::cli::guarded(|| panic!("the roof\u{1b} is on fire"));
    assert_eq!(code, 101);
    // Not the code of a panic: only a program that was guarded gets here.
    std::process::exit(77);
}

#[test]
fn a_bug_says_so_with_the_version_and_where_to_take_it() {
    let output = Command::new(std::env::current_exe().expect("this test"))
        .args([
            "--ignored",
            "--exact",
            "interrupt::a_program_with_a_bug",
            "--nocapture",
        ])
        .output()
        .expect("the test runs itself");
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(77), "{err}");
    for word in [
        env!("CARGO_PKG_VERSION"),
        "bug in stratavox",
        "please report",
        "the roof",
        "interrupt.rs",
    ] {
        assert!(err.contains(word), "no {word:?} in {err}");
    }
    for word in ["panicked at", "RUST_BACKTRACE", "\u{1b}"] {
        assert!(!err.contains(word), "{word:?} in {err}");
    }
}
