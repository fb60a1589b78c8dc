//! Uploads, updates and what a function finds empty, in pieces: to the bit what they are at once, and given up between
//! two of them, or refused by the queue, they leave what can be drawn rightly later. And the order of updates.

use crate::embed_shared::{Host, HostImage};
use ash::vk;
use glam::DVec3;
use std::cell::Cell;
use std::ops::ControlFlow;
use std::sync::Arc;
use stratavox::camera::Camera;
use stratavox::embed::{
    Error, FrameInfo, Pacing, QueueLock, Renderer, RendererDesc, Submitter, Update, Volume,
};
use stratavox::gpu::{Caps, Load};
use stratavox::technique::{Filter, Order, Settings, Technique};
use stratavox::transfer::{OpacityPoint, TransferFunction};
use stratavox::volume::{self, VoxelBox};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// Two blocks across, one down.
const EXTENT: [u32; 2] = [80, 60];
/// More bytes and more macro cells than one piece has, in a sheet that is soon drawn.
const SHEET: [u32; 3] = [1032, 1024, 8];
const SMALL: [u32; 3] = [37, 22, 27];

/// Hills in empty space, higher by `more` in a box.
fn hills(dims: [u32; 3], more: f64, region: VoxelBox) -> volume::Volume {
    let scale = DVec3::new(1032.0, 1024.0, 8.0) / DVec3::from_array(dims.map(f64::from));
    let field = |p: DVec3| {
        let at = p * scale;
        let hill = 0.7 * (at.x / 90.0).sin() * (at.y / 70.0).cos();
        let inside = (0..3).all(|k| {
            let voxel = p[k].floor() as u32;
            (region.min[k]..region.max[k]).contains(&voxel)
        });
        hill.max(0.0) + if inside { more } else { 0.0 }
    };
    let mut made = crate::shared::volume_of(dims, crate::shared::sheared_affine(), field);
    made.value_range = [0.0, 1.0];
    made
}

fn plain(dims: [u32; 3]) -> volume::Volume {
    hills(dims, 0.0, whole(dims))
}

fn whole(dims: [u32; 3]) -> VoxelBox {
    VoxelBox {
        min: [0; 3],
        max: dims,
    }
}

/// Most of what it is given is empty under it.
fn steep() -> TransferFunction {
    let opacity = |value, opacity| OpacityPoint { value, opacity };
    TransferFunction {
        opacity: vec![opacity(0.45, 0.0), opacity(0.5, 0.6)],
        ..crate::shared::ramps()
    }
}

fn rays() -> Settings {
    Settings::default()
}

/// A sheet is one brick of several slabs, and a small volume many bricks.
fn in_bricks() -> Host {
    Host::with_caps(Caps {
        max_image_dimension_3d: 14,
        max_image_array_layers: 11,
        ..Caps::UNLIMITED
    })
}

fn uploaded(host: &Host, voxels: &volume::Volume, settings: &Settings) -> Arc<Volume> {
    let mut made = Volume::new(host.gpu(), voxels, settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { made.record_upload(host.gpu(), cmd).unwrap() });
    Arc::new(made)
}

fn renderer(host: &Host, volume: &Arc<Volume>, settings: &Settings) -> Renderer {
    let class = RendererDesc {
        settings: settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: 2,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
    };
    let function = Some(&crate::shared::ramps()).cloned();
    Renderer::new(host.gpu(), volume, function.as_ref(), class, EXTENT, &[]).unwrap()
}

fn camera(voxels: &volume::Volume) -> Camera {
    let grid = voxels.grid();
    crate::shared::oblique_camera(&grid, crate::shared::projections(&grid)[1])
}

fn shot(camera: &Camera, frame: u32) -> FrameInfo<'_> {
    FrameInfo {
        frame,
        camera,
        depth: None,
    }
}

const CLEAR: Load = Load::Clear([0.0; 4]);

fn fetched(host: &Host, image: &HostImage) -> Vec<[f64; 4]> {
    // SAFETY: it was left so; `run` waits.
    host.run(|cmd| unsafe { image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL) });
    image.numbers()
}

/// Why no picture is drawn, or the picture.
fn drawn(host: &Host, renderer: &mut Renderer, camera: &Camera) -> Result<Vec<[f64; 4]>, Error> {
    let image = HostImage::new(host, FORMAT, EXTENT);
    let mut recorded = Ok(());
    // SAFETY: `run` waits.
    host.run(|cmd| unsafe {
        recorded = renderer.record_into(cmd, &shot(camera, 0), &image.target(), CLEAR);
    });
    recorded?;
    Ok(fetched(host, &image))
}

fn picture(host: &Host, renderer: &mut Renderer, camera: &Camera) -> Vec<[f64; 4]> {
    drawn(host, renderer, camera).unwrap()
}

/// Of a new volume, and a new renderer with a function of its own.
fn expected(
    host: &Host,
    voxels: &volume::Volume,
    settings: &Settings,
    function: &TransferFunction,
) -> Vec<[f64; 4]> {
    let there = uploaded(host, voxels, settings);
    let mut renderer = renderer(host, &there, settings);
    renderer.set_function(Some(function)).unwrap();
    let found = picture(host, &mut renderer, &camera(voxels));
    let seen = found.iter().filter(|pixel| pixel[3] > 0.0).count();
    assert!(seen > 100, "only {seen} pixels show anything");
    found
}

#[test]
fn an_upload_in_pieces_is_the_upload() {
    let slices = Settings {
        technique: Technique::Slices2d,
        order: Order::BackToFront,
        ..Settings::default()
    };
    let cubic = Settings {
        filter: Filter::Cubic,
        ..Settings::default()
    };
    let cases = [
        (Host::new(), SHEET, rays()),
        // The device finds the ranges of these cells.
        (Host::new(), SHEET, cubic),
        (in_bricks(), SMALL, rays()),
        (in_bricks(), SMALL, slices),
    ];
    for (host, dims, settings) in cases {
        let (gpu, voxels) = (host.gpu(), plain(dims));
        let wanted = expected(&host, &voxels, &settings, &crate::shared::ramps());
        let mut made = Volume::new(gpu, &voxels, &settings).unwrap();
        let count = made.upload_parts().unwrap();
        assert!(count > 5, "{count} pieces of {settings:?}");
        let part = |made: &mut Volume| {
            let mut left = 0;
            // SAFETY: outside rendering, parts in order; `run` waits.
            host.run(|cmd| unsafe { left = made.record_upload_part(gpu, cmd, 1).unwrap() });
            left
        };
        for done in 1..4 {
            assert_eq!(part(&mut made), count - done);
        }
        // It is no volume yet.
        let shared = Arc::new(made);
        let mut early = renderer(&host, &shared, &settings);
        let found = drawn(&host, &mut early, &camera(&voxels));
        assert!(matches!(found, Err(Error::NotUploaded)), "{found:?}");
        drop(early);
        let mut made = Arc::try_unwrap(shared).unwrap();
        while part(&mut made) > 0 {}
        // SAFETY: nothing is recorded.
        let again = unsafe { made.record_upload_part(gpu, vk::CommandBuffer::null(), 1) };
        assert!(matches!(again, Err(Error::Uploaded)), "{again:?}");
        let mut renderer = renderer(&host, &Arc::new(made), &settings);
        let found = picture(&host, &mut renderer, &camera(&voxels));
        assert!(found == wanted, "{settings:?}");
    }
}

/// One piece, in a submission of its own.
fn part_of(host: &Host, there: &Volume, update: &mut Update) -> Result<u64, Error> {
    let mut left = Ok(0);
    // SAFETY: parts in order; `run` waits.
    host.run(|cmd| unsafe { left = there.record_update_part(cmd, update, 1) });
    left
}

fn update(host: &Host, there: &Volume, update: Update) -> Result<(), Error> {
    let mut done = Ok(());
    // SAFETY: `run` waits.
    host.run(|cmd| unsafe { done = there.record_update(cmd, update) });
    done
}

#[test]
fn an_update_in_pieces_is_the_update_and_half_of_it_is_not_drawn() {
    let sheet = VoxelBox {
        min: [100, 0, 0],
        max: [1000, 1024, 8],
    };
    let small = VoxelBox {
        min: [3, 2, 5],
        max: [31, 20, 22],
    };
    for (host, dims, region) in [(Host::new(), SHEET, sheet), (in_bricks(), SMALL, small)] {
        let (settings, old) = (rays(), plain(dims));
        let changed = hills(dims, 0.2, region);
        let wanted = expected(&host, &changed, &settings, &crate::shared::ramps());
        let camera = camera(&old);
        let there = uploaded(&host, &old, &settings);
        let mut renderer = renderer(&host, &there, &settings);
        let before = picture(&host, &mut renderer, &camera);
        assert!(before != wanted);
        let mut first = there.stage_update(region, (&changed).into()).unwrap();
        let count = first.parts();
        assert!(count > 3, "{count} pieces of {dims:?}");
        for done in 1..=2 {
            assert_eq!(part_of(&host, &there, &mut first).unwrap(), count - done);
            let half = drawn(&host, &mut renderer, &camera);
            assert!(
                matches!(half, Err(Error::HalfUpdated { region: found }) if found == region),
                "{half:?}"
            );
        }
        // Given up: one of fewer voxels does not mend it, one of as many does.
        drop(first);
        let fewer = VoxelBox {
            max: region.max.map(|n| n - 1),
            ..region
        };
        let fewer = there.stage_update(fewer, (&changed).into()).unwrap();
        let refused = self::update(&host, &there, fewer);
        assert!(
            matches!(refused, Err(Error::HalfUpdated { .. })),
            "{refused:?}"
        );
        let mut second = there.stage_update(region, (&changed).into()).unwrap();
        while part_of(&host, &there, &mut second).unwrap() > 0 {}
        let again = part_of(&host, &there, &mut second);
        assert!(matches!(again, Err(Error::Update { .. })), "{again:?}");
        assert!(picture(&host, &mut renderer, &camera) == wanted, "{dims:?}");
    }
}

#[test]
fn updates_out_of_their_order_are_refused() {
    let host = Host::new();
    let (settings, old) = (rays(), plain(SMALL));
    let there = uploaded(&host, &old, &settings);
    let mut renderer = renderer(&host, &there, &settings);
    let region = |first: u32| VoxelBox {
        min: [first, 2, 3],
        max: [first + 9, 15, 20],
    };
    let (one, all) = (hills(SMALL, 0.2, region(4)), whole(SMALL));
    let stage = |at: VoxelBox, from: &volume::Volume| there.stage_update(at, from.into()).unwrap();
    let is_refused = |found: Result<(), Error>, text: &str| {
        let error = found.expect_err("refused");
        assert!(matches!(error, Error::UpdateOrder { .. }), "{error:?}");
        assert!(error.to_string().contains(text), "{error}");
    };
    let (first, later) = (stage(region(4), &one), stage(region(20), &one));
    is_refused(update(&host, &there, later), "one with 1 before it");
    update(&host, &there, first).unwrap();
    let camera = camera(&old);
    let wanted = expected(&host, &one, &settings, &crate::shared::ramps());
    assert!(
        picture(&host, &mut renderer, &camera) == wanted,
        "nothing of the later one"
    );
    // The second was staged from voxels that the first would have brought.
    let (first, second) = (stage(region(20), &one), stage(region(4), &one));
    drop(first);
    is_refused(update(&host, &there, second), "which was given up");
    let (third, fourth) = (stage(all, &one), stage(all, &old));
    update(&host, &there, third).unwrap();
    update(&host, &there, fourth).unwrap();
    let wanted = expected(&host, &old, &settings, &crate::shared::ramps());
    assert!(picture(&host, &mut renderer, &camera) == wanted, "in order");
}

#[test]
fn what_a_new_function_finds_empty_comes_in_pieces() {
    let (host, settings, voxels) = (Host::new(), rays(), plain(SHEET));
    let wanted = expected(&host, &voxels, &settings, &steep());
    let there = uploaded(&host, &voxels, &settings);
    let mut renderer = renderer(&host, &there, &settings);
    let camera = camera(&voxels);
    picture(&host, &mut renderer, &camera);
    let blocks = renderer.begin_parts(&shot(&camera, 1)).unwrap();
    let image = HostImage::new(&host, FORMAT, EXTENT);
    let part = |renderer: &mut Renderer| {
        let mut left = 0;
        // SAFETY: parts in order; `run` waits.
        host.run(|cmd| unsafe {
            let part = renderer.record_part_into(cmd, 1, 1, &image.target(), CLEAR);
            left = part.unwrap();
        });
        left
    };
    // Given up after so many pieces, and the rest by a frame of another number.
    for given_up in [None, Some(1), Some(3), Some(6)] {
        renderer
            .set_function(Some(&crate::shared::ramps()))
            .unwrap();
        picture(&host, &mut renderer, &camera);
        renderer.set_function(Some(&steep())).unwrap();
        let count = renderer.begin_parts(&shot(&camera, 1)).unwrap();
        // Four passes over two pieces of cells.
        assert_eq!(count, blocks + 8);
        let all = given_up.unwrap_or(count);
        for done in 1..=all {
            assert_eq!(part(&mut renderer), count - done);
        }
        if let Some(given_up) = given_up {
            let found = picture(&host, &mut renderer, &camera);
            assert!(found == wanted, "given up after {given_up}");
            // What the other frame has found is there for this one too.
            assert_eq!(part(&mut renderer), blocks - 1);
            while part(&mut renderer) > 0 {}
        }
        assert!(fetched(&host, &image) == wanted, "{given_up:?}");
    }
    // An update ends it.
    renderer.begin_parts(&shot(&camera, 1)).unwrap();
    let same = there.stage_update(whole(SHEET), (&voxels).into()).unwrap();
    update(&host, &there, same).unwrap();
    // SAFETY: what is refused records nothing.
    host.run(|cmd| unsafe {
        let ended = renderer.record_part_into(cmd, 1, 1, &image.target(), CLEAR);
        assert!(matches!(ended, Err(Error::NotBegun { .. })), "{ended:?}");
    });
}

/// Submits what it is asked to but for one time, counted from 1.
fn queue_that_refuses(refuse: u32) -> impl Fn(&mut dyn FnMut()) {
    let count = Cell::new(0);
    move |submit: &mut dyn FnMut()| {
        count.set(count.get() + 1);
        if count.get() != refuse {
            submit();
        }
    }
}

#[test]
fn what_was_not_submitted_is_recorded_again() {
    let host = Host::that_lets_us_submit();
    let (gpu, settings, old) = (host.gpu(), rays(), plain(SHEET));
    let region = VoxelBox {
        min: [0, 0, 0],
        max: [1000, 1024, 8],
    };
    let changed = hills(SHEET, 0.2, region);
    let wanted = [&old, &changed].map(|of| expected(&host, of, &settings, &crate::shared::ramps()));
    let camera = camera(&old);
    let mut submitter = Submitter::new(gpu, 1).unwrap();
    let mut made = Volume::new(gpu, &old, &settings).unwrap();
    let idle = || {
        // SAFETY: the queue is ours alone.
        unsafe { host.device.queue_wait_idle(host.queue).unwrap() }
    };
    // The first submission, one of the middle and the last are not taken; each is tried again.
    let refuses = |number: u32, work: &mut dyn FnMut(QueueLock, Pacing) -> Result<bool, Error>| {
        for refuse in [number, 0] {
            let locked = queue_that_refuses(refuse);
            let lock = QueueLock {
                queue: host.queue,
                locked: &locked,
            };
            let mut go_on = |_: f64| ControlFlow::Continue(());
            let pacing = Pacing {
                target_ms: 1e-6,
                tell: &mut go_on,
            };
            let done = work(lock, pacing);
            match refuse {
                0 => assert!(done.unwrap()),
                _ => assert!(done.is_err(), "submission {refuse}"),
            }
            idle();
        }
    };
    let pieces = made.upload_parts().unwrap() as u32;
    refuses(pieces - 1, &mut |lock, pacing| {
        // SAFETY: each is waited for above.
        unsafe { submitter.upload_in_parts(gpu, &mut made, 0, lock, &[], &[], pacing) }
    });
    let mut other = Volume::new(gpu, &old, &settings).unwrap();
    refuses(1, &mut |lock, _| {
        // SAFETY: as above.
        let done = unsafe { submitter.upload(gpu, &mut other, 0, lock, &[], &[]) };
        done.map(|()| true)
    });
    for there in [Arc::new(other), Arc::new(made)] {
        let image = HostImage::new(&host, FORMAT, EXTENT);
        // A function is forgotten with the frame that brought it, at once and in parts.
        let mut renderer = self::renderer(&host, &there, &settings);
        refuses(1, &mut |lock, _| {
            let (shot, target) = (shot(&camera, 0), image.target());
            // SAFETY: as above.
            let done =
                unsafe { submitter.submit(&mut renderer, &shot, &target, CLEAR, lock, &[], &[]) };
            done.map(|()| true)
        });
        assert!(fetched(&host, &image) == wanted[0], "a frame");
        for refuse in [1, 4, 9] {
            let mut renderer = self::renderer(&host, &there, &settings);
            refuses(refuse, &mut |lock, pacing| {
                let (shot, target) = (shot(&camera, 0), image.target());
                // SAFETY: as above.
                unsafe {
                    submitter.submit_in_parts(
                        &mut renderer,
                        &shot,
                        &target,
                        CLEAR,
                        lock,
                        &[],
                        &[],
                        pacing,
                    )
                }
            });
            assert!(fetched(&host, &image) == wanted[0], "a frame in parts");
        }
        let mut update = there.stage_update(region, (&changed).into()).unwrap();
        let last = update.parts() as u32;
        let mut drawn_in = self::renderer(&host, &there, &settings);
        refuses(1, &mut |lock, pacing| {
            if update.parts() as u32 == last {
                // Nothing of it is there, and all may be drawn.
                drop(picture(&host, &mut drawn_in, &camera));
            }
            // SAFETY: as above.
            unsafe { submitter.update_in_parts(&there, &mut update, 0, lock, &[], &[], pacing) }
        });
        assert!(
            picture(&host, &mut drawn_in, &camera) == wanted[1],
            "an update"
        );
    }
}
