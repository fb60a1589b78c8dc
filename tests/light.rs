//! Light on samples: the device draws what its twin computes, and the twin what the closed form says.

mod shared;

use glam::{DVec3, dvec3};
use shared::{Worst, compare, device, oblique_shots, ramps, sheared_affine, volume_of, waves};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::ColorSpace;
use stratavox::technique::{Filter, Light, Mode, Shading};
use stratavox::transfer::{ColorPoint, TransferFunction};
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

/// The colour of a surface in f64, written a second time: `sampling.md` 7 word by word.
fn phong(shading: &Shading, color: DVec3, normal: DVec3, to_eye: DVec3) -> DVec3 {
    let mut lit = shading.ambient * color;
    for light in &shading.lights {
        let to_light = light.towards.normalize();
        let halfway = (to_light + to_eye).normalize();
        let diffuse = shading.diffuse * normal.dot(to_light).abs();
        let specular = shading.specular * normal.dot(halfway).abs().powf(shading.shininess);
        lit += DVec3::from_array(light.srgb) * (diffuse * color + specular);
    }
    lit
}

/// A18: on a field that rises evenly every sample has the same normal, so a pixel has the colour of one surface.
#[test]
fn an_even_slope_of_any_grid_shines_as_the_closed_form_says() {
    let slope = dvec3(0.011, -0.02, 0.015);
    let color = dvec3(0.6, 0.3, 0.45);
    let affine = sheared_affine();
    let center = GRID().center();
    let value = |p| 0.5 + slope.dot(affine.transform_point3(p) - center);
    let volume = volume_of(GRID().dims, affine, value);
    let transfer = TransferFunction {
        color: vec![ColorPoint {
            value: 0.5,
            srgb: color.to_array(),
        }],
        ..ramps()
    };
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let mut headlight = Shading::default();
    for (shading, is_headlight) in shadings().into_iter().zip([true, false]) {
        for shot in oblique_shots(GRID(), Mode::Composite) {
            for conformance in [true, false] {
                let shot = shot.with(|settings| {
                    settings.shading = Some(shading.clone());
                    settings.color_space = ColorSpace::Display;
                    settings.conformance = conformance;
                    // No tap outside the outermost voxel centres.
                    settings.crop = Some([DVec3::splat(1.625), GRID().far_corner() - 1.625]);
                });
                let scene = shot.scene(&volume, Some(&transfer));
                let found = renderer.render(&scene, &[]).unwrap().picture;
                let mut worst = Worst::new(format!("conformance {conformance}, {}", shot.what()));
                let mut mistaken = [0.0f64; 4];
                let rays = shot.camera.rays(shot.extent);
                for (i, [x, y]) in shot.pixels().enumerate() {
                    let [.., alpha] = found.pixels[i];
                    if alpha < 0.01 {
                        continue;
                    }
                    let shown =
                        DVec3::from_array([0, 1, 2].map(|c| f64::from(found.pixels[i][c] / alpha)));
                    let (_, along) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
                    let to_eye = -along.normalize();
                    if is_headlight {
                        let srgb = [1.0; 3];
                        headlight.lights = vec![Light {
                            towards: to_eye,
                            srgb,
                        }];
                    }
                    let shading = if is_headlight { &headlight } else { &shading };
                    let lit = |normal: DVec3| phong(shading, color, normal.normalize(), to_eye);
                    let wanted = lit(slope);
                    for c in 0..3 {
                        worst.take([x, y], shown[c] - wanted[c], tolerance(conformance));
                    }
                    let m = affine.matrix3;
                    let voxel = m.transpose() * slope;
                    for (k, wrong) in [voxel, m * voxel, m.inverse() * voxel]
                        .into_iter()
                        .enumerate()
                    {
                        mistaken[k] = mistaken[k].max((lit(wrong) - wanted).abs().max_element());
                    }
                    let dark = shading.ambient * color;
                    mistaken[3] = mistaken[3].max((dark - wanted).abs().max_element());
                }
                worst.assert_holds();
                // Voxel gradients, directions for covectors, the inverse not transposed, one-sided light that a
                // slope away from it does not see: each is far more than the tolerance.
                assert!(
                    mistaken.iter().all(|&m| m > 0.01),
                    "{mistaken:?} tells nothing"
                );
            }
        }
    }
}

/// Conformance: A18. Else a table's cell rounds the opacity of both the colour and alpha alike, and the device's
/// filter slips alike on both sides of a difference where the field is even, up to f32: values of about 1 are
/// stored to 6e-8, a difference of 0.04 is off by 2 * 6e-8 / 0.04 = 3e-6 for each of a fetch and a filter, times
/// the steepest change of the light with the normal, shininess * specular + diffuse = 10.
fn tolerance(conformance: bool) -> f64 {
    if conformance { 1e-5 } else { 6e-5 }
}
