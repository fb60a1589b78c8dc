//! The words that flags of sampling take, built or not, and what they stand for.

use crate::{
    picture::ColorSpace,
    technique::{Filter, FilterBy, Lattice, Mode, Order, Technique},
};
use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// Every word of `--technique`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum TechniqueWord {
    #[default]
    Raycast,
    #[value(name = "slices-3d")]
    #[serde(rename = "slices-3d")]
    Slices3d,
    #[value(name = "slices-2d")]
    #[serde(rename = "slices-2d")]
    Slices2d,
}

impl TechniqueWord {
    /// What it stands for.
    pub fn technique(self) -> Technique {
        match self {
            Self::Raycast => Technique::Raycast,
            Self::Slices3d => Technique::Slices3d,
            Self::Slices2d => Technique::Slices2d,
        }
    }
}

/// Every word of `--mode`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum ModeWord {
    #[default]
    Composite,
    Mip,
    Minip,
    Average,
    Xray,
    /// The first local maximum over a threshold
    Lmip,
    /// The maximum of values that fade behind others
    AttenuatedMip,
    /// Composite in which a new maximum clears what lies before it
    Mida,
    /// Surfaces where the volume has a value, or several
    Iso,
}

impl ModeWord {
    /// What it stands for.
    pub fn mode(self) -> Mode {
        match self {
            Self::Composite => Mode::Composite,
            Self::Mip => Mode::Mip,
            Self::Minip => Mode::Minip,
            Self::Average => Mode::Average,
            Self::Xray => Mode::Xray,
            Self::Lmip => Mode::Lmip,
            Self::AttenuatedMip => Mode::AttenuatedMip,
            Self::Mida => Mode::Mida,
            Self::Iso => Mode::Iso,
        }
    }
}

/// Every word of `--filter`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum FilterWord {
    Nearest,
    #[default]
    Linear,
    #[value(help = "quadratic B-spline through the voxels")]
    Quadratic,
    #[value(help = "cubic B-spline through the voxels, the most exact")]
    Cubic,
    #[value(help = "quadratic B-spline of the voxels: never rings, blurs more than linear")]
    QuadraticSmooth,
    #[value(help = "cubic B-spline of the voxels: never rings, blurs most")]
    CubicSmooth,
    #[value(help = "Catmull-Rom cubic through the voxels")]
    CatmullRom,
}

impl FilterWord {
    /// The flag with this word.
    pub fn said(self) -> String {
        let name = self.to_possible_value();
        format!(
            "--filter {}",
            name.as_ref().map_or("", |name| name.get_name())
        )
    }

    /// The word for this filter.
    pub fn of(filter: Filter) -> Self {
        let word = Self::value_variants()
            .iter()
            .find(|word| word.filter() == filter);
        *word.expect("every filter has a word")
    }

    /// What it stands for.
    pub fn filter(self) -> Filter {
        match self {
            Self::Nearest => Filter::Nearest,
            Self::Linear => Filter::Linear,
            Self::Quadratic => Filter::Quadratic,
            Self::Cubic => Filter::Cubic,
            Self::QuadraticSmooth => Filter::QuadraticSmooth,
            Self::CubicSmooth => Filter::CubicSmooth,
            Self::CatmullRom => Filter::CatmullRom,
        }
    }
}

/// Every word of `--filter-by`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum FilterByWord {
    #[default]
    #[value(
        help = "fetch for rays where the driver is llvmpipe, whose sampler is slower; else sampler"
    )]
    Auto,
    #[value(help = "the device's sampler, whose weights have some 8 bits on graphics cards")]
    Sampler,
    #[value(help = "the shader, with weights in floats")]
    Fetch,
}

impl FilterByWord {
    /// What it stands for.
    pub fn filter_by(self) -> FilterBy {
        match self {
            Self::Auto => FilterBy::Auto,
            Self::Sampler => FilterBy::Sampler,
            Self::Fetch => FilterBy::Fetch,
        }
    }
}

/// Every word of `--lattice`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum LatticeWord {
    #[default]
    Ray,
    Planes,
}

impl LatticeWord {
    /// What it stands for.
    pub fn lattice(self) -> Lattice {
        match self {
            Self::Ray => Lattice::Ray,
            Self::Planes => Lattice::Planes,
        }
    }
}

/// Every word of `--order`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum OrderWord {
    #[default]
    BackToFront,
    FrontToBack,
}

impl OrderWord {
    /// What it stands for.
    pub fn order(self) -> Order {
        match self {
            Self::BackToFront => Order::BackToFront,
            Self::FrontToBack => Order::FrontToBack,
        }
    }
}

/// Every word of `--color-space`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum ColorSpaceWord {
    #[default]
    Linear,
    Display,
}

impl ColorSpaceWord {
    /// What it stands for.
    pub fn color_space(self) -> ColorSpace {
        match self {
            Self::Linear => ColorSpace::Linear,
            Self::Display => ColorSpace::Display,
        }
    }
}
