//! The examples draw what they promise, and each of their barriers is needed.

#[cfg(all(feature = "phantoms", feature = "png", target_os = "linux"))]
#[path = "../missing_barrier/mod.rs"]
mod missing_barrier;

#[cfg(all(feature = "phantoms", feature = "png"))]
mod embed;
#[cfg(all(feature = "phantoms", feature = "png", target_os = "linux"))]
mod example_barriers;
#[cfg(all(feature = "phantoms", feature = "png"))]
mod meshes;
