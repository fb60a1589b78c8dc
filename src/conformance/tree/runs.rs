//! Classified voxels of shear-warp, which lie in runs, against the same numbers in four dense volumes:
//!
//! ```text
//! nearest     of oblique slices, seen in perspective
//! linear      along an axis, from places of few binary digits: samples lie in their slices to the last bit
//! ```
//!
//! Voxels have codes of 16 bits, of which the device makes the runs. The dense numbers are stored as halves with a rescale by 2, of
//! which there are no runs; no sum rounds otherwise for it.

use super::ground::{self, SHEAR_WARP};
use crate::camera::{Camera, Projection};
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::{Bound, Measurement, Pictures};
use crate::conformance::oracle::{Numbers, PictureCase};
use crate::conformance::test_bed::TestBed;
use crate::scene::{Beside, Scene};
use crate::technique::preclassified::preclassified;
use crate::technique::{Filter, Intermediate, Mode};
use crate::volume::{Rescale, Volume, Voxels};
use glam::{DAffine3, DVec3, dvec3};

/// Rows of three words of 32 voxels, of the last of which some bits are no voxels.
const DIMS: [u32; 3] = [75, 13, 11];

const DERIVATION: &str =
    "the same operations on the same numbers, or on numbers times a power of two: no bit differs";

/// How voxels are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look {
    Nearest,
    /// Along this axis.
    Linear(usize),
}

/// From where voxels in runs and dense ones are seen the same.
pub fn cases() -> Vec<Case> {
    let looks = [
        ("nearest.perspective", Look::Nearest, Profile::Baseline),
        ("linear_fetch.along_x", Look::Linear(0), Profile::Full),
        ("linear_fetch.along_y", Look::Linear(1), Profile::Full),
        ("linear_fetch.along_z", Look::Linear(2), Profile::Baseline),
    ];
    let case = |(word, look, profile)| {
        let name = format!("relation.runs.{}.composite.{word}", SHEAR_WARP.word);
        let mut case = Case::new(name, move |bed| measure(bed, look));
        case.profile = profile;
        case
    };
    looks.into_iter().map(case).collect()
}

fn measure(bed: &mut TestBed, look: Look) -> Result<Measurement, Stop> {
    let shot = shot(look);
    let function = ground::ramps();
    let volume = islands(&shot);
    let coded = Scene {
        beside: Beside::Preclassified,
        ..shot.scene(&volume, Some(&function))
    };
    let found = bed.render(&coded, &[])?;
    let (length, space) = (coded.reference_length(), coded.settings.color_space);
    let made = preclassified(&volume, &function, length, space)
        .map_err(|problem| Stop::Suite(problem.to_string()))?;
    let dense = made.map(halved);
    let [red, beside @ ..] = dense.each_ref();
    let dense = Scene {
        beside: Beside::Classified(&beside),
        ..shot.scene(red, Some(&function))
    };
    let expected = bed.render(&dense, &[])?;
    let mut measurement = Measurement::new(Bound::new("same-bytes", DERIVATION), 1000);
    for (i, pixel) in shot.pixels().enumerate() {
        for c in 0..4 {
            let at = || format!("channel {c} of pixel {pixel:?}");
            let [expected, found] = [&expected, &found].map(|p| f64::from(p.pixels[i][c]));
            measurement.take(at, expected, found, 0.0);
        }
    }
    let drawn = found.pixels.iter().filter(|pixel| pixel[3] > 0.01).count();
    measurement.hold(|| "pixels that are drawn".into(), drawn > 100);
    measurement.pictures = Some(Pictures {
        width: shot.extent[0],
        expected: expected.pixels,
        found: found.pixels,
    });
    Ok(measurement)
}

/// One sample a slice.
fn shot(look: Look) -> PictureCase {
    let filter = match look {
        Look::Nearest => Filter::Nearest,
        Look::Linear(_) => Filter::Linear,
    };
    let is_perspective = look == Look::Nearest;
    let shot = ground::shot(SHEAR_WARP, Mode::Composite, (filter, false), is_perspective);
    let mut shot = shot.with(|settings| {
        settings.crop = None;
        settings.samples_per_voxel = 1.0;
    });
    shot.grid.dims = DIMS;
    match look {
        Look::Nearest => {
            shot.camera = ground::oblique_camera(&shot.grid, shot.camera.projection);
            let size = (shot.grid.world_from_voxel.matrix3 * shot.grid.far_corner()).length();
            shot.camera.eye = shot.camera.target + size * dvec3(0.4, -1.6, 0.9);
        }
        Look::Linear(axis) => {
            shot.grid.world_from_voxel = DAffine3::IDENTITY;
            shot.camera = along(axis);
            // Between voxels, and as fine as the picture.
            shot.settings.intermediate = Intermediate::PerVoxel(2.0);
            shot.extent = match axis {
                0 => [32, 28],
                _ => [160, 28],
            };
        }
    }
    shot
}

/// Two pixels a voxel.
fn along(axis: usize) -> Camera {
    let center = 0.5 * DVec3::from(DIMS.map(f64::from));
    Camera {
        eye: center - 128.0 * DVec3::AXES[axis],
        target: center,
        up: match axis {
            0 | 2 => DVec3::Y,
            _ => DVec3::Z,
        },
        projection: Projection::Orthographic { view_height: 14.0 },
        zoom: 1.0,
    }
}

/// Waves of which half are under water: full voxels with wide gaps between.
fn islands(shot: &PictureCase) -> Volume {
    const MOST: f64 = 65_535.0;
    let above = |p: DVec3| (2.0 * ground::waves(1.6 * p) - 1.0).clamp(0.0, 1.0);
    let volume = Numbers::of(shot, |p| (MOST * above(p)).round()).volume;
    let Voxels::F32(numbers) = volume.voxels else {
        unreachable!("made of floats")
    };
    let voxels = Voxels::U16(numbers.into_iter().map(|n| n as u16).collect());
    let rescale = Rescale {
        slope: 1.0 / MOST,
        intercept: 0.0,
    };
    let made = Volume::from_voxels(volume.dims, volume.world_from_voxel, voxels, rescale, None);
    made.expect("as many voxels as the grid has")
}

/// The same values otherwise stored.
fn halved(volume: Volume) -> Volume {
    let Voxels::F32(numbers) = volume.voxels else {
        unreachable!("made of floats")
    };
    Volume {
        voxels: Voxels::F32(numbers.into_iter().map(|n| 0.5 * n).collect()),
        rescale: Rescale {
            slope: 2.0,
            intercept: 0.0,
        },
        ..volume
    }
}
