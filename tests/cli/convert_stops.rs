//! A conversion to bricks that is stopped: no half file has the name of a whole one, and `--resume` ends where an
//! uninterrupted run does, byte for byte, or says by name why it cannot.

use crate::person::Folder;
use std::{
    fs,
    io::{BufRead, BufReader},
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

const DIMS: [usize; 3] = [122, 1201, 61];

const WORDS: &str = "convert a.raw --raw 122x1201x61,u8 --type u16 --window 0,90 -o a.svb";

/// A folder with a volume of 11 rows of bricks, 6 of half as many voxels, and so on.
fn folder() -> Folder {
    let folder = Folder::new();
    let count = DIMS.iter().product();
    let numbers = (0..count).map(|n: usize| (n * n / 64 % 251) as u8);
    folder.file("a.raw", numbers.collect::<Vec<u8>>());
    folder
}

/// Runs these words until so many bricks are written, and stops them with `stop`; gives what is left on stderr and the
/// exit code.
fn stopped(folder: &Folder, words: &str, bricks: usize, stop: fn(&mut Child)) -> (String, i32) {
    let mut child = folder
        .command(&format!("{words} --progress json"))
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let mut lines = BufReader::new(child.stderr.take().expect("a pipe")).lines();
    let word = format!("\"done\":{bricks},");
    let found = lines.by_ref().map_while(Result::ok);
    assert!(
        found.into_iter().any(|line| line.contains(&word)),
        "no {word}"
    );
    stop(&mut child);
    let start = Instant::now();
    let status = child.wait().expect("an end");
    assert!(start.elapsed() < Duration::from_secs(10), "it hangs");
    let rest: Vec<String> = lines.map_while(Result::ok).collect();
    (rest.join("\n"), status.code().unwrap_or(-1))
}

fn kill(child: &mut Child) {
    child.kill().expect("killed");
}

fn interrupt(child: &mut Child) {
    let words = ["-INT".to_owned(), child.id().to_string()];
    let sent = Command::new("kill").args(words).status();
    assert!(sent.expect("kill runs").success());
}

#[test]
fn a_stopped_conversion_goes_on_to_the_same_bytes() {
    let folder = folder();
    folder.run(WORDS).assert_done();
    let wanted = fs::read(folder.path("a.svb")).expect("a file");
    fs::rename(folder.path("a.svb"), folder.path("wanted.svb")).expect("renamed");
    for (bricks, stop) in [(4, kill as fn(&mut Child)), (24, kill), (4, interrupt)] {
        let (said, code) = stopped(&folder, WORDS, bricks, stop);
        assert!(!folder.path("a.svb").exists(), "half a file");
        assert!(folder.path(".a.svb.unfinished").is_file());
        if code == 130 {
            assert!(
                said.contains("a.svb is kept") && said.contains("--resume"),
                "{said}"
            );
        }
        // Killed once more, later.
        stopped(&folder, &format!("{WORDS} --resume"), bricks + 4, kill);
        let ran = folder.run(&format!("{WORDS} --resume"));
        ran.assert_done();
        assert!(ran.err.contains("bricks are there and stay"), "{ran:#?}");
        assert!(
            fs::read(folder.path("a.svb")).expect("a file") == wanted,
            "other bytes"
        );
        assert_eq!(folder.names(), ["a.raw", "a.svb", "wanted.svb"]);
        fs::remove_file(folder.path("a.svb")).expect("removed");
    }
}

#[test]
fn another_conversion_is_refused_by_what_has_changed() {
    let folder = folder();
    let (_, code) = stopped(&folder, WORDS, 4, kill);
    assert_eq!(code, -1);
    folder
        .run(WORDS)
        .assert_refused(4, &["unfinished conversion", "--resume", "--force"]);
    for (words, said) in [
        (WORDS.replace("0,90", "0,91"), "`conversion.window` was"),
        (WORDS.replace("u16", "f32"), "`conversion.type` was"),
        (
            format!("{WORDS} --crop 0,9,0,9,0,9"),
            "`conversion.crop` was",
        ),
        (format!("{WORDS} --time 0"), "`conversion.input.time` was"),
    ] {
        let ran = folder.run(&format!("{words} --resume"));
        ran.assert_refused(2, &["--resume: ", said, "--force begins anew"]);
    }
    // The bricks of nobody else's journal, and a file that has changed since.
    let journal = fs::read_to_string(folder.path(".a.svb.journal")).expect("a journal");
    let other = journal.replace("\"version\":\"", "\"version\":\"9.");
    folder.file(".a.svb.journal", other);
    folder
        .run(&format!("{WORDS} --resume"))
        .assert_refused(2, &["`version` was", "9."]);
    folder.file(".a.svb.journal", &journal);
    let mut bytes = fs::read(folder.path("a.raw")).expect("a file");
    bytes[7] ^= 1;
    folder.file("a.raw", bytes);
    folder
        .run(&format!("{WORDS} --resume"))
        .assert_refused(2, &["`conversion.file.names_sizes_and_changes` was"]);
    let unfinished = fs::File::open(folder.path(".a.svb.unfinished")).expect("a file");
    unfinished.lock().expect("locked");
    let ran = folder.run(&format!("{WORDS} --resume --force"));
    ran.assert_refused(4, &["another run is writing it"]);
    drop(unfinished);
    // Of the changed file, anew.
    folder
        .run(&format!("{WORDS} --resume --force"))
        .assert_done();
    assert_eq!(folder.names(), ["a.raw", "a.svb"]);
    folder
        .run(&format!("{WORDS} --resume"))
        .assert_refused(4, &["it exists"]);
}

#[test]
fn what_is_written_in_one_piece_is_not_gone_on_with() {
    let folder = Folder::new();
    folder
        .run("convert phantom:head,n=8 -o a.nrrd --resume")
        .assert_refused(2, &["--resume is for a .svb"]);
    folder
        .run("convert phantom:head,n=8 -o a.stl --iso 300 --resume")
        .assert_refused(2, &["cannot be used with"]);
    // What is damaged is told, and leaves nothing behind.
    folder.file("a.npy", &b"\x93NUMPY\x01\0"[..]);
    let ran = folder.run("convert a.npy -o a.svb --resume");
    assert_eq!(ran.code, 3, "{ran:#?}");
    assert_eq!(folder.names(), ["a.npy"]);
    // A journal without bricks, as somebody may have left it, is in nobody's way.
    folder.file(".b.svb.journal", "dear diary");
    folder
        .run("convert phantom:head,n=8 -o b.svb --resume")
        .assert_done();
    assert_eq!(folder.names(), ["a.npy", "b.svb"]);
}
