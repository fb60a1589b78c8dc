//! Shadows by half-angle slices: the device against its CPU reference, and both against closed forms and geometry.

mod ball;
mod exact;
mod host;
mod references;
mod refused;
mod symmetry;

use crate::shared::{PictureCase, device, oblique_camera, projections, sheared_affine, waves};
use glam::DVec3;
use stratavox::camera::Camera;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::Picture;
use stratavox::technique::{Light, Settings, Shading, Shadows, Technique};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::{Grid, Volume};

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};

/// The part of the colour that needs no light.
const AMBIENT: f64 = 0.1;

fn half_angle() -> Settings {
    Settings {
        technique: Technique::Slices3d,
        shading: Some(Shading {
            shadows: Shadows::HalfAngle,
            ..Shading::plain()
        }),
        conformance: true,
        ..Settings::default()
    }
}

/// One light, on matter as it is.
fn plain(towards: DVec3) -> Option<Shading> {
    let light = Light::of_world(towards, [1.0; 3]);
    Some(Shading {
        lights: vec![light],
        shadows: Shadows::HalfAngle,
        ..Shading::plain()
    })
}

/// Light from behind the eye, from the side, and from behind the volume.
fn ways_to_light(camera: &Camera) -> [DVec3; 3] {
    let axes = camera.frame();
    let at = |x: f64, y: f64, z: f64| x * axes.right + y * axes.up - z * axes.forward;
    [at(0.8, 0.5, 1.0), at(-1.0, 0.4, 0.2), at(0.3, 0.9, -0.8)]
}

/// In both projections, where half-angle slices can be.
fn shots() -> [PictureCase; 2] {
    projections(&GRID()).map(|projection| PictureCase {
        grid: GRID(),
        camera: oblique_camera(&GRID(), projection),
        extent: [28, 24],
        settings: half_angle(),
    })
}

/// Values fade to 0, which is transparent, towards the box: whether rounding takes a sample at its faces in or leaves
/// it out changes no picture and no shadow.
fn fading(p: DVec3) -> f64 {
    let far = GRID().far_corner();
    let inside = (p - 0.5).min(far - 0.5 - p).min_element();
    (inside / 2.0).min(1.0) * waves(p)
}

/// White, of one extinction per world length for values from `value` on, none below.
fn white(steps: &[(f64, f64)]) -> TransferFunction {
    let point = |&(value, extinction): &(f64, f64)| OpacityPoint {
        value,
        opacity: -f64::exp_m1(-extinction),
    };
    TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: steps.iter().map(point).collect(),
        reference_length: Some(1.0),
        interpolation: Interpolation::Step,
        gradient_transfer: None,
        medium: None,
    }
}

/// What CPU references in both precisions and the device make of a shot.
fn pictures(volume: &Volume, shot: &PictureCase, transfer: &TransferFunction) -> [Picture; 3] {
    let scene = shot.scene(volume, Some(transfer));
    [
        reference::render::<f64>(&scene).unwrap(),
        reference::render::<f32>(&scene).unwrap(),
        on_device(volume, shot, transfer),
    ]
}

fn on_device(volume: &Volume, shot: &PictureCase, transfer: &TransferFunction) -> Picture {
    let mut renderer = Renderer::new(device(), volume).unwrap();
    let scene = shot.scene(volume, Some(transfer));
    renderer.render(&scene, &[]).unwrap().picture
}
