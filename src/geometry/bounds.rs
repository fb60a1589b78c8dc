//! Which pixels may see a sphere or a triangle.
//!
//! ```text
//! perspective   x / z of the two planes through the eye that touch it:  (X Z -+ r sqrt(X^2 + Z^2 - r^2)) / (Z^2 - r^2)
//! parallel      X -+ r
//! ```
//!
//! along each axis of the picture. A sphere that reaches the plane of the eye may be seen anywhere; of a triangle that does, the
//! part before the eye is looked at.

use crate::camera::{Camera, Rays};
use glam::DVec3;
use std::ops::Range;

/// Pixels that a corner may lie farther out, by rounding.
const ROUNDING: f64 = 1e-6;
/// Of a triangle, what is nearer to the plane of the eye is not seen: a part of the distance of its farthest corner.
const NEAREST: f64 = 1e-9;

/// From the world to the pixels of a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    rays: Rays,
    is_perspective: bool,
    extent: [u32; 2],
    at: [f64; 2],
}

impl Bounds {
    /// Of rays through a place in each pixel, from its centre.
    pub fn new(camera: &Camera, extent: [u32; 2], at: [f64; 2]) -> Self {
        Self {
            rays: camera.rays(extent),
            is_perspective: camera.projection.is_perspective(),
            extent,
            at,
        }
    }

    /// The columns and rows of pixels whose rays may meet the hull of two spheres; `None` where none can.
    pub fn of(&self, spheres: [(DVec3, f64); 2]) -> Option<[Range<u32>; 2]> {
        let all = self.extent.map(|n| 0..n);
        let found = spheres.map(|(center, radius)| self.sphere(center, radius));
        let [Some(a), Some(b)] = found else {
            // Behind the eye altogether.
            let behind = |(center, radius): &(DVec3, f64)| {
                self.is_perspective
                    && (*center - self.rays.origin).dot(self.rays.forward) + radius <= 0.0
            };
            return (!spheres.iter().all(behind)).then_some(all);
        };
        self.pixels([0, 1].map(|k| [a[k][0].min(b[k][0]), a[k][1].max(b[k][1])]))
    }

    /// The same of a triangle.
    pub fn of_triangle(&self, corners: [DVec3; 3]) -> Option<[Range<u32>; 2]> {
        let from = corners.map(|corner| corner - self.rays.origin);
        let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut add = |from: DVec3| {
            for (k, at) in self.pixel(from).into_iter().enumerate() {
                ends[k] = [ends[k][0].min(at - ROUNDING), ends[k][1].max(at + ROUNDING)];
            }
        };
        if !self.is_perspective {
            from.into_iter().for_each(add);
            return self.pixels(ends);
        }
        let farthest = from.iter().map(|from| from.length()).fold(0.0, f64::max);
        let least = NEAREST * farthest;
        let depth = |from: DVec3| from.dot(self.rays.forward);
        for (a, b) in [(from[0], from[1]), (from[1], from[2]), (from[2], from[0])] {
            let [near, far] = [depth(a), depth(b)];
            if near >= least {
                add(a);
            }
            if (near < least) != (far < least) {
                add(a.lerp(b, (least - near) / (far - near)));
            }
        }
        self.pixels(ends)
    }

    /// The pixels whose rays lie between ends along both axes.
    fn pixels(&self, ends: [[f64; 2]; 2]) -> Option<[Range<u32>; 2]> {
        let ranges = [0, 1].map(|k| {
            let [low, high] = ends[k];
            // The pixel i has its ray at i + 1/2 + at.
            let first = (low - 0.5 - self.at[k]).ceil().max(0.0);
            let end = ((high - 0.5 - self.at[k]).floor() + 1.0).min(f64::from(self.extent[k]));
            first as u32..end.max(0.0) as u32
        });
        (!ranges.iter().any(Range::is_empty)).then_some(ranges)
    }

    /// Where a place is seen, counted from the eye, in front of it.
    fn pixel(&self, from: DVec3) -> [f64; 2] {
        let rays = &self.rays;
        if !self.is_perspective {
            return [rays.origin_dx, rays.origin_dy]
                .map(|axis| from.dot(axis) / axis.length_squared());
        }
        let z = from.dot(rays.forward);
        [rays.direction_dx, rays.direction_dy].map(|axis| {
            let pixel = axis.length();
            let unit = axis / pixel;
            (from.dot(unit) / z - rays.direction.dot(unit)) / pixel
        })
    }

    /// Between which columns and rows it is seen, in pixels; `None` where that is not known.
    fn sphere(&self, center: DVec3, radius: f64) -> Option<[[f64; 2]; 2]> {
        let rays = &self.rays;
        if !self.is_perspective {
            let from = center - rays.origin;
            let along = |axis: DVec3| {
                let pixel = axis.length();
                let (x, r) = (from.dot(axis) / (pixel * pixel), radius / pixel);
                [x - r, x + r]
            };
            return Some([along(rays.origin_dx), along(rays.origin_dy)]);
        }
        let from = center - rays.origin;
        let z = from.dot(rays.forward);
        let least = z * z - radius * radius;
        if z <= radius || least <= 1e-9 * z * z {
            return None;
        }
        let along = |axis: DVec3| {
            let pixel = axis.length();
            let unit = axis / pixel;
            let x = from.dot(unit);
            let root = radius * (x * x + least).max(0.0).sqrt();
            let middle = rays.direction.dot(unit);
            [-1.0, 1.0].map(|side| ((x * z + side * root) / least - middle) / pixel)
        };
        Some([along(rays.direction_dx), along(rays.direction_dy)])
    }
}
