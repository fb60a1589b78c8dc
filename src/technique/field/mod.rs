//! Ray casting of scattered points themselves: samples are those of a ray caster, and the value of one is that of the field of
//! the points around it ([`PointField`]), in place of what a filter makes of voxels.
//!
//! ```text
//! samples at steps of R / samples_per_voxel       no data where no point lies within R: cells without points nearby are skipped
//! ```
//!
//! Of a scene whose volume is [`Points::binned_within`](crate::points::Points::binned_within) of the radius: the box of that is
//! the domain.

mod gpu;
mod rules;

pub use gpu::GpuField;

use super::gather::{GatherDesc, RayPass};
use super::{Error, View};
use crate::gpu::Error as GpuError;
use crate::points::PointField;
use crate::shaders::Frame;

/// The pass of these rays.
pub(super) fn pass(desc: &GatherDesc) -> Result<RayPass, GpuError> {
    let mode = desc.settings.mode;
    if mode.is_projection() {
        let name = format!("projection.{}.field.ray", mode.shader_key());
        return RayPass::projection_of(desc.gpu, &name);
    }
    let transfer = match desc.variant.transfer {
        "points" => "points",
        _ => "table",
    };
    let layers = match desc.variant.writes_layers {
        true => "",
        false => ".picture",
    };
    let name = format!("raycast.composite.field.ray.{transfer}{layers}");
    RayPass::picture_of(desc.gpu, &name)
}

/// Loop turns of a sample beside those over its points: its own, what is skipped before it, layers and rows of cells with the
/// turns that end them.
const TURNS_OF_SAMPLE: u32 = 2 + 4 + 3 * 4 + 9;
/// Of what is once a ray.
const SPARE_TURNS: u32 = 2048;

impl View<'_> {
    /// Tells the parameters where the cells of a field are.
    pub(crate) fn tell_field(&self, field: &PointField, frame: &mut Frame) {
        let cells_from_voxel = field.cells_from_world() * self.grid.world_from_voxel;
        frame.field_from_voxel = super::frame::affine_rows(&cells_from_voxel);
        frame.field_cells = field.counts();
        frame.field_scale = field.cells_per_radius().recip() as f32;
        frame.field_density = field.density_scale() as f32;
        frame.field_skips = self.settings.skip.into();
        frame.part_end = i32::MAX as u32;
    }

    /// How many samples of a ray one recording takes, so that its loops are no longer than the device allows: of each, its points,
    /// and the turns of a search among so many control points.
    ///
    /// # Errors
    /// [`Error::NotFor`] where those of one sample are.
    pub(crate) fn field_samples_at_once(
        &self,
        field: &PointField,
        control_points: usize,
        max_loop_turns: u32,
    ) -> Result<u32, Error> {
        if max_loop_turns == u32::MAX {
            return Ok(i32::MAX as u32);
        }
        let search = 2 * ((control_points + 1).ilog2() + 2);
        let clip = self.settings.clip_planes.len() as u32;
        let room = max_loop_turns.saturating_sub(SPARE_TURNS + clip);
        let near = field.most_near();
        let of_sample = near.saturating_add(TURNS_OF_SAMPLE + search);
        match room / of_sample {
            0 => Err(Error::NotFor {
                wanted: "casting these points on this device, whose driver ends long loops",
                of: "fewer points within a radius",
                found: format!("{near} in the cells around a place: take a smaller radius"),
            }),
            samples => Ok(samples),
        }
    }

    /// How many recordings of so many samples each the longest ray takes.
    pub(crate) fn field_parts(&self, at_once: u32) -> usize {
        // One sample more where a step is cut short, and one at either end.
        let samples = self.longest_sample_count().ceil() + 3.0;
        (samples / f64::from(at_once)).ceil() as usize
    }
}
