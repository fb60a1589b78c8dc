//! What to do where the intermediate image of shear-warp has no room: the largest `--intermediate` that has.
//!
//! ```text
//! 16 bytes a base pixel   the largest image of a view, whose sides are no longer than the technique has room for
//! ```

use super::{Error, sample_limit::rounded_down};
use crate::gpu;
use crate::offscreen;
use crate::scene::Scene;
use crate::technique::{self, InPixel, Intermediate, Settings};

/// Of what base rays leave, four numbers of 32 bits each.
const BYTES_PER_BASE_PIXEL: u64 = 16;
/// As it stands in the errors of the device.
const IMAGE: &str = "`base rays`";
/// Fewer base pixels a voxel show nothing.
const COARSEST: f64 = 0.1;
/// Halvings of the range in which the number is looked for.
const HALVINGS: u32 = 24;

/// What [`explained`] makes of the errors of a scene on the device of a renderer.
pub fn told<'a>(
    on: &offscreen::Renderer,
    scene: &'a Scene<'a>,
) -> impl Fn(offscreen::Error) -> Error + Copy + use<'a> {
    let most_bytes = on.device().gpu().limits().max_allocation_bytes;
    move |error| explained(error, scene, most_bytes)
}

/// The error, with a hint that names the number where it is about the intermediate image; `most_bytes` is what the device has room
/// for in one image.
pub fn explained(error: offscreen::Error, scene: &Scene, most_bytes: u64) -> Error {
    let allowed = match &error {
        offscreen::Error::Technique(technique::Error::IntermediateTooLarge { .. }) => most_bytes,
        offscreen::Error::Gpu(gpu::Error::Limit { doing, allowed, .. })
            if doing.contains(IMAGE) =>
        {
            most_bytes.min(*allowed)
        }
        _ => return error.into(),
    };
    let Intermediate::PerVoxel(found) = scene.settings.intermediate else {
        return error.into();
    };
    let Some(number) = largest(scene, found, allowed) else {
        return error.into();
    };
    let (message, hint) = (
        error.to_string(),
        format!("--intermediate {} has room", rounded_down(number)).into(),
    );
    match error {
        offscreen::Error::Gpu(_) => Error::Limit { message, hint },
        _ => Error::Usage { message, hint },
    }
}

/// Base pixels a voxel under `found` whose image has room; `None` where none has.
fn largest(scene: &Scene, found: f64, allowed: u64) -> Option<f64> {
    let grid = scene.volume.grid();
    let fits = |per_voxel: f64| {
        let settings = Settings {
            intermediate: Intermediate::PerVoxel(per_voxel),
            ..scene.settings.clone()
        };
        let scene = Scene {
            settings: &settings,
            ..*scene
        };
        let room = scene.view(&grid, InPixel::CENTER).intermediate_room();
        let bytes = |[x, y]: [u32; 2]| BYTES_PER_BASE_PIXEL * u64::from(x) * u64::from(y);
        room.is_ok_and(|room| bytes(room) <= allowed)
    };
    let [mut low, mut high] = [COARSEST, found];
    if !fits(low) {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if fits(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(low)
}
