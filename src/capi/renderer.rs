//! Pictures of a volume in the host's frames.

use super::device::{Device, sv_device};
use super::function::{function, sv_transfer_function};
use super::handles::{self, Kind};
use super::images::{MOST_FRAMES, depth_images, sv_depth_image, sv_target_class, target_class};
use super::settings::{settings, sv_settings};
use super::status::{Failure, guard, number, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use super::volume::{self, sv_volume};
use crate::embed::{self, RendererDesc, SliceBlending};
use crate::technique::Settings;
use std::ffi::c_void;
use std::sync::{Arc, Mutex};

/// Pictures of one volume in a host's frames. 0 is none.
pub type sv_renderer = u64;

/// What a renderer is made for.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_renderer_desc {
    /// `sizeof(sv_renderer_desc)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// Uploaded, with settings of the same kind.
    pub volume: sv_volume,
    /// 0: a ramp of greys over the volume's range.
    pub function: sv_transfer_function,
    /// What to compute, or NULL.
    pub settings: *const sv_settings,
    /// What is drawn into.
    pub target: *const sv_target_class,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Frames of the host that may be unfinished at once, at most 64. 0 is 1.
    pub frames_in_flight: u32,
    /// Not 0: what the host has drawn hides the volume behind it. Cameras are SV_CAMERA_MATRICES then.
    pub has_host_depth: u32,
    /// Not 0: sv_renderer_draw_depth will be called, where `target` has a depth attachment (cameras are
    /// SV_CAMERA_MATRICES then). sv_renderer_record_pick may be called too.
    pub gives_depth: u32,
    /// 0: slices are blended with each other in an image of floats, and the result once into the target. Not 0: one by one
    /// in the target, each rounded to its format, which is wrong in targets of few bits; composites from back to front
    /// alone, and not in parts.
    pub blends_slices_in_target: u32,
    /// With `has_host_depth`: the host's depth, one image for all frames in flight or one for each. Slices that are
    /// blended in the target without `gives_depth` are tested against its attachment instead, and have none.
    pub depth_images: *const sv_depth_image,
    /// How many there are.
    pub depth_image_count: u64,
    /// Not 0: sv_renderer_record_pick will be called. Rays that composite keep 16 bytes more for it, a pixel and frame in
    /// flight; of slices, rays look for the depth.
    pub picks: u32,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_renderer_desc {
    const NAME: &'static str = "sv_renderer_desc";
}

/// One thread at a time.
pub(super) struct Held(Mutex<Inner>);

pub(super) struct Inner {
    pub renderer: embed::Renderer,
    pub volume: Arc<embed::Volume>,
}

impl Kind for Held {
    const NUMBER: u64 = 4;
    const NAME: &'static str = "sv_renderer";
}

/// Runs `body` on the renderer of a handle.
pub(super) fn with(
    handle: sv_renderer,
    body: impl FnOnce(&Device, &mut Inner) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let (device, held) = handles::find::<Held>(handle)?;
    let mut inner = handles::only(Held::NAME, &held.0)?;
    device.run(|| body(&device, &mut inner))
}

/// Makes all that frames of that size will need: nothing is compiled later.
/// Threads: any; several at once make several renderers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_create(
    device: sv_device,
    desc: *const sv_renderer_desc,
    renderer: *mut sv_renderer,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the sv_renderer", renderer)?;
        let device = handles::device(device)?;
        device.run(|| {
            // SAFETY: the caller's promise.
            let desc = unsafe { structure::read(desc)? };
            // SAFETY: as above.
            let inner = unsafe { made(&device, &desc)? };
            let handle = handles::add(&device, Held(Mutex::new(inner)))?;
            // SAFETY: not NULL; the caller's promise.
            unsafe { renderer.write(handle) };
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Frames of another size, or with other depth images, from now on. Nothing waits; what frames in flight use is freed
/// by sv_device_retire. Threads: one at a time for one renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_resize(
    renderer: sv_renderer,
    width: u32,
    height: u32,
    depth_images: *const sv_depth_image,
    depth_image_count: u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        with(renderer, |device, inner| {
            // SAFETY: the caller's promise.
            let images = unsafe { self::depth_images(depth_images, depth_image_count)? };
            let extent = extent(device, [width, height])?;
            Ok(inner.renderer.resize(extent, &images)?)
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Another transfer function from the next recording on; 0 is the ramp of greys. It may be called each frame: nothing
/// is compiled, nothing waits. Threads: one at a time for one renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_set_transfer_function(
    renderer: sv_renderer,
    function: sv_transfer_function,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        with(renderer, |device, inner| {
            let (mode, range) = (inner.mode(), inner.volume.value_range());
            let function = self::function(device, function, mode, range)?;
            Ok(inner.renderer.set_function(function.as_ref())?)
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Other numbers in the settings from the next recording on: steps, crops, planes, levels, lights. What needs other
/// pipelines is refused. Threads: one at a time for one renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_set_settings(
    renderer: sv_renderer,
    settings: *const sv_settings,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        with(renderer, |_, inner| {
            // SAFETY: the caller's promise.
            let settings = unsafe { self::settings(settings, inner.volume.value_range())? };
            Ok(inner.renderer.set_settings(settings)?)
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Another volume of the same size and kind from the next recording on: the next time of a series. It is uploaded, or
/// its upload is recorded. Threads: one at a time for one renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_set_volume(
    renderer: sv_renderer,
    volume: sv_volume,
    function: sv_transfer_function,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        with(renderer, |device, inner| {
            let volume = handles::find_on::<volume::Held>(device, volume)?.share()?;
            let range = volume.value_range();
            let function = self::function(device, function, inner.mode(), range)?;
            inner.renderer.set_volume(&volume, function.as_ref())?;
            inner.volume = volume;
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Destroys the handle; what frames in flight use is freed by sv_device_retire. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_destroy(
    renderer: sv_renderer,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || handles::remove::<Held>(renderer).map(drop);
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

impl Inner {
    fn mode(&self) -> crate::technique::Mode {
        self.renderer.class().settings.mode
    }
}

/// # Safety
/// As [`structure::read`] of all that `desc` points to.
unsafe fn made(device: &Device, desc: &sv_renderer_desc) -> Result<Inner, Failure> {
    let volume = handles::find_on::<volume::Held>(device, desc.volume)?.share()?;
    let range = volume.value_range();
    // SAFETY: the caller's promise.
    let (settings, target, depths): (Settings, _, _) = unsafe {
        let target = structure::read(desc.target)?;
        let depths = depth_images(desc.depth_images, desc.depth_image_count)?;
        (
            settings(desc.settings, range)?,
            target_class(&target)?,
            depths,
        )
    };
    let function = function(device, desc.function, settings.mode, range)?;
    let frames = desc.frames_in_flight.max(1);
    if frames > MOST_FRAMES {
        let doing = "keep frames in flight";
        return Err(Failure::limit(doing, frames.into(), MOST_FRAMES.into()));
    }
    let class = RendererDesc {
        settings,
        target,
        frames_in_flight: frames,
        host_depth: desc.has_host_depth != 0,
        gives_depth: desc.gives_depth != 0,
        picks: desc.picks != 0,
        slice_blending: match desc.blends_slices_in_target {
            0 => SliceBlending::Float,
            _ => SliceBlending::InTarget,
        },
    };
    let extent = extent(device, [desc.width, desc.height])?;
    let gpu = &device.gpu;
    let renderer = embed::Renderer::new(gpu, &volume, function.as_ref(), class, extent, &depths)?;
    Ok(Inner { renderer, volume })
}

/// A size that the device can draw to.
pub(super) fn extent(device: &Device, extent: [u32; 2]) -> Result<[u32; 2], Failure> {
    let limits = device.gpu.limits();
    let most = [0, 1].map(|k| {
        let of_image = limits.max_image_dimension_2d;
        limits.max_framebuffer[k]
            .min(limits.max_viewport[k])
            .min(of_image)
    });
    for (name, (found, most)) in ["width", "height"]
        .into_iter()
        .zip(extent.into_iter().zip(most))
    {
        number(name, "1 or more", found.into(), found > 0)?;
        if found > most {
            let doing = format!("draw pictures of such {name}");
            return Err(Failure::limit(doing, found.into(), most.into()));
        }
    }
    Ok(extent)
}
