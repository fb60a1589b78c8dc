//! How gradients are made: flags to [`GradientFilter`].

use crate::technique::{GradientFilter, GradientStorage};
use clap::{Args, ValueEnum};
use serde::{Deserialize, Serialize};

const HEADING: &str = "Light";

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GradientFlags {
    /// How gradients are made, for light and for functions of gradients [default: central]
    #[arg(long, value_name = "FILTER", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gradient_filter: Option<GradientWord>,
    /// Whether gradients are made for each sample or kept at the voxels, 8 bytes each on the device [default: made]
    #[arg(long, value_name = "WHERE", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gradients: Option<GradientStorageWord>,
}

/// Every word of `--gradients`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GradientStorageWord {
    /// Made for each sample
    #[default]
    Made,
    /// Kept: central differences and sobel of the trilinear field, where every voxel has data, without --conformance
    Kept,
    /// Kept where they can be and a graphics card has the memory; made on software devices, which are no faster so
    Auto,
}

/// Every word of `--gradient-filter`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GradientWord {
    /// Central differences, one voxel before and after, of values as --filter makes them
    #[default]
    Central,
    /// Central differences of the trilinear field, whatever --filter is
    Linear,
    /// Sobel's 3 x 3 x 3 operator on the trilinear field: smoother where voxels are noisy
    Sobel,
    /// The derivative of the cubic B-spline through the voxels, whatever --filter is: the most exact
    Cubic,
    /// The derivative of --filter itself; nearest and linear have none
    Analytic,
}

impl GradientFlags {
    /// What it stands for.
    pub fn filter(&self) -> GradientFilter {
        match self.gradient_filter.unwrap_or_default() {
            GradientWord::Central => GradientFilter::Central,
            GradientWord::Linear => GradientFilter::Linear,
            GradientWord::Sobel => GradientFilter::Sobel,
            GradientWord::Cubic => GradientFilter::Cubic,
            GradientWord::Analytic => GradientFilter::Analytic,
        }
    }

    /// Whether they are kept.
    pub fn keep(&self) -> GradientStorage {
        match self.gradients.unwrap_or_default() {
            GradientStorageWord::Made => GradientStorage::OnTheFly,
            GradientStorageWord::Kept => GradientStorage::Precomputed,
            GradientStorageWord::Auto => GradientStorage::Auto,
        }
    }

    /// Flags that change nothing where gradients make nothing of the picture, a sentence each.
    pub fn idle(&self, has_gradients: bool) -> Vec<&'static str> {
        if has_gradients {
            return Vec::new();
        }
        let filter = self.gradient_filter.map(|_| {
            "--gradient-filter has no effect without --shading phong or a function of gradients"
        });
        let keep = self.gradients.map(
            |_| "--gradients has no effect without --shading phong or a function of gradients",
        );
        filter.into_iter().chain(keep).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_are_central_differences_of_the_values_unless_said() {
        assert_eq!(GradientFlags::default().filter(), GradientFilter::Central);
        let said = GradientFlags {
            gradient_filter: Some(GradientWord::Cubic),
            gradients: Some(GradientStorageWord::Auto),
        };
        assert_eq!(said.filter(), GradientFilter::Cubic);
        assert_eq!((said.idle(false).len(), said.idle(true).len()), (2, 0));
        let kept = (GradientFlags::default().keep(), said.keep());
        assert_eq!(kept, (GradientStorage::OnTheFly, GradientStorage::Auto));
    }
}
