//! What says where rays need not look, in words.

use crate::technique::SkipBy;
use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// A [`SkipBy`] as options and scene files name it, or that rays look everywhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EmptySpaceWord {
    /// Blocks of 8^3 voxels, and how far away the next one with matter is
    #[default]
    Cells,
    /// The octree of single voxels with matter
    Octree,
    /// Their runs along x
    Runs,
    /// Nothing is left out, as by --no-skip
    None,
}

impl EmptySpaceWord {
    /// Whether something is left out.
    pub fn skips(self) -> bool {
        self != Self::None
    }

    /// By what.
    pub fn skip_by(self) -> SkipBy {
        match self {
            Self::Octree => SkipBy::Octree,
            Self::Runs => SkipBy::Runs,
            Self::Cells | Self::None => SkipBy::Cells,
        }
    }
}
