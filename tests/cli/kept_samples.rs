//! `--keep-samples` and `--resume`: a picture of paths that goes on is the one of a run that never stopped.

use crate::person::Folder;
use std::fs;
#[cfg(unix)]
use std::io::{BufRead, BufReader};
#[cfg(unix)]
use std::process::{Command, Stdio};

const WORDS: &str = "render phantom:head,n=24 --technique pathtrace --size 24x20";

#[test]
fn a_picture_that_goes_on_is_that_of_one_run() {
    let folder = Folder::new();
    let read = |name: &str| fs::read(folder.path(name)).expect("a file");
    for (more, name) in [("", "plain"), ("--denoise-picture", "clear")] {
        folder
            .run(&format!("{WORDS} {more} --spp 28 -o {name}.npy"))
            .assert_done();
    }
    // Neither ends with a block of paths; the second changes nothing that samples depend on.
    let ran = folder.run(&format!("{WORDS} --spp 3 --keep-samples s -o a.npy"));
    ran.assert_done();
    let ran = folder.run(&format!(
        "{WORDS} --spp 17 --keep-samples s --resume --exposure 1 -o b.png"
    ));
    ran.assert_done();
    assert!(ran.err.contains("2 paths a pixel are there"), "{}", ran.err);
    let ran = folder.run(&format!(
        "{WORDS} --spp 28 --keep-samples s --resume -o c.npy"
    ));
    ran.assert_done();
    assert!(ran.err.contains("paths a pixel are there"), "{}", ran.err);
    assert!(read("c.npy") == read("plain.npy"));
    // Once more: all of them are there, and the picture of the run before is replaced.
    fs::write(folder.path("c.npy"), "worse").expect("a file");
    folder
        .run(&format!(
            "{WORDS} --spp 28 --keep-samples s --resume --denoise-picture -o c.npy"
        ))
        .assert_done();
    assert!(read("c.npy") == read("clear.npy"));
    // It is of this file alone.
    let ran = folder.run(&format!(
        "{WORDS} --spp 28 --keep-samples s --resume -o a.npy"
    ));
    ran.assert_refused(4, &["a.npy", "--force"]);
    // Nothing to go on with: from the beginning.
    folder
        .run(&format!(
            "{WORDS} --spp 28 --keep-samples new --resume -o d.npy"
        ))
        .assert_done();
    assert!(
        read("d.npy") == read("plain.npy")
            && read("new") == {
                fs::remove_file(folder.path("s")).expect("a file");
                folder
                    .run(&format!(
                        "{WORDS} --spp 28 --keep-samples s --force -o d.npy"
                    ))
                    .assert_done();
                read("s")
            }
    );
}

/// Layers, and the filter that takes noise out, are of all paths too.
#[test]
fn layers_go_on_and_those_that_were_not_kept_are_refused() {
    let folder = Folder::new();
    let read = |name: &str| fs::read(folder.path(name)).expect("a file");
    let wanted = "--aov direct,bounces,depth,noise";
    folder
        .run(&format!("{WORDS} --spp 28 {wanted} -o one.exr"))
        .assert_done();
    let keep = format!("{WORDS} --keep-samples s");
    folder
        .run(&format!("{keep} --spp 11 {wanted} -o a.exr"))
        .assert_done();
    let ran = folder.run(&format!("{keep} --spp 28 --resume {wanted} -o b.exr"));
    ran.assert_done();
    assert!(ran.err.contains("10 paths a pixel are there") || ran.err.contains("8 paths"));
    assert!(read("b.exr") == read("one.exr"));
    // Guides are kept whatever is wanted, other layers are not.
    let again = format!("{keep} --spp 28 --resume -o c.exr --aov");
    folder.run(&format!("{again} albedo,normal")).assert_done();
    let ran = folder.run(&format!("{again} indirect,direct,emission"));
    ran.assert_refused(
        2,
        &["s keeps no sums of --aov indirect,emission", "--force"],
    );
    folder
        .run(&format!("{again} indirect --force"))
        .assert_done();
    // One kind of layer alone takes as much as its images do.
    let head = 80 + 2 * 64;
    let pixels = 24 * 20;
    let length = |name: &str| read(name).len();
    folder
        .run(&format!("{WORDS} --spp 4 --keep-samples t -o t.png"))
        .assert_done();
    folder
        .run(&format!(
            "{WORDS} --spp 4 --keep-samples u --aov direct -o u.exr"
        ))
        .assert_done();
    assert!((head * pixels..head * pixels + 8192).contains(&length("t")));
    let more = length("u") - length("t");
    assert!((64 * pixels..64 * pixels + 64).contains(&more), "{more}");
}

#[test]
fn samples_of_another_picture_are_refused_by_what_is_other() {
    let folder = Folder::new();
    let keep = format!("{WORDS} --spp 4 --keep-samples s");
    folder.run(&format!("{keep} -o a.png")).assert_done();
    let samples = fs::read(folder.path("s")).expect("a file");
    folder
        .run(&format!("{keep} -o b.png"))
        .assert_refused(4, &["--resume", "--force"]);
    let again = format!("{keep} --resume -o b.png");
    for (more, said) in [
        ("--seed 3", "`scene.path.seed` was null, is 3"),
        ("--zoom 2", "`scene.camera."),
        ("--light 1,0,0", "`scene.light.light`"),
        ("--phase hg:0.3", "`scene.path.phase`"),
        ("--environment 1,1,1 --background environment", "`scene."),
        ("--filter nearest", "`scene."),
        ("--clip 1,0,0,0", "`scene."),
    ] {
        let ran = folder.run(&format!("{again} {more}"));
        ran.assert_refused(2, &[said, "s:", "--force begins anew"]);
    }
    folder
        .run(&again.replace("24x20", "20x20"))
        .assert_refused(2, &["`scene.picture.size` was \"24x20\", is \"20x20\""]);
    let other = again.replace("n=24", "n=20");
    folder.run(&other).assert_refused(2, &["`volume` was"]);
    folder
        .run(&again.replace("--spp 4", "--spp 3"))
        .assert_refused(2, &["has 4 samples a pixel, and --spp is 3"]);
    assert!(fs::read(folder.path("s")).expect("a file") == samples);
    folder
        .run(&format!("{again} --seed 3 --force"))
        .assert_done();
    assert!(fs::read(folder.path("s")).expect("a file") != samples);
}

#[test]
fn a_file_that_holds_no_samples_is_refused() {
    let folder = Folder::new();
    let keep = format!("{WORDS} --spp 2 --keep-samples s");
    folder.run(&format!("{keep} -o a.png")).assert_done();
    let whole = fs::read(folder.path("s")).expect("a file");
    let with = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = whole.clone();
        change(&mut bytes);
        bytes
    };
    let at = b"stratavox samples\n".len();
    for (bytes, said) in [
        (b"no samples".to_vec(), "it holds no samples"),
        (with(&|b| b[at] = 9), "samples of version 9"),
        (with(&|b| b[at + 7] = 255), "bytes of words"),
        (with(&|b| b[at + 8] = b'!'), "its words"),
        (
            with(&|b| b.truncate(at)),
            "wanted 26 bytes or more, found 18",
        ),
        (with(&|b| b.truncate(at + 13)), "bytes or more, found 31"),
        (with(&|b| b.truncate(b.len() - 1)), "wanted"),
        (with(&|b| b.push(0)), "wanted"),
        (
            with(&|b| *b.iter_mut().nth_back(99).expect("a byte") ^= 1),
            "damaged",
        ),
        (with(&|b| *b.last_mut().expect("a byte") ^= 1), "damaged"),
    ] {
        fs::write(folder.path("s"), bytes).expect("a file");
        let ran = folder.run(&format!("{keep} --resume -o b.png"));
        ran.assert_refused(3, &["cannot read s", said]);
    }
}

#[test]
fn samples_are_kept_of_one_picture_of_paths_of_a_device() {
    let folder = Folder::new();
    let sphere = "render phantom:sphere,n=8 --size 8x8 -o a.png";
    for (words, said) in [
        ("--keep-samples s", "--technique pathtrace"),
        ("--technique pathtrace --resume", "--keep-samples"),
        (
            "--technique pathtrace --keep-samples s --repeat 2",
            "--repeat",
        ),
        (
            "--technique pathtrace --keep-samples s --refine",
            "--refine",
        ),
        (
            "--technique pathtrace --keep-samples s --device reference",
            "--device reference",
        ),
        ("--technique pathtrace --keep-samples a.png", "twice"),
    ] {
        let ran = folder.run(&format!("{sphere} {words}"));
        ran.assert_refused(2, &[said]);
    }
    let ran = folder.run(&format!(
        "{sphere} --technique pathtrace --keep-samples none/s"
    ));
    ran.assert_refused(4, &["no folder"]);
}

/// An interrupt keeps whole blocks, and a run that goes on is one that never stopped.
#[cfg(unix)]
#[test]
fn an_interrupt_keeps_samples() {
    let folder = Folder::new();
    let mut child = folder
        .command(&format!(
            "{WORDS} --spp 1000000 --keep-samples s --progress json -o a.npy"
        ))
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let mut stderr = BufReader::new(child.stderr.take().expect("a pipe")).lines();
    let begun = stderr
        .by_ref()
        .map_while(Result::ok)
        .find(|line| line.contains("\"part\""));
    assert!(begun.is_some(), "nothing is drawn");
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.expect("kill runs").success());
    let said: Vec<String> = stderr.map_while(Result::ok).collect();
    assert_eq!(child.wait().expect("an end").code(), Some(130), "{said:?}");
    let ran = folder.run(&format!(
        "{WORDS} --spp 1000000 --keep-samples s --resume --seconds 0.000001 -o a.npy"
    ));
    ran.assert_done();
    let (before, _) = ran
        .err
        .split_once(" paths a pixel are there")
        .expect("samples are there");
    let number = before.rsplit(|c: char| !c.is_ascii_digit()).next();
    let there: u32 = number.and_then(|n| n.parse().ok()).expect("a number");
    let more = there + 5;
    folder
        .run(&format!(
            "{WORDS} --spp {more} --keep-samples s --resume -o a.npy"
        ))
        .assert_done();
    folder
        .run(&format!("{WORDS} --spp {more} -o b.npy"))
        .assert_done();
    let read = |name| fs::read(folder.path(name)).expect("a file");
    assert!(read("a.npy") == read("b.npy"), "{there} paths");
}
