//! Shear-warp, against the same functions on the CPU in f64: more base pixels than voxels, and an eye that looks nearly along the
//! slices' axis, along which base rays and slices are most alike.
//!
//! Not slabs: of pixels of four such rays a sixth and more depends on rounding.

use super::ground::{self, PROJECTIONS, SHEAR_WARP};
use super::reference;
use crate::conformance::case::{Case, Profile};
use crate::conformance::oracle::PictureCase;
use crate::picture::ColorSpace;
use crate::technique::{Filter, Intermediate, Mode};
use glam::dvec3;

/// What of shear-warp is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look {
    /// Two base pixels a voxel.
    Fine,
    /// From near the axis y.
    AlongAxis,
}

impl Look {
    const ALL: [(Self, &str); 2] = [(Self::Fine, "fine"), (Self::AlongAxis, "along_axis")];
}

/// Composites of each look.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (look, word) in Look::ALL {
        for (projection, is_perspective) in PROJECTIONS {
            let name = format!(
                "reference.{}.composite.{word}.linear_fetch.{projection}",
                SHEAR_WARP.word
            );
            let mut case = Case::new(name, move |bed| {
                reference::of_shot(bed, &shot(look, is_perspective), false)
            });
            case.profile = match is_perspective {
                true => Profile::Baseline,
                false => Profile::Full,
            };
            cases.push(case);
        }
    }
    cases
}

fn shot(look: Look, is_perspective: bool) -> PictureCase {
    let filter = (Filter::Linear, false);
    let shot = ground::shot(SHEAR_WARP, Mode::Composite, filter, is_perspective);
    let mut shot = shot.with(|settings| {
        settings.crop = None;
        settings.color_space = ColorSpace::Linear;
        if look == Look::Fine {
            settings.intermediate = Intermediate::PerVoxel(2.0);
        }
    });
    if look == Look::AlongAxis {
        let axes = shot.grid.world_from_voxel.matrix3;
        let back = shot.camera.eye - shot.camera.target;
        let towards = (axes * dvec3(0.03, -1.0, 0.02)).normalize();
        shot.camera.eye = shot.camera.target + back.length() * towards;
    }
    shot
}
