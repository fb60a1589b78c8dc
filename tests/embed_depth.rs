//! A host's own spheres inside, before and behind a volume hide of it what lies behind them, and no more: against the
//! CPU twin, whose ray of each pixel a clip plane cuts where that pixel's depth says. And the volume's own depth, back.

mod embed_shared;
mod shared;

use ash::vk;
use embed_shared::{ATTACHED, DepthImage, Host, HostImage, READ, Stage};
use glam::dcamera::rh::proj::vulkan;
use glam::dcamera::rh::view::look_at_mat4;
use glam::{DMat4, DVec3, dvec3};
use std::sync::Arc;
use stratavox::camera::{Camera, HostDepth, Nearer, Projection, Sides};
use stratavox::embed::{Class, Error, HostDepthImage, Renderer, Shot, Volume};
use stratavox::gpu::{DepthClass, Load, Target, TargetClass, Use};
use stratavox::offscreen::{self, reference};
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::{ClipPlane, Lattice, Level, Mode, Order, Settings, Technique};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// A host's matrices around the stage, and which of its depths is nearer.
struct Eye {
    name: &'static str,
    view: DMat4,
    clip: DMat4,
    nearer: Nearer,
}

fn eyes(stage: &Stage) -> [Eye; 4] {
    let Camera {
        eye, target, up, ..
    } = stage.camera;
    let view = look_at_mat4(eye, target, up);
    let [width, height] = stage.extent.map(f64::from);
    let (aspect, distance) = (width / height, eye.distance(target));
    let (half_height, fov) = (0.16 * distance, 0.34);
    let half_width = aspect * half_height;
    let (near, far) = (0.2 * distance, 4.0 * distance);
    [
        Eye {
            name: "perspective",
            view,
            clip: vulkan::perspective(fov, aspect, near, far),
            nearer: Nearer::Smaller,
        },
        // Its near plane cuts the volume.
        Eye {
            name: "perspective, reversed, without a far plane",
            view,
            clip: vulkan::perspective_infinite_reverse(fov, aspect, 0.95 * distance),
            nearer: Nearer::Larger,
        },
        Eye {
            name: "orthographic",
            view,
            clip: vulkan::orthographic(
                -half_width,
                half_width,
                -half_height,
                half_height,
                near,
                far,
            ),
            nearer: Nearer::Smaller,
        },
        // Off the middle, and its far plane cuts the volume.
        Eye {
            name: "orthographic, reversed",
            view,
            clip: vulkan::orthographic(
                -0.5 * half_width,
                1.5 * half_width,
                -half_height,
                half_height,
                1.05 * distance,
                -far,
            ),
            nearer: Nearer::Larger,
        },
    ]
}

/// Centre and radius: inside, before and behind the volume.
fn spheres(stage: &Stage) -> [(DVec3, f64); 3] {
    let center = stage.grid.center();
    let away = (center - stage.camera.eye).normalize();
    let aside = away.cross(DVec3::Z).normalize();
    [
        (center + 1.5 * aside, 4.0),
        (center - 16.0 * away - 4.0 * aside, 2.0),
        (center + 18.0 * away + 2.0 * aside, 9.0),
    ]
}

/// The depth buffer that a host would have after it has drawn the spheres exactly.
fn depths(stage: &Stage, camera: &Camera, depth: &HostDepth) -> Vec<f32> {
    let rays = camera.rays(stage.extent);
    let [width, height] = stage.extent;
    let pixels = (0..width * height).map(|i| [i % width, i / width].map(|n| f64::from(n) + 0.5));
    let spheres = spheres(stage);
    let far = 1.0 - depth.nearer.near();
    let of_pixel = |[x, y]: [f64; 2]| {
        let (origin, direction) = rays.at(x, y);
        let hit = |(center, radius): (DVec3, f64)| {
            let to_center = center - origin;
            let along = to_center.dot(direction);
            let inside = radius * radius - (to_center.length_squared() - along * along);
            (inside > 0.0).then(|| along - inside.sqrt())
        };
        let nearest = spheres.into_iter().filter_map(hit).reduce(f64::min);
        let found = nearest.map(|t| depth.of(origin + t * direction));
        // What the host's own near and far planes cut away.
        let found = found.filter(|depth| (0.0..=1.0).contains(depth));
        found.unwrap_or(far) as f32
    };
    pixels.map(of_pixel).collect()
}

/// What the twin sees through one pixel when the ray ends where the host's depth lies, `moved` a little.
fn twin(
    stage: &Stage,
    camera: &Camera,
    depth: &HostDepth,
    pixel: [u32; 2],
    drawn: f32,
    moved: f64,
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
    clip(end * (1.0 + moved), -direction);
    clip(
        depth.distance(origin, direction, depth.nearer.near()),
        direction,
    );
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

struct Found {
    pixels: Vec<[f64; 4]>,
    depths: Vec<f32>,
}

/// What a host gets that draws the volume behind `drawn`.
fn draw(host: &Host, stage: &Stage, camera: &Camera, depth: &HostDepth, drawn: &[f32]) -> Found {
    let is_ray = stage.settings.technique == Technique::Raycast;
    let gives_depth = is_ray && stage.settings.mode.has_depth();
    let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
    let state = if is_ray { READ } else { ATTACHED };
    let buffer = DepthImage::new(host, stage.extent, drawn, state);
    let image = HostImage::new(host, FORMAT, stage.extent);
    let class = Class {
        settings: stage.settings.clone(),
        target: TargetClass {
            depth: Some(DepthClass {
                format: vk::Format::D32_SFLOAT,
                has_stencil: false,
                is_reversed: depth.nearer == Nearer::Larger,
            }),
            ..FORMAT.into()
        },
        frames_in_flight: 1,
        host_depth: true,
        gives_depth,
    };
    // SAFETY: the buffer outlives the renderer.
    let read = unsafe { HostDepthImage::new(buffer.view, READ.2, stage.extent) };
    let read = if is_ray { vec![read] } else { Vec::new() };
    let shot = Shot {
        frame: 0,
        camera,
        depth: Some(*depth),
    };
    // SAFETY: recorded in order; all of it lives until `run` has waited.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    let volume = Arc::new(volume);
    let function = Some(&stage.transfer);
    let mut renderer =
        Renderer::new(host.gpu(), &volume, function, class, stage.extent, &read).unwrap();
    // SAFETY: as above.
    host.run(|cmd| unsafe {
        renderer.record(cmd, &shot).unwrap();
        image.make_target(cmd);
        if is_ray {
            buffer.barrier(cmd, READ, ATTACHED);
        }
        let depth = Some(&buffer);
        host.begin_rendering_before(cmd, image.view, stage.extent, [0.0; 4], depth);
        renderer.draw(cmd, 0).unwrap();
        if gives_depth {
            renderer.draw_depth(cmd, 0).unwrap();
        }
        host.device.cmd_end_rendering(cmd);
        image.fetch_drawn(cmd);
    });
    Found {
        pixels: image.numbers(),
        depths: buffer.numbers(),
    }
}

fn stages() -> Vec<Stage> {
    let rays = Settings {
        technique: Technique::Raycast,
        ..Settings::default()
    };
    let slices = |technique| Settings {
        technique,
        lattice: Lattice::Planes,
        order: Order::BackToFront,
        ..Settings::default()
    };
    [
        rays,
        slices(Technique::Slices3d),
        slices(Technique::Slices2d),
    ]
    .map(Stage::new)
    .into()
}

/// As [`embed_shared::assert_close`] has it for f32 targets, of 60 slices; and where the end of a ray moves by 1e-5 of
/// its length (the depth buffer's rounding near the far plane and the twin's own arithmetic), its last sample may come
/// or go, or be cut a little elsewhere: each of the three is right.
const ALLOWED: f64 = 1e-4;
const MOVED: [f64; 3] = [0.0, -1e-5, 1e-5];

#[test]
fn what_a_host_has_drawn_hides_what_lies_behind_it_and_no_more() {
    let host = Host::new();
    for stage in stages() {
        for eye in eyes(&stage) {
            let what = format!("{:?}, {}", stage.settings.technique, eye.name);
            let (camera, depth) = Camera::from_matrices(&eye.view, &eye.clip, eye.nearer).unwrap();
            let drawn = depths(&stage, &camera, &depth);
            let far = (1.0 - eye.nearer.near()) as f32;
            let is_drawn = drawn.iter().filter(|&&d| d != far).count();
            assert!(is_drawn > 150, "{what}: only {is_drawn} pixels of spheres");
            let found = draw(&host, &stage, &camera, &depth, &drawn);
            let open = vec![far; drawn.len()];
            let alone = draw(&host, &stage, &camera, &depth, &open);
            let width = stage.extent[0];
            let (mut worst, mut hidden) = (0.0f64, 0);
            for i in (0..drawn.len()).step_by(7) {
                let pixel = [i as u32 % width, i as u32 / width];
                let off = |moved| {
                    let wanted = twin(&stage, &camera, &depth, pixel, drawn[i], moved);
                    let channels = wanted.iter().zip(&found.pixels[i]);
                    let off = channels.map(|(&w, f)| (f64::from(w) - f).abs());
                    off.fold(0.0, f64::max)
                };
                let off = MOVED.into_iter().map(off).fold(f64::INFINITY, f64::min);
                hidden += u32::from(found.pixels[i][3] < alone.pixels[i][3] - 0.05);
                assert!(off < ALLOWED, "{what}: pixel {pixel:?} is off by {off}");
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
        let found = draw(&host, &stage, &camera, &depth, &drawn);
        let scene = Scene {
            volume: &stage.volume,
            transfer: Some(&stage.transfer),
            beside: Default::default(),
            camera: &camera,
            extent_pixels: stage.extent,
            settings: &stage.settings,
        };
        let mut renderer = offscreen::Renderer::new(shared::device(), &stage.volume).unwrap();
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
                Nearer::Smaller => a < b,
                Nearer::Larger => a > b,
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
    let class = Class {
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
    };
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    let (function, volume) = (Some(&stage.transfer), Arc::new(volume));
    let mut renderer =
        Renderer::new(host.gpu(), &volume, function, class, stage.extent, &[]).unwrap();
    let shot = Shot {
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
        let mut renderer = offscreen::Renderer::new(shared::device(), &stage.volume).unwrap();
        let rendered = renderer.render(&scene, &[LayerKind::Position]).unwrap();
        let position = &rendered.picture.layers[0].values;
        let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
        // SAFETY: outside rendering; `run` waits.
        host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
        let class = Class {
            settings: stage.settings.clone(),
            target: FORMAT.into(),
            frames_in_flight: 1,
            host_depth: false,
            gives_depth: false,
        };
        let (function, volume) = (Some(&stage.transfer), Arc::new(volume));
        let mut renderer =
            Renderer::new(host.gpu(), &volume, function, class, stage.extent, &[]).unwrap();
        let image = HostImage::new(&host, FORMAT, stage.extent);
        let target = Target {
            image: image.raw,
            view: image.view,
            format: FORMAT,
            extent: stage.extent,
            before: Use::Nothing.into(),
            after: Use::TransferRead.into(),
        };
        let (mut hits, mut misses) = (0, 0);
        for pixel in [[22, 18], [20, 12], [30, 20], [0, 0], [43, 35]] {
            let shot = Shot {
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
