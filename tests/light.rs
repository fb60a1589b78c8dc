//! Light on samples: the device draws what its twin computes, and the twin what the closed form says.

mod shared;

use glam::{DVec3, dvec3};
use shared::{compare, device, oblique_shots, ramps, sheared_affine, volume_of, waves};
use stratavox::offscreen::{Renderer, reference};
use stratavox::technique::{Filter, Light, Mode, Shading};
use stratavox::volume::{Grid, Volume};

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};

fn lights() -> Vec<Light> {
    let light = |towards, srgb| Light { towards, srgb };
    vec![
        light(dvec3(1.0, -2.0, 0.7), [1.0, 0.9, 0.8]),
        light(dvec3(-0.3, 0.2, 3.0), [0.2, 0.3, 0.6]),
        light(DVec3::NEG_X, [0.3; 3]),
    ]
}

fn shadings() -> [Shading; 2] {
    let lit = Shading {
        ambient: 0.2,
        diffuse: 0.5,
        specular: 0.4,
        shininess: 23.0,
        lights: lights(),
    };
    [Shading::default(), lit]
}

/// Of every technique, filter and kind of light.
fn assert_drawn_as_computed(volume: &Volume, what: &str) {
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), volume).unwrap();
    for shot in oblique_shots(GRID(), Mode::Composite) {
        for (filter, shading) in [Filter::Nearest, Filter::Linear]
            .into_iter()
            .zip(shadings())
        {
            let dark = shot.with(|settings| settings.filter = filter);
            let shot = dark.with(|settings| settings.shading = Some(shading));
            let scene = shot.scene(volume, Some(&transfer));
            let found = renderer.render(&scene, &[]).unwrap().picture;
            let double = reference::render::<f64>(&scene).unwrap();
            let single = reference::render::<f32>(&scene).unwrap();
            let all = [&double, &single, &found].map(|p| p.pixels.as_flattened());
            let what = format!("{what}, {filter:?}, {}", shot.what());
            compare(&what, 4 * found.width, all, 1.0);
            let dark = renderer.render(&dark.scene(volume, Some(&transfer)), &[]);
            let dark = dark.unwrap().picture;
            let changed = dark.pixels.iter().zip(&found.pixels);
            let changed = changed.filter(|(a, b)| (a[0] - b[0]).abs() > 0.01).count();
            assert!(changed > 100, "{what}: light changes {changed} pixels");
            let alpha = |p: &[[f32; 4]]| p.iter().map(|p| p[3]).collect::<Vec<_>>();
            assert_eq!(alpha(&dark.pixels), alpha(&found.pixels), "{what}: opacity");
        }
    }
}

#[test]
fn every_technique_and_filter_lights_what_its_twin_lights() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    assert_drawn_as_computed(&volume, "whole");
}

#[test]
fn a_gradient_with_a_hole_in_it_is_dark_on_the_device_as_in_the_twin() {
    let mut volume = volume_of(GRID().dims, sheared_affine(), waves);
    let count = volume.dims.iter().product::<u32>();
    volume.validity = Some((0..count).map(|i| u8::from(i % 53 != 7)).collect());
    assert_drawn_as_computed(&volume, "with holes");
}
