//! Techniques, modes and filters by the words that people write.

use super::{Filter, Mode, Technique};
use std::fmt::{Display, Formatter, Result};

impl Display for Technique {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(match self {
            Self::Raycast => "raycast",
            Self::Slices3d => "slices-3d",
            Self::Slices2d => "slices-2d",
        })
    }
}

impl Display for Mode {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(match self {
            Self::Composite => "composite",
            Self::Mip => "mip",
            Self::Minip => "minip",
            Self::Average => "average",
            Self::Xray => "xray",
            Self::Lmip => "lmip",
            Self::AttenuatedMip => "attenuated-mip",
            Self::Iso => "iso",
            Self::Mida => "mida",
        })
    }
}

impl Display for Filter {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(match self {
            Self::Nearest => "nearest",
            Self::Linear => "linear",
            Self::Quadratic => "quadratic",
            Self::Cubic => "cubic",
            Self::QuadraticSmooth => "quadratic-smooth",
            Self::CubicSmooth => "cubic-smooth",
            Self::CatmullRom => "catmull-rom",
        })
    }
}
