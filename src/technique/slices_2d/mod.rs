//! 2D texture slicing: three stacks of axis-aligned slices, blended in hardware ([`super::Slicer`]).

#[doc(hidden)]
pub mod between;
#[doc(hidden)]
pub mod reference;
mod stack;

pub use super::stack_axis::stack_axis;
pub use between::planes_per_slice;
pub use stack::{set_slices, stack_shares};

use super::gather::slices;
use super::registry::{SliceShaders, TechniqueDesc};
use super::slicer::slicer_supports;
use crate::resident::TextureLayout;

/// 2D texture slicing, to those who ask.
pub(super) static DESC: TechniqueDesc = TechniqueDesc {
    casts_rays: false,
    draws_stacks: true,
    splats: false,
    traces_paths: false,
    streams: false,
    supports: slicer_supports,
    has_half_angle: false,
    base_plane: None,
    layouts: &[
        TextureLayout::Stack(0),
        TextureLayout::Stack(1),
        TextureLayout::Stack(2),
    ],
    layout_of: |view| TextureLayout::Stack(stack_axis(view)),
    longest_sample_count: |view| view.longest_stack(),
    set_slices: |view, part, fields| {
        view.set_between(fields);
        set_slices(view, stack_axis(view), part, fields)
    },
    gather: slices,
    slice_shaders: Some(&SLICE_SHADERS),
};

/// Of the slices of a stack.
pub(super) static SLICE_SHADERS: SliceShaders = SliceShaders {
    cover: "slices_2d_cover",
    // Two triangles cover a rectangle.
    vertices_per_slice: 6,
    fragment: "slices_2d",
    patch_list: "slice_patches.stack",
};
