//! Emission and absorption against closed forms: A1 to A6 and A9 of the oracles, every placement of samples,
//! both projections, twins in f32 and f64, and the device.

mod shared;

use glam::DAffine3;
use shared::oracle::{
    atmosphere, constant_color, homogeneous, linear_density, order_of_convergence,
    quadratic_density,
};
use shared::{Device, Shot, Twin, Way, inner_box, oblique_shots, sheared_affine, straight_shots};
use stratavox::technique::{Mode, Settings};
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
        Box::new(Twin::<f64>::new()),
        Box::new(Twin::<f32>::new()),
        Box::new(Device),
    ]
}

fn all_shots() -> Vec<Shot> {
    let mut shots = oblique_shots(SHEARED(), Mode::Composite);
    shots.extend(straight_shots(STRAIGHT, Mode::Composite));
    shots
}

/// Without the outer half voxel, where the device holds the edge's value.
fn inner(shot: Shot) -> Shot {
    let crop = Some(inner_box(&shot.grid));
    Shot {
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
        quadratic_density(&Twin::<f64>::new(), &shot).assert_holds();
        quadratic_density(&Twin::<f32>::new(), &shot).assert_holds();
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
            let shot = Shot { settings, ..shot };
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
                let shot = Shot {
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
        atmosphere(&Twin::<f64>::new(), &shot).assert_holds();
        atmosphere(&Twin::<f32>::new(), &shot).assert_holds();
    }
}
