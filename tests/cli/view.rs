//! `stratavox view` where there is no viewer.

use crate::person::Folder;
use std::fs;
use std::process::Command;

#[test]
fn without_a_viewer_a_line_says_how_to_install_it() {
    let folder = Folder::new();
    // The program alone: beside that of the tests stands a viewer.
    let alone = folder.path("stratavox");
    let program = env!("CARGO_BIN_EXE_stratavox");
    if fs::hard_link(program, &alone).is_err() {
        fs::copy(program, &alone).expect("a copy");
    }
    let ran = Command::new(alone)
        .args(["view", "phantom:head"])
        .env("PATH", folder.path(""))
        .output()
        .expect("the program runs");
    let said = String::from_utf8_lossy(&ran.stderr);
    assert_eq!(ran.status.code(), Some(2), "{said}");
    assert!(said.contains("stratavox-viewer is not installed"), "{said}");
    let hint = said.lines().find(|line| line.contains("hint: "));
    let hint = hint.unwrap_or_else(|| panic!("no hint: {said}"));
    assert!(
        hint.contains("cargo install --path examples/viewer"),
        "{hint}"
    );
}
