//! The Gaussian that a voxel is, in voxel space, and what of it the parameters hold.
//!
//! With h the standard deviation in voxels, A the linear part of world_from_voxel, p the world length of a pixel at
//! the centre of the box, rho the low pass in pixels and D the smallest spacing,
//!
//! ```text
//! M = (h^2 I + lambda A^-1 A^-T)^-1        lambda = max(0, (rho p)^2 - (h D)^2)
//! R = sqrt(2 bits ln 2)                    e^(-R^2 / 2) = 2^-bits
//! ```
//!
//! A splat that is widened keeps its integral: it is less high (Zwicker et al. 2001 widen the picture of a splat, here
//! it is the splat itself).

use super::line::Line;
use super::{Sheets, Splat, sheets_of, uses_stack};
use crate::lattice::main_axis;
use crate::technique::stack_axis::stack_axis;
use crate::technique::{Error, Technique, View};
use glam::{DMat3, DVec3};

/// Sheets that one slice of voxels may reach into: as many as the shader has room for.
pub const MAX_OPEN_SHEETS: usize = 24;
/// Rays that are steeper beside the slices of a stack than this are refused.
const STEEPEST_DEGREES: f64 = 75.0;
/// Rays across and down that are looked at for all of a picture, those of its corners among them.
const RAYS: u32 = 33;

/// A Gaussian of integral 1 that ends where it has fallen to a part of its peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kernel {
    /// The inverse of its covariance, in voxel space.
    pub precision: DMat3,
    /// Where it ends, in standard deviations.
    pub reach: f64,
}

impl Kernel {
    /// That of a picture.
    pub fn of(view: &View) -> Self {
        let splat = view.settings.splat;
        let std_world = splat.std * view.grid.smallest_spacing();
        let widened = std_world.powi(2) * (view.splat_widening().powi(2) - 1.0);
        let inverse = view.world_from_voxel().matrix3.inverse();
        let covariance = DMat3::from_diagonal(DVec3::splat(splat.std.powi(2)))
            + inverse * inverse.transpose() * widened;
        Self {
            precision: covariance.inverse(),
            reach: reach_of(&splat),
        }
    }

    /// sqrt(det M) / (2 pi (1 - e^(-R^2 / 2))): over sqrt(d.Md) the largest integral along a ray of direction d. What
    /// is cut off is given to the rest.
    pub fn peak(&self) -> f64 {
        let kept = 1.0 - (-0.5 * self.reach.powi(2)).exp();
        self.precision.determinant().sqrt() / (std::f64::consts::TAU * kept)
    }

    /// How far it reaches along each axis, in voxels.
    pub fn halo(&self) -> DVec3 {
        let covariance = self.precision.inverse();
        let deviations = [0, 1, 2].map(|k| covariance.col(k)[k].sqrt());
        self.reach * DVec3::from_array(deviations)
    }
}

/// Standard deviations at which a splat has fallen to its last part.
pub(super) fn reach_of(splat: &Splat) -> f64 {
    (2.0 * f64::from(splat.cut_bits) * std::f64::consts::LN_2).sqrt()
}

/// Fields of the frame by the same names.
#[derive(Default)]
pub(in crate::technique) struct OfSplats {
    pub splat_diagonal: [f32; 3],
    pub splat_mixed: [f32; 3],
    pub splat_reach: f32,
    pub splat_peak: f32,
    pub splat_first: [i32; 3],
    pub splat_last: [i32; 3],
    pub splat_halo: [f32; 3],
    pub part_end: u32,
}

impl View<'_> {
    /// By how much the low pass makes a splat wider than it is along the smallest spacing, max(1, rho p / (h D)); 1 for
    /// other techniques. Sheets are as much thicker: wider splats need no thinner ones, and reach into as many.
    pub(in crate::technique) fn splat_widening(&self) -> f64 {
        // Scattered points are widened one by one.
        if self.settings.technique != Technique::Splat || self.settings.splat.of_points {
            return 1.0;
        }
        let splat = self.settings.splat;
        let rays = self.rays();
        let longest = |x: DVec3, y: DVec3| x.length().max(y.length());
        // The world is moved so that the centre of the box is its origin.
        let depth = (-rays.forward.dot(rays.origin)).max(0.0);
        let pixel = longest(rays.origin_dx, rays.origin_dy)
            + depth * longest(rays.direction_dx, rays.direction_dy);
        (splat.low_pass * pixel / (splat.std * self.grid.smallest_spacing())).max(1.0)
    }

    /// The parameters of splats; nothing for other techniques.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] where more sheets are open at a time than there is room for, and [`Error::NotFor`] for an
    /// eye, or rays, that slices of a stack are not for.
    pub(in crate::technique) fn of_splats(&self) -> Result<OfSplats, Error> {
        if self.settings.technique != Technique::Splat {
            return Ok(OfSplats::default());
        }
        if self.settings.splat.of_points {
            return Ok(OfSplats {
                splat_reach: reach_of(&self.settings.splat) as f32,
                ..OfSplats::default()
            });
        }
        let kernel = Kernel::of(self);
        if uses_stack(self.settings) {
            self.check_stack()?;
        } else if sheets_of(self.settings.mode, self.settings.splat.sheets) == Sheets::Image {
            self.check_open_sheets()?;
        }
        let m = kernel.precision;
        let [low, high] = self.domain();
        // A little more than it reaches: rounding loses nothing.
        let halo = kernel.halo() + 0.01;
        Ok(OfSplats {
            splat_diagonal: [0, 1, 2].map(|k| m.col(k)[k] as f32),
            splat_mixed: [m.col(1)[2] as f32, m.col(0)[2] as f32, m.col(0)[1] as f32],
            splat_reach: kernel.reach as f32,
            splat_peak: kernel.peak() as f32,
            splat_first: (low - 0.5).ceil().as_ivec3().to_array(),
            splat_last: ((high - 0.5).ceil() - 1.0).as_ivec3().to_array(),
            splat_halo: halo.as_vec3().to_array(),
            part_end: i32::MAX as u32,
        })
    }

    /// Rays through pixels that lie evenly over the picture, its corners among them: origin and direction in voxel
    /// space for unit directions in the world, and the cosine of their angle to the forward direction.
    pub(super) fn some_rays(&self) -> impl Iterator<Item = (DVec3, DVec3, f64)> {
        let rays = self.rays();
        let voxel_from_world = self.world_from_voxel().inverse();
        let [width, height] = self.extent_pixels.map(f64::from);
        (0..RAYS * RAYS).map(move |i| {
            let at = |i: u32, pixels: f64| f64::from(i) * pixels / f64::from(RAYS - 1);
            let (x, y) = (at(i % RAYS, width), at(i / RAYS, height));
            let direction = rays.direction + x * rays.direction_dx + y * rays.direction_dy;
            let direction = direction.normalize();
            (
                voxel_from_world
                    .transform_point3(rays.origin + x * rays.origin_dx + y * rays.origin_dy),
                voxel_from_world.transform_vector3(direction),
                rays.forward.dot(direction),
            )
        })
    }

    /// How many image-aligned sheets a slice of splats reaches into at most.
    pub(crate) fn open_sheets(&self) -> f64 {
        let kernel = Kernel::of(self);
        let step = self.step_world();
        let open = self.some_rays().map(|(origin, direction, cosine)| {
            let (o, d) = (origin.to_array(), direction.to_array());
            let line = Line::of_kernel(&kernel, main_axis(d), o, d);
            2.0 * line.reach * cosine / step
        });
        // The sheets at both ends are cut by the reach.
        open.fold(0.0, f64::max) + 2.0
    }

    fn check_open_sheets(&self) -> Result<(), Error> {
        let open = self.open_sheets();
        Error::unless(
            open <= MAX_OPEN_SHEETS as f64,
            "the number of image-aligned sheets that a slice of splats reaches into",
            "24 at most: fewer samples per voxel make sheets thicker",
            open.ceil(),
        )
    }

    /// Slices of a stack are met from one side, by rays that are not too steep.
    fn check_stack(&self) -> Result<(), Error> {
        let axis = stack_axis(self);
        let refused = |found: String| {
            Err(Error::NotFor {
                wanted: "splatting in axis-aligned sheets, or in none,",
                of: "an eye outside of their slices and rays up to 75 degrees off their normal: image-aligned sheets are for all",
                found,
            })
        };
        let slices = f64::from(self.grid.dims[axis]);
        if self.camera.projection.is_perspective() {
            let inverse = self.grid.world_from_voxel.inverse();
            let eye = inverse.transform_point3(self.camera.eye)[axis];
            if (0.0..=slices).contains(&eye) {
                return refused(format!("an eye at height {eye:.1} of {slices} slices"));
            }
        }
        let cosine = |d: DVec3| d[axis].abs() / d.length();
        let least = self.some_rays().map(|(_, d, _)| cosine(d));
        let degrees = least.fold(1.0, f64::min).acos().to_degrees();
        match degrees <= STEEPEST_DEGREES {
            true => Ok(()),
            false => refused(format!("rays {degrees:.0} degrees off it")),
        }
    }
}
