//! Camera, grid and settings to the parameters that shaders and CPU references share: pure, set up once in f64.
//!
//! The world is moved so that the centre of the uncropped grid box is its origin: f32 then keeps the same
//! precision wherever the volume lies, and the planes n . x = (k + 1/2) h pass by the centre as
//! `sampling.md` 3 wants them.

use super::blend::extreme_sign;
use super::clip_rows::clip_rows;
use super::shading::set_shading;
use super::shear_warp::{BasePlane, intermediate_room};
use super::stack_axis::stack_axis;
use super::{Filter, InPixel, Lattice, MAX_SAMPLES_PER_RAY, Settings};
use crate::camera::{Camera, Rays};
use crate::picture::ColorSpace;
use crate::resident::{Cell, Coding, TransferLayout, front_to_back, front_to_back_by_rows};
use crate::shaders::{
    FrameFields, KERNEL_CATMULL_ROM, KERNEL_CUBIC, KERNEL_QUADRATIC, MAX_CLIP_PLANES,
};
use crate::technique::Error;
use crate::transfer::Interpolation;
use crate::volume::{Grid, kernel::Kernel};
use glam::{DAffine3, DMat3, DVec3, dvec3};

/// What one picture is taken of, and how.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The grid of the volume.
    pub grid: &'a Grid,
    /// The eye.
    pub camera: &'a Camera,
    /// Pixels across and down.
    pub extent_pixels: [u32; 2],
    /// Where in a pixel its ray goes through.
    pub in_pixel: InPixel,
    /// The words of the picture.
    pub settings: &'a Settings,
}

/// The number of the kernel in the parameters.
fn kernel_number(filter: Filter) -> u32 {
    match filter.kernel() {
        Some(Kernel::Cubic) => KERNEL_CUBIC,
        Some(Kernel::CatmullRom) => KERNEL_CATMULL_ROM,
        Some(Kernel::Quadratic) | None => KERNEL_QUADRATIC,
    }
}

impl View<'_> {
    /// World length of a step: the smallest spacing over the samples per voxel, as much longer as pixels make splats wider;
    /// of rays through a base plane the distance of slices over that, of a field of points its radius.
    pub fn step_world(&self) -> f64 {
        if self.settings.technique.is_warped() {
            let row = self.grid.voxel_rows()[stack_axis(self)];
            return 1.0 / (row.length() * self.settings.samples_per_voxel);
        }
        if let Some(field) = &self.settings.field {
            return field.radius / self.settings.samples_per_voxel;
        }
        let spacing = self.grid.smallest_spacing() * self.splat_widening();
        spacing / self.settings.samples_per_voxel
    }

    /// The part of the grid that is kept, in voxel space.
    pub fn domain(&self) -> [DVec3; 2] {
        let far = self.grid.far_corner();
        let [low, high] = self.settings.crop.unwrap_or([DVec3::ZERO, far]);
        [low.max(DVec3::ZERO), high.min(far)]
    }

    /// The centred world to voxel space and back.
    pub fn world_from_voxel(&self) -> DAffine3 {
        DAffine3::from_translation(-self.grid.center()) * self.grid.world_from_voxel
    }

    /// The rays of the picture in the centred world.
    pub fn rays(&self) -> Rays {
        let mut rays = self.camera.rays(self.extent_pixels);
        let [x, y] = self.in_pixel.at;
        rays.origin += x * rays.origin_dx + y * rays.origin_dy - self.grid.center();
        rays.direction += x * rays.direction_dx + y * rays.direction_dy;
        rays
    }

    /// The parameters of the whole grid, without those of slices.
    ///
    /// # Errors
    /// [`Error::TooManySamples`], [`Error::TooManyClipPlanes`], those of lights and of [`Settings::check`].
    pub fn fields(&self, coding: &Coding, transfer: &TransferLayout) -> Result<FrameFields, Error> {
        self.settings.check()?;
        let base = self.base_plane()?;
        let rays = base.map_or_else(|| self.rays(), |base| base.rays);
        let extent_pixels = base.map_or(self.extent_pixels, |base| base.extent);
        let world_from_voxel = self.world_from_voxel();
        let [domain_min, domain_max] = self.domain();
        self.check_sample_count()?;
        let of_mode = self.of_mode();
        let of_faces = self.settings.of_faces();
        let of_splats = self.of_splats()?;
        let patterns = self.of_patterns();
        let (tone, tone_gain) = self.settings.of_tone();
        let reach = self.cover_reach();
        let margin = self.cover_margin(&rays, &world_from_voxel) + reach.voxels;
        let (clip_planes, clip_plane_count) = self.clip_planes()?;
        let v = |v: DVec3| v.as_vec3().to_array();
        let forward_voxel = world_from_voxel.matrix3.transpose() * rays.forward;
        let mut fields = FrameFields {
            origin: v(rays.origin),
            origin_dx: v(rays.origin_dx),
            origin_dy: v(rays.origin_dy),
            direction: v(rays.direction),
            direction_dx: v(rays.direction_dx),
            direction_dy: v(rays.direction_dy),
            forward: v(rays.forward),
            forward_voxel: v(forward_voxel),
            step_world: self.step_world() as f32,
            termination: if self.settings.conformance {
                0.0
            } else {
                self.settings.termination
            },
            code_scale: coding.scale,
            code_offset: coding.offset,
            slope: coding.slope,
            intercept: coding.intercept,
            codes_are_integers: coding.is_integer.into(),
            domain_min: v(domain_min),
            domain_max: v(domain_max),
            cover_min: v(domain_min - margin),
            cover_max: v(domain_max + margin),
            dims: self.grid.dims.map(|n| n as f32),
            voxel_from_world: affine_rows(&world_from_voxel.inverse()),
            world_from_voxel: affine_rows(&world_from_voxel),
            clip_from_world: clip_rows(&rays, extent_pixels),
            clip_planes,
            clip_plane_count,
            table_count: transfer.table_count,
            table_first: transfer.table_first,
            table_scale: transfer.table_scale,
            reference_length: transfer.reference_length,
            color_point_count: transfer.color_point_count,
            opacity_point_count: transfer.opacity_point_count,
            first_widget_entry: transfer.first_widget_entry,
            interpolation_is_step: (transfer.interpolation == Interpolation::Step).into(),
            color_space_is_display: (transfer.colors_are_linear
                || self.settings.color_space == ColorSpace::Display)
                .into(),
            emission_point_count: transfer.emission_point_count,
            opacity_is_extinction: transfer.opacity_is_extinction.into(),
            extinction_is_colored: transfer.extinction_is_colored.into(),
            brick_dims: self.grid.dims.map(|n| n as f32),
            is_first_brick: 1,
            is_only_brick: 1,
            extent_pixels,
            slice_direction: 1,
            slab_first: transfer.slab_first,
            slab_scale: transfer.slab_scale,
            slab_count: transfer.slab_count,
            planes_per_slice: 1.0,
            cover_eye_reach: reach.eye,
            is_jittered: patterns.is_jittered,
            jitter: patterns.jitter,
            jitter_shift: patterns.jitter_shift,
            is_uneven: patterns.is_uneven,
            cell_seed: patterns.cell_seed,
            cell_pixels: patterns.cell_pixels,
            kernel: kernel_number(self.settings.filter),
            extreme_sign: extreme_sign(self.settings.mode),
            value_low: of_mode.value_low,
            value_scale: of_mode.value_scale,
            lmip_threshold: of_mode.lmip_threshold,
            mida_fade: of_mode.mida_fade,
            mida_mip: of_mode.mida_mip,
            attenuation: of_mode.attenuation,
            depth_cue: of_mode.depth_cue,
            depth_near: of_mode.depth_near,
            depth_scale: of_mode.depth_scale,
            level_count: of_mode.level_count,
            level_values: of_mode.level_values,
            level_colors: of_mode.level_colors,
            smallest_spacing: self.grid.smallest_spacing() as f32,
            samples_per_voxel: self.settings.samples_per_voxel as f32,
            gradient_operator: self.settings.gradient_operator().number(),
            gradient_scale: coding.scale,
            gradient_codes_are_integers: coding.is_integer.into(),
            dim: self.settings.dim as f32,
            cut_faces: of_faces.cut_faces,
            cut_low: of_faces.cut_low,
            cut_scale: of_faces.cut_scale,
            is_last_brick: 1,
            patch_pixels: self.patch_pixels(),
            patch_reach_voxels: self.patch_reach_voxels() as f32,
            patch_reach_planes: if self.settings.preintegrated {
                0.5
            } else {
                0.0
            },
            host_near: 0.5,
            plane_offset: base.map_or(0.0, |base| base.offset_world as f32),
            base_from_pixel: base.map_or([[0.0; 4]; 3], |base| rows_of(base.base_from_pixel)),
            splat_diagonal: of_splats.splat_diagonal,
            splat_reach: of_splats.splat_reach,
            splat_mixed: of_splats.splat_mixed,
            splat_peak: of_splats.splat_peak,
            splat_first: of_splats.splat_first,
            splat_last: of_splats.splat_last,
            splat_halo: of_splats.splat_halo,
            part_end: of_splats.part_end,
            tone,
            tone_gain,
            // What a brick, slices, channels, lights, cells and a host's depth say of themselves, where there are any.
            ..bytemuck::Zeroable::zeroed()
        };
        self.set_light(&mut fields);
        if let Some(shading) = &self.settings.shading {
            let camera = self.camera.frame();
            set_shading(shading, &camera, self.settings.color_space, &mut fields)?;
        }
        if self.settings.technique.traces_paths() {
            self.set_paths(&mut fields)?;
        }
        if let Some(scattering) = self.settings.single_scattering {
            self.set_scattering(scattering, &mut fields)?;
        }
        Ok(fields)
    }

    /// The plane whose points rays go through, where they are not the pixels of the picture.
    ///
    /// # Errors
    /// Those of [`shear_warp::base_plane`](super::shear_warp::base_plane).
    pub(crate) fn base_plane(&self) -> Result<Option<BasePlane>, Error> {
        let of = self.settings.technique.desc().base_plane;
        of.map(|base_plane| base_plane(self)).transpose()
    }

    /// Pixels of the intermediate image, or more; one where there is none.
    ///
    /// # Errors
    /// As [`Self::base_plane`].
    pub(crate) fn intermediate_room(&self) -> Result<[u32; 2], Error> {
        let Some(base) = self.base_plane()? else {
            return Ok([1; 2]);
        };
        let room = intermediate_room(self.grid, self.settings, self.extent_pixels);
        Ok([0, 1].map(|k| room[k].max(base.extent[k])))
    }

    /// Narrows the parameters to one of several bricks. `is_first`: no nearer one has been recorded.
    pub fn set_brick(&self, cell: &Cell, is_first: bool, fields: &mut FrameFields) {
        let [low, high] = self.part(Some(cell));
        for k in 0..3 {
            let margin = fields.domain_min[k] - fields.cover_min[k];
            fields.cover_min[k] = low[k] as f32 - margin;
            fields.cover_max[k] = high[k] as f32 + margin;
            // Rounding may take a sample a little out of the grid: the outer bricks have no outer face.
            let own = &cell.own;
            let is_outer = [own.min[k] == 0, own.max[k] == self.grid.dims[k]];
            fields.brick_min[k] = if is_outer[0] {
                f32::MIN
            } else {
                own.min[k] as f32
            };
            fields.brick_max[k] = if is_outer[1] {
                f32::MAX
            } else {
                own.max[k] as f32
            };
        }
        fields.brick_origin = cell.stored.min.map(|n| n as f32);
        fields.brick_dims = cell.stored.dims().map(|n| n as f32);
        fields.is_first_brick = is_first.into();
        fields.is_only_brick = 0;
    }

    /// The part of the domain that lies in a brick, or all of it.
    pub fn part(&self, cell: Option<&Cell>) -> [DVec3; 2] {
        let [low, high] = self.domain();
        let corner = |voxel: [u32; 3]| DVec3::from_array(voxel.map(f64::from));
        match cell {
            Some(cell) => [
                low.max(corner(cell.own.min)),
                high.min(corner(cell.own.max)),
            ],
            None => [low, high],
        }
    }

    /// The order in which every ray meets the bricks.
    pub fn front_to_back(&self, cells: &[Cell]) -> Vec<usize> {
        front_to_back(cells, self.eye_cell(cells[0].own.dims()))
    }

    /// Such an order in which neighbours along x stand together.
    pub fn front_to_back_by_rows(&self, cells: &[Cell]) -> Vec<usize> {
        front_to_back_by_rows(cells, self.eye_cell(cells[0].own.dims()))
    }

    /// Where the eye lies, in cells of so many voxels; infinite for parallel rays.
    pub(super) fn eye_cell(&self, size: [u32; 3]) -> [f64; 3] {
        match self.camera.projection.is_perspective() {
            true => {
                let eye = self
                    .grid
                    .world_from_voxel
                    .inverse()
                    .transform_point3(self.camera.eye);
                std::array::from_fn(|k| eye[k] / f64::from(size[k]))
            }
            false => {
                let forward = self.rays().forward;
                self.grid
                    .voxel_rows()
                    .map(|row| -f64::INFINITY.copysign(row.dot(forward)))
            }
        }
    }

    /// A 2D stack takes one sample a slice, whatever the step.
    fn check_sample_count(&self) -> Result<(), Error> {
        if self.settings.technique.draws_stacks() {
            return Ok(());
        }
        let wanted = self.longest_sample_count();
        if wanted <= f64::from(MAX_SAMPLES_PER_RAY) {
            return Ok(());
        }
        Err(Error::TooManySamples {
            wanted,
            limit: MAX_SAMPLES_PER_RAY,
        })
    }

    /// How many steps the longest ray takes, which is the longest diagonal of the box; along their main axes rays take so
    /// many for each of its voxels.
    pub(super) fn longest_sample_count(&self) -> f64 {
        if self.settings.lattice == Lattice::Bresenham && self.settings.technique.casts_rays() {
            return self.settings.samples_per_voxel * self.grid.far_corner().max_element();
        }
        let m = self.world_from_voxel().matrix3;
        let far = self.grid.far_corner();
        let diagonals = [
            dvec3(1., 1., 1.),
            dvec3(1., 1., -1.),
            dvec3(1., -1., 1.),
            dvec3(-1., 1., 1.),
        ];
        let longest = diagonals
            .map(|d| (m * (d * far)).length())
            .into_iter()
            .fold(0.0, f64::max);
        longest / self.step_world()
    }

    /// By how many voxels a slicer's cover is larger than the domain: two pixels, as the farthest corner
    /// sees them. Rounding in the rasterizer then never uncovers a pixel.
    fn cover_margin(&self, rays: &Rays, world_from_voxel: &DAffine3) -> DVec3 {
        let far = self.grid.far_corner();
        let corner = |i: u32| far * dvec3((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into());
        let depth = |i: u32| {
            rays.forward
                .dot(world_from_voxel.transform_point3(corner(i)) - rays.origin)
        };
        let farthest = (0..8).map(depth).fold(0.0, f64::max);
        let side = |dx: DVec3, dy: DVec3| dx.length().max(dy.length());
        let pixel_world = side(rays.origin_dx, rays.origin_dy)
            + side(rays.direction_dx, rays.direction_dy) * farthest;
        let rows = self.grid.voxel_rows().map(|row| row.length());
        2.0 * pixel_world * DVec3::from_array(rows) + 1e-3
    }

    fn clip_planes(&self) -> Result<([[f32; 4]; MAX_CLIP_PLANES as usize], u32), Error> {
        let wanted = &self.settings.clip_planes;
        let mut planes = [[0.0; 4]; MAX_CLIP_PLANES as usize];
        if wanted.len() > planes.len() {
            return Err(Error::TooManyClipPlanes {
                wanted: wanted.len(),
                limit: planes.len(),
            });
        }
        for (plane, found) in planes.iter_mut().zip(wanted) {
            let offset = found.offset - found.normal.dot(self.grid.center());
            // Normals of any length: a power of two changes no digit.
            let largest = found.normal.abs().max_element();
            let scale = if largest > 0.0 {
                (-largest.log2().floor()).exp2()
            } else {
                1.0
            };
            let limit = f64::from(f32::MAX);
            let scaled = (scale * found.normal).extend((scale * offset).clamp(-limit, limit));
            *plane = scaled.as_vec4().to_array();
        }
        Ok((planes, wanted.len() as u32))
    }
}

fn rows_of(m: DMat3) -> [[f32; 4]; 3] {
    [0, 1, 2].map(|k| m.row(k).extend(0.0).as_vec4().to_array())
}

pub(super) fn affine_rows(affine: &DAffine3) -> [[f32; 4]; 3] {
    let (m, t) = (affine.matrix3, affine.translation);
    [0, 1, 2].map(|k| m.row(k).extend(t[k]).as_vec4().to_array())
}
