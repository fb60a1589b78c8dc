//! A volume that is drawn brick by brick from its source is the same picture as one in memory.

use crate::shared::{device, oblique_camera, projections, ramps, waves};
use crate::streaming_shared::{Numbers, open};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use stratavox::camera::{Camera, Projection};
use stratavox::geometry::{Geometry, RoundCones, Vertex};
use stratavox::offscreen::{Renderer, Stream, StreamOptions};
use stratavox::picture::{LayerKind, Picture};
use stratavox::scene::Scene;
use stratavox::technique::{
    ClipPlane, Filter, Jitter, Lattice, Level, Mode, Settings, Shading, Technique,
};
use stratavox::volume::{Source, TimeComponent, Volume};

fn scene<'a>(
    volume: &'a Volume,
    transfer: &'a stratavox::transfer::TransferFunction,
    camera: &'a Camera,
    settings: &'a Settings,
) -> Scene<'a> {
    Scene {
        volume,
        transfer: Some(transfer),
        beside: Default::default(),
        camera,
        extent_pixels: [44, 35],
        settings,
    }
}

const SMALL: StreamOptions = StreamOptions {
    side: 16,
    piece_bytes: 30_000,
    device_bytes: 200_000,
    all_device_bytes: u64::MAX,
};

/// The same in many small bricks.
const TINY: StreamOptions = StreamOptions {
    side: 8,
    piece_bytes: 30_000,
    device_bytes: 600_000,
    all_device_bytes: u64::MAX,
};

/// Pictures of everything that a stream can be drawn with; texels are fetched, so that bricks change no bit.
fn settings() -> Vec<Settings> {
    let base = Settings {
        technique: Technique::Raycast,
        conformance: true,
        ..Settings::default()
    };
    let of = |mode, filter| Settings {
        mode,
        filter,
        ..base.clone()
    };
    let mut all: Vec<_> = [
        (Mode::Composite, Filter::Linear),
        (Mode::Composite, Filter::Nearest),
        (Mode::Composite, Filter::CatmullRom),
        (Mode::Mip, Filter::Linear),
        (Mode::Minip, Filter::Linear),
        (Mode::Average, Filter::Linear),
        (Mode::Xray, Filter::Nearest),
        (Mode::Lmip, Filter::Linear),
        (Mode::AttenuatedMip, Filter::Linear),
        (Mode::Mida, Filter::Linear),
    ]
    .map(|(mode, filter)| of(mode, filter))
    .into();
    let composite = || of(Mode::Composite, Filter::Linear);
    all.push(Settings {
        termination: 0.05,
        ..composite()
    });
    all.push(Settings {
        lattice: Lattice::Planes,
        ..composite()
    });
    all.push(Settings {
        lattice: Lattice::Bresenham,
        ..composite()
    });
    all.push(Settings {
        lattice: Lattice::Jitter,
        jitter: Jitter { seed: 5, frame: 2 },
        rays_per_side: 2,
        ..composite()
    });
    all.push(Settings {
        shading: Some(Shading::default()),
        ..composite()
    });
    let middle = crate::shared::sheared_affine().transform_point3(glam::dvec3(12.0, 10.0, 9.0));
    let normal = glam::dvec3(0.3, 1.0, -0.2);
    all.push(Settings {
        clip_planes: vec![ClipPlane {
            normal,
            offset: normal.dot(middle),
        }],
        crop: Some([glam::dvec3(2.5, 0.0, 3.0), glam::dvec3(19.0, 20.25, 16.0)]),
        ..composite()
    });
    let mut surface = of(Mode::Iso, Filter::Linear);
    surface.per_mode.levels = vec![Level {
        value: 0.6,
        srgb: [0.9, 0.6, 0.3],
        opacity: 0.7,
    }];
    surface.shading = Some(Shading::default());
    all.push(surface);
    all
}

fn assert_same(source: Numbers, settings: &[Settings]) {
    assert_same_beside(source, settings, None);
}

fn assert_same_beside(source: Numbers, settings: &[Settings], geometry: Option<Arc<Geometry>>) {
    let source = Arc::new(source);
    let volume = source.in_memory();
    let stream = open(&source, SMALL);
    assert!(stream.brick_count() >= 8, "{} bricks", stream.brick_count());
    assert_eq!(stream.outline().value_range, volume.value_range);
    assert!(stream.outline().is_outline());
    let mut whole = Renderer::new(device(), &volume).expect("a renderer");
    let mut streamed = Renderer::streamed(device(), &stream).expect("a renderer");
    for renderer in [&mut whole, &mut streamed] {
        renderer.set_geometry(geometry.clone());
    }
    for projection in projections(&volume.grid()) {
        let camera = oblique_camera(&volume.grid(), projection);
        for settings in settings {
            let layers = match settings.mode {
                Mode::Composite => &[LayerKind::Depth, LayerKind::Transmittance][..],
                _ => &[LayerKind::Depth],
            };
            let transfer = ramps();
            let render = |renderer: &mut Renderer, volume| -> Picture {
                let scene = scene(volume, &transfer, &camera, settings);
                renderer.render(&scene, layers).expect("a picture").picture
            };
            let wanted = render(&mut whole, &volume);
            let found = render(&mut streamed, stream.outline());
            let drawn = wanted.pixels.iter().filter(|p| p[3] > 0.0).count();
            assert!(drawn > 100, "{settings:?}: only {drawn} pixels are drawn");
            let pairs = wanted.pixels.iter().zip(&found.pixels);
            let differ = pairs.filter(|(a, b)| a != b).count();
            assert_eq!(differ, 0, "{settings:?}: pixels that differ, of {drawn}");
            let bits = |picture: &Picture| -> Vec<u32> {
                let layers = picture.layers.iter().flat_map(|layer| &layer.values);
                layers.map(|value| value.to_bits()).collect()
            };
            assert!(bits(&wanted) == bits(&found), "{settings:?}: layers");
        }
    }
}

#[test]
fn a_streamed_picture_is_bit_identical() {
    assert_same(Numbers::of([25, 21, 18], None, waves), &settings());
}

#[test]
fn rays_through_every_brick_end_at_geometry() {
    let affine = crate::shared::sheared_affine();
    let vertex = |x: f64, radius: f64| Vertex {
        place: affine.transform_point3(glam::dvec3(x, 10.0, 9.0)),
        radius: radius * affine.matrix3.x_axis.length(),
        color: [1.0, 0.5, 0.0],
    };
    let mut cones = RoundCones::default();
    cones.add_line([vertex(-2.0, 3.0), vertex(27.0, 1.5)]);
    let some = [0, 3, 9, 15].map(|nth| settings()[nth].clone());
    let geometry = Some(Arc::new(cones.into()));
    assert_same_beside(Numbers::of([25, 21, 18], None, waves), &some, geometry);
}

#[test]
fn holes_stay_holes_in_every_brick() {
    let holed = |p: glam::DVec3| match p.distance(glam::dvec3(9.0, 11.0, 8.5)) < 4.0 {
        true => -7.0,
        false => waves(p),
    };
    let some = [0, 1, 3, 13].map(|nth| settings()[nth].clone());
    assert_same(Numbers::of([25, 21, 18], Some(-7.0), holed), &some);
}

/// A ball in the middle of nothing.
fn ball(p: glam::DVec3) -> f64 {
    f64::from(p.distance(glam::dvec3(12.0, 12.0, 44.0)) < 4.0)
}

#[test]
fn neighbours_along_x_are_read_together_and_the_picture_is_the_same() {
    let some = [0, 1, 13, 15].map(|nth| settings()[nth].clone());
    assert_same(Numbers::of([25, 21, 18], None, waves).by_rows(), &some);
    let reads_of = |source: Numbers, piece_bytes| {
        let source = Arc::new(source);
        let options = StreamOptions {
            piece_bytes,
            device_bytes: 1 << 30,
            ..SMALL
        };
        let stream = open(&source, options);
        let grid = stream.outline().grid();
        let camera = oblique_camera(&grid, projections(&grid)[0]);
        let transfer = ramps();
        let settings = Settings {
            skip: false,
            ..Settings::default()
        };
        let scene = scene(stream.outline(), &transfer, &camera, &settings);
        let mut renderer = Renderer::streamed(device(), &stream).expect("a renderer");
        let before = source.reads.load(Ordering::Relaxed);
        renderer.render(&scene, &[]).expect("a picture");
        source.reads.load(Ordering::Relaxed) - before
    };
    // 4 x 2 x 2 bricks of 16 voxels; a row of them has 60 x 19 x 19 floats with halos.
    let numbers = || Numbers::of([60, 20, 20], None, waves);
    assert_eq!(reads_of(numbers(), 1 << 20), 16, "one brick each");
    // The first brick is read alone before the picture begins.
    assert_eq!(reads_of(numbers().by_rows(), 1 << 20), 1 + 4, "rows");
    // Two bricks of 19 x 19 fit and three do not; rows of 19 x 7 fit as a whole.
    let half = 4 * (16 + 16 + 3) * 19 * 19;
    assert_eq!(
        reads_of(numbers().by_rows(), half),
        1 + 2 + 3,
        "parts of rows"
    );
}

#[test]
fn bricks_that_nobody_sees_are_not_read() {
    let source = Arc::new(Numbers::of([24, 24, 48], None, ball));
    let stream = open(&source, TINY);
    let volume = source.in_memory();
    let grid = volume.grid();
    let camera = oblique_camera(&grid, projections(&grid)[0]);
    let transfer = ramps();
    let reads_of = |settings: &Settings| {
        let mut renderer = Renderer::streamed(device(), &stream).expect("a renderer");
        let before = source.reads.load(Ordering::Relaxed);
        let scene = scene(stream.outline(), &transfer, &camera, settings);
        let picture = renderer.render(&scene, &[]).expect("a picture").picture;
        assert!(picture.pixels.iter().any(|pixel| pixel[3] > 0.0));
        let first = source.reads.load(Ordering::Relaxed) - before;
        renderer.render(&scene, &[]).expect("a picture");
        let second = source.reads.load(Ordering::Relaxed) - before - first;
        [first, second]
    };
    let all = stream.brick_count();
    let [first, second] = reads_of(&Settings::default());
    // The ball lies in 2 x 2 x 2 bricks, and touches some beside them.
    assert!((8..=18).contains(&first), "{first} of {all} were read");
    assert_eq!(second, 0, "they stay where there is room");
    let no_skip = Settings {
        skip: false,
        ..Settings::default()
    };
    let [first, second] = reads_of(&no_skip);
    assert!(first >= all, "{first} of {all} were read");
    assert!(0 < second && second < all, "{second} of {all} had to leave");
}

#[test]
fn bricks_behind_opaque_ones_are_not_read() {
    let front = |p: glam::DVec3| if p.z < 16.0 { 1.0 } else { 0.95 };
    let source = Arc::new(Numbers::of([24, 24, 96], None, front));
    let stream = open(&source, TINY);
    let grid = stream.outline().grid();
    let mut camera = oblique_camera(&grid, projections(&grid)[1]);
    // Along z, from the front.
    camera.target = grid.center();
    camera.eye = camera.target - 300.0 * grid.world_from_voxel.matrix3.z_axis;
    camera.projection = Projection::Orthographic { view_height: 8.0 };
    let mut transfer = ramps();
    for point in &mut transfer.opacity {
        point.opacity = 1.0;
    }
    for (mode, termination, most) in [
        (Mode::Composite, 0.001, 40),
        (Mode::Mip, 0.0, 40),
        (Mode::Average, 0.0, 108),
    ] {
        let settings = Settings {
            mode,
            termination,
            ..Settings::default()
        };
        let mut renderer = Renderer::streamed(device(), &stream).expect("a renderer");
        let before = source.reads.load(Ordering::Relaxed);
        let scene = scene(stream.outline(), &transfer, &camera, &settings);
        renderer.render(&scene, &[]).expect("a picture");
        let reads = source.reads.load(Ordering::Relaxed) - before;
        let all = stream.brick_count();
        assert!(
            reads <= most && (most < all || reads >= all),
            "{mode:?}: {reads} of {all} bricks were read"
        );
    }
}

#[test]
fn all_that_lies_on_the_device_stays_under_what_it_may_take() {
    const MOST: u64 = 12 << 20;
    let source = Arc::new(Numbers::of([128; 3], None, |p| p.x));
    let peak_of = |all_device_bytes| {
        let options = StreamOptions {
            side: 64,
            piece_bytes: 1 << 20,
            device_bytes: u64::MAX,
            all_device_bytes,
        };
        let stream = open(&source, options);
        let grid = stream.outline().grid();
        let camera = oblique_camera(&grid, projections(&grid)[0]);
        let transfer = ramps();
        let settings = Settings {
            mode: Mode::Average,
            ..Settings::default()
        };
        let scene = scene(stream.outline(), &transfer, &camera, &settings);
        let mut renderer = Renderer::streamed(device(), &stream).expect("a renderer");
        renderer.render(&scene, &[]).expect("a picture");
        let picture = renderer.render(&scene, &[]).expect("a picture").picture;
        (renderer.device().gpu().memory().peak_bytes, picture)
    };
    // 8 bricks of 67 floats a side are 9.6 MB, and pictures and copies take blocks of 4 MiB.
    let (all, whole) = peak_of(u64::MAX);
    let (some, bricks) = peak_of(MOST);
    assert!(all > MOST && some <= MOST, "{all} and {some} of {MOST}");
    assert!(whole == bricks, "the pictures differ");
}

#[test]
fn what_a_stream_has_not_is_refused_by_name() {
    let source = Arc::new(Numbers::of([24, 24, 24], None, waves));
    let stream = open(&source, SMALL);
    let grid = stream.outline().grid();
    let camera = oblique_camera(&grid, projections(&grid)[0]);
    let transfer = ramps();
    let refused = |settings: Settings| {
        let mut renderer = Renderer::streamed(device(), &stream).expect("a renderer");
        let scene = scene(stream.outline(), &transfer, &camera, &settings);
        renderer
            .render(&scene, &[])
            .expect_err("refused")
            .to_string()
    };
    let slices = refused(Settings {
        technique: Technique::Slices3d,
        ..Settings::default()
    });
    assert!(slices.contains("another technique"), "{slices}");
    let cubic = refused(Settings {
        filter: Filter::Cubic,
        ..Settings::default()
    });
    assert!(cubic.contains("coefficients"), "{cubic}");
    // Nobody else draws an outline.
    let mut other = Renderer::new(device(), stream.outline()).expect("a renderer");
    let settings = Settings::default();
    let scene = scene(stream.outline(), &transfer, &camera, &settings);
    let outline = other.render(&scene, &[]).expect_err("refused").to_string();
    assert!(outline.contains("stream"), "{outline}");
}

#[test]
fn a_look_can_be_ended_and_an_overview_is_every_nth_voxel() {
    let source = Arc::new(Numbers::of([250, 170, 110], None, |p| p.x + 1000.0 * p.y));
    let ended = Stream::open(
        Arc::clone(&source) as _,
        TimeComponent::default(),
        StreamOptions::default(),
        &mut |_, _| ControlFlow::Break(()),
    );
    assert!(ended.expect("readable").is_none());
    let stream = open(&source, StreamOptions::default());
    let overview = stream.overview();
    // 4.7 million voxels: every second one along each axis.
    assert_eq!(overview.header().dims, [125, 85, 55]);
    let whole = overview.header().whole();
    let piece = overview
        .read(TimeComponent::default(), whole)
        .expect("in memory");
    let place = overview.header().world_from_voxel;
    let from_world = source.header.world_from_voxel.inverse();
    for (i, j) in [(0, 0), (7, 3), (124, 84)] {
        let center = place.transform_point3(glam::dvec3(i as f64 + 0.5, j as f64 + 0.5, 0.5));
        let voxel = from_world.transform_point3(center);
        let found = f64::from(piece.voxels.stored(j * 125 + i));
        assert!(
            (found - voxel.x - 1000.0 * voxel.y).abs() < 0.01,
            "{voxel}: {found}"
        );
    }
}
