//! Classified voxels of shear-warp lie in runs: the pictures are those of four dense volumes.
//!
//! The dense ones are the same numbers in halves with a rescale by 2, which runs are not made of: a factor of 2 changes no
//! bit of any sum. Seen along an axis from a place of few binary digits samples lie in their slices exactly, and so no bit may
//! differ; from elsewhere textures mix in some of the next slice, where runs do not.

use crate::shared::{device, oblique_camera, projections, share, sheared_affine};
use crate::skipping_shared::Numbers;
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::Headless;
use stratavox::offscreen::Renderer;
use stratavox::picture::Picture;
use stratavox::resident::RunsSize;
use stratavox::scene::{Beside, Scene};
use stratavox::technique::{
    AmbientOcclusion, Filter, FilterBy, Intermediate, Settings, Shading, Technique,
};
use stratavox::transfer::{Interpolation, TransferFunction};
use stratavox::volume::{Rescale, Volume, Voxels};

/// Of classified voxels nothing but the reference length.
fn function() -> TransferFunction {
    TransferFunction {
        color: Vec::new(),
        opacity: Vec::new(),
        reference_length: Some(1.0),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// Red, green and blue times depth, and depth, of voxels of which about this share is full. All numbers are 16-bit floats.
struct Classified {
    dims: [u32; 3],
    affine: DAffine3,
    numbers: [Vec<f32>; 4],
    validity: Option<Vec<u8>>,
}

impl Classified {
    fn random(numbers: &mut Numbers, dims: [u32; 3], affine: DAffine3, share: f64) -> Self {
        let count = dims.iter().product::<u32>() as usize;
        let mut made: [Vec<f32>; 4] = std::array::from_fn(|_| vec![0.0; count]);
        for n in 0..count {
            if numbers.next() < share {
                let depth = (1 + numbers.below(32)) as f32 / 64.0;
                let color: [f32; 3] = std::array::from_fn(|_| numbers.below(17) as f32 / 16.0);
                let [r, g, b] = color.map(|c| c * depth);
                made.iter_mut()
                    .zip([r, g, b, depth])
                    .for_each(|(of, x)| of[n] = x);
            }
        }
        Self {
            dims,
            affine,
            numbers: made,
            validity: None,
        }
    }

    fn volumes(&self, part: f32) -> Vec<Volume> {
        let made = |numbers: &Vec<f32>| {
            let stored = numbers.iter().map(|n| part * n).collect();
            let rescale = Rescale {
                slope: f64::from(1.0 / part),
                intercept: 0.0,
            };
            let voxels = Voxels::F32(stored);
            let made = Volume::from_voxels(self.dims, self.affine, voxels, rescale, None);
            Volume {
                validity: self.validity.clone(),
                ..made.expect("a right volume")
            }
        };
        self.numbers.iter().map(made).collect()
    }

    /// How many voxels have depth and data, and how many runs there are of them along x.
    fn full_and_runs(&self) -> [u64; 2] {
        let is_valid = |n: usize| self.validity.as_ref().is_none_or(|valid| valid[n] != 0);
        let full: Vec<bool> = self.numbers[3]
            .iter()
            .enumerate()
            .map(|(n, &depth)| depth > 0.0 && is_valid(n))
            .collect();
        let runs = full.chunks(self.dims[0] as usize).map(|row| {
            let starts = (0..row.len()).filter(|&i| row[i] && (i == 0 || !row[i - 1]));
            starts.count() as u64
        });
        [full.iter().filter(|full| **full).count() as u64, runs.sum()]
    }
}

/// A picture and the runs that it read.
fn drawn(
    device: Headless,
    volumes: &[Volume],
    camera: &Camera,
    settings: &Settings,
) -> (Picture, Option<RunsSize>, Headless) {
    let function = function();
    let beside: Vec<_> = volumes[1..].iter().collect();
    let mut renderer = Renderer::several(device, volumes.iter().collect()).expect("a renderer");
    let scene = Scene {
        volume: &volumes[0],
        transfer: Some(&function),
        beside: Beside::Classified(&beside),
        camera,
        extent_pixels: [148, 148],
        settings,
    };
    let picture = renderer.render(&scene, &[]).expect("a picture").picture;
    (picture, renderer.runs(), renderer.into_device())
}

/// The pictures by runs and by dense volumes.
fn both(
    device: Headless,
    classified: &Classified,
    camera: &Camera,
    settings: &Settings,
) -> ([Picture; 2], Headless) {
    let (by_runs, size, device) = drawn(device, &classified.volumes(1.0), camera, settings);
    let (dense, none, device) = drawn(device, &classified.volumes(0.5), camera, settings);
    let size = size.expect("runs");
    assert_eq!([size.full, size.runs], classified.full_and_runs());
    let [nx, ny, nz] = classified.dims;
    let words = u64::from(nx.div_ceil(32) * ny * nz);
    let payload = if settings.conformance { 16 } else { 8 };
    // In rows of 4096 texels, where there is more than one.
    let texels = |count: u64| match count {
        0..=4096 => count.max(1),
        _ => count.next_multiple_of(4096),
    };
    assert_eq!(size.bytes, 8 * texels(words) + payload * texels(size.full));
    assert_eq!(none, None, "dense");
    ([by_runs, dense], device)
}

/// Along an axis, from places of few binary digits, with base pixels between voxels: all sums of places are exact.
fn along(classified: &Classified, axis: usize, sign: f64) -> Camera {
    let center = 0.5 * DVec3::from(classified.dims.map(f64::from));
    let mut back = DVec3::ZERO;
    back[axis] = 64.0 * sign;
    Camera {
        eye: center + back,
        target: center,
        up: DVec3::AXES[(axis + 1) % 3],
        projection: Projection::Orthographic { view_height: 74.0 },
        zoom: 1.0,
    }
}

fn settings() -> Settings {
    Settings {
        technique: Technique::ShearWarp,
        intermediate: Intermediate::PerVoxel(2.0),
        conformance: true,
        ..Settings::default()
    }
}

fn bits(picture: &Picture) -> Vec<u32> {
    let numbers = picture.pixels.as_flattened().iter();
    numbers.map(|n| n.to_bits()).collect()
}

#[test]
fn rows_of_all_lengths_around_words_are_seen_as_dense_volumes_are() {
    let mut numbers = Numbers(31);
    let mut there = device();
    let mut seen = 0;
    for long in 0..3 {
        for count in [31, 32, 33, 63, 64, 65] {
            let mut dims = [5, 4, 6];
            dims[long] = count;
            let shares: &[f64] = if count == 33 {
                &[0.0, 0.04, 0.5, 1.0]
            } else {
                &[0.3]
            };
            for &part in shares {
                let classified = Classified::random(&mut numbers, dims, DAffine3::IDENTITY, part);
                for axis in 0..3 {
                    let sign = [1.0, -1.0][numbers.below(2)];
                    let camera = along(&classified, axis, sign);
                    let ([by_runs, dense], device) = both(there, &classified, &camera, &settings());
                    there = device;
                    assert!(
                        bits(&by_runs) == bits(&dense),
                        "{dims:?}, {part} full, along {axis} by {sign}"
                    );
                    seen += dense.pixels.iter().filter(|p| p[3] > 0.1).count();
                }
            }
        }
    }
    assert!(seen > 10_000, "{seen} pixels are drawn");
}

#[test]
fn light_holes_nearest_voxels_and_crops_are_those_of_dense_volumes() {
    let mut numbers = Numbers(7);
    let mut there = device();
    for round in 0..share(12) {
        let mut classified = Classified::random(&mut numbers, [37, 9, 11], DAffine3::IDENTITY, 0.4);
        if round % 2 == 0 {
            let count = classified.numbers[0].len();
            let validity = (0..count).map(|_| u8::from(numbers.next() > 0.02));
            classified.validity = Some(validity.collect());
        }
        let settings = Settings {
            shading: (numbers.below(2) == 0).then(Shading::default),
            filter: [Filter::Linear, Filter::Nearest][numbers.below(2)],
            crop: (numbers.below(2) == 0).then_some([dvec3(3.0, 2.0, 2.0), dvec3(33.5, 8.0, 10.0)]),
            ..settings()
        };
        let camera = along(&classified, numbers.below(3), 1.0);
        let ([by_runs, dense], device) = both(there, &classified, &camera, &settings);
        there = device;
        assert!(bits(&by_runs) == bits(&dense), "{settings:?}");
        assert!(dense.pixels.iter().any(|p| p[3] > 0.1), "{settings:?}");
    }
}

/// Of 16 bits too: the numbers are such floats.
#[test]
fn nearest_voxels_are_the_same_from_everywhere() {
    let mut numbers = Numbers(19);
    let mut there = device();
    let classified = Classified::random(&mut numbers, [34, 21, 17], sheared_affine(), 0.1);
    let grid = classified.volumes(1.0)[0].grid();
    for projection in projections(&grid) {
        for conformance in [true, false] {
            for intermediate in [Intermediate::PerVoxel(1.0), Intermediate::Pixels] {
                let settings = Settings {
                    filter: Filter::Nearest,
                    conformance,
                    intermediate,
                    ..settings()
                };
                let camera = oblique_camera(&grid, projection);
                let ([by_runs, dense], device) = both(there, &classified, &camera, &settings);
                there = device;
                assert!(bits(&by_runs) == bits(&dense), "{settings:?}");
                assert!(dense.pixels.iter().any(|p| p[3] > 0.1), "{settings:?}");
            }
        }
    }
}

/// What textures mix in of the next slice: a sample at `o + t d`, numbers of up to R voxels, is off its slice by
///
/// ```text
/// delta = 8 R 2^-24           and so its numbers by delta times the largest; of N slices pixels by N delta of light and of depth
/// ```
#[test]
fn between_voxels_of_oblique_slices_no_more_differs_than_rounding_of_places() {
    let mut numbers = Numbers(11);
    let mut there = device();
    let classified = Classified::random(&mut numbers, [34, 21, 17], sheared_affine(), 0.1);
    let grid = classified.volumes(1.0)[0].grid();
    for projection in projections(&grid) {
        let camera = oblique_camera(&grid, projection);
        let voxel_from_world = grid.world_from_voxel.inverse();
        let eye = voxel_from_world.transform_point3(camera.eye);
        let reach = eye.abs().max_element().max(34.0);
        let delta = 8.0 * reach / f64::from(1 << 24);
        let bound = (2.0 * 34.0 * delta * 0.5) as f32;
        let ([by_runs, dense], device) = both(there, &classified, &camera, &settings());
        there = device;
        let pairs = by_runs.pixels.iter().zip(&dense.pixels);
        let off = pairs.flat_map(|(a, b)| (0..4).map(move |k| (a[k] - b[k]).abs()));
        let off = off.fold(0.0, f32::max);
        println!("{projection:?}: {off:e} of {bound:e}");
        assert!(off <= bound, "{projection:?}: {off:e}, not {bound:e}");
        assert!(dense.pixels.iter().any(|p| p[3] > 0.1));
    }
}

/// Numbers of 16 bits are off by e = 2^-11 of each, so a depth too, and a colour by twice as much:
///
/// ```text
/// opacity 1 - exp(-d)     d exp(-d) e <= e / exp(1)
/// light                   2 e more
/// ```
#[test]
fn sixteen_bits_are_near_to_thirty_two() {
    let mut numbers = Numbers(5);
    let mut classified = Classified::random(&mut numbers, [34, 21, 17], sheared_affine(), 0.3);
    // Not to be held by 16 bits.
    let noise: Vec<f32> = (0..classified.numbers[3].len())
        .map(|_| 1.0 + 0.01 * numbers.next() as f32)
        .collect();
    for of in &mut classified.numbers {
        of.iter_mut().zip(&noise).for_each(|(x, noise)| *x *= noise);
    }
    let grid = classified.volumes(1.0)[0].grid();
    let camera = oblique_camera(&grid, projections(&grid)[1]);
    let of = |conformance| Settings {
        conformance,
        filter_by: FilterBy::Fetch,
        termination: 0.0,
        ..settings()
    };
    let volumes = classified.volumes(1.0);
    let (halves, half, there) = drawn(device(), &volumes, &camera, &of(false));
    let (singles, single, _) = drawn(there, &volumes, &camera, &of(true));
    let [half, single] = [half, single].map(|size| size.expect("runs"));
    assert_eq!(single.full, half.full);
    assert!(single.bytes > half.bytes);
    let pairs = halves.pixels.iter().zip(&singles.pixels);
    let off = pairs.map(|(a, b)| (0..4).map(|k| (a[k] - b[k]).abs()).fold(0.0, f32::max));
    let off = off.fold(0.0, f32::max);
    let bound = 2f32.powi(-11) * (2.0 + 1.0 / std::f32::consts::E) + 2e-6;
    println!("{off:e} of {bound:e}");
    assert!(off > 0.0 && off <= bound, "{off:e}, not {bound:e}");
}

/// Samples between slices, light that matter hinders, a sampler that is asked for, and numbers that 16 bits do not hold.
#[test]
fn what_runs_are_not_for_is_drawn_of_dense_volumes() {
    let mut numbers = Numbers(3);
    let mut classified = Classified::random(&mut numbers, [33, 9, 8], DAffine3::IDENTITY, 0.4);
    let camera = along(&classified, 2, 1.0);
    let occlusion = AmbientOcclusion {
        strength: 0.5,
        radius_world: None,
    };
    let ordinary = Settings {
        conformance: false,
        ..settings()
    };
    let others = [
        Settings {
            samples_per_voxel: 2.0,
            ..settings()
        },
        Settings {
            ambient_occlusion: Some(occlusion),
            ..settings()
        },
        Settings {
            filter_by: FilterBy::Sampler,
            ..ordinary.clone()
        },
        Settings {
            technique: Technique::Raycast,
            ..settings()
        },
    ];
    let mut there = device();
    for other in others {
        let (_, size, device) = drawn(there, &classified.volumes(1.0), &camera, &other);
        assert_eq!(size, None, "{other:?}");
        there = device;
    }
    let (_, size, device) = drawn(there, &classified.volumes(1.0), &camera, &ordinary);
    assert!(size.is_some());
    classified.numbers[3][100] = 70_000.0;
    let (_, size, device) = drawn(device, &classified.volumes(1.0), &camera, &ordinary);
    assert_eq!(size, None);
    let (_, size, _) = drawn(device, &classified.volumes(1.0), &camera, &settings());
    assert!(size.is_some(), "32 bits hold it");
}

/// As when a function is changed and changed back.
#[test]
fn the_same_voxels_make_the_same_picture_after_others() {
    let mut numbers = Numbers(29);
    let [one, other] = [0.2, 0.6]
        .map(|part| Classified::random(&mut numbers, [33, 12, 10], sheared_affine(), part));
    let grid = one.volumes(1.0)[0].grid();
    let camera = oblique_camera(&grid, projections(&grid)[0]);
    let mut there = device();
    let mut pictures = Vec::new();
    for classified in [&one, &other, &one] {
        let (picture, size, device) = drawn(there, &classified.volumes(1.0), &camera, &settings());
        there = device;
        pictures.push((bits(&picture), size));
    }
    assert!(pictures[0] == pictures[2] && pictures[0] != pictures[1]);
}
