//! Pre-integrated classification against integrals in closed form (`sampling.md` 10, A13 and its like).
//!
//! Where a value runs linearly along a ray from f0 to f1 over the length L, whatever the steps,
//!
//! ```text
//! tau = L (T(f1) - T(f0)) / (f1 - f0)         alpha = 1 - exp(-tau)
//! ```
//!
//! with T the integral of -ln(1 - a)/d0 over the value; for an opacity that runs straight from a0 to a1 that is
//! ((1 - a) ln(1 - a) + a) / d0 between both, over their slope.

use crate::shared::{
    Chord, PictureCase, Worst, device, inner_box, oblique_camera, projections, volume_of, waves,
};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{ColorSpace, Picture};
use stratavox::technique::{Lattice, Order, Settings, Technique};
use stratavox::transfer::{
    Absorption, ColorPoint, Interpolation, OpacityPoint, SlabTable, TransferFunction, classify_slab,
};
use stratavox::volume::Grid;

fn function(opacity: &[(f64, f64)], interpolation: Interpolation) -> TransferFunction {
    let opacity = opacity.iter();
    TransferFunction {
        color: vec![
            ColorPoint {
                value: 0.1,
                srgb: [0.9, 0.2, 0.6],
            },
            ColorPoint {
                value: 0.8,
                srgb: [0.3, 1.0, 0.6],
            },
        ],
        opacity: opacity
            .map(|&(value, opacity)| OpacityPoint { value, opacity })
            .collect(),
        reference_length: Some(1.0),
        interpolation,
        gradient_transfer: None,
        medium: None,
    }
}

/// Ramps, a spike far thinner than what a step passes, jumps, opaque matter.
fn functions() -> Vec<TransferFunction> {
    use Interpolation::{Linear, Step};
    vec![
        function(&[(0.2, 0.0), (0.6, 0.15), (0.9, 0.4)], Linear),
        function(&[(0.433, 0.0), (0.437, 0.98), (0.441, 0.0)], Linear),
        function(&[(0.3, 0.0), (0.45, 0.3), (0.46, 0.02), (0.7, 0.2)], Step),
        function(&[(0.5, 0.0), (0.5, 0.2), (0.62, 0.2), (0.62, 0.05)], Linear),
        function(&[(0.3, 0.0), (0.8, 1.0)], Linear),
    ]
}

/// T at a value.
fn integral(function: &TransferFunction, value: f64) -> f64 {
    let points = &function.opacity;
    let of = |a: f64| a.min(stratavox::transfer::MAX_OPACITY);
    let extinction = |a: f64| -(1.0 - of(a)).ln();
    let first = points[0];
    if value <= first.value {
        return (value - first.value) * extinction(first.opacity);
    }
    let mut sum = 0.0;
    for pair in points.windows(2) {
        let (start, end) = (pair[0].value, pair[1].value.min(value));
        if end <= start {
            continue;
        }
        let slope = (pair[1].opacity - pair[0].opacity) / (pair[1].value - start);
        let ends = [pair[0].opacity, pair[0].opacity + slope * (end - start)];
        sum += match function.interpolation {
            Interpolation::Linear if slope != 0.0 => {
                let primitive = |a: f64| {
                    // From the limit on extinction is constant.
                    let beyond = (a - of(a)) * extinction(a);
                    let a = of(a);
                    (1.0 - a) * (1.0 - a).ln() + a + beyond
                };
                (primitive(ends[1]) - primitive(ends[0])) / slope
            }
            _ => (end - start) * extinction(ends[0]),
        };
    }
    let last = points[points.len() - 1];
    sum + (value - last.value).max(0.0) * extinction(last.opacity)
}

fn table_of(function: &TransferFunction) -> SlabTable {
    let absorption = Absorption::Extinction {
        reference_length: 1.0,
    };
    SlabTable::new(function, absorption, ColorSpace::Linear)
}

#[test]
fn the_table_knows_the_integral_between_any_two_values() {
    let mut seed = 1u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(seed >> 8) / 16_777_216.0
    };
    for (nth, function) in functions().iter().enumerate() {
        let table = table_of(function);
        for _ in 0..4000 {
            let front = -0.3 + 1.6 * random();
            let back = front + (random() - 0.5) * 10f64.powi(-((random() * 4.0) as i32));
            let (front, back) = (front as f32, back as f32);
            let (f, b) = (f64::from(front), f64::from(back));
            let wanted = (integral(function, b) - integral(function, f)) / (b - f);
            if (b - f).abs() < 1e-3 {
                continue;
            }
            // A cell is w wide; inside of it extinction is a line, which misses a jump by w/4 of its height at most.
            let width = 1.0 / f64::from(table.scale);
            let highest = 8.4;
            let allowed = 2e-6 * wanted + 0.25 * width * highest / (b - f).abs();
            for (found, precision) in [
                (classify_slab(&table, front, back)[3].into(), "f32"),
                (classify_slab(&table, f, b)[3], "f64"),
            ] {
                let off: f64 = found - wanted;
                assert!(
                    off.abs() <= allowed,
                    "function {nth} {precision}: from {front} to {back} {found}, wanted {wanted}, allowed {allowed:e}"
                );
            }
            assert_eq!(
                classify_slab(&table, front, back),
                classify_slab(&table, back, front)
            );
        }
    }
}

/// Rays, planes, stacks; one sample a voxel and one in two.
fn slabs() -> Vec<Settings> {
    let way = |technique, lattice, samples_per_voxel, smooth| Settings {
        technique,
        lattice,
        samples_per_voxel,
        smooth,
        preintegrated: true,
        conformance: true,
        color_space: ColorSpace::Display,
        ..Settings::default()
    };
    use Technique::*;
    vec![
        way(Raycast, Lattice::Ray, 1.0, false),
        way(Raycast, Lattice::Ray, 0.23, false),
        way(Raycast, Lattice::Planes, 0.5, false),
        way(Raycast, Lattice::Jitter, 0.5, false),
        way(Slices3d, Lattice::Ray, 0.5, false),
        way(Slices2d, Lattice::Ray, 1.0, false),
        Settings {
            order: Order::FrontToBack,
            ..way(Slices2d, Lattice::Ray, 1.7, true)
        },
    ]
}

fn straight(n: u32) -> Grid {
    Grid {
        dims: [n; 3],
        world_from_voxel: DAffine3::IDENTITY,
    }
}

/// The field rises along a direction that no axis is; on a box in which trilinear interpolation is the field.
#[test]
fn linear_fields_are_exact_at_any_step_with_any_function() {
    let grid = straight(20);
    let field = |p: DVec3| (p - 10.0).dot(dvec3(0.031, -0.042, 0.025)) + 0.5;
    let volume = volume_of(grid.dims, grid.world_from_voxel, field);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for projection in projections(&grid) {
        let camera = oblique_camera(&grid, projection);
        for settings in slabs() {
            let settings = Settings {
                crop: Some(inner_box(&grid)),
                ..settings
            };
            let shot = PictureCase {
                grid,
                camera,
                extent: [32, 28],
                settings,
            };
            let is_perspective = matches!(projection, Projection::Perspective { .. });
            // Every other function in each projection.
            let mine = functions().into_iter().enumerate();
            for (nth, function) in mine.filter(|(nth, _)| (nth % 2 == 0) == is_perspective) {
                let function = &function;
                let scene = shot.scene(&volume, Some(function));
                let device = renderer.render(&scene, &[]).unwrap().picture;
                let reference = reference::render::<f64>(&scene).unwrap();
                for (picture, name) in [(device, "device"), (reference, "f64 reference")] {
                    linear_field(
                        &shot,
                        function,
                        field,
                        &picture,
                        &format!("{name}, function {nth}"),
                    );
                }
            }
        }
    }
}

fn linear_field(
    shot: &PictureCase,
    function: &TransferFunction,
    field: impl Fn(DVec3) -> f64,
    picture: &Picture,
    what: &str,
) {
    let mut worst = Worst::new(format!("A13 {what}, {}", shot.what()));
    let width = 1.0 / f64::from(table_of(function).scale);
    for (pixel, found) in shot.pixels().zip(&picture.pixels) {
        let Some(chord) = Chord::of(shot, pixel) else {
            worst.take(pixel, found[3].into(), 0.0);
            continue;
        };
        let [f0, f1] = [chord.enter, chord.leave].map(|t| field(chord.at(t)));
        let length = chord.leave - chord.enter;
        let rise = (f1 - f0) / length;
        if rise.abs() < 1e-3 {
            // Along the field every slab is one value, and a value at a jump is on either side of it.
            worst.leave_out();
            continue;
        }
        let depth = (integral(function, f1) - integral(function, f0)) / rise;
        let extinction = |f: f64| -(1.0 - function.opacity(f).min(0.99976)).ln();
        // What the ends of the chord add or take as they move in f32, and what a cell does not know at both ends.
        let at_ends = extinction(f0).max(extinction(f1));
        let ends = 2.0 * chord.blur * at_ends + 0.5 * width / rise.abs() * at_ends;
        let allowed = 1e-5 + ends * (-depth).exp();
        worst.take(pixel, f64::from(found[3]) + (-depth).exp_m1(), allowed);
    }
    worst.assert_holds();
}

/// From 0 to 1 within one voxel, a spike between: samples a voxel apart never see it.
#[test]
fn a_spike_inside_one_voxel_has_its_whole_depth() {
    let grid = straight(8);
    let volume = volume_of(grid.dims, grid.world_from_voxel, |p| f64::from(p.z > 4.0));
    let spike = &functions()[1];
    let depth = integral(spike, 1.0) - integral(spike, 0.0);
    let camera = Camera {
        eye: grid.center() - dvec3(0.0, 0.0, 20.0),
        target: grid.center(),
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 8.0 },
        zoom: 1.0,
    };
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let mut plain = 0.0;
    for settings in slabs() {
        // Slabs end at the centres of voxels: a ray is cut there, planes and slices lie so.
        let crop = [dvec3(0.0, 0.0, 0.5), dvec3(8.0, 8.0, 7.5)];
        if settings.samples_per_voxel != 1.0 {
            continue;
        }
        let settings = Settings {
            crop: Some(crop),
            ..settings
        };
        let shot = PictureCase {
            grid,
            camera,
            extent: [16, 16],
            settings,
        };
        let found = renderer
            .render(&shot.scene(&volume, Some(spike)), &[])
            .unwrap()
            .picture;
        let mut worst = Worst::new(format!("a spike, {}", shot.what()));
        for (pixel, found) in shot.pixels().zip(&found.pixels) {
            worst.take(pixel, f64::from(found[3]) + (-depth).exp_m1(), 1e-5);
        }
        worst.assert_holds();
        let point = shot.with(|settings| settings.preintegrated = false);
        let found = renderer
            .render(&point.scene(&volume, Some(spike)), &[])
            .unwrap()
            .picture;
        plain += found.pixels[120][3];
    }
    assert_eq!(
        plain, 0.0,
        "single samples must miss the spike, or this proves nothing"
    );
}

/// The furnace: in front of a background of its own colour a medium is not seen (A6), and nothing shines more than
/// its colour, however opaque a slab is. Without the attenuation inside a slab both fail.
#[test]
fn one_colour_stays_that_colour_whatever_the_density() {
    let grid = straight(16);
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    let color = [0.8, 0.5, 0.25];
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for (nth, function) in functions().into_iter().enumerate() {
        let function = TransferFunction {
            color: vec![ColorPoint {
                value: 0.0,
                srgb: color,
            }],
            ..function
        };
        for settings in slabs() {
            let camera = oblique_camera(&grid, projections(&grid)[1]);
            let shot = PictureCase {
                grid,
                camera,
                extent: [32, 28],
                settings,
            };
            let picture = renderer
                .render(&shot.scene(&volume, Some(&function)), &[])
                .unwrap()
                .picture;
            let mut worst = Worst::new(format!("A6 function {nth}, {}", shot.what()));
            for (pixel, found) in shot.pixels().zip(&picture.pixels) {
                for (c, wanted) in color.into_iter().enumerate() {
                    let seen = f64::from(found[c]) + (1.0 - f64::from(found[3])) * wanted;
                    worst.take(pixel, seen - wanted, 2e-6);
                }
            }
            worst.assert_holds();
        }
    }
}

/// The colour that leaves out the attenuation inside a slab, d times the mean emission, is what the ratio form is not.
#[test]
fn opaque_slabs_shine_no_more_than_their_colour() {
    let table = table_of(&functions()[4]);
    let length = 2.0;
    let mut cheap_is_over = false;
    for i in 0..100 {
        let (front, back) = (0.01 * f64::from(i), 0.9);
        let [red, green, _, extinction] = classify_slab(&table, front, back);
        let opacity = -(-extinction * length).exp_m1();
        for color in [red, green] {
            assert!((0.0..=1.0).contains(&(opacity * color)), "{front}: {color}");
            cheap_is_over |= length * extinction * color > 1.0;
        }
    }
    assert!(cheap_is_over, "no slab is opaque, this proves nothing");
}

/// A1 with slabs: they are cut to the domain, so the length is the chord itself on every lattice.
#[test]
fn a_uniform_medium_is_as_deep_as_its_chords() {
    let grid = straight(16);
    let volume = volume_of(grid.dims, grid.world_from_voxel, |_| 0.5);
    let function = function(&[(0.0, 0.1), (1.0, 0.1)], Interpolation::Linear);
    let extinction = -(0.9f64).ln();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for projection in projections(&grid) {
        for settings in slabs() {
            let camera = oblique_camera(&grid, projection);
            let shot = PictureCase {
                grid,
                camera,
                extent: [32, 28],
                settings,
            };
            let picture = renderer
                .render(&shot.scene(&volume, Some(&function)), &[])
                .unwrap()
                .picture;
            let mut worst = Worst::new(format!("A1 slabs, {}", shot.what()));
            for (pixel, found) in shot.pixels().zip(&picture.pixels) {
                let chord = Chord::of(&shot, pixel);
                let length = chord
                    .as_ref()
                    .map_or(0.0, |chord| chord.leave - chord.enter);
                let blur = chord.map_or(0.0, |chord| chord.blur);
                let wanted = -(-extinction * length).exp_m1();
                worst.take(
                    pixel,
                    f64::from(found[3]) - wanted,
                    5e-6 + 2.0 * blur * extinction,
                );
            }
            worst.assert_holds();
        }
    }
}

/// Both ways to classify tend to one picture, and slabs are off by a fourth when steps are halved.
#[test]
fn slabs_tend_to_the_picture_of_samples_with_order_two() {
    let grid = straight(16);
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    let smooth = function(&[(0.0, 0.05), (1.0, 0.35)], Interpolation::Linear);
    let camera = oblique_camera(&grid, projections(&grid)[0]);
    let picture = |samples_per_voxel: f64, preintegrated: bool| {
        let settings = Settings {
            samples_per_voxel,
            preintegrated,
            conformance: true,
            crop: Some(inner_box(&grid)),
            ..Settings::default()
        };
        let shot = PictureCase {
            grid,
            camera,
            extent: [24, 20],
            settings,
        };
        reference::render::<f64>(&shot.scene(&volume, Some(&smooth))).unwrap()
    };
    let limit = picture(64.0, false);
    let apart = |picture: Picture| {
        let both = picture
            .pixels
            .as_flattened()
            .iter()
            .zip(limit.pixels.as_flattened());
        let squares = both.map(|(a, b)| f64::from(a - b).powi(2));
        (squares.sum::<f64>() / limit.pixels.len() as f64).sqrt()
    };
    let errors = [1.0, 2.0, 4.0].map(|samples| apart(picture(samples, true)));
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.25, "order {order} in {errors:?}");
    }
}
