//! The closed list of techniques (where samples lie) and modes (what is done with them).

/// Where samples lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Technique {
    /// One ray a pixel in a compute pass.
    #[default]
    Raycast,
    /// Planes parallel to the picture, drawn and blended by the rasterizer.
    Slices3d,
    /// The volume's own slices along the axis that faces the eye most.
    Slices2d,
}

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
}

/// How a value between voxel centres is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// The voxel that the sample lies in.
    Nearest,
    /// Trilinear (bilinear inside a 2D stack).
    #[default]
    Linear,
}
