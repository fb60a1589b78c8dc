//! Volumes with much empty space, functions that show little of them, and pictures with and without what is left out.

#![allow(dead_code, reason = "each test program uses some of it")]

use crate::shared::{oblique_camera, projections, sheared_affine, volume_of};
use glam::{DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::Renderer;
use stratavox::picture::{LayerKind, Picture};
use stratavox::scene::Scene;
use stratavox::technique::{Mode, Settings, Technique};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::{Grid, Rescale, Volume, Voxels};

/// Numbers that look random and are the same each time (Knuth's linear congruence).
pub struct Numbers(pub u64);

impl Numbers {
    /// From 0 to 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 40) as f64 / (1u64 << 24) as f64
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    pub fn point(&mut self) -> DVec3 {
        dvec3(self.next(), self.next(), self.next())
    }
}

pub const DIMS: [u32; 3] = [41, 30, 27];

/// A few hard and soft balls in noise, by a type of voxel.
pub fn balls(numbers: &mut Numbers, as_bytes: bool) -> Volume {
    let far = dvec3(41.0, 30.0, 27.0);
    let balls: Vec<_> = (0..2)
        .map(|_| {
            (
                numbers.point() * far,
                1.0 + 3.0 * numbers.next(),
                40.0 + 200.0 * numbers.next(),
            )
        })
        .collect();
    let noise: Vec<f64> = (0..1024).map(|_| 6.0 * numbers.next()).collect();
    let field = |p: DVec3| {
        let of_ball = |&(center, radius, height): &(DVec3, f64, f64)| {
            height * (1.0 + radius - (p - center).length()).clamp(0.0, 1.0)
        };
        let place = p.dot(dvec3(1.0, 41.0, 1231.0)) as usize % 1024;
        balls.iter().map(of_ball).fold(noise[place], f64::max)
    };
    let floats = volume_of(DIMS, sheared_affine(), field);
    if !as_bytes {
        return floats;
    }
    let Voxels::F32(values) = &floats.voxels else {
        unreachable!("made so")
    };
    let codes = values.iter().map(|&v| v as u8).collect();
    let rescale = Rescale {
        slope: -1.5,
        intercept: 400.0,
    };
    let affine = sheared_affine();
    Volume::from_voxels(DIMS, affine, Voxels::U8(codes), rescale, None).expect("a right volume")
}

/// Hills of opacity with nothing between them.
pub fn hills(numbers: &mut Numbers, range: [f64; 2]) -> TransferFunction {
    let mut at = range[0] - 5.0;
    let mut opacity = Vec::new();
    while at < range[1] + 5.0 {
        let is_hill = numbers.next() < 0.25;
        opacity.push(OpacityPoint {
            value: at,
            opacity: if is_hill { numbers.next() } else { 0.0 },
        });
        at += (range[1] - range[0]) * 0.25 * numbers.next();
    }
    let color = |(value, srgb)| ColorPoint { value, srgb };
    TransferFunction {
        color: [(range[0], [1.0, 0.2, 0.1]), (range[1], [0.2, 0.9, 1.0])]
            .map(color)
            .into(),
        opacity,
        reference_length: None,
        interpolation: match numbers.below(2) {
            0 => Interpolation::Linear,
            _ => Interpolation::Step,
        },
        gradient_transfer: None,
        medium: None,
    }
}

pub fn cameras(grid: &Grid) -> Vec<Camera> {
    let mut cameras: Vec<_> = projections(grid)
        .into_iter()
        .map(|p| oblique_camera(grid, p))
        .collect();
    let inside = Camera {
        eye: grid.center(),
        target: grid.center() + dvec3(1.0, 0.4, -0.7),
        ..cameras[0]
    };
    cameras.push(Camera {
        projection: Projection::Perspective { fov_degrees: 70.0 },
        ..inside
    });
    cameras
}

fn picture(renderer: &mut Renderer, scene: &Scene, skip: bool) -> Picture {
    let settings = Settings {
        skip,
        ..scene.settings.clone()
    };
    let scene = Scene {
        settings: &settings,
        ..*scene
    };
    let is_slicer = settings.technique != Technique::Raycast;
    let layers: &[LayerKind] = match settings.mode {
        _ if is_slicer => &[LayerKind::Samples],
        Mode::Composite | Mode::Mida => &[
            LayerKind::Depth,
            LayerKind::Transmittance,
            LayerKind::Samples,
        ],
        _ => &[LayerKind::Depth, LayerKind::Value, LayerKind::Samples],
    };
    renderer.render(&scene, layers).expect("a picture").picture
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|v| v.to_bits()).collect()
}

/// How many samples were taken with and without leaving some out.
pub fn samples_of_same_pictures(renderer: &mut Renderer, scene: &Scene) -> [f64; 2] {
    let [skipped, whole] = [true, false].map(|skip| picture(renderer, scene, skip));
    let about = format!("{:?}\n{:?}", scene.settings, scene.transfer);
    let pixels = |p: &Picture| bits(p.pixels.as_flattened());
    assert!(pixels(&skipped) == pixels(&whole), "other pixels: {about}");
    for (a, b) in skipped.layers.iter().zip(&whole.layers) {
        if a.kind != LayerKind::Samples {
            assert!(
                bits(&a.values) == bits(&b.values),
                "other {:?}: {about}",
                a.kind
            );
        }
    }
    let count = |p: &Picture| {
        let layer = p
            .layers
            .iter()
            .find(|layer| layer.kind == LayerKind::Samples);
        layer
            .expect("asked for")
            .values
            .iter()
            .map(|&n| f64::from(n))
            .sum::<f64>()
    };
    [count(&skipped), count(&whole)]
}
