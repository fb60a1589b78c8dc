//! A conversion that cannot be done leaves everything as it was: what is there is kept, nothing half is left.

use crate::{convert::askew, person::Folder};

#[test]
fn what_is_there_is_kept_and_an_input_is_never_an_output() {
    let folder = Folder::new();
    let path = askew(&folder);
    let before = std::fs::read(&path).expect("a file");
    folder
        .run("convert askew.mha -o askew.mha --force")
        .assert_refused(4, &["it is an input"]);
    folder.file("out.nrrd", "mine");
    folder
        .run("convert askew.mha -o out.nrrd")
        .assert_refused(4, &["exists", "--force"]);
    assert_eq!(
        std::fs::read(folder.path("out.nrrd")).expect("a file"),
        b"mine"
    );
    folder
        .run("convert askew.mha -o none/out.nrrd")
        .assert_refused(4, &["none"]);
    assert_eq!(std::fs::read(&path).expect("a file"), before);
    folder
        .run("convert askew.mha -o out.nrrd --force")
        .assert_done();
    assert_eq!(folder.names(), ["askew.mha", "out.nrrd"]);
}

#[test]
fn words_that_cannot_be_followed_are_refused_and_leave_nothing() {
    let folder = Folder::new();
    for (words, name) in [
        ("convert phantom:fog,n=8", "--output"),
        ("convert phantom:fog,n=8 -o a.png", "a.png"),
        ("convert phantom:fog,n=8 -o .nrrd", ".nrrd"),
        (
            "convert phantom:fog,n=8 -o a.nrrd --crop 0,9,0,8,0,8",
            "--crop 0,9",
        ),
        (
            "convert phantom:fog,n=8 -o a.nrrd --crop 0,0,0,8,0,8",
            "--crop",
        ),
        (
            "convert phantom:fog,n=8 -o a.nrrd --crop -1,3,0,8,0,8",
            "--crop",
        ),
        (
            "convert phantom:fog,n=8 -o a.nrrd --crop 0.5,3,0,8,0,8",
            "--crop",
        ),
        ("convert phantom:fog,n=8 -o a.nrrd --type u7", "--type"),
        ("convert phantom:fog,n=8 -o a.nrrd --window 1,2", "--type"),
        (
            "convert phantom:fog,n=8 -o a.nrrd --type u8 --window 2,1",
            "--window 2,1",
        ),
        ("convert phantom:fog,n=8 -o a.nrrd --time 7", "--time 7"),
        ("convert phantom:storm,n=8 -o a.nrrd", "--variable"),
    ] {
        let ran = folder.run(words);
        assert_eq!(ran.code, 2, "{words}: {ran:?}");
        assert!(ran.err.contains(name), "{words}: {ran:?}");
    }
    folder
        .run("convert none.nrrd -o a.nrrd")
        .assert_refused(3, &["none.nrrd"]);
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

#[test]
fn a_source_that_breaks_off_leaves_no_file() {
    let folder = Folder::new();
    let head = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 64 64 64\nencoding: gzip\n\n";
    folder
        .run("convert phantom:fog,n=64,type=u8 -o whole.nrrd")
        .assert_done();
    let whole = std::fs::read(folder.path("whole.nrrd")).expect("a file");
    let at = whole
        .windows(2)
        .position(|two| two == b"\n\n")
        .expect("a header")
        + 2;
    folder.file(
        "cut.nrrd",
        [head.as_bytes(), &whole[at..whole.len() - 4]].concat(),
    );
    let ran = folder.run("convert cut.nrrd -o out.mha");
    ran.assert_refused(3, &["cut.nrrd"]);
    assert_eq!(folder.names(), ["cut.nrrd", "whole.nrrd"]);
}

#[test]
#[cfg(unix)]
fn a_disk_that_takes_no_more_and_an_interrupt_leave_no_file() {
    use std::io::BufRead;
    let folder = Folder::new();
    let limited = std::process::Command::new("sh")
        .arg("-c")
        .arg(format!(
            "ulimit -f 8; exec {} convert phantom:fog,n=64 -o out.npy",
            env!("CARGO_BIN_EXE_stratavox")
        ))
        .current_dir(folder.path("."))
        .output()
        .expect("a shell");
    assert_eq!(limited.status.code(), Some(4), "{limited:?}");
    assert!(folder.names().is_empty(), "{:?}", folder.names());

    let mut child = folder
        .command("convert phantom:shells,n=400 -o out.nrrd --progress json")
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("the program runs");
    let stderr = std::io::BufReader::new(child.stderr.take().expect("a pipe"));
    let writing = stderr
        .lines()
        .map_while(Result::ok)
        .find(|line| line.contains("\"write\""));
    assert!(writing.is_some(), "the program writes nothing");
    assert_eq!(
        folder.names().len(),
        1,
        "an unfinished file: {:?}",
        folder.names()
    );
    let kill = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.expect("kill runs").success());
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}
