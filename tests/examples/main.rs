//! The examples draw what they promise, and each of their barriers is needed.

#[cfg(all(feature = "png", target_os = "linux"))]
#[path = "../missing_barrier/mod.rs"]
mod missing_barrier;

#[cfg(feature = "png")]
mod embed;
#[cfg(all(feature = "png", target_os = "linux"))]
mod example_barriers;
#[cfg(feature = "png")]
mod meshes;
