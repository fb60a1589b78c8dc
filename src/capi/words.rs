//! Numbers of C for words of the library. Structures hold them as `uint32_t`: any number may stand there.

use super::status::Failure;
use crate::picture::ToneCurve;
use crate::technique::SingleScattering;
use crate::volume::VoxelType;

/// The rendering technique.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_technique {
    /// One ray a pixel, in a compute pass.
    SV_TECHNIQUE_RAYCAST = 0,
    /// Planes parallel to the picture, drawn and blended.
    SV_TECHNIQUE_SLICES_3D = 1,
    /// The volume's own slices along the axis that faces the eye most.
    SV_TECHNIQUE_SLICES_2D = 2,
    /// Rays through a plane between these slices, warped to the picture. No depth.
    SV_TECHNIQUE_SHEAR_WARP = 3,
    /// Every voxel is a Gaussian, of which rays take the integral.
    SV_TECHNIQUE_SPLAT = 4,
    /// Random paths of light that scatters: each frame has more of them.
    SV_TECHNIQUE_PATHTRACE = 5,
}

/// What is done with the samples of a ray.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_mode {
    /// Emission and absorption.
    SV_MODE_COMPOSITE = 0,
    /// Maximum.
    SV_MODE_MIP = 1,
    /// Minimum.
    SV_MODE_MINIP = 2,
    /// Mean, weighted by length.
    SV_MODE_AVERAGE = 3,
    /// Integral of the value over world length.
    SV_MODE_XRAY = 4,
    /// First local maximum over a threshold, the maximum where there is none. Rays only.
    SV_MODE_LMIP = 5,
    /// Maximum of values that what lies before them fades. Rays only.
    SV_MODE_ATTENUATED_MIP = 6,
    /// Surfaces where the volume has the values of `levels`. Rays only.
    SV_MODE_ISO = 7,
    /// Emission and absorption in which a new maximum takes from what lies before it. Rays only.
    SV_MODE_MIDA = 8,
}

/// How light comes to matter that scatters it once on its way to the eye.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_scattering {
    /// It scatters none: matter shines in its colours.
    SV_SCATTERING_NONE = 0,
    /// Lights are followed from each sample on.
    SV_SCATTERING_MARCH = 1,
    /// Nothing is in the way of lights.
    SV_SCATTERING_OPEN = 2,
}

/// What is done with light near white and over it.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_tone {
    /// Light over 1 is cut off by targets that do not hold it.
    SV_TONE_NONE = 0,
    /// Colours stay, and bright ones fade to white (Khronos PBR neutral).
    SV_TONE_NEUTRAL = 1,
    /// Soft in the dark and in the light (Hable 2010).
    SV_TONE_FILMIC = 2,
}

/// How a value between voxel centres is made.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_filter {
    /// Trilinear (bilinear in a 2D stack).
    SV_FILTER_LINEAR = 0,
    /// The voxel that the sample lies in.
    SV_FILTER_NEAREST = 1,
    /// The quadratic B-spline through the voxels.
    SV_FILTER_QUADRATIC = 2,
    /// The cubic B-spline through the voxels.
    SV_FILTER_CUBIC = 3,
    /// The quadratic B-spline with voxels as coefficients, which blurs.
    SV_FILTER_QUADRATIC_SMOOTH = 4,
    /// The cubic B-spline with voxels as coefficients, which blurs more.
    SV_FILTER_CUBIC_SMOOTH = 5,
    /// Catmull and Rom's cubic through the voxels.
    SV_FILTER_CATMULL_ROM = 6,
}

/// Which samples rays take.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_lattice {
    /// Equal steps from where the ray enters the volume.
    SV_LATTICE_RAY = 0,
    /// Where the ray meets the planes that SV_TECHNIQUE_SLICES_3D draws.
    SV_LATTICE_PLANES = 1,
    /// Equal steps after a first one that depends on the pixel: grain in place of bands.
    SV_LATTICE_JITTER = 2,
    /// Where the ray meets the heights (j + 1/2) / samples_per_voxel of its own main axis, in voxels.
    SV_LATTICE_BRESENHAM = 3,
}

/// In which numbers colours are blended.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_color_space {
    /// Linear light: for targets of floats and of `SRGB` formats.
    SV_COLOR_SPACE_LINEAR = 0,
    /// sRGB numbers as they are: for `UNORM` targets that are shown as they are.
    SV_COLOR_SPACE_DISPLAY = 1,
}

/// The type of stored voxels.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_voxel_type {
    /// 8 bits, unsigned.
    SV_VOXEL_U8 = 0,
    /// 8 bits, signed.
    SV_VOXEL_I8 = 1,
    /// 16 bits, unsigned.
    SV_VOXEL_U16 = 2,
    /// 16 bits, signed.
    SV_VOXEL_I16 = 3,
    /// 32 bits, unsigned. Kept as F32.
    SV_VOXEL_U32 = 4,
    /// 32 bits, signed. Kept as F32.
    SV_VOXEL_I32 = 5,
    /// Half precision.
    SV_VOXEL_F16 = 6,
    /// Single precision.
    SV_VOXEL_F32 = 7,
    /// Double precision. Kept as F32.
    SV_VOXEL_F64 = 8,
}

/// What a camera is made of.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_camera_kind {
    /// All of the volume from the front, in perspective.
    SV_CAMERA_FITTED = 0,
    /// `eye`, `target` and `up`.
    SV_CAMERA_LOOK_AT = 1,
    /// `view_from_world` and `clip_from_view`.
    SV_CAMERA_MATRICES = 2,
}

/// The version of this interface.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_version {
    /// Of this header: compare it with sv_abi_version.
    SV_ABI_VERSION = 1,
}

pub(super) const VOXEL_TYPES: [VoxelType; 9] = [
    VoxelType::U8,
    VoxelType::I8,
    VoxelType::U16,
    VoxelType::I16,
    VoxelType::U32,
    VoxelType::I32,
    VoxelType::F16,
    VoxelType::F32,
    VoxelType::F64,
];

/// Light through a coarse grid is not followed in a host's frames.
pub(super) const SCATTERINGS: [Option<SingleScattering>; 3] = [
    None,
    Some(SingleScattering::March),
    Some(SingleScattering::Open),
];

pub(super) const TONES: [ToneCurve; 3] = [ToneCurve::None, ToneCurve::Neutral, ToneCurve::Filmic];

/// The word of a number.
pub(super) fn word<T: Copy>(name: &str, words: &[T], number: u32) -> Result<T, Failure> {
    words.get(number as usize).copied().ok_or_else(|| {
        let last = words.len() - 1;
        Failure::argument(format!("{name}: wanted 0 to {last}, found {number}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::ColorSpace;
    use crate::named::Named;
    use crate::technique::{Filter, Lattice, Mode, Technique};

    #[test]
    fn a_number_of_c_is_the_value_of_the_same_name() {
        let source = include_str!("words.rs");
        fn is_named<T: Named>(source: &str, prefix: &str) {
            let rows = source.matches(&format!("\n    {prefix}_")).count();
            assert_eq!(rows, T::ALL.len(), "{prefix}");
            for (number, value) in T::ALL.iter().enumerate() {
                let name = value.name().replace('-', "_").to_uppercase();
                let row = format!("    {prefix}_{name} = {number},\n");
                assert!(source.contains(&row), "{row}");
            }
        }
        is_named::<Technique>(source, "SV_TECHNIQUE");
        is_named::<Mode>(source, "SV_MODE");
        is_named::<Filter>(source, "SV_FILTER");
        is_named::<Lattice>(source, "SV_LATTICE");
        is_named::<ColorSpace>(source, "SV_COLOR_SPACE");
        use sv_voxel_type::*;
        assert_eq!(VOXEL_TYPES[SV_VOXEL_F64 as usize], VoxelType::F64);
        assert_eq!(VOXEL_TYPES[SV_VOXEL_I16 as usize], VoxelType::I16);
        assert_eq!(TONES[sv_tone::SV_TONE_FILMIC as usize], ToneCurve::Filmic);
    }

    #[test]
    fn zero_is_what_the_library_takes_by_default() {
        let zero = (
            Technique::ALL[0],
            Mode::ALL[0],
            Filter::ALL[0],
            Lattice::ALL[0],
            ColorSpace::ALL[0],
        );
        assert_eq!(zero, Default::default());
    }
}
