//! Splats, against the same sums on the CPU in f64: values and extremes in sheets that are slices, sums, and with voxels without
//! data.

use super::ground::{self, MODES, PROJECTIONS, RAYS};
use super::reference;
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::Measurement;
use crate::conformance::test_bed::TestBed;
use crate::named::Named;
use crate::picture::ColorSpace;
use crate::technique::splat::Sheets;
use crate::technique::{Filter, Mode, Technique};

/// Thickness of sheets, in steps: a slice of the grid at hand reaches into fewer than there is room for.
const SAMPLES_PER_VOXEL: f64 = 0.5;

/// The product of sheets and modes.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for sheets in [Sheets::Image, Sheets::Axis] {
        for mode in MODES {
            // Sums have no sheets; into which sheet that faces the eye a slice first reaches depends on rounding, in more pixels
            // than a case may leave out: `tests/exact/splat` has those.
            let is_sum = matches!(mode, Mode::Average | Mode::Xray);
            if is_sum != (sheets == Sheets::Image) {
                continue;
            }
            for (look, has_holes) in [("plain", false), ("holes", true)] {
                for (projection, is_perspective) in PROJECTIONS {
                    let word = ground::word_of(mode);
                    let name = format!("splat.{}.{word}.{look}.{projection}", sheets.name());
                    let mut case = Case::new(name, move |bed| {
                        measure(bed, sheets, mode, has_holes, is_perspective)
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
    has_holes: bool,
    is_perspective: bool,
) -> Result<Measurement, Stop> {
    let shot = ground::shot(RAYS, mode, (Filter::Linear, false), is_perspective);
    let shot = shot.with(|settings| {
        settings.technique = Technique::Splat;
        settings.splat.sheets = sheets;
        settings.samples_per_voxel = SAMPLES_PER_VOXEL;
        settings.crop = None;
        settings.color_space = ColorSpace::Linear;
    });
    reference::of_shot(bed, &shot, has_holes)
}
