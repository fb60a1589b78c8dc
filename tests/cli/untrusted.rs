//! `--untrusted`: the same pictures and words, by a reader that the system holds to limits.
#![cfg(target_os = "linux")]

use super::person::{Folder, Ran};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// A file with what follows its name.
fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures")
        .join(name)
}

/// Notes of the two runs, without the line that says where the output is.
fn notes(ran: &Ran) -> Vec<&str> {
    ran.err.lines().collect()
}

#[test]
fn what_is_read_elsewhere_is_the_same_in_every_verb() {
    let folder = Folder::new();
    let files = [
        "npy/fortran-i2-be.npy",
        "npy/colors.npy",
        "tiff/ome-ctzyx.ome.tif",
        "netcdf/packed.nc --variable t",
        "hdf5/earliest.h5 --variable a",
        "dicom/deflated_i16.dcm",
    ];
    let mut compared = 0;
    for file in files {
        let input = fixture(file).display().to_string();
        for (words, output) in [
            ("info INPUT --json", None),
            ("info INPUT", None),
            (
                "render INPUT --device reference --size 16x16 -o a.png --force --time 0",
                Some("a.png"),
            ),
            ("convert INPUT -o a.nrrd --force", Some("a.nrrd")),
            (
                "animate INPUT --device reference --size 16x16 --turntable 2 -o a.gif --force",
                Some("a.gif"),
            ),
            ("histogram INPUT -o a.svg --force", Some("a.svg")),
        ] {
            let words = words.replace("INPUT", &input);
            let run = |words: &str| {
                let ran = folder.run(words);
                let bytes = output.and_then(|name| std::fs::read(folder.path(name)).ok());
                if let Some(name) = output {
                    let _ = std::fs::remove_file(folder.path(name));
                }
                (ran, bytes)
            };
            let (plain, bytes) = run(&words);
            let (other, same) = run(&format!("{words} --untrusted"));
            assert_eq!(
                plain.code, other.code,
                "{words}: {} {}",
                plain.err, other.err
            );
            assert_eq!(plain.out, other.out, "{words}");
            assert_eq!(notes(&plain), notes(&other), "{words}");
            assert_eq!(bytes, same, "{words}");
            compared += usize::from(plain.code == 0);
        }
    }
    println!("{compared} runs compared");
    assert!(compared >= 30, "only {compared} runs did anything");
}

#[test]
fn many_volumes_at_once_are_read_elsewhere_too() {
    let folder = Folder::new();
    for name in ["i2-be.npy", "fortran-times.npy"] {
        std::fs::copy(fixture("npy").join(name), folder.path(name)).expect("a copy");
    }
    for (out, flag) in [("one", ""), ("two", "--untrusted")] {
        std::fs::create_dir(folder.path(out)).expect("a folder");
        let words = format!(
            "thumbnails i2-be.npy fortran-times.npy --size 16x16 --device reference -o {out} {flag}"
        );
        folder.run(&words).assert_done();
    }
    let read = |name: &str| std::fs::read(folder.path(name)).expect("a picture");
    assert_eq!(read("one/i2-be.png"), read("two/i2-be.png"));
    assert_eq!(read("one/fortran-times.png"), read("two/fortran-times.png"));
}

#[test]
fn errors_of_files_are_the_same_words() {
    let folder = Folder::new();
    folder.file(
        "cut.npy",
        &std::fs::read(fixture("npy/times.npy")).expect("a file")[..150],
    );
    folder.file("text.txt", "no volume");
    for words in ["info cut.npy", "info text.txt", "render cut.npy -o a.png"] {
        let plain = folder.run(words);
        let other = folder.run(&format!("{words} --untrusted"));
        assert_eq!(
            (plain.code, &plain.err),
            (other.code, &other.err),
            "{words}"
        );
        assert_eq!(plain.code, 3, "{}", plain.err);
    }
}

#[test]
fn a_reader_that_loops_or_eats_memory_is_stopped() {
    let folder = Folder::new();
    std::fs::copy(fixture("npy/i2-be.npy"), folder.path("a.npy")).expect("a copy");
    for (fault, words) in [("loop", "processor time"), ("allocate", "more memory")] {
        for verb in [
            "info a.npy",
            "render a.npy -o a.png --device reference",
            "convert a.npy -o a.nrrd",
        ] {
            let start = Instant::now();
            let mut command = folder.command(&format!("{verb} --untrusted"));
            let output = command
                .env("STRATAVOX_READER_FAULT", fault)
                .output()
                .expect("a run");
            let err = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(6), "{fault} {verb}: {err}");
            assert!(
                err.contains("cannot read a.npy") && err.contains(words),
                "{err}"
            );
            assert!(start.elapsed().as_secs() < 60, "{fault} {verb}");
        }
    }
    assert_eq!(folder.names(), ["a.npy"]);
}

/// True where the kernel has Landlock: it gives the version of the interface, and an error where there is none.
fn has_landlock() -> bool {
    const VERSION: libc::c_ulong = 1;
    let nothing = std::ptr::null::<libc::c_void>();
    // SAFETY: with this flag the call takes no pointer and no length, and changes nothing.
    let version = unsafe { libc::syscall(libc::SYS_landlock_create_ruleset, nothing, 0, VERSION) };
    version > 0
}

#[test]
fn a_reader_opens_nothing_but_its_input_and_that_for_reading() {
    let folder = Folder::new();
    std::fs::copy(fixture("npy/i2-be.npy"), folder.path("a.npy")).expect("a copy");
    let plain = folder.run("info a.npy --untrusted");
    plain.assert_done();
    if !has_landlock() {
        println!("skipped: this kernel has no Landlock");
        return;
    }
    for fault in ["read", "write"] {
        let mut command = folder.command("info a.npy --untrusted");
        let output = command.env("STRATAVOX_READER_FAULT", fault).output();
        let output = output.expect("a run");
        // A reader that gets at the file ends at once.
        let err = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{fault}: {err}");
        assert_eq!(String::from_utf8_lossy(&output.stdout), plain.out);
    }
}

#[test]
fn folders_are_read_by_a_reader_that_opens_nothing_else() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("slices")).expect("a folder");
    for name in ["rle_i16.dcm", "implicit_i16.dcm"] {
        let to = folder.path("slices").join(name);
        std::fs::copy(fixture("dicom").join(name), to).expect("a copy");
    }
    for words in ["info slices", "info nowhere", "info slices/rle_i16.dcm"] {
        let plain = folder.run(words);
        let other = folder.run(&format!("{words} --untrusted"));
        assert_eq!(
            (plain.code, &plain.out, &plain.err),
            (other.code, &other.out, &other.err),
            "{words}"
        );
    }
}
