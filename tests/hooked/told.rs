//! What a device is asked for, and what of it is told.

use super::hooked;
use crate::shared::allowed;
use std::error::Error;
use stratavox::gpu::{self, *};
use stratavox::{embed, offscreen};

/// The error of the device in what a caller got.
pub fn of_device<'a>(error: &'a (dyn Error + 'static)) -> &'a gpu::Error {
    let found = error.downcast_ref::<gpu::Error>();
    let inside = || match error.downcast_ref::<offscreen::Error>() {
        Some(offscreen::Error::Gpu(error)) => Some(error),
        _ => match error.downcast_ref::<embed::Error>() {
            Some(embed::Error::Gpu(error)) => Some(error),
            _ => None,
        },
    };
    found
        .or_else(inside)
        .unwrap_or_else(|| panic!("not of the device: {error}"))
}

/// What is required, and nothing else.
pub const FEATURES: Features = Features {
    dynamic_rendering: true,
    synchronization2: true,
    timeline_semaphore: false,
    robust_buffer_access: false,
    robust_image_access: false,
    portability_subset: false,
};

fn options() -> Options {
    Options {
        caps: allowed(Caps::UNLIMITED),
        pipeline_cache: PipelineCache::Off,
        validation: Validation::Off,
    }
}

/// A device of our own.
pub fn headless() -> Result<Headless, gpu::Error> {
    // SAFETY: the functions are Vulkan's, or fail as Vulkan's may.
    unsafe { Headless::through(hooked, &DeviceChoice::Default, &options()) }
}
