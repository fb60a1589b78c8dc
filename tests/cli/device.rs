//! The Vulkan device: chosen by words, listed, and named when it is not there.

use crate::person::Folder;
use serde_json::Value;

#[test]
fn devices_are_listed_with_what_they_can_do() {
    let folder = Folder::new();
    let ran = folder.run("devices --json");
    ran.assert_done();
    let list: Value = serde_json::from_str(&ran.out).expect("JSON");
    let device = &list["devices"][0];
    for key in [
        "index",
        "name",
        "kind",
        "uuid",
        "vulkan",
        "driver",
        "memory_bytes",
        "usable",
        "abilities",
    ] {
        assert!(!device[key].is_null(), "no {key} in {list}");
    }
    let name = device["name"].as_str().expect("a name");
    assert!(folder.run("devices").out.contains(name), "{name}");
}

#[test]
fn a_device_that_is_not_here_exits_5_and_those_that_are_here_are_named() {
    let folder = Folder::new();
    let ran = folder.run("render phantom:fog,n=8 -o a.png --size 8x8 --device nobodys-card");
    ran.assert_refused(5, &["nobodys-card", "there are", "hint"]);
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

#[test]
fn a_machine_without_a_driver_exits_5_and_can_still_draw_by_the_reference() {
    let folder = Folder::new();
    let without_driver = |words: &str| {
        let mut command = folder.command(words);
        command
            .env("VK_DRIVER_FILES", "/nowhere.json")
            .env("VK_ICD_FILENAMES", "/nowhere.json");
        command.output().expect("the program runs")
    };
    let output = without_driver("render phantom:fog,n=8 -o a.png --size 8x8");
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(5), "{err}");
    assert!(
        err.contains("no Vulkan device") && err.contains("--device reference"),
        "{err}"
    );
    let output = without_driver("render phantom:fog,n=8 -o a.png --size 8x8 --device reference");
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn the_device_draws_what_the_reference_draws() {
    let folder = Folder::new();
    for technique in ["raycast", "slices-3d", "slices-2d"] {
        for mode in ["composite", "mip"] {
            let words = format!(
                "render phantom:gauss,n=16 --size 32x24 --force --technique {technique} --mode {mode} --conformance"
            );
            folder.run(&format!("{words} -o a.npy")).assert_done();
            folder
                .run(&format!("{words} -o b.npy --device reference"))
                .assert_done();
            // Rounding of some tens of blends in f32; the CPU references themselves are held tighter elsewhere.
            folder
                .run("compare a.npy b.npy --at-most 0.0001")
                .assert_done();
        }
    }
}
