//! What interpolates between voxels.
//!
//! ```text
//! sampler    the device's texture unit: as exact as its sub-texel bits
//! fetches    the shader itself, from eight texels in f32
//! corners    the same, on devices that compute on the CPU, from four words beside the texture or in its place (`resident::FootprintTexels`)
//! ```

use super::{Filter, GradientStorage, Operator, SampleInputs, Settings};

/// A wish for one of them. Conformance pictures fetch, whatever is wished.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FilterBy {
    /// Footprint texels where there are any, else the sampler. Renderers of our own make corners for drivers that were found to
    /// be faster with them ([`Gpu::has_slow_sampler`](crate::gpu::Gpu::has_slow_sampler)): it follows from driver,
    /// volume and picture alone, so that the same picture always comes out the same (`docs/sampling-notes.md`).
    #[default]
    Auto,
    /// The sampler, where the device has one for the format.
    Sampler,
    /// Footprint texels where there can be any, else fetches.
    Fetch,
}

impl Settings {
    /// Whether pictures of one volume read its [`FootprintTexels`](crate::resident::FootprintTexels), where it has them: those of rays,
    /// paths and view-aligned slices, linear.
    pub fn reads_footprint_texels(&self, mix: SampleInputs) -> bool {
        let is_slab =
            self.preintegrated && (!self.technique.casts_rays() || self.has_general_light());
        let is_free = !self.conformance && !is_slab && self.single_scattering.is_none();
        // Splats read voxels one by one, from the texture itself; fields of points have none.
        let is_splatted = self.technique.splats() || self.field.is_some();
        let has_such = !self.technique.draws_stacks() && !self.is_half_angle() && !is_splatted;
        let is_wished = self.filter_by != FilterBy::Sampler;
        mix.is_of_one() && has_such && is_free && is_wished && self.filter == Filter::Linear
    }

    /// Whether they read nothing else of its values, so that it needs no texture: what fetches voxels one by one does.
    pub(crate) fn reads_footprint_texels_alone(&self, mix: SampleInputs) -> bool {
        let has_texels = self.per_mode.exact_maximum || self.has_general_light();
        self.reads_footprint_texels(mix) && !has_texels
    }

    /// Light that something hinders, or gradients by other than central differences.
    fn has_general_light(&self) -> bool {
        let is_central = self.gradient_operator() == Operator::Central
            && self.gradient_storage == GradientStorage::OnTheFly;
        self.wants_light_volume() || !is_central
    }
}
