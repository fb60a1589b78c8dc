//! How often the loops of a ray go round: some drivers end all loops of an invocation after so many turns, without a
//! word ([`crate::gpu::Caps::max_loop_turns`]), and what lies behind would be missing from the picture.
//!
//! ```text
//! turns of a sample = 3 + n (looks (1 + mask + filter) + weights + search + light)
//! ```
//!
//! for n volumes: the sample itself, the search for it, what is left out on the way; with one look, or two where
//! there are slabs, 6 more where a gradient is made of differences, and 28 (with the turn that ends them) where there is a second
//! derivative; labels have one, and 14 where they are lit. A mask goes round for the layers and rows of the footprint, a kernel for those of its taps, a
//! search for the halvings of the points, light for lamps and for the corners of a cell of the light volume. Clip
//! planes are gone over once a ray, and once more for cut faces.

use super::{
    Error, Filter, GradientStorage, Operator, SampleKind, Settings, ShaderVariant,
    SingleScattering, View,
};
use glam::DVec3;

/// Of what is rare: surfaces that are refined, the first turns of everything.
const SPARE: f64 = 2048.0;

/// What transfer functions have loops over.
#[derive(Clone, Copy, Debug, Default)]
pub struct Functions {
    /// Control points of the longest one.
    pub points: usize,
    /// Whether one asks for second derivatives.
    pub second: bool,
    /// How many of the volumes are label maps: one voxel is looked at there, without a loop around it.
    pub labels: usize,
}

/// How often the loops of one sample go round, at most.
pub fn turns_per_sample(
    settings: &Settings,
    variant: &ShaderVariant,
    volumes: usize,
    functions: Functions,
) -> u64 {
    let width = match settings.filter {
        Filter::Nearest => 1,
        Filter::Linear => 2,
        Filter::Quadratic | Filter::QuadraticSmooth => 3,
        Filter::Cubic | Filter::CubicSmooth | Filter::CatmullRom => 4,
    };
    // Two nested loops, with the turns that end them.
    let layers_and_rows = (width + 1) * (width + 1);
    // A function that returns early is a loop of one turn.
    let mask = if variant.holes == "mask" {
        layers_and_rows + 1
    } else {
        0
    };
    // Texels are made in a loop over taps.
    let filter = if variant.filter == "kernel" {
        layers_and_rows + 5
    } else {
        0
    };
    let are_kept = settings.gradient_storage == GradientStorage::Precomputed;
    let is_weighted = settings.gradient_operator() != Operator::Central;
    let has_gradient = variant.mix.uses_gradient() || variant.is_lit;
    let of_values = if variant.take == SampleKind::Preintegrated {
        2
    } else {
        1
    };
    let of_gradient = match has_gradient {
        true if !is_weighted && !are_kept => 6,
        _ => 0,
    };
    let fetches = of_values + of_gradient + if functions.second { 28 } else { 0 };
    // Four layers of four rows, with the turns that end them, and the choice of the weights.
    let weights = if has_gradient && is_weighted && !are_kept {
        5 * 5 + 5
    } else {
        0
    };
    // Over lights, and over the corners of a cell of the light volume for each of them and for ambient light.
    let light = if has_gradient {
        let corners = if settings.wants_light_volume() { 9 } else { 1 };
        let shading = settings.shading.as_ref();
        let lights = shading.map_or(0, |shading| shading.lights.len().max(1)) as u64;
        corners + lights * (1 + corners) + 1
    } else {
        0
    };
    let search = if variant.transfer == "points" {
        2 * u64::from((functions.points + 1).ilog2() + 2)
    } else {
        0
    };
    // Channels are gone over when they are asked for data, looked at and classified.
    let of_each = if volumes > 1 { 3 } else { 0 };
    let of_numbers = fetches * (1 + mask + filter) + weights;
    let of_labels = 1 + mask + if has_gradient { 14 } else { 0 };
    if settings.single_scattering.is_some() {
        // In the light volume each light, and the sky, has the corners of a cell.
        let lights = settings.path.lights.len() + settings.path.lamps.len();
        let of_light = 10 * (1 + lights as u64);
        return 4 + 2 * (of_numbers + search) + of_light;
    }
    let [labels, volumes] = [functions.labels, volumes].map(|n| n as u64);
    let numbers = volumes.saturating_sub(labels);
    3 + volumes * (of_each + search + light) + numbers * of_numbers + labels * of_labels
}

impl View<'_> {
    /// How often the loops of one sample go round that follow light to where the domain ends:
    ///
    /// ```text
    /// sum over lights of  2 (n / 4 + 1) + 3 n / 8 + 3 + n (mask + search)        n steps
    /// ```
    ///
    /// four steps a turn, each after a search for the next one that counts, which goes round for macro cells.
    ///
    /// n is `part` of what the samples per voxel make it.
    fn turns_of_light(&self, variant: &ShaderVariant, functions: Functions, part: f64) -> f64 {
        if self.settings.single_scattering != Some(SingleScattering::March) {
            return 0.0;
        }
        let mask = if variant.holes == "mask" { 10.0 } else { 0.0 };
        let search = match variant.transfer {
            "points" => 2.0 * f64::from((functions.points + 1).ilog2() + 2),
            _ => 0.0,
        };
        let camera = self.camera.frame();
        let clip = self.settings.clip_planes.len() as f64;
        let lights = self.settings.path.lights.iter();
        let ways = lights.map(|light| {
            let way = light.way(&camera).unwrap_or(DVec3::ZERO);
            self.longest_way(way)
        });
        // Those of a point lead anywhere.
        let lamps = self.settings.path.lamps.iter();
        let all = ways.chain(lamps.map(|_| self.grid.diagonal()));
        let turns = all.map(|length| {
            let steps = part * length / self.step_world() + 1.0;
            steps * (7.0 / 8.0 + mask + search) + 6.0 + clip
        });
        turns.sum()
    }

    /// World length of the longest straight line of this direction in the box of the grid.
    fn longest_way(&self, way: DVec3) -> f64 {
        let slopes = self.grid.voxel_rows().map(|row| row.dot(way).abs());
        let far = self.grid.far_corner();
        let lengths = (0..3).map(|k| far[k] / slopes[k].max(1e-20));
        lengths.fold(f64::INFINITY, f64::min)
    }

    /// Whether the loops of the longest ray end where they should on a device that counts their turns.
    ///
    /// # Errors
    /// [`Error::LoopsEnd`].
    pub fn check_turns(
        &self,
        variant: &ShaderVariant,
        volumes: usize,
        functions: Functions,
        max_loop_turns: u32,
    ) -> Result<(), Error> {
        // Of a slicer every invocation takes one sample, and paths end by themselves.
        let technique = self.settings.technique;
        // Fields of points are recorded in parts, and so are splats (`View::splat_sheets_at_once`).
        let is_in_parts = self.settings.field.is_some() || technique.splats();
        if !technique.casts_rays() || technique.traces_paths() || is_in_parts {
            return Ok(());
        }
        let wanted = self.longest_sample_count();
        self.check_loops(variant, volumes, functions, max_loop_turns, wanted)
    }

    /// The same for rays that find the depth of slices, one volume's.
    ///
    /// # Errors
    /// [`Error::LoopsEnd`].
    pub fn check_depth_turns(
        &self,
        variant: &ShaderVariant,
        functions: Functions,
        max_loop_turns: u32,
    ) -> Result<(), Error> {
        let wanted = (self.settings.technique.desc().longest_sample_count)(self);
        self.check_loops(variant, 1, functions, max_loop_turns, wanted)
    }

    fn check_loops(
        &self,
        variant: &ShaderVariant,
        volumes: usize,
        functions: Functions,
        max_loop_turns: u32,
        wanted: f64,
    ) -> Result<(), Error> {
        if max_loop_turns == u32::MAX {
            return Ok(());
        }
        let turns = turns_per_sample(self.settings, variant, volumes, functions) as f64;
        let of_light = |part| self.turns_of_light(variant, functions, part);
        let clip = 2.0 * self.settings.clip_planes.len() as f64;
        let room = (f64::from(max_loop_turns) - SPARE - clip).max(0.0);
        let limit = room / (turns + of_light(1.0));
        if wanted <= limit {
            return Ok(());
        }
        let is_by_voxels = self.settings.technique.draws_stacks();
        // Steps of rays and of light are longer together.
        let fits = |part: f64| part * wanted * (turns + of_light(part)) <= room;
        let part = largest_part(fits);
        let samples_per_voxel = (!is_by_voxels).then_some(self.settings.samples_per_voxel * part);
        Err(Error::LoopsEnd {
            wanted,
            limit,
            samples_per_voxel,
            follows_light: of_light(1.0) > turns,
        })
    }
}

/// The largest number from 0 to 1 that fits, where all below one that fits do: by halving, so that it fits itself.
fn largest_part(fits: impl Fn(f64) -> bool) -> f64 {
    let halved = (0..60).fold([0.0, 1.0], |[low, high], _| {
        let middle = 0.5 * (low + high);
        match fits(middle) {
            true => [middle, high],
            false => [low, middle],
        }
    });
    halved[0]
}
