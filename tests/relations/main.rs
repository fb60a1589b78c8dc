//! Pictures against each other: what may not change one, and how it changes with its scene.
#![cfg(feature = "conformance")]

#[path = "../shared/mod.rs"]
mod shared;
#[path = "../skipping_shared/mod.rs"]
mod skipping_shared;
#[path = "../streaming_shared/mod.rs"]
mod streaming_shared;

mod blending;
mod bricks;
mod classified_runs;
mod domain;
mod lattice;
mod macro_cells;
mod preclassified;
mod projection;
mod runs_on_device;
mod skipping;
mod skipping_beside;
mod skipping_slices;
mod skipping_voxels;
mod streaming;
mod streaming_skipped;
mod symmetry;
mod tiles;
mod warped;
