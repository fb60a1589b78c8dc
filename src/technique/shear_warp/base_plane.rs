//! The base plane of a view: a plane between the slices, whose points are the pixels of the intermediate image.
//!
//! ```text
//! base pixel (U, V)     u = (U + 1/2) / q, v = (V + 1/2) / q along the two axes of the plane, in voxels; U, V whole
//! its ray               perspective     from the eye e through b(u, v)
//!                       orthographic    along the view, from the plane through the eye
//! slices                n . x = (k + 1/2) h + c, n the unit normal of the slices away from the eye, h their distance
//! a picture's pixel     its ray v(t) = o + t d in voxel space meets the plane z at o + ((z - o_k) / d_k) d, so
//!                       (w U, w V, w) = s (q (d_k o_i + (z - o_k) d_i), .., d_k), linear in (x, y, 1), s the sign that
//!                       makes w positive before the eye
//! ```
//!
//! Both maps are projective, the second one is kept as a matrix. Lacroute and Levoy, "Fast Volume Rendering Using a
//! Shear-Warp Factorization of the Viewing Transformation", SIGGRAPH 1994.

use super::Intermediate;
use crate::camera::Rays;
use crate::technique::stack_axis::stack_axis;
use crate::technique::{Error, Settings, View};
use crate::volume::Grid;
use glam::{DMat3, DVec2, DVec3, dvec2, dvec3};
use std::cmp::Ordering;

/// Base pixels around what a picture sees: of bilinear warps one, and one for rounding.
const MARGIN: f64 = 2.0;
/// What a host makes room for, beyond what parallel rays at any angle up to 45 degrees beside the slices need.
const ROOM: f64 = 1.25;
/// Base pixels along a side at most: rays that run beside the slices meet the plane anywhere.
const MOST_ACROSS: u32 = 1 << 14;

/// The rays of the intermediate image, its slices and its place in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BasePlane {
    /// The axis across its slices.
    pub axis: usize,
    /// Base pixels per voxel.
    pub per_voxel: f64,
    /// The rays of base pixels in the centred world, as a camera has those of pixels.
    pub rays: Rays,
    /// Base pixels across and down.
    pub extent: [u32; 2],
    /// Where a pixel lies in the intermediate image: homogeneous, of (x, y, 1).
    pub base_from_pixel: DMat3,
    /// The distance of two heights with samples, world length.
    pub step_world: f64,
    /// Where they lie: n . x = (k + 1/2) `step_world` + this.
    pub offset_world: f64,
}

/// The two axes of a plane across `axis`, in order.
pub(super) fn axes_across(axis: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][axis]
}

/// The base plane of a view.
///
/// # Errors
/// [`Error::EyeAmongSlices`], [`Error::IntermediateTooLarge`].
pub fn base_plane(view: &View) -> Result<BasePlane, Error> {
    let axis = stack_axis(view);
    let across = axes_across(axis);
    let [low, high] = view.domain();
    let height = 0.5 * (low[axis] + high[axis]);
    let of_pixels = VoxelRays::new(view, &whole_pixel_rays(view));
    of_pixels.check_eye(view, axis)?;
    let on_plane = OnPlane {
        axis,
        across,
        height,
    };
    let per_voxel = match view.settings.intermediate {
        Intermediate::PerVoxel(per_voxel) => per_voxel,
        Intermediate::Pixels => on_plane.pixels_per_voxel(&of_pixels, view.extent_pixels),
    };
    let seen = on_plane.seen(&of_pixels, [low, high], view.extent_pixels);
    let first = (seen[0] * per_voxel - 0.5).floor() - MARGIN;
    let last = (seen[1] * per_voxel - 0.5).ceil() + MARGIN;
    let extent = (last - first + 1.0).max(DVec2::ONE);
    if extent.max_element().partial_cmp(&MOST_ACROSS.into()) != Some(Ordering::Less) {
        return Err(Error::IntermediateTooLarge {
            wanted: extent.to_array(),
            limit: [MOST_ACROSS; 2],
        });
    }
    let in_pixel = VoxelRays::new(view, &view.rays());
    let rays = on_plane.rays(view, first, per_voxel);
    let (step_world, offset_world) = heights(view, axis, rays.forward);
    Ok(BasePlane {
        axis,
        per_voxel,
        rays,
        extent: extent.to_array().map(|n| n as u32),
        base_from_pixel: on_plane.base_from_pixel(&in_pixel, first, per_voxel),
        step_world,
        offset_world,
    })
}

/// Room for the intermediate images of a grid and a picture from wherever they are seen, base pixels across and down. Few views
/// ask for more: in perspective those from very near, and those of a stack that is not the one that faces the eye.
///
/// A parallel ray runs beside its main axis by at most as much as along it, in world lengths, so that the shadow of n_k slices on
/// the plane is longer than that by n_k times the ratio of spacings.
pub(crate) fn intermediate_room(
    grid: &Grid,
    settings: &Settings,
    extent_pixels: [u32; 2],
) -> [u32; 2] {
    let rows = grid.voxel_rows().map(|row| row.length());
    let of_axis = |axis: usize| {
        let slices = f64::from(grid.dims[axis]) / rows[axis];
        axes_across(axis).map(|i| f64::from(grid.dims[i]) + slices * rows[i])
    };
    let voxels = [0, 1, 2].map(of_axis);
    let largest = [0, 1].map(|side| voxels.iter().map(|v| v[side]).fold(0.0, f64::max));
    let room = match settings.intermediate {
        Intermediate::PerVoxel(per_voxel) => largest.map(|n| n * per_voxel),
        // As many as the picture has, whose diagonal may lie along either side.
        Intermediate::Pixels => {
            let [width, height] = extent_pixels.map(f64::from);
            [2.0 * width.hypot(height); 2]
        }
    };
    room.map(|n| ((ROOM * n + 2.0 * MARGIN + 2.0).ceil() as u32).min(MOST_ACROSS))
}

impl BasePlane {
    /// Whether its image lies in one of so many base pixels.
    ///
    /// # Errors
    /// [`Error::IntermediateTooLarge`].
    pub(crate) fn check_room(&self, limit: [u32; 2]) -> Result<(), Error> {
        match self.extent[0] <= limit[0] && self.extent[1] <= limit[1] {
            true => Ok(()),
            false => Err(Error::IntermediateTooLarge {
                wanted: self.extent.map(f64::from),
                limit,
            }),
        }
    }
}

/// The rays of the picture as if it had one ray a pixel: the intermediate image does not depend on where in its pixel a ray is.
fn whole_pixel_rays(view: &View) -> Rays {
    let mut rays = view.camera.rays(view.extent_pixels);
    rays.origin -= view.grid.center();
    rays
}

/// World distance of heights with samples, and their offset: slices lie at m + 1/2 in voxel space, the centre of the
/// world at n_k / 2. Slabs end at slices, and their middles lie half way between.
fn heights(view: &View, axis: usize, forward: DVec3) -> (f64, f64) {
    let per_slice = view.settings.samples_per_voxel;
    let row = view.grid.voxel_rows()[axis];
    let step = 1.0 / (row.length() * per_slice);
    let half_way = 0.5 * per_slice * f64::from(view.grid.dims[axis]);
    let between = if view.settings.preintegrated {
        0.5
    } else {
        0.0
    };
    // Heights (j + 1/2) / D are mirrored where the normal is.
    let offset = match row.dot(forward) > 0.0 {
        true => between - half_way,
        false => between + half_way,
    };
    (step, (offset - offset.floor()) * step)
}

/// Rays of a picture in voxel space: v(t) = origin + t direction, both affine in the pixel.
struct VoxelRays {
    is_perspective: bool,
    origin: [DVec3; 3],
    direction: [DVec3; 3],
    eye: DVec3,
}

impl VoxelRays {
    fn new(view: &View, rays: &Rays) -> Self {
        let voxel_from_world = view.world_from_voxel().inverse();
        let point = |p| voxel_from_world.transform_point3(p);
        let vector = |v| voxel_from_world.transform_vector3(v);
        Self {
            is_perspective: view.camera.projection.is_perspective(),
            origin: [
                point(rays.origin),
                vector(rays.origin_dx),
                vector(rays.origin_dy),
            ],
            direction: [
                vector(rays.direction),
                vector(rays.direction_dx),
                vector(rays.direction_dy),
            ],
            eye: point(view.camera.eye - view.grid.center()),
        }
    }

    /// Origin and direction of a pixel's ray.
    fn at(&self, pixel: DVec2) -> [DVec3; 2] {
        [self.origin, self.direction].map(|[at, dx, dy]| at + pixel.x * dx + pixel.y * dy)
    }

    /// Seen from among its slices a stack has rays of both signs, and no base plane.
    fn check_eye(&self, view: &View, axis: usize) -> Result<(), Error> {
        let slices = f64::from(view.grid.dims[axis]);
        let is_among = self.is_perspective && (0.0..=slices).contains(&self.eye[axis]);
        match is_among {
            true => Err(Error::EyeAmongSlices),
            false => Ok(()),
        }
    }
}

/// Where rays meet the base plane.
struct OnPlane {
    axis: usize,
    across: [usize; 2],
    height: f64,
}

impl OnPlane {
    fn of(&self, point: DVec3) -> DVec2 {
        let [i, j] = self.across;
        dvec2(point[i], point[j])
    }

    fn point(&self, place: DVec2) -> DVec3 {
        let mut point = DVec3::ZERO;
        point[self.across[0]] = place.x;
        point[self.across[1]] = place.y;
        point[self.axis] = self.height;
        point
    }

    /// Where a pixel's ray meets the plane; `None` where it does so behind the eye, or not at all.
    fn meets(&self, rays: &VoxelRays, pixel: DVec2) -> Option<DVec2> {
        let [origin, direction] = rays.at(pixel);
        let t = (self.height - origin[self.axis]) / direction[self.axis];
        let is_before = t.is_finite() && (t > 0.0 || !rays.is_perspective);
        is_before.then(|| self.of(origin + t * direction))
    }

    /// The rectangle of the plane in which rays of the picture meet the domain, in voxels.
    fn seen(&self, rays: &VoxelRays, [low, high]: [DVec3; 2], extent: [u32; 2]) -> [DVec2; 2] {
        let corner = |n: u32| {
            let pick = |k: u32| f64::from(n >> k & 1);
            low + (high - low) * dvec3(pick(0), pick(1), pick(2))
        };
        let shadow = rectangle((0..8).map(|n| self.shadow(rays, corner(n))));
        let [width, height] = extent.map(f64::from);
        let corners = [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]];
        let met = corners.map(|[x, y]| self.meets(rays, dvec2(x, y)));
        if met.iter().any(Option::is_none) {
            return shadow;
        }
        let picture = rectangle(met.into_iter().flatten());
        // Beside each other: nothing is seen, and one place is as good as another.
        let low = shadow[0].max(picture[0]).min(shadow[1]);
        [low, shadow[1].min(picture[1]).max(low)]
    }

    /// Where the ray through a point meets the plane.
    fn shadow(&self, rays: &VoxelRays, point: DVec3) -> DVec2 {
        let direction = match rays.is_perspective {
            true => point - rays.eye,
            false => rays.direction[0],
        };
        let t = (self.height - point[self.axis]) / direction[self.axis];
        self.of(point + t * direction)
    }

    /// The largest number of pixels that a voxel of the plane is long, at the corners and the middle of the picture.
    fn pixels_per_voxel(&self, rays: &VoxelRays, extent: [u32; 2]) -> f64 {
        let [width, height] = extent.map(f64::from);
        let places = [[0.5, 0.5], [0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        let of_place = |[x, y]: [f64; 2]| {
            let pixel = dvec2(x * width, y * height);
            let step = 1e-3;
            let at = |by: DVec2| self.meets(rays, pixel + by);
            let dx = at(dvec2(step, 0.0))? - at(dvec2(-step, 0.0))?;
            let dy = at(dvec2(0.0, step))? - at(dvec2(0.0, -step))?;
            Some(1.0 / smallest_singular_value([dx, dy].map(|d| d / (2.0 * step))))
        };
        let largest = places.into_iter().filter_map(of_place).fold(0.0, f64::max);
        match largest.is_finite() && largest > 0.0 {
            true => largest,
            false => 1.0,
        }
    }

    fn rays(&self, view: &View, first: DVec2, per_voxel: f64) -> Rays {
        let world_from_voxel = view.world_from_voxel();
        let camera = whole_pixel_rays(view);
        let corner = world_from_voxel.transform_point3(self.point(first / per_voxel));
        let side = |place: DVec2| {
            let end = self.point(place) - self.point(DVec2::ZERO);
            world_from_voxel.transform_vector3(end / per_voxel)
        };
        let (dx, dy) = (side(DVec2::X), side(DVec2::Y));
        let eye = view.camera.eye - view.grid.center();
        let forward = camera.forward;
        if view.camera.projection.is_perspective() {
            return Rays {
                origin: eye,
                origin_dx: DVec3::ZERO,
                origin_dy: DVec3::ZERO,
                direction: corner - eye,
                direction_dx: dx,
                direction_dy: dy,
                forward: self.normal(view, corner - eye),
            };
        }
        let on_eye_plane = |v: DVec3| v - forward * v.dot(forward);
        Rays {
            origin: eye + on_eye_plane(corner - eye),
            origin_dx: on_eye_plane(dx),
            origin_dy: on_eye_plane(dy),
            direction: forward,
            direction_dx: DVec3::ZERO,
            direction_dy: DVec3::ZERO,
            forward: self.normal(view, forward),
        }
    }

    /// The unit normal of the slices, on the side that a direction goes to.
    fn normal(&self, view: &View, direction: DVec3) -> DVec3 {
        let normal = view.grid.voxel_rows()[self.axis].normalize();
        normal * normal.dot(direction).signum()
    }

    /// (w U, w V, w) of (x, y, 1).
    fn base_from_pixel(&self, rays: &VoxelRays, first: DVec2, per_voxel: f64) -> DMat3 {
        let (k, z) = (self.axis, self.height);
        // Of the three products of origin and direction one is constant in each projection.
        let row = |i: usize| {
            let term = |n: usize| match rays.is_perspective {
                true => {
                    rays.direction[n][k] * rays.origin[0][i]
                        + (z - rays.origin[0][k]) * rays.direction[n][i]
                }
                false => {
                    let height = if n == 0 { z } else { 0.0 };
                    rays.direction[0][k] * rays.origin[n][i]
                        + (height - rays.origin[n][k]) * rays.direction[0][i]
                }
            };
            dvec3(term(1), term(2), term(0))
        };
        let weight = match rays.is_perspective {
            true => dvec3(
                rays.direction[1][k],
                rays.direction[2][k],
                rays.direction[0][k],
            ),
            false => DVec3::Z * rays.direction[0][k],
        };
        let sign = match rays.is_perspective {
            true => (z - rays.origin[0][k]).signum(),
            false => rays.direction[0][k].signum(),
        };
        let [u, v] = self.across.map(row);
        let rows = [
            per_voxel * u - first.x * weight,
            per_voxel * v - first.y * weight,
            weight,
        ];
        let rows = rows.map(|row| row * sign);
        // Of any scale: the largest number of w is about 1.
        let largest = rows[2].abs().max_element();
        DMat3::from_cols(rows[0], rows[1], rows[2]).transpose() * largest.recip()
    }
}

fn rectangle(mut places: impl Iterator<Item = DVec2>) -> [DVec2; 2] {
    let first = places.next().unwrap_or_default();
    places.fold([first; 2], |[low, high], place| {
        [low.min(place), high.max(place)]
    })
}

/// Of the matrix with these columns.
fn smallest_singular_value([a, b]: [DVec2; 2]) -> f64 {
    let (trace, determinant) = (a.length_squared() + b.length_squared(), a.perp_dot(b));
    let largest = 0.5
        * (trace
            + (trace * trace - 4.0 * determinant * determinant)
                .max(0.0)
                .sqrt());
    determinant.abs() / largest.sqrt()
}
