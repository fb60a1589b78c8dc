//! A lost device is heard of once, and only destroyed from then on.

use crate::hooked::{FEATURES, Host, Stage, Tape, headless, hooked, of_device};
use ash::vk;
use std::sync::Arc;
use stratavox::gpu::{self, *};
use stratavox::offscreen::{self, Renderer};
use stratavox::resident::GpuVolume;
use stratavox::resolve::Resolve;
use stratavox::scene::Scene;
use stratavox::technique::{ACCUMULATION_FORMAT, Mode, Settings, accumulation};

#[test]
fn a_lost_device_is_not_called_again_but_to_destroy_what_was_made_on_it() {
    let tape = Tape::begin();
    let (host, stage) = (Host::new(), Stage::new());
    let device = host.device(FEATURES);
    // SAFETY: the handles are right; nothing recorded here is submitted, and all of it is dropped before the device.
    unsafe {
        let gpu = Gpu::from_host(device.handles(hooked)).unwrap();
        let timer = Timer::new(&gpu).unwrap().expect("a queue with a clock");
        let (image, picture) = ("image", "picture");
        let image = accumulation(&gpu, [8, 8], image).unwrap();
        let target = accumulation(&gpu, [8, 8], picture).unwrap();
        let bytes = 16 * 64;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let readback = Buffer::new(&gpu, bytes, usage, Memory::Readback, "readback").unwrap();
        let volume = GpuVolume::new(&gpu, &stage.volume, stage.layout()).unwrap();
        let staging = volume.stage(&stage.volume).unwrap();
        assert!(!gpu.is_lost());

        tape.lose_at_next("vkGetQueryPoolResults");
        let told = timer.elapsed_ms().unwrap_err();
        assert!(
            matches!(&told, gpu::Error::DeviceLost { doing } if doing == "read a timer"),
            "{told}"
        );
        assert!(gpu.is_lost());

        let refusals = [
            Buffer::new(&gpu, 16, usage, Memory::Device, "later").err(),
            accumulation(&gpu, [8, 8], "later").err(),
            Sampler::linear_clamp(&gpu).err(),
            gpu::Timer::new(&gpu).err(),
            timer.elapsed_ms().err(),
            gpu.pipeline_cache_data().err(),
            Resolve::new(&gpu, Mode::Composite, Blend::Replace, ACCUMULATION_FORMAT).err(),
            GpuVolume::new(&gpu, &stage.volume, stage.layout()).err(),
        ];
        for (k, told) in refusals.into_iter().enumerate() {
            let is_named =
                matches!(&told, Some(gpu::Error::DeviceLost { doing }) if !doing.is_empty());
            assert!(is_named, "call {k}: {told:?}");
        }
        let told = stage.draw(&device, &gpu).unwrap_err();
        assert!(
            matches!(of_device(&*told), gpu::Error::DeviceLost { .. }),
            "{told}"
        );

        let cmd = device.begin();
        timer.start(cmd);
        volume.record_upload_all(cmd, &staging).unwrap();
        image_barrier(&gpu, cmd, &image, Use::Nothing, Use::TransferWrite);
        clear_image(&gpu, cmd, &image, [0.0; 4]);
        begin_rendering(&gpu, cmd, &[(target.view(), Load::Keep)], [8, 8]);
        set_area(&gpu, cmd, [8, 8]);
        end_rendering(&gpu, cmd);
        image_to_buffer(&gpu, cmd, &image, Region::whole(&image), &readback, 0).unwrap();
        buffer_barrier(&gpu, cmd, &readback, Use::TransferWrite, Use::HostRead);
        timer.stop(cmd);
        assert_eq!(tape.after_loss(), Vec::<&str>::new());

        drop((timer, image, target, readback, volume, staging));
        gpu.retire(u64::MAX);
        assert_eq!(Arc::strong_count(&gpu), 1);
        drop(gpu);
    }
    assert_eq!(tape.after_loss(), Vec::<&str>::new());
    assert_eq!(tape.books(), Vec::<&str>::new());
}

#[test]
fn a_host_that_hears_of_the_loss_first_says_so() {
    let tape = Tape::begin();
    let (host, stage) = (Host::new(), Stage::new());
    let device = host.device(FEATURES);
    // SAFETY: the handles are right, and everything made on the device is dropped before it.
    let gpu = unsafe { Gpu::from_host(device.handles(hooked)).unwrap() };
    gpu.declare_lost();
    tape.lose();
    let told = stage.draw(&device, &gpu).unwrap_err();
    assert!(
        matches!(of_device(&*told), gpu::Error::DeviceLost { .. }),
        "{told}"
    );
    drop(gpu);
    assert_eq!(tape.after_loss(), Vec::<&str>::new());
    assert_eq!(tape.books(), Vec::<&str>::new());
}

#[test]
fn a_renderer_whose_device_was_lost_says_so_from_then_on() {
    let tape = Tape::begin();
    let stage = Stage::new();
    let settings = Settings::default();
    let scene = Scene {
        beside: Default::default(),
        volume: &stage.volume,
        transfer: Some(&stage.transfer),
        camera: &stage.camera,
        extent_pixels: [16, 12],
        settings: &settings,
    };
    let mut renderer = Renderer::new(headless().unwrap(), &stage.volume).unwrap();
    renderer.render(&scene, &[]).unwrap();
    tape.lose_at_next("vkWaitForFences");
    for _ in 0..3 {
        let told = renderer.render(&scene, &[]).unwrap_err();
        let is_lost = matches!(&told, offscreen::Error::Gpu(gpu::Error::DeviceLost { .. }));
        assert!(is_lost, "{told}");
    }
    assert!(renderer.device().gpu().is_lost());
    drop(renderer);
    assert_eq!(tape.after_loss(), Vec::<&str>::new());
    assert_eq!(tape.books(), Vec::<&str>::new());
}
