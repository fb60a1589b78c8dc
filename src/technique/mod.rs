//! The closed list of techniques (where samples lie) and modes (what is done with them).

mod accumulation;
mod alike_cells;
pub mod blend;
mod cell_cubic;
mod clip_rows;
mod compatibility;
#[doc(hidden)]
pub mod composite;
pub(crate) mod cost;
mod error;
#[doc(hidden)]
pub mod faces;
pub mod field;
mod filter_by;
mod frame;
mod frame_of_mode;
#[doc(hidden)]
pub mod full_voxels;
pub(crate) mod gather;
#[doc(hidden)]
pub mod gradient;
mod gradient_filter;
#[doc(hidden)]
pub mod gradient_taps;
mod host_depth_copy;
mod in_pixel;
mod inputs;
#[doc(hidden)]
pub mod isosurface;
pub(crate) mod layers;
mod light_field;
mod light_paths;
mod light_plan;
mod light_volume;
#[doc(hidden)]
pub mod lit_mixture;
mod loop_limit;
mod march;
#[doc(hidden)]
pub mod merge;
#[doc(hidden)]
pub mod mida;
#[doc(hidden)]
pub mod mixture;
mod modes;
mod names;
#[doc(hidden)]
pub mod own_grid;
mod patch_slicer;
mod patches;
pub mod pathtrace;
mod per_mode;
#[doc(hidden)]
pub mod preclassified;
mod projected;
pub mod projection;
mod ray_tiles;
pub mod raycast;
mod recording;
#[doc(hidden)]
pub mod reference;
mod registry;
mod scattered_light;
mod scattering;
mod scattering_rules;
#[doc(hidden)]
pub mod second_derivative;
#[doc(hidden)]
pub mod shading;
pub mod shear_warp;
mod skip;
mod slab;
mod slicer;
pub mod slices_2d;
pub mod slices_3d;
pub mod splat;
mod stack_axis;
mod tone;

pub use accumulation::{ACCUMULATION_FORMAT, accumulation};
#[doc(hidden)]
pub use alike_cells::AlikeCells;
pub(crate) use clip_rows::clip_rows;
pub use error::Error;
pub use filter_by::FilterBy;
pub use frame::View;
pub use gradient_filter::{GradientFilter, GradientSource, GradientStorage, Operator};
pub use in_pixel::InPixel;
pub use inputs::{Inputs, SampleKind, ShaderVariant};
#[doc(hidden)]
pub use light_field::LightField;
pub use light_plan::{AmbientOcclusion, LightPlan, MAX_LIGHT_CELLS, MAX_RADIUS_CELLS, Shadows};
pub use light_volume::LightVolume;
#[doc(hidden)]
pub use loop_limit::Functions;
pub use mixture::{GpuChannel, Role, SampleInputs};
pub(crate) use modes::Fold;
pub use modes::Mode;
pub use patch_slicer::{PatchBindings, PatchSlicer};
pub use patches::{BATCH_SLICES, PatchRoom, Patches};
pub use per_mode::{DEFAULT_ATTENUATION, Level, PerMode};
pub use ray_tiles::{RayBindings, RayTiles};
pub use recording::{Recording, parameter_ring};
pub(crate) use scattered_light::{scattered, shining};
pub use scattering::SingleScattering;
pub use shading::{Light, LightSpace, Shading};
pub use shear_warp::Intermediate;
pub use skip::{Skip, SkipBy, Skippable};
pub use slicer::{DepthAccess, Slicer};

use crate::points::FieldKernel;
use crate::volume::{Spline, kernel::Kernel};

/// The rendering technique.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Technique {
    /// One ray a pixel in a compute pass.
    #[default]
    Raycast,
    /// Planes parallel to the picture, drawn and blended by the rasterizer.
    Slices3d,
    /// The volume's own slices along the axis that faces the eye most.
    Slices2d,
    /// Rays through a plane between these slices, warped to the picture.
    ShearWarp,
    /// Every voxel is a Gaussian, of which rays take the integral.
    Splat,
    /// Random paths of light that scatters in a medium.
    Pathtrace,
}

/// How a value between voxel centres is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// The voxel that the sample lies in.
    Nearest,
    /// Trilinear (bilinear inside a 2D stack).
    #[default]
    Linear,
    /// The quadratic B-spline through the voxels.
    Quadratic,
    /// The cubic B-spline through the voxels.
    Cubic,
    /// The quadratic B-spline with the voxels as its coefficients: no ringing, and blurred.
    QuadraticSmooth,
    /// The cubic B-spline with the voxels as its coefficients: no ringing, and more blurred.
    CubicSmooth,
    /// Catmull and Rom's cubic through the voxels.
    CatmullRom,
}

impl Filter {
    /// The kernel that weights the voxels, where it reaches beyond the nearest two of an axis.
    pub fn kernel(self) -> Option<Kernel> {
        match self {
            Self::Nearest | Self::Linear => None,
            Self::Quadratic | Self::QuadraticSmooth => Some(Kernel::Quadratic),
            Self::Cubic | Self::CubicSmooth => Some(Kernel::Cubic),
            Self::CatmullRom => Some(Kernel::CatmullRom),
        }
    }

    /// The spline whose coefficients it reads in place of voxels: see [`Coefficients`](crate::volume::Coefficients).
    pub fn spline(self) -> Option<Spline> {
        match self {
            Self::Quadratic => Some(Spline::Quadratic),
            Self::Cubic => Some(Spline::Cubic),
            _ => None,
        }
    }
}

/// Which samples a ray caster takes (`sampling.md` 3). Slicers have a lattice of their own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Lattice {
    /// Equal steps from where the ray enters the domain.
    #[default]
    Ray,
    /// Where the ray meets the planes that a view-aligned slicer draws.
    Planes,
    /// Equal steps, of which the first is cut short by a part that depends on the pixel ([`Jitter`]): grain in place
    /// of bands. Ray casting only, and not for surfaces.
    Jitter,
    /// Where the ray meets the heights (j + 1/2) / D of its own main axis, that of its largest slope in voxel space, with
    /// D [`Settings::samples_per_voxel`]: for D = 1 in the voxels of Bresenham's line. Ray casting only.
    Bresenham,
}

/// What moves the patterns of [`Lattice::Jitter`] and of [`Settings::uneven_rays`]: same numbers, same picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Jitter {
    /// Another pattern.
    pub seed: u32,
    /// The number of the picture in a film.
    pub frame: u32,
}

/// In which order a slicer blends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Order {
    /// The over operator.
    #[default]
    BackToFront,
    /// The under operator.
    FrontToBack,
}

/// Keeps the world points with `normal . x >= offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the line above says it")]
pub struct ClipPlane {
    pub normal: glam::DVec3,
    pub offset: f64,
}

impl ClipPlane {
    /// Its unit normal and the offset that belongs to it; a normal of length 0 keeps what it kept.
    pub(crate) fn unit(&self) -> (glam::DVec3, f64) {
        let length = self.normal.length();
        match length > 0.0 {
            true => (self.normal / length, self.offset / length),
            false => (self.normal, self.offset),
        }
    }
}

/// How a cut through the volume looks. It is not lit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CutFaces {
    /// As the transfer functions say, opaque wherever they have any opacity.
    Own,
    /// The greys of a window, its lower end first: opaque wherever the value is over that, as a slice of a scanner
    /// shows it. Of several volumes the first counts, of colours what their opacity is classified by.
    Grey([f64; 2]),
}

/// What to compute. Words of the command line, once checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The rendering technique.
    pub technique: Technique,
    /// What is done with the samples of a ray.
    pub mode: Mode,
    /// How values between voxels are made.
    pub filter: Filter,
    /// What makes them: the device's sampler or the shader.
    pub filter_by: FilterBy,
    /// Which samples the ray caster takes.
    pub lattice: Lattice,
    /// What moves the patterns of [`Lattice::Jitter`] and of uneven rays.
    pub jitter: Jitter,
    /// How slicers blend.
    pub order: Order,
    /// How fine the intermediate image of shear-warp is.
    pub intermediate: Intermediate,
    /// Which of the three stacks 2D slicing draws, and shear-warp casts rays through; `None`: the one that faces the eye most.
    pub stack: Option<usize>,
    /// 2D stacks with slices interpolated between their own, so that samples keep their distance, and a cross-fade
    /// of both stacks ([`slices_2d::stack_shares`]) where the eye changes from one to the other.
    pub smooth: bool,
    /// Composite: what lies between two samples counts, and not only the samples ([`crate::transfer::SlabTable`]).
    pub preintegrated: bool,
    /// Samples per smallest voxel spacing, or per radius of [`Self::field`]; positive. 2D stacks have one a slice, [`Lattice::Bresenham`] so many a voxel
    /// of the main axis.
    pub samples_per_voxel: f64,
    /// Composite by rays: where the transfer function hardly changes over the values of a macro cell, one sample stands
    /// for all of a ray in it. No channel of the picture, premultiplied as it is blended, is farther than this from
    /// that of all samples; over 0, at most 1.
    pub adaptive_steps: Option<f64>,
    /// Rays per pixel is the square of this; at least 1.
    pub rays_per_side: u32,
    /// Several rays go through uneven places of the pixel, others in each pixel, which [`Self::jitter`] moves.
    pub uneven_rays: bool,
    /// The ray ends after the sample at which transmittance falls under this; 0: never.
    pub termination: f32,
    /// Whether samples that cannot matter may be left out. The picture is the same without.
    pub skip: bool,
    /// What says where they are. The picture is the same by each.
    pub empty_space: SkipBy,
    /// In which numbers colours are blended.
    pub color_space: crate::picture::ColorSpace,
    /// What the light of a composite goes through on its way into a host's target ([`crate::embed::Renderer::draw`]). Other
    /// pictures do not look at it: [`crate::picture::Picture::apply_tone`].
    pub tone: crate::picture::Tone,
    /// Voxel space box to keep, min and max; fractions allowed. `None`: all of it.
    pub crop: Option<[glam::DVec3; 2]>,
    /// Half-spaces, of which the intersection is kept. At most [`crate::shaders::MAX_CLIP_PLANES`].
    pub clip_planes: Vec<ClipPlane>,
    /// Composite by rays: what the crop box and the clip planes lay bare is an opaque cross-section.
    pub cut_faces: Option<CutFaces>,
    /// Light on composited samples; `None`: their colour as it is.
    pub shading: Option<Shading>,
    /// How gradients are made, for light and for transfer functions of gradients.
    pub gradient_filter: GradientFilter,
    /// Whether they are made for each sample, or kept at the voxels.
    pub gradient_storage: GradientStorage,
    /// Ambient light that matter nearby takes away, with lights or without, of what is composited.
    pub ambient_occlusion: Option<AmbientOcclusion>,
    /// Float targets, no early termination, filtering by texel fetch, control points searched exactly.
    pub conformance: bool,
    /// What single modes want to know.
    pub per_mode: PerMode,
    /// What is left of the extinction and of the colour of a dimmed label ([`crate::volume::labels::dim`]), 0 to 1.
    pub dim: f64,
    /// What splats are.
    pub splat: splat::Splat,
    /// Scattered points are cast by rays, and this is their field. Ray casting only.
    pub field: Option<FieldKernel>,
    /// What paths are, and the medium, the lights and the sky of [`Self::single_scattering`].
    pub path: pathtrace::PathTracing,
    /// Composite by rays: matter scatters light once on its way to the eye, and does not shine in its colours, which are
    /// albedos.
    pub single_scattering: Option<SingleScattering>,
}

/// Faint, and still seen.
pub const DEFAULT_DIM: f64 = 0.2;

/// Samples that one ray may take: no wish of a host makes a shader run without end.
pub const MAX_SAMPLES_PER_RAY: u32 = 1 << 20;

impl Settings {
    /// Which samples rays take: of shear-warp those on planes, which are slices of the volume.
    pub(crate) fn ray_lattice(&self) -> Lattice {
        match self.technique.is_warped() {
            true => Lattice::Planes,
            false => self.lattice,
        }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            technique: Technique::default(),
            mode: Mode::default(),
            filter: Filter::default(),
            filter_by: FilterBy::default(),
            lattice: Lattice::default(),
            jitter: Jitter::default(),
            order: Order::default(),
            intermediate: Intermediate::default(),
            stack: None,
            smooth: false,
            preintegrated: false,
            samples_per_voxel: 1.0,
            adaptive_steps: None,
            rays_per_side: 1,
            uneven_rays: false,
            termination: 0.0,
            skip: true,
            empty_space: SkipBy::default(),
            color_space: crate::picture::ColorSpace::default(),
            tone: crate::picture::Tone::default(),
            crop: None,
            clip_planes: Vec::new(),
            cut_faces: None,
            shading: None,
            gradient_filter: GradientFilter::default(),
            gradient_storage: GradientStorage::default(),
            ambient_occlusion: None,
            conformance: false,
            per_mode: PerMode::default(),
            dim: DEFAULT_DIM,
            splat: splat::Splat::default(),
            field: None,
            path: pathtrace::PathTracing::default(),
            single_scattering: None,
        }
    }
}
