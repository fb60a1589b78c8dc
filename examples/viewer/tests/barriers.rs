//! Each barrier that the viewer records, its own and stratavox's, is needed: without it the validation layer speaks,
//! but for those that it cannot know of. Looked at under `STRATAVOX_VALIDATION=sync`, and skipped elsewhere: it takes a
//! run each.
#![cfg(target_os = "linux")]

mod display;
#[path = "../../../tests/missing_barrier/mod.rs"]
mod missing_barrier;

use display::{Display, skipped};
use missing_barrier::*;
use std::fs;
use tempfile::TempDir;

/// From a colour target to what the window shows: layers of 2023 do not look at what dynamic rendering stores, and
/// presentation waits for a semaphore.
const SHOWN: &str = "image 2 to 1000001002";
/// What the CPU reads: no layer sees that.
const COPIED_TO_HOST: &str = "buffer 1000 to 2000";

#[test]
fn each_barrier_of_a_window_is_needed() {
    if std::env::var("STRATAVOX_VALIDATION").as_deref() != Ok("sync") {
        skipped::<()>("STRATAVOX_VALIDATION=sync is not set");
        return;
    }
    let (Some(display), Some(layer)) = (Display::new(), MissingBarrier::new()) else {
        return;
    };
    let folder = TempDir::new().unwrap();
    let script = folder.path().join("script.txt");
    // One picture of the volume, copied, and the window, copied.
    fs::write(&script, "picture p.png\nwindow w.png\n").unwrap();
    let program = || {
        let mut viewer = display.viewer(folder.path());
        viewer.args(["phantom:head,n=16", "--bare", "--size", "96x72"]);
        // Nothing is drawn to fit the eye: barriers of small frames are those of offscreen pictures.
        viewer.args(["--look", "plain"]);
        viewer.arg("--script").arg(&script);
        viewer.env_remove("STRATAVOX_VALIDATION");
        viewer
    };
    let unheard = [
        STAND_IN,
        STAND_IN,
        NEXT_FUNCTION,
        LIST_BEFORE,
        PART_BEFORE,
        ORDERED_TWICE,
        // The picture of the volume and the window, of each of two frames.
        NEW_TARGET,
        NEW_TARGET,
        NEW_TARGET,
        NEW_TARGET,
        // Of the first frame, and of one that was drawn while the script went on.
        SHOWN,
        SHOWN,
        COPIED_TO_HOST,
        COPIED_TO_HOST,
    ];
    layer.assert_each_is_missed(program, &unheard);
}
