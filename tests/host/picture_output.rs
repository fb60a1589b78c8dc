//! Picture files appear whole or not at all.

#![cfg(all(feature = "png", feature = "exr"))]

#[allow(dead_code, reason = "each file of tests uses some of it")]
use crate::picture_shared;

use picture_shared::{EIGHT, FORCE, names, picture, rich};
use std::path::{Path, PathBuf};
use std::process::Command;
use stratavox::picture::{OutputProblem, Picture, read_image, write_picture};

#[test]
fn an_existing_file_stays_unless_forced() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.png", "a.exr", "a.npy"] {
        let path = folder.path().join(name);
        std::fs::write(&path, "mine").unwrap();
        let error = write_picture(&rich(), &path, EIGHT).unwrap_err();
        assert!(matches!(error.problem, OutputProblem::Exists), "{error}");
        assert_eq!(std::fs::read(&path).unwrap(), b"mine", "{name}");
        write_picture(&rich(), &path, FORCE).unwrap();
        assert!(read_image(&path).is_ok(), "{name}");
    }
    assert!(
        names(folder.path())
            .iter()
            .all(|name| !name.ends_with(".part"))
    );
}

#[test]
fn an_existing_layer_file_keeps_the_picture_from_being_written() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.samples.npy"), "mine").unwrap();
    let error = write_picture(&rich(), &folder.path().join("a.npy"), EIGHT).unwrap_err();
    assert!(error.path.ends_with("a.samples.npy"), "{error}");
    assert_eq!(names(folder.path()), ["a.samples.npy"]);
}

#[test]
fn places_that_take_no_file_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| write_picture(&rich(), &folder.path().join(name), EIGHT).unwrap_err();
    let missing = at("nowhere/a.png");
    assert!(
        matches!(missing.problem, OutputProblem::NoFolder(_)),
        "{missing}"
    );
    assert!(missing.to_string().contains("nowhere"), "{missing}");
    std::fs::create_dir(folder.path().join("b.png")).unwrap();
    assert!(matches!(at("b.png").problem, OutputProblem::IsFolder));
    for name in ["a.jpg", "a", "a.png.gz"] {
        let error = at(name);
        assert!(
            matches!(error.problem, OutputProblem::Extension(_)),
            "{error}"
        );
    }
    let torn = Picture { width: 4, ..rich() };
    let error = write_picture(&torn, &folder.path().join("c.npy"), EIGHT).unwrap_err();
    assert!(
        matches!(error.problem, OutputProblem::Size { .. }),
        "{error}"
    );
    let empty = Picture {
        height: 0,
        pixels: vec![],
        ..picture(1, vec![[0.0; 4]])
    };
    let error = write_picture(&empty, &folder.path().join("c.png"), EIGHT).unwrap_err();
    assert!(matches!(error.problem, OutputProblem::Encode(_)), "{error}");
    assert_eq!(names(folder.path()), ["b.png"]);
}

#[cfg(unix)]
#[test]
fn a_new_file_has_the_rights_that_the_users_mask_leaves() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npy");
    write_picture(&picture(1, vec![[0.0; 4]]), &path, EIGHT).unwrap();
    let plain = folder.path().join("plain");
    std::fs::write(&plain, "").unwrap();
    let mode = |path: &Path| path.metadata().unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&plain), "{:o}", mode(&path));
}

/// Writes 64 x 64 pixels (64 KiB) to the path in the environment; a test only for the one below.
#[test]
fn write_where_told() {
    let Some(path) = std::env::var_os("STRATAVOX_TEST_WRITE_TO").map(PathBuf::from) else {
        return;
    };
    let error = write_picture(&picture(64, vec![[0.5; 4]; 64 * 64]), &path, FORCE).unwrap_err();
    assert!(
        matches!(
            error.problem,
            OutputProblem::Write {
                wanted_bytes: 65_664,
                ..
            }
        ),
        "{error}"
    );
}

#[cfg(unix)]
#[test]
fn a_file_that_finds_no_room_leaves_the_old_one_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npy");
    std::fs::write(&path, "mine").unwrap();
    // The limit ends a write early and then refuses it, as a full disk does.
    let output = Command::new("sh")
        .args([
            "-c",
            "trap '' XFSZ; ulimit -f 16; exec \"$0\" --exact write_where_told",
        ])
        .arg(std::env::current_exe().unwrap())
        .env("STRATAVOX_TEST_WRITE_TO", &path)
        // Through pipes: the limit would hold for a log file too.
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "the write did not fail as it should: {}",
        String::from_utf8_lossy(&output.stdout)
    );
    assert_eq!(std::fs::read(&path).unwrap(), b"mine");
    assert_eq!(names(folder.path()), ["a.npy"]);
}
