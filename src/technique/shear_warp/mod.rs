//! Shear-warp: rays through the points of a base plane between the slices of the volume, then a warp of what they leave
//! to the picture.
//!
//! ```text
//! I(U, V)    what a ray through base pixel (U, V) gathers, with samples on the slices
//! picture    bilinear mean of the four I around where a pixel's ray meets the base plane
//! ```
//!
//! The base plane is a camera ([`base_plane`]): its rays are those of the ray caster, on the lattice of planes with the slices as
//! planes. Lacroute and Levoy, SIGGRAPH 1994, without their classification before interpolation and their 8 bits.

mod base_plane;
mod gather;
mod on_plane;
#[doc(hidden)]
pub mod reference;

pub(crate) use base_plane::intermediate_room;
pub use base_plane::{BasePlane, base_plane};

use super::registry::TechniqueDesc;
use super::stack_axis::stack_axis;
use super::{Error, Lattice, Settings};
use crate::resident::TextureLayout;

/// How fine an intermediate image is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Intermediate {
    /// So many base pixels a voxel; positive.
    PerVoxel(f64),
    /// As fine as the picture, where that is finest.
    Pixels,
}

impl Default for Intermediate {
    fn default() -> Self {
        Self::PerVoxel(1.0)
    }
}

/// Shear-warp, to those who ask.
pub(super) static DESC: TechniqueDesc = TechniqueDesc {
    casts_rays: true,
    draws_stacks: false,
    splats: false,
    traces_paths: false,
    streams: false,
    supports,
    has_half_angle: false,
    base_plane: Some(base_plane),
    layouts: &[TextureLayout::Texture3d],
    layout_of: |_| TextureLayout::Texture3d,
    longest_sample_count: |view| view.longest_sample_count(),
    set_slices: |view, _, fields| {
        fields.slice_axis = stack_axis(view) as u32;
        0
    },
    gather: gather::shear_warp,
    slice_shaders: None,
};

fn supports(settings: &Settings) -> Result<(), Error> {
    let mode = settings.mode;
    if mode.needs_rays() {
        return Err(Error::NotFor {
            wanted: "shear-warp",
            of: "composite, mip, minip, average and xray",
            found: format!("mode {mode}"),
        });
    }
    let per_mode = &settings.per_mode;
    let refused = [
        (settings.lattice != Lattice::Ray, "a lattice of rays"),
        (
            settings.uneven_rays,
            "rays at uneven places of their pixels",
        ),
        (settings.cut_faces.is_some(), "an opaque cut face"),
        (
            settings.adaptive_steps.is_some(),
            "sampling by adaptive steps",
        ),
        (per_mode.exact_maximum, "the exact extreme of a field"),
        (per_mode.depth_cue != 0.0, "a depth cue"),
    ];
    if let Some((_, wanted)) = refused.into_iter().find(|(is_wanted, _)| *is_wanted) {
        return Err(Error::NotFor {
            wanted,
            of: "ray casting",
            found: "shear-warp, whose pixels are means of four rays".into(),
        });
    }
    let Intermediate::PerVoxel(per_voxel) = settings.intermediate else {
        return Ok(());
    };
    let is_fine = per_voxel > 0.0 && per_voxel.is_finite();
    Error::unless(
        is_fine,
        "the number of base pixels per voxel",
        "a number over 0",
        per_voxel,
    )
}
