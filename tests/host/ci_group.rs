//! What `make test` shows of the sweeps: `.ci/group --summary`.

use std::path::Path;
use std::process::Command;

/// What the script prints in a folder of its own.
fn group(folder: &Path, words: &[&str]) -> String {
    let ran = Command::new(folder.join(".ci/group")).args(words).output();
    let ran = ran.expect("a shell");
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{words:?}: {said}");
    String::from_utf8_lossy(&ran.stdout).into_owned()
}

#[test]
fn the_summary_says_how_much_was_swept_once_and_before_the_counts() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join(".ci/group");
    if !script.is_file() {
        println!("skipped: .ci/group is no part of the package");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join(".ci")).expect("a folder");
    std::fs::copy(script, folder.path().join(".ci/group")).expect("a copy");
    // As the sweeps print them, between lines of other tests.
    let lines = "test a ... ok\n\
        11002 cuts of 331 files in 9 s, 12 of them of bytes that carry nothing, 3 between messages or arrays\n\
        npy: 700 fields, 650 refused, 9 bytes of memory, 1ms at most\n\
        6414 fields in 8 s\n\
        63 hostile files: at most 44 MiB of memory and 1.2 s\n\
        12 examples\n";
    for name in ["first", "second"] {
        group(folder.path(), &[name, "printf", "%s", lines]);
    }
    let summary = group(folder.path(), &["--summary", "first", "second"]);
    let counts = summary.find("group  ").expect("the head of the counts");
    for line in [
        "11002 cuts of 331 files",
        "6414 fields in",
        "63 hostile files:",
    ] {
        assert_eq!(summary.matches(line).count(), 1, "{line}: {summary}");
        assert!(summary.find(line) < Some(counts), "{line}: {summary}");
    }
    assert!(!summary.contains("12 examples") && !summary.contains("700 fields"));
}
