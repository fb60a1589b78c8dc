//! What a renderer makes on a device goes with it.

mod shared;

use shared::{device, oblique_camera, projections, ramps, sheared_affine, volume_of, waves};
use std::sync::Arc;
use stratavox::offscreen::Renderer;
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::{Mode, Settings, Technique};

#[test]
fn a_dropped_renderer_leaves_no_vulkan_object() {
    let mut volume = volume_of([9, 8, 7], sheared_affine(), waves);
    volume.validity = Some((0..9 * 8 * 7).map(|i| u8::from(i % 5 != 0)).collect());
    let transfer = ramps();
    let grid = volume.grid();
    let camera = oblique_camera(&grid, projections(&grid)[1]);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let gpu = Arc::clone(renderer.device().gpu());
    for technique in [Technique::Raycast, Technique::Slices3d, Technique::Slices2d] {
        for (mode, transfer) in [(Mode::Composite, Some(&transfer)), (Mode::Xray, None)] {
            let settings = Settings {
                technique,
                mode,
                rays_per_side: 2,
                ..Settings::default()
            };
            let scene = Scene {
                beside: Default::default(),
                volume: &volume,
                transfer,
                camera: &camera,
                extent_pixels: [16, 12],
                settings: &settings,
            };
            renderer.render(&scene, &[LayerKind::Samples]).unwrap();
        }
    }
    let alive: usize = gpu.live_objects().values().sum();
    assert!(alive > 20, "only {alive} objects were ever counted");
    drop(renderer);
    // SAFETY: every submission was waited for.
    unsafe { gpu.retire(u64::MAX) };
    assert_eq!(
        gpu.live_objects().into_iter().collect::<Vec<_>>(),
        [],
        "what is left"
    );
}
