//! Voxels that are classified before they are interpolated.

use super::*;
use crate::shared::placements;
use glam::dvec3;
use stratavox::camera::{Camera, Projection};
use stratavox::technique::preclassified::preclassified;

/// Nothing but a thin spike half way up to 0.7, and an extinction of 3 above.
fn spike() -> TransferFunction {
    let dense = -(-3.0_f64).exp_m1();
    let points = [
        (0.0, 0.0),
        (0.433, 0.0),
        (0.437, 0.98),
        (0.441, 0.0),
        (0.7, 0.0),
        (0.7, dense),
        (1.0, dense),
    ];
    TransferFunction {
        opacity: points
            .map(|(value, opacity)| OpacityPoint { value, opacity })
            .into(),
        ..fog([1.0; 3], 0.0)
    }
}

/// A ramp from 0 to 1 between the centres of two voxels, seen along it, four samples to the way.
#[test]
fn a_spike_between_two_voxels_is_seen_by_slabs_alone_and_an_edge_as_the_mean_of_its_ends() {
    let volume = volume_of([4, 4, 2], DAffine3::IDENTITY, |p| p.z - 0.5);
    let function = spike();
    let classified = preclassified(&volume, &function, 1.0, ColorSpace::Linear).unwrap();
    let [red, green, blue, depth] = &classified;
    let others = [green, blue, depth];
    let center = volume.grid().center();
    let camera = Camera {
        eye: center - dvec3(0.0, 0.0, 9.0),
        target: center,
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 4.0 },
        zoom: 1.0,
    };
    // The way of f past a spike of width w and height a is linear there: its optical depth is the integral of
    // -ln(1 - opacity) over two straight lines, w / a (a + (1 - a) ln(1 - a)) each.
    let (width, height) = (0.004, 0.98_f64);
    let of_spike = 2.0 * width / height * (height + (1.0 - height) * (1.0 - height).ln());
    let mut values = renderer(&[&volume]);
    let mut materials = renderer(&[red, green, blue, depth]);
    // A stack has no samples between its slices.
    let rays = placements().into_iter().take(4);
    for settings in rays {
        let shot = PictureCase {
            grid: volume.grid(),
            camera,
            extent: [4, 4],
            settings,
        };
        let shot = shot.with(|settings| {
            settings.samples_per_voxel = 4.0;
            settings.crop = Some([dvec3(0.0, 0.0, 0.5), dvec3(4.0, 4.0, 1.5)]);
        });
        let post = scene(&shot, &volume, &function, Beside::Nothing);
        let pre = scene(&shot, red, &function, Beside::Classified(&others));
        let slabs = shot.clone().with(|settings| {
            settings.preintegrated = true;
            settings.conformance = false;
        });
        let exact = scene(&slabs, &volume, &function, Beside::Nothing);
        // The table of slabs has cells of its own width, of which the spike may lose a part.
        let cases = [
            ("pre", pictures(&mut materials, &pre), 1.5, 1e-5),
            ("post", pictures(&mut values, &post), 0.75, 1e-5),
            ("slabs", pictures(&mut values, &exact), 0.9 + of_spike, 2e-3),
        ];
        for (what, all, wanted, tolerance) in cases {
            for picture in all {
                for pixel in &picture.pixels {
                    let found = -f64::from(1.0 - pixel[3]).ln();
                    assert!(
                        (found - wanted).abs() < tolerance,
                        "{what}, {}: depth {found}, not {wanted}",
                        shot.what()
                    );
                    assert!((pixel[0] - pixel[3]).abs() < 1e-6, "white: {pixel:?}");
                }
            }
        }
    }
}

/// Opaque blue beside transparent red: what lies between is blue, because nothing of the red is there.
#[test]
fn a_transparent_voxel_gives_its_colour_to_none() {
    let volume = volume_of([8, 4, 2], DAffine3::IDENTITY, |p| (p.x - 0.5) % 2.0);
    let color = |value, srgb| ColorPoint { value, srgb };
    let opacity = |value, opacity| OpacityPoint { value, opacity };
    let function = TransferFunction {
        color: vec![color(0.0, [1.0, 0.0, 0.0]), color(1.0, [0.0, 0.0, 1.0])],
        opacity: vec![opacity(0.0, 0.0), opacity(1.0, 0.7)],
        ..fog([0.0; 3], 0.0)
    };
    let classified = preclassified(&volume, &function, 1.0, ColorSpace::Linear).unwrap();
    let [red, green, blue, depth] = &classified;
    let others = [green, blue, depth];
    let shot = oblique_shots(volume.grid(), Mode::Composite).swap_remove(0);
    let scene = scene(&shot, red, &function, Beside::Classified(&others));
    let picture = reference::render::<f64>(&scene).unwrap();
    let drawn = picture.pixels.iter().filter(|p| p[3] > 0.1);
    let mut count = 0;
    for pixel in drawn {
        let off = [pixel[0], pixel[1], pixel[2] - pixel[3]].map(f32::abs);
        assert!(off.iter().all(|&off| off < 1e-6), "{pixel:?}");
        count += 1;
    }
    assert!(count > 100, "only {count} pixels are drawn");
}

#[test]
fn classified_voxels_are_drawn_as_the_reference_draws_them() {
    let volume = with_holes(volume_of(GRID().dims, sheared_affine(), waves), 37);
    let function = TransferFunction {
        reference_length: Some(1.7),
        ..ramps()
    };
    for space in [ColorSpace::Linear, ColorSpace::Display] {
        let classified = preclassified(&volume, &function, 1.7, space).unwrap();
        let [red, green, blue, depth] = &classified;
        let others = [green, blue, depth];
        let mut renderer = renderer(&[red, green, blue, depth]);
        let shots = small_shots(GRID(), Mode::Composite).into_iter();
        for shot in shots
            .skip(usize::from(space == ColorSpace::Display))
            .step_by(2)
        {
            let shot = shot.with(|settings| settings.color_space = space);
            let scene = scene(&shot, red, &function, Beside::Classified(&others));
            let all = pictures(&mut renderer, &scene);
            let what = format!("classified, {space:?}, {}", shot.what());
            let drawn = all[1].pixels.iter().filter(|p| p[3] > 0.01).count();
            assert!(drawn > 100, "{what}: only {drawn} pixels are drawn");
            let lists = all.each_ref().map(|p| p.pixels.as_flattened());
            compare(&what, 4 * all[0].width, lists, 1.0);
        }
    }
}
