//! What half-angle slices cannot do.

use super::{GRID, plain, shots};
use crate::shared::{PictureCase, device, device_with, ramps, sheared_affine, volume_of, waves};
use glam::{DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::Caps;
use stratavox::offscreen::{self, Renderer, reference};
use stratavox::picture::LayerKind;
use stratavox::scene::{Beside, Scene};
use stratavox::technique::{Error, Filter, Mode, Settings, Technique};

#[test]
fn what_half_angle_slices_cannot_do_is_refused_by_name() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let [parallel, perspective] = shots();
    let refused = |shot: &PictureCase, beside: Beside| -> Error {
        let scene = Scene {
            beside,
            ..shot.scene(&volume, Some(&transfer))
        };
        let of_reference = reference::render::<f32>(&scene).unwrap_err();
        let mut renderer = Renderer::several(device(), scene.volumes()).unwrap();
        match renderer.render(&scene, &[]).unwrap_err() {
            offscreen::Error::Technique(of_device) => assert_eq!(of_device, of_reference),
            other => panic!("{other}"),
        }
        of_reference
    };
    let alone = |shot: &PictureCase| refused(shot, Beside::Nothing).to_string();
    for (change, wanted) in [
        (
            (|s: &mut Settings| s.technique = Technique::Raycast) as fn(&mut Settings),
            "half-angle slicing is for 3D slices, not for raycast",
        ),
        (|s| s.technique = Technique::Slices2d, "not for slices-2d"),
        (|s| s.mode = Mode::Mip, "is for composite, not for mode mip"),
        (|s| s.filter = Filter::Cubic, "nearest and linear filters"),
        (|s| s.preintegrated = true, "pre-integrated classification"),
        (
            |s| {
                let mut shading = plain(DVec3::X).unwrap();
                shading.lights.extend(shading.lights.clone());
                s.shading = Some(shading);
            },
            "one light, and 2 were given",
        ),
    ] {
        let text = alone(&parallel.with(change));
        assert!(text.contains(wanted), "{text}");
    }
    let green = [&volume, &volume];
    let text = refused(&parallel, Beside::Colors(&green)).to_string();
    assert!(text.contains("one volume of numbers"), "{text}");

    // The eye beside the box, light across the view: rays at the rim run along the slices.
    let wide = PictureCase {
        camera: Camera {
            eye: GRID().center() + dvec3(2.0, -14.0, 0.0),
            target: GRID().center(),
            projection: Projection::Perspective { fov_degrees: 120.0 },
            ..perspective.camera
        },
        ..perspective.with(|s| s.shading = plain(DVec3::X))
    };
    let text = alone(&wide);
    assert!(text.contains("degrees off the normal"), "{text}");

    let small = Caps {
        max_image_dimension_3d: 13,
        ..Caps::UNLIMITED
    };
    let mut renderer = Renderer::new(device_with(small), &volume).unwrap();
    let scene = parallel.scene(&volume, Some(&transfer));
    let error = renderer.render(&scene, &[]).unwrap_err().to_string();
    assert!(error.contains("one texture of the device"), "{error}");

    let blends_halves = Caps {
        float32_blend: false,
        ..Caps::UNLIMITED
    };
    let mut renderer = Renderer::new(device_with(blends_halves), &volume).unwrap();
    let error = renderer.render(&scene, &[]).unwrap_err().to_string();
    assert!(error.contains("blending"), "{error}");

    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for layer in [LayerKind::Depth, LayerKind::Value, LayerKind::Position] {
        let error = renderer.render(&scene, &[layer]).unwrap_err().to_string();
        let name = layer.name();
        assert!(error.contains(&format!("`{name}`")), "{error}");
    }
}
