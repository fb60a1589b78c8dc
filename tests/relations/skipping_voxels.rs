//! What says where rays need not look, macro cells, an octree or runs of single voxels, changes no bit of a picture: of all filters,
//! on all lattices, with light and without, of bytes and of floats, with holes, by functions of gradients too.

use crate::shared::{device, device_with, share};
use crate::skipping_shared::{DIMS, Numbers, balls, cameras, hills, samples_of_same_pictures};
use glam::dvec3;
use stratavox::gpu::Caps;
use stratavox::offscreen::{Error, Renderer};
use stratavox::scene::{Beside, Scene};
use stratavox::technique::{
    self, ClipPlane, Filter, FilterBy, Jitter, Lattice, Mode, Settings, Shading, SkipBy, Technique,
};
use stratavox::transfer::{GradientTransfer, Shape, TransferFunction, Widget};
use stratavox::volume::Volume;

const FILTERS: [Filter; 12] = [
    Filter::Nearest,
    Filter::Linear,
    Filter::Quadratic,
    Filter::Cubic,
    Filter::QuadraticSmooth,
    Filter::CubicSmooth,
    Filter::CatmullRom,
    Filter::Linear,
    Filter::Linear,
    Filter::Linear,
    Filter::Linear,
    Filter::Linear,
];
const WAYS: [SkipBy; 3] = [SkipBy::Cells, SkipBy::Octree, SkipBy::Runs];

fn settings(numbers: &mut Numbers, volume: &Volume, filter: Filter) -> Settings {
    let lattices = [
        Lattice::Ray,
        Lattice::Planes,
        Lattice::Jitter,
        Lattice::Bresenham,
    ];
    let mut settings = Settings {
        filter,
        filter_by: [FilterBy::Auto, FilterBy::Sampler, FilterBy::Fetch][numbers.below(3)],
        lattice: lattices[numbers.below(4)],
        jitter: Jitter { seed: 3, frame: 1 },
        samples_per_voxel: [0.3, 1.0, 2.3][numbers.below(3)],
        termination: [0.0, 0.02][numbers.below(2)],
        conformance: numbers.below(4) == 0,
        shading: (numbers.below(2) == 0).then(Shading::default),
        ..Settings::default()
    };
    if numbers.below(3) == 0 {
        settings.crop = Some([dvec3(3.5, 2.0, 6.25), dvec3(37.0, 28.5, 22.0)]);
        let normal = dvec3(0.3, -0.2, 0.9);
        settings.clip_planes = vec![ClipPlane {
            normal,
            offset: normal.dot(volume.grid().center()) - 4.0,
        }];
    }
    settings
}

/// By values, or by a contour of them alone.
fn function(numbers: &mut Numbers, [low, high]: [f64; 2]) -> TransferFunction {
    let mut function = hills(numbers, [low, high]);
    if numbers.below(4) == 0 {
        function.opacity.clear();
        function.gradient_transfer = Some(GradientTransfer {
            steepest: Some(0.3 * (high - low)),
            share: Vec::new(),
            widgets: vec![Widget {
                srgb: None,
                opacity: 0.8,
                shape: Shape::Contour {
                    value: low + (0.15 + 0.8 * numbers.next()) * (high - low),
                    half_width: 1.0,
                },
                second: None,
            }],
        });
    }
    function
}

fn with_holes(numbers: &mut Numbers, volume: Volume) -> Volume {
    let count = DIMS.iter().product::<u32>();
    let validity = (0..count).map(|_| u8::from(numbers.below(9) != 0));
    Volume {
        validity: Some(validity.collect()),
        ..volume
    }
}

#[test]
fn pictures_are_the_same_to_the_bit_by_whatever_rays_leave_out() {
    let mut numbers = Numbers(31);
    // Samples by cells, octree and runs; all.
    let mut sums = [0.0; 4];
    // Where one filter of three is drawn, each volume has others.
    let kinds = [(true, false), (false, false), (true, true)];
    for (nth, (as_bytes, has_holes)) in kinds.into_iter().enumerate() {
        let volume = balls(&mut numbers, as_bytes);
        let volume = match has_holes {
            true => with_holes(&mut numbers, volume),
            false => volume,
        };
        let cameras = cameras(&volume.grid());
        let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
        let mut filters = FILTERS.to_vec();
        filters.rotate_left(4 * nth);
        for &filter in &filters[..share(FILTERS.len())] {
            let function = function(&mut numbers, volume.value_range);
            let settings = settings(&mut numbers, &volume, filter);
            let camera = cameras[numbers.below(cameras.len())];
            for (n, empty_space) in WAYS.into_iter().enumerate() {
                let settings = Settings {
                    empty_space,
                    ..settings.clone()
                };
                let scene = Scene {
                    volume: &volume,
                    transfer: Some(&function),
                    beside: Beside::Nothing,
                    camera: &camera,
                    extent_pixels: [36, 28],
                    settings: &settings,
                };
                let [found, all] = samples_of_same_pictures(&mut renderer, &scene);
                sums[n] += found;
                sums[3] += all / 3.0;
            }
        }
    }
    println!("{sums:?} samples by cells, octree, runs; all");
    let [cells, octree, runs, all] = sums;
    // Cells without matter are cubes of voxels without.
    assert!(octree < 0.9 * cells && cells < 0.9 * all, "{sums:?}");
    // One set of voxels. The last sample of a ray, which is cut short, is left out by longer leaps alone.
    assert!(octree <= runs && runs < 0.9 * cells, "{sums:?}");
}

#[test]
fn a_function_that_is_changed_and_changed_back_shows_the_same() {
    let mut numbers = Numbers(5);
    let volume = balls(&mut numbers, true);
    let functions = [(); 2].map(|()| hills(&mut numbers, volume.value_range));
    let camera = cameras(&volume.grid())[0];
    for empty_space in [SkipBy::Octree, SkipBy::Runs] {
        let settings = Settings {
            empty_space,
            ..Settings::default()
        };
        let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
        let mut pixels = |n: usize| {
            let scene = Scene {
                volume: &volume,
                transfer: Some(&functions[n]),
                beside: Beside::Nothing,
                camera: &camera,
                extent_pixels: [36, 28],
                settings: &settings,
            };
            renderer
                .render(&scene, &[])
                .expect("a picture")
                .picture
                .pixels
        };
        let [first, other, again] = [0, 1, 0].map(&mut pixels);
        assert!(first == again, "{empty_space}");
        assert!(first != other, "two functions alike");
    }
}

#[test]
fn pictures_that_do_not_go_by_single_voxels_are_refused_by_name() {
    let by_octree = || Settings {
        empty_space: SkipBy::Octree,
        ..Settings::default()
    };
    type Change = fn(&mut Settings);
    let changes: [(&str, Change); 4] = [
        ("ray casting", |s| s.technique = Technique::Slices3d),
        ("composite", |s| s.mode = Mode::Mip),
        ("samples that are points", |s| s.preintegrated = true),
        ("samples that are points", |s| s.adaptive_steps = Some(0.1)),
    ];
    for (wanted, change) in changes {
        let mut settings = by_octree();
        change(&mut settings);
        let found = settings.check_ways();
        assert!(
            matches!(found, Err(technique::Error::NotFor { of, .. }) if of == wanted),
            "{wanted}: {found:?}"
        );
    }
    let mut numbers = Numbers(5);
    let volume = balls(&mut numbers, true);
    let function = hills(&mut numbers, volume.value_range);
    let small = Caps {
        max_image_dimension_3d: 19,
        ..Caps::UNLIMITED
    };
    let mut bricked = Renderer::new(device_with(small), &volume).expect("a renderer");
    // Not from corners, which lie in one texture.
    let settings = Settings {
        conformance: true,
        ..by_octree()
    };
    let scene = Scene {
        volume: &volume,
        transfer: Some(&function),
        beside: Beside::Nothing,
        camera: &cameras(&volume.grid())[0],
        extent_pixels: [36, 28],
        settings: &settings,
    };
    let found = bricked.render(&scene, &[]).map(|_| ());
    assert!(
        matches!(
            found,
            Err(Error::Technique(technique::Error::NotFor { .. }))
        ),
        "{found:?}"
    );
}
