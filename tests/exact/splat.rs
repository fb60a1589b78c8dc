//! Splats against closed forms, and against sums over all voxels in f64: on the CPU reference and on the device.

mod as_points;
mod classified;
mod defaults;
mod laws;
mod one_voxel;
mod parts;
mod points;
mod sheets;
mod sums;

use crate::shared::{PictureCase, device, oblique_camera, projections, sheared_affine};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::scene::{Beside, Scene};
use stratavox::technique::splat::{Sheets, Splat, oracle};
use stratavox::technique::{Mode, Settings, Technique};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::{Grid, Volume};

const DIMS: [u32; 3] = [14, 12, 13];

/// How far off where a ray passes a voxel may be, for each voxel that its eye is away: sixteen roundings of a place, of the ray's
/// origin, its direction, the crossing of a slice and the way from there, three products each and their sums.
const PLACE: f64 = 16.0 / (1 << 24) as f64;
/// Of a number that does not depend on how far away anything is: precision, peak, exponential.
const NUMBER: f64 = 32.0 / (1 << 24) as f64;

/// Voxels that a ray adds at most: rows and columns within reach of it in each slice.
const VOXELS: f64 = 13.0 * 49.0;

/// How far off many roundings of numbers up to 1 come to be: each lies anywhere within half of 2^-24, so their sum has a
/// deviation of 2^-24 sqrt(count / 12), and this is six of it.
fn of_roundings(count: f64) -> f64 {
    6.0 * (count / 12.0).sqrt() / f64::from(1 << 24)
}

/// How far off a sum of splats may be, as a part of it, where its ray is off by [`PLACE`]: all as much to one side as the
/// steepest flank of a Gaussian makes it, and in the precision of each.
fn of_splats(voxels_away: f64) -> f64 {
    PLACE * voxels_away / Splat::default().std * std::f64::consts::FRAC_PI_2.sqrt() + NUMBER
}

/// How far off a channel of classified sheets may be. What of a splat lies before an end of a sheet is off by 7.5e-8, its
/// approximation, and 5.2e-7, f32. Errors of splats have no sign in common: with F their integrals, the mean of a sheet of one
/// voxel is off by twice that, times sqrt(sum of F^2), whose F are a half of their peak in the mean and come to 1 + 2 R h in
/// all. Of a mean as far off, colour is off by its slope, 0.9, and opacity by that of extinction, (0.4 / 0.6) / (1 - 0.4), times
/// how far light comes, 1 over an extinction of -ln(1 - 0.2) at values in the middle.
fn of_sheets() -> f64 {
    let Splat { std, cut_bits, .. } = Splat::default();
    let part = 7.5e-8 + 5.2e-7;
    let peak = 1.0 / (std::f64::consts::TAU * std * std);
    let reach = (2.0 * f64::from(cut_bits) * std::f64::consts::LN_2).sqrt();
    let mean = 2.0 * part * (0.5 * peak * (1.0 + 2.0 * reach * std)).sqrt();
    mean * (0.9 + 0.4 / 0.6 / 0.6 / -(0.8f64.ln()))
}

/// Cubes, far from the origin.
fn cubes() -> Grid {
    Grid {
        dims: DIMS,
        world_from_voxel: DAffine3::from_translation(dvec3(5.0, -3.0, 40.0)),
    }
}

/// No angle is right, and no two sides are alike.
fn sheared() -> Grid {
    Grid {
        dims: DIMS,
        world_from_voxel: sheared_affine(),
    }
}

fn settings(mode: Mode, sheets: Sheets) -> Settings {
    Settings {
        technique: Technique::Splat,
        mode,
        conformance: true,
        color_space: ColorSpace::Display,
        splat: Splat {
            sheets,
            ..Splat::default()
        },
        ..Settings::default()
    }
}

/// Both projections, from where no axis is.
fn shots(grid: Grid, settings: &Settings) -> [PictureCase; 2] {
    projections(&grid).map(|projection| PictureCase {
        grid,
        camera: oblique_camera(&grid, projection),
        extent: [24, 22],
        settings: settings.clone(),
    })
}

/// From a direction of voxel space, seeing all of the grid.
fn seen_from(grid: Grid, towards: DVec3, settings: &Settings) -> PictureCase {
    let size = (grid.world_from_voxel.matrix3 * grid.far_corner()).length();
    PictureCase {
        grid,
        camera: Camera {
            eye: grid.center() + 2.0 * size * towards.normalize(),
            target: grid.center(),
            up: dvec3(0.1, 0.2, 1.0),
            projection: Projection::Orthographic {
                view_height: 0.8 * size,
            },
            zoom: 1.0,
        },
        extent: [24, 22],
        settings: settings.clone(),
    }
}

fn function() -> TransferFunction {
    let color = |value, srgb| ColorPoint { value, srgb };
    let opacity = |value, opacity| OpacityPoint { value, opacity };
    TransferFunction {
        color: vec![color(0.0, [0.1, 0.2, 0.9]), color(1.0, [1.0, 0.5, 0.1])],
        opacity: vec![opacity(0.2, 0.0), opacity(0.8, 0.4)],
        reference_length: Some(1.0),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// Numbers without a pattern.
fn noise(p: DVec3) -> f64 {
    let seed = p.dot(dvec3(12.9898, 78.233, 37.719)).sin() * 43758.5453;
    seed - seed.floor()
}

/// A ray in centred world space and in voxel space.
struct Ray {
    origin: DVec3,
    direction: DVec3,
    line: oracle::Line,
    forward: DVec3,
}

fn ray_of(shot: &PictureCase, [x, y]: [u32; 2]) -> Ray {
    let rays = shot.camera.rays(shot.extent);
    let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let voxel = shot.grid.world_from_voxel.inverse();
    Ray {
        origin: origin - shot.grid.center(),
        direction,
        line: oracle::Line {
            origin: voxel.transform_point3(origin),
            direction: voxel.transform_vector3(direction),
        },
        forward: rays.forward,
    }
}

impl Ray {
    fn edge(&self, height: f64) -> f64 {
        (height - self.forward.dot(self.origin)) / self.forward.dot(self.direction)
    }

    /// Where it is in the box of a grid, from the eye on.
    fn inside(&self, grid: &Grid) -> Option<[f64; 2]> {
        let [mut enter, mut leave] = [0.0f64, f64::INFINITY];
        let (o, d) = (self.line.origin, self.line.direction);
        for k in 0..3 {
            let ends = [0.0, grid.far_corner()[k]].map(|face| (face - o[k]) / d[k]);
            enter = enter.max(ends[0].min(ends[1]));
            leave = leave.min(ends[0].max(ends[1]));
        }
        (enter < leave).then_some([enter, leave])
    }
}

/// Emission and absorption of sheets (length, colour, extinction), front to back.
fn over(sheets: impl Iterator<Item = (f64, [f64; 4])>) -> [f64; 4] {
    let (mut color, mut through) = ([0.0; 3], 1.0);
    for (length, [r, g, b, extinction]) in sheets {
        let opacity = -(-extinction * length).exp_m1();
        for (sum, c) in color.iter_mut().zip([r, g, b]) {
            *sum += through * opacity * c;
        }
        through *= 1.0 - opacity;
    }
    let [r, g, b] = color;
    [r, g, b, 1.0 - through]
}

/// All voxels with their centres, in an order that is no one's: value, 1 where there is one, 1.
fn voxels(volume: &Volume) -> impl Iterator<Item = (DVec3, [f64; 3])> {
    let [nx, ny, _] = volume.dims.map(|n| n as usize);
    let count = volume.voxels.len();
    (0..count).map(move |n| {
        let i = (n * 5 + 3) % count;
        let center = dvec3(
            (i % nx) as f64,
            (i / nx % ny) as f64,
            (i / (nx * ny)) as f64,
        ) + 0.5;
        let is_there = volume.validity.as_ref().is_none_or(|v| v[i] != 0);
        let value = f64::from(volume.voxels.stored(i));
        match is_there {
            true => (center, [value, 1.0, 1.0]),
            false => (center, [0.0, 0.0, 1.0]),
        }
    })
}

fn scene<'a>(shot: &'a PictureCase, volume: &'a Volume, f: &'a TransferFunction) -> Scene<'a> {
    Scene {
        volume,
        transfer: Some(f),
        beside: Beside::Nothing,
        camera: &shot.camera,
        extent_pixels: shot.extent,
        settings: &shot.settings,
    }
}

/// By the CPU reference in f64 and in f32, and by the device.
fn pictures(scene: &Scene, layers: &[LayerKind]) -> [(&'static str, Picture); 3] {
    let mut renderer = Renderer::several(device(), scene.volumes()).unwrap();
    [
        ("f64", reference::render::<f64>(scene).unwrap()),
        ("f32", reference::render::<f32>(scene).unwrap()),
        ("device", renderer.render(scene, layers).unwrap().picture),
    ]
}

fn values(picture: &Picture) -> &[f32] {
    let layer = picture
        .layers
        .iter()
        .find(|layer| layer.kind == LayerKind::Value);
    &layer.expect("values").values
}

/// Both sides of 45 degrees between two axes, and a diagonal.
const DIRECTIONS: [DVec3; 3] = [
    dvec3(1.0, 0.998, 0.13),
    dvec3(0.998, 1.0, 0.13),
    dvec3(1.0, -1.1, 0.9),
];
