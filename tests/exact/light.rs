//! Light on samples: the device draws what its CPU reference computes, and the CPU reference what the closed form says.

use crate::shared::{
    PictureCase, Worst, compare, device, device_with, oblique_shots, ramps, sheared_affine,
    volume_of, waves,
};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::gpu::Caps;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{ColorSpace, Picture};
use stratavox::technique::{
    Filter, GradientFilter, GradientStorage, Light, LightSpace, Mode, Settings, Shading,
};
use stratavox::transfer::{ColorPoint, TransferFunction};
use stratavox::volume::{Grid, Volume};

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};

fn lights() -> Vec<Light> {
    let light = |towards, srgb| Light::of_world(towards, srgb);
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
        ..Shading::default()
    };
    [Shading::default(), lit]
}

/// Lights that move with the camera, on matter that is lit evenly where gradients are small; `waves` rises by 0.15 a
/// voxel at most.
fn steady() -> Shading {
    let [_, lights] = shadings();
    let lights = lights.lights.into_iter().map(|light| Light {
        space: LightSpace::Camera,
        ..light
    });
    Shading {
        half_gradient: 0.1,
        lights: lights.collect(),
        ..shadings()[1].clone()
    }
}

/// In every placement and projection, each technique with each kind of filter, in turns.
fn assert_drawn_as_computed(volume: &Volume, what: &str) {
    let mut renderer = Renderer::new(device(), volume).unwrap();
    let [headlight, lights] = shadings();
    let turns = [
        (Filter::Nearest, headlight.clone()),
        (Filter::Linear, lights),
        (Filter::Cubic, headlight),
    ];
    for (i, shot) in oblique_shots(GRID(), Mode::Composite).iter().enumerate() {
        let (filter, shading) = &turns[(i + i / 6) % turns.len()];
        let dark = shot.with(|settings| settings.filter = *filter);
        let lit = dark.with(|settings| settings.shading = Some(shading.clone()));
        assert_changes(&mut renderer, volume, &dark, &lit, what);
    }
}

/// Each technique once, with both projections among them.
fn assert_steady_light_drawn_as_computed(volume: &Volume, what: &str) {
    let mut renderer = Renderer::new(device(), volume).unwrap();
    let shots = oblique_shots(GRID(), Mode::Composite);
    for k in [0, 8, 5] {
        let dark = shots[k].with(|settings| settings.filter = Filter::Linear);
        let lit = dark.with(|settings| settings.shading = Some(steady()));
        assert_changes(&mut renderer, volume, &dark, &lit, what);
        // It is another light than that of the world, and than that of all gradients.
        for change in [
            |shading: &mut Shading| shading.half_gradient = 0.0,
            |shading: &mut Shading| {
                for light in &mut shading.lights {
                    light.space = LightSpace::World;
                }
            },
        ] {
            let other = dark.with(|settings| {
                let mut shading = steady();
                change(&mut shading);
                settings.shading = Some(shading);
            });
            assert_changes(&mut renderer, volume, &other, &lit, what);
        }
    }
}

/// The lit picture is that of its CPU reference, and another than `without`, by colour alone.
fn assert_changes(
    renderer: &mut Renderer,
    volume: &Volume,
    without: &PictureCase,
    lit: &PictureCase,
    what: &str,
) {
    let transfer = ramps();
    let scene = lit.scene(volume, Some(&transfer));
    let found = renderer.render(&scene, &[]).unwrap().picture;
    let double = reference::render::<f64>(&scene).unwrap();
    let single = reference::render::<f32>(&scene).unwrap();
    let all = [&double, &single, &found].map(|p| p.pixels.as_flattened());
    let Settings {
        filter,
        gradient_filter,
        ..
    } = lit.settings;
    let what = format!("{what}, {filter:?}, {gradient_filter:?}, {}", lit.what());
    compare(&what, 4 * found.width, all, 1.0);
    let without = reference::render::<f32>(&without.scene(volume, Some(&transfer))).unwrap();
    let pixels = || without.pixels.iter().zip(&single.pixels);
    let changed = pixels()
        .filter(|(a, b)| (a[0] - b[0]).abs() > 0.002)
        .count();
    assert!(
        20 * changed > found.pixels.len(),
        "{what}: {changed} pixels change"
    );
    assert!(pixels().all(|(a, b)| a[3] == b[3]), "{what}: opacity");
}

/// Each technique with each operator, beside a filter that reads something else or the same.
fn assert_gradients_drawn_as_computed(volume: &Volume, what: &str) {
    use GradientFilter::{Analytic, Central, Cubic, Linear, Sobel};
    let shots = oblique_shots(GRID(), Mode::Composite);
    let mut renderer = Renderer::new(device(), volume).unwrap();
    let [headlight, lights] = shadings();
    for (i, (filter, gradient_filter)) in [
        (Filter::Cubic, Linear),
        (Filter::Nearest, Sobel),
        (Filter::Linear, Cubic),
        (Filter::Cubic, Cubic),
        (Filter::Quadratic, Analytic),
        (Filter::CatmullRom, Analytic),
    ]
    .into_iter()
    .enumerate()
    {
        // One of the two placements of each technique, in one of the two projections.
        for technique in [0, 2, 4] {
            let shot = &shots[(technique + i % 2 + 6 * (i / 2 % 2)) % shots.len()];
            let small = PictureCase {
                extent: [24, 20],
                ..shot.clone()
            };
            let central = small.with(|settings| {
                settings.filter = filter;
                settings.shading = Some([&headlight, &lights][i % 2].clone());
                settings.gradient_filter = Central;
            });
            let other = central.with(|settings| settings.gradient_filter = gradient_filter);
            assert_changes(&mut renderer, volume, &central, &other, what);
        }
    }
}

/// The gradient of |p - c|^2 is nowhere zero where c lies outside, and bends everywhere.
fn bowl(p: DVec3) -> f64 {
    1e-3 * (p - dvec3(-12.0, -9.0, -14.0)).length_squared()
}

/// What is kept and what is made are the same up to half floats and the sampler's weights.
#[test]
fn kept_gradients_light_what_made_ones_light_in_bricks_too() {
    let volume = volume_of([17, 21, 14], DAffine3::IDENTITY, bowl);
    let transfer = one_color();
    let small = Caps {
        max_image_dimension_3d: 13,
        max_image_array_layers: 8,
        ..Caps::UNLIMITED
    };
    let diffuse = Shading {
        ambient: 0.0,
        diffuse: 1.0,
        specular: 0.0,
        ..Shading::default()
    };
    let shots = oblique_shots(volume.grid(), Mode::Composite);
    for (device, kinds) in [(device(), 3), (device_with(small), 1)] {
        let mut renderer = Renderer::new(device, &volume).unwrap();
        for (i, (filter, gradient_filter)) in [
            (Filter::Linear, GradientFilter::Central),
            (Filter::Cubic, GradientFilter::Linear),
            (Filter::Nearest, GradientFilter::Sobel),
        ]
        .into_iter()
        .take(kinds)
        .enumerate()
        {
            for technique in [0, 2, 4] {
                let small = PictureCase {
                    extent: [24, 20],
                    ..shots[technique + 6 * (i % 2)].clone()
                };
                let shot = small.with(|settings| {
                    settings.filter = filter;
                    settings.gradient_filter = gradient_filter;
                    settings.gradient_storage = GradientStorage::Precomputed;
                    settings.shading = Some(diffuse.clone());
                    settings.color_space = ColorSpace::Display;
                    settings.conformance = false;
                });
                let scene = shot.scene(&volume, Some(&transfer));
                let kept = renderer.render(&scene, &[]).unwrap().picture;
                let reference = reference::render::<f64>(&scene).unwrap();
                let mut worst = Worst::new(format!("{filter:?}, {}", shot.what()));
                for (pixel, (a, b)) in shot.pixels().zip(kept.pixels.iter().zip(&reference.pixels))
                {
                    if b[3] < 0.01 {
                        continue;
                    }
                    if (a[3] - b[3]).abs() > 1e-3 {
                        worst.leave_out();
                        continue;
                    }
                    // A half is off by 2^-11 of a component, which neighbours have up to 1.4 times of; a weight by
                    // 2^-9 of what lies between neighbours, half of the gradient at the edge, along three axes:
                    // together 7e-4 + 17e-4 of the normal, and as much of its cosine.
                    worst.take(pixel, f64::from(a[0] / a[3] - b[0] / b[3]), 2.5e-3);
                }
                worst.assert_holds();
            }
        }
    }
}

#[test]
fn gradients_are_kept_where_they_can_be_and_made_or_refused_elsewhere() {
    let whole = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let shot = &oblique_shots(GRID(), Mode::Composite)[0];
    for (volume, gradient_filter, conformance, reason) in [
        (&whole, GradientFilter::Central, true, "conformance"),
        (&whole, GradientFilter::Cubic, false, "trilinear"),
        (&with_holes(), GradientFilter::Central, false, "no data"),
    ] {
        let mut renderer = Renderer::new(device(), volume).unwrap();
        let mut drawn = |keep| {
            let shot = shot.with(|settings| {
                settings.shading = Some(Shading::default());
                settings.gradient_storage = keep;
                settings.gradient_filter = gradient_filter;
                settings.conformance = conformance;
            });
            let scene = shot.scene(volume, Some(&transfer));
            let reference = reference::render::<f32>(&scene).err();
            let drawn = renderer.render(&scene, &[]);
            let drawn = drawn.map(|drawn| drawn.picture.pixels);
            (
                drawn.map_err(|e| e.to_string()),
                reference.map(|e| e.to_string()),
            )
        };
        let (refused, by_reference) = drawn(GradientStorage::Precomputed);
        let refused = refused.expect_err("refused");
        assert!(refused.contains(reason), "{refused}");
        assert_eq!(by_reference, Some(refused));
        let [auto, made] = [GradientStorage::Auto, GradientStorage::OnTheFly]
            .map(|keep| drawn(keep).0.expect("drawn"));
        assert_eq!(auto, made, "{reason}");
    }
}

#[test]
fn every_gradient_filter_lights_what_its_reference_lights_whatever_the_filter() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    assert_gradients_drawn_as_computed(&volume, "whole");
}

#[test]
fn every_gradient_filter_is_dark_where_a_voxel_with_a_weight_has_no_data() {
    assert_gradients_drawn_as_computed(&with_holes(), "with holes");
}

#[test]
fn every_technique_and_filter_lights_what_its_reference_lights() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    assert_drawn_as_computed(&volume, "whole");
}

#[test]
fn each_technique_draws_light_of_the_camera_with_a_half_gradient_as_its_reference() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    assert_steady_light_drawn_as_computed(&volume, "whole");
}

#[test]
fn a_gradient_with_a_hole_in_it_is_dark_on_the_device_as_in_the_reference() {
    assert_drawn_as_computed(&with_holes(), "with holes");
}

fn with_holes() -> Volume {
    let mut volume = volume_of(GRID().dims, sheared_affine(), waves);
    let count = volume.dims.iter().product::<u32>();
    volume.validity = Some((0..count).map(|i| u8::from(i % 499 != 7)).collect());
    volume
}

/// The colour of a surface in f64, written a second time: `sampling.md` 7 word by word.
fn phong(shading: &Shading, color: DVec3, normal: DVec3, to_eye: DVec3) -> DVec3 {
    let mut lit = shading.ambient * color;
    let headlight = Light::of_world(to_eye, [1.0; 3]);
    let lights = if shading.lights.is_empty() {
        &[headlight][..]
    } else {
        &shading.lights
    };
    for light in lights {
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
    let [headlight, lights] = shadings();
    assert_shines(slope, &headlight);
    // Towards the eye and away from it: only light on both sides is the same on both.
    assert_shines(-slope, &headlight);
    assert_shines(slope, &lights);
}

fn assert_shines(slope: DVec3, shading: &Shading) {
    let center = GRID().center();
    let affine = sheared_affine();
    let value = |p| 0.5 + slope.dot(affine.transform_point3(p) - center);
    let volume = volume_of(GRID().dims, affine, value);
    let transfer = one_color();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
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
            assert_has_normal(&shot, shading, &found, slope);
        }
    }
}

const COLOR: DVec3 = dvec3(0.6, 0.3, 0.45);

fn one_color() -> TransferFunction {
    TransferFunction {
        color: vec![ColorPoint {
            value: 0.5,
            srgb: COLOR.to_array(),
        }],
        ..ramps()
    }
}

/// Every pixel that shows anything has the colour of a surface across `slope`.
fn assert_has_normal(shot: &PictureCase, shading: &Shading, found: &Picture, slope: DVec3) {
    let conformance = shot.settings.conformance;
    let mut worst = Worst::new(format!("conformance {conformance}, {}", shot.what()));
    let m = sheared_affine().matrix3;
    let voxel = m.transpose() * slope;
    // Voxel gradients, directions for covectors, the inverse not transposed.
    let mistakes = [voxel, m * voxel, m.inverse() * voxel];
    let mut mistaken = [0.0f64; 3];
    let rays = shot.camera.rays(shot.extent);
    for (i, [x, y]) in shot.pixels().enumerate() {
        let [r, g, b, alpha] = found.pixels[i].map(f64::from);
        if alpha < 0.01 {
            continue;
        }
        let (_, along) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let lit = |normal: DVec3| phong(shading, COLOR, normal.normalize(), -along.normalize());
        let wanted = lit(slope);
        for error in (dvec3(r, g, b) / alpha - wanted).to_array() {
            worst.take([x, y], error, tolerance(conformance));
        }
        for (most, normal) in mistaken.iter_mut().zip(mistakes) {
            *most = most.max((lit(normal) - wanted).abs().max_element());
        }
    }
    worst.assert_holds();
    assert!(
        mistaken.iter().all(|&m| m > 0.01),
        "{mistaken:?} tells nothing"
    );
}

/// Conformance: A18. Else a table's cell rounds the opacity of both the colour and alpha alike, and the device's
/// filter slips alike on both sides of a difference where the field is even, up to f32: values of about 1 are
/// stored to 6e-8, a difference of 0.04 is off by 2 * 6e-8 / 0.04 = 3e-6 for each of a fetch and a filter, times
/// the steepest change of the light with the normal, shininess * specular + diffuse = 10.
fn tolerance(conformance: bool) -> f64 {
    if conformance { 1e-5 } else { 6e-5 }
}

#[test]
fn a_field_of_one_value_has_no_surface_whatever_makes_gradients() {
    let volume = volume_of(GRID().dims, sheared_affine(), |_| 0.7);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let transfer = ramps();
    let shot = &oblique_shots(GRID(), Mode::Composite)[0];
    let by = |filter, gradient_filter| {
        shot.with(|settings| {
            settings.filter = filter;
            settings.gradient_filter = gradient_filter;
        })
    };
    let shots = [
        by(Filter::Cubic, GradientFilter::Central),
        by(Filter::CatmullRom, GradientFilter::Central),
        by(Filter::Linear, GradientFilter::Sobel),
        by(Filter::Linear, GradientFilter::Cubic),
        by(Filter::CubicSmooth, GradientFilter::Analytic),
    ];
    for shot in shots {
        for conformance in [false, true] {
            let dark = shot.with(|s| s.conformance = conformance);
            let lit = dark.with(|s| s.shading = Some(Shading::default()));
            let [dark, lit] = [&dark, &lit].map(|shot| {
                let scene = shot.scene(&volume, Some(&transfer));
                renderer.render(&scene, &[]).unwrap().picture
            });
            Worst::between(shot.what(), dark.width, &dark.pixels, &lit.pixels, 1e-6).assert_holds();
        }
    }
}
