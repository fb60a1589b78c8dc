//! Whether gradients are kept and what filters, where that is left to the device.

use crate::gpu::Gpu;
use crate::resident::KeptGradients;
use crate::scene::Scene;
use crate::technique::{FilterBy, GradientStorage, Settings};
use std::borrow::Cow;

/// Part of the device's memory that kept gradients may take: voxels and pictures want theirs.
const SHARE: f64 = 0.5;

/// The settings of a scene with [`GradientStorage::Auto`] decided, and with [`FilterBy::Auto`] where a device has the sampler.
pub fn decided<'a>(gpu: &Gpu, scene: &Scene<'a>) -> Cow<'a, Settings> {
    let settings = scene.settings;
    let filter_by = filter_by(settings.filter_by, gpu.has_slow_sampler());
    if settings.gradient_storage != GradientStorage::Auto && settings.filter_by == filter_by {
        return Cow::Borrowed(settings);
    }
    let can_be = settings.kept_operator().is_some() && scene.volume.validity.is_none();
    let voxels = scene.volume.dims.iter().map(|&n| u64::from(n)).product();
    let heap_bytes = gpu.limits().max_heap_bytes;
    let gradient_storage = match settings.gradient_storage {
        GradientStorage::Auto if can_be && is_worth_it(gpu.is_cpu(), heap_bytes, voxels) => {
            GradientStorage::Precomputed
        }
        GradientStorage::Auto => GradientStorage::OnTheFly,
        wanted => wanted,
    };
    Cow::Owned(Settings {
        gradient_storage,
        filter_by,
        ..settings.clone()
    })
}

/// [`FilterBy::Auto`] goes on to mean corners.
fn filter_by(wanted: FilterBy, has_slow_sampler: bool) -> FilterBy {
    match wanted {
        FilterBy::Auto if !has_slow_sampler => FilterBy::Sampler,
        wanted => wanted,
    }
}

/// Software devices look up four halves no faster than six values (`docs/quality.md`).
fn is_worth_it(is_cpu: bool, heap_bytes: u64, voxels: u64) -> bool {
    let wanted = voxels.saturating_mul(KeptGradients::BYTES_PER_VOXEL);
    !is_cpu && wanted as f64 <= SHARE * heap_bytes as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_are_kept_where_half_of_a_graphics_card_has_room_for_them() {
        assert!(is_worth_it(false, 1 << 30, 1 << 26));
        assert!(!is_worth_it(false, 1 << 30, (1 << 26) + 1));
        assert!(!is_worth_it(true, 1 << 40, 1));
    }

    #[test]
    fn corners_are_for_drivers_that_are_faster_with_them_or_who_asks_for_them() {
        use FilterBy::{Auto, Fetch, Sampler};
        let decided =
            |has_slow_sampler| [Auto, Sampler, Fetch].map(|w| filter_by(w, has_slow_sampler));
        assert_eq!(decided(true), [Auto, Sampler, Fetch]);
        assert_eq!(decided(false), [Sampler, Sampler, Fetch]);
    }
}
