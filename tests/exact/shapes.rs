//! Spheres with a hard edge and Gaussians against closed forms: A7, A8, A10 and A11 of the oracles.

use crate::shared::oracle::{
    Gaussian, absorbing_sphere, emissive_sphere, gaussian_maximum, gaussian_ratio, gaussian_xray,
};
use crate::shared::{Device, PictureCase, Reference, Way, oblique_shots, sheared_affine};
use glam::{DAffine3, DMat3, DQuat, DVec3, dvec3};
use stratavox::technique::{Filter, Mode, Settings};
use stratavox::volume::Grid;

const SHEARED: fn() -> Grid = || Grid {
    dims: [34, 38, 24],
    world_from_voxel: sheared_affine(),
};
/// Room for five widths on both sides of a Gaussian of width 6.
const CUBE: Grid = Grid {
    dims: [64; 3],
    world_from_voxel: DAffine3::IDENTITY,
};

fn references() -> [Box<dyn Way>; 2] {
    [
        Box::new(Reference::<f64>::new()),
        Box::new(Reference::<f32>::new()),
    ]
}

/// Voxels as they are: a sphere of voxels has a value of 0 or 1 everywhere.
fn nearest(shot: PictureCase) -> PictureCase {
    let settings = Settings {
        filter: Filter::Nearest,
        ..shot.settings
    };
    PictureCase { settings, ..shot }
}

fn every(shot: PictureCase, samples_per_voxel: f64) -> PictureCase {
    let settings = Settings {
        samples_per_voxel,
        ..shot.settings
    };
    PictureCase { settings, ..shot }
}

#[test]
fn an_absorbing_sphere_is_as_opaque_as_its_chords_to_a_sample() {
    for shot in oblique_shots(SHEARED(), Mode::Composite)
        .into_iter()
        .map(nearest)
    {
        for way in references() {
            absorbing_sphere(&*way, &shot, false).assert_holds();
            absorbing_sphere(&*way, &every(shot.clone(), 9.0), false).assert_holds();
        }
        absorbing_sphere(&Device, &shot, true).assert_holds();
    }
}

#[test]
fn an_emissive_sphere_shines_as_its_chords_are_long_to_a_sample() {
    for shot in oblique_shots(SHEARED(), Mode::Xray)
        .into_iter()
        .map(nearest)
    {
        for way in references() {
            emissive_sphere(&*way, &shot, false).assert_holds();
            emissive_sphere(&*way, &every(shot.clone(), 9.0), false).assert_holds();
        }
        emissive_sphere(&Device, &shot, true).assert_holds();
    }
}

/// Three widths along axes of its own, off the middle; five widths lie inside the box.
fn leaning() -> Gaussian {
    let turn = DMat3::from_quat(DQuat::from_axis_angle(
        dvec3(1.0, 2.0, -0.5).normalize(),
        0.7,
    ));
    let inverse_squares = DMat3::from_diagonal(DVec3::new(3.0, 4.0, 5.5).powf(-2.0));
    Gaussian {
        center: dvec3(33.5, 31.0, 30.5),
        m: turn * inverse_squares * turn.transpose(),
        interpolation: 0.0,
    }
}

/// The one that the device gets as voxels: trilinear interpolation takes 3/(8 s^2) off its top.
fn sampled() -> Gaussian {
    Gaussian {
        center: CUBE.center() + dvec3(0.3, -0.4, 0.2),
        m: DMat3::IDENTITY / 36.0,
        interpolation: 3.0 / (8.0 * 36.0),
    }
}

#[test]
fn the_xray_of_a_gaussian_is_a_gaussian() {
    for shot in oblique_shots(CUBE, Mode::Xray) {
        for way in references() {
            for samples_per_voxel in [1.0, 0.25] {
                gaussian_xray(&*way, &every(shot.clone(), samples_per_voxel), &leaning())
                    .assert_holds();
            }
        }
        gaussian_xray(&Device, &shot, &sampled()).assert_holds();
    }
}

#[test]
fn the_maximum_of_a_gaussian_is_a_gaussian() {
    for shot in oblique_shots(CUBE, Mode::Mip) {
        for way in references() {
            for samples_per_voxel in [1.0, 0.25] {
                gaussian_maximum(&*way, &every(shot.clone(), samples_per_voxel), &leaning())
                    .assert_holds();
            }
        }
        gaussian_maximum(&Device, &shot, &sampled()).assert_holds();
    }
}

#[test]
fn maximum_over_xray_of_a_gaussian_is_the_same_everywhere() {
    let close = |mode| {
        let shots = oblique_shots(CUBE, mode).into_iter();
        shots.map(|mut shot| {
            shot.camera.zoom = 3.0;
            shot
        })
    };
    for (mip, xray) in close(Mode::Mip).zip(close(Mode::Xray)) {
        for way in references() {
            gaussian_ratio(&*way, &mip, &xray, &leaning()).assert_holds();
        }
        gaussian_ratio(&Device, &mip, &xray, &sampled()).assert_holds();
    }
}
