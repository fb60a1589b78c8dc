//! Splatting of a volume (Westover 1990): every voxel is a Gaussian, of which a ray takes the exact integral.
//!
//! ```text
//! f(x) = sum over voxels of f_i G(x - c_i)        G of covariance h^2 I in voxel space, integral 1
//! ```
//!
//! Sheets cut rays into pieces, as slices of a stack or as slabs that face the eye (Mueller & Crawfis 1998). What a
//! sheet is made of is classified after it is put together (Mueller, Möller & Crawfis 1999) or added up of classified
//! voxels; then optical depths are added and opacities follow, so that alpha is the same whatever the sheets are.

pub mod kernel;
mod line;
mod open_sheets;
pub mod oracle;
mod parts;
pub mod points;
#[doc(hidden)]
pub mod reference;
mod rules;

pub use kernel::MAX_OPEN_SHEETS;
pub use points::{GpuViewPoints, ViewPoints};

use super::gather::{Gather, GatherDesc, RayPass, rays_of};
use super::registry::TechniqueDesc;
use super::stack_axis::stack_axis;
use super::{Mode, SampleInputs, Settings};
use crate::gpu::Error;
use crate::named::named;
use crate::resident::TextureLayout;

/// How rays are cut where splats are put together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sheets {
    /// Slabs parallel to the picture, a step thick: between the planes of a view-aligned slicer.
    #[default]
    Image,
    /// The slices of the stack that faces the eye most. Colours jump where another one does.
    Axis,
    /// Each splat is composited by itself: of voxels that are classified.
    None,
}

named!(Sheets {
    Image "image" "slabs that face the eye, one for each of --samples-per-voxel",
    Axis "axis" "the volume's own slices along the axis that faces the eye most; colours jump where that changes",
    None "none" "each splat by itself, with --preclassified",
});

/// What a splat is. Other techniques do not look at it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splat {
    /// How they are put together.
    pub sheets: Sheets,
    /// Standard deviation, in voxels.
    pub std: f64,
    /// No splat is thinner than so many pixels, as they are at the centre of the box; 0: whatever the pixels are.
    pub low_pass: f64,
    /// Where a splat ends: what it has fallen to, of its peak, is a power of 1/2.
    pub cut_bits: u32,
    /// What is splatted are scattered points, with standard deviations of their own, in place of voxels: no sheets.
    pub of_points: bool,
}

impl Splat {
    /// Of scattered points. On any grid of pixels their sums are those of integrals to 6e-5: so wide they are at least.
    pub fn of_points() -> Self {
        Self {
            low_pass: 0.75,
            of_points: true,
            ..Self::default()
        }
    }
}

impl Default for Splat {
    fn default() -> Self {
        Self {
            sheets: Sheets::default(),
            std: 0.6,
            low_pass: 0.6,
            cut_bits: 20,
            of_points: false,
        }
    }
}

/// Splatting, to those who ask.
pub(super) static DESC: TechniqueDesc = TechniqueDesc {
    casts_rays: true,
    draws_stacks: false,
    splats: true,
    traces_paths: false,
    streams: false,
    // `Settings::check_splats` refuses by name.
    supports: |_| Ok(()),
    has_half_angle: false,
    base_plane: None,
    layouts: &[TextureLayout::Texture3d],
    layout_of: |_| TextureLayout::Texture3d,
    longest_sample_count: |view| view.longest_sample_count(),
    set_slices: |view, _, fields| {
        // Else each ray has slices of its own.
        let is_stack = uses_stack(view.settings);
        fields.slice_axis = if is_stack { stack_axis(view) as u32 } else { 3 };
        0
    },
    gather,
    slice_shaders: None,
};

/// Where sums over splats have none of the order that sheets are for, each is by itself.
fn sheets_of(mode: Mode, sheets: Sheets) -> Sheets {
    match mode {
        Mode::Average | Mode::Xray => Sheets::None,
        _ => sheets,
    }
}

/// Whether its slices are those of a stack, the same for all rays.
fn uses_stack(settings: &Settings) -> bool {
    let is_sum = matches!(settings.mode, Mode::Average | Mode::Xray);
    settings.splat.sheets != Sheets::Image && !is_sum && !settings.splat.of_points
}

fn gather(desc: &GatherDesc) -> Result<Box<dyn Gather>, Error> {
    if desc.settings.splat.of_points {
        return points::gather(desc);
    }
    let (gpu, mode) = (desc.gpu, desc.settings.mode);
    let (holes, transfer) = (desc.variant.holes, desc.variant.transfer);
    let sheets = match sheets_of(mode, desc.settings.splat.sheets) {
        Sheets::Image => "image",
        Sheets::Axis => "axis",
        Sheets::None => "each",
    };
    let pass = if mode.is_projection() {
        let name = format!("splat_projection.{sheets}.{}.{holes}", mode.shader_key());
        RayPass::projection_of(gpu, &name)?
    } else {
        let take = match desc.variant.mix {
            SampleInputs::Colors => "pre",
            _ => "post",
        };
        let transfer = match transfer {
            "points" => "points",
            _ => "table",
        };
        let name = format!("splat.{sheets}.{take}.{holes}.{transfer}");
        RayPass::picture_of(gpu, &name)?
    };
    Ok(rays_of(gpu, pass))
}
