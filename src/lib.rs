//! A volume renderer that speaks Vulkan: two texture slicers, a ray caster and
//! maximum intensity projection, each with a CPU reference and an exact answer.
//!
//! `docs/architecture.md` is the map of the sources: where a pixel comes from, how to add a technique, a mode or a format, and a
//! glossary. `docs/sampling.md` defines what is computed.
//!
//! # Where a pixel comes from
//!
//! `format` reads a file into a [`volume::Volume`], [`resident`] puts it on the device, [`technique::View::recordings`] sets the
//! parameters, `shaders/raycast.wgsl` (or a slicer's) walks the ray, `shaders/lib/mode_*.wgsl` says what a sample adds,
//! `shaders/resolve.wgsl` makes a colour of what projects, and [`offscreen::Renderer::render`] (or a host) puts the passes in order.
//!
//! # Layers
//!
//! A module uses lower layers only, and some layers have steps inside; `tests/host/floors.rs` checks that.
//!
//! | layer | modules | what they know |
//! |---|---|---|
//! | 0 | `shaders`, `real`, `ray`, `blue_noise`, `lattice`, [`color`], `fence`, `named` | arithmetic shared with the shaders, free of Vulkan |
//! | 1 | [`gpu`], [`volume`], [`transfer`], [`camera`], [`picture`], [`mesh`], `figure` | Vulkan objects, or data; never both |
//! | 1 | [`points`] | scattered points, a volume that stands for them, and interpolation |
//! | 1 | [`flow`] | velocities, and lines that follow them |
//! | 1 | [`geometry`] | opaque lines and spheres, and what a camera sees of them |
//! | 2 | [`resident`], `isosurface`, `format` | data put on a device; a surface in a volume; bytes of files turned into a [`volume::Source`] |
//! | 3 | [`technique`], [`resolve`], `look` | `new`, `bind`, `record`, and the CPU references; what suits a volume |
//! | 4 | [`embed`] | a volume in a host's frames |
//! | 5 | [`scene`], [`offscreen`], `annotate` | a scene to a [`picture::Picture`], which it waits for; words and marks over it |
//! | 6 | `conformance` | cases with exact answers, and verdicts on devices |
//! | 7 | `cli` | words to scenes, errors to exit codes |
//! | 7 | `capi` | what [`embed`] does, for C |
//!
//! Modules and items that this documentation does not show serve the program and the tests: they are no promise, and
//! change with any version.
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
//! # How to embed
//!
//! A host keeps its device, its queues, its command buffers and its images: it gives handles to
//! [`gpu::Gpu::from_host`], and nothing is submitted or waited for behind its back. The device speaks Vulkan
//! 1.3 and has `dynamicRendering` and `synchronization2` enabled, and `timelineSemaphore` where we submit; the queues are of a family with
//! graphics and compute. [`embed`] is the way in, on three levels: draw inside the host's rendering, record into an
//! image of the host's, or let us submit.
//!
//! ```rust,no_run
//! use ash::vk;
//! use std::sync::Arc;
//! use stratavox::camera::{Camera, DepthConvention};
//! use stratavox::embed::{RendererDesc, Error, Renderer, FrameInfo, SliceBlending, Volume};
//! use stratavox::gpu::{Gpu, TargetClass};
//! use stratavox::technique::Settings;
//! use stratavox::transfer::TransferFunction;
//!
//! /// Once: textures and their upload, recorded outside rendering; pipelines, images and descriptor sets.
//! unsafe fn made(
//!     gpu: &Arc<Gpu>,
//!     cmd: vk::CommandBuffer,
//!     target: TargetClass,
//!     extent: [u32; 2],
//!     voxels: &stratavox::volume::Volume,
//!     function: &TransferFunction,
//! ) -> Result<Renderer, Error> {
//!     let settings = Settings::default();
//!     let mut volume = Volume::new(gpu, voxels, &settings)?;
//!     unsafe { volume.record_upload(gpu, cmd)? };
//!     let class = RendererDesc {
//!         settings,
//!         target,
//!         frames_in_flight: 2,
//!         host_depth: false,
//!         gives_depth: false,
//!         picks: false,
//!         slice_blending: SliceBlending::Float,
//!     };
//!     Renderer::new(gpu, &Arc::new(volume), Some(function), class, extent, &[])
//! }
//!
//! /// Each frame, with the matrices that the host draws its own geometry with.
//! unsafe fn frame(
//!     renderer: &mut Renderer,
//!     cmd: vk::CommandBuffer,
//!     frame: u32,
//!     [view_from_world, clip_from_view]: [glam::DMat4; 2],
//! ) -> Result<(), Error> {
//!     let (camera, _) = Camera::from_matrices(&view_from_world, &clip_from_view, DepthConvention::Standard)?;
//!     unsafe { renderer.record(cmd, &FrameInfo { frame, camera: &camera, depth: None })? };
//!     // vkCmdBeginRendering, the host's own geometry
//!     unsafe { renderer.draw(cmd, frame)? };
//!     // vkCmdEndRendering
//!     Ok(())
//! }
//! ```
//!
//! `examples/embed.rs` is a whole host, from its device to a PNG; `docs/embedding.md` goes through every barrier, the
//! host's depth buffer, frames in flight, functions that are dragged, volumes that change.
//!
//! # The pieces below
//!
//! What [`embed`] does not draw (light volumes, half-angle slices, several volumes, several rays a pixel) a host puts
//! together itself:
//!
//! | step | when | how |
//! |---|---|---|
//! | make | once | [`resident::GpuVolume`], [`resident::GpuTransfer`], a technique, a [`technique::parameter_ring`]; for compute passes also [`technique::accumulation`] and a [`resolve::Resolve`] |
//! | bind | once | `bind` of technique and resolve: descriptor sets, one for each brick |
//! | upload | once | `record_upload` outside rendering; the staging buffer goes when that has run |
//! | describe | each frame | [`technique::View::recordings`], each written to a slot that no unfinished frame reads |
//! | record | each frame | `record` of the technique, then of the resolve; makes, destroys and waits for nothing |
//!
//! Each image must be in a state, which is a word of [`gpu::Use`], and is left in one. [`gpu::image_barrier`]
//! goes from one to the next for images of ours, [`gpu::Target`] from and to what a host says for its own.
//!
//! | recording | image | arrives in | leaves in |
//! |---|---|---|---|
//! | [`resident::GpuVolume::record_upload`] | textures | `Nothing`, or `Sampled` | `Sampled` |
//! | [`resident::GpuTransfer::record_upload`] | table | `Nothing` | `SampledOrRead` |
//! | [`technique::raycast`], [`technique::projection`]: outside rendering | textures | `Sampled` | `Sampled` |
//! | | table | `SampledOrRead` | `SampledOrRead` |
//! | | accumulation, layers | `ComputeWrite` | `ComputeWrite` |
//! | [`technique::Slicer`]: inside the host's rendering | textures | `Sampled` | `Sampled` |
//! | | the host's target | `ColorTarget` | `ColorTarget` |
//! | [`technique::PatchSlicer`]: lists outside the host's rendering, draws inside | textures | `Sampled` | `Sampled` |
//! | | the host's target | `ColorTarget` | `ColorTarget` |
//! | [`technique::slices_3d::HalfAngleSlicer`]: outside rendering | textures | `Sampled` | `Sampled` |
//! | | accumulation, light buffer | `ColorTarget` | `ColorTarget` |
//! | [`resolve`]: inside the host's rendering | accumulation | `FragmentSampled` | `FragmentSampled` |
//! | | the host's target | `ColorTarget` | `ColorTarget` |
//!
//! After a recording, the bound pipeline, descriptor set 0, viewport and scissor are ours: a host sets its own
//! again. Bricks of a compute pass want a barrier from `ComputeWrite` to `ComputeWrite` between them.
//!
//! Frames in flight have slots and accumulation images of their own; volumes, tables, pipelines and rings are
//! shared. [`gpu::Gpu::announce`] before recording says with which value a frame is done: what is dropped
//! later lives until [`gpu::Gpu::retire`] hears of it.
//!
//! Colour is premultiplied. Targets that hold linear light (floats, `SRGB`) go with
//! [`picture::ColorSpace::Linear`], `UNORM` targets that are shown as they are with
//! [`picture::ColorSpace::Display`].
//!
//! # Several values a voxel
//!
//! [`scene::Scene::beside`] puts volumes on one grid together, sample by sample. A host makes them by
//! [`resident::GpuVolume::several`] and [`resident::GpuTransfer::several`], takes the variant of
//! [`technique::ShaderVariant::mixed`] and the parameters of [`technique::View::recordings_of`], and binds the bricks of all of
//! them by [`technique::Inputs`].
//!
//! # Filters through the voxels
//!
//! [`technique::Filter::Quadratic`] and [`technique::Filter::Cubic`] read coefficients in place of voxels: a host makes
//! them by [`volume::Coefficients::new`] and puts them on the device by [`resident::GpuVolume::of_coefficients`]. A
//! recording that would read the one for the other is refused.
//!
//! # Long work in parts
//!
//! What is recorded for one picture may take seconds. A host that must not wait, or a system whose watchdog ends what
//! holds a device for long, records parts of it into several submissions: tiles of a picture
//! ([`technique::raycast::Raycast::record_tiles`], [`technique::projection::Projection::record_tiles`],
//! [`technique::Slicer::record_tile`], [`resolve::Resolve::record_tile`]), runs of slices, steps of half-angle slices
//! ([`embed::Renderer::begin_parts`]), and of what is made before a picture runs of workgroups
//! ([`technique::LightVolume::record_part`], [`resident::KeptGradients::record_part`],
//! [`resident::MacroCells::record_part`], [`resident::EmptySpace::record_part`]). The result is the same to the bit.
//! [`offscreen::Renderer`] does so by itself, and can be stopped in between.
//!
//! # What holds everywhere
//!
//! Recording creates, destroys and waits for nothing. Only `gpu/headless.rs` makes a device. Files are
//! touched by `format`, `picture` and `transfer/file.rs`, by the program, and by `gpu/cache.rs`, which keeps
//! compiled pipelines. There is no global state. The same inputs give the same bytes.

#[cfg(feature = "annotate")]
pub mod annotate;
#[doc(hidden)]
pub mod blue_noise;
pub mod camera;
#[cfg(feature = "capi")]
pub mod capi;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
pub mod color;
#[cfg(feature = "conformance")]
#[doc(hidden)]
pub mod conformance;
pub mod embed;
#[cfg(feature = "files")]
mod fence;
#[cfg(feature = "annotate")]
#[cfg_attr(
    not(feature = "cli"),
    allow(
        dead_code,
        unused_imports,
        reason = "the program writes figures into files too"
    )
)]
mod figure;
pub mod flow;
#[cfg(feature = "files")]
pub mod format;
pub mod geometry;
pub mod gpu;
#[doc(hidden)]
pub mod isosurface;
#[doc(hidden)]
pub mod lattice;
#[doc(hidden)]
pub mod look;
pub mod mesh;
mod named;
pub mod offscreen;
pub mod picture;
pub mod points;
#[doc(hidden)]
pub mod ray;
#[doc(hidden)]
pub mod real;
pub mod resident;
pub mod resolve;
pub mod scene;
#[doc(hidden)]
pub mod shaders;
pub mod technique;
pub mod transfer;
pub mod volume;

/// The example of the README compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
