//! Light that matter scatters: once along rays, and along random paths.
//!
//! ```text
//! single    rays, light scattered once, against the CPU references in f64
//! paths     random paths, path by path, against the CPU references in f64: both draw the same numbers
//! closed    random paths against closed forms, in macro cells too, which change the numbers that paths draw
//! ```

mod closed;
mod paths;
mod single;

use super::ground;
use crate::conformance::case::Case;
use crate::conformance::oracle::PictureCase;
use crate::picture::ColorSpace;
use crate::technique::pathtrace::{Lamp, LampShape, PathTracing};
use crate::technique::{Filter, Light, Mode};
use crate::transfer::Phase;
use glam::{DVec3, dvec3};

/// All of them.
pub fn cases() -> Vec<Case> {
    let mut cases = single::cases();
    cases.extend(paths::cases());
    cases.extend(closed::cases());
    cases
}

/// Pixels of a picture: a case takes less than a second of a processor.
const EXTENT: [u32; 2] = [24, 22];

/// A light of colour 1 from this direction.
fn light(towards: DVec3) -> Light {
    Light::of_world(towards, [1.0; 3])
}

/// Matter that takes a tenth of the light, scatters it forwards and back, under two lights.
fn lit() -> PathTracing {
    PathTracing {
        samples: 4,
        albedo: 0.9,
        density: 0.7,
        phase: Phase::TwoLobes {
            part: 0.6,
            g: [0.7, -0.3],
        },
        lights: vec![light(dvec3(1.0, 2.0, 0.5)), light(dvec3(-1.0, 0.2, 1.0))],
        ..PathTracing::default()
    }
}

/// A light at this place, in voxel space.
fn lamp(voxel: DVec3, shape: LampShape, srgb: [f64; 3]) -> Lamp {
    Lamp {
        place: ground::grid().world_from_voxel.transform_point3(voxel),
        shape,
        srgb,
    }
}

/// One perspective picture of a placement, all of the grid in it.
fn shot(placement: ground::Placement, filter: Filter) -> PictureCase {
    let mut shot = ground::shot(placement, Mode::Composite, (filter, false), true);
    shot.extent = EXTENT;
    shot.settings.crop = None;
    shot.settings.color_space = ColorSpace::Linear;
    shot
}
