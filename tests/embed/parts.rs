//! A frame in parts is the frame in one, and may be given up between two of them.

use crate::embed_shared::{Host, HostImage, Stage};
use ash::vk;
use std::ops::ControlFlow;
use std::sync::Arc;
use stratavox::embed::{
    Error, FrameInfo, Pacing, QueueLock, Renderer, RendererDesc, SliceBlending, Submitter, Volume,
};
use stratavox::gpu::{Caps, Load, Target, TargetState, Use};
use stratavox::technique::{Mode, Order, Settings, Shading, Shadows, Technique};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// Three blocks across, two down, the last ones smaller.
const EXTENT: [u32; 2] = [150, 90];

/// Rays that composite and that project, slices into the target and into an image of ours, slices that eye and light
/// see in turn.
fn ways() -> Vec<Settings> {
    let ways = [
        (Technique::Raycast, Mode::Composite),
        (Technique::Raycast, Mode::Mip),
        (Technique::Slices3d, Mode::Composite),
        (Technique::Slices2d, Mode::Composite),
        (Technique::Slices3d, Mode::Mip),
        (Technique::ShearWarp, Mode::Composite),
        (Technique::ShearWarp, Mode::Mip),
        (Technique::Splat, Mode::Composite),
    ];
    let settings = ways.map(|(technique, mode)| Settings {
        technique,
        mode,
        order: Order::BackToFront,
        ..Settings::default()
    });
    let shaded = Shading {
        shadows: Shadows::HalfAngle,
        ..Shading::default()
    };
    let in_light = Settings {
        technique: Technique::Slices3d,
        shading: Some(shaded),
        ..Settings::default()
    };
    settings.into_iter().chain([in_light]).collect()
}

/// Blocks, of half the side where slices of many bricks are thought to take long, or draws of eye and light.
fn assert_count(settings: &Settings, is_cut: bool, count: u64) {
    let is_sliced = !matches!(settings.technique, Technique::Raycast | Technique::Splat);
    match settings.shading.is_some() {
        // Bands of the intermediate image, and three of the picture.
        false if settings.technique == Technique::ShearWarp => {
            assert!((4..12).contains(&count), "{count}")
        }
        // Blocks of a quarter of the side: of each pixel the voxels near its ray are looked at.
        false if settings.technique == Technique::Splat => assert_eq!(count, 60),
        true => assert!(count > 20 && count.is_multiple_of(2), "{count}"),
        false if is_cut && is_sliced => assert!([6, 15].contains(&count), "{count}"),
        false => assert_eq!(count, 6),
    }
}

fn stage(settings: &Settings) -> Stage {
    let mut stage = Stage::new(settings.clone());
    stage.settings.conformance = false;
    stage.extent = EXTENT;
    stage
}

fn renderer(host: &Host, stage: &Stage) -> Renderer {
    let gpu = host.gpu();
    let mut volume = Volume::new(gpu, &stage.volume, &stage.settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(gpu, cmd).unwrap() });
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: 2,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
    };
    let function = Some(&stage.transfer);
    Renderer::new(gpu, &Arc::new(volume), function, class, EXTENT, &[]).unwrap()
}

fn shot(stage: &Stage, frame: u32) -> FrameInfo<'_> {
    FrameInfo {
        frame,
        camera: &stage.camera,
        depth: None,
    }
}

const CLEAR: Load = Load::Clear([0.25, 0.5, 0.0, 1.0]);

/// The frame in one.
fn whole(host: &Host, renderer: &mut Renderer, stage: &Stage) -> Vec<[f64; 4]> {
    let image = HostImage::new(host, FORMAT, EXTENT);
    // SAFETY: recorded in order; `run` waits.
    host.run(|cmd| unsafe {
        let target = image.target();
        renderer
            .record_into(cmd, &shot(stage, 0), &target, CLEAR)
            .unwrap();
        image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    });
    image.numbers()
}

#[test]
fn parts_together_are_the_frame() {
    let bricks = Caps {
        max_image_dimension_3d: 12,
        max_image_array_layers: 12,
        ..Caps::UNLIMITED
    };
    for caps in [Caps::UNLIMITED, bricks] {
        let host = Host::with_caps(caps);
        // What the light sees lies in one brick, and so do splats.
        let is_cut = caps != Caps::UNLIMITED;
        let is_whole = |of: &Settings| of.shading.is_some() || of.technique == Technique::Splat;
        let ways = ways().into_iter();
        for settings in ways.filter(|settings| !is_cut || !is_whole(settings)) {
            let stage = stage(&settings);
            let mut renderer = renderer(&host, &stage);
            let wanted = whole(&host, &mut renderer, &stage);
            for size in [1, 4, u64::MAX] {
                let image = HostImage::new(&host, FORMAT, EXTENT);
                // In a layout that parts leave behind them: the next one that named it would be heard.
                let target = Target {
                    before: Use::TransferWrite.into(),
                    ..image.target()
                };
                // SAFETY: the image is the host's; `run` waits.
                host.run(|cmd| unsafe { image.clear(cmd, [1.0; 4]) });
                let count = renderer.begin_parts(&shot(&stage, 1)).unwrap();
                assert_count(&settings, is_cut, count);
                let mut left = count;
                while left > 0 {
                    // SAFETY: one part a submission, in order; `run` waits.
                    host.run(|cmd| unsafe {
                        let after = renderer.record_part_into(cmd, 1, size, &target, CLEAR);
                        let after = after.unwrap();
                        assert_eq!(after, left.saturating_sub(size));
                        left = after;
                    });
                }
                // SAFETY: the target is as it was said to leave.
                host.run(|cmd| unsafe {
                    image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
                });
                let found = image.numbers();
                let off = found.iter().zip(&wanted).filter(|(f, w)| f != w).count();
                assert_eq!(off, 0, "in parts of {size}: {settings:?}");
            }
        }
    }
}

#[test]
fn blocks_are_smaller_where_a_picture_takes_long() {
    let host = Host::new();
    let gpu = host.gpu();
    // SAFETY: the handles are the host's.
    let properties = unsafe {
        gpu.instance()
            .get_physical_device_properties(gpu.physical_device())
    };
    // Some 1000 samples a pixel are 100 ms a block for a device that computes on the CPU, and 5 ms elsewhere.
    let settings = Settings {
        samples_per_voxel: 40.0,
        ..Settings::default()
    };
    let stage = stage(&settings);
    let mut renderer = renderer(&host, &stage);
    let wanted = whole(&host, &mut renderer, &stage);
    let mut left = renderer.begin_parts(&shot(&stage, 1)).unwrap();
    let is_cpu = properties.device_type == vk::PhysicalDeviceType::CPU;
    assert!(left >= if is_cpu { 15 } else { 6 }, "{left} blocks");
    let image = HostImage::new(&host, FORMAT, EXTENT);
    while left > 0 {
        // SAFETY: one part a submission, in order; `run` waits.
        host.run(|cmd| unsafe {
            let after = renderer.record_part_into(cmd, 1, 7, &image.target(), CLEAR);
            left = after.unwrap();
        });
    }
    // SAFETY: the target is as it was said to leave.
    host.run(|cmd| unsafe { image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL) });
    assert!(image.numbers() == wanted);
}

#[test]
fn a_frame_that_is_given_up_leaves_the_target_as_it_is_said() {
    let host = Host::new();
    for settings in ways() {
        let stage = stage(&settings);
        let mut renderer = renderer(&host, &stage);
        let wanted = whole(&host, &mut renderer, &stage);
        let image = HostImage::new(&host, FORMAT, EXTENT);
        const DRAWN: [f32; 4] = [0.5, 0.0, 0.0, 0.5];
        // Kept, so that what is left of it shows.
        let target = Target {
            before: Use::TransferWrite.into(),
            ..image.target()
        };
        let count = renderer.begin_parts(&shot(&stage, 1)).unwrap();
        // SAFETY: in order; `run` waits. The image is in the layout that the documentation says.
        host.run(|cmd| unsafe {
            image.clear(cmd, DRAWN);
            let load = Load::Keep;
            let left = renderer.record_part_into(cmd, 1, 2, &target, load).unwrap();
            assert_eq!(left, count - 2);
            let stage = vk::PipelineStageFlags::TRANSFER;
            let written = vk::AccessFlags::TRANSFER_WRITE;
            let read = vk::AccessFlags::TRANSFER_READ;
            let to = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
            let from = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
            image.barrier(cmd, (stage, written, to), (stage, read, from));
            image.copy_from(cmd, from);
        });
        let found = image.numbers();
        let as_it_was = DRAWN.map(f64::from);
        let changed = found.iter().filter(|&&pixel| pixel != as_it_was).count();
        assert_eq!(changed, 0, "{settings:?}");
        // The same frame, begun anew, and another.
        assert!(
            whole(&host, &mut renderer, &stage) == wanted,
            "{settings:?}"
        );
        renderer.begin_parts(&shot(&stage, 1)).unwrap();
    }
}

#[test]
fn what_ends_a_frame_in_parts_is_told() {
    let host = Host::new();
    let stage = stage(&Settings::default());
    let mut renderer = renderer(&host, &stage);
    let image = HostImage::new(&host, FORMAT, EXTENT);
    let part = |renderer: &mut Renderer, frame: u32, target: &Target, load: Load| {
        let mut found = Ok(0);
        // SAFETY: what is refused records nothing, and the rest is of a frame begun; `run` waits.
        host.run(|cmd| unsafe {
            found = renderer.record_part_into(cmd, frame, 1, target, load);
        });
        found
    };
    let right = image.target();
    let none = part(&mut renderer, 0, &right, CLEAR);
    assert!(
        matches!(none, Err(Error::NotBegun { frame: 0 })),
        "{none:?}"
    );
    let none = part(&mut renderer, 2, &right, CLEAR);
    assert!(matches!(none, Err(Error::NoFrame { .. })), "{none:?}");
    let changes: [&dyn Fn(&mut Renderer); 3] = [
        &|renderer| renderer.set_function(Some(&stage.transfer)).unwrap(),
        &|renderer| renderer.resize(EXTENT, &[]).unwrap(),
        &|renderer| drop(whole(&host, renderer, &stage)),
    ];
    for (k, change) in changes.iter().enumerate() {
        renderer.begin_parts(&shot(&stage, 0)).unwrap();
        part(&mut renderer, 0, &right, CLEAR).unwrap();
        change(&mut renderer);
        let ended = part(&mut renderer, 0, &right, CLEAR);
        assert!(
            matches!(ended, Err(Error::NotBegun { .. })),
            "{k}: {ended:?}"
        );
    }
    // States that lose what is to be kept, in one recording and in parts.
    let lost = Target {
        after: TargetState {
            layout: vk::ImageLayout::UNDEFINED,
            ..right.after
        },
        ..right
    };
    for (target, load) in [(right, Load::Keep), (lost, CLEAR)] {
        renderer.begin_parts(&shot(&stage, 0)).unwrap();
        let refused = part(&mut renderer, 0, &target, load);
        assert!(
            matches!(refused, Err(Error::TargetState { .. })),
            "{refused:?}"
        );
        // SAFETY: what is refused records nothing.
        host.run(|cmd| unsafe {
            let refused = renderer.record_into(cmd, &shot(&stage, 0), &target, load);
            assert!(
                matches!(refused, Err(Error::TargetState { .. })),
                "{refused:?}"
            );
        });
    }
    // Slices that are blended in the target have no image that parts could gather them in.
    let slices = self::stage(&Settings {
        technique: Technique::Slices3d,
        ..Settings::default()
    });
    let class = RendererDesc {
        slice_blending: SliceBlending::InTarget,
        settings: slices.settings.clone(),
        ..renderer.class().clone()
    };
    let mut volume = Volume::new(host.gpu(), &slices.volume, &slices.settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    let (volume, function) = (Arc::new(volume), Some(&slices.transfer));
    let mut renderer = Renderer::new(host.gpu(), &volume, function, class, EXTENT, &[]).unwrap();
    let refused = renderer.begin_parts(&shot(&slices, 0));
    assert!(
        matches!(refused, Err(Error::NotEmbedded { .. })),
        "{refused:?}"
    );
}

#[test]
fn submissions_follow_each_other_and_a_host_may_end_them() {
    let host = Host::that_lets_us_submit();
    let device = &host.device;
    let mut kind =
        vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
    let info = vk::SemaphoreCreateInfo::default().push_next(&mut kind);
    // SAFETY: the device has timelines; destroyed below.
    let timeline = unsafe { device.create_semaphore(&info, None).unwrap() };
    // SAFETY: as above.
    let reached = || unsafe { device.get_semaphore_counter_value(timeline).unwrap() };
    let submissions = std::cell::Cell::new(0);
    let locked = |submit: &mut dyn FnMut()| {
        submissions.set(submissions.get() + 1);
        submit();
    };
    let lock = QueueLock {
        queue: host.queue,
        locked: &locked,
    };
    for (n, settings) in (0..).zip(ways()) {
        let stage = stage(&settings);
        let mut renderer = renderer(&host, &stage);
        let wanted = whole(&host, &mut renderer, &stage);
        let image = HostImage::new(&host, FORMAT, EXTENT);
        let mut submitter = Submitter::new(host.gpu(), 1).unwrap();
        let (shot, target) = (shot(&stage, 0), image.target());
        let count = renderer.begin_parts(&shot).unwrap() as usize;
        let (waits, signals) = ([(timeline, 2 * n)], [(timeline, 2 * n + 1)]);
        for stops in [true, false] {
            submissions.set(0);
            let mut told = Vec::new();
            let mut tell = |done: f64| {
                told.push(done);
                match stops && told.len() == 2 {
                    true => ControlFlow::Break(()),
                    false => ControlFlow::Continue(()),
                }
            };
            // No block is done in no time: each is a submission.
            let pacing = Pacing {
                target_ms: 1e-6,
                tell: &mut tell,
            };
            // SAFETY: what is submitted is waited for, here or below.
            let is_done = unsafe {
                submitter.submit_in_parts(
                    &mut renderer,
                    &shot,
                    &target,
                    CLEAR,
                    lock,
                    &waits,
                    &signals,
                    pacing,
                )
            };
            assert_eq!(is_done.unwrap(), !stops);
            let first = 0.9 / count as f64;
            assert!(told.is_sorted() && told.iter().all(|part| (first..1.0).contains(part)));
            // One waits for the host's values by itself.
            let wanted = if stops {
                (2, 3)
            } else {
                (count - 1, count + 1)
            };
            assert_eq!((told.len(), submissions.get()), wanted, "{settings:?}");
            if stops {
                assert_eq!(reached(), 2 * n, "no signal of a frame that is given up");
            }
        }
        // SAFETY: the device has timelines; the image is as it was said to leave.
        unsafe {
            let (semaphores, values) = ([timeline], [2 * n + 1]);
            let info = vk::SemaphoreWaitInfo::default()
                .semaphores(&semaphores)
                .values(&values);
            device.wait_semaphores(&info, u64::MAX).unwrap();
            host.run(|cmd| image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL));
            let info = vk::SemaphoreSignalInfo::default()
                .semaphore(timeline)
                .value(2 * n + 2);
            device.signal_semaphore(&info).unwrap();
        }
        assert!(image.numbers() == wanted, "{settings:?}");
    }
    // SAFETY: nothing uses it any more.
    unsafe { device.destroy_semaphore(timeline, None) };
    let none = Submitter::new(host.gpu(), 0).map(drop);
    assert!(
        matches!(none, Err(Error::FramesInFlight { found: 0, .. })),
        "{none:?}"
    );
}
