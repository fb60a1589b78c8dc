//! `stratavox::embed` in a host of its own: the frames that it records are the offscreen pictures.
#![cfg(feature = "conformance")]

#[path = "../driver_faults/mod.rs"]
mod driver_faults;
#[path = "../embed_shared/mod.rs"]
mod embed_shared;
#[allow(dead_code, reason = "its random numbers alone are wanted")]
#[path = "../shared/mutate.rs"]
mod mutate;
#[path = "../shared/mod.rs"]
mod shared;
#[path = "../skipping_shared/mod.rs"]
mod skipping_shared;

mod barriers;
mod budget;
mod depth;
mod flight;
mod formats;
mod frames;
mod geometry;
mod layouts;
mod levels;
mod noise;
mod parts;
mod patches;
mod paths;
mod pictures;
mod pieces;
mod plan;
mod several;
mod skipped;
mod slice_depth;
mod stale;
mod targets;
mod threads;
mod tone;
mod update;
