//! Round cones and triangles in a host's own rendering, before volumes that end at them.
//!
//! ```text
//! geometry.record_upload(cmd)             outside rendering, once
//! each frame
//!     geometry.draw(cmd, shot, extent)    inside the host's rendering, tested against its depth, which it writes
//!     renderer.record, renderer.draw      with the host's depth: the volume ends at what is drawn
//! ```
//!
//! The cones are intersected pixel by pixel (`shaders/round_cone.wgsl`), so that a tube is round however near it comes. What is
//! seen is what [`crate::geometry::Geometry::seen`] makes on the CPU, cut by the host's near and far planes.

mod shapes;
mod view;

use super::renderer_desc::check_frames;
use super::{Error, FrameInfo};
use crate::camera::{DepthConvention, HostDepth};
use crate::geometry;
use crate::gpu::{Gpu, ParameterRing, TargetClass, Tile, set_area_of};
use crate::picture::ColorSpace;
use crate::shaders::GeometryView;
use ash::vk;
use glam::DVec3;
use shapes::{GpuVertex, Parts, Shapes};
use std::sync::Arc;

/// What geometry is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GeometryDesc {
    /// What is drawn into: the formats, samples and depth of the host's rendering. A depth attachment is wanted.
    pub target: TargetClass,
    /// The numbers that the target gets: as [`crate::technique::Settings::color_space`].
    pub color_space: ColorSpace,
    /// How many frames of the host may be unfinished at once.
    pub frames_in_flight: u32,
}

/// Opaque round cones and triangles on a host's device.
#[derive(Debug)]
pub struct Geometry {
    gpu: Arc<Gpu>,
    desc: GeometryDesc,
    /// What places on the device count from, world.
    center: DVec3,
    ring: ParameterRing,
    cones: Option<Shapes>,
    triangles: Option<Shapes>,
    is_uploaded: bool,
}

impl Geometry {
    /// Buffers, a staging buffer that holds all shapes, pipelines and descriptor sets: all there will ever be. Clip planes of
    /// renderers do not cut it.
    ///
    /// # Errors
    /// [`Error::HostDepth`] for a target without a depth attachment, [`Error::Geometry`] for a place or a radius that is none,
    /// [`Error::FramesInFlight`], limits of the device by their names, and no memory.
    pub fn new(
        gpu: &Arc<Gpu>,
        geometry: &geometry::Geometry,
        desc: GeometryDesc,
    ) -> Result<Self, Error> {
        check_frames(desc.frames_in_flight)?;
        if desc.target.depth.is_none() {
            return Err(Error::HostDepth {
                wanted: "a depth attachment in `GeometryDesc::target`".into(),
                found: "none".into(),
            });
        }
        let cones = geometry.cones.vertices();
        let corners = geometry.triangles.all_corners();
        let places = || {
            let cones = cones.iter().map(|vertex| vertex.place);
            cones.chain(corners.iter().map(|corner| corner.place))
        };
        let ends = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = places().fold(ends, |(low, high), p| (low.min(p), high.max(p)));
        let center = match places().next() {
            Some(_) => 0.5 * (low + high),
            None => DVec3::ZERO,
        };
        let vertex = |place: DVec3, radius: f64, color| GpuVertex {
            place: (place - center).as_vec3().to_array(),
            radius: radius as f32,
            color,
            unused: 0.0,
        };
        let cones = Parts {
            name: "round cones",
            shaders: ["round_cone_cover", "round_cone"],
            vertices: cones
                .iter()
                .map(|end| vertex(end.place, end.radius, end.color))
                .collect(),
            numbers: &geometry.cones.numbers(),
            corners_a_number: 3,
        };
        let triangles = Parts {
            name: "triangles",
            shaders: ["triangle_corner", "triangle"],
            vertices: corners
                .iter()
                .map(|corner| vertex(corner.place, 1.0, corner.color))
                .collect(),
            numbers: geometry.triangles.numbers(),
            corners_a_number: 1,
        };
        for parts in [&cones, &triangles] {
            check(parts)?;
            parts.check_limits(gpu)?;
        }
        let bytes = cones
            .bytes()
            .into_iter()
            .chain(triangles.bytes())
            .sum::<u64>();
        let counts = [geometry.cones.len(), geometry.triangles.len()];
        gpu.check_budget(
            || {
                format!(
                    "put {} round cones and {} triangles on the device",
                    counts[0], counts[1]
                )
            },
            2 * bytes,
        )?;
        let (slot, slots) = (size_of::<GeometryView>() as u32, desc.frames_in_flight);
        let ring = ParameterRing::new(gpu, slot, slots, "views of geometry")?;
        Ok(Self {
            gpu: Arc::clone(gpu),
            center,
            cones: Shapes::new(gpu, &cones, &desc, &ring)?,
            triangles: Shapes::new(gpu, &triangles, &desc, &ring)?,
            ring,
            desc,
            is_uploaded: false,
        })
    }

    /// What it was made for.
    pub fn desc(&self) -> &GeometryDesc {
        &self.desc
    }

    /// Records the upload, once: for vertices and for their numbers a copy, then a barrier from transfers to vertex and fragment
    /// shaders. What it was staged in goes when that has run: [`Gpu::announce`] comes before.
    ///
    /// # Errors
    /// [`Error::Uploaded`] the second time.
    ///
    /// # Safety
    /// `cmd` is recording, outside rendering, after [`Gpu::announce`] of its value, and is submitted before anything that
    /// draws the geometry.
    pub unsafe fn record_upload(&mut self, cmd: vk::CommandBuffer) -> Result<(), Error> {
        self.gpu.check_alive("upload geometry")?;
        if self.is_uploaded {
            return Err(Error::Uploaded);
        }
        for shapes in [&mut self.cones, &mut self.triangles].into_iter().flatten() {
            // SAFETY: the caller's promises.
            unsafe { shapes.record_upload(&self.gpu, cmd)? };
        }
        self.is_uploaded = true;
        Ok(())
    }

    /// Draws all of it over what the host has drawn so far, where it is not behind that, and writes its depth. Parameters go
    /// through mapped memory, so that nothing comes before it outside of rendering. Bound pipeline, descriptor set 0, viewport
    /// and scissor are ours afterwards.
    ///
    /// With several samples all of a pixel see what its middle sees of round cones.
    ///
    /// # Errors
    /// [`Error::NotUploaded`], [`Error::NoFrame`], [`Error::HostDepth`] without [`FrameInfo::depth`] or with the other depth
    /// nearer, and those of the camera.
    ///
    /// # Safety
    /// - `cmd` is recording inside rendering to a target of [`GeometryDesc::target`] and of `extent` pixels, the depth of which
    ///   may be written;
    /// - it runs after what [`Geometry::record_upload`] recorded, on the same queue;
    /// - nothing unfinished was drawn with the same [`FrameInfo::frame`]: a second view of one frame takes another number.
    pub unsafe fn draw(
        &self,
        cmd: vk::CommandBuffer,
        shot: &FrameInfo,
        extent: [u32; 2],
    ) -> Result<(), Error> {
        self.gpu.check_alive("draw geometry")?;
        if !self.is_uploaded {
            return Err(Error::NotUploaded);
        }
        let of = self.desc.frames_in_flight;
        if shot.frame >= of {
            let found = shot.frame;
            return Err(Error::NoFrame { found, of });
        }
        shot.camera.check()?;
        let depth = self.depth_of(shot)?;
        let space = self.desc.color_space;
        let view = view::view(shot.camera, &depth, self.center, extent, space);
        self.ring.write(shot.frame, bytemuck::bytes_of(&view))?;
        let offset = self.ring.offset(shot.frame)?;
        // SAFETY: the caller's promises.
        unsafe {
            set_area_of(&self.gpu, cmd, extent, Tile::whole(extent));
            for shapes in [&self.cones, &self.triangles].into_iter().flatten() {
                shapes.draw(cmd, offset);
            }
        }
        Ok(())
    }

    fn depth_of(&self, shot: &FrameInfo) -> Result<HostDepth, Error> {
        let refuse = |wanted: &str, found: String| {
            let wanted = wanted.to_owned();
            Err(Error::HostDepth { wanted, found })
        };
        let Some(depth) = shot.depth else {
            let wanted = "`FrameInfo::depth`, from `Camera::from_matrices`";
            return refuse(wanted, "none".into());
        };
        let is_reversed = self
            .desc
            .target
            .depth
            .is_some_and(|depth| depth.is_reversed);
        match is_reversed == (depth.nearer == DepthConvention::Reversed) {
            true => Ok(depth),
            false => refuse(
                "`FrameInfo::depth` and `GeometryDesc::target` with the same depth nearer",
                format!("{:?}", depth.nearer),
            ),
        }
    }
}

/// Whether all vertices are places with a radius, as f32 from their middle.
fn check(parts: &Parts) -> Result<(), Error> {
    for (number, vertex) in parts.vertices.iter().enumerate() {
        let refuse = |what, wanted, found: String| {
            Err(Error::Geometry {
                shapes: parts.name,
                number,
                what,
                wanted,
                found,
            })
        };
        let is_finite = |numbers: &[f32]| numbers.iter().all(|n| n.is_finite());
        if !is_finite(&vertex.place) {
            let found = format!("{:?} from the middle of all", vertex.place);
            return refuse("place", "a place that f32 can hold", found);
        }
        if !(vertex.radius > 0.0 && vertex.radius.is_finite()) {
            let found = vertex.radius.to_string();
            return refuse("radius", "a length over 0 that f32 can hold", found);
        }
        if !is_finite(&vertex.color) {
            let found = format!("{:?}", vertex.color);
            return refuse("color", "finite numbers", found);
        }
    }
    Ok(())
}
