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

/// A surface where nothing is said of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The value that the volume has there.
    pub value: f64,
    /// What it takes of the light from behind, 0 to 1.
    pub opacity: f64,
    /// Its colour before light, in sRGB numbers.
    pub srgb: [f64; 3],
}

/// Colours of surfaces, from the one inside outwards: light, so that their shading is seen.
pub const SURFACE_COLORS: [[f64; 3]; 8] = [
    BONE,
    SKIN,
    [0.55, 0.75, 0.90],
    [0.65, 0.85, 0.60],
    [0.90, 0.65, 0.80],
    [0.95, 0.85, 0.45],
    [0.60, 0.85, 0.85],
    [0.75, 0.70, 0.95],
];

const BONE: [f64; 3] = [0.96, 0.91, 0.80];
const SKIN: [f64; 3] = [0.93, 0.70, 0.56];
const BELOW_ZERO: [f64; 3] = [0.35, 0.55, 0.95];
const ABOVE_ZERO: [f64; 3] = [0.95, 0.45, 0.35];

/// Surfaces that show what the values look like, the ones inside seen through the others.
///
/// Hounsfield units: bone, in faint skin. Values on both sides of zero: half of the strongest on each side. Else the
/// value that best parts dark from bright (Otsu's), of all but the darkest and brightest thousandth.
pub fn surfaces(summary: &ValueSummary) -> Vec<Surface> {
    let surface = |value, opacity, srgb| Surface {
        value,
        opacity,
        srgb,
    };
    let [low, high] = [0.001, 0.999].map(|share| summary.quantile(share));
    match Kind::of(summary) {
        Kind::Ct if 1.0 - summary.share_below(BONE_HU) > BONE_SHARE => vec![
            surface(SKIN_HU, SKIN_OPACITY, SKIN),
            surface(BONE_HU, 1.0, BONE),
        ],
        Kind::Ct => vec![surface(SKIN_HU, 1.0, SKIN)],
        Kind::Signed => vec![
            surface(0.5 * low, 1.0, BELOW_ZERO),
            surface(0.5 * high, 1.0, ABOVE_ZERO),
        ],
        Kind::Labels | Kind::Tissue | Kind::Sparse | Kind::Uptake | Kind::Field => {
            vec![surface(summary.threshold(low, high), 1.0, BONE)]
        }
    }
}
