//! Each barrier that is recorded in the examples of hosts, theirs and ours, is needed: without it the validation layer
//! speaks, but for those that it cannot know of. Looked at only under `STRATAVOX_VALIDATION=sync`, and skipped
//! elsewhere.

use crate::missing_barrier::*;
use crate::{embed_example, meshes_example};
use std::env;
use std::process::Command;
use stratavox::gpu::{Validation, ValidationMode};
use stratavox::technique::Technique;

/// The programs, run by themselves: a process has one set of layers.
const ONE: &str = "STRATAVOX_EXAMPLE";

/// Not a test by itself: what the others run.
#[test]
fn example() {
    let folder = tempfile::tempdir().unwrap();
    match env::var(ONE).as_deref() {
        Ok("embed") => embed_example::run(&folder.path().join("sphere.png")).unwrap(),
        Ok("rays") => meshes_example::run(folder.path(), Technique::Raycast, 1).unwrap(),
        Ok("slices") => meshes_example::run(folder.path(), Technique::Slices3d, 1).unwrap(),
        _ => println!("skipped: the other tests run it"),
    }
}

fn assert_each_is_missed(name: &str, unheard: &[&str]) {
    if Validation::default().mode().unwrap() != Some(ValidationMode::Synchronization) {
        println!("skipped: STRATAVOX_VALIDATION=sync is not set");
        return;
    }
    let Some(layer) = MissingBarrier::new() else {
        return;
    };
    let program = || {
        let mut command = Command::new(env::current_exe().unwrap());
        command
            .args(["--exact", "example_barriers::example", "--nocapture"])
            .env(ONE, name);
        command.env_remove("STRATAVOX_VALIDATION");
        command
    };
    layer.assert_each_is_missed(program, unheard);
}

#[test]
fn the_smallest_host() {
    assert_each_is_missed(
        "embed",
        &[
            STAND_IN,
            STAND_IN,
            NEXT_FUNCTION,
            LIST_BEFORE,
            PART_BEFORE,
            ORDERED_TWICE,
            NEW_TARGET,
        ],
    );
}

#[test]
fn rays_among_meshes() {
    let unheard = [
        STAND_IN,
        STAND_IN,
        WRITTEN_BY_HOST,
        NEW_DEPTH,
        NEW_TARGET,
        NEXT_FUNCTION,
        LIST_BEFORE,
        PART_BEFORE,
        ORDERED_TWICE,
        SAME_TARGET,
        READ_BY_HOST,
    ];
    assert_each_is_missed("rays", &unheard);
}

#[test]
fn slices_among_meshes() {
    let unheard = [
        STAND_IN,
        STAND_IN,
        WRITTEN_BY_HOST,
        NEW_DEPTH,
        NEW_TARGET,
        // The image that slices are gathered in.
        NEW_TARGET,
        // The copy of the host's depth.
        NEW_DEPTH_COPY,
        SAME_TARGET,
        READ_BY_HOST,
    ];
    assert_each_is_missed("slices", &unheard);
}
