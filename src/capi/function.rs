//! Transfer functions: value to colour and opacity.

use super::device::sv_device;
use super::handles::{self, Kind};
use super::settings::share;
use super::status::{Failure, guard, number, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use crate::technique::Mode;
use crate::transfer::{
    Classified, ColorPoint, Interpolation, OpacityPoint, TransferFunction, Window,
};
use std::ffi::c_void;
use std::sync::Arc;

/// A transfer function. 0 is a ramp of greys over the volume's range.
pub type sv_transfer_function = u64;

/// Colour at a value.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_color_point {
    /// After rescale.
    pub value: f64,
    /// sRGB numbers from 0 to 1.
    pub srgb: [f64; 3],
}

/// Opacity at a value.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_opacity_point {
    /// After rescale.
    pub value: f64,
    /// Per reference length, 0 to 1.
    pub opacity: f64,
}

/// A transfer function by control points in order of their values, constant beyond the ends.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_transfer_function_desc {
    /// `sizeof(sv_transfer_function_desc)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// None: black.
    pub colors: *const sv_color_point,
    /// How many there are, at most 4096.
    pub color_count: u64,
    /// None: transparent.
    pub opacities: *const sv_opacity_point,
    /// How many there are, at most 4096.
    pub opacity_count: u64,
    /// The world length that opacities are for. 0: the smallest voxel spacing.
    pub reference_length: f64,
    /// Not 0: from one point to the next the value of the first holds. Else it goes straight.
    pub is_stepped: u32,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_transfer_function_desc {
    const NAME: &'static str = "sv_transfer_function_desc";
}

/// Renderers copy it.
pub(super) struct Held(TransferFunction);

impl Kind for Held {
    const NUMBER: u64 = 3;
    const NAME: &'static str = "sv_transfer_function";
}

/// As many as a file may have.
const MOST_POINTS: u64 = 4096;

/// The function of a handle of this device; 0 is the grey ramp, or nothing where surfaces need none.
pub(super) fn function(
    device: &super::device::Device,
    handle: sv_transfer_function,
    mode: Mode,
    range: [f64; 2],
) -> Result<Option<TransferFunction>, Failure> {
    if handle != 0 {
        let held = handles::find_on::<Held>(device, handle)?;
        return Ok(Some(Held::clone_of(&held)));
    }
    let classified = match mode.is_projection() {
        true => Classified::Projection,
        false => Classified::Samples,
    };
    Ok((mode != Mode::Iso).then(|| Window::of_range(range).grey(classified)))
}

impl Held {
    fn clone_of(held: &Arc<Self>) -> TransferFunction {
        held.0.clone()
    }
}

/// Takes control points in. Nothing of it lies on the device. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_transfer_function_create(
    device: sv_device,
    desc: *const sv_transfer_function_desc,
    function: *mut sv_transfer_function,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the sv_transfer_function", function)?;
        let device = handles::device(device)?;
        // SAFETY: the caller's promise.
        let made = unsafe { made(desc)? };
        let handle = handles::add(&device, Held(made))?;
        // SAFETY: not NULL; the caller's promise.
        unsafe { function.write(handle) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Destroys it. Renderers that were made with it have a copy. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_transfer_function_destroy(
    function: sv_transfer_function,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || handles::remove::<Held>(function).map(drop);
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// # Safety
/// As [`structure::read`], and the arrays are as long as they say.
unsafe fn made(desc: *const sv_transfer_function_desc) -> Result<TransferFunction, Failure> {
    // SAFETY: the caller's promise.
    let (desc, colors, opacities) = unsafe {
        let desc = structure::read(desc)?;
        let (colors, opacities) = (
            "sv_transfer_function_desc.colors",
            "sv_transfer_function_desc.opacities",
        );
        let colors = structure::array(colors, desc.colors, desc.color_count, MOST_POINTS)?;
        let count = desc.opacity_count;
        let opacities = structure::array(opacities, desc.opacities, count, MOST_POINTS)?;
        (desc, colors, opacities)
    };
    rising("sv_color_point.value", colors.iter().map(|p| p.value))?;
    rising("sv_opacity_point.value", opacities.iter().map(|p| p.value))?;
    for channel in colors.iter().flat_map(|point| point.srgb) {
        share("sv_color_point.srgb", channel)?;
    }
    for point in opacities {
        share("sv_opacity_point.opacity", point.opacity)?;
    }
    let length = desc.reference_length;
    let is_length = length >= 0.0 && length.is_finite();
    let wanted = "a length, or 0";
    number(
        "sv_transfer_function_desc.reference_length",
        wanted,
        length,
        is_length,
    )?;
    let color = colors.iter().map(|point| ColorPoint {
        value: point.value,
        srgb: point.srgb,
    });
    let opacity = opacities.iter().map(|point| OpacityPoint {
        value: point.value,
        opacity: point.opacity,
    });
    Ok(TransferFunction {
        color: color.collect(),
        opacity: opacity.collect(),
        reference_length: (length > 0.0).then_some(length),
        interpolation: match desc.is_stepped {
            0 => Interpolation::Linear,
            _ => Interpolation::Step,
        },
        gradient_transfer: None,
        medium: None,
    })
}

fn rising(name: &str, values: impl Iterator<Item = f64>) -> Result<(), Failure> {
    let mut last = f64::NEG_INFINITY;
    for value in values {
        let wanted = "finite numbers, none under the one before";
        number(name, wanted, value, value.is_finite() && value >= last)?;
        last = value;
    }
    Ok(())
}
