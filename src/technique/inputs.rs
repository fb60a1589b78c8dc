//! What every technique reads, by the names that the shaders give it, and which variant of a shader that
//! asks for.

use super::field::GpuField;
use super::splat::GpuViewPoints;
use super::{
    Filter, FilterBy, GpuChannel, GradientStorage, Lattice, LightVolume, Mode, Operator, Role,
    SampleInputs, Settings, Skip, SkipBy,
};
use crate::gpu::{Bindings, Buffer, Error, Gpu, Image, Layout, ParameterRing, Resource};
use crate::resident::{
    Brick, ClassifiedRuns, FootprintTexels, GpuTransfer, GpuVolume, TextureLayout,
};
use crate::shaders::{MAX_CHANNELS, Shader, find, shader};
use std::sync::Arc;

/// What a technique reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a> {
    /// Parameters; one slot a recording.
    pub ring: &'a ParameterRing,
    /// What is shown.
    pub volume: &'a GpuVolume,
    /// The part of it that this recording shows.
    pub brick: &'a Brick,
    /// Classification; projecting modes do without.
    pub transfer: Option<&'a GpuTransfer>,
    /// The same part of the volumes that are put together with it; none where it is alone.
    pub beside: &'a [&'a Brick],
    /// What comes through to a sample, where the settings ask for occlusion or shadows.
    pub light: Option<&'a LightVolume>,
    /// The scattered points of the view, where the settings ask for them.
    pub points: Option<&'a GpuViewPoints>,
    /// The field that rays are cast through, where the settings ask for one.
    pub field: Option<&'a GpuField>,
    /// The picture of the sky that paths find light in.
    pub sky: Option<&'a Buffer>,
    /// Where not to look. Its [`Recording`](super::Recording::skip) must be told the same.
    pub skip: Skip<'a>,
}

impl Inputs<'_> {
    /// A descriptor set of what `layout` declares, taken from the inputs and from `outputs`.
    ///
    /// # Errors
    /// Where a declared name is not there.
    pub fn bind(
        &self,
        gpu: &Arc<Gpu>,
        layout: &Layout,
        outputs: &[(&str, Resource)],
    ) -> Result<Bindings, Error> {
        let mut given = vec![("frame", Resource::Uniform(self.ring))];
        let values = match self.volume.layout() {
            TextureLayout::Texture3d => "volume",
            TextureLayout::Stack(_) => "stack",
        };
        given.push((values, Resource::sampled(&self.brick.values)));
        given.push(("gradient_source", Resource::sampled(self.gradient_source())));
        given.push(("gradient_sampler", Resource::Sampler(self.volume.sampler())));
        given.push(("volume_sampler", Resource::Sampler(self.volume.sampler())));
        given.extend(self.channels());
        if let Some(transfer) = self.transfer {
            let table = transfer.table();
            given.push(("transfer_table", Resource::sampled_or_read(table)));
            given.push(("stored_table", Resource::read(table)));
            given.push(("transfer_numbers", Resource::Storage(transfer.numbers())));
            if let Some(slabs) = transfer.slab_table() {
                given.push(("slab_table", Resource::sampled_or_read(slabs)));
                given.push(("stored_slabs", Resource::read(slabs)));
            }
        }
        // Where there is none, something stands in that is not looked at.
        let light = self.light.map(LightVolume::buffer);
        let light = light.unwrap_or(self.ring.buffer());
        given.push(("blue_noise", Resource::sampled(self.volume.blue_noise())));
        given.push(("light_volume", Resource::Storage(light)));
        let sky = self.sky.unwrap_or(self.ring.buffer());
        given.push(("sky", Resource::Storage(sky)));
        if let Some(points) = self.points {
            given.push(("view_points", Resource::Storage(points.points())));
            given.push(("block_points", Resource::Storage(points.blocks())));
        }
        if let Some(field) = self.field {
            given.push(("field_points", Resource::Storage(field.points())));
            given.push(("field_cells", Resource::Storage(field.cells())));
        }
        let [distance_map, ranges] = match self.skip {
            Skip::Nothing => [self.ring.buffer(); 2],
            Skip::Unseen(cells, empty) => [empty.distance_map(), cells.ranges()],
            Skip::Exceeded(cells) => [self.ring.buffer(), cells.ranges()],
        };
        let full = match self.skip {
            Skip::Unseen(_, empty) => empty.full_voxels(),
            Skip::Nothing | Skip::Exceeded(_) => None,
        };
        let corners = self.volume.corners().map(FootprintTexels::image);
        given.extend(corners.map(|corners| ("corners", Resource::read(corners))));
        given.push(("distance_map", Resource::Storage(distance_map)));
        given.push(("cell_ranges", Resource::Storage(ranges)));
        let full = full.unwrap_or(self.ring.buffer());
        given.push(("full_voxels", Resource::Storage(full)));
        let runs = self.volume.runs();
        let words = runs.map_or(self.volume.blue_noise(), ClassifiedRuns::words);
        let payload = runs.map_or(self.volume.no_depth(), ClassifiedRuns::payload);
        given.push(("run_words", Resource::sampled(words)));
        given.push(("run_payload", Resource::sampled(payload)));
        given.extend_from_slice(outputs);
        if !outputs.iter().any(|(name, _)| *name == "host_depth") {
            given.push(("host_depth", Resource::sampled(self.volume.no_depth())));
        }
        given.retain(|(name, _)| layout.slots().iter().any(|slot| slot.name == *name));
        Bindings::new(gpu, layout, &given)
    }
}

impl Inputs<'_> {
    /// What gradients are read from or made of: the values themselves, unless something lies beside them.
    fn gradient_source(&self) -> &Image {
        let mut bricks = self.volume.bricks().iter();
        let Some(index) = bricks.position(|brick| brick.cell == self.brick.cell) else {
            return &self.brick.values;
        };
        let kept = self.volume.kept_gradients();
        let kept = kept.map(|kept| &kept.images()[index]);
        let beside = self.volume.gradient_source();
        let beside = beside.map(|source| &source.bricks()[index].values);
        kept.or(beside).unwrap_or(&self.brick.values)
    }
}

/// What the shaders call volumes after the first, and where they have values.
const CHANNELS: [[&str; 2]; MAX_CHANNELS as usize - 1] = [
    ["channel_1", "validity_1"],
    ["channel_2", "validity_2"],
    ["channel_3", "validity_3"],
];

impl<'a> Inputs<'a> {
    /// Every name gets something: where there is no such channel, or it has no holes, another's stands in and
    /// is not looked at.
    fn channels(&self) -> Vec<(&'static str, Resource<'a>)> {
        let mut given = Vec::new();
        let bricks = || [self.brick].into_iter().chain(self.beside.iter().copied());
        let any_mask = bricks().find_map(|brick| brick.validity.as_ref());
        let any_mask = any_mask.or(Some(self.volume.no_mask()));
        let mask = |brick: &'a Brick| brick.validity.as_ref().or(any_mask);
        given.extend(mask(self.brick).map(|mask| ("validity", Resource::sampled(mask))));
        for (c, [values, validity]) in CHANNELS.into_iter().enumerate() {
            let brick = *self.beside.get(c).unwrap_or(&self.brick);
            given.push((values, Resource::sampled(&brick.values)));
            given.extend(mask(brick).map(|mask| (validity, Resource::sampled(mask))));
        }
        given
    }
}

/// The variant of a shader: what fills the slots of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ShaderVariant {
    /// How values between voxels are made.
    pub filter: &'static str,
    /// Whether the volume has holes.
    pub holes: &'static str,
    /// Which samples a ray caster takes.
    pub lattice: &'static str,
    /// How values are classified.
    pub transfer: &'static str,
    /// How several volumes go together, or whether the gradient of one counts.
    pub mix: SampleInputs,
    /// What a sample is.
    pub take: SampleKind,
    /// Steps adapt to what is there.
    pub is_adaptive: bool,
    /// What says where nothing is seen.
    pub skip_by: SkipBy,
    /// No clip planes and no cut faces, and all rays begin at the same place of their pixels: for such pictures alone.
    pub is_whole: bool,
    /// Whether volumes that are mixed lie on grids of their own.
    pub has_own_grids: bool,
    /// Whether classified voxels lie in runs.
    pub is_in_runs: bool,
    /// Whether light falls on what a constant lights: volumes that are mixed, slabs, samples between slices.
    pub is_lit: bool,
    /// Whether matter is in the way of light that falls on volumes that are mixed.
    pub is_hindered: bool,
    /// Whether matter scatters light once.
    pub is_scattered: bool,
    /// Whether paths meet surfaces of values.
    pub has_levels: bool,
    /// Rays leave what lies beside the picture: depth, value, samples, and what bricks behind go on with.
    pub writes_layers: bool,
}

/// What a sample is: a point of a ray, or a piece of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SampleKind {
    /// A point.
    Point,
    /// A point on a plane between the slices of a stack.
    InterpolatedSlice,
    /// A piece, by the values at its two ends.
    Preintegrated,
}

impl SampleKind {
    fn of(settings: &Settings) -> Self {
        match settings.preintegrated {
            true => Self::Preintegrated,
            false if settings.smooth => Self::InterpolatedSlice,
            false => Self::Point,
        }
    }

    /// Its part of a shader's name.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Point => "",
            Self::InterpolatedSlice => "_smooth",
            Self::Preintegrated => "_slab",
        }
    }
}

impl ShaderVariant {
    /// The variant for a picture of such a volume.
    pub fn of(settings: &Settings, volume: &GpuVolume) -> Self {
        Self::mixed(
            settings,
            SampleInputs::Scalar,
            &[GpuChannel::numbers(volume)],
        )
    }

    /// The variant for a picture of several volumes.
    pub fn mixed(settings: &Settings, mix: SampleInputs, parts: &[GpuChannel]) -> Self {
        let is_fetched =
            |part: &GpuChannel| part.role != Role::Labels && !part.volume.texel().is_filtered;
        let is_in_runs = parts[0].volume.runs().is_some();
        let is_by_fetches = settings.conformance
            || settings.filter_by == FilterBy::Fetch
            || is_in_runs
            || parts.iter().any(is_fetched);
        let has_holes = parts.iter().any(|part| part.volume.has_holes());
        let has_surfaces = settings.shading.as_ref().is_some_and(|s| s.has_surfaces);
        let is_lit = has_surfaces || settings.wants_light_volume();
        let take = SampleKind::of(settings);
        let is_point = take == SampleKind::Point;
        let is_general = settings.gradient_operator() != Operator::Central
            || settings.gradient_storage == GradientStorage::Precomputed
            || settings.wants_light_volume();
        let corners = footprint_texels_of(parts).filter(|_| settings.reads_footprint_texels(mix));
        Self {
            mix: match mix {
                SampleInputs::Scalar if settings.single_scattering.is_some() => mix,
                SampleInputs::Scalar if is_lit && is_point && is_general => {
                    SampleInputs::ScalarGradient
                }
                SampleInputs::Scalar if is_lit && is_point => SampleInputs::Shaded,
                SampleInputs::GradientOpacity if is_general => SampleInputs::ScalarGradient,
                _ => mix,
            },
            filter: match settings.filter {
                Filter::Nearest => "nearest",
                Filter::Linear => match corners {
                    Some(corners) => corners.filter(),
                    None if is_by_fetches => "linear_fetch",
                    None => "linear",
                },
                Filter::CatmullRom => "kernel",
                _ if is_by_fetches => "kernel",
                _ => "spline",
            },
            holes: if has_holes { "mask" } else { "none" },
            lattice: match settings.ray_lattice() {
                Lattice::Ray | Lattice::Jitter => "ray",
                Lattice::Planes => "planes",
                Lattice::Bresenham => "bresenham",
            },
            take,
            transfer: match corners {
                _ if settings.conformance => "points",
                Some(_) => "stored",
                None => "table",
            },
            is_adaptive: settings.adaptive_steps.is_some(),
            skip_by: settings.empty_space,
            is_whole: false,
            has_own_grids: parts
                .iter()
                .any(|part| part.volume.grid() != parts[0].volume.grid()),
            is_in_runs,
            is_lit: is_lit && (!mix.is_of_one() || !is_point) && settings.mode == Mode::Composite,
            is_hindered: !mix.is_of_one()
                && settings.wants_light_volume()
                && settings.mode == Mode::Composite,
            is_scattered: settings.single_scattering.is_some(),
            has_levels: settings.has_solid_levels(),
            writes_layers: true,
        }
    }
}

impl ShaderVariant {
    /// The variant that knows nothing of clip planes, cut faces, jitter and rays with places of their own in their
    /// pixels, where these settings have none of it: for pictures of them alone.
    pub(crate) fn of_whole(self, settings: &Settings) -> Self {
        let is_cut = !settings.clip_planes.is_empty() || settings.cut_faces.is_some();
        let is_uneven = settings.uneven_rays || settings.lattice == Lattice::Jitter;
        Self {
            is_whole: !is_cut && !is_uneven,
            ..self
        }
    }

    /// The parts of a shader's name that say whether light falls by a constant, and whether grids are shared.
    pub(super) fn light_and_grids(&self) -> String {
        let light = match (self.is_hindered, self.is_lit) {
            (false, false) => "",
            (false, true) => ".lit",
            (true, _) => ".hindered",
        };
        let grids = match (self.is_in_runs, self.has_own_grids) {
            (true, _) => ".runs",
            (false, true) => ".own",
            (false, false) => "",
        };
        format!("{light}{grids}")
    }

    /// The shader of that name for such pictures: the leanest that there is, [`Self::is_whole`] before one that writes
    /// no layers.
    pub(super) fn shader(&self, name: &str) -> &'static Shader {
        let name = &format!("{name}{}", self.light_and_grids());
        let whole: &[&str] = if self.is_whole {
            &[".whole", ""]
        } else {
            &[""]
        };
        let alone: &[&str] = if self.writes_layers {
            &[""]
        } else {
            &[".picture", ""]
        };
        let ends = whole
            .iter()
            .flat_map(|whole| alone.iter().map(move |alone| (whole, alone)));
        let mut found = ends.filter_map(|(whole, alone)| find(&format!("{name}{whole}{alone}")));
        found.next().unwrap_or_else(|| shader(name))
    }
}

/// Those of the one volume.
fn footprint_texels_of<'a>(parts: &[GpuChannel<'a>]) -> Option<&'a FootprintTexels> {
    match parts {
        [part] => part.volume.corners(),
        _ => None,
    }
}
