//! Relations between pictures: no answer is known, and two of them must agree.
//!
//! | relation | allowed |
//! |---|---|
//! | the same picture twice; with other layers asked for; in small submissions; in bricks, lit too | nothing |
//! | empty space skipped and not, in every mode; by macro cells, by an octree of voxels and by runs of them | nothing |
//! | colours of the function permuted, and the picture's | nothing |
//! | values times 4 and the function's; the world twice as large | nothing: powers of two round nothing |
//! | MIDA of gamma -1 and compositing; LMIP of no threshold and MIP | nothing |
//! | front to back and back to front; view-aligned slices and rays on their lattice | both running errors |
//! | the volume mirrored along an axis, or its axes taken in turn, and the world with them | both |
//! | both halves of a box, one over the other, and the whole | all three |
//! | a crop, and a function that is clear outside of it | both |
//! | an X-ray of a sum, and the sum of X-rays | all three |
//! | one colour in front of a background of it, and that colour | one |

mod kinds;
mod pair;

use super::ground::{self, PROJECTIONS, Placement};
use crate::conformance::case::{Case, Profile};
use crate::named::Named;
use crate::technique::{Mode, Order};
use crate::volume::VoxelType;
pub use kinds::Kind;

/// Every relation for every placement, mode and projection that has it.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for placement in ground::all_placements() {
        for (projection, is_perspective) in PROJECTIONS {
            for (word, kind) in Kind::ALL {
                for &mode in Mode::ALL {
                    let Some(of) = placement.word_in(mode) else {
                        continue;
                    };
                    if !has(placement, mode) || !kind.is_for(placement, mode) {
                        continue;
                    }
                    let mode_word = ground::word_of(mode);
                    let name = format!("relation.{word}.{of}.{mode_word}.{projection}");
                    let mut case = Case::new(name, move |bed| {
                        pair::measure(bed, kind, placement, mode, is_perspective)
                    });
                    case.needs = ground::needs(placement, mode, VoxelType::F32, false);
                    if kind.is_of_bricks() && placement.is_slicer() {
                        // Batches end where bricks do: in 16-bit floats that is another picture.
                        case.needs = vec![ground::blended_floats()];
                    }
                    case.profile = profile(kind, placement, mode, is_perspective);
                    cases.push(case);
                }
            }
        }
    }
    cases.extend(of_paths());
    cases
}

/// Those that random paths stand in: all that change no number that they draw.
fn of_paths() -> impl Iterator<Item = Case> {
    let kinds = Kind::ALL
        .into_iter()
        .filter(|(_, kind)| kind.is_for_paths());
    kinds.map(|(word, kind)| {
        let (placement, mode) = (ground::PATHS, Mode::Composite);
        let name = format!("relation.{word}.{}.composite.perspective", placement.word);
        Case::new(name, move |bed| {
            pair::measure(bed, kind, placement, mode, true)
        })
    })
}

fn has(placement: Placement, mode: Mode) -> bool {
    !mode.needs_rays() || placement.has_rays()
}

/// The baseline has each relation in each placement, and the modes where they are other shaders.
fn profile(kind: Kind, placement: Placement, mode: Mode, is_perspective: bool) -> Profile {
    let is_common = mode == Mode::Composite || mode.needs_rays();
    let is_first = placement.order == Order::BackToFront;
    let is_in = match kind {
        Kind::Skipped => is_perspective || mode == Mode::Composite,
        Kind::InBricks => is_perspective && is_first && mode != Mode::Xray,
        Kind::LitInBricks => is_perspective && is_first,
        _ if mode == Mode::Composite => is_perspective || is_first,
        _ => is_perspective != (is_common || mode == Mode::Xray),
    };
    match is_in {
        true => Profile::Baseline,
        false => Profile::Full,
    }
}
