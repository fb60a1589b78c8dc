//! How many samples an intermediate image takes. A length of n in whole voxels has n base pixels of a lattice of whole voxels,
//! wherever it lies: each slice is met once by each of n_i n_j q^2 parallel rays, so that there are n_x n_y n_z q^2 samples in
//! every direction. Bilinear weights of all pixels of a warp add up to one for each base pixel:
//!
//! ```text
//! sum of `samples` of a picture x area of its pixel on the base plane, in base pixels = samples of the intermediate image
//! ```

use super::{cubes, drawn, settings};
use crate::shared::{PictureCase, volume_of, waves};
use glam::{DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::technique::Mode;

const SIDE: u32 = 112;

/// Samples of the intermediate image of parallel rays, counted by a picture of so many pixels a voxel.
fn samples(dims: [u32; 3], towards: DVec3, pan: DVec3, per_voxel: f64) -> f64 {
    let grid = cubes(dims);
    let towards = towards.normalize();
    let target = grid.center() + pan;
    // All of the box, from wherever it is seen.
    let view_height = 1.2 * grid.far_corner().length();
    let shot = PictureCase {
        grid,
        camera: Camera {
            eye: target - 60.0 * towards,
            target,
            up: dvec3(0.1, 0.2, 1.0),
            projection: Projection::Orthographic { view_height },
            zoom: 1.0,
        },
        extent: [SIDE; 2],
        settings: settings(Mode::Composite, per_voxel),
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    let sum: f64 = drawn(&shot, &volume).layers[0]
        .values
        .iter()
        .map(|&n| f64::from(n))
        .sum();
    let pixel = view_height / f64::from(SIDE);
    // A pixel covers as much more of the base plane as rays run beside its axis.
    sum * pixel * pixel / towards.abs().max_element() * per_voxel * per_voxel
}

#[test]
fn an_intermediate_image_has_as_many_samples_as_voxels_from_wherever_it_is_seen() {
    let dims = [14, 12, 16];
    let voxels = f64::from(dims.iter().product::<u32>());
    for towards in [
        dvec3(0.2, 1.0, 0.1),
        dvec3(0.7, -0.6, 1.0),
        dvec3(-1.0, 0.97, 0.95),
        dvec3(0.3, 0.4, -1.0),
    ] {
        for per_voxel in [1.0, 2.0] {
            let pans = [
                DVec3::ZERO,
                dvec3(0.31, 0.17, -0.42),
                dvec3(-0.23, 0.44, 0.12),
            ];
            let sum: f64 = pans
                .iter()
                .map(|&pan| samples(dims, towards, pan, per_voxel))
                .sum();
            let found = sum / pans.len() as f64 / (voxels * per_voxel * per_voxel);
            println!("{towards}, {per_voxel} a voxel: {found} samples a voxel");
            assert!(
                (found - 1.0).abs() < 0.01,
                "{towards}, {per_voxel}: {found}"
            );
        }
    }
}
