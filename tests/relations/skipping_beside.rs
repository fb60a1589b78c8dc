//! What rays leave out changes no bit of a picture: functions of gradients, slabs, mixtures and maxima that are faded.

use crate::shared::{device_with, share, sheared_affine, volume_of};
use crate::skipping_shared::{DIMS, Numbers, balls, cameras, hills, samples_of_same_pictures};
use glam::{DVec3, dvec3};
use stratavox::gpu::Caps;
use stratavox::offscreen::Renderer;
use stratavox::picture::ColorSpace;
use stratavox::scene::{Beside, Channel, Scene};
use stratavox::technique::preclassified::preclassified;
use stratavox::technique::{ClipPlane, Filter, Lattice, Mode, Role, Settings, Shading, Technique};
use stratavox::transfer::{
    Cells, GradientTransfer, OpacityPoint, SecondDerivative, Shape, TransferFunction, Widget,
};
use stratavox::volume::{Rescale, Volume, Voxels};

/// In one piece, and in bricks.
const CAPS: [fn() -> Caps; 2] = [
    || Caps::UNLIMITED,
    || Caps {
        max_image_dimension_3d: 19,
        max_image_array_layers: 17,
        ..Caps::UNLIMITED
    },
];

fn settings(numbers: &mut Numbers, volume: &Volume) -> Settings {
    let grid = volume.grid();
    let mut settings = Settings {
        filter: [Filter::Linear, Filter::Nearest][numbers.below(2)],
        lattice: [
            Lattice::Ray,
            Lattice::Planes,
            Lattice::Jitter,
            Lattice::Bresenham,
        ][numbers.below(4)],
        samples_per_voxel: [0.7, 1.0, 2.3][numbers.below(3)],
        termination: [0.0, 0.02][numbers.below(2)],
        conformance: numbers.below(3) == 0,
        ..Settings::default()
    };
    if numbers.below(2) == 0 {
        settings.crop = Some([dvec3(3.5, 2.0, 6.25), dvec3(37.0, 28.5, 22.0)]);
        settings.clip_planes = vec![ClipPlane {
            normal: dvec3(0.3, -0.2, 0.9),
            offset: dvec3(0.3, -0.2, 0.9).dot(grid.center()) - 4.0,
        }];
    }
    settings
}

/// Some of the time as slices.
fn sliced(numbers: &mut Numbers, settings: &mut Settings) {
    let techniques = [
        Technique::Raycast,
        Technique::Raycast,
        Technique::Slices3d,
        Technique::Slices2d,
    ];
    settings.technique = techniques[numbers.below(4)];
    if settings.technique != Technique::Raycast {
        settings.lattice = Lattice::Ray;
    }
}

/// Towers of any height in some macro cells, so that rays meet several maxima, and a long step may lead from one into a
/// cell that knows nothing of it.
fn towers(numbers: &mut Numbers, as_bytes: bool) -> Volume {
    let heights: Vec<f64> = (0..512)
        .map(|_| (500.0 * numbers.next() - 250.0).max(0.0))
        .collect();
    let field = |p: DVec3| {
        let cell = (p / 8.0).floor();
        let height = heights[cell.dot(dvec3(1.0, 8.0, 64.0)) as usize % 512];
        let is_gap = (p - 8.0 * cell).cmpge(DVec3::splat(6.0)).any();
        if is_gap { 0.0 } else { height }
    };
    let made = volume_of(DIMS, sheared_affine(), field);
    let Voxels::F32(values) = &made.voxels else {
        unreachable!("made so")
    };
    if !as_bytes {
        return made;
    }
    let codes = values.iter().map(|&v| v as u8).collect();
    let (voxels, rescale) = (Voxels::U8(codes), Rescale::default());
    Volume::from_voxels(DIMS, sheared_affine(), voxels, rescale, None).expect("a right volume")
}

/// Pictures of random volumes and functions, one by one with and without leaving anything out.
fn compare_many(
    make: fn(&mut Numbers, bool) -> Volume,
    seed: u64,
    pictures: usize,
    most: f64,
    mut change: impl FnMut(&mut Numbers, &mut Settings, &mut TransferFunction, &Volume),
) {
    let mut numbers = Numbers(seed);
    let mut sums = [0.0; 2];
    for (as_bytes, caps) in [(true, CAPS[0]), (false, CAPS[0]), (true, CAPS[1])] {
        let volume = make(&mut numbers, as_bytes);
        let cameras = cameras(&volume.grid());
        let mut renderer = Renderer::new(device_with(caps()), &volume).expect("a renderer");
        for _ in 0..pictures {
            let mut function = hills(&mut numbers, volume.value_range);
            let mut settings = settings(&mut numbers, &volume);
            change(&mut numbers, &mut settings, &mut function, &volume);
            let scene = Scene {
                volume: &volume,
                transfer: Some(&function),
                beside: Default::default(),
                camera: &cameras[numbers.below(cameras.len())],
                extent_pixels: [36, 28],
                settings: &settings,
            };
            let found = samples_of_same_pictures(&mut renderer, &scene);
            assert!(found[0] <= found[1], "{found:?} samples");
            sums = [sums[0] + found[0], sums[1] + found[1]];
        }
    }
    let part = sums[0] / sums[1];
    assert!(part < most, "hardly anything was left out: {part}");
}

/// A shape somewhere in the upper half of the values.
fn widget(numbers: &mut Numbers, [low, high]: [f64; 2]) -> Widget {
    let range = high - low;
    let mut at = || low + range * (0.4 + 0.6 * numbers.next());
    let mut ends = [at(), at()];
    ends.sort_by(f64::total_cmp);
    let shape = match numbers.below(5) {
        0 => Shape::Rectangle {
            values: ends,
            gradients: [0.1, 2.0],
        },
        1 => Shape::Triangle {
            value: ends[1],
            half_width: 0.2 * range,
            threshold: 0.1,
            top: 1.0,
        },
        2 => Shape::Gaussian {
            value: ends[1],
            gradient: 0.3,
            sigma_value: 0.03 * range,
            sigma_gradient: 0.3,
        },
        3 => {
            let point = |(value, opacity)| OpacityPoint { value, opacity };
            let points = [(low, 0.0), (ends[0], 0.0), (ends[1], 0.7), (high, 0.0)];
            Shape::Region {
                points: points.map(point).into(),
            }
        }
        _ => Shape::Image {
            values: [low, high],
            gradients: [0.0, 1.0],
            columns: 4,
            cells: Cells::Shares(vec![0.0, 0.0, 0.0, 0.9, 0.0, 0.0, 0.4, 0.0]),
        },
    };
    Widget {
        srgb: [None, Some([0.9, 0.4, 0.1])][numbers.below(2)],
        opacity: [0.0, 0.4, 1.0][numbers.below(3)],
        shape,
        second: (numbers.below(4) == 0)
            .then_some(SecondDerivative::Trapezoid([-2.0, -0.5, 0.5, 2.0])),
    }
}

#[test]
fn functions_of_gradients_are_drawn_the_same_whatever_is_left_out() {
    compare_many(
        balls,
        3,
        share(8),
        0.8,
        |numbers, settings, function, volume| {
            let range = volume.value_range;
            let opacity = |(value, opacity)| OpacityPoint { value, opacity };
            if numbers.below(2) == 0 {
                function.opacity.clear();
            }
            function.gradient_transfer = Some(GradientTransfer {
                steepest: Some(0.3 * (range[1] - range[0])),
                share: [vec![], vec![opacity((0.0, 0.2)), opacity((1.0, 0.9))]][numbers.below(2)]
                    .clone(),
                widgets: (0..numbers.below(3))
                    .map(|_| widget(numbers, range))
                    .collect(),
            });
            if numbers.below(3) == 0 {
                settings.shading = Some(Shading::default());
            }
            sliced(numbers, settings);
            if settings.technique == Technique::Raycast && numbers.below(4) == 0 {
                (settings.mode, settings.lattice) = (Mode::Mida, Lattice::Ray);
                settings.per_mode.unit_values = range;
            }
        },
    );
}

/// A contour reaches as far as the gradient takes it, and no farther than the values around a sample let it be steep.
#[test]
fn contours_are_left_out_where_no_value_comes_near_them() {
    compare_many(
        balls,
        13,
        share(8),
        0.7,
        |numbers, settings, function, volume| {
            let [low, high] = volume.value_range;
            function.opacity.clear();
            let mut contour = || Widget {
                srgb: None,
                opacity: 0.8,
                shape: Shape::Contour {
                    value: low + (0.15 + 0.8 * numbers.next()) * (high - low),
                    half_width: [0.3, 1.0, 2.5][numbers.below(3)],
                },
                second: None,
            };
            function.gradient_transfer = Some(GradientTransfer {
                steepest: Some(0.3 * (high - low)),
                share: Vec::new(),
                widgets: vec![contour(), contour()],
            });
            sliced(numbers, settings);
        },
    );
}

#[test]
fn slabs_are_the_same_whatever_rays_leave_out() {
    compare_many(balls, 7, share(14), 0.8, |_, settings, _, _| {
        settings.preintegrated = true;
        if settings.lattice == Lattice::Bresenham {
            settings.lattice = Lattice::Planes;
        }
    });
}

#[test]
fn maxima_that_hang_on_what_lies_before_them_are_the_same_whatever_is_left_out() {
    let modes = [Mode::Mida, Mode::Lmip, Mode::AttenuatedMip];
    compare_many(towers, 9, 16, 0.95, |numbers, settings, _, volume| {
        let [low, high] = volume.value_range;
        let at = |part: f64| low + part * (high - low);
        settings.mode = modes[numbers.below(3)];
        settings.lattice = [Lattice::Ray, Lattice::Jitter][numbers.below(2)];
        settings.samples_per_voxel = [0.3, 0.7, 2.3][numbers.below(3)];
        let lower = at(0.5 * numbers.next());
        settings.per_mode.unit_values = [lower, high];
        settings.per_mode.lmip_threshold = at(numbers.next());
        settings.per_mode.mida_gamma = [-1.0, -0.4, 0.0, 0.5][numbers.below(4)];
        settings.per_mode.attenuation = [0.0, 2.0, 30.0][numbers.below(3)];
    });
}

/// Names of things in blocks, most of which are nothing.
fn labels(numbers: &mut Numbers) -> Volume {
    let [nx, ny, nz] = DIMS;
    let named = numbers.below(20) as u32;
    let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    let codes = all.map(|[x, y, z]| u8::from((x / 9 + 5 * (y / 8) + 7 * (z / 9)) % 20 == named));
    let (voxels, rescale) = (Voxels::U8(codes.collect()), Rescale::default());
    Volume::from_voxels(DIMS, sheared_affine(), voxels, rescale, None).expect("a right volume")
}

#[test]
fn mixtures_are_the_same_whatever_is_left_out() {
    let mut numbers = Numbers(13);
    let mut sums = [0.0; 2];
    for caps in CAPS {
        let volumes = [true, false].map(|as_bytes| balls(&mut numbers, as_bytes));
        let names = labels(&mut numbers);
        let all = vec![&volumes[0], &volumes[1], &names];
        let mut renderer = Renderer::several(device_with(caps()), all).expect("a renderer");
        let cameras = cameras(&names.grid());
        for _ in 0..share(14) {
            let functions = [0, 1].map(|n| hills(&mut numbers, volumes[n].value_range));
            let mut colors = hills(&mut numbers, [0.0, 1.0]);
            let point = |(value, opacity)| OpacityPoint { value, opacity };
            colors.opacity = [(0.4, 0.0), (0.6, 0.5)].map(point).into();
            let channel = |volume, transfer, role| Channel {
                volume,
                transfer: Some(transfer),
                role,
            };
            let role = [Role::Numbers, Role::Opacity][numbers.below(2)];
            let channels = [
                channel(&volumes[1], &functions[1], role),
                channel(&names, &colors, Role::Labels),
            ];
            let settings = settings(&mut numbers, &names);
            let scene = Scene {
                volume: &volumes[0],
                transfer: Some(&functions[0]),
                beside: Beside::Channels(&channels),
                camera: &cameras[numbers.below(cameras.len())],
                extent_pixels: [30, 26],
                settings: &settings,
            };
            let found = samples_of_same_pictures(&mut renderer, &scene);
            sums = [sums[0] + found[0], sums[1] + found[1]];
        }
    }
    let part = sums[0] / sums[1];
    assert!(part < 0.9, "hardly anything was left out: {part}");
}

#[test]
fn colours_with_an_alpha_are_the_same_whatever_is_left_out() {
    let mut numbers = Numbers(17);
    let mut sums = [0.0; 2];
    let far = dvec3(41.0, 30.0, 27.0);
    let color = volume_of(DIMS, sheared_affine(), |p| p.x / far.x);
    let center = numbers.point() * far;
    let ball = |p: DVec3| f64::from((p - center).length() < 5.0);
    let alpha = volume_of(DIMS, sheared_affine(), ball);
    let point = |(value, opacity)| OpacityPoint { value, opacity };
    let mut function = hills(&mut numbers, [0.0, 1.0]);
    function.opacity = [(0.1, 0.0), (1.0, 0.6)].map(point).into();
    let beside = [&color, &color, &alpha];
    let all = vec![&color, &color, &color, &alpha];
    let mut renderer = Renderer::several(device_with(Caps::UNLIMITED), all).expect("a renderer");
    let cameras = cameras(&color.grid());
    for _ in 0..6 {
        let settings = settings(&mut numbers, &color);
        let scene = Scene {
            volume: &color,
            transfer: Some(&function),
            beside: Beside::Colors(&beside),
            camera: &cameras[numbers.below(cameras.len())],
            extent_pixels: [30, 26],
            settings: &settings,
        };
        let found = samples_of_same_pictures(&mut renderer, &scene);
        sums = [sums[0] + found[0], sums[1] + found[1]];
    }
    let part = sums[0] / sums[1];
    assert!(part < 0.7, "hardly anything was left out: {part}");
}

#[test]
fn classified_voxels_are_the_same_whatever_is_left_out() {
    let mut numbers = Numbers(23);
    let mut sums = [0.0; 2];
    for has_holes in [false, true] {
        let mut volume = towers(&mut numbers, false);
        if has_holes {
            let count = volume.voxels.len();
            volume.validity = Some((0..count).map(|i| u8::from(i % 89 != 5)).collect());
        }
        let point = |(value, opacity)| OpacityPoint { value, opacity };
        let mut function = hills(&mut numbers, volume.value_range);
        function.opacity = [(225.0, 0.0), (240.0, 0.3), (250.0, 0.0)].map(point).into();
        let length = volume.grid().smallest_spacing();
        let made = preclassified(&volume, &function, length, ColorSpace::Linear).expect("volumes");
        let [red, beside @ ..] = &made;
        let beside: Vec<_> = beside.iter().collect();
        let all = made.iter().collect();
        let mut renderer =
            Renderer::several(device_with(Caps::UNLIMITED), all).expect("a renderer");
        // The last one stands among slices, for which shear-warp is not.
        let cameras = cameras(&volume.grid());
        for (technique, count) in [(Technique::Raycast, 3), (Technique::ShearWarp, 2)] {
            for (nth, camera) in cameras.iter().take(count).enumerate() {
                let mut settings = settings(&mut numbers, &volume);
                if technique != Technique::Raycast {
                    settings = Settings {
                        technique,
                        filter: Filter::Linear,
                        lattice: Lattice::Ray,
                        crop: settings.crop,
                        conformance: nth == 0,
                        ..Settings::default()
                    };
                }
                let scene = Scene {
                    volume: red,
                    transfer: Some(&function),
                    beside: Beside::Classified(&beside),
                    camera,
                    extent_pixels: [30, 26],
                    settings: &settings,
                };
                let found = samples_of_same_pictures(&mut renderer, &scene);
                sums = [sums[0] + found[0], sums[1] + found[1]];
            }
        }
    }
    let part = sums[0] / sums[1];
    assert!(part < 0.7, "hardly anything was left out: {part}");
}
