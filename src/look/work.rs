//! How much work a picture is: samples of the rays that see something.
//!
//! ```text
//! work = sum over visible pixels of chord / step,   step = smallest spacing / samples per voxel
//! ```
//!
//! counted in a small frame and scaled to the picture. Empty-space skipping and early termination make it less.

use crate::camera::Camera;
use crate::volume::Grid;
use glam::{DAffine3, DVec3};

/// Samples from which a still takes one sample a voxel.
pub const MOST_SAMPLES: f64 = 400e6;

/// World length of the part of a ray that lies in the box of the grid.
fn chord(voxel_from_world: &DAffine3, dims: [u32; 3], origin: DVec3, along: DVec3) -> f64 {
    let start = voxel_from_world.transform_point3(origin).to_array();
    let step = voxel_from_world.transform_vector3(along).to_array();
    let (mut near, mut far) = (0.0_f64, f64::INFINITY);
    for k in 0..3 {
        let side = f64::from(dims[k]);
        let [a, b] = [-start[k] / step[k], (side - start[k]) / step[k]];
        if step[k] == 0.0 {
            if !(0.0..=side).contains(&start[k]) {
                return 0.0;
            }
            continue;
        }
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    (far - near).max(0.0)
}

/// Samples of a picture of `extent_pixels` by one sample a voxel, by the pixels of a small frame that see something.
pub fn samples(
    grid: &Grid,
    camera: &Camera,
    small_pixels: [u32; 2],
    visible: &[bool],
    extent_pixels: [u32; 2],
) -> f64 {
    let rays = camera.rays(small_pixels);
    let voxel_from_world = grid.world_from_voxel.inverse();
    let pixels = (0_u32..)
        .zip(visible)
        .filter(|(_, is_visible)| **is_visible);
    let chords: f64 = pixels
        .map(|(at, _)| {
            let [x, y] = [at % small_pixels[0], at / small_pixels[0]].map(|n| f64::from(n) + 0.5);
            let (origin, along) = rays.at(x, y);
            chord(&voxel_from_world, grid.dims, origin, along)
        })
        .sum();
    let area = |[w, h]: [u32; 2]| f64::from(w) * f64::from(h);
    chords / grid.smallest_spacing() * area(extent_pixels) / area(small_pixels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Projection;
    use glam::dvec3;

    #[test]
    fn a_box_that_is_seen_from_in_front_takes_its_depth_in_every_pixel_that_it_covers() {
        let grid = Grid {
            dims: [10, 20, 30],
            world_from_voxel: DAffine3::from_scale(dvec3(2.0, 2.0, 2.0)),
        };
        let camera = Camera {
            eye: dvec3(10.0, 200.0, 30.0),
            target: dvec3(10.0, 20.0, 30.0),
            up: DVec3::Z,
            projection: Projection::Orthographic { view_height: 80.0 },
            zoom: 1.0,
        };
        // The box is 20 by 60 of 80 by 80: 10 by 30 pixels of 40 by 40, each 20 voxels deep.
        let found = samples(&grid, &camera, [40, 40], &[true; 1600], [80, 80]);
        assert!((found - 4.0 * 10.0 * 30.0 * 20.0).abs() < 1e-6, "{found}");
    }
}
