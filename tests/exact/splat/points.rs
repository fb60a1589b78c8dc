//! Splats of scattered points against sums over all points in f64, on the CPU reference and on the device.

mod moved;

use super::{function, values};
use crate::shared::{Worst, device, device_with};
use glam::{DMat3, DVec3, dvec3};
use std::f64::consts::TAU;
use stratavox::camera::{Camera, Projection, Rays};
use stratavox::gpu::Caps;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::points::Points;
use stratavox::scene::{Beside, Scene};
use stratavox::technique::splat::{Sheets, Splat};
use stratavox::technique::{ClipPlane, Mode, Settings, Technique};
use stratavox::transfer::{Absorption, TransferFunction, classify_by_points};
use stratavox::volume::Volume;

const EXTENT: [u32; 2] = [37, 29];
const EPS: f64 = f32::EPSILON as f64;
const SUMS: [Mode; 2] = [Mode::Xray, Mode::Average];

struct Case {
    camera: Camera,
    settings: Settings,
}

fn settings(mode: Mode) -> Settings {
    Settings {
        technique: Technique::Splat,
        mode,
        conformance: true,
        color_space: ColorSpace::Display,
        splat: Splat::of_points(),
        ..Settings::default()
    }
}

/// From an oblique direction, both projections; in perspective from among the points.
fn shots(mode: Mode) -> [Case; 3] {
    let looking = |eye: DVec3, projection| Case {
        camera: Camera {
            eye,
            target: dvec3(5.0, 5.0, 5.0),
            up: DVec3::Z,
            projection,
            zoom: 1.0,
        },
        settings: settings(mode),
    };
    let degrees = |n: f64| Projection::Perspective { fov_degrees: n };
    [
        looking(
            dvec3(25.0, -13.0, 18.0),
            Projection::Orthographic { view_height: 13.0 },
        ),
        looking(dvec3(17.0, -9.0, 12.0), degrees(38.0)),
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

/// From much thinner than a pixel to as wide as the picture.
fn cloud(count: usize, seed: u32) -> Points {
    let mut unit = random(seed);
    let places = (0..count).map(|_| 10.0 * dvec3(unit(), unit(), unit()));
    let places = places.collect();
    let mut list = |of: fn(f64) -> f64| (0..count).map(|_| of(unit()) as f32).collect::<Vec<_>>();
    let values = list(|u| u);
    let stds = list(|u| 0.01 * 300f64.powf(u * u * u));
    let weights = list(|u| 2.0 * u);
    Points::new(places, values, Some(stds), Some(weights)).expect("points")
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

fn pictures(shot: &Case, points: &Points, layers: &[LayerKind]) -> [(&'static str, Picture); 3] {
    let (volume, f) = (points.binned(), function());
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

/// What is wrong of a sum over points: what checks must not take for the law.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Wrong {
    /// Points that pixels widen are as high as before.
    KeptPeak,
    /// What pixels widen them by is all of their width.
    WideningAlone,
    /// Points are listed where their centres are.
    BoxOfCentre,
    /// The nearest to the eye lies in front.
    ByDistance,
    /// The farthest lies in front.
    BackToFront,
    /// Of equal depths the last of the file lies in front.
    LastOfTies,
}

/// What a ray meets of a point.
struct Met {
    index: usize,
    depth: f64,
    /// In standard deviations, and how far rounding to f32 may move it.
    off: f64,
    blur: f64,
    /// Of the splat, as high as it is drawn.
    std_of_peak: f64,
}

impl Met {
    /// e^(-b^2 / 2).
    fn share(&self) -> f64 {
        (-0.5 * self.off * self.off).exp()
    }

    /// The same, and nothing beyond where it ends.
    fn share_within(&self, end: f64) -> f64 {
        match self.off <= end {
            true => self.share(),
            false => 0.0,
        }
    }

    /// Of the share: the steepest slope of e^(-b^2 / 2) is e^(-1/2) = 0.607; e^x is off by 3 + 2 abs(x) ulp (Vulkan
    /// specification, precision of SPIR-V instructions), and two factors and a product by one each. Whether a point is met at
    /// all depends on rounding where it ends.
    fn share_error(&self, end: f64) -> f64 {
        let exponent = 0.5 * self.off * self.off;
        let rounding = (6.0 + 2.0 * exponent) * EPS * self.share();
        let at_end = match (self.off - end).abs() <= self.blur {
            true => (-0.5 * end * end).exp(),
            false => 0.0,
        };
        0.61 * self.blur + rounding + at_end
    }
}

/// Where splats end, in standard deviations.
fn end_of(shot: &Case) -> f64 {
    (2.0 * f64::from(shot.settings.splat.cut_bits) * 2f64.ln()).sqrt()
}

/// All points before the eye of a pixel's ray that rounding may find within reach, from front to back. Of the eye and of
/// pixels it takes the camera's word alone.
fn met(shot: &Case, points: &Points, [x, y]: [u32; 2], wrong: Option<Wrong>) -> Vec<Met> {
    let is = |of| wrong == Some(of);
    let rays = shot.camera.rays(EXTENT);
    let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let direction = direction.normalize();
    let height = f64::from(EXTENT[1]);
    let reach = end_of(shot);
    let mut all: Vec<_> = (0..points.len())
        .filter_map(|index| {
            let to = points.places()[index] - origin;
            let from_eye = points.places()[index] - shot.camera.eye;
            let depth = from_eye.dot(rays.forward);
            let pixel = match shot.camera.projection {
                Projection::Orthographic { view_height } => view_height / height,
                Projection::Perspective { fov_degrees } => {
                    2.0 * (0.5 * fov_degrees.to_radians()).tan() * depth / height
                }
                ref other => panic!("{other:?}"),
            };
            let own = f64::from(points.stds()[index]);
            let widest = own.max(shot.settings.splat.low_pass * pixel);
            let std = match is(Wrong::WideningAlone) {
                true => (widest * widest - own * own).sqrt(),
                false => widest,
            };
            let std_of_peak = if is(Wrong::KeptPeak) { own } else { std };
            let along = to.dot(direction);
            let off = (to - along * direction).length() / std;
            // Half an ulp of origin and centre, which are less than 20 from the box's centre together beside their
            // difference; of that and of the direction, whose norm is off by three, and of two products.
            let blur = 8.0 * EPS * (to.length() + 20.0) / std;
            let is_listed =
                !is(Wrong::BoxOfCentre) || is_in_block(&rays, points.places()[index], [x, y]);
            let is_met = std > 0.0 && depth > 0.0 && along > 0.0 && off <= reach + blur;
            let depth = if is(Wrong::ByDistance) {
                from_eye.length()
            } else {
                depth
            };
            (is_met && is_listed).then_some(Met {
                index,
                depth,
                off,
                blur,
                std_of_peak,
            })
        })
        .collect();
    if is(Wrong::LastOfTies) {
        all.reverse();
    }
    all.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    if is(Wrong::BackToFront) {
        all.reverse();
    }
    all
}

/// Whether a place is seen in the block of 8 x 8 pixels of this one.
fn is_in_block(rays: &Rays, place: DVec3, [x, y]: [u32; 2]) -> bool {
    let to = place - rays.origin;
    // The pixel (x, y) whose ray goes through it:
    //     parallel       origin + x dx + y dy + t direction = place
    //     from an eye    direction + x dx + y dy = s (place - eye)
    let pixel = match rays.direction_dx == DVec3::ZERO {
        true => DMat3::from_cols(rays.origin_dx, rays.origin_dy, rays.direction).inverse() * to,
        false => {
            let sides = DMat3::from_cols(rays.direction_dx, rays.direction_dy, -to);
            -(sides.inverse() * rays.direction)
        }
    };
    let [column, row, _] = pixel.to_array();
    [(column, x), (row, y)]
        .iter()
        .all(|(at, n)| (at / 8.0).floor() == f64::from(n / 8))
}

fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..EXTENT[1]).flat_map(|y| (0..EXTENT[0]).map(move |x| [x, y]))
}

/// Sums of a picture against those over all points.
fn check_sums(shot: &Case, points: &Points, picture: &Picture, wrong: Option<Wrong>) -> Worst {
    let mode = shot.settings.mode;
    let mut worst = Worst::new(format!("{mode}, {wrong:?}"));
    for (pixel, &found) in pixels().zip(values(picture)) {
        // Sum of m f F, of m F, and what rounding makes of both.
        let mut sums = [0.0; 4];
        let (end, all) = (end_of(shot), met(shot, points, pixel, wrong));
        // Each addition rounds the sum once, each term is a product of three.
        let adding = (all.len() as f64 + 4.0) * EPS;
        for met in all {
            let value = f64::from(points.values()[met.index]);
            let weight = f64::from(points.weight(met.index)) / (TAU * met.std_of_peak.powi(2));
            sums[0] += weight * value * met.share_within(end);
            sums[1] += weight * met.share_within(end);
            sums[2] += weight * value * met.share_error(end);
            sums[3] += weight * met.share_error(end);
        }
        sums[2] += adding * sums[0];
        sums[3] += adding * sums[1];
        let found = f64::from(found);
        if mode == Mode::Xray {
            let found = if found.is_nan() { 0.0 } else { found };
            worst.take(pixel, found - sums[0], sums[2]);
        } else if sums[1] > 100.0 * sums[3] {
            let wanted = sums[0] / sums[1];
            let allowed = (sums[2] + wanted * sums[3]) / (sums[1] - sums[3]);
            worst.take(pixel, found - wanted, allowed + 2.0 * EPS * wanted);
        }
    }
    worst
}

#[test]
fn sums_are_those_over_all_points() {
    let points = cloud(400, 3);
    for mode in SUMS {
        for shot in &shots(mode) {
            for (name, picture) in pictures(shot, &points, &[LayerKind::Value]) {
                println!("{name}:");
                check_sums(shot, &points, &picture, None).assert_holds();
                for wrong in [Wrong::KeptPeak, Wrong::WideningAlone, Wrong::BoxOfCentre] {
                    check_sums(shot, &points, &picture, Some(wrong)).assert_caught();
                }
            }
        }
    }
}

/// Each fifth in the place of the one before: of equal depths the first of the file lies in front.
fn with_ties(points: &Points) -> Points {
    let mut places = points.places().to_vec();
    for i in (4..places.len()).step_by(5) {
        places[i] = places[i - 1];
    }
    let (values, stds) = (points.values().to_vec(), points.stds().to_vec());
    Points::new(places, values, Some(stds), None).expect("points")
}

/// A composite against that of all points by depth.
fn check_composite(shot: &Case, points: &Points, picture: &Picture, wrong: Option<Wrong>) -> Worst {
    let f = function();
    let table = stratavox::transfer::Points::new(
        &f,
        Absorption::Extinction {
            reference_length: f.reference_length.expect("a length"),
        },
        ColorSpace::Display,
    );
    let mut worst = Worst::new(format!("composite, {wrong:?}"));
    for (pixel, found) in pixels().zip(&picture.pixels) {
        let (mut color, mut left, mut error) = ([0.0; 3], 1.0, 0.0);
        let end = end_of(shot);
        for met in met(shot, points, pixel, wrong) {
            let value = f64::from(points.values()[met.index]);
            let [r, g, b, extinction] = classify_by_points(&table, value);
            let std = f64::from(points.stds()[met.index]);
            let length = TAU.sqrt() * std * (std / met.std_of_peak).powi(2);
            let depth = extinction * length * met.share_within(end);
            let opacity = -(-depth).exp_m1();
            for (sum, c) in color.iter_mut().zip([r, g, b]) {
                *sum += left * opacity * c;
            }
            left *= 1.0 - opacity;
            // Of the depth: of its factors, which are 8 ulp of colour points and their exponents beside the share;
            // 1 - e^-x, with its exponential: 4 ulp of 1; what it is added to and multiplied with: one each of at
            // most 1.
            error += extinction * length * met.share_error(end) + 8.0 * EPS * depth + 6.0 * EPS;
        }
        let wanted = [color[0], color[1], color[2], 1.0 - left];
        for (found, wanted) in found.iter().zip(wanted) {
            worst.take(pixel, f64::from(*found) - wanted, error);
        }
    }
    worst
}

#[test]
fn a_composite_is_that_of_all_points_by_depth() {
    let points = with_ties(&cloud(400, 4));
    for shot in &shots(Mode::Composite) {
        let is_perspective = shot.camera.projection.is_perspective();
        for (name, picture) in pictures(shot, &points, &[]) {
            println!("{name}:");
            check_composite(shot, &points, &picture, None).assert_holds();
            let wrong = [
                Wrong::KeptPeak,
                Wrong::WideningAlone,
                Wrong::BoxOfCentre,
                Wrong::BackToFront,
                Wrong::LastOfTies,
            ];
            // From infinitely far away both are one order.
            let of_an_eye = [Wrong::ByDistance].into_iter().filter(|_| is_perspective);
            for wrong in wrong.into_iter().chain(of_an_eye) {
                check_composite(shot, &points, &picture, Some(wrong)).assert_caught();
            }
        }
    }
}

#[test]
fn extremes_are_those_of_points_within_two_deviations() {
    let points = cloud(300, 5);
    for mode in [Mode::Mip, Mode::Minip] {
        for shot in &shots(mode) {
            for (name, picture) in pictures(shot, &points, &[LayerKind::Value]) {
                let mut drawn = 0;
                for (pixel, &found) in pixels().zip(values(&picture)) {
                    let all = met(shot, &points, pixel, None);
                    let extreme = |within: f64| {
                        let inside = all.iter().filter(|met| met.off + within * met.blur <= 2.0);
                        let values = inside.map(|met| points.values()[met.index]);
                        match mode {
                            Mode::Mip => values.reduce(f32::max),
                            _ => values.reduce(f32::min),
                        }
                    };
                    let wanted = [extreme(1.0), extreme(-1.0)].map(|v| v.unwrap_or(f32::NAN));
                    let is_one = |v: f32| v == found || v.is_nan() && found.is_nan();
                    assert!(
                        wanted.into_iter().any(is_one),
                        "{mode} {name} {pixel:?} {found} {wanted:?}"
                    );
                    drawn += u32::from(!found.is_nan());
                }
                assert!(drawn > 100, "{drawn}");
            }
        }
    }
}

#[test]
fn the_order_of_the_file_does_not_matter_and_two_in_one_place_are_one_of_twice_the_depth() {
    let points = cloud(200, 6);
    let pick = |order: &[usize]| {
        let of = |list: &[f32]| order.iter().map(|&i| list[i]).collect::<Vec<_>>();
        let places = order.iter().map(|&i| points.places()[i]).collect();
        let weights = order.iter().map(|&i| points.weight(i)).collect();
        Points::new(
            places,
            of(points.values()),
            Some(of(points.stds())),
            Some(weights),
        )
        .expect("points")
    };
    let shuffled = pick(&(0..200).map(|i| i * 77 % 200).collect::<Vec<_>>());
    let [_, shot, _] = shots(Mode::Composite);
    let both = [&points, &shuffled].map(|points| pictures(&shot, points, &[]));
    for ((name, one), (_, other)) in both[0].iter().zip(&both[1]) {
        assert_eq!(one.pixels, other.pixels, "{name}");
    }
    let twice = pick(&(0..400).map(|i| i / 2).collect::<Vec<_>>());
    let volume = points.binned();
    let mut f = function();
    let once = |f: &TransferFunction, points: &Points| {
        let scene = scene(&shot, &volume, points, f);
        reference::render::<f64>(&scene).expect("drawn")
    };
    let of_two = once(&f, &twice);
    // A step of opacity: between its points alpha is not what is doubled.
    f.interpolation = stratavox::transfer::Interpolation::Step;
    let of_two_steps = once(&f, &twice);
    for point in &mut f.opacity {
        point.opacity = 1.0 - (1.0 - point.opacity).powi(2);
    }
    let of_one = once(&f, &points);
    for (two, one) in of_two_steps.pixels.iter().zip(&of_one.pixels) {
        for (two, one) in two.iter().zip(one) {
            assert!((two - one).abs() < 2e-6, "{two} {one}");
        }
    }
    assert_ne!(of_two.pixels, of_one.pixels);
}

#[test]
fn the_average_of_a_constant_is_it_and_clips_go_by_centres() {
    let mut unit = random(8);
    let places: Vec<_> = (0..60)
        .map(|_| 10.0 * dvec3(unit(), unit(), unit()))
        .collect();
    let points = Points::new(places, vec![0.625; 60], None, None).expect("points");
    for shot in &shots(Mode::Average) {
        for (name, picture) in pictures(shot, &points, &[LayerKind::Value]) {
            let found = values(&picture).iter().filter(|v| !v.is_nan());
            assert!(found.clone().all(|v| (v - 0.625).abs() < 1e-6), "{name}");
            assert!(found.count() > 100);
        }
    }
    let [mut shot, ..] = shots(Mode::Xray);
    let plane = ClipPlane {
        normal: DVec3::X,
        offset: 4.0,
    };
    let is_left = |i: &usize| points.places()[*i].x >= 4.0;
    let left: Vec<_> = (0..60).filter(is_left).collect();
    let places = left.iter().map(|&i| points.places()[i]).collect();
    let stds = left.iter().map(|&i| points.stds()[i]).collect();
    let alone = Points::new(places, vec![0.625; left.len()], Some(stds), None).expect("points");
    let volume = points.binned();
    let f = function();
    let wanted = reference::render::<f64>(&scene(&shot, &volume, &alone, &f)).expect("drawn");
    shot.settings.clip_planes = vec![plane];
    let found = reference::render::<f64>(&scene(&shot, &volume, &points, &f)).expect("drawn");
    assert_eq!(wanted.pixels, found.pixels);
}

#[test]
fn points_are_refused_where_they_are_not_drawn() {
    let (points, f) = (cloud(5, 9), function());
    let volume = points.binned();
    let [mut shot, ..] = shots(Mode::Composite);
    let refused = |shot: &Case, beside: Beside| {
        let scene = Scene {
            beside,
            ..scene(shot, &volume, &points, &f)
        };
        scene.check().expect_err("refused").to_string()
    };
    let text = refused(&shot, Beside::Nothing);
    assert!(text.contains("scattered points"), "{text}");
    shot.settings.splat.sheets = Sheets::Axis;
    assert!(refused(&shot, Beside::Points(&points)).contains("axis"));
    shot.settings = Settings::default();
    let text = refused(&shot, Beside::Points(&points));
    assert!(
        text.contains("raycast") && text.contains("splatting"),
        "{text}"
    );
}

#[test]
fn lists_longer_than_loops_may_be_are_drawn_in_parts() {
    let [shot, ..] = shots(Mode::Composite);
    let points = cloud(2000, 10);
    let (volume, f) = (points.binned(), function());
    let parts = |settings: &Settings, turns| {
        let shot = Case {
            camera: shot.camera,
            settings: settings.clone(),
        };
        let caps = Caps {
            max_loop_turns: turns,
            ..Caps::UNLIMITED
        };
        let scene = scene(&shot, &volume, &points, &f);
        let mut renderer = Renderer::new(device_with(caps), &volume).expect("a renderer");
        renderer.render(&scene, &[]).expect("drawn").picture
    };
    for mode in [Mode::Composite, Mode::Mip, Mode::Xray, Mode::Average] {
        let settings = settings(mode);
        let [whole, cut] = [u32::MAX, 300].map(|turns| parts(&settings, turns));
        assert_eq!(whole.pixels, cut.pixels, "{mode}");
    }
}
