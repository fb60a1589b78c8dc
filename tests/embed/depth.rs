//! A host's own spheres inside, before and behind a volume hide of it what lies behind them, and no more: against the
//! CPU reference, whose ray of each pixel a clip plane cuts where that pixel's depth says. And the volume's own depth, back.

use crate::embed_shared::{Host, HostImage, Stage, depths, draw, eyes};
use ash::vk;
use glam::{DVec3, dvec3};
use std::sync::Arc;
use stratavox::camera::{Camera, DepthConvention, HostDepth, Projection, Sides};
use stratavox::embed::{Error, FrameInfo, Renderer, RendererDesc, Volume};
use stratavox::gpu::{DepthClass, Load, TargetClass};
use stratavox::offscreen::{self, reference};
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::{ClipPlane, Lattice, Level, Mode, Settings, Technique};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// What the CPU reference sees through one pixel when the ray begins at the near plane and ends where the host's depth lies,
/// both `moved` a little.
fn reference(
    stage: &Stage,
    camera: &Camera,
    depth: &HostDepth,
    pixel: [u32; 2],
    drawn: f32,
    [near_moved, end_moved]: [f64; 2],
) -> [f32; 4] {
    let rays = camera.rays(stage.extent);
    let [x, y] = pixel.map(|n| f64::from(n) + 0.5);
    let (origin, direction) = rays.at(x, y);
    // A picture of this pixel alone.
    let [width, height] = stage.extent.map(f64::from);
    let of_pixel = |sides: Sides| {
        let across = |part: f64| sides.left + part / width * (sides.right - sides.left);
        let down = |part: f64| sides.top + part / height * (sides.bottom - sides.top);
        Sides {
            left: across(x - 0.5),
            right: across(x + 0.5),
            top: down(y - 0.5),
            bottom: down(y + 0.5),
        }
    };
    let projection = match camera.projection {
        Projection::Frustum(sides) => Projection::Frustum(of_pixel(sides)),
        Projection::Parallel(sides) => Projection::Parallel(of_pixel(sides)),
        other => panic!("{other:?} comes of no matrices"),
    };
    let camera = Camera {
        projection,
        ..*camera
    };
    let mut settings = stage.settings.clone();
    let end = depth.distance(origin, direction, f64::from(drawn));
    let mut clip = |t: f64, normal: DVec3| {
        if t.is_finite() {
            let offset = normal.dot(origin + t * direction);
            settings.clip_planes.push(ClipPlane { normal, offset });
        }
    };
    clip(end * (1.0 + end_moved), -direction);
    let near = depth.distance(origin, direction, depth.nearer.near());
    clip(near * (1.0 + near_moved), direction);
    let scene = Scene {
        volume: &stage.volume,
        transfer: Some(&stage.transfer),
        beside: Default::default(),
        camera: &camera,
        extent_pixels: [1, 1],
        settings: &settings,
    };
    reference::render::<f32>(&scene).unwrap().pixels[0]
}

fn stages() -> Vec<Stage> {
    let of = |technique, mode, preintegrated| {
        Stage::new(Settings {
            technique,
            mode,
            preintegrated,
            lattice: match technique {
                Technique::Raycast | Technique::Splat => Lattice::Ray,
                _ => Lattice::Planes,
            },
            ..Settings::default()
        })
    };
    let slices = [Technique::Slices3d, Technique::Slices2d];
    let sliced = slices.into_iter().flat_map(|technique| {
        [
            of(technique, Mode::Composite, false),
            of(technique, Mode::Composite, true),
            of(technique, Mode::Mip, false),
            of(technique, Mode::Average, false),
        ]
    });
    let cast = [Technique::Raycast, Technique::Splat].map(|by| of(by, Mode::Composite, false));
    cast.into_iter().chain(sliced).collect()
}

/// As [`embed_shared::assert_close`] has it for f32 targets, of 60 slices; and where a ray ends, the sample there may
/// come or go, or be cut a little elsewhere: each of them is right. The far end moves by 1e-5 of its length (the depth
/// buffer's rounding near the far plane, and the CPU reference's own arithmetic). The near end moves by that, and for slices by
/// what a rasterizer may be off where it clips them at the near plane: corners lie on a grid of
/// 2^-subPixelPrecisionBits of a pixel, and a slice that is seen no flatter than at 45 degrees to two axes goes back
/// sqrt(2) as far as it goes aside.
const ALLOWED: f64 = 1e-4;
const END_MOVED: f64 = 1e-5;

/// How far the near end may move, of its length.
fn near_moved(host: &Host, camera: &Camera, depth: &HostDepth, extent: [u32; 2]) -> f64 {
    let gpu = host.gpu();
    // SAFETY: the handles are the host's.
    let properties = unsafe {
        gpu.instance()
            .get_physical_device_properties(gpu.physical_device())
    };
    let [x, y] = extent.map(|n| f64::from(n) / 2.0);
    let at_near = |x: f64| {
        let (origin, direction) = camera.rays(extent).at(x, y);
        let t = depth.distance(origin, direction, depth.nearer.near());
        (origin + t * direction, t)
    };
    let ((here, t), (beside, _)) = (at_near(x), at_near(x + 1.0));
    let pixel = here.distance(beside) / t;
    let grid = 0.5f64.powi(properties.limits.sub_pixel_precision_bits as i32);
    END_MOVED + std::f64::consts::SQRT_2 * pixel * grid
}

#[test]
fn what_a_host_has_drawn_hides_what_lies_behind_it_and_no_more() {
    let host = Host::new();
    for stage in stages() {
        for (nth, eye) in eyes(&stage).into_iter().enumerate() {
            let Settings {
                technique,
                mode,
                preintegrated,
                ..
            } = stage.settings;
            let slabs = if preintegrated { ", slabs" } else { "" };
            let what = format!("{technique} {mode}{slabs}, {}", eye.name);
            // What reads the depth does it in one way: a perspective that is reversed, and parallel rays.
            if (preintegrated || mode != Mode::Composite) && !(1..3).contains(&nth) {
                continue;
            }
            let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
            let drawn = depths(&stage, &camera, &depth);
            let far = (1.0 - eye.nearer.near()) as f32;
            let is_drawn = drawn.iter().filter(|&&d| d != far).count();
            assert!(is_drawn > 150, "{what}: only {is_drawn} pixels of spheres");
            let found = draw(&host, &stage, &camera, &depth, &drawn, None);
            let open = vec![far; drawn.len()];
            let alone = draw(&host, &stage, &camera, &depth, &open, None);
            let width = stage.extent[0];
            let near_moved = match technique {
                Technique::Raycast | Technique::Splat => END_MOVED,
                _ => near_moved(&host, &camera, &depth, stage.extent),
            };
            let (mut worst, mut hidden) = (0.0f64, 0);
            for i in (0..drawn.len()).step_by(7) {
                let pixel = [i as u32 % width, i as u32 / width];
                let off = |moved| {
                    let wanted = reference(&stage, &camera, &depth, pixel, drawn[i], moved);
                    let channels = wanted.iter().zip(&found.pixels[i]);
                    let off = channels.map(|(&w, f)| (f64::from(w) - f).abs());
                    off.fold(0.0, f64::max)
                };
                // CPU references are slow: others are asked only where the first is off.
                let ways = [0.0, -1.0, 1.0].into_iter();
                let ways = ways.flat_map(|near| [0.0, -1.0, 1.0].map(|end| [near, end]));
                let moved = ways.map(|[near, end]| [near * near_moved, end * END_MOVED]);
                let off = moved.map(off).find(|&off| off < ALLOWED);
                let off = off.unwrap_or(f64::INFINITY);
                let seen = found.pixels[i].iter().zip(&alone.pixels[i]);
                hidden += u32::from(seen.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) > 0.02);
                assert!(off < ALLOWED, "{what}: pixel {pixel:?} is off");
                worst = worst.max(off);
            }
            println!("{what}: off by {worst:.1e} at most, {hidden} pixels seen less");
            assert!(hidden > 8, "{what}: the spheres hide {hidden} pixels");
        }
    }
}

#[test]
fn a_surface_gives_its_depth_back_where_it_is_nearer_than_the_host() {
    let host = Host::new();
    let mut stage = Stage::new(Settings {
        mode: Mode::Iso,
        ..Settings::default()
    });
    stage.settings.per_mode.levels = vec![Level {
        value: 0.45,
        srgb: [0.9, 0.6, 0.3],
        opacity: 1.0,
    }];
    // A near plane in the volume moves where rays take their samples, and with them what they find at silhouettes.
    let before_the_volume = eyes(&stage)
        .into_iter()
        .filter(|eye| !eye.name.contains("far"));
    for eye in before_the_volume {
        let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
        let drawn = depths(&stage, &camera, &depth);
        let found = draw(&host, &stage, &camera, &depth, &drawn, None);
        let scene = Scene {
            volume: &stage.volume,
            transfer: Some(&stage.transfer),
            beside: Default::default(),
            camera: &camera,
            extent_pixels: stage.extent,
            settings: &stage.settings,
        };
        let mut renderer =
            offscreen::Renderer::new(crate::shared::device(), &stage.volume).unwrap();
        let layers = [LayerKind::Position];
        let rendered = renderer.render(&scene, &layers).unwrap();
        let position = &rendered.picture.layers[0];
        let (mut nearer, mut farther) = (0, 0);
        for (i, point) in position.values.chunks(3).enumerate() {
            let point = dvec3(point[0].into(), point[1].into(), point[2].into());
            let surface = depth.of(point);
            if !(0.0..=1.0).contains(&surface) {
                continue;
            }
            let is_nearer = |a: f64, b: f64| match depth.nearer {
                DepthConvention::Standard => a < b,
                DepthConvention::Reversed => a > b,
            };
            let host_depth = f64::from(drawn[i]);
            // Positions are f32 of some 60 mm: 4e-6 of it, times the slope of the depth, which is 1 over at least a
            // fifth of the distance.
            let allowed = 1e-5;
            if (surface - host_depth).abs() < allowed {
                continue;
            }
            let is_seen = is_nearer(surface, host_depth);
            let wanted = if is_seen { surface } else { host_depth };
            let off = (f64::from(found.depths[i]) - wanted).abs();
            assert!(off < allowed, "{}: pixel {i} is off by {off}", eye.name);
            match is_seen {
                true => nearer += 1,
                false => farther += 1,
            }
        }
        assert!(nearer > 40, "{}: {nearer} pixels of surface", eye.name);
        println!(
            "{}: {nearer} of the surface, {farther} of the host",
            eye.name
        );
    }
}

#[test]
fn a_depth_that_is_nearer_the_other_way_round_is_refused() {
    let host = Host::new();
    let stage = Stage::new(Settings::default());
    let [eye, ..] = eyes(&stage);
    let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
    let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: TargetClass {
            depth: Some(DepthClass {
                format: vk::Format::D32_SFLOAT,
                has_stencil: false,
                is_reversed: true,
            }),
            ..FORMAT.into()
        },
        frames_in_flight: 1,
        host_depth: false,
        gives_depth: true,
        picks: false,
        slice_blending: Default::default(),
    };
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    let (function, volume) = (Some(&stage.transfer), Arc::new(volume));
    let mut renderer =
        Renderer::new(host.gpu(), &volume, function, class, stage.extent, &[]).unwrap();
    let shot = FrameInfo {
        frame: 0,
        camera: &camera,
        depth: Some(depth),
    };
    // SAFETY: refused before anything is recorded.
    let refused = unsafe { renderer.record(vk::CommandBuffer::null(), &shot) };
    assert!(
        matches!(refused, Err(Error::HostDepth { .. })),
        "{refused:?}"
    );
}

#[test]
fn a_picked_pixel_says_where_it_is_and_what_voxel_is_there() {
    let host = Host::new();
    for mode in [Mode::Composite, Mode::Mip, Mode::Iso] {
        let mut stage = Stage::new(Settings {
            mode,
            ..Settings::default()
        });
        stage.settings.per_mode.levels = vec![Level {
            value: 0.45,
            srgb: [0.9, 0.6, 0.3],
            opacity: 1.0,
        }];
        let scene = Scene {
            volume: &stage.volume,
            transfer: Some(&stage.transfer),
            beside: Default::default(),
            camera: &stage.camera,
            extent_pixels: stage.extent,
            settings: &stage.settings,
        };
        let mut renderer =
            offscreen::Renderer::new(crate::shared::device(), &stage.volume).unwrap();
        let rendered = renderer.render(&scene, &[LayerKind::Position]).unwrap();
        let position = &rendered.picture.layers[0].values;
        let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
        // SAFETY: outside rendering; `run` waits.
        host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
        let class = RendererDesc {
            settings: stage.settings.clone(),
            target: FORMAT.into(),
            frames_in_flight: 1,
            host_depth: false,
            gives_depth: false,
            picks: true,
            slice_blending: Default::default(),
        };
        let (function, volume) = (Some(&stage.transfer), Arc::new(volume));
        let mut renderer =
            Renderer::new(host.gpu(), &volume, function, class, stage.extent, &[]).unwrap();
        let image = HostImage::new(&host, FORMAT, stage.extent);
        let target = image.target();
        let (mut hits, mut misses) = (0, 0);
        for pixel in [[22, 18], [20, 12], [30, 20], [0, 0], [43, 35]] {
            let shot = FrameInfo {
                frame: 0,
                camera: &stage.camera,
                depth: None,
            };
            // SAFETY: recorded in order; all of it lives until `run` has waited.
            host.run(|cmd| unsafe {
                let load = Load::Clear([0.0; 4]);
                renderer.record_into(cmd, &shot, &target, load).unwrap();
                renderer.record_pick(cmd, 0, pixel).unwrap();
            });
            let i = (pixel[1] * stage.extent[0] + pixel[0]) as usize;
            let wanted = &position[3 * i..3 * i + 3];
            match renderer.pick(0, pixel).unwrap() {
                None => {
                    assert!(wanted[0].is_nan(), "{mode:?} {pixel:?}");
                    misses += 1;
                }
                Some(pick) => {
                    let wanted = dvec3(wanted[0].into(), wanted[1].into(), wanted[2].into());
                    let off = pick.position.distance(wanted);
                    assert!(off < 1e-4, "{mode:?} {pixel:?}: off by {off}");
                    let there = pick.voxel_of(&stage.volume).expect("inside");
                    // The nearest voxel of a field that changes by 0.6 a voxel at most.
                    let value = pick.value.unwrap_or(there);
                    assert!((there - value).abs() < 0.6, "{there} for {value}");
                    hits += 1;
                }
            }
        }
        assert!(hits >= 2 && misses >= 1, "{mode:?}: {hits} hits");
        let other = renderer.pick(0, [1, 1]);
        assert!(matches!(other, Err(Error::NotPicked { .. })), "{other:?}");
        // SAFETY: nothing is recorded.
        let outside = unsafe { renderer.record_pick(vk::CommandBuffer::null(), 0, [44, 0]) };
        assert!(matches!(outside, Err(Error::NoPixel { .. })));
    }
}
