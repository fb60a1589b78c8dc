//! Splats, against the same sums on the CPU in f64: values and extremes in sheets, sums, voxels that are classified before, voxels
//! without data, splats that wide pixels widen, splats that end early, and an eye far away and near by.

use super::ground::{self, MODES, PROJECTIONS, RAYS};
use super::reference;
use crate::camera::Projection;
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::Measurement;
use crate::conformance::oracle::PictureCase;
use crate::conformance::test_bed::TestBed;
use crate::named::Named;
use crate::picture::ColorSpace;
use crate::scene::{Beside, Scene};
use crate::technique::preclassified::preclassified;
use crate::technique::splat::Sheets;
use crate::technique::{Filter, Mode, Technique};
use crate::volume::Volume;

/// Thickness of sheets, in steps: a slice of the grid at hand reaches into fewer than there is room for.
const SAMPLES_PER_VOXEL: f64 = 0.5;
/// No splat is thinner than so many pixels, about twice as wide as that of a voxel: along no axis of the grid is it as wide as along
/// another, so its precision is no diagonal.
const WIDE: f64 = 1.2;

/// What splats are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look {
    Plain,
    Holes,
    Wide,
    Classified,
    /// Cut as for pictures of 8 bits.
    Short,
    Far,
    Near,
}

impl Look {
    const ALL: [(Self, &str); 7] = [
        (Self::Plain, "plain"),
        (Self::Holes, "holes"),
        (Self::Wide, "wide"),
        (Self::Classified, "classified"),
        (Self::Short, "short"),
        (Self::Far, "far"),
        (Self::Near, "near"),
    ];

    /// Whether what is asked is what a ray takes of a splat: sheets have no part in it.
    fn is_of_one_splat(self) -> bool {
        matches!(self, Self::Short | Self::Far | Self::Near)
    }

    /// Whether there is such a picture: sums have no sheets, and only classified voxels are composited without them.
    fn is_drawn(self, sheets: Sheets, mode: Mode) -> bool {
        let is_sum = matches!(mode, Mode::Average | Mode::Xray);
        match (self, sheets) {
            (Self::Classified, _) => mode == Mode::Composite,
            (look, _) if look.is_of_one_splat() => sheets == Sheets::Image && mode == Mode::Xray,
            (Self::Wide, _) if !matches!(mode, Mode::Composite | Mode::Xray) => false,
            (_, Sheets::Image) => true,
            (_, Sheets::Axis) => !is_sum,
            (_, Sheets::None) => false,
        }
    }
}

/// The product of sheets, modes and looks.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for &sheets in Sheets::ALL {
        for mode in MODES {
            for (look, word) in Look::ALL {
                if !look.is_drawn(sheets, mode) {
                    continue;
                }
                for (projection, is_perspective) in PROJECTIONS {
                    // Of parallel rays all distances are alike.
                    if matches!(look, Look::Far | Look::Near) && !is_perspective {
                        continue;
                    }
                    let of_mode = ground::word_of(mode);
                    let name = format!("splat.{}.{of_mode}.{word}.{projection}", sheets.name());
                    let mut case = Case::new(name, move |bed| {
                        measure(bed, sheets, mode, look, is_perspective)
                    });
                    case.profile = match is_perspective {
                        true => Profile::Baseline,
                        false => Profile::Full,
                    };
                    cases.push(case);
                }
            }
        }
    }
    cases
}

fn measure(
    bed: &mut TestBed,
    sheets: Sheets,
    mode: Mode,
    look: Look,
    is_perspective: bool,
) -> Result<Measurement, Stop> {
    let shot = ground::shot(RAYS, mode, (Filter::Linear, false), is_perspective);
    let shot = shot.with(|settings| {
        settings.technique = Technique::Splat;
        settings.splat.sheets = sheets;
        settings.samples_per_voxel = SAMPLES_PER_VOXEL;
        settings.crop = None;
        settings.color_space = ColorSpace::Linear;
        if look == Look::Wide {
            settings.splat.low_pass = WIDE;
        }
        if look.is_of_one_splat() {
            settings.splat.low_pass = 0.0;
        }
        if look == Look::Short {
            settings.splat.cut_bits = 8;
        }
    });
    let shot = match look {
        Look::Far => from(shot, 6.0, 4.4),
        Look::Near => from(shot, 0.42, 75.0),
        _ => shot,
    };
    match look {
        Look::Classified => classified(bed, &shot),
        look if look.is_of_one_splat() => summed(bed, &shot),
        _ => reference::of_shot(bed, &shot, look == Look::Holes),
    }
}

/// With so many times the distance of its eye from what it looks at.
fn from(mut shot: PictureCase, times: f64, fov_degrees: f64) -> PictureCase {
    let back = shot.camera.eye - shot.camera.target;
    shot.camera.eye = shot.camera.target + times * back;
    shot.camera.projection = Projection::Perspective { fov_degrees };
    shot
}

/// The sums of a shot, of waves, by a function that still tells them apart: integrals of some 20 voxels.
fn summed(bed: &mut TestBed, shot: &PictureCase) -> Result<Measurement, Stop> {
    let volume = reference::volume(shot, false);
    let mut function = ground::ramps();
    let colors = function.color.iter_mut().map(|point| &mut point.value);
    let opacities = function.opacity.iter_mut().map(|point| &mut point.value);
    colors.chain(opacities).for_each(|value| *value *= 16.0);
    reference::of_scene(bed, shot, &shot.scene(&volume, Some(&function)))
}

/// The picture of a shot, of waves that are classified before.
fn classified(bed: &mut TestBed, shot: &PictureCase) -> Result<Measurement, Stop> {
    let volume = reference::volume(shot, false);
    let function = ground::ramps();
    let length = shot.scene(&volume, Some(&function)).length_of(&function);
    let space = shot.settings.color_space;
    let parts = preclassified(&volume, &function, length, space)
        .map_err(|problem| Stop::Suite(problem.to_string()))?;
    let beside: Vec<&Volume> = parts[1..].iter().collect();
    let scene = Scene {
        beside: Beside::Classified(&beside),
        ..shot.scene(&parts[0], Some(&function))
    };
    reference::of_scene(bed, shot, &scene)
}
