//! A volume inside a host's frame: three levels over one set of objects.
//!
//! ```text
//!     Volume::new(gpu, voxels, settings)               textures; record_upload once, outside rendering
//!     Renderer::new(gpu, volume, function, class, ..)  pipelines, images, descriptor sets: all of them
//! each frame
//!     renderer.record(cmd, shot)                       outside rendering: parameters, compute passes
//! A   renderer.draw(cmd, frame)                        inside the host's rendering, over what it has drawn
//! B   renderer.record_into(cmd, shot, target)          both, into an image that comes and goes in stated states
//! C   submitter.submit(queue, frame, waits, signals)   the same, submitted by us
//! ```
//!
//! A and B never submit, never wait and make no Vulkan object. What a frame uses is free again when the host says so:
//! it counts its submissions, calls [`Gpu::announce`](crate::gpu::Gpu::announce) before it records and
//! [`Gpu::retire`](crate::gpu::Gpu::retire) when the device has done them, and gives a number of a frame in flight
//! ([`FrameInfo::frame`]) to no second frame before the first is done.
//!
//! Lines, arrows and points that a host has as round cones, and triangles, it may have drawn into its own picture and depth by
//! [`Geometry`].
//!
//! What a host has drawn hides the volume behind it ([`RendererDesc::host_depth`]): its depth buffer is read as a texture. Its own
//! depth a picture gives back by [`Renderer::draw_depth`] and [`Renderer::record_pick`] ([`RendererDesc::gives_depth`], [`RendererDesc::picks`]).
//!
//! Path tracing adds up from frame to frame ([`Renderer::paths_traced`], [`Renderer::noise`]).
//!
//! While it is drawn, a volume takes new voxels of a box ([`Volume::stage_update`], [`Volume::record_update`]). Frames,
//! uploads and updates may be cut into parts that are submitted one by one and given up between two of them:
//!
//! ```text
//!             B, recorded                          C, submitted until the host says no
//! a frame     Renderer::begin_parts                Submitter::submit_in_parts
//!             Renderer::record_part_into
//! an upload   Volume::record_upload_part           Submitter::upload_in_parts
//! an update   Volume::record_update_part           Submitter::update_in_parts
//! ```
//!
//! Not here, and refused by name: light volumes (shadows, ambient occlusion), several volumes, several rays a pixel,
//! adaptive steps, cross-fades of stacks. `docs/embedding.md` says why, and the pieces for them lie one floor below, in
//! [`crate::technique`].

mod error;
mod frame;
mod function;
mod geometry;
mod in_parts;
mod noise;
mod parts;
mod pass;
mod paths;
mod pick;
mod pieces;
mod recording;
mod renderer;
mod renderer_desc;
mod submitter;
mod update;
#[cfg(test)]
mod updated_cells;
mod updates;
mod upload;
mod volume;

pub use error::Error;
pub use geometry::{Geometry, GeometryDesc};
pub use in_parts::Pacing;
pub use pick::Pick;
pub use renderer::Renderer;
pub use renderer_desc::{FrameInfo, HostDepthImage, RendererDesc, SliceBlending};
pub use submitter::{QueueLock, Submitter};
pub use update::Update;
pub use volume::Volume;
