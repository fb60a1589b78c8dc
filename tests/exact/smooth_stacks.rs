//! Smooth 2D stacks: planes between slices, the cross-fade from stack to stack, popping; and the jitter of rays.

use crate::shared::{
    PictureCase, Worst, device, oblique_camera, projections, ramps, straight_shots, volume_of,
    waves,
};
use glam::{DAffine3, DVec3, dvec3};
use std::f64::consts::TAU;
use stratavox::blue_noise::jitter_of;
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::technique::slices_2d::{planes_per_slice, stack_shares};
use stratavox::technique::{Jitter, Lattice, Mode, Settings, Technique};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::{Grid, Volume};

fn cube(n: u32) -> Grid {
    Grid {
        dims: [n; 3],
        world_from_voxel: DAffine3::IDENTITY,
    }
}

/// So many degrees from the first axis towards the second, and a little from above.
fn turned(grid: &Grid, degrees: f64, tilt: f64) -> Camera {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let (down, level) = tilt.to_radians().sin_cos();
    let direction = dvec3(cos * level, sin * level, -down);
    Camera {
        eye: grid.center() - 100.0 * direction,
        target: grid.center(),
        up: DVec3::Z,
        projection: Projection::Orthographic {
            view_height: 1.2 * f64::from(grid.dims[0]),
        },
        zoom: 1.0,
    }
}

fn stacks(smooth: bool) -> Settings {
    Settings {
        technique: Technique::Slices2d,
        smooth,
        conformance: true,
        color_space: ColorSpace::Display,
        ..Settings::default()
    }
}

#[test]
fn without_planes_between_a_smooth_stack_is_the_classic_one_to_the_bit() {
    let volume = volume_of([16; 3], DAffine3::IDENTITY, waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let shot = straight_shots(volume.grid(), Mode::Composite)
        .into_iter()
        .find(|shot| shot.settings.technique == Technique::Slices2d)
        .unwrap();
    let smooth = shot.with(|settings| settings.smooth = true);
    assert_eq!(
        planes_per_slice(&smooth.view(), 2),
        1,
        "seen along the axis"
    );
    let transfer = ramps();
    let mut picture = |shot: &PictureCase| {
        let scene = shot.scene(&volume, Some(&transfer));
        renderer.render(&scene, &[]).unwrap().picture.pixels
    };
    let (classic, smooth) = (picture(&shot), picture(&smooth));
    assert!(classic.iter().any(|pixel| pixel[3] > 0.1));
    assert_eq!(classic, smooth);
}

#[test]
fn samples_keep_their_distance_however_the_eye_turns() {
    let grid = cube(16);
    for samples in [1.0, 2.0, 3.0] {
        for degrees in 0..45 {
            let settings = Settings {
                samples_per_voxel: samples,
                ..stacks(true)
            };
            let camera = turned(&grid, degrees.into(), 0.0);
            let shot = PictureCase {
                grid,
                camera,
                extent: [8, 8],
                settings,
            };
            let planes = f64::from(planes_per_slice(&shot.view(), 0));
            let distance = 1.0 / (planes * f64::from(degrees).to_radians().cos());
            assert!(distance <= 1.002 / samples, "{degrees} degrees: {distance}");
            assert!(distance >= 0.5 / samples, "{degrees} degrees: {distance}");
        }
    }
}

#[test]
fn stacks_share_a_picture_near_the_switch_and_only_there() {
    let grid = cube(16);
    let shares = |degrees: f64, tilt: f64, smooth| {
        let shot = PictureCase {
            grid,
            camera: turned(&grid, degrees, tilt),
            extent: [8, 8],
            settings: stacks(smooth),
        };
        stack_shares(&shot.view())
    };
    assert_eq!(shares(43.0, 0.0, false), [(0, 1.0)]);
    assert_eq!(shares(38.9, 0.0, true), [(0, 1.0)]);
    assert_eq!(shares(51.1, 0.0, true), [(1, 1.0)]);
    let close = |found: Vec<(usize, f64)>, wanted: &[(usize, f64)]| {
        let same = found.len() == wanted.len()
            && found
                .iter()
                .zip(wanted)
                .all(|(f, w)| f.0 == w.0 && (f.1 - w.1).abs() < 1e-9);
        assert!(same, "{found:?}, wanted {wanted:?}");
    };
    close(shares(45.0, 0.0, true), &[(0, 0.5), (1, 0.5)]);
    let corner = 2f64.sqrt().recip().atan().to_degrees();
    close(
        shares(45.0, corner, true),
        &[(0, 1.0 / 3.0), (1, 1.0 / 3.0), (2, 1.0 / 3.0)],
    );
    // Half way out of the band r is 1/2.
    close(shares(42.0, 0.0, true), &[(0, 2.0 / 3.0), (1, 1.0 / 3.0)]);
    let mut before = shares(37.0, 0.0, true)[0].1;
    for i in 1..=80 {
        let now = shares(37.0 + 0.1 * f64::from(i), 0.0, true)[0].1;
        assert!(
            (now - before).abs() < 0.02,
            "a jump at step {i}: {before} to {now}"
        );
        before = now;
    }
}

#[test]
fn a_faded_picture_is_the_mean_of_both_stacks() {
    let volume = volume_of([16; 3], DAffine3::IDENTITY, waves);
    let grid = volume.grid();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let transfer = ramps();
    let shot = PictureCase {
        grid,
        camera: turned(&grid, 43.0, 7.0),
        extent: [32, 28],
        settings: stacks(true),
    };
    let shares = stack_shares(&shot.view());
    assert_eq!(shares.len(), 2, "{shares:?}");
    let mut device = |shot: &PictureCase| {
        let scene = shot.scene(&volume, Some(&transfer));
        renderer.render(&scene, &[]).unwrap().picture
    };
    let faded = device(&shot);
    let of_stack = |stack| shot.with(|settings| settings.stack = Some(stack));
    let both = [0, 1].map(|i| (device(&of_stack(shares[i].0)), shares[i].1));
    let reference = reference::render::<f64>(&shot.scene(&volume, Some(&transfer))).unwrap();
    let mut mean = Worst::new("mean of stacks");
    let mut references = Worst::new("reference of a faded picture");
    for (i, pixel) in shot.pixels().enumerate() {
        for c in 0..4 {
            let found = f64::from(faded.pixels[i][c]);
            let wanted: f64 = both
                .iter()
                .map(|(p, share)| share * f64::from(p.pixels[i][c]))
                .sum();
            mean.take(pixel, found - wanted, 2e-7);
            references.take(pixel, found - f64::from(reference.pixels[i][c]), 1e-5);
        }
    }
    mean.assert_holds();
    references.assert_holds();
}

fn shell() -> TransferFunction {
    let opacity = |value, opacity| OpacityPoint { value, opacity };
    TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: vec![opacity(7.5, 0.0), opacity(9.0, 0.22), opacity(10.5, 0.0)],
        reference_length: Some(1.0),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// The target of smooth stacks: J of a thin shell under a thousandth, and classic stacks show what they always did.
#[test]
fn a_thin_shell_does_not_pop_in_smooth_stacks() {
    let grid = cube(32);
    let center = grid.center() + dvec3(2.3, -1.1, 0.7);
    let volume = volume_of(grid.dims, grid.world_from_voxel, |p| p.distance(center));
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let transfer = shell();
    let mut jump = |smooth: bool, preintegrated: bool| {
        let mut picture = |stack| {
            let settings = Settings {
                preintegrated,
                stack: Some(stack),
                ..stacks(smooth)
            };
            let shot = PictureCase {
                grid,
                camera: turned(&grid, 45.0, 12.0),
                extent: [48, 48],
                settings,
            };
            renderer
                .render(&shot.scene(&volume, Some(&transfer)), &[])
                .unwrap()
                .picture
        };
        let [a, b] = [picture(0), picture(1)];
        let both = || a.pixels.iter().zip(&b.pixels);
        let change: f32 = both().map(|(a, b)| (a[0] - b[0]).abs()).sum();
        f64::from(change / both().map(|(a, _)| a[0]).sum::<f32>())
    };
    let (classic, smooth) = (jump(false, false), jump(true, true));
    assert!(smooth <= 0.001, "J of smooth stacks: {smooth}");
    assert!(classic >= 0.005, "J of classic stacks: {classic}");
}

fn jittered(
    volume: &Volume,
    renderer: &mut Renderer,
    jitter: Jitter,
    preintegrated: bool,
) -> Picture {
    let grid = volume.grid();
    let settings = Settings {
        lattice: Lattice::Jitter,
        jitter,
        preintegrated,
        samples_per_voxel: 0.5,
        ..Settings::default()
    };
    let camera = oblique_camera(&grid, projections(&grid)[1]);
    let shot = PictureCase {
        grid,
        camera,
        extent: [32, 28],
        settings,
    };
    let transfer = ramps();
    renderer
        .render(&shot.scene(volume, Some(&transfer)), &[LayerKind::Samples])
        .unwrap()
        .picture
}

#[test]
fn jitter_is_a_function_of_pixel_frame_and_seed() {
    let volume = volume_of([16; 3], DAffine3::IDENTITY, waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let mut other = Renderer::new(device(), &volume).unwrap();
    let jitter = |seed, frame| Jitter { seed, frame };
    for preintegrated in [false, true] {
        let first = jittered(&volume, &mut renderer, jitter(1, 0), preintegrated);
        let again = jittered(&volume, &mut other, jitter(1, 0), preintegrated);
        assert_eq!(first.pixels, again.pixels, "the same bytes");
        for changed in [jitter(2, 0), jitter(1, 1)] {
            let found = jittered(&volume, &mut renderer, changed, preintegrated);
            // The only sample of a short ray lies in its middle.
            let are_long = |i: &usize| {
                [&first, &found]
                    .iter()
                    .all(|p| p.layers[0].values[*i] > 1.0)
            };
            let long = (0..first.pixels.len()).filter(are_long);
            let (same, differ): (Vec<_>, Vec<_>) =
                long.partition(|&i| first.pixels[i] == found.pixels[i]);
            assert!(differ.len() > 100, "{} long rays", differ.len());
            assert!(
                differ.len() > 20 * same.len(),
                "{changed:?}: {} are the same",
                same.len()
            );
        }
    }
}

/// The parts of a step that the parameters of a picture give to the pixels of 64 x 64, row after row.
fn parts(seed: u32, frame: u32) -> Vec<f32> {
    let grid = volume_of([4; 3], DAffine3::IDENTITY, waves).grid();
    let settings = Settings {
        lattice: Lattice::Jitter,
        jitter: Jitter { seed, frame },
        ..Settings::default()
    };
    let shot = PictureCase {
        grid,
        camera: oblique_camera(&grid, projections(&grid)[0]),
        extent: [64, 64],
        settings,
    };
    let frame = shot.parameters().0;
    shot.pixels()
        .map(|pixel| jitter_of(&frame, pixel))
        .collect()
}

/// By how much sorted parts are off even ones.
fn spread(mut parts: Vec<f32>) -> f32 {
    parts.sort_by(f32::total_cmp);
    let count = parts.len() as f32;
    let even = |i: usize| (i as f32 + 0.5) / count;
    let off = parts
        .iter()
        .enumerate()
        .map(|(i, part)| (part - even(i)).abs());
    off.fold(0.0, f32::max)
}

#[test]
fn the_pattern_of_jitter_is_even_in_space_and_time() {
    let of_pixel: Vec<_> = (0..64).map(|frame| parts(7, frame)[64 * 5 + 3]).collect();
    // Two ranks share each of 2048 levels, so a part is at most one level off.
    let in_space = [parts(7, 0), parts(8, 5)].map(spread);
    assert!(
        in_space.iter().all(|&off| off < 1.0 / 2048.0),
        "{in_space:?}"
    );
    // 64 random numbers would be off by a tenth.
    let in_time = spread(of_pixel);
    assert!(in_time < 0.05, "{in_time}");
}

/// Which share of the power of 64 x 64 numbers lies at less than an eighth of a turn a pixel, in every direction:
/// under a quarter of the Nyquist frequency.
fn slow_share(parts: &[f32]) -> f64 {
    let mean = parts.iter().map(|&part| f64::from(part)).sum::<f64>() / 4096.0;
    let off = |i: usize| f64::from(parts[i]) - mean;
    let all: f64 = (0..4096).map(|i| off(i).powi(2)).sum::<f64>() * 4096.0;
    let slow = (-7i32..8).flat_map(|v| (-7i32..8).map(move |u| [u, v]));
    let slow = slow.filter(|[u, v]| (1..64).contains(&(u * u + v * v)));
    let power = |[u, v]: [i32; 2]| {
        let mut sums = [0.0; 2];
        for i in 0..4096 {
            let turns = (u * (i % 64) + v * (i / 64)).rem_euclid(64);
            let (sine, cosine) = (f64::from(turns) / 64.0 * TAU).sin_cos();
            sums[0] += off(i as usize) * cosine;
            sums[1] += off(i as usize) * sine;
        }
        sums[0].powi(2) + sums[1].powi(2)
    };
    slow.map(power).sum::<f64>() / all
}

#[test]
fn the_pattern_of_jitter_is_blue_in_every_picture_of_a_film() {
    let mut state = 1u32;
    let white: Vec<_> = (0..4096)
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 16_777_216.0
        })
        .collect();
    let of_white = slow_share(&white);
    assert!((0.03..0.07).contains(&of_white), "{of_white}");
    for (seed, frame) in [(0, 0), (0, 1), (0, 2), (9, 0), (9, 33)] {
        let found = slow_share(&parts(seed, frame));
        println!("{seed} {frame}: {:.4} %", 100.0 * found);
        assert!(found < 1e-4, "{seed} {frame}: {found}");
    }
}
