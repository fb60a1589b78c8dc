//! Which pixels may see a sphere.
//!
//! ```text
//! perspective   x / z of the two planes through the eye that touch it:  (X Z -+ r sqrt(X^2 + Z^2 - r^2)) / (Z^2 - r^2)
//! parallel      X -+ r
//! ```
//!
//! along each axis of the picture. A sphere that reaches the plane of the eye may be seen anywhere.

use crate::camera::{Camera, Rays};
use glam::DVec3;
use std::ops::Range;

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
        let ranges = [0, 1].map(|k| {
            let [low, high] = [a[k][0].min(b[k][0]), a[k][1].max(b[k][1])];
            // The pixel i has its ray at i + 1/2 + at.
            let first = (low - 0.5 - self.at[k]).ceil().max(0.0);
            let end = ((high - 0.5 - self.at[k]).floor() + 1.0).min(f64::from(self.extent[k]));
            first as u32..end.max(0.0) as u32
        });
        (!ranges.iter().any(Range::is_empty)).then_some(ranges)
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
