//! A volume renderer that speaks Vulkan: two texture slicers, a ray caster and
//! maximum intensity projection, each with a CPU twin and an exact answer.
//!
//! # Floors
//!
//! A module uses lower floors only; `tests/floors.rs` holds us to it.
//!
//! | floor | modules | what they know |
//! |---|---|---|
//! | 0 | [`shaders`], [`real`], [`ray`], [`lattice`], [`color`] | arithmetic shared with the shaders, free of Vulkan |
//! | 1 | [`gpu`], [`volume`], [`transfer`], [`camera`], [`picture`] | Vulkan objects, or data; never both |
//! | 2 | [`resident`], `format` | data put on a device; bytes of files turned into a [`volume::Source`] |
//! | 3 | [`technique`], [`resolve`] | `new`, `bind`, `record`, and the CPU twins |
//! | 4 | [`scene`], [`offscreen`] | a scene to a [`picture::Picture`]; the only place that submits and waits |
//! | 5 | `cli` | words to scenes, errors to exit codes |
//!
//! # Spaces
//!
//! - **voxel**: continuous grid coordinates; voxel (i, j, k) covers `[i, i+1)` on each axis, its centre is at +0.5.
//! - **texture**: voxel / dims, the unit cube.
//! - **world**: right-handed, in the file's unit (millimetres for medical files, RAS+).
//! - **view, clip, ndc, pixel**: Vulkan's, y down, depth 0 to 1. A pixel is sampled at its centre.
//!
//! A transform is named `target_from_source`. A ray keeps one parameter `t` in world length in every
//! space: directions are transformed and never normalized again.
//!
//! # What holds everywhere
//!
//! Recording creates, destroys and waits for nothing. Only `gpu/headless.rs` makes a device. Files are
//! touched by `format`, `picture` and `transfer/file.rs`, by the program, and by `gpu/cache.rs`, which keeps
//! compiled pipelines. There is no global state. The same inputs give the same bytes.
//!
//! # Where a pixel comes from
//!
//! [`technique::View::recordings`] sets the parameters, `shaders/raycast.wgsl` (or a slicer's) walks the ray,
//! `shaders/lib/mode_*.wgsl` says what a sample adds, `shaders/resolve.wgsl` makes it a colour, and
//! [`offscreen::Renderer::render`] (or a host) puts the passes in order.

pub mod camera;
#[cfg(feature = "cli")]
pub mod cli;
pub mod color;
#[cfg(feature = "files")]
pub mod format;
pub mod gpu;
pub mod lattice;
pub mod offscreen;
pub mod picture;
pub mod ray;
pub mod real;
pub mod resident;
pub mod resolve;
pub mod scene;
pub mod shaders;
pub mod technique;
pub mod transfer;
pub mod volume;

/// The example of the README compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
