//! A volume renderer that speaks Vulkan: two texture slicers, a ray caster and
//! maximum intensity projection, each with a CPU twin and an exact answer.
//!
//! # Floors
//!
//! A module uses lower floors only; `tests/floors.rs` holds us to it.
//!
//! | floor | modules | what they know |
//! |---|---|---|
//! | 0 | [`shaders`], [`real`], [`ray`], [`blue_noise`], [`lattice`], [`color`], `fence` | arithmetic shared with the shaders, free of Vulkan |
//! | 1 | [`gpu`], [`volume`], [`transfer`], [`camera`], [`picture`], [`mesh`] | Vulkan objects, or data; never both |
//! | 2 | [`resident`], [`isosurface`], `format` | data put on a device; a surface in a volume; bytes of files turned into a [`volume::Source`] |
//! | 3 | [`technique`], [`resolve`] | `new`, `bind`, `record`, and the CPU twins |
//! | 4 | [`scene`], [`offscreen`] | a scene to a [`picture::Picture`]; the only place that submits and waits |
//! | 4 | [`embed`] | a volume in a host's frames |
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
//! # How to embed
//!
//! A host keeps its device, its queues, its command buffers and its images: it gives handles to
//! [`gpu::Gpu::from_host`], and nothing is submitted or waited for behind its back. The device speaks Vulkan
//! 1.3 and has `dynamicRendering` and `synchronization2` enabled, no more; the queues are of a family with
//! graphics and compute.
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
//! | [`resident::GpuTransfer::record_upload`] | table | `Nothing` | `Sampled` |
//! | [`technique::raycast`], [`technique::projection`]: outside rendering | textures, table | `Sampled` | `Sampled` |
//! | | accumulation, layers | `ComputeWrite` | `ComputeWrite` |
//! | [`technique::Slicer`]: inside the host's rendering | textures, table | `Sampled` | `Sampled` |
//! | | the host's target | `ColorTarget` | `ColorTarget` |
//! | [`technique::PatchSlicer`]: lists outside the host's rendering, draws inside | textures, table | `Sampled` | `Sampled` |
//! | | the host's target | `ColorTarget` | `ColorTarget` |
//! | [`technique::slices_3d::HalfAngleSlicer`]: outside rendering | textures, table | `Sampled` | `Sampled` |
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
//! View-aligned slices in a host's own pass, over what it has drawn:
//!
//! ```rust,no_run
//! use ash::vk;
//! use std::{error::Error, sync::Arc};
//! use stratavox::gpu::{Gpu, ParameterRing};
//! use stratavox::resident::{GpuTransfer, GpuVolume};
//! use stratavox::technique::blend::Drawn;
//! use stratavox::technique::{Inputs, Mode, Skip, Slicer, Technique, View, Words, parameter_ring};
//! use stratavox::transfer::TransferFunction;
//! use stratavox::volume::Volume;
//!
//! struct Shown {
//!     volume: GpuVolume,
//!     transfer: GpuTransfer,
//!     ring: ParameterRing,
//!     slicer: Slicer,
//!     /// One for each brick.
//!     bound: Vec<stratavox::gpu::Bindings>,
//! }
//!
//! impl Shown {
//!     /// Objects and their descriptor sets, and the upload, recorded outside rendering.
//!     unsafe fn new(
//!         gpu: &Arc<Gpu>,
//!         cmd: vk::CommandBuffer,
//!         target_format: vk::Format,
//!         frames_in_flight: u32,
//!         view: &View,
//!         voxels: &Volume,
//!         function: &TransferFunction,
//!     ) -> Result<Self, Box<dyn Error>> {
//!         let settings = view.settings;
//!         let volume = GpuVolume::new(gpu, voxels, view.texture_layout())?;
//!         let staging = volume.stage(voxels)?;
//!         let length = view.grid.smallest_spacing();
//!         let transfer = GpuTransfer::new(gpu, function, length, settings.color_space)?;
//!         unsafe {
//!             volume.record_upload_all(cmd, &staging)?;
//!             transfer.record_upload(cmd)?;
//!         }
//!         let bricks = volume.bricks().len() as u32;
//!         let ring = parameter_ring(gpu, bricks * frames_in_flight)?;
//!         let words = Words::of(settings, &volume);
//!         let picture = Drawn::Picture(Mode::Composite);
//!         let (technique, order) = (Technique::Slices3d, settings.order);
//!         let slicer = Slicer::new(gpu, technique, picture, order, &words, target_format)?;
//!         let bind = |brick| {
//!             let (ring, volume, transfer) = (&ring, &volume, Some(&transfer));
//!             slicer.bind(&Inputs { ring, volume, brick, transfer, beside: &[], light: None, skip: Skip::Nothing })
//!         };
//!         let bound = volume.bricks().iter().map(bind).collect::<Result<_, _>>()?;
//!         Ok(Self { volume, transfer, ring, slicer, bound })
//!     }
//!
//!     /// One frame, inside the host's rendering to an image of `view.extent_pixels`.
//!     unsafe fn record(
//!         &self,
//!         cmd: vk::CommandBuffer,
//!         frame_in_flight: u32,
//!         view: &View,
//!     ) -> Result<(), Box<dyn Error>> {
//!         let first_slot = frame_in_flight * self.bound.len() as u32;
//!         let recordings = view.recordings(&self.volume, Some(&self.transfer))?;
//!         for (slot, recording) in (first_slot..).zip(recordings) {
//!             let offset = recording.write(&self.ring, slot)?;
//!             let (bound, extent) = (&self.bound[recording.brick], view.extent_pixels);
//!             let slices = 0..recording.slices;
//!             unsafe { self.slicer.record(cmd, bound, offset, extent, slices) };
//!         }
//!         Ok(())
//!     }
//! }
//! ```
//!
//! `staging` is dropped while the upload may run: [`gpu::Gpu::announce`] was called with its value before.
//! `examples/embed` is a whole host, from its device to a PNG, with the ray caster.
//!
//! # Several values a voxel
//!
//! [`scene::Scene::beside`] puts volumes on one grid together, sample by sample. A host makes them by
//! [`resident::GpuVolume::several`] and [`resident::GpuTransfer::several`], takes the variant of
//! [`technique::Words::mixed`] and the parameters of [`technique::View::recordings_of`], and binds the bricks of all of
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
//! ([`technique::slices_3d::HalfAngleSlicer::record_clear`]), and of what is made before a picture runs of workgroups
//! ([`technique::LightVolume::record_part`], [`resident::KeptGradients::record_part`],
//! [`resident::MacroCells::record_part`], [`resident::EmptySpace::record_part`]). The result is the same to the bit.
//! [`offscreen::Renderer`] does so by itself, and can be stopped in between.
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

pub mod blue_noise;
pub mod camera;
#[cfg(feature = "cli")]
pub mod cli;
pub mod color;
pub mod embed;
#[cfg(feature = "files")]
mod fence;
#[cfg(feature = "files")]
pub mod format;
pub mod gpu;
pub mod isosurface;
pub mod lattice;
pub mod mesh;
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
