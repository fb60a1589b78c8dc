//! What rays leave out changes no bit of a picture.

use crate::shared::{device, device_with, oblique_camera, projections, share, volume_of};
use crate::skipping_shared::{Numbers, balls, cameras, hills, samples_of_same_pictures};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::Caps;
use stratavox::offscreen::Renderer;
use stratavox::scene::Scene;
use stratavox::technique::{
    ClipPlane, CutFaces, Filter, Jitter, Lattice, Level, Mode, Settings, Shading,
};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::Volume;

/// Every word that has a say in which samples there are.
fn settings(numbers: &mut Numbers, volume: &Volume) -> Settings {
    let grid = volume.grid();
    let modes = [
        Mode::Composite,
        Mode::Composite,
        Mode::Mip,
        Mode::Minip,
        Mode::Iso,
    ];
    let filters = [
        Filter::Linear,
        Filter::Linear,
        Filter::Nearest,
        Filter::Cubic,
        Filter::QuadraticSmooth,
        Filter::CatmullRom,
    ];
    let lattices = [
        Lattice::Ray,
        Lattice::Planes,
        Lattice::Jitter,
        Lattice::Bresenham,
    ];
    let mode = modes[numbers.below(modes.len())];
    let mut settings = Settings {
        mode,
        filter: filters[numbers.below(filters.len())],
        lattice: lattices[numbers.below(4)],
        jitter: Jitter { seed: 3, frame: 1 },
        samples_per_voxel: [0.3, 1.0, 2.3][numbers.below(3)],
        termination: [0.0, 0.02][numbers.below(2)],
        conformance: numbers.below(3) == 0,
        ..Settings::default()
    };
    if mode == Mode::Iso {
        settings.lattice = Lattice::Ray;
        let [low, high] = volume.value_range;
        let mut values = [numbers.next(), numbers.next()].map(|x| low + x * (high - low));
        values.sort_by(f64::total_cmp);
        let level = |value| Level {
            value,
            srgb: [0.9, 0.5, 0.2],
            opacity: 0.6,
        };
        settings.per_mode.levels = values.map(level).into();
        // Segments in bricks reach no farther than the voxels there.
        settings.filter = [Filter::Linear, Filter::Nearest][numbers.below(2)];
        settings.samples_per_voxel = settings.samples_per_voxel.max(1.0);
    }
    let is_composite = mode == Mode::Composite;
    if (is_composite || mode == Mode::Iso) && numbers.below(3) == 0 {
        settings.shading = Some(Shading::default());
    }
    if numbers.below(2) == 0 {
        settings.crop = Some([dvec3(3.5, 2.0, 6.25), dvec3(37.0, 28.5, 22.0)]);
        settings.clip_planes = vec![ClipPlane {
            normal: dvec3(0.3, -0.2, 0.9),
            offset: dvec3(0.3, -0.2, 0.9).dot(grid.center()) - 4.0,
        }];
        let has_faces = settings.lattice != Lattice::Bresenham;
        if is_composite && settings.shading.is_none() && has_faces {
            settings.cut_faces = [None, Some(CutFaces::Own)][numbers.below(2)];
        }
    }
    settings
}

fn compare_many(caps: impl Fn() -> Caps, seed: u64, pictures: usize, most: f64) {
    let mut numbers = Numbers(seed);
    let mut sums = [0.0; 2];
    for as_bytes in [true, false] {
        let volume = balls(&mut numbers, as_bytes);
        let cameras = cameras(&volume.grid());
        let mut renderer = Renderer::new(device_with(caps()), &volume).expect("a renderer");
        for _ in 0..share(pictures) {
            let function = hills(&mut numbers, volume.value_range);
            let settings = settings(&mut numbers, &volume);
            let is_iso = settings.mode == Mode::Iso;
            let scene = Scene {
                volume: &volume,
                transfer: Some(&function).filter(|_| !is_iso),
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
    assert!(
        sums[0] < most * sums[1],
        "hardly anything was left out: {sums:?}"
    );
}

#[test]
fn pictures_are_the_same_to_the_bit_whatever_rays_leave_out() {
    compare_many(|| Caps::UNLIMITED, 11, 30, 0.8);
}

#[test]
fn and_so_they_are_in_bricks() {
    let small = || Caps {
        max_image_dimension_3d: 19,
        ..Caps::UNLIMITED
    };
    compare_many(small, 5, 12, 0.95);
}

#[test]
fn of_a_ball_in_empty_space_few_samples_are_taken() {
    let ball = |p: DVec3| 100.0 * f64::from((p - 32.0).length() < 6.0);
    let volume = volume_of([64; 3], DAffine3::IDENTITY, ball);
    let point = |(value, opacity)| OpacityPoint { value, opacity };
    let function = TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: [(0.0, 0.0), (20.0, 0.0), (100.0, 0.5)].map(point).into(),
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    };
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[0]);
    let settings = Settings::default();
    let scene = Scene {
        volume: &volume,
        transfer: Some(&function),
        beside: Default::default(),
        camera: &camera,
        extent_pixels: [48; 2],
        settings: &settings,
    };
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    let [skipped, whole] = samples_of_same_pictures(&mut renderer, &scene);
    // The ball, cells of eight voxels and what they touch: 24 of 64 voxels along each axis at most.
    assert!(skipped < whole * 27.0 / 512.0 * 1.5, "{skipped} of {whole}");
    assert!(skipped > 0.0);
    // No function at all shows nothing: no sample is taken, and the picture is empty.
    let nothing = TransferFunction {
        opacity: Vec::new(),
        ..function.clone()
    };
    let scene = Scene {
        transfer: Some(&nothing),
        ..scene
    };
    let [skipped, whole] = samples_of_same_pictures(&mut renderer, &scene);
    assert!(skipped < whole / 20.0, "{skipped} of {whole}");
}

#[test]
fn a_voxel_at_the_border_of_a_cell_is_seen_from_the_cells_beside() {
    let bright = [
        [7, 12, 12],
        [12, 8, 12],
        [12, 12, 15],
        [16, 4, 4],
        [6, 17, 19],
        [17, 20, 9],
        [20, 20, 6],
        [3, 3, 17],
        [20, 6, 20],
        [4, 14, 4],
        [12, 20, 14],
    ];
    let at = |p: DVec3| [p.x as u32, p.y as u32, p.z as u32];
    let field = |p: DVec3| 100.0 * f64::from(bright.contains(&at(p)));
    let volume = volume_of([24; 3], DAffine3::IDENTITY, field);
    let point = |(value, opacity)| OpacityPoint { value, opacity };
    let function = TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: [(0.1, 0.0), (0.2, 0.5), (100.0, 0.9)].map(point).into(),
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    };
    let camera = oblique_camera(&volume.grid(), projections(&volume.grid())[0]);
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    let mut settings: Vec<_> = [
        Filter::Linear,
        Filter::QuadraticSmooth,
        Filter::CubicSmooth,
        Filter::CatmullRom,
    ]
    .map(|filter| Settings {
        filter,
        samples_per_voxel: 3.0,
        ..Settings::default()
    })
    .into();
    // The near end of a segment lies in another cell than its far end.
    let mut surfaces = Settings {
        mode: Mode::Iso,
        samples_per_voxel: 0.5,
        ..Settings::default()
    };
    surfaces.per_mode.levels = vec![Level {
        value: 30.0,
        srgb: [1.0; 3],
        opacity: 0.5,
    }];
    settings.push(surfaces);
    for settings in settings {
        let is_iso = settings.mode == Mode::Iso;
        let scene = Scene {
            volume: &volume,
            transfer: Some(&function).filter(|_| !is_iso),
            beside: Default::default(),
            camera: &camera,
            extent_pixels: [96; 2],
            settings: &settings,
        };
        let [skipped, whole] = samples_of_same_pictures(&mut renderer, &scene);
        assert!(skipped < whole, "{settings:?}: {skipped} of {whole}");
    }
}

/// Small balls far from one another, looked at through wide and narrow lenses, from outside and from between them, in
/// pictures whose tiles are wider and narrower than a cell.
#[test]
fn tiles_that_meet_nothing_are_left_out_and_no_others() {
    let mut numbers = Numbers(23);
    let side = 96.0;
    let centers: Vec<_> = (0..4).map(|_| side * numbers.point()).collect();
    let ball = |p: DVec3| {
        let is_inside = |&center: &DVec3| (p - center).length() < 1.5;
        100.0 * f64::from(centers.iter().any(is_inside))
    };
    let volume = volume_of([96, 96, 96], DAffine3::IDENTITY, ball);
    let point = |(value, opacity)| OpacityPoint { value, opacity };
    let function = TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: [(20.0, 0.0), (100.0, 0.7)].map(point).into(),
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    };
    for caps in [
        Caps::UNLIMITED,
        Caps {
            max_image_dimension_3d: 56,
            ..Caps::UNLIMITED
        },
    ] {
        let mut renderer = Renderer::new(device_with(caps), &volume).expect("a renderer");
        let mut sums = [0.0; 2];
        for number in 0..24 {
            let per_side = 1 + numbers.below(2) as u32;
            let mode = [Mode::Composite, Mode::Composite, Mode::Mida, Mode::Mip][numbers.below(4)];
            let lattice = [
                Lattice::Ray,
                Lattice::Planes,
                Lattice::Jitter,
                Lattice::Bresenham,
            ][numbers.below(4)];
            let settings = Settings {
                mode,
                lattice: match mode {
                    Mode::Mida => Lattice::Ray,
                    _ => lattice,
                },
                rays_per_side: per_side,
                uneven_rays: per_side > 1,
                jitter: Jitter { seed: 5, frame: 2 },
                ..Settings::default()
            };
            let away = [0.0, 90.0, 400.0, 1e5][numbers.below(4)];
            let target = side * numbers.point();
            let eye = target + (1.0 + away) * (numbers.point() - 0.5);
            let height = [2.0, 60.0, 200.0][numbers.below(3)];
            let camera = Camera {
                eye,
                target,
                up: DVec3::Z,
                zoom: 1.0,
                projection: match numbers.below(2) {
                    0 => Projection::Orthographic {
                        view_height: height,
                    },
                    _ => Projection::Perspective {
                        fov_degrees: [5.0, 40.0, 150.0][numbers.below(3)],
                    },
                },
            };
            let scene = Scene {
                volume: &volume,
                transfer: Some(&function),
                beside: Default::default(),
                camera: &camera,
                extent_pixels: [9 + numbers.below(150) as u32, 7 + numbers.below(100) as u32],
                settings: &settings,
            };
            let found = samples_of_same_pictures(&mut renderer, &scene);
            assert!(found[0] <= found[1], "{number}: {found:?} samples");
            sums = [sums[0] + found[0], sums[1] + found[1]];
        }
        assert!(
            sums[0] < 0.5 * sums[1],
            "hardly anything was left out: {sums:?}"
        );
    }
}
