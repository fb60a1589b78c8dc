//! What becomes of the viewer when its surface, its device or the size of its window is gone. `failing/layer.c` stands
//! between it and the validation layer.
#![cfg(target_os = "linux")]

mod display;
#[path = "../../../tests/layer/mod.rs"]
mod layer;

use display::{Display, skipped, texts};
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;
use tempfile::TempDir;

const NAME: &str = "VK_LAYER_STRATAVOX_failing";
const SURFACE_LOST: i32 = -1_000_000_000;
const OUT_OF_DATE: i32 = -1_000_001_004;
const DEVICE_LOST: i32 = -4;

/// The layer, built; `None` where that cannot be.
fn layer(folder: &Path) -> Option<()> {
    match layer::build(folder, NAME, include_str!("failing/layer.c")) {
        true => Some(()),
        false => skipped(layer::UNBUILT),
    }
}

/// A viewer of which call number `at` of `name` ends so.
fn viewer(display: &Display, folder: &Path, (name, at, with): (&str, u32, i32)) -> Command {
    let mut viewer = display.viewer(folder);
    viewer
        .args(["phantom:head,n=16", "--bare", "--validation", "sync"])
        .args(["--size", "96x72"])
        .env("VK_ADD_LAYER_PATH", folder)
        .env("VK_INSTANCE_LAYERS", NAME)
        .env("FAILING_CALL", name)
        .env("FAILING_AT", at.to_string())
        .env("FAILING_WITH", with.to_string());
    viewer
}

fn play(display: &Display, folder: &Path, fails: (&str, u32, i32)) -> (Output, String) {
    let script = folder.join("script.txt");
    fs::write(&script, "frames 4\npicture p.png\nwindow w.png\n").unwrap();
    let mut viewer = viewer(display, folder, fails);
    let output = viewer.arg("--script").arg(script).output().unwrap();
    let text = texts(&output);
    assert!(text.contains(&format!("failing: {}", fails.0)), "{text}");
    assert!(!text.contains("Validation Error"), "{text}");
    (output, text)
}

#[test]
fn a_surface_that_is_lost_is_made_anew_and_one_out_of_date_too() {
    let folder = TempDir::new().unwrap();
    let (Some(display), Some(())) = (Display::new(), layer(folder.path())) else {
        return;
    };
    let pictures = || ["p.png", "w.png"].map(|name| fs::read(folder.path().join(name)).unwrap());
    // The first call of all: nothing fails later.
    let (output, text) = play(
        &display,
        folder.path(),
        ("vkAcquireNextImageKHR", 1, OUT_OF_DATE),
    );
    assert!(output.status.success(), "{text}");
    let wanted = pictures();
    for fails in [
        ("vkAcquireNextImageKHR", 3, SURFACE_LOST),
        ("vkQueuePresentKHR", 2, SURFACE_LOST),
        ("vkQueuePresentKHR", 3, OUT_OF_DATE),
        ("vkAcquireNextImageKHR", 1, SURFACE_LOST),
    ] {
        let (output, text) = play(&display, folder.path(), fails);
        assert!(output.status.success(), "{fails:?}: {text}");
        assert!(pictures() == wanted, "{fails:?}: other pictures");
    }
    // Its window's images cannot be made at all.
    let (output, text) = play(
        &display,
        folder.path(),
        ("vkCreateSwapchainKHR", 1, SURFACE_LOST),
    );
    assert_eq!(output.status.code(), Some(5), "{text}");
    assert!(text.contains("surface was lost"), "{text}");
}

#[test]
fn a_device_that_is_lost_ends_the_viewer_with_a_sentence() {
    let folder = TempDir::new().unwrap();
    let (Some(display), Some(())) = (Display::new(), layer(folder.path())) else {
        return;
    };
    for (name, at) in [
        ("vkQueueSubmit2", 1),
        ("vkQueueSubmit2", 3),
        ("vkAcquireNextImageKHR", 2),
        ("vkQueuePresentKHR", 2),
    ] {
        let (output, text) = play(&display, folder.path(), (name, at, DEVICE_LOST));
        assert_eq!(output.status.code(), Some(5), "{name} {at}: {text}");
        assert!(
            text.contains("the device was lost while"),
            "{name} {at}: {text}"
        );
        assert!(!text.contains("panicked"), "{name} {at}: {text}");
    }
}

#[test]
fn a_window_without_a_size_draws_nothing_until_it_has_one() {
    let folder = TempDir::new().unwrap();
    let (Some(display), Some(())) = (Display::new(), layer(folder.path())) else {
        return;
    };
    if Command::new("xdotool").arg("version").output().is_err() {
        skipped::<()>("there is no xdotool");
        return;
    }
    let tool = |words: &[&str]| {
        let mut command = Command::new("xdotool");
        let output = command.args(words).env("DISPLAY", &display.name).output();
        let output = output.unwrap();
        assert!(output.status.success(), "{words:?}: {}", texts(&output));
        String::from_utf8(output.stdout).unwrap().trim().to_owned()
    };
    // The second time that it is asked for its size: that is after the first resizing.
    let fails = ("vkGetPhysicalDeviceSurfaceCapabilitiesKHR", 2, 0);
    let running = viewer(&display, folder.path(), fails)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let window = tool(&["search", "--sync", "--onlyvisible", "--name", "stratavox"]);
    let rest = || std::thread::sleep(Duration::from_millis(1000));
    rest();
    tool(&["windowsize", &window, "120", "90"]);
    rest();
    // Now it has a size again, is tiny, is away, and comes back.
    tool(&["windowsize", &window, "1", "1"]);
    rest();
    tool(&["windowunmap", &window]);
    rest();
    tool(&["windowmap", &window]);
    tool(&["windowsize", &window, "140", "100"]);
    rest();
    tool(&["windowfocus", &window]);
    tool(&["key", "--window", &window, "shift+s"]);
    rest();
    tool(&["key", "--window", &window, "q"]);
    let output = running.wait_with_output().unwrap();
    let text = texts(&output);
    assert!(output.status.success(), "{text}");
    assert!(text.contains("failing: "), "{text}");
    let shown =
        stratavox::picture::read_image(&folder.path().join("head-n-16-window.png")).unwrap();
    assert_eq!([shown.width, shown.height], [140, 100]);
}
