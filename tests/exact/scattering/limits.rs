//! Drivers that end loops after so many turns, and the samples a voxel that an error names: they are drawn, and few more
//! are not.

use super::{around_blobs, blobs, matter, scene, single};
use crate::pathtrace::light;
use crate::shared::device_with;
use glam::dvec3;
use stratavox::gpu::Caps;
use stratavox::offscreen::{Error, Renderer};
use stratavox::technique::pathtrace::PathTracing;
use stratavox::technique::{self, Settings, SingleScattering};

#[test]
fn the_samples_that_an_error_of_marched_light_names_are_drawn() {
    let caps = Caps {
        max_loop_turns: 5000,
        ..Caps::UNLIMITED
    };
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let mut renderer = Renderer::new(device_with(caps), &volume).expect("a renderer");
    for lights in 1..=3 {
        let mut draw = |samples_per_voxel: f64| {
            let lights = vec![light(dvec3(1.0, 0.5, 0.3)); lights];
            let path = PathTracing {
                lights,
                ..PathTracing::default()
            };
            let settings = Settings {
                samples_per_voxel,
                ..single(SingleScattering::March, path)
            };
            let scene = scene(&volume, &function, &camera, &settings, [4, 3]);
            renderer.render(&scene, &[]).map(drop)
        };
        let named = |error: Error| match error {
            Error::Technique(technique::Error::LoopsEnd {
                samples_per_voxel: Some(most),
                follows_light: true,
                ..
            }) => most,
            error => panic!("{error}"),
        };
        let most = named(draw(2.0).expect_err("refused"));
        assert!((0.1..2.0).contains(&most), "{lights}: {most}");
        // But for rounding.
        draw(0.999_999 * most).unwrap_or_else(|error| panic!("{lights}: {most}: {error}"));
        let again = named(draw(1.000_001 * most).expect_err("refused"));
        assert!((again / most - 1.0).abs() < 1e-9, "{again} {most}");
    }
}
