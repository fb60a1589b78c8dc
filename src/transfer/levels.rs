//! The values of which a volume shows a surface, where nothing is said: what separates its matter.

use super::{Kind, ValueSummary};

/// Skin stands where air turns to tissue.
const SKIN_HU: f64 = -300.0;
/// Over this is bone, with little of what a contrast agent fills.
const BONE_HU: f64 = 250.0;
/// Less bone than this is specks.
const BONE_SHARE: f64 = 0.003;
/// What skin takes of the light of the bone behind it.
const SKIN_OPACITY: f64 = 0.25;

/// Values and the opacities of their surfaces, so that the ones inside are seen.
///
/// Hounsfield units: bone, in faint skin. Values on both sides of zero: half of the strongest on each side. Else the
/// value that best parts dark from bright (Otsu's), of all but the darkest and brightest thousandth.
pub fn levels(summary: &ValueSummary) -> Vec<(f64, f64)> {
    let [low, high] = [0.001, 0.999].map(|share| summary.quantile(share));
    match Kind::of(summary) {
        Kind::Ct if 1.0 - summary.share_below(BONE_HU) > BONE_SHARE => {
            vec![(SKIN_HU, SKIN_OPACITY), (BONE_HU, 1.0)]
        }
        Kind::Ct => vec![(SKIN_HU, 1.0)],
        Kind::Signed => vec![(0.5 * low, 1.0), (0.5 * high, 1.0)],
        Kind::Labels | Kind::Tissue | Kind::Sparse | Kind::Uptake | Kind::Field => {
            vec![(summary.threshold(low, high), 1.0)]
        }
    }
}
