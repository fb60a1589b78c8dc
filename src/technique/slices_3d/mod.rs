//! View-aligned slicing: planes parallel to the picture, cut in the vertex shader, blended in hardware
//! ([`super::Slicer`]). With shadows, planes half way between the picture and the light ([`HalfAngleSlicer`]).

#[doc(hidden)]
pub mod cover;
pub mod half_angle;
mod planes;
#[doc(hidden)]
pub mod reference;

pub use half_angle::HalfAngleSlicer;
pub use planes::set_planes;

use super::blend::Drawn;
use super::gather::slices;
use super::registry::{SliceShaders, TechniqueDesc};
use super::slicer::slicer_supports;
use crate::resident::TextureLayout;

/// View-aligned slicing, to those who ask.
pub(super) static DESC: TechniqueDesc = TechniqueDesc {
    casts_rays: false,
    draws_stacks: false,
    splats: false,
    traces_paths: false,
    streams: false,
    supports: slicer_supports,
    has_half_angle: true,
    base_plane: None,
    layouts: &[TextureLayout::Texture3d],
    layout_of: |_| TextureLayout::Texture3d,
    longest_sample_count: |view| view.longest_sample_count(),
    set_slices: set_planes,
    gather: |desc| match desc.settings.is_half_angle() && desc.drawn != Drawn::Count {
        true => half_angle::half_angle_slices(desc),
        false => slices(desc),
    },
    slice_shaders: Some(&SliceShaders {
        cover: "slices_3d_cover",
        // Four triangles cover the six corners of a plane in a box.
        vertices_per_slice: 12,
        fragment: "slices_3d",
        patch_list: "slice_patches.view",
    }),
};
