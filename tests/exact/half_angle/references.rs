//! The device draws what its CPU reference computes.

use super::{GRID, fading, plain, shots, ways_to_light};
use crate::shared::PictureCase;
use crate::shared::{compare, device, ramps, sheared_affine, volume_of};
use glam::dvec3;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{LayerKind, Picture};
use stratavox::scene::Scene;
use stratavox::technique::{ClipPlane, Filter, Order, Settings};
use stratavox::transfer::{GradientTransfer, Shape, TransferFunction, Widget};
use stratavox::volume::{Rescale, Volume, Voxels};

/// Picture and layers of the device against those of the CPU reference.
fn check(renderer: &mut Renderer, scene: &Scene, what: &str) -> Picture {
    let kinds = [LayerKind::Transmittance, LayerKind::Samples];
    let found = renderer.render(scene, &kinds).unwrap().picture;
    let double = reference::render::<f64>(scene).unwrap();
    let single = reference::render::<f32>(scene).unwrap();
    let all = [&double, &single, &found];
    let pixels = all.map(|p| p.pixels.as_flattened());
    compare(what, 4 * found.width, pixels, 1.0);
    for kind in kinds {
        let values = |picture: &'_ Picture| {
            let layer = picture.layers.iter().find(|layer| layer.kind == kind);
            layer.expect("a layer of slicers").values.clone()
        };
        let lists = all.map(values);
        let scale = lists[0].iter().copied().fold(1.0, f32::max);
        let lists = [&lists[0][..], &lists[1][..], &lists[2][..]];
        compare(&format!("{kind:?} of {what}"), found.width, lists, scale);
    }
    let unlit = Settings {
        shading: None,
        ..scene.settings.clone()
    };
    let unlit = Scene {
        settings: &unlit,
        ..*scene
    };
    let lit = reference::render::<f32>(&unlit).unwrap();
    let darker = found.pixels.iter().zip(&lit.pixels);
    let darker = darker
        .filter(|(found, lit)| found[1] < 0.8 * lit[1])
        .count();
    assert!(darker > 60, "{what}: only {darker} pixels are in shadow");
    found
}

#[test]
fn eye_and_light_draw_what_their_references_compute() {
    let volume = volume_of(GRID().dims, sheared_affine(), fading);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let mut orders = Vec::new();
    for (turn, shot) in shots().iter().enumerate() {
        for (i, towards) in ways_to_light(&shot.camera).into_iter().enumerate() {
            let mut shading = plain(towards).unwrap();
            // Surfaces now and then, in the light of a colour.
            shading.has_surfaces = i == 1;
            shading.lights[0].srgb = [1.0, 0.9, 0.7];
            let filter = [Filter::Linear, Filter::Nearest][(i + turn) % 2];
            let shot = shot.with(|settings| {
                settings.filter = filter;
                settings.shading = Some(shading);
            });
            let what = format!("light {i}, {filter:?}, {}", shot.what());
            check(&mut renderer, &shot.scene(&volume, Some(&transfer)), &what);
            orders.push(shot.view().half_angle().unwrap().order);
        }
    }
    assert!(orders.contains(&Order::FrontToBack) && orders.contains(&Order::BackToFront));
}

#[test]
fn holes_cuts_and_widgets_throw_the_shadows_of_their_references() {
    let values = volume_of(GRID().dims, sheared_affine(), fading).voxels;
    let codes = (0..values.len()).map(|i| (values.stored(i) * 200.0) as u8);
    let rescale = Rescale {
        slope: 1.0 / 200.0,
        intercept: 0.0,
    };
    let voxels = Voxels::U8(codes.collect());
    let volume = Volume::from_voxels(GRID().dims, sheared_affine(), voxels, rescale, Some(120.0));
    let volume = volume.unwrap();
    let widget = Widget {
        second: None,
        srgb: Some([0.2, 0.9, 0.3]),
        opacity: 0.5,
        shape: Shape::Contour {
            value: 0.55,
            half_width: 2.0,
        },
    };
    let gradient_transfer = TransferFunction {
        medium: None,
        gradient_transfer: Some(GradientTransfer {
            steepest: Some(0.3),
            share: Vec::new(),
            widgets: vec![widget],
        }),
        ..ramps()
    };
    let normal = dvec3(1.0, 0.4, -0.3).normalize();
    let plane = ClipPlane {
        normal,
        offset: normal.dot(GRID().center()) - 4.0,
    };
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let [parallel, perspective] = shots();
    let cut = |shot: &PictureCase| {
        let towards = ways_to_light(&shot.camera)[0];
        shot.with(|settings| {
            settings.shading = plain(towards);
            settings.crop = Some([dvec3(1.0, 1.7, -4.0), dvec3(16.2, 99.0, 11.9)]);
            settings.clip_planes = vec![plane];
        })
    };
    let (cut, whole) = (cut(&parallel), perspective);
    let cut = cut.with(|settings| settings.filter = Filter::Nearest);
    check(&mut renderer, &cut.scene(&volume, Some(&ramps())), "cut");
    check(
        &mut renderer,
        &whole.scene(&volume, Some(&gradient_transfer)),
        "widgets, headlight",
    );
}
