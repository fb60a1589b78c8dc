//! Rays as long as a device allows are whole, and longer ones are refused: llvmpipe ends the loops of an invocation
//! after 65 535 turns, all of them counted together, without a word.

use crate::shared::{device, ramps, volume_of};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Error, Renderer, reference};
use stratavox::picture::{LayerKind, Picture};
use stratavox::scene::{Beside, Scene};
use stratavox::technique::{self, Filter, GradientFilter, Settings, Shading};
use stratavox::volume::Volume;

const LENGTH: u32 = 400;

fn long_volume(has_holes: bool) -> Volume {
    let mut volume = volume_of([4, 4, LENGTH], DAffine3::IDENTITY, |p| {
        0.3 + 0.2 * (0.7 * p.z).sin() + 0.02 * p.x
    });
    if has_holes {
        let count = volume.voxels.len();
        volume.validity = Some((0..count).map(|i| u8::from(i != 7)).collect());
    }
    volume
}

fn along_z() -> Camera {
    Camera {
        eye: dvec3(2.0, 2.0, -10.0),
        target: dvec3(2.0, 2.0, 0.0),
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 3.0 },
        zoom: 1.0,
    }
}

fn samples(picture: &Picture) -> &[f32] {
    let mut layers = picture.layers.iter();
    let layer = layers.find(|layer| layer.kind == LayerKind::Samples);
    &layer.expect("the layer that was asked for").values
}

#[test]
fn a_ray_is_as_long_as_its_reference_up_to_the_limit_of_the_driver() {
    let transfer = ramps();
    let camera = along_z();
    let [plain, holes] = [false, true].map(long_volume);
    let mut refused = 0;
    let lit = |filter| (Some(Shading::default()), filter);
    let dark = (None, GradientFilter::Central);
    let plain_light = lit(GradientFilter::Central);
    for (volume, filter, conformance, (shading, gradient_filter)) in [
        (&plain, Filter::Linear, false, dark.clone()),
        (&plain, Filter::Linear, true, dark.clone()),
        (&plain, Filter::CatmullRom, false, dark.clone()),
        (&plain, Filter::Linear, true, lit(GradientFilter::Cubic)),
        (&holes, Filter::Linear, true, lit(GradientFilter::Sobel)),
        (&holes, Filter::Cubic, true, lit(GradientFilter::Linear)),
        (&plain, Filter::Cubic, true, plain_light.clone()),
        (&holes, Filter::Nearest, false, dark.clone()),
        (&holes, Filter::Linear, false, dark.clone()),
        (&holes, Filter::Linear, false, plain_light.clone()),
        (&holes, Filter::Cubic, false, dark.clone()),
        (&holes, Filter::Cubic, false, plain_light.clone()),
        (&holes, Filter::Quadratic, true, plain_light.clone()),
    ] {
        let what = format!(
            "{filter:?}, {gradient_filter:?}, conformance {conformance}, {}",
            shading.is_some()
        );
        let mut renderer = Renderer::new(device(), volume).unwrap();
        let mut draw = |samples_per_voxel: f64| {
            let settings = Settings {
                filter,
                gradient_filter,
                conformance,
                shading: shading.clone(),
                samples_per_voxel,
                ..Settings::default()
            };
            let scene = Scene {
                volume,
                transfer: Some(&transfer),
                beside: Beside::Nothing,
                camera: &camera,
                extent_pixels: [4, 3],
                settings: &settings,
            };
            let drawn = renderer.render(&scene, &[LayerKind::Samples]);
            drawn.map(|drawn| (drawn.picture, reference::render::<f32>(&scene).unwrap()))
        };
        // 400 000 samples are over the limit of every picture on a driver that has one. On a graphics card, which has none,
        // they would take minutes.
        let may_end_loops = device().gpu().is_cpu();
        let error = may_end_loops.then(|| draw(1000.0).err()).flatten();
        let at_most = match error {
            Some(Error::Technique(technique::Error::LoopsEnd { wanted, limit, .. })) => {
                refused += 1;
                assert!(wanted > 399_999.0, "{what}: {wanted}");
                0.995 * limit / f64::from(LENGTH)
            }
            Some(error) => panic!("{what}: {error}"),
            None => 4.0,
        };
        let (found, reference) = draw(at_most).unwrap();
        assert_eq!(
            samples(&found),
            samples(&reference),
            "{what}: {at_most} a voxel"
        );
        assert!(samples(&found)[0] > 90.0, "{what}");
    }
    println!("{refused} of 13 kinds of picture have a limit here");
}
