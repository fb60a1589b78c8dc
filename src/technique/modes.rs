//! Modes: what is done with the samples of a ray, and what follows from it.

use crate::named::named;

/// What is done with the samples of a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Emission and absorption.
    #[default]
    Composite,
    /// Maximum.
    Mip,
    /// Minimum.
    Minip,
    /// Mean, weighted by length.
    Average,
    /// Integral of the value over world length.
    Xray,
    /// First local maximum over a threshold, the maximum where there is none (Sato et al. 1998).
    Lmip,
    /// Maximum of values that what lies before them fades.
    AttenuatedMip,
    /// Surfaces where the volume has one value, or one of several.
    Iso,
    /// Emission and absorption in which a new maximum takes from what lies before it (Bruckner and Groeller 2009).
    Mida,
}

named!(Mode {
    Composite "composite" "Colours and opacities blended from the eye on",
    Mip "mip" "The maximum along each ray (maximum intensity projection)",
    Minip "minip" "The minimum along each ray",
    Average "average" "The mean along each ray",
    Xray "xray" "The integral along each ray, value times world length",
    Lmip "lmip" "The first local maximum over a threshold",
    AttenuatedMip "attenuated-mip" "The maximum of values that fade behind others",
    Iso "iso" "Surfaces where the volume has a value, or several",
    Mida "mida" "Composite in which a new maximum clears what lies before it",
});

/// How two samples become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fold {
    /// Matter lies before matter.
    Material,
    /// The larger one counts.
    Max,
    /// The smaller one counts.
    Min,
    /// Both are added, each times its length.
    Sum,
}

impl Mode {
    /// How two samples become one.
    pub(crate) fn fold(self) -> Fold {
        match self {
            Self::Composite | Self::Mida | Self::Iso => Fold::Material,
            Self::Mip | Self::Lmip | Self::AttenuatedMip => Fold::Max,
            Self::Minip => Fold::Min,
            Self::Average | Self::Xray => Fold::Sum,
        }
    }

    /// The mode of a compute pass, in the names of its shaders: sums are one, which the resolve divides or not.
    pub(super) fn shader_key(self) -> &'static str {
        match self {
            Self::Composite => "composite",
            Self::Mip => "mip",
            Self::Minip => "minip",
            Self::Average | Self::Xray => "sum",
            Self::Lmip => "lmip",
            Self::AttenuatedMip => "attenuated_mip",
            Self::Mida => "mida",
            Self::Iso => "iso",
        }
    }

    /// True where one value a ray is projected and classified once.
    pub fn is_projection(self) -> bool {
        self.fold() != Fold::Material
    }

    /// True where samples must come from front to back, one after the other: blending units cannot do it.
    pub fn needs_rays(self) -> bool {
        matches!(
            self,
            Self::Lmip | Self::AttenuatedMip | Self::Mida | Self::Iso
        )
    }

    /// True where one number a ray is found, before any colour.
    pub fn has_value(self) -> bool {
        self.is_projection() || self == Self::Iso
    }

    /// True where the ray caster finds a place of the ray that stands for the picture.
    pub fn has_depth(self) -> bool {
        self.fold() != Fold::Sum
    }

    /// True where what is projected lies at one place of the ray.
    pub fn projects_one_place(self) -> bool {
        matches!(self.fold(), Fold::Max | Fold::Min)
    }
}
