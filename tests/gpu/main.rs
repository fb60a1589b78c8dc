//! The device layer: devices, objects, limits, submissions, and the validation that listens.
#![cfg(feature = "conformance")]

#[path = "../gpu_shared/mod.rs"]
mod gpu_shared;
#[cfg(feature = "cli")]
#[path = "../layer/mod.rs"]
mod layer;
#[path = "../shared/mod.rs"]
mod shared;

mod cost;
mod devices;
mod float_blend;
mod host;
mod limits;
mod objects;
#[cfg(feature = "cli")]
mod portability;
mod run;
mod staging;
mod validation;
