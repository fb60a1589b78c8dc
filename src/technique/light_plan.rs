//! Light that matter elsewhere takes away: what is asked for, and the coarse grid and the paths by which it is found.
//!
//! ```text
//! cells of an axis   min(voxels, 128), all of one size: none is smaller than a voxel
//! looks at a cell    ceil(voxels of the cell) along each axis, at most 4; of several grids those of the finest
//! sky                32 paths all around, from the node to the end of the grid
//! occlusion          32 paths all around, from one cell to the radius
//! shadow             8 paths over the disc of the light, from the node to the end of the grid
//! ```
//!
//! The first piece of a path is left out for occlusion: else a surface, which is never thinner than a cell there,
//! would darken itself (Hernell, Ljung and Ynnerman, IEEE TVCG 16(4), 2010, begin a voxel away for the same reason).
//! Extinction volumes for this: Schlegel, Makhinya and Pajarola, IEEE TVCG 17(12), 2011.

use super::light_paths::{all_around, path, towards};
use super::{Error, Light, Mode, SingleScattering, View};
use crate::shaders::{FrameFields, LightGrid, LightGridFields};
use crate::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use crate::volume::Grid;
use glam::DVec3;

/// Darkness where little light comes in from all around.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientOcclusion {
    /// How much of the ambient light is taken where nothing comes in, 0 to 1. Without lights all light is ambient.
    pub strength: f64,
    /// World length within which matter is in the way; `None`: a twentieth of the diagonal of the grid box.
    pub radius_world: Option<f64>,
}

/// What keeps lights from a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Shadows {
    /// Nothing.
    #[default]
    Off,
    /// Matter on the way to each light but a headlight, followed once through a coarse grid.
    Volume {
        /// How wide a light looks from the surface: 0 for sharp shadows, the sun 0.5.
        light_size_degrees: f64,
    },
    /// Composite by view-aligned slices, of one volume in one texture: slices half way between eye and light, drawn
    /// into the picture and into what the light sees ([`super::slices_3d::HalfAngleSlicer`]).
    HalfAngle,
}

/// Cells of an axis, at most.
pub const MAX_LIGHT_CELLS: u32 = 128;
/// Cells along a radius of occlusion, at most: farther away there is no end of the work.
pub const MAX_RADIUS_CELLS: f64 = 64.0;
/// Voxels that a product of matrices may be off by.
const ROUNDING: f64 = 1e-6;
/// Looks at a cell along an axis, at most.
const MAX_LOOKS: u32 = 4;
/// Part of the diagonal of the grid box.
const DEFAULT_RADIUS: f64 = 0.05;

/// What one light volume is made of and for.
#[derive(Clone, Debug, PartialEq)]
pub struct LightPlan {
    /// Cells along each axis.
    pub cells: [u32; 3],
    /// Size of a cell in voxel space.
    pub cell_voxels: [f64; 3],
    /// World length of the shortest side of a cell.
    pub cell_length: f64,
    /// Looks at a cell along each axis.
    pub looks: [u32; 3],
    /// A cell has the mean of the extinctions that are found there, and not that of opacities: where light is asked for inside
    /// of matter.
    pub adds_extinctions: bool,
    /// How many bundles of paths there are: that of occlusion first, then one a light.
    pub bundle_count: u32,
    /// As `shaders/light_volume.wgsl` reads them.
    pub paths: Vec<[f32; 4]>,
}

impl LightPlan {
    /// The grid of the light volume of such a view, without paths.
    fn grid_of(view: &View) -> Self {
        let dims = view.grid.dims;
        let cells = dims.map(|n| n.min(MAX_LIGHT_CELLS));
        let cell_voxels: [f64; 3] =
            std::array::from_fn(|k| f64::from(dims[k]) / f64::from(cells[k]));
        let spacing = view.grid.spacing();
        let sides = (0..3).filter(|&k| dims[k] > 1);
        let sides = sides.map(|k| spacing[k] * cell_voxels[k]);
        Self {
            cells,
            cell_voxels,
            cell_length: sides
                .reduce(f64::min)
                .unwrap_or_else(|| view.grid.smallest_spacing()),
            looks: cell_voxels.map(|n| (n.ceil() as u32).clamp(1, MAX_LOOKS)),
            adds_extinctions: view.settings.single_scattering.is_some(),
            bundle_count: 0,
            paths: Vec::new(),
        }
    }

    /// Looks as often as the voxels of another grid ask for, which matter on `first` is seen together with: nothing of a
    /// finer grid is passed over.
    pub(crate) fn look_at(&mut self, first: &Grid, other: &Grid) {
        let own = other.world_from_voxel.inverse() * first.world_from_voxel;
        for (k, looks) in self.looks.iter_mut().enumerate() {
            let side = own.matrix3.col(k) * self.cell_voxels[k];
            let voxels = (side.abs().max_element() - ROUNDING).ceil();
            *looks = (*looks).max((voxels as u32).min(MAX_LOOKS));
        }
    }

    /// Bytes of the light volume of a volume of these dims with so many bundles, and of the cells that it is made from.
    pub fn bytes(dims: [u32; 3], bundle_count: u32) -> u64 {
        let cells = dims.map(|n| n.min(MAX_LIGHT_CELLS));
        let product = |more: u32| cells.iter().map(|&n| u64::from(n + more)).product::<u64>();
        match bundle_count {
            0 => 0,
            count => 4 * (product(0) + u64::from(count) * product(1)),
        }
    }

    /// Numbers of the light volume.
    pub fn node_count(&self) -> u64 {
        let nodes: u64 = self.cells.iter().map(|&n| u64::from(n) + 1).product();
        nodes * u64::from(self.bundle_count)
    }

    /// Cells of the grid.
    pub fn cell_count(&self) -> u64 {
        self.cells.iter().map(|&n| u64::from(n)).product()
    }

    /// The parameters of the passes that make the light volume.
    pub fn parameters(&self) -> LightGrid {
        LightGridFields {
            cells: self.cells,
            bundle_count: self.bundle_count,
            cell_voxels: self.cell_voxels.map(|n| n as f32),
            cell_length: self.cell_length as f32,
            looks: self.looks,
            adds_extinctions: self.adds_extinctions.into(),
        }
        .into()
    }
}

impl View<'_> {
    /// The light volume that such pictures read; `None` where they read none.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a radius that is none or spans more than [`MAX_RADIUS_CELLS`] cells,
    /// [`Error::NoWayToLight`].
    pub fn light_plan(&self) -> Result<Option<LightPlan>, Error> {
        let mut plan = LightPlan::grid_of(self);
        let mut bundles: Vec<(Vec<DVec3>, [f64; 2])> = Vec::new();
        if let Some(radius) = self.occlusion_radius(&plan)? {
            let start = plan.cell_length.min(0.5 * radius);
            bundles.push((all_around(), [start, radius]));
        }
        if self.settings.has_hindered_sky() {
            bundles.push((all_around(), [0.0, f64::INFINITY]));
        }
        if let Some((lights, size_degrees)) = self.settings.shadow_lights() {
            for light in lights {
                let way = light.way(&self.camera.frame())?;
                bundles.push((towards(way, size_degrees), [0.0, f64::INFINITY]));
            }
        }
        if bundles.is_empty() {
            return Ok(None);
        }
        let rows = self.grid.voxel_rows();
        let in_cells = |direction: DVec3| {
            DVec3::from_array(std::array::from_fn(|k| {
                rows[k].dot(direction) / plan.cell_voxels[k]
            }))
        };
        let traced = bundles.iter().map(|(directions, reach)| {
            let weight = 1.0 / directions.len() as f64;
            let paths = directions.iter().flat_map(|&direction| {
                let sides = path(in_cells(direction), *reach, plan.cells);
                let weight = weight / sides.len() as f64;
                sides.into_iter().map(move |pieces| (weight, pieces))
            });
            paths.collect::<Vec<_>>()
        });
        let traced: Vec<Vec<(f64, Vec<[f32; 4]>)>> = traced.collect();
        plan.bundle_count = traced.len() as u32;
        plan.paths = packed(&traced);
        Ok(Some(plan))
    }

    /// The radius of occlusion in world length; `None` without occlusion.
    fn occlusion_radius(&self, plan: &LightPlan) -> Result<Option<f64>, Error> {
        let Some(occlusion) = self.settings.occlusion() else {
            return Ok(None);
        };
        let far = self.grid.world_from_voxel.matrix3 * self.grid.far_corner();
        let longest = MAX_RADIUS_CELLS * plan.cell_length;
        let chosen = (DEFAULT_RADIUS * far.length()).max(2.0 * plan.cell_length);
        let radius = occlusion.radius_world.unwrap_or(chosen.min(longest));
        if !(radius > 0.0 && radius <= longest) {
            return Err(Error::OutOfRange {
                name: "the radius of ambient occlusion",
                wanted: "over 0, and at most 64 cells of the light grid",
                found: radius,
            });
        }
        Ok(Some(radius))
    }

    /// Fills the parameters that techniques read of the light volume.
    pub(super) fn set_light(&self, fields: &mut FrameFields) {
        let plan = LightPlan::grid_of(self);
        fields.light_cells = plan.cells.map(|n| n as f32);
        fields.light_cells_per_voxel = plan.cell_voxels.map(|n| (1.0 / n) as f32);
        let settings = self.settings;
        // A surface fills the cell that it lies in.
        fields.light_reach = plan.cell_length as f32;
        let occlusion = settings.occlusion();
        fields.occlusion_strength = match settings.has_hindered_sky() {
            true => 1.0,
            false => occlusion.map_or(0.0, |o| o.strength as f32),
        };
        fields.has_shadows = settings.shadow_lights().is_some().into();
        fields.shadow_bundle = (fields.occlusion_strength != 0.0).into();
    }

    /// What is in the way of light in mode [`Mode::Iso`]: beyond each surface matter as opaque as it over the smallest
    /// voxel spacing. `None` in other modes, whose transfer function says it.
    pub fn matter_of_surfaces(&self) -> Option<TransferFunction> {
        if self.settings.mode != Mode::Iso {
            return None;
        }
        let mut levels = self.settings.per_mode.levels.clone();
        levels.sort_by(|a, b| a.value.total_cmp(&b.value));
        let below = levels.first()?.value - 1.0;
        let point = |value, opacity| OpacityPoint { value, opacity };
        let points = levels.iter().map(|level| point(level.value, level.opacity));
        Some(TransferFunction {
            color: vec![ColorPoint {
                value: below,
                srgb: [0.0; 3],
            }],
            opacity: [point(below, 0.0)].into_iter().chain(points).collect(),
            reference_length: None,
            interpolation: Interpolation::Step,
            gradient_transfer: None,
            medium: None,
        })
    }
}

/// A path in pieces, and how much it counts.
type WeightedPath = (f64, Vec<[f32; 4]>);

/// Bundles, then paths, then pieces, each with where its parts lie.
fn packed(bundles: &[Vec<WeightedPath>]) -> Vec<[f32; 4]> {
    let path_count: usize = bundles.iter().map(Vec::len).sum();
    let (mut heads, mut paths, mut pieces) = (Vec::new(), Vec::new(), Vec::new());
    let first_path = bundles.len();
    let first_piece = first_path + path_count;
    for bundle in bundles {
        let start = first_path + paths.len();
        for (weight, own) in bundle {
            let start = first_piece + pieces.len();
            pieces.extend_from_slice(own);
            let end = first_piece + pieces.len();
            paths.push([start as f32, end as f32, *weight as f32, 0.0]);
        }
        let end = first_path + paths.len();
        heads.push([start as f32, end as f32, 0.0, 0.0]);
    }
    [heads, paths, pieces].concat()
}

impl super::Settings {
    /// The occlusion of such pictures, where it takes light at all.
    pub fn occlusion(&self) -> Option<AmbientOcclusion> {
        self.ambient_occlusion.filter(|o| o.strength != 0.0)
    }

    /// Whether slices lie half way between eye and light.
    pub fn is_half_angle(&self) -> bool {
        let shading = self.shading.as_ref();
        shading.is_some_and(|shading| shading.shadows == Shadows::HalfAngle)
    }

    /// True where light is followed through the volume.
    pub fn wants_light_volume(&self) -> bool {
        let has_sky = self.occlusion().is_some() || self.has_hindered_sky();
        has_sky || self.shadow_lights().is_some()
    }

    /// The lights whose shadows are followed through a volume, and how wide they look. None where the light is a
    /// headlight, which shines on all that is seen.
    fn shadow_lights(&self) -> Option<(&[Light], f64)> {
        if let Some(scattering) = self.single_scattering {
            let path = &self.path;
            let is_there = scattering == SingleScattering::Volume && !path.lights.is_empty();
            return is_there.then_some((&path.lights, path.light_size_degrees));
        }
        let shading = self.shading.as_ref()?;
        match shading.shadows {
            Shadows::Volume { light_size_degrees } if !shading.lights.is_empty() => {
                Some((&shading.lights, light_size_degrees))
            }
            _ => None,
        }
    }

    /// Whether the numbers of occlusion and shadows mean something.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub(super) fn check_light(&self) -> Result<(), Error> {
        let strength = self.ambient_occlusion.map_or(0.0, |o| o.strength);
        let is_share = (0.0..=1.0).contains(&strength);
        Error::unless(
            is_share,
            "the strength of ambient occlusion",
            "0 to 1",
            strength,
        )?;
        let size = self.shadow_lights().map_or(0.0, |(_, size)| size);
        let is_angle = (0.0..=90.0).contains(&size);
        Error::unless(is_angle, "the size of lights", "0 to 90 degrees", size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DMat3, dvec3};

    #[test]
    fn cells_are_looked_at_as_often_as_the_finest_grid_has_voxels_there() {
        let sheared = DMat3::from_cols(
            dvec3(1.1, 0.2, -0.1),
            dvec3(-0.3, 0.9, 0.2),
            dvec3(0.1, 0.3, 1.6),
        );
        let grid = |matrix3, dims| Grid {
            dims,
            world_from_voxel: DAffine3::from_mat3_translation(matrix3, dvec3(25.0, -8.0, 1e3)),
        };
        let first = grid(sheared, [9, 8, 7]);
        let finer = |factors: [f64; 3]| {
            let scale = DMat3::from_diagonal(dvec3(factors[0], factors[1], factors[2]));
            grid(sheared * scale.inverse(), [9, 8, 7])
        };
        let looks = |other: &Grid| {
            let mut plan = LightPlan {
                cells: first.dims,
                cell_voxels: [1.0; 3],
                cell_length: 1.0,
                looks: [1; 3],
                adds_extinctions: false,
                bundle_count: 0,
                paths: Vec::new(),
            };
            plan.look_at(&first, other);
            plan.looks
        };
        assert_eq!(looks(&first), [1; 3], "no more than for one volume");
        assert_eq!(looks(&finer([2.0, 1.0, 3.0])), [2, 1, 3]);
        assert_eq!(looks(&finer([0.4, 1.5, 90.0])), [1, 2, 4], "at most four");
    }
}
