//! Light on slabs and on samples between slices: one gradient, in their middle.
//!
//! Where a value runs linearly, its gradient is one everywhere, and light from afar makes one colour of another: a lit
//! picture is that of the function of these colours, whatever the steps. Elsewhere what is left out falls with the square
//! of the step.

use super::slabs_references::{DIMS, assert_bricks_leave, check, shot, ways, with_holes};
use crate::shared::{
    Worst, device, inner_box, oblique_camera, projections, ramps, sheared_affine, straight_shots,
    volume_of, waves,
};
use glam::{DAffine3, dvec3};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::ColorSpace;
use stratavox::technique::{
    AmbientOcclusion, ClipPlane, CutFaces, Filter, FilterBy, GradientFilter, Lattice, Light, Mode,
    Settings, Shading, Technique,
};
use stratavox::transfer::TransferFunction;
use stratavox::volume::{Rescale, Volume, Voxels};

fn lights() -> Shading {
    Shading {
        ambient: 0.2,
        diffuse: 0.5,
        specular: 0.4,
        shininess: 23.0,
        lights: vec![
            Light::of_world(dvec3(1.0, -2.0, 0.7), [1.0, 0.9, 0.8]),
            Light::of_world(dvec3(-0.3, 0.2, 3.0), [0.2, 0.3, 0.6]),
        ],
        half_gradient: 0.05,
        ..Shading::default()
    }
}

/// The ways of `slabs_references` that are not of points, lit: by the headlight, by lights of the world, occluded.
fn lit_ways() -> Vec<Settings> {
    let ways = ways().into_iter().filter(|s| s.preintegrated || s.smooth);
    let lit = |(turn, mut settings): (usize, Settings)| {
        settings.shading = (turn % 4 != 3).then(|| match turn % 2 {
            0 => lights(),
            _ => Shading::default(),
        });
        settings.ambient_occlusion = (turn % 4 > 1).then_some(AmbientOcclusion {
            strength: 0.8,
            radius_world: None,
        });
        settings
    };
    ways.enumerate().map(lit).collect()
}

#[test]
fn lit_slabs_and_samples_between_slices_are_drawn_as_their_references_compute_them() {
    let volumes = [volume_of(DIMS, sheared_affine(), waves), with_holes()];
    let mut renderers = volumes
        .each_ref()
        .map(|volume| Renderer::new(device(), volume).unwrap());
    let grid = volumes[0].grid();
    let cameras = projections(&grid).map(|p| oblique_camera(&grid, p));
    let transfer = ramps();
    for (turn, settings) in lit_ways().into_iter().enumerate() {
        let nearest = Settings {
            filter: Filter::Nearest,
            ..settings.clone()
        };
        for settings in [settings, nearest] {
            let (volume, renderer) = (&volumes[turn % 2], &mut renderers[turn % 2]);
            let shot = shot(cameras[turn % 2], settings, volume);
            check(renderer, volume, &ramps(), &shot);
            let dark = shot.with(|settings| {
                settings.shading = None;
                settings.ambient_occlusion = None;
            });
            let [lit, dark] = [&shot, &dark].map(|shot| {
                let scene = shot.scene(volume, Some(&transfer));
                reference::render::<f32>(&scene).unwrap().pixels
            });
            let pixels = || lit.iter().zip(&dark);
            let changed = pixels().filter(|(a, b)| (a[0] - b[0]).abs() > 0.002);
            assert!(20 * changed.count() > lit.len(), "{}", shot.what());
            assert!(pixels().all(|(a, b)| a[3] == b[3]), "{}", shot.what());
        }
    }
}

#[test]
fn a_field_that_rises_evenly_is_lit_as_the_function_of_lit_colors_is_drawn() {
    let volume = volume_of(DIMS, DAffine3::IDENTITY, |p| {
        0.04 * p.x + 0.03 * p.y - 0.02 * p.z + 0.2
    });
    let grid = volume.grid();
    let camera = oblique_camera(&grid, projections(&grid)[0]);
    let [low, high] = inner_box(&grid);
    let shading = lights();
    let normal = dvec3(0.04, 0.03, -0.02).normalize();
    let gradient = dvec3(0.04, 0.03, -0.02).length();
    let view = (camera.eye - camera.target).normalize();
    // Blinn and Phong of one colour, and the part of it that counts.
    let lit = |color: [f64; 3]| {
        let mut sum = color.map(|c| shading.ambient * c);
        for light in &shading.lights {
            let towards = light.towards.normalize();
            let halfway = (towards + view).normalize();
            let diffuse = shading.diffuse * normal.dot(towards).abs();
            let specular = shading.specular * normal.dot(halfway).abs().powf(shading.shininess);
            for c in 0..3 {
                sum[c] += light.srgb[c] * (diffuse * color[c] + specular);
            }
        }
        let surface = gradient / (gradient + shading.half_gradient);
        std::array::from_fn(|c| (1.0 - surface) * color[c] + surface * sum[c])
    };
    let function = TransferFunction {
        color: vec![stratavox::transfer::ColorPoint {
            value: 0.0,
            srgb: [0.5, 0.3, 0.2],
        }],
        ..ramps()
    };
    let mut of_lit = function.clone();
    for point in &mut of_lit.color {
        point.srgb = lit(point.srgb);
    }
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let mut worst = Worst::new("lit slabs of an even field");
    for mut settings in ways().into_iter().filter(|s| s.preintegrated || s.smooth) {
        settings.color_space = ColorSpace::Display;
        // Differences over the border of the grid are not those of the field.
        settings.crop = Some([low + 1.0, high - 1.0]);
        let dark = shot(camera, settings, &volume);
        let bright = dark.with(|settings| settings.shading = Some(lights()));
        let wanted = reference::render::<f64>(&dark.scene(&volume, Some(&of_lit))).unwrap();
        let found = renderer
            .render(&bright.scene(&volume, Some(&function)), &[])
            .unwrap()
            .picture;
        let pixels = wanted.pixels.iter().zip(&found.pixels);
        assert!(wanted.pixels.iter().any(|pixel| pixel[3] > 0.2));
        for (i, (wanted, found)) in pixels.enumerate() {
            let at = [i as u32 % dark.extent[0], i as u32 / dark.extent[0]];
            for c in 0..4 {
                // Colours, and gradients by differences of f32 values over two voxels.
                worst.take(at, f64::from((wanted[c] - found[c]).abs()), 1e-5);
            }
        }
    }
    worst.assert_holds();
}

/// Of a smooth field, in f64: twice as many slabs leave a quarter of what one gradient a slab leaves out.
#[test]
fn what_one_gradient_a_slab_leaves_out_falls_with_the_square_of_the_step() {
    let volume = volume_of([24; 3], DAffine3::IDENTITY, |p| {
        let q = (p - 12.0) / 12.0;
        (-1.5 * q.length_squared()).exp()
    });
    let grid = volume.grid();
    let camera = oblique_camera(&grid, projections(&grid)[0]);
    let transfer = ramps();
    let picture = |samples_per_voxel: f64| {
        let settings = Settings {
            preintegrated: true,
            shading: Some(lights()),
            samples_per_voxel,
            color_space: ColorSpace::Display,
            filter: Filter::Linear,
            termination: 0.0,
            ..Settings::default()
        };
        let shot = shot(camera, settings, &volume);
        let scene = shot.scene(&volume, Some(&transfer));
        reference::render::<f64>(&scene).unwrap().pixels
    };
    let fine = picture(32.0);
    let rms = |samples: f64| {
        let coarse = picture(samples);
        let pairs = coarse.as_flattened().iter().zip(fine.as_flattened());
        let squares: f64 = pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum();
        (squares / fine.as_flattened().len() as f64).sqrt()
    };
    let [one, two, four] = [1.0, 2.0, 4.0].map(rms);
    println!("rms at 1, 2, 4 slabs a voxel: {one:.2e}, {two:.2e}, {four:.2e}");
    // A trilinear field has kinks, at which a middle stands for less: a third is left at most.
    assert!(one > 3.0 * two && two > 3.0 * four);
}

#[test]
fn bricks_leave_lit_slabs_bit_identical() {
    // What comes through to slabs is added up brick by brick, and rounded: `occlusion.rs`.
    let lit = |settings| Settings {
        ambient_occlusion: None,
        ..settings
    };
    assert_bricks_leave(lit_ways().into_iter().map(lit).collect());
}

#[test]
fn a_smooth_stack_without_planes_between_is_lit_as_the_classic_one_to_the_bit() {
    let volume = volume_of([16; 3], DAffine3::IDENTITY, waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let shots = straight_shots(volume.grid(), Mode::Composite).into_iter();
    let mut of_stacks = shots.filter(|shot| shot.settings.technique == Technique::Slices2d);
    let classic = of_stacks.next().unwrap();
    let classic = classic.with(|settings| settings.shading = Some(lights()));
    let smooth = classic.with(|settings| settings.smooth = true);
    let transfer = ramps();
    let [classic, smooth] = [classic, smooth].map(|shot| {
        let scene = shot.scene(&volume, Some(&transfer));
        renderer.render(&scene, &[]).unwrap().picture.pixels
    });
    assert!(classic.iter().any(|pixel| pixel[3] > 0.1));
    assert!(classic == smooth);
}

/// By footprint texels and by the sampler: the same but for its weights of eight bits.
#[test]
fn footprint_texels_light_slabs_as_the_sampler_does() {
    let volume = volume_of(DIMS, sheared_affine(), |p| (60_000.0 * waves(p)).round());
    let Voxels::F32(numbers) = &volume.voxels else {
        panic!("32-bit floats");
    };
    let codes = Voxels::U16(numbers.iter().map(|&n| n as u16).collect());
    let rescale = Rescale {
        slope: 1.0 / 60_000.0,
        ..Rescale::default()
    };
    let volume = Volume::from_voxels(DIMS, sheared_affine(), codes, rescale, None).unwrap();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[1]);
    let transfer = ramps();
    for lattice in [Lattice::Ray, Lattice::Planes] {
        for shading in [None, Some(lights())] {
            let settings = Settings {
                preintegrated: true,
                lattice,
                shading,
                ..Settings::default()
            };
            let texels = shot(camera, settings, &volume);
            let sampler = texels.with(|settings| settings.filter_by = FilterBy::Sampler);
            let [texels, sampler] = [texels, sampler].map(|shot| {
                let scene = shot.scene(&volume, Some(&transfer));
                renderer.render(&scene, &[]).unwrap().picture.pixels
            });
            let pairs = texels.as_flattened().iter().zip(sampler.as_flattened());
            let most = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(most < 0.02, "{lattice:?}: {most}");
        }
    }
}

#[test]
fn cut_faces_of_slabs_are_not_lit() {
    let volume = volume_of(DIMS, sheared_affine(), waves);
    let grid = volume.grid();
    let camera = oblique_camera(&grid, projections(&grid)[1]);
    let middle = grid.world_from_voxel.transform_point3(grid.center());
    let normal = (camera.target - camera.eye).normalize();
    let settings = Settings {
        preintegrated: true,
        conformance: true,
        shading: Some(lights()),
        clip_planes: vec![ClipPlane {
            normal,
            offset: normal.dot(middle),
        }],
        cut_faces: Some(CutFaces::Own),
        ..Settings::default()
    };
    let shot = shot(camera, settings, &volume);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    check(&mut renderer, &volume, &ramps(), &shot);
}

#[test]
fn gradient_filters_light_slabs_of_rays_and_are_refused_between_slices() {
    let volume = volume_of(DIMS, sheared_affine(), waves);
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[1]);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for mut settings in ways().into_iter().filter(|s| s.preintegrated || s.smooth) {
        settings.shading = Some(lights());
        settings.gradient_filter = GradientFilter::Sobel;
        if settings.technique == Technique::Slices2d {
            let error = settings.check().unwrap_err().to_string();
            assert!(error.contains("a gradient filter"), "{error}");
            continue;
        }
        check(
            &mut renderer,
            &volume,
            &ramps(),
            &shot(camera, settings, &volume),
        );
    }
}
