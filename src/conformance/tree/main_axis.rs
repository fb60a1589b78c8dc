//! Samples along the main axis of each ray where that is hard to say: on a flat grid, where it is another axis than in the
//! world; on a diagonal, where two axes are alike and rounding may not choose; many samples a voxel, where none may drift;
//! and a domain that begins on a sample, which belongs to it, and ends on one, which does not.

use super::drawn::measure;
use super::ground::{self, PLACEMENTS, PROJECTIONS, Placement};
use crate::camera::{Camera, Projection};
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::oracle::{Classes, Numbers, Part, PictureCase, seen};
use crate::conformance::test_bed::TestBed;
use crate::picture::LayerKind;
use crate::technique::{Filter, Mode, Role, Settings};
use crate::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use crate::volume::Grid;
use glam::{DAffine3, DMat3, DQuat, DVec3, dvec3};

const AXES: Placement = PLACEMENTS[2];

/// Voxels along a grid in which samples have the time to drift.
const LONG: u32 = 160;

/// The distance of 1 from the next f32, and what log may be off by near 1.
const EPS: f64 = 1.0 / (1u32 << 23) as f64;
const LOG: f64 = 1.0 / (1u32 << 21) as f64;

const ON_FACES: &str = "e = 2^-23, an operation may round either way. The opacity of a sample is off by 2^-21 for log, by (3 + 2 s) e \
for exp and by 6 e; each of N samples lets that into the picture, and a blend rounds twice: allowed = N (that + 2 e). The first sample \
lies where the ray enters by the same subtraction and the same division.";

/// Where the main axis is hard to say.
#[derive(Clone, Copy, Debug, PartialEq)]
enum View {
    Flat,
    Diagonal,
    Fine,
}

const VIEWS: [(&str, View); 3] = [
    ("flat", View::Flat),
    ("diagonal", View::Diagonal),
    ("fine", View::Fine),
];

/// All of them.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (word, view) in VIEWS {
        for mode in [Mode::Composite, Mode::Mip, Mode::Xray] {
            // What each of two thousand opacities may be off by adds up to more than says something.
            if view == View::Fine && mode == Mode::Composite {
                continue;
            }
            for (projection, is_perspective) in PROJECTIONS {
                let mode_word = ground::word_of(mode);
                let name =
                    format!("raycast.bresenham.{mode_word}.{word}.linear_fetch.f32.{projection}");
                let mut case = Case::new(name, move |bed| draw(bed, view, mode, is_perspective));
                case.profile = [Profile::Full, Profile::Baseline][usize::from(is_perspective)];
                cases.push(case);
            }
        }
    }
    for (word, towards) in [("forwards", DVec3::Z), ("backwards", DVec3::NEG_Z)] {
        let name = format!("raycast.bresenham.composite.on_faces.{word}");
        cases.push(Case::new(name, move |bed| draw_on_faces(bed, towards)).of(Profile::Full));
    }
    cases
}

fn draw(
    bed: &mut TestBed,
    view: View,
    mode: Mode,
    is_perspective: bool,
) -> Result<Measurement, Stop> {
    let shot = ground::shot(AXES, mode, (Filter::Linear, false), is_perspective);
    let mut shot = shot.with(|settings| settings.crop = None);
    match view {
        View::Flat => {
            shot.grid = Grid {
                dims: [26, 24, 5],
                world_from_voxel: DAffine3::from_scale(dvec3(1.0, 1.0, 5.0)),
            };
            // Mostly along z in the world, and along x in voxels.
            look_along(&mut shot, dvec3(0.5, 0.2, 0.8), DVec3::Y, None);
        }
        View::Diagonal => {
            let turn = DMat3::from_quat(DQuat::from_axis_angle(
                dvec3(0.3, -0.5, 0.8).normalize(),
                0.7,
            ));
            shot.grid = Grid {
                dims: [19, 19, 15],
                world_from_voxel: DAffine3::from_mat3(turn * 1.3),
            };
            // A column of pixels lies in the plane in which both axes are alike.
            shot.extent = [33, 29];
            look_along(&mut shot, turn * dvec3(-1.0, -1.0, 0.3), turn.z_axis, None);
            // Beside the diagonal itself, on which samples along both axes are the same.
            let beside = turn * dvec3(0.2, -0.2, 0.0);
            shot.camera.eye += beside;
            shot.camera.target += beside;
        }
        View::Fine => {
            shot.grid = Grid {
                dims: [9, 8, LONG],
                world_from_voxel: DAffine3::IDENTITY,
            };
            shot.settings.samples_per_voxel = 12.0;
            // Where no tap lies outside.
            shot.settings.crop = Some([DVec3::ONE, shot.grid.far_corner() - 1.0]);
            look_along(&mut shot, dvec3(0.01, 0.007, 1.0), DVec3::Y, Some(8.0));
        }
    }
    let part = Part {
        numbers: match view {
            // The largest value is that of the last sample.
            View::Fine => Numbers::of(&shot, |p| 0.1 + 0.8 * p.z / f64::from(LONG)),
            _ => Numbers::of(&shot, ground::waves),
        },
        function: ground::ramps(),
        role: Role::Numbers,
    };
    let scene = shot.scene(&part.numbers.volume, Some(&part.function));
    let layers: &[LayerKind] = match mode {
        Mode::Composite => &[],
        _ => &[LayerKind::Value],
    };
    measure(bed, &shot, &scene, layers, |chord| {
        seen(&shot, chord, std::slice::from_ref(&part))
    })
}

/// From where the eye looks along a direction at all of the grid, or at so much of its middle.
fn look_along(shot: &mut PictureCase, direction: DVec3, up: DVec3, height: Option<f64>) {
    let size = (shot.grid.world_from_voxel.matrix3 * shot.grid.far_corner()).length();
    let view_height = height.unwrap_or(0.7 * size);
    let distance = 1.7 * size;
    let projection = match shot.camera.projection {
        Projection::Orthographic { .. } => Projection::Orthographic { view_height },
        _ => Projection::Perspective {
            fov_degrees: 2.0 * (0.5 * view_height / distance).atan().to_degrees(),
        },
    };
    shot.camera = Camera {
        eye: shot.grid.center() - distance * direction.normalize(),
        target: shot.grid.center(),
        up,
        projection,
        zoom: 1.0,
    };
}

/// Along the last axis, cut where samples lie.
fn draw_on_faces(bed: &mut TestBed, towards: DVec3) -> Result<Measurement, Stop> {
    const EXTINCTION: f64 = 0.11;
    const SAMPLES: f64 = 7.0;
    let grid = Grid {
        dims: [12, 12, 14],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let mut shot = ground::shot(AXES, Mode::Composite, (Filter::Linear, false), false);
    shot = PictureCase {
        grid,
        camera: Camera {
            eye: grid.center() - 30.0 * towards,
            target: grid.center(),
            up: DVec3::Y,
            projection: Projection::Orthographic { view_height: 12.0 },
            zoom: 1.0,
        },
        extent: [12; 2],
        settings: Settings {
            samples_per_voxel: 1.0,
            crop: Some([dvec3(0.0, 0.0, 2.5), dvec3(12.0, 12.0, 2.5 + SAMPLES)]),
            color_space: Classes::SPACE,
            ..shot.settings
        },
    };
    let function = TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: vec![OpacityPoint {
            value: 0.0,
            opacity: -(-EXTINCTION).exp_m1(),
        }],
        reference_length: Some(1.0),
        interpolation: Interpolation::Step,
        gradient_transfer: None,
        medium: None,
    };
    let numbers = Numbers::of(&shot, |_| 1.0);
    let found = bed.render(&shot.scene(&numbers.volume, Some(&function)), &[])?;
    let wanted = -(-SAMPLES * EXTINCTION).exp_m1();
    let of_sample = LOG + (3.0 + 2.0 * EXTINCTION) * EPS + 6.0 * EPS;
    let allowed = SAMPLES * (of_sample + 2.0 * EPS);
    let mut measurement =
        Measurement::new(Bound::new("on-faces", ON_FACES).with("N", SAMPLES), 500);
    for (pixel, found) in shot.pixels().zip(&found.pixels) {
        for (c, &found) in found.iter().enumerate() {
            let at = || format!("channel {c} of pixel {pixel:?}");
            measurement.take(at, wanted, found.into(), allowed);
        }
    }
    Ok(measurement)
}
