//! The closed list of techniques: what each says of itself, and what all others ask in place of its name.

use super::gather::{Gather, GatherDesc};
use super::reference::{Gathered, Samples};
use super::shear_warp::BasePlane;
use super::{
    Error, Settings, Technique, View, pathtrace, projection, raycast, shear_warp, slices_2d,
    slices_3d, splat,
};
use crate::gpu;
use crate::named::named;
use crate::real::Real;
use crate::resident::TextureLayout;
use crate::shaders::FrameFields;
use glam::DVec3;

named!(Technique {
    Raycast "raycast" "",
    Slices3d "slices-3d" "",
    Slices2d "slices-2d" "",
    ShearWarp "shear-warp" "",
    Splat "splat" "",
    Pathtrace "pathtrace" "",
});

/// The base plane of a view.
type BasePlaneOf = fn(&View) -> Result<BasePlane, Error>;

/// What a technique says of itself.
#[derive(Debug)]
pub(crate) struct TechniqueDesc {
    /// One invocation takes the samples of a pixel from front to back. `false`: the rasterizer draws slices and blends
    /// them.
    pub casts_rays: bool,
    /// The slices are those of the volume's own grid: one sample a slice, whatever the step is.
    pub draws_stacks: bool,
    /// Rays take integrals of Gaussians, and no samples.
    pub splats: bool,
    /// Each pixel is the mean of random paths, of which pictures of parts add up to that of all.
    pub traces_paths: bool,
    /// A volume may come brick by brick from its file.
    pub streams: bool,
    /// Refuses what it has no passes for.
    pub supports: fn(&Settings) -> Result<(), Error>,
    /// Its slices may lie half way between the eye and a light.
    pub has_half_angle: bool,
    /// The plane whose points its rays go through, where they are not the pixels of the picture.
    pub base_plane: Option<BasePlaneOf>,
    /// How a volume lies in textures so that it can be seen from everywhere.
    pub layouts: &'static [TextureLayout],
    /// Which of these a view reads.
    pub layout_of: fn(&View) -> TextureLayout,
    /// How many samples a pixel takes at most.
    pub longest_sample_count: fn(&View) -> f64,
    /// Fills in the slices of a part of the grid ([`View::part`]) and returns how many to draw.
    pub set_slices: fn(&View, [DVec3; 2], &mut FrameFields) -> u32,
    /// The passes in which it makes a picture.
    pub gather: fn(&GatherDesc) -> Result<Box<dyn Gather>, gpu::Error>,
    /// What draws its slices; `None`: rays draw none.
    pub slice_shaders: Option<&'static SliceShaders>,
}

/// The shaders that draw slices, by name.
#[derive(Debug)]
pub(crate) struct SliceShaders {
    /// Covers a slice with triangles.
    pub cover: &'static str,
    /// How many vertices that takes.
    pub vertices_per_slice: u32,
    /// Takes the sample of a pixel.
    pub fragment: &'static str,
    /// Lists the patches of slices that are not empty.
    pub patch_list: &'static str,
}

impl Technique {
    /// What it says of itself.
    pub(crate) fn desc(self) -> &'static TechniqueDesc {
        match self {
            Self::Raycast => &raycast::DESC,
            Self::Slices3d => &slices_3d::DESC,
            Self::Slices2d => &slices_2d::DESC,
            Self::ShearWarp => &shear_warp::DESC,
            Self::Splat => &splat::DESC,
            Self::Pathtrace => &pathtrace::DESC,
        }
    }

    /// What draws its slices; of rays, whose slices nobody asks for, those of a stack.
    pub(super) fn slice_shaders(self) -> &'static SliceShaders {
        self.desc()
            .slice_shaders
            .unwrap_or(&slices_2d::SLICE_SHADERS)
    }

    /// [`TechniqueDesc::casts_rays`].
    pub(crate) fn casts_rays(self) -> bool {
        self.desc().casts_rays
    }

    /// [`TechniqueDesc::draws_stacks`].
    pub(crate) fn draws_stacks(self) -> bool {
        self.desc().draws_stacks
    }

    /// [`TechniqueDesc::splats`].
    pub(crate) fn splats(self) -> bool {
        self.desc().splats
    }

    /// [`TechniqueDesc::traces_paths`].
    pub(crate) fn traces_paths(self) -> bool {
        self.desc().traces_paths
    }

    /// [`TechniqueDesc::streams`].
    pub(crate) fn streams(self) -> bool {
        self.desc().streams
    }

    /// Whether its pixels are means of what several rays have gathered ([`TechniqueDesc::base_plane`]).
    pub(crate) fn is_warped(self) -> bool {
        self.desc().base_plane.is_some()
    }

    /// Whether a pixel has a ray of its own, with a place where it ends.
    pub(crate) fn has_depth(self) -> bool {
        self.casts_rays() && !self.is_warped() && !self.traces_paths()
    }

    /// What its CPU reference gathers for one pixel, of all modes but surfaces.
    #[doc(hidden)]
    pub fn pixel<R: Real>(self, of: &impl Samples<R>, pixel: [R; 2]) -> Gathered<R> {
        match self {
            Self::Raycast if of.settings().mode.is_projection() => {
                projection::reference::pixel(of, pixel)
            }
            Self::Raycast => raycast::reference::pixel(of, pixel),
            Self::Slices3d => slices_3d::reference::pixel(of, pixel),
            Self::Slices2d => slices_2d::reference::pixel(of, pixel),
            Self::ShearWarp => {
                shear_warp::reference::pixel(of, pixel, |base| Self::Raycast.pixel(of, base))
            }
            Self::Splat => splat::reference::pixel(of, pixel),
            Self::Pathtrace => pathtrace::reference::pixel(of, pixel),
        }
    }
}
