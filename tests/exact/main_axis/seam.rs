//! The seam: where the main axis changes inside of a picture in perspective, samples lie elsewhere on both sides of it. Rays on
//! their own lattice have none.

use super::settings;
use crate::shared::PictureCase;
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::technique::Mode;
use stratavox::volume::Grid;

const SIDE: u32 = 64;

/// Extinction of voxels in a shell as thin as 1.5 of them, 0.1 per voxel, filtered linearly.
fn shell(p: DVec3) -> f64 {
    let is_inside = |voxel: DVec3| {
        let off = voxel.distance(DVec3::splat(0.5 * f64::from(SIDE))) - 0.35 * f64::from(SIDE);
        f64::from(u8::from(off.abs() < 0.75))
    };
    let low = (p - 0.5).floor();
    let part = p - 0.5 - low;
    let corner = |i: u32| {
        let step = dvec3((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into());
        let weights = (1.0 - part) + step * (2.0 * part - 1.0);
        weights.element_product() * is_inside(low + step + 0.5)
    };
    0.1 * (0..8).map(corner).sum::<f64>()
}

/// What is opaque along a ray of samples of one axis.
fn alpha(o: DVec3, d: DVec3, k: usize, per_voxel: f64) -> f64 {
    let heights = 0..(f64::from(SIDE) * per_voxel) as u32;
    let depth = heights.map(|j| {
        let height = (f64::from(j) + 0.5) / per_voxel;
        let t = (height - o[k]) / d[k];
        shell(o + t * d)
    });
    -(-depth.sum::<f64>() / (per_voxel * d[k].abs())).exp_m1()
}

#[test]
fn the_seam_fades_with_more_samples() {
    let grid = Grid {
        dims: [SIDE; 3],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let azimuth = 30f64.to_radians();
    let shot = PictureCase {
        grid,
        camera: Camera {
            eye: grid.center() - 80.0 * dvec3(azimuth.cos(), azimuth.sin(), 0.0),
            target: grid.center(),
            up: DVec3::Z,
            projection: Projection::Perspective { fov_degrees: 60.0 },
            zoom: 1.0,
        },
        extent: [512, 512],
        settings: settings(Mode::Composite, 1.0),
    };
    let rays = shot.camera.rays(shot.extent);
    let mut jumps = [[0.0f64; 4]; 2];
    let (mut on_seam, mut other, mut seen) = (0, 0, 0);
    for [x, y] in shot.pixels() {
        let (o, d) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
        other += usize::from(d.y.abs().max(d.z.abs()) > d.x.abs());
        seen += 1;
        // Within a pixel of where x and y are alike.
        let nearly = (d.x.abs() - d.y.abs()).abs() < 1.0 / 512.0;
        let is_hit = alpha(o, d, 0, 8.0) > 0.05;
        if !nearly || !is_hit {
            continue;
        }
        on_seam += 1;
        for (nth, per_voxel) in [1.0, 2.0, 4.0, 8.0].into_iter().enumerate() {
            let jump = (alpha(o, d, 0, per_voxel) - alpha(o, d, 1, per_voxel)).abs();
            jumps[0][nth] += jump;
            jumps[1][nth] = jumps[1][nth].max(jump);
        }
    }
    let mean = jumps[0].map(|sum| sum / f64::from(on_seam));
    println!(
        "{on_seam} rays on the seam, {:.1} % along another axis than in the middle; jumps of alpha in the mean {mean:.5?}, at most {:.5?}",
        100.0 * other as f64 / seen as f64,
        jumps[1]
    );
    assert!(on_seam > 100);
    assert!((0.002..0.006).contains(&mean[0]), "{mean:?}");
    assert!(
        mean[1] < 0.3 * mean[0] && mean[2] < 0.5 * mean[1],
        "{mean:?}"
    );
    assert!(mean[3] < 1e-4, "{mean:?}");
}
