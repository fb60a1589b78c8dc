//! Where the rays of a picture meet the base plane, and the rays of its base pixels.
//!
//! ```text
//! v(t) = o + t d meets the plane at z in o + ((z - o_k) / d_k) d
//! ```

use crate::camera::Rays;
use crate::technique::{Error, View};
use glam::{DMat3, DVec2, DVec3, dvec2, dvec3};

/// The rays of the picture as if it had one ray a pixel: the intermediate image does not depend on where in its pixel a
/// ray is.
pub(super) fn whole_pixel_rays(view: &View) -> Rays {
    let mut rays = view.camera.rays(view.extent_pixels);
    rays.origin -= view.grid.center();
    rays
}

/// Rays of a picture in voxel space: v(t) = origin + t direction, both affine in the pixel.
pub(super) struct VoxelRays {
    is_perspective: bool,
    origin: [DVec3; 3],
    direction: [DVec3; 3],
    eye: DVec3,
}

impl VoxelRays {
    pub fn new(view: &View, rays: &Rays) -> Self {
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
    pub fn check_eye(&self, view: &View, axis: usize) -> Result<(), Error> {
        let slices = f64::from(view.grid.dims[axis]);
        let is_among = self.is_perspective && (0.0..=slices).contains(&self.eye[axis]);
        match is_among {
            true => Err(Error::EyeAmongSlices),
            false => Ok(()),
        }
    }
}

/// Where rays meet the base plane.
pub(super) struct OnPlane {
    /// Across the plane.
    pub axis: usize,
    /// Along it, in order.
    pub across: [usize; 2],
    pub height: f64,
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
    pub fn seen(&self, rays: &VoxelRays, [low, high]: [DVec3; 2], extent: [u32; 2]) -> [DVec2; 2] {
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
    pub fn pixels_per_voxel(&self, rays: &VoxelRays, extent: [u32; 2]) -> f64 {
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

    pub fn rays(&self, view: &View, first: DVec2, per_voxel: f64) -> Rays {
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
    pub fn base_from_pixel(&self, rays: &VoxelRays, first: DVec2, per_voxel: f64) -> DMat3 {
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
