//! Each barrier that the viewer records, its own and stratavox's, is needed: without it the validation layer speaks, but for
//! those that it cannot know of. Looked at under `STRATAVOX_VALIDATION=sync`, and skipped elsewhere: it takes a run each.
#![cfg(target_os = "linux")]

mod display;
#[path = "../../../tests/missing_barrier/mod.rs"]
mod missing_barrier;

use display::{Display, skipped};
use missing_barrier::*;
use std::fs;
use tempfile::TempDir;

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
        viewer.arg("--script").arg(&script);
        viewer.env_remove("STRATAVOX_VALIDATION");
        viewer
    };
    layer.assert_each_is_missed(program, &[]);
}
