//! The examples draw what they promise, and each of their barriers is needed.

#[cfg(all(feature = "phantoms", feature = "png"))]
#[path = "../../examples/embed.rs"]
#[allow(dead_code, reason = "its `main` is not called")]
mod embed_example;
#[cfg(all(feature = "phantoms", feature = "png"))]
#[path = "../../examples/meshes/main.rs"]
#[allow(dead_code, reason = "its `main` is not called")]
mod meshes_example;
#[cfg(all(feature = "phantoms", feature = "png", target_os = "linux"))]
#[path = "../missing_barrier/mod.rs"]
mod missing_barrier;

#[cfg(all(feature = "phantoms", feature = "png"))]
mod embed;
#[cfg(all(feature = "phantoms", feature = "png", target_os = "linux"))]
mod example_barriers;
#[cfg(all(feature = "phantoms", feature = "png"))]
mod meshes;
