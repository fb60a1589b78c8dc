//! Whether gradients are kept, where that is left to the device.

use crate::gpu::Gpu;
use crate::resident::KeptGradients;
use crate::scene::Scene;
use crate::technique::{Keep, Settings};
use std::borrow::Cow;

/// Part of the device's memory that kept gradients may take: voxels and pictures want theirs.
const SHARE: f64 = 0.5;

/// The settings of a scene with [`Keep::Auto`] decided.
pub fn decided<'a>(gpu: &Gpu, scene: &Scene<'a>) -> Cow<'a, Settings> {
    let settings = scene.settings;
    if settings.keep_gradients != Keep::Auto {
        return Cow::Borrowed(settings);
    }
    let can_be = settings.kept_operator().is_some() && scene.volume.validity.is_none();
    let keep_gradients = match can_be && fits(gpu, scene) {
        true => Keep::Always,
        false => Keep::Never,
    };
    Cow::Owned(Settings {
        keep_gradients,
        ..settings.clone()
    })
}

fn fits(gpu: &Gpu, scene: &Scene) -> bool {
    let voxels: u64 = scene.volume.dims.iter().map(|&n| u64::from(n)).product();
    let wanted = voxels.saturating_mul(KeptGradients::BYTES_PER_VOXEL);
    wanted as f64 <= SHARE * gpu.limits().max_heap_bytes as f64
}
