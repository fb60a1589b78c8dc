//! Words and marks over a picture of the host's: a bar of colours, a scale, arrows, a title.

use super::camera::{camera, sv_camera};
use super::device::{Device, sv_device};
use super::function::{function, sv_transfer_function};
use super::handles;
use super::settings::{finite, settings, sv_settings};
use super::status::{Failure, guard, number, reserved, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use super::volume::affine;
use crate::annotate::{Annotation, Error, Facts, GeometryLegend, Marks, Seen};
use crate::picture::{ColorSpace, Picture};
use crate::scene::Beside;
use crate::volume::Grid;
use std::ffi::{CStr, c_char, c_void};

/// What is drawn over a picture, and what is known of the volume in it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_overlay_desc {
    /// `sizeof(sv_overlay_desc)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// Pixels across: 1 to 16384.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Who looks, as in sv_frame_info.
    pub camera: *const sv_camera,
    /// Which marks, as `--annotate` of the program has them: "bar,scale,title=Storm". NULL: "bar,time,orientation,scale".
    pub marks: *const c_char,
    /// How many voxels there are along x, y and z: 1 or more of each.
    pub dims: [u32; 3],
    /// Not 0: x of the world points right, y to the front and z to the head of a patient.
    pub is_patient: u32,
    /// As in sv_volume_desc. All zero: voxel space is the world.
    pub world_from_voxel: [f64; 16],
    /// Whose colours the bar has. 0: there is no bar.
    pub function: sv_transfer_function,
    /// What was computed, or NULL, as in sv_renderer_desc: a bar is as opaque as its mode makes values.
    pub settings: *const sv_settings,
    /// What the values are, or NULL. These four are UTF-8; letters that cannot be drawn are boxes.
    pub caption: *const c_char,
    /// Their unit, or NULL.
    pub unit: *const c_char,
    /// The moment, or NULL: "2005-08-28T12:00:00" is written as a date.
    pub time: *const c_char,
    /// Where the volume is from, or NULL.
    pub source: *const c_char,
    /// Not 0: x of the world points east, y north and z up.
    pub is_earth: u32,
    /// Not 0: the values along the bar are spread by their logarithms.
    pub is_logarithmic: u32,
    /// Metres of a unit of the world. 0: not known, and there is no unit at the scale.
    pub length_metres: f64,
    /// How much higher than it is the volume is drawn. 0 is 1.
    pub height_factor: f64,
    /// Pixels of an em. 0: a fortieth of the height, 11 at least.
    pub text_pixels: f64,
    /// What lies under the marks, which are light or dark by it: four numbers a pixel, linear light times opacity, rows from
    /// the top. NULL: black. It is read before the call returns.
    pub under: *const f32,
    /// How many numbers there are.
    pub under_count: u64,
    /// Not 0: the marks have this colour.
    pub has_color: u32,
    /// 0.
    pub reserved: u32,
    /// sRGB, 0 to 1.
    pub color: [f64; 3],
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_overlay_desc {
    const NAME: &'static str = "sv_overlay_desc";
}

/// Larger pictures are not annotated.
const MOST_PIXELS: u32 = 16384;

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::argument(format!("sv_overlay_desc: {error}"))
    }
}

/// Draws words and marks as pixels of their own: linear light times opacity, four numbers each, rows from the top, to be laid over
/// the picture (`over + (1 - opacity) under`). `count` numbers have room at `pixels`: 4 times width times height.
/// Edges of a box that lie behind the volume are left out. Nothing is done on the device. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_overlay_rgba(
    device: sv_device,
    desc: *const sv_overlay_desc,
    pixels: *mut f32,
    count: u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the pixels", pixels)?;
        let device = handles::device(device)?;
        // SAFETY: the caller's promise.
        let made = unsafe { drawn(&device, &structure::read(desc)?, count)? };
        let numbers = made.as_flattened();
        // SAFETY: the caller's promise: there is room for `count` numbers, which are as many.
        unsafe { pixels.copy_from_nonoverlapping(numbers.as_ptr(), numbers.len()) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Words of a caller's; `None` for NULL.
///
/// # Safety
/// `pointer` is NULL, or what it points to ends with a zero, lives and does not change for `'a`.
unsafe fn text<'a>(name: &str, pointer: *const c_char) -> Result<Option<&'a str>, Failure> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise.
    let words = unsafe { CStr::from_ptr(pointer) }.to_str();
    let wrong = |_| Failure::argument(format!("sv_overlay_desc.{name}: wanted UTF-8"));
    words.map(Some).map_err(wrong)
}

/// # Safety
/// As [`structure::read`] of all that `desc` points to; words end with a zero.
unsafe fn drawn(
    device: &Device,
    desc: &sv_overlay_desc,
    count: u64,
) -> Result<Vec<[f32; 4]>, Failure> {
    let [width, height] = [desc.width, desc.height];
    for (name, found) in [("width", width), ("height", height)] {
        if found > MOST_PIXELS {
            let doing = "draw over pixels";
            return Err(Failure::limit(doing, found.into(), MOST_PIXELS.into()));
        }
        number(
            &format!("sv_overlay_desc.{name}"),
            "1 or more",
            found.into(),
            found > 0,
        )?;
    }
    let wanted = 4 * u64::from(width) * u64::from(height);
    let is_length = |length: f64| length >= 0.0 && length.is_finite();
    for (name, found, is_right) in [
        (
            "length_metres",
            desc.length_metres,
            is_length(desc.length_metres),
        ),
        (
            "height_factor",
            desc.height_factor,
            is_length(desc.height_factor),
        ),
        (
            "text_pixels",
            desc.text_pixels,
            is_length(desc.text_pixels) && desc.text_pixels <= f64::from(MOST_PIXELS),
        ),
    ] {
        number(
            &format!("sv_overlay_desc.{name}"),
            "a length, or 0",
            found,
            is_right,
        )?;
    }
    reserved("sv_overlay_desc.reserved", desc.reserved)?;
    number("count", &wanted.to_string(), count as f64, count == wanted)?;
    let dims = desc.dims;
    let fewest = f64::from(dims[0].min(dims[1]).min(dims[2]));
    number("sv_overlay_desc.dims", "1 or more", fewest, fewest > 0.0)?;
    let grid = Grid {
        dims,
        world_from_voxel: affine("sv_overlay_desc.world_from_voxel", &desc.world_from_voxel)?,
    };
    // SAFETY: the caller's promise.
    let (camera, settings, under, [marks, caption, unit, time, source]) = unsafe {
        (
            camera(desc.camera, &grid, [width, height])?.0,
            settings(desc.settings, [0.0, 1.0])?,
            structure::array(
                "sv_overlay_desc.under",
                desc.under,
                desc.under_count,
                wanted,
            )?,
            [
                text("marks", desc.marks)?,
                text("caption", desc.caption)?,
                text("unit", desc.unit)?,
                text("time", desc.time)?,
                text("source", desc.source)?,
            ],
        )
    };
    let under_count = under.len() as f64;
    let is_picture = under.is_empty() || under.len() as u64 == wanted;
    number(
        "sv_overlay_desc.under_count",
        &format!("0 or {wanted}"),
        under_count,
        is_picture,
    )?;
    let color = finite("sv_overlay_desc.color", desc.color)?;
    let is_color = color.min_element() >= 0.0 && color.max_element() <= 1.0;
    number(
        "sv_overlay_desc.color",
        "0 to 1",
        color.max_element(),
        is_color,
    )?;
    let marks: Marks = match marks.unwrap_or(Marks::USUAL).parse() {
        Ok(marks) => marks,
        Err(wrong) => {
            return Err(Failure::argument(format!("sv_overlay_desc.marks: {wrong}")));
        }
    };
    marks.check()?;
    let function = match desc.function {
        0 => None,
        handle => function(device, handle, settings.mode, [0.0, 1.0])?,
    };
    let owned = |words: Option<&str>| words.map(str::to_owned);
    let annotation = Annotation {
        marks,
        size: (desc.text_pixels > 0.0).then_some(desc.text_pixels),
        color: (desc.has_color != 0).then(|| color.to_array()),
        is_log: desc.is_logarithmic != 0,
        facts: Facts {
            caption: owned(caption).unwrap_or_default(),
            unit: owned(unit),
            times: 1,
            time_names: time.into_iter().map(str::to_owned).collect(),
            is_patient: desc.is_patient != 0,
            is_earth: desc.is_earth != 0,
            length_metres: (desc.length_metres > 0.0).then_some(desc.length_metres),
            source: owned(source).unwrap_or_default(),
            ..Facts::default()
        },
    };
    let picture = Picture {
        width,
        height,
        pixels: match under.as_chunks::<4>().0 {
            [] => vec![[0.0, 0.0, 0.0, 1.0]; (wanted / 4) as usize],
            pixels => pixels.to_vec(),
        },
        color_space: ColorSpace::Linear,
        layers: Vec::new(),
    };
    let seen = Seen {
        camera: &camera,
        settings: &settings,
        function: function.as_ref(),
        beside: Beside::Nothing,
        grid,
        height_factor: match desc.height_factor {
            0.0 => 1.0,
            factor => factor,
        },
        time: 0.0,
        projected: None,
        geometry: GeometryLegend::default(),
    };
    Ok(annotation.draw(&picture, &seen)?.front)
}
