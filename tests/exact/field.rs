//! Rays through the field of scattered points: against the closed form of one point, and between bounds that go over all samples
//! and all points in f64; on the CPU reference and on the device.

use crate::shared::{Worst, device, device_with};
use glam::{DVec3, dvec3};
use std::f64::consts::PI;
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::Caps;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::points::{FieldKernel, Points, Quantity};
use stratavox::scene::{Beside, Scene};
use stratavox::technique::{ClipPlane, Mode, Settings};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::Volume;

const EXTENT: [u32; 2] = [29, 23];
const EPS: f64 = f32::EPSILON as f64;
const OPACITY: f64 = 0.35;
const REFERENCE_LENGTH: f64 = 1.25;
const RADIUS: f64 = 1.7;

struct Case {
    camera: Camera,
    settings: Settings,
}

fn settings(mode: Mode, radius: f64, quantity: Quantity) -> Settings {
    Settings {
        mode,
        conformance: true,
        color_space: ColorSpace::Display,
        samples_per_voxel: 4.0,
        field: Some(FieldKernel { radius, quantity }),
        ..Settings::default()
    }
}

/// From an oblique direction, both projections; in perspective from among the points too.
fn cameras() -> [Camera; 3] {
    let looking = |eye: DVec3, projection| Camera {
        eye,
        target: dvec3(5.0, 5.0, 5.0),
        up: DVec3::Z,
        projection,
        zoom: 1.0,
    };
    let degrees = |n: f64| Projection::Perspective { fov_degrees: n };
    [
        looking(
            dvec3(25.0, -13.0, 18.0),
            Projection::Orthographic { view_height: 15.0 },
        ),
        looking(dvec3(17.0, -9.0, 12.0), degrees(42.0)),
        looking(dvec3(5.5, 4.0, 2.0), degrees(95.0)),
    ]
}

/// Numbers from 0 to 1 without a pattern.
fn random(seed: u32) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(2_654_435_761) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        f64::from(state) / f64::from(u32::MAX)
    }
}

fn cloud(count: usize, seed: u32) -> Points {
    let mut unit = random(seed);
    let places = (0..count).map(|_| 10.0 * dvec3(unit(), unit(), unit()));
    let places = places.collect();
    let values = (0..count).map(|_| unit() as f32).collect();
    let weights = (0..count).map(|_| 0.25 + unit() as f32).collect();
    Points::new(places, values, None, Some(weights)).expect("points")
}

/// Grey as the value is, and equally opaque.
fn function() -> TransferFunction {
    let ends = [0.0, 1.0];
    TransferFunction {
        color: ends
            .map(|value| ColorPoint {
                value,
                srgb: [value; 3],
            })
            .to_vec(),
        opacity: ends
            .map(|value| OpacityPoint {
                value,
                opacity: OPACITY,
            })
            .to_vec(),
        reference_length: Some(REFERENCE_LENGTH),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

fn scene<'a>(
    shot: &'a Case,
    volume: &'a Volume,
    points: &'a Points,
    f: &'a TransferFunction,
) -> Scene<'a> {
    Scene {
        volume,
        transfer: Some(f),
        beside: Beside::Points(points),
        camera: &shot.camera,
        extent_pixels: EXTENT,
        settings: &shot.settings,
    }
}

fn volume_of(shot: &Case, points: &Points) -> Volume {
    points.binned_within(shot.settings.field.expect("a field").radius)
}

fn pictures(shot: &Case, points: &Points, layers: &[LayerKind]) -> [(&'static str, Picture); 3] {
    let (volume, f) = (volume_of(shot, points), function());
    let scene = scene(shot, &volume, points, &f);
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    [
        ("f64", reference::render::<f64>(&scene).expect("drawn")),
        ("f32", reference::render::<f32>(&scene).expect("drawn")),
        (
            "device",
            renderer.render(&scene, layers).expect("drawn").picture,
        ),
    ]
}

/// The layer of values.
fn values(picture: &Picture) -> Vec<f32> {
    let layer = picture.layers.iter().find(|l| l.kind == LayerKind::Value);
    layer.expect("a layer of values").values.clone()
}

fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..EXTENT[1]).flat_map(|y| (0..EXTENT[0]).map(move |x| [x, y]))
}

/// A sample of a ray: its place, the length it stands for, at least and at most, and how far f32 may move it, in radii.
struct Sample {
    place: DVec3,
    length: [f64; 2],
    blur: f64,
}

/// The samples of a pixel's ray in the box of the points; `None` where rounding says how many there are.
fn samples(shot: &Case, volume: &Volume, [x, y]: [u32; 2]) -> Option<Vec<Sample>> {
    let rays = shot.camera.rays(EXTENT);
    let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let direction = direction.normalize();
    let grid = volume.grid();
    let low = grid.world_from_voxel.translation;
    let high = grid.world_from_voxel.transform_point3(grid.far_corner());
    let [at_low, at_high] = [low, high].map(|corner| (corner - origin) / direction);
    let t0 = at_low.min(at_high).max_element().max(0.0);
    let mut t1 = at_low.max(at_high).min_element();
    let mut t_first = t0;
    for plane in &shot.settings.clip_planes {
        let t = (plane.offset - plane.normal.dot(origin)) / plane.normal.dot(direction);
        match plane.normal.dot(direction) > 0.0 {
            true => t_first = t_first.max(t),
            false => t1 = t1.min(t),
        }
    }
    let t0 = t_first;
    if t1 <= t0 {
        return (t0 - t1 > 1e-3).then(Vec::new);
    }
    let radius = shot.settings.field.expect("a field").radius;
    let step = radius / shot.settings.samples_per_voxel;
    let steps = (t1 - t0) / step;
    if (steps - steps.round()).abs() < 1e-2 {
        return None;
    }
    let whole = steps.floor();
    let sample = |k: f64| {
        let length = if k < whole { step } else { t1 - t0 - k * step };
        let t = t0 + k * step + 0.5 * length;
        // Half an ulp of the origin, and three of its way to voxels; of the direction eight, its norm and its way; of t twice as
        // many as of both, which the side of the box is divided by, and four of its sum; three of the place in voxels, as many
        // of that in cells and of what they are made by.
        let blur = 32.0 * EPS * (origin.distance(grid.center()) + t + grid.diagonal()) / radius;
        // The last ends where the ray does.
        let off = if k < whole { 0.0 } else { blur * radius };
        Sample {
            place: origin + t * direction,
            length: [(length - off).max(0.0), length + off],
            blur,
        }
    };
    Some((0..=whole as u32).map(|k| sample(k.into())).collect())
}

fn wendland(r: f64) -> f64 {
    (1.0 - r).max(0.0).powi(4) * (4.0 * r + 1.0)
}

/// What a sample may be: whether there may be a value, whether there must, and between which values it lies.
#[derive(Clone, Copy)]
struct Found {
    may: bool,
    must: bool,
    values: [f64; 2],
}

fn found(shot: &Case, points: &Points, sample: &Sample) -> Found {
    let FieldKernel { radius, quantity } = shot.settings.field.expect("a field");
    // Sums over the points, low and high: of m W and m f W; and the range of the values.
    let (mut weights, mut sums, mut range) = ([0.0; 2], [0.0; 2], [1.0_f64, 0.0]);
    let mut near = 0.0;
    for (i, p) in points.places().iter().enumerate() {
        let r = p.distance(sample.place) / radius;
        if r > 1.0 + sample.blur {
            continue;
        }
        near += 1.0;
        let (m, f) = (f64::from(points.weight(i)), f64::from(points.values()[i]));
        let kernels = [r + sample.blur, (r - sample.blur).max(0.0)].map(wendland);
        for side in 0..2 {
            weights[side] += m * kernels[side];
            sums[side] += m * f * kernels[side];
        }
        range = [range[0].min(f), range[1].max(f)];
    }
    // Twelve operations of each term, and the sum.
    let rounding = (16.0 + near) * EPS;
    let [low, high] = match quantity {
        // Also where weights are so small that nothing is left of them.
        Quantity::Mean => {
            let between = [sums[0] / weights[1], sums[1] / weights[0]];
            let within = |x: f64| {
                if x.is_nan() {
                    x
                } else {
                    x.clamp(range[0], range[1])
                }
            };
            let low = if between[0].is_nan() {
                range[0]
            } else {
                within(between[0])
            };
            let high = if between[1].is_nan() {
                range[1]
            } else {
                within(between[1])
            };
            [low, high]
        }
        Quantity::Density => weights.map(|w| w * 21.0 / (2.0 * PI * radius.powi(3))),
    };
    Found {
        may: weights[1] > 0.0,
        must: weights[0] > 0.0,
        values: [low * (1.0 - rounding), high * (1.0 + rounding)],
    }
}

/// Between which numbers a pixel lies: the value, NaN where there is none, or the grey and the alpha of composites; `None` where rounding
/// says whether there is a value, or how many samples.
fn pixel(shot: &Case, volume: &Volume, points: &Points, at: [u32; 2]) -> Option<[[f64; 2]; 2]> {
    let samples = samples(shot, volume, at)?;
    let all: Vec<(Found, [f64; 2])> = samples
        .iter()
        .map(|sample| (found(shot, points, sample), sample.length))
        .filter(|(found, _)| found.may)
        .collect();
    let must = || all.iter().filter(|(found, _)| found.must);
    if all.is_empty() && shot.settings.mode != Mode::Composite {
        return Some([[f64::NAN; 2]; 2]);
    }
    let rounding = (8.0 + all.len() as f64) * EPS;
    let wide = |[low, high]: [f64; 2]| [low * (1.0 - rounding), high * (1.0 + rounding)];
    let extreme = |of: &mut dyn Iterator<Item = f64>, fold: fn(f64, f64) -> f64| of.reduce(fold);
    let of_sum = |side: usize| -> [f64; 2] {
        let add = |[sum, length]: [f64; 2], (found, d): &(Found, [f64; 2])| {
            [sum + found.values[side] * d[side], length + d[side]]
        };
        match side {
            0 => must().fold([0.0; 2], add),
            _ => all.iter().fold([0.0; 2], add),
        }
    };
    let value = match shot.settings.mode {
        Mode::Mip => [
            extreme(&mut must().map(|(f, _)| f.values[0]), f64::max)?,
            extreme(&mut all.iter().map(|(f, _)| f.values[1]), f64::max)?,
        ],
        Mode::Minip => [
            extreme(&mut all.iter().map(|(f, _)| f.values[0]), f64::min)?,
            extreme(&mut must().map(|(f, _)| f.values[1]), f64::min)?,
        ],
        Mode::Xray => {
            must().next()?;
            wide([of_sum(0)[0], of_sum(1)[0]])
        }
        Mode::Average => {
            must().next()?;
            let [low, high] = [of_sum(0), of_sum(1)];
            wide([low[0] / high[1], high[0] / low[1]])
        }
        _ => {
            let extinction = -(1.0 - OPACITY).ln() / REFERENCE_LENGTH;
            // The most and the least that is in the way.
            let mut left = [1.0_f64; 2];
            let mut grey = [0.0; 2];
            for (found, d) in &all {
                let opacity = d.map(|d| -(-extinction * d).exp_m1());
                if found.must {
                    grey[0] += left[0] * opacity[0] * found.values[0];
                }
                grey[1] += left[1] * opacity[1] * found.values[1];
                left[0] *= 1.0 - opacity[1];
                if found.must {
                    left[1] *= 1.0 - opacity[0];
                }
            }
            // Of each sample 4 ulp of 1 for 1 - e^-x, 8 of the colour points, one each of products and sums.
            let rounding = 16.0 * EPS * all.len() as f64;
            let alpha = [1.0 - left[1] - rounding, 1.0 - left[0] + rounding];
            return Some([[grey[0] - rounding, grey[1] + rounding], alpha]);
        }
    };
    Some([value; 2])
}

/// How far a number lies out of where it may, and how wide that is.
fn take(worst: &mut Worst, at: [u32; 2], found: f32, [low, high]: [f64; 2]) {
    if low.is_nan() {
        let error = if found.is_nan() { 0.0 } else { 1.0 };
        return worst.take(at, error, 0.5);
    }
    let middle = 0.5 * (low + high);
    worst.take(
        at,
        f64::from(found) - middle,
        0.5 * (high - low) + f64::MIN_POSITIVE,
    );
}

#[test]
fn every_mode_is_that_of_all_samples_of_all_points() {
    let points = cloud(260, 3);
    let (mut widest, mut count) = (0.0_f64, 0);
    for (mode, quantity) in [
        (Mode::Xray, Quantity::Density),
        (Mode::Mip, Quantity::Density),
        (Mode::Xray, Quantity::Mean),
        (Mode::Average, Quantity::Mean),
        (Mode::Mip, Quantity::Mean),
        (Mode::Minip, Quantity::Mean),
        (Mode::Composite, Quantity::Mean),
    ] {
        for (number, camera) in cameras().into_iter().enumerate() {
            let mut shot = Case {
                camera,
                settings: settings(mode, RADIUS, quantity),
            };
            if number == 1 {
                shot.settings.clip_planes = vec![ClipPlane {
                    normal: dvec3(0.3, -0.8, 0.52),
                    offset: 0.2,
                }];
            }
            let volume = volume_of(&shot, &points);
            let wanted: Vec<_> = pixels()
                .map(|at| pixel(&shot, &volume, &points, at))
                .collect();
            let has_value = mode != Mode::Composite;
            let layers: &[LayerKind] = if has_value { &[LayerKind::Value] } else { &[] };
            for (name, picture) in pictures(&shot, &points, layers) {
                let mut worst = Worst::new(format!("{mode} {quantity:?} {number} {name}"));
                let found = if has_value {
                    values(&picture)
                } else {
                    Vec::new()
                };
                for (i, at) in pixels().enumerate() {
                    let Some([first, alpha]) = wanted[i] else {
                        worst.leave_out();
                        continue;
                    };
                    if has_value {
                        take(&mut worst, at, found[i], first);
                    } else {
                        take(&mut worst, at, picture.pixels[i][1], first);
                        take(&mut worst, at, picture.pixels[i][3], alpha);
                    }
                    if first[1] > 0.0 {
                        widest += (first[1] - first[0]) / first[1];
                        count += 1;
                    }
                }
                worst.assert_holds();
            }
        }
    }
    // What is checked is no wide range: a mean of 2 % at most.
    let mean = widest / f64::from(count);
    assert!(mean < 0.02, "{mean}");
}

/// Integral of the kernel of radius 1 along a line that passes the point at distance b: with J_n that of r^n,
/// J0 - 10 J2 + 20 J3 - 15 J4 + 4 J5.
fn along_line(b: f64) -> f64 {
    let half = (1.0 - b * b).max(0.0).sqrt();
    let below_first = if b > 0.0 {
        2.0 * (half / b).asinh()
    } else {
        0.0
    };
    let mut j = vec![2.0 * half, half + 0.5 * b * b * below_first];
    for n in 2..=5 {
        let order = n as f64;
        j.push((2.0 * half + order * b * b * j[n - 2]) / (order + 1.0));
    }
    j[0] - 10.0 * j[2] + 20.0 * j[3] - 15.0 * j[4] + 4.0 * j[5]
}

#[test]
fn the_x_ray_of_a_point_is_the_closed_form() {
    let place = dvec3(5.3, 4.9, 5.2);
    let (radius, per_radius) = (6.0, 10.0_f64);
    let points = Points::new(vec![place], vec![0.5], None, None).expect("a point");
    let norm = 2.0 * PI / 21.0 * f64::powi(radius, 3);
    let [camera, other, _] = cameras();
    for camera in [camera, other] {
        let mut shot = Case {
            camera,
            settings: settings(Mode::Xray, radius, Quantity::Density),
        };
        shot.settings.samples_per_voxel = per_radius;
        for (name, picture) in pictures(&shot, &points, &[LayerKind::Value]) {
            let mut worst = Worst::new(format!("one point, {name}"));
            for (at, found) in pixels().zip(values(&picture)) {
                let rays = shot.camera.rays(EXTENT);
                let (origin, direction) = rays.at(f64::from(at[0]) + 0.5, f64::from(at[1]) + 0.5);
                let direction = direction.normalize();
                let to = place - origin;
                let b = (to - to.dot(direction) * direction).length() / radius;
                if b > 1.1 {
                    assert!(found.is_nan(), "{at:?} {found}");
                    continue;
                }
                let wanted = radius * along_line(b.min(1.0)) / norm;
                // Midpoints (540 / 720 steps^4 in radii: `tests/host/points_field.rs`); of every sample the slope of the kernel, which is
                // under 2.2, times how far its place is off, and 64 roundings.
                let blur =
                    32.0 * EPS * (origin.distance(place) + to.length() + 4.0 * radius) / radius;
                let of_steps = 0.75 / per_radius.powi(4);
                let allowed = radius / norm * (of_steps + 2.0 * (2.2 * blur + 64.0 * EPS));
                let found = if found.is_nan() {
                    0.0
                } else {
                    f64::from(found)
                };
                worst.take(at, found - wanted, allowed);
            }
            worst.assert_holds();
        }
    }
}

#[test]
fn empty_cells_and_parts_of_rays_change_no_bit() {
    // Two clusters far apart, and one point that many others lie on.
    let near = cloud(150, 9);
    let mut places = near.places().to_vec();
    for (i, place) in places.iter_mut().enumerate() {
        *place = match i % 3 {
            0 => 0.2 * *place,
            1 => dvec3(8.0, 7.5, 9.0) + 0.1 * *place,
            _ => dvec3(2.0, 9.0, 4.0),
        };
    }
    let points = Points::new(places, near.values().to_vec(), None, None).expect("points");
    for mode in [
        Mode::Composite,
        Mode::Mip,
        Mode::Minip,
        Mode::Xray,
        Mode::Average,
    ] {
        let [camera, ..] = cameras();
        let drawn = |skip, turns| {
            let shot = Case {
                camera,
                settings: Settings {
                    skip,
                    ..settings(mode, 0.9, Quantity::Mean)
                },
            };
            let (volume, f) = (volume_of(&shot, &points), function());
            let caps = Caps {
                max_loop_turns: turns,
                ..Caps::UNLIMITED
            };
            let scene = scene(&shot, &volume, &points, &f);
            let mut renderer = Renderer::new(device_with(caps), &volume).expect("a renderer");
            renderer
                .render(&scene, &[])
                .map(|drawn| drawn.picture.pixels)
        };
        let whole = drawn(true, u32::MAX).expect("drawn");
        assert!(whole.iter().filter(|pixel| pixel[3] > 0.0).count() > 40);
        assert_eq!(whole, drawn(false, u32::MAX).expect("drawn"), "{mode}");
        // Four samples at a time.
        assert_eq!(whole, drawn(true, 2600).expect("drawn"), "{mode}");
        let text = drawn(true, 2100).expect_err("no sample fits").to_string();
        assert!(text.contains("smaller radius"), "{text}");
    }
}
