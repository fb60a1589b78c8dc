//! The three levels of `stratavox::embed` draw the very picture that `offscreen::Renderer` makes.

use crate::embed_shared::{Host, HostImage, Stage, all_settings, offscreen};
use ash::vk;
use std::sync::Arc;
use stratavox::embed::{
    Error, FrameInfo, QueueLock, Renderer, RendererDesc, SliceBlending, Submitter, Volume,
};
use stratavox::gpu::Load;
use stratavox::technique::{Mode, Order, Settings, Technique};
use stratavox::volume::{self, Rescale, Voxels};

/// What is drawn there is what was computed, to the bit.
const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

fn stage(settings: &Settings) -> Stage {
    let mut stage = Stage::new(settings.clone());
    // Pictures as hosts draw them: tables, filters of the device, what cannot be seen left out.
    stage.settings.conformance = false;
    stage
}

fn class(stage: &Stage) -> RendererDesc {
    RendererDesc {
        settings: stage.settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: 2,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
    }
}

fn shot(stage: &Stage, frame: u32) -> FrameInfo<'_> {
    FrameInfo {
        frame,
        camera: &stage.camera,
        depth: None,
    }
}

fn uploaded(host: &Host, stage: &Stage) -> Arc<Volume> {
    let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    Arc::new(volume)
}

fn renderer(host: &Host, stage: &Stage) -> Renderer {
    let volume = uploaded(host, stage);
    let function = Some(&stage.transfer);
    let class = class(stage);
    Renderer::new(host.gpu(), &volume, function, class, stage.extent, &[]).unwrap()
}

fn assert_same(settings: &Settings, found: &[[f64; 4]], wanted: &[[f64; 4]], level: &str) {
    let what = format!("{level}: {settings:?}");
    assert_eq!(found.len(), wanted.len());
    let off = found.iter().zip(wanted).filter(|(f, w)| f != w).count();
    assert_eq!(off, 0, "pixels that differ, {what}");
}

#[test]
fn level_a_draws_inside_the_hosts_rendering_what_offscreen_makes() {
    let host = Host::new();
    for settings in all_settings() {
        let stage = stage(&settings);
        let mut renderer = renderer(&host, &stage);
        let image = HostImage::new(&host, FORMAT, stage.extent);
        // SAFETY: recorded in order; all of it lives until `run` has waited.
        host.run(|cmd| unsafe {
            renderer.record(cmd, &shot(&stage, 0)).unwrap();
            image.make_target(cmd);
            host.begin_rendering(cmd, image.view, stage.extent, [0.0; 4]);
            renderer.draw(cmd, 0).unwrap();
            host.device.cmd_end_rendering(cmd);
            image.fetch_drawn(cmd);
        });
        assert_same(&settings, &image.numbers(), &offscreen(&stage), "A");
    }
}

#[test]
fn level_b_records_into_an_image_that_comes_and_goes_as_the_host_says() {
    let host = Host::new();
    for settings in all_settings() {
        let stage = stage(&settings);
        let mut renderer = renderer(&host, &stage);
        let image = HostImage::new(&host, FORMAT, stage.extent);
        // SAFETY: as above; the target leaves as the copy reads it.
        host.run(|cmd| unsafe {
            let (target, load) = (image.target(), Load::Clear([0.0; 4]));
            let shot = shot(&stage, 1);
            renderer.record_into(cmd, &shot, &target, load).unwrap();
            image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
        });
        assert_same(&settings, &image.numbers(), &offscreen(&stage), "B");
    }
}

#[test]
fn level_c_submits_under_the_hosts_lock_between_the_hosts_values() {
    let host = Host::that_lets_us_submit();
    let device = &host.device;
    let timeline = || {
        let mut kind =
            vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
        let info = vk::SemaphoreCreateInfo::default().push_next(&mut kind);
        // SAFETY: the device has timelines; destroyed below.
        unsafe { device.create_semaphore(&info, None).unwrap() }
    };
    let (gate, done) = (timeline(), timeline());
    let locked = std::cell::Cell::new(0);
    let in_lock = |submit: &mut dyn FnMut()| {
        locked.set(locked.get() + 1);
        submit();
    };
    let lock = QueueLock {
        queue: host.queue,
        locked: &in_lock,
    };
    // SAFETY: the semaphores are timelines of the device; waits and destruction in their order.
    let reached = || unsafe { device.get_semaphore_counter_value(done).unwrap() };
    let stage = stage(&Settings::default());
    let mut renderer = renderer(&host, &stage);
    let image = HostImage::new(&host, FORMAT, stage.extent);
    let mut submitter = Submitter::new(host.gpu(), 2).unwrap();
    // SAFETY: one frame in flight; what it uses lives until the wait is over.
    unsafe {
        let (shot, target) = (shot(&stage, 0), image.target());
        let load = Load::Clear([0.0; 4]);
        submitter
            .submit(
                &mut renderer,
                &shot,
                &target,
                load,
                lock,
                &[(gate, 3)],
                &[(done, 7)],
            )
            .unwrap();
        assert_eq!((locked.get(), reached()), (1, 0), "it begins at value 3");
        let info = vk::SemaphoreSignalInfo::default().semaphore(gate).value(3);
        device.signal_semaphore(&info).unwrap();
        let (semaphores, values) = ([done], [7]);
        let info = vk::SemaphoreWaitInfo::default()
            .semaphores(&semaphores)
            .values(&values);
        device.wait_semaphores(&info, u64::MAX).unwrap();
        // The other frame in flight fetches what was drawn.
        let fetch = |cmd| {
            image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
            Ok(())
        };
        submitter
            .run(lock, 1, &[(done, 7)], &[(done, 8)], fetch)
            .unwrap();
        device.device_wait_idle().unwrap();
        device.destroy_semaphore(gate, None);
        device.destroy_semaphore(done, None);
    }
    assert_same(&stage.settings, &image.numbers(), &offscreen(&stage), "C");
}

#[test]
fn level_c_draws_in_all_settings_what_offscreen_makes() {
    let host = Host::that_lets_us_submit();
    let device = &host.device;
    let in_lock = |submit: &mut dyn FnMut()| submit();
    let lock = QueueLock {
        queue: host.queue,
        locked: &in_lock,
    };
    let mut submitter = Submitter::new(host.gpu(), 2).unwrap();
    for settings in all_settings() {
        let stage = stage(&settings);
        let mut renderer = renderer(&host, &stage);
        let image = HostImage::new(&host, FORMAT, stage.extent);
        // SAFETY: the device is done with one submission before its number comes again, and with all before they go.
        unsafe {
            let (shot, target) = (shot(&stage, 1), image.target());
            let load = Load::Clear([0.0; 4]);
            submitter
                .submit(&mut renderer, &shot, &target, load, lock, &[], &[])
                .unwrap();
            let fetch = |cmd| {
                image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
                Ok(())
            };
            submitter.run(lock, 0, &[], &[], fetch).unwrap();
            device.device_wait_idle().unwrap();
        }
        assert_same(&settings, &image.numbers(), &offscreen(&stage), "C");
    }
}

/// Voxels that software devices have corners of, which rays and view-aligned slices read in both places.
#[test]
fn bytes_are_drawn_as_offscreen_too() {
    let host = Host::new();
    for technique in [
        Technique::Raycast,
        Technique::Slices3d,
        Technique::Slices2d,
        Technique::ShearWarp,
        Technique::Splat,
    ] {
        let mut stage = stage(&Settings {
            technique,
            ..Settings::default()
        });
        let Voxels::F32(values) = &stage.volume.voxels else {
            unreachable!("made so")
        };
        let [low, high] = stage.volume.value_range.map(|v| v as f32);
        let codes = values
            .iter()
            .map(|v| (255.0 * (v - low) / (high - low)) as u8);
        let rescale = Rescale {
            slope: f64::from(high - low) / 255.0,
            intercept: low.into(),
        };
        let voxels = Voxels::U8(codes.collect());
        let (dims, affine) = (stage.volume.dims, stage.volume.world_from_voxel);
        stage.volume = volume::Volume::from_voxels(dims, affine, voxels, rescale, None).unwrap();
        let mut renderer = renderer(&host, &stage);
        let found = drawn(&host, &mut renderer, &stage);
        assert_same(&stage.settings, &found, &offscreen(&stage), "bytes");
    }
}

#[test]
fn a_recorded_frame_makes_nothing_and_compiles_nothing() {
    let host = Host::new();
    let gpu = host.gpu();
    for settings in all_settings() {
        let stage = stage(&settings);
        let mut renderer = renderer(&host, &stage);
        let made = || {
            (
                gpu.live_objects(),
                gpu.pipelines_made(),
                gpu.memory().reserved_bytes,
            )
        };
        let before = made();
        for frame in [0, 1] {
            let image = HostImage::new(&host, FORMAT, stage.extent);
            // SAFETY: as above.
            host.run(|cmd| unsafe {
                let (target, load) = (image.target(), Load::Clear([0.0; 4]));
                let shot = shot(&stage, frame);
                renderer.record_into(cmd, &shot, &target, load).unwrap();
            });
        }
        assert_eq!(made(), before, "{settings:?}");
    }
}

#[test]
fn a_function_dragged_each_frame_compiles_nothing_and_leaves_nothing() {
    let host = Host::with_timeline();
    let gpu = host.gpu();
    let mut stage = stage(&Settings::default());
    let mut renderer = renderer(&host, &stage);
    let image = HostImage::new(&host, FORMAT, stage.extent);
    let mut pictures = Vec::new();
    let (mut objects, mut pipelines) = (None, None);
    for n in 1..=6 {
        for point in &mut stage.transfer.opacity {
            point.value *= 0.93;
        }
        gpu.announce(n);
        renderer.set_function(Some(&stage.transfer)).unwrap();
        // SAFETY: as above: `run` waits, so that the frame is done.
        unsafe {
            host.run(|cmd| {
                let (target, load) = (image.target(), Load::Clear([0.0; 4]));
                let shot = shot(&stage, (n % 2) as u32);
                renderer.record_into(cmd, &shot, &target, load).unwrap();
                image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
            });
            gpu.retire(n);
        }
        assert_same(
            &stage.settings,
            &image.numbers(),
            &offscreen(&stage),
            "dragged",
        );
        pictures.push(image.numbers());
        let there = gpu.live_objects();
        assert_eq!(objects.get_or_insert(there.clone()), &there, "frame {n}");
        let made = gpu.pipelines_made();
        assert_eq!(pipelines.get_or_insert(made), &made, "frame {n}");
    }
    assert!(pictures.windows(2).all(|pair| pair[0] != pair[1]));
}

/// The picture of a renderer, by level B.
fn drawn(host: &Host, renderer: &mut Renderer, stage: &Stage) -> Vec<[f64; 4]> {
    let image = HostImage::new(host, FORMAT, renderer.extent());
    // SAFETY: as above.
    host.run(|cmd| unsafe {
        let (target, load) = (image.target(), Load::Clear([0.0; 4]));
        let shot = shot(stage, 0);
        renderer.record_into(cmd, &shot, &target, load).unwrap();
        image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    });
    image.numbers()
}

#[test]
fn a_renderer_goes_on_with_another_size_another_volume_and_other_numbers() {
    let host = Host::new();
    for technique in [
        Technique::Raycast,
        Technique::Slices3d,
        Technique::Slices2d,
        Technique::ShearWarp,
        Technique::Splat,
    ] {
        let mut stage = stage(&Settings {
            technique,
            ..Settings::default()
        });
        let mut renderer = renderer(&host, &stage);
        let made = host.gpu().pipelines_made();
        let check = |renderer: &mut Renderer, stage: &Stage, what: &str| {
            let found = drawn(&host, renderer, stage);
            assert_same(&stage.settings, &found, &offscreen(stage), what);
        };
        check(&mut renderer, &stage, "as made");
        stage.extent = [37, 29];
        renderer.resize(stage.extent, &[]).unwrap();
        check(&mut renderer, &stage, "resized");
        stage.settings.samples_per_voxel = 1.7;
        renderer.set_settings(stage.settings.clone()).unwrap();
        check(&mut renderer, &stage, "with other numbers");
        // The next time of a series: values in another order.
        let stratavox::volume::Voxels::F32(values) = &mut stage.volume.voxels else {
            panic!("the stage has f32 values");
        };
        values
            .iter_mut()
            .for_each(|value| *value = 0.8 * (1.0 - *value));
        let next = uploaded(&host, &stage);
        renderer.set_volume(&next, Some(&stage.transfer)).unwrap();
        // SAFETY: nothing is recorded.
        let early = unsafe { renderer.draw(vk::CommandBuffer::null(), 0) };
        assert!(matches!(early, Err(Error::NotRecorded { .. })), "{early:?}");
        check(&mut renderer, &stage, "of another volume");
        assert_eq!(host.gpu().pipelines_made(), made, "{technique:?}");
    }
}

#[test]
fn a_function_that_shows_all_and_then_one_that_does_not_compile_nothing() {
    let host = Host::new();
    let mut stage = stage(&Settings::default());
    let some = stage.transfer.clone();
    for point in &mut stage.transfer.opacity {
        point.opacity = 0.5;
    }
    let mut renderer = renderer(&host, &stage);
    let made = host.gpu().pipelines_made();
    stage.transfer = some;
    renderer.set_function(Some(&stage.transfer)).unwrap();
    let found = drawn(&host, &mut renderer, &stage);
    assert_same(&stage.settings, &found, &offscreen(&stage), "some seen");
    assert_eq!(host.gpu().pipelines_made(), made);
}

#[test]
fn a_volume_whose_cells_are_for_another_filter_is_refused() {
    let host = Host::new();
    let linear = stage(&Settings::default());
    let volume = uploaded(&host, &linear);
    let mut wide = class(&linear);
    wide.settings.filter = stratavox::technique::Filter::CubicSmooth;
    let function = Some(&linear.transfer);
    let made = Renderer::new(host.gpu(), &volume, function, wide, linear.extent, &[]);
    let found = made.map(drop).expect_err("another halo").to_string();
    assert!(found.contains("another filter"), "{found}");
}

#[test]
fn what_cannot_be_drawn_so_is_refused_by_name() {
    let host = Host::new();
    let good = stage(&Settings::default());
    let volume = uploaded(&host, &good);
    let refused = |class: RendererDesc| {
        let function = Some(&good.transfer);
        let made = Renderer::new(host.gpu(), &volume, function, class, good.extent, &[]);
        made.map(drop).expect_err("refused").to_string()
    };
    let with = |change: &dyn Fn(&mut RendererDesc)| {
        let mut class = class(&good);
        change(&mut class);
        refused(class)
    };
    for (text, found) in [
        ("several rays", with(&|c| c.settings.rays_per_side = 2)),
        (
            "adaptive",
            with(&|c| c.settings.adaptive_steps = Some(0.01)),
        ),
        ("depth attachment", with(&|c| c.gives_depth = true)),
        ("images to read", with(&|c| c.host_depth = true)),
        (
            "front to back",
            with(&|c| {
                c.settings.technique = Technique::Slices3d;
                c.settings.order = Order::FrontToBack;
                c.slice_blending = SliceBlending::InTarget;
            }),
        ),
        (
            "rays that blends slices in the target",
            with(&|c| c.slice_blending = SliceBlending::InTarget),
        ),
        (
            "a mode other than composite",
            with(&|c| {
                c.settings.technique = Technique::Slices2d;
                c.settings.mode = Mode::Mip;
                c.slice_blending = SliceBlending::InTarget;
            }),
        ),
        (
            "depth attachment for R8G8B8A8_UNORM",
            with(&|c| {
                c.target.depth = Some(stratavox::gpu::DepthClass {
                    format: vk::Format::R8G8B8A8_UNORM,
                    has_stencil: false,
                    is_reversed: false,
                });
            }),
        ),
    ] {
        assert!(found.contains(text), "wanted {text}, found: {found}");
    }
    let mut renderer = renderer(&host, &good);
    // SAFETY: nothing is recorded.
    let drawn = unsafe { renderer.draw(vk::CommandBuffer::null(), 0) };
    assert!(matches!(drawn, Err(Error::NotRecorded { frame: 0, .. })));
    // SAFETY: as above.
    let drawn = unsafe { renderer.draw(vk::CommandBuffer::null(), 2) };
    assert!(matches!(drawn, Err(Error::NoFrame { found: 2, of: 2 })));
    let other = Settings {
        mode: Mode::Mip,
        ..good.settings.clone()
    };
    let found = renderer.set_settings(other).expect_err("other pipelines");
    assert!(found.to_string().contains("needs another one"), "{found}");
    let cropped = Settings {
        samples_per_voxel: 2.0,
        ..good.settings.clone()
    };
    renderer.set_settings(cropped).expect("the same pipelines");
    let mut twice = Volume::new(host.gpu(), &good.volume, &good.settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe {
        twice.record_upload(host.gpu(), cmd).unwrap();
        let again = twice.record_upload(host.gpu(), cmd);
        assert!(matches!(again, Err(Error::Uploaded)), "{again:?}");
    });
    let picked = renderer.pick(0, [1, 1]);
    assert!(matches!(picked, Err(Error::NotPicked { .. })));
}
