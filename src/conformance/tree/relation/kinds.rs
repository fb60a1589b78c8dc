//! The relations, and for which pictures each holds.

use super::super::ground::Placement;
use crate::technique::{Mode, Order, Technique};

/// What is done to a picture that leaves it as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the table of the module says it")]
pub enum Kind {
    Repeated,
    WithLayers,
    InSmallSubmissions,
    Skipped,
    SkippedByOctree,
    SkippedByRuns,
    InBricks,
    LitInBricks,
    PermutedColors,
    ScaledValues,
    ScaledWorld,
    OtherMode,
    OtherOrder,
    RaysOnPlanes,
    Mirrored,
    Turned,
    InTwo,
    ClearOutside,
    Summed,
    Furnace,
}

impl Kind {
    /// By the words of names.
    pub const ALL: [(&str, Self); 20] = [
        ("repeated", Self::Repeated),
        ("with_layers", Self::WithLayers),
        ("in_small_submissions", Self::InSmallSubmissions),
        ("skipped", Self::Skipped),
        ("skipped_by_octree", Self::SkippedByOctree),
        ("skipped_by_runs", Self::SkippedByRuns),
        ("in_bricks", Self::InBricks),
        ("lit_in_bricks", Self::LitInBricks),
        ("permuted_colors", Self::PermutedColors),
        ("scaled_values", Self::ScaledValues),
        ("scaled_world", Self::ScaledWorld),
        ("other_mode", Self::OtherMode),
        ("other_order", Self::OtherOrder),
        ("rays_on_planes", Self::RaysOnPlanes),
        ("mirrored", Self::Mirrored),
        ("turned", Self::Turned),
        ("in_two", Self::InTwo),
        ("clear_outside", Self::ClearOutside),
        ("summed", Self::Summed),
        ("furnace", Self::Furnace),
    ];

    /// Whether pictures of a placement and a mode stand in it.
    pub fn is_for(self, placement: Placement, mode: Mode) -> bool {
        let is_composite = mode == Mode::Composite;
        let is_xray = mode == Mode::Xray;
        let is_fixed = placement.is_fixed();
        match self {
            Self::Skipped => true,
            Self::SkippedByOctree | Self::SkippedByRuns => {
                is_composite && placement.technique == Technique::Raycast
            }
            Self::InBricks => is_composite || is_xray || mode == Mode::Mip || mode == Mode::Lmip,
            Self::LitInBricks => is_composite,
            Self::Repeated => is_composite || is_xray,
            Self::WithLayers | Self::InSmallSubmissions => is_composite || mode == Mode::Mip,
            Self::PermutedColors | Self::ScaledWorld | Self::Furnace => is_composite,
            Self::ScaledValues => is_composite || mode == Mode::Mip || mode == Mode::Iso,
            Self::OtherMode => matches!(mode, Mode::Mida | Mode::Lmip),
            Self::OtherOrder => {
                is_composite && placement.is_slicer() && placement.order == Order::BackToFront
            }
            Self::RaysOnPlanes => (is_composite || is_xray) && placement.word == "slices_3d.over",
            Self::Mirrored | Self::Turned => is_composite || is_xray,
            Self::InTwo | Self::ClearOutside => is_composite && is_fixed,
            Self::Summed => is_xray,
        }
    }

    /// Whether pictures of random paths stand in it.
    pub fn is_for_paths(self) -> bool {
        matches!(
            self,
            Self::Repeated
                | Self::InSmallSubmissions
                | Self::PermutedColors
                | Self::ScaledValues
                | Self::ScaledWorld
        )
    }

    /// Whether empty space is that of single voxels.
    pub fn is_by_voxels(self) -> bool {
        matches!(self, Self::SkippedByOctree | Self::SkippedByRuns)
    }

    /// Whether a picture of bricks stands in it.
    pub fn is_of_bricks(self) -> bool {
        matches!(self, Self::InBricks | Self::LitInBricks)
    }

    /// Whether no bit may differ.
    pub fn is_exact(self) -> bool {
        matches!(
            self,
            Self::Repeated
                | Self::WithLayers
                | Self::InSmallSubmissions
                | Self::Skipped
                | Self::SkippedByOctree
                | Self::SkippedByRuns
                | Self::InBricks
                | Self::LitInBricks
                | Self::PermutedColors
                | Self::ScaledValues
                | Self::ScaledWorld
                | Self::OtherMode
        )
    }
}
