//! Quadratic, cubic and Catmull-Rom on a device: what their CPU references compute, the known errors, and what is refused.

use crate::shared::{
    Chord, PictureCase, Worst, compare, device, oblique_shots, ramps, sheared_affine, volume_of,
    waves,
};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{LayerKind, Picture};
use stratavox::resident::{GpuVolume, TextureLayout};
use stratavox::scene::{Beside, Channel, Scene};
use stratavox::technique::{Error, Filter, Mode, Role, Settings, Shading, Technique};
use stratavox::volume::field::{Field, MarschnerLobb};
use stratavox::volume::{Coefficients, Grid, Rescale, Spline, Volume, Voxels};

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};
const FILTERS: [Filter; 5] = [
    Filter::Quadratic,
    Filter::Cubic,
    Filter::QuadraticSmooth,
    Filter::CubicSmooth,
    Filter::CatmullRom,
];
const MODES: [Mode; 5] = [
    Mode::Composite,
    Mode::Mip,
    Mode::Minip,
    Mode::Average,
    Mode::Xray,
];

fn small(shot: PictureCase) -> PictureCase {
    let extent = [20, 18];
    PictureCase { extent, ..shot }
}

fn check(renderer: &mut Renderer, volume: &Volume, shot: &PictureCase) {
    let transfer = ramps();
    let scene = shot.scene(volume, Some(&transfer));
    let found = renderer.render(&scene, &[]).unwrap().picture;
    let double = reference::render::<f64>(&scene).unwrap();
    let single = reference::render::<f32>(&scene).unwrap();
    let what = format!("{:?}, {}", shot.settings.filter, shot.what());
    let all = [&double, &single, &found].map(|picture| picture.pixels.as_flattened());
    compare(&what, 4 * found.width, all, 1.0);
    let drawn = single.pixels.iter().filter(|p| p[3] > 0.01).count();
    assert!(drawn > 50, "{what}: only {drawn} pixels are drawn");
}

#[test]
fn every_technique_mode_and_filter_draws_what_its_reference_computes() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for mode in MODES {
        for shot in oblique_shots(GRID(), mode) {
            // One projection of the camera has all there is to filtering.
            let is_perspective = matches!(shot.camera.projection, Projection::Perspective { .. });
            if is_perspective == (mode == Mode::Composite) {
                for filter in FILTERS {
                    let shot = small(shot.with(|settings| settings.filter = filter));
                    check(&mut renderer, &volume, &shot);
                }
            }
        }
    }
}

#[test]
fn holes_and_codes_with_a_rescale_are_those_of_the_reference() {
    let values = volume_of(GRID().dims, sheared_affine(), waves).voxels;
    let codes = (0..values.len()).map(|i| (values.stored(i) * 4000.0 - 1024.0) as i16);
    let voxels = Voxels::I16(codes.collect());
    let rescale = Rescale {
        slope: 1.0 / 4000.0,
        intercept: 0.256,
    };
    // Few holes: of 64 voxels around a sample none may be one.
    let fill = f64::from(voxels.stored(1500));
    let volume = Volume::from_voxels(GRID().dims, sheared_affine(), voxels, rescale, Some(fill));
    let volume = volume.unwrap();
    assert!(volume.no_data_count() > 0);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for shot in oblique_shots(GRID(), Mode::Composite).into_iter().take(6) {
        for filter in [Filter::Quadratic, Filter::Cubic, Filter::CatmullRom] {
            let shot = small(shot.with(|settings| settings.filter = filter));
            check(&mut renderer, &volume, &shot);
        }
    }
}

#[test]
fn shaded_pictures_of_wide_filters_are_those_of_the_reference() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for shot in oblique_shots(GRID(), Mode::Composite).into_iter().take(6) {
        for filter in [Filter::Cubic, Filter::CatmullRom] {
            let shot = small(shot.with(|settings| {
                settings.filter = filter;
                settings.shading = Some(Shading::default());
            }));
            check(&mut renderer, &volume, &shot);
        }
    }
}

/// Voxels of side 2/39, the centres of the outermost at -1 and 1.
fn signal_affine() -> DAffine3 {
    DAffine3::from_scale_rotation_translation(
        DVec3::splat(1.0 / 19.5),
        glam::DQuat::IDENTITY,
        DVec3::splat(-1.0 - 0.5 / 19.5),
    )
}

/// One sample a ray: a slab of half a voxel, seen along z, is sampled in its middle.
fn signal_shot(slab: f64, filter: Filter) -> PictureCase {
    let bottom = 20.0 + 19.5 * slab;
    let far = 40.0;
    PictureCase {
        grid: Grid {
            dims: [40; 3],
            world_from_voxel: signal_affine(),
        },
        camera: Camera {
            eye: dvec3(0.0, 0.0, -3.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Orthographic { view_height: 1.6 },
            zoom: 1.0,
        },
        extent: [48, 48],
        settings: Settings {
            mode: Mode::Mip,
            filter,
            crop: Some([dvec3(0.0, 0.0, bottom), dvec3(far, far, bottom + 0.5)]),
            ..Settings::default()
        },
    }
}

#[test]
fn errors_on_the_signal_of_marschner_and_lobb_are_the_known_ones() {
    let field = MarschnerLobb::default();
    let at_voxel = |p: DVec3| field.value(signal_affine().transform_point3(p));
    let volume = volume_of([40; 3], signal_affine(), at_voxel);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for (filter, wanted) in [
        (Filter::Nearest, 0.0474),
        (Filter::Linear, 0.0328),
        (Filter::Quadratic, 0.0185),
        (Filter::Cubic, 0.0147),
        (Filter::QuadraticSmooth, 0.0391),
        (Filter::CubicSmooth, 0.0452),
        (Filter::CatmullRom, 0.0233),
    ] {
        let (mut squares, mut count) = (0.0, 0);
        for slab in 0..12 {
            let slab = -0.79 + 1.57 * f64::from(slab) / 11.0;
            let shot = signal_shot(slab, filter);
            let scene = shot.scene(&volume, Some(&transfer));
            let layers = [LayerKind::Value];
            let found = renderer.render(&scene, &layers).unwrap().picture;
            for (pixel, value) in shot.pixels().zip(&found.layers[0].values) {
                let chord = Chord::of(&shot, pixel).unwrap();
                assert_eq!(chord.samples.len(), 1);
                let point = chord.at(chord.samples[0].0);
                squares += (f64::from(*value) - field.value(point)).powi(2);
                count += 1;
            }
        }
        let found = (squares / f64::from(count)).sqrt();
        println!("{filter:?}: {found:.4}, known {wanted}");
        assert!(
            (found / wanted - 1.0).abs() < 0.03,
            "{filter:?}: {found}, wanted {wanted}"
        );
    }
}

#[test]
fn slices_of_a_stack_show_the_spline_through_the_whole_volume() {
    // At slice centres a stack's bicubic is the tricubic through the voxels: view-aligned planes of the same places.
    let grid = Grid {
        dims: [12, 10, 8],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let camera = Camera {
        eye: grid.center() - 20.0 * DVec3::Z,
        target: grid.center(),
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 11.0 },
        zoom: 1.0,
    };
    for filter in [Filter::Quadratic, Filter::Cubic, Filter::CatmullRom] {
        let mut picture = |technique| -> Picture {
            let settings = Settings {
                technique,
                filter,
                conformance: true,
                ..Settings::default()
            };
            let shot = PictureCase {
                grid,
                camera,
                extent: [32, 32],
                settings,
            };
            let scene = shot.scene(&volume, Some(&transfer));
            renderer.render(&scene, &[]).unwrap().picture
        };
        let wanted = picture(Technique::Slices3d);
        let found = picture(Technique::Slices2d);
        Worst::between(
            format!("{filter:?}"),
            32,
            &wanted.pixels,
            &found.pixels,
            1e-5,
        )
        .assert_holds();
    }
}

#[test]
fn a_volume_of_voxels_is_not_taken_for_coefficients() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let device = device();
    let layout = TextureLayout::Texture3d;
    let voxels = GpuVolume::new(device.gpu(), &volume, layout).unwrap();
    let made = Coefficients::new(&volume, Spline::Cubic, layout.filtered_axes());
    let cubic = GpuVolume::of_coefficients(device.gpu(), &made, layout).unwrap();
    for filter in FILTERS.into_iter().chain([Filter::Nearest, Filter::Linear]) {
        let shot = &oblique_shots(GRID(), Mode::Mip)[0];
        let shot = shot.with(|settings| settings.filter = filter);
        for made in [&voxels, &cubic] {
            let found = made.spline();
            let wrong = Error::WrongCoefficients { filter, found };
            let recorded = shot.view().recordings(made, None).map(|all| all.len());
            if filter.spline() == found {
                assert_eq!(recorded, Ok(1), "{filter:?}");
            } else {
                assert_eq!(recorded, Err(wrong), "{filter:?}");
            }
        }
    }
}

#[test]
fn several_volumes_are_refused_by_name_where_samples_are_mixed() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let other = [Channel {
        volume: &volume,
        transfer: Some(&transfer),
        role: Role::Numbers,
    }];
    let mut renderer = Renderer::several(device(), vec![&volume, &volume]).unwrap();
    for filter in FILTERS {
        for mode in [Mode::Composite, Mode::Mip] {
            let shot = &oblique_shots(GRID(), mode)[0];
            let shot = shot.with(|settings| settings.filter = filter);
            let scene = Scene {
                beside: Beside::Channels(&other),
                ..shot.scene(&volume, Some(&transfer))
            };
            let on_device = renderer.render(&scene, &[]).map(|found| found.picture);
            let on_cpu = reference::render::<f32>(&scene);
            if mode == Mode::Composite {
                let wanted = Error::FilterAlone { filter };
                assert_eq!(on_device.unwrap_err().to_string(), wanted.to_string());
                assert_eq!(on_cpu.unwrap_err(), wanted);
            } else {
                let (found, wanted) = (on_device.unwrap(), on_cpu.unwrap());
                let what = format!("two in one MIP, {filter:?}");
                Worst::between(what, found.width, &wanted.pixels, &found.pixels, 1e-5)
                    .assert_holds();
            }
        }
    }
}
