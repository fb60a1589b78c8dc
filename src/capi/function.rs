//! Transfer functions: value to colour and opacity.

use super::device::sv_device;
use super::handles::{self, Kind};
use super::settings::share;
use super::status::{Failure, guard, number, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use crate::technique::Mode;
use crate::transfer::{
    Classified, ColorPoint, Interpolation, MediumPoint, OpacityPoint, TransferFunction, Window,
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

/// What matter does to light at a value, for SV_TECHNIQUE_PATHTRACE.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_medium_point {
    /// After rescale.
    pub value: f64,
    /// Linear numbers of red, green and blue, none under 0.
    pub linear: [f64; 3],
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
    /// 0.
    pub reserved: u32,
    /// Extinction per world length in place of opacities, which are none then: what scatters no light takes the opacity that
    /// it has over `reference_length`, 0 there being the length behind which half of the light is left in the densest matter.
    /// None: that of `opacities`.
    pub extinctions: *const sv_medium_point,
    /// How many there are, at most 4096.
    pub extinction_count: u64,
    /// The part of light that is scattered and not absorbed, 0 to 1. None: the colours in linear light.
    pub albedos: *const sv_medium_point,
    /// How many there are, at most 4096.
    pub albedo_count: u64,
    /// Light that matter sends out, radiance per world length. None: it sends out none.
    pub emissions: *const sv_medium_point,
    /// How many there are, at most 4096.
    pub emission_count: u64,
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
    let (desc, colors, opacities, [extinctions, albedos, emissions]) = unsafe {
        let desc = structure::read(desc)?;
        let (colors, opacities) = (
            "sv_transfer_function_desc.colors",
            "sv_transfer_function_desc.opacities",
        );
        let colors = structure::array(colors, desc.colors, desc.color_count, MOST_POINTS)?;
        let count = desc.opacity_count;
        let opacities = structure::array(opacities, desc.opacities, count, MOST_POINTS)?;
        (desc, colors, opacities, medium(&desc)?)
    };
    if !extinctions.is_empty() && !opacities.is_empty() {
        return Err(Failure::argument(
            "sv_transfer_function_desc: wanted extinctions or opacities, found both",
        ));
    }
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
    let function = TransferFunction {
        color: color.collect(),
        opacity: opacity.collect(),
        reference_length: (length > 0.0).then_some(length),
        interpolation: match desc.is_stepped {
            0 => Interpolation::Linear,
            _ => Interpolation::Step,
        },
        gradient_transfer: None,
        medium: None,
    };
    let mut function = match extinctions.is_empty() {
        true => function,
        false => function.with_extinction(extinctions),
    };
    if !albedos.is_empty() || !emissions.is_empty() {
        let medium = function.medium.get_or_insert_default();
        (medium.albedo, medium.emission) = (albedos, emissions);
    }
    Ok(function)
}

/// Extinctions, albedos and emissions.
///
/// # Safety
/// The arrays are as long as they say.
unsafe fn medium(desc: &sv_transfer_function_desc) -> Result<[Vec<MediumPoint>; 3], Failure> {
    let lists = [
        ("extinctions", desc.extinctions, desc.extinction_count),
        ("albedos", desc.albedos, desc.albedo_count),
        ("emissions", desc.emissions, desc.emission_count),
    ];
    let mut made = [const { Vec::new() }; 3];
    for (made, (list, points, count)) in made.iter_mut().zip(lists) {
        let name = format!("sv_transfer_function_desc.{list}");
        // SAFETY: the caller's promise.
        let points = unsafe { structure::array(&name, points, count, MOST_POINTS)? };
        rising("sv_medium_point.value", points.iter().map(|p| p.value))?;
        for amount in points.iter().flat_map(|point| point.linear) {
            match list {
                "albedos" => share("sv_medium_point.linear", amount)?,
                _ => number(
                    "sv_medium_point.linear",
                    "0 or more",
                    amount,
                    amount >= 0.0 && amount.is_finite(),
                )?,
            }
        }
        made.extend(points.iter().map(|point| MediumPoint {
            value: point.value,
            linear: point.linear,
        }));
    }
    Ok(made)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matter_is_taken_in_as_files_have_it() {
        let points = [[0.0; 3], [1.0, 0.5, 0.25]].map(|linear| sv_medium_point {
            value: linear[0],
            linear,
        });
        let desc = sv_transfer_function_desc {
            struct_size: size_of::<sv_transfer_function_desc>() as u32,
            next: std::ptr::null(),
            colors: std::ptr::null(),
            color_count: 0,
            opacities: std::ptr::null(),
            opacity_count: 0,
            reference_length: 0.0,
            is_stepped: 0,
            reserved: 0,
            extinctions: points.as_ptr(),
            extinction_count: 2,
            albedos: points.as_ptr(),
            albedo_count: 2,
            emissions: points.as_ptr(),
            emission_count: 1,
        };
        // SAFETY: the arrays are as long as they say.
        let function = unsafe { made(&desc) }.map_err(|_| ()).expect("a function");
        let wanted = points.map(|point| MediumPoint {
            value: point.value,
            linear: point.linear,
        });
        let medium = function.medium.as_deref().expect("a medium");
        assert_eq!(medium.extinction, wanted);
        assert_eq!(medium.albedo, wanted);
        assert_eq!(medium.emission, wanted[..1]);
        // Half of the light is left over the reference length in the densest matter, by the mean of its colours.
        let last = function.opacity.last().expect("points").opacity;
        assert!((last - 0.5).abs() < 1e-12, "{last}");
        let plain = sv_transfer_function_desc {
            extinction_count: 0,
            albedo_count: 0,
            emission_count: 0,
            ..desc
        };
        // SAFETY: as before.
        let function = unsafe { made(&plain) }.map_err(|_| ()).expect("a function");
        assert_eq!(function.medium, None);
    }
}
