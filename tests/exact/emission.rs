//! Emission and absorption against closed forms: A1 to A6 and A9 of the oracles, every placement of samples,
//! both projections, CPU references in f32 and f64, and the device.

use crate::shared::oracle::{
    atmosphere, constant_color, homogeneous, linear_density, order_of_convergence,
    quadratic_density,
};
use crate::shared::{
    Device, PictureCase, Reference, Way, Worst, device, inner_box, oblique_shots, ramps,
    sheared_affine, straight_shots, volume_of, waves,
};
use glam::DAffine3;
use stratavox::color::decode_srgb;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::ColorSpace;
use stratavox::scene::Scene;
use stratavox::technique::{Mode, Settings};
use stratavox::transfer::ColorPoint;
use stratavox::volume::Grid;

const SHEARED: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};
const STRAIGHT: Grid = Grid {
    dims: [16, 18, 20],
    world_from_voxel: DAffine3::IDENTITY,
};

fn ways() -> [Box<dyn Way>; 3] {
    [
        Box::new(Reference::<f64>::new()),
        Box::new(Reference::<f32>::new()),
        Box::new(Device),
    ]
}

fn all_shots() -> Vec<PictureCase> {
    let mut shots = oblique_shots(SHEARED(), Mode::Composite);
    shots.extend(straight_shots(STRAIGHT, Mode::Composite));
    shots
}

/// Without the outer half voxel, where the device holds the edge's value.
fn inner(shot: PictureCase) -> PictureCase {
    let crop = Some(inner_box(&shot.grid));
    PictureCase {
        settings: Settings {
            crop,
            ..shot.settings
        },
        ..shot
    }
}

#[test]
fn a_homogeneous_cube_is_as_opaque_as_its_chords_are_long() {
    for way in ways() {
        for shot in all_shots() {
            homogeneous(&*way, &shot).assert_holds();
        }
    }
}

#[test]
fn a_linear_density_is_integrated_exactly() {
    for way in ways() {
        for shot in all_shots().into_iter().map(inner) {
            linear_density(&*way, &shot).assert_holds();
        }
    }
}

#[test]
fn a_quadratic_density_is_off_by_the_error_that_midpoints_make() {
    for way in ways() {
        for shot in straight_shots(STRAIGHT, Mode::Composite) {
            quadratic_density(&*way, &shot).assert_holds();
        }
    }
    // Between voxel centres the device interpolates: only a formula has a square there.
    for shot in oblique_shots(SHEARED(), Mode::Composite) {
        quadratic_density(&Reference::<f64>::new(), &shot).assert_holds();
        quadratic_density(&Reference::<f32>::new(), &shot).assert_holds();
    }
}

#[test]
fn rising_light_converges_with_the_square_of_the_step() {
    for way in ways() {
        for shot in all_shots() {
            // A fixed box of the world, away from the edges that only the device has.
            let far = shot.grid.far_corner();
            let crop = Some([glam::DVec3::ONE, far - 1.0]);
            let settings = Settings {
                crop,
                ..shot.settings.clone()
            };
            let shot = PictureCase { settings, ..shot };
            let [coarse, fine] = order_of_convergence(&*way, &shot);
            let order = (coarse / fine).log2();
            println!(
                "A4, {}, {}: order {order:.4}, errors {coarse:.2e} and {fine:.2e}",
                way.name(),
                shot.what()
            );
            assert!((order - 2.0).abs() <= 0.1, "order {order}");
        }
    }
}

#[test]
fn one_color_stays_that_color_at_any_density_and_step() {
    for way in ways() {
        for shot in all_shots() {
            for samples_per_voxel in [0.7, 1.0, 3.1] {
                let settings = Settings {
                    samples_per_voxel,
                    ..shot.settings.clone()
                };
                let shot = PictureCase {
                    settings,
                    ..shot.clone()
                };
                constant_color(&*way, &shot).assert_holds();
            }
        }
    }
}

#[test]
fn an_atmosphere_absorbs_as_its_integral_says() {
    for way in ways() {
        for shot in straight_shots(STRAIGHT, Mode::Composite) {
            atmosphere(&*way, &shot).assert_holds();
        }
    }
    for shot in oblique_shots(SHEARED(), Mode::Composite) {
        atmosphere(&Reference::<f64>::new(), &shot).assert_holds();
        atmosphere(&Reference::<f32>::new(), &shot).assert_holds();
    }
}

#[test]
fn a_furnace_looks_the_same_with_and_without_its_medium() {
    // A6: the background has the medium's colour, so the picture is that colour, and opaque, everywhere.
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let srgb = [0.9, 0.5, 0.2];
    let mut transfer = ramps();
    transfer.color = vec![ColorPoint { value: 0.0, srgb }];
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for color_space in [ColorSpace::Linear, ColorSpace::Display] {
        for shot in oblique_shots(SHEARED(), Mode::Composite) {
            let settings = Settings {
                color_space,
                ..shot.settings.clone()
            };
            let scene = Scene {
                beside: Default::default(),
                volume: &volume,
                transfer: Some(&transfer),
                camera: &shot.camera,
                extent_pixels: shot.extent,
                settings: &settings,
            };
            let pictures = [
                ("device", renderer.render(&scene, &[]).unwrap().picture),
                ("f32", reference::render::<f32>(&scene).unwrap()),
                ("f64", reference::render::<f64>(&scene).unwrap()),
            ];
            for (way, mut picture) in pictures {
                let seen = picture.pixels.iter().filter(|p| p[3] > 0.1).count();
                assert!(seen > 200, "the medium is in {seen} pixels only");
                picture.over_background([srgb[0], srgb[1], srgb[2], 1.0]);
                let color = match color_space {
                    ColorSpace::Linear => srgb.map(decode_srgb),
                    ColorSpace::Display => srgb,
                };
                let mut worst = Worst::new(format!("A6, {way}, {color_space:?}, {}", shot.what()));
                for (pixel, found) in shot.pixels().zip(&picture.pixels) {
                    for c in 0..3 {
                        worst.take(pixel, f64::from(found[c]) - color[c], 2e-6);
                    }
                    worst.take(pixel, f64::from(found[3]) - 1.0, 2e-6);
                }
                worst.assert_holds();
            }
        }
    }
}
