//! The signal of Marschner and Lobb in 40 voxels an axis over [-1, 1], and points of [-0.8, 0.8] of it, one a pixel:
//! each ray takes one sample, in the middle of a slab of half a voxel.

use glam::{DAffine3, DQuat, DVec3};
use stratavox::camera::{Camera, Projection};
use stratavox::volume::field::{Field, MarschnerLobb};
use stratavox::volume::{Rescale, Volume, Voxels};

pub const SIDE: u32 = 40;

/// The centres of the outermost voxels lie at -1 and 1.
pub fn world_from_voxel() -> DAffine3 {
    let spacing = 2.0 / f64::from(SIDE - 1);
    let corner = DVec3::splat(-1.0 - 0.5 * spacing);
    DAffine3::from_scale_rotation_translation(DVec3::splat(spacing), DQuat::IDENTITY, corner)
}

pub fn signal() -> Volume {
    let field = MarschnerLobb::default();
    let numbers = (0..SIDE.pow(3)).map(|i| {
        let index = [i % SIDE, i / SIDE % SIDE, i / (SIDE * SIDE)];
        let voxel = DVec3::from_array(index.map(f64::from)) + 0.5;
        field.value(world_from_voxel().transform_point3(voxel)) as f32
    });
    let voxels = Voxels::F32(numbers.collect());
    let rescale = Rescale::default();
    Volume::from_voxels([SIDE; 3], world_from_voxel(), voxels, rescale, None)
        .expect("as many voxels as dims say")
}

/// Sees [-0.8, 0.8] in x and y.
pub fn camera() -> Camera {
    Camera {
        eye: -3.0 * DVec3::Z,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 1.6 },
        zoom: 1.0,
    }
}

/// The slab around height z of the world, and the points that the pixels of a picture of so many a side show.
pub fn slab(z: f64, pixels: u32) -> ([DVec3; 2], Vec<DVec3>) {
    let middle = world_from_voxel()
        .inverse()
        .transform_point3(z * DVec3::Z)
        .z;
    let side = f64::from(SIDE);
    let crop = [
        DVec3::new(0.0, 0.0, middle - 0.25),
        DVec3::new(side, side, middle + 0.25),
    ];
    let rays = camera().rays([pixels; 2]);
    let at = |i: u32| f64::from(i) + 0.5;
    let point = |i: u32| {
        let (origin, _) = rays.at(at(i % pixels), at(i / pixels));
        DVec3::new(origin.x, origin.y, z)
    };
    (crop, (0..pixels * pixels).map(point).collect())
}

/// The middles of so many slabs of [-0.8, 0.8].
pub fn heights(count: u32) -> impl Iterator<Item = f64> {
    (0..count).map(move |i| -0.8 + 1.6 * (f64::from(i) + 0.5) / f64::from(count))
}
