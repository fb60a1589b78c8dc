//! How gradients are made: flags to [`GradientFilter`].

use crate::technique::GradientFilter;
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

    /// Flags that change nothing where gradients make nothing of the picture, a sentence each.
    pub fn idle(&self, has_gradients: bool) -> Vec<&'static str> {
        match self.gradient_filter {
            Some(_) if !has_gradients => vec![
                "--gradient-filter has no effect without --shading phong or a function of gradients",
            ],
            _ => Vec::new(),
        }
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
        };
        assert_eq!(said.filter(), GradientFilter::Cubic);
        assert_eq!((said.idle(false).len(), said.idle(true).len()), (1, 0));
    }
}
