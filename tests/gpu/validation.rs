//! Each gate of the validation layer is alive: a mistake made on purpose is reported.
//!
//! Every control runs in a process of its own with `STRATAVOX_VALIDATION` set, so that it runs whatever the suite
//! runs under. Where the layer is not installed it says "skipped".

use crate::gpu_shared::*;
use ash::vk;
use std::{panic, process::Command, sync::Arc};
use stratavox::gpu::*;

/// Runs `mistake` in a child process under `mode`. `test` is the name of the test that calls.
fn control(mode: ValidationMode, test: &str, mistake: fn()) {
    const VARIABLE: &str = "STRATAVOX_TEST_CONTROL";
    if std::env::var(VARIABLE).is_ok_and(|asked| asked == test) {
        return mistake();
    }
    let options = Options {
        pipeline_cache: PipelineCache::Off,
        validation: Validation::On(mode),
        ..Options::default()
    };
    if let Err(error @ Error::NoValidation { .. }) = Headless::new(&DeviceChoice::Default, &options)
    {
        println!("skipped: {error}");
        return;
    }
    let child = Command::new(std::env::current_exe().unwrap())
        .args([&format!("validation::{test}"), "--exact", "--nocapture"])
        .env(VALIDATION_VARIABLE, mode.word())
        .env(VARIABLE, test)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&child.stdout) + String::from_utf8_lossy(&child.stderr);
    assert!(
        child.status.success() && said.contains("1 passed"),
        "{said}"
    );
}

/// Takes the messages; one of them must have `id` in its name and `text` in its text.
#[track_caller]
fn expect(headless: &Headless, id: &str, text: &str) {
    let messages = headless.take_validation_messages();
    let is_wanted = |message: &Message| message.id.contains(id) && message.text.contains(text);
    assert!(
        messages.iter().any(is_wanted),
        "no `{id}` about `{text}` in {messages:#?}"
    );
}

#[test]
fn core_validation_reports_a_wrong_layout() {
    control(
        ValidationMode::Core,
        "core_validation_reports_a_wrong_layout",
        || {
            let mut headless = headless();
            let gpu = Arc::clone(headless.gpu());
            let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
            let format = vk::Format::R8_UNORM;
            let desc = ImageDesc {
                kind: ImageKind::D3,
                extent: [4; 3],
                format,
                usage,
                name: "untouched",
            };
            let image = Image::new(&gpu, &desc).unwrap();
            let staging = Buffer::new(
                &gpu,
                64,
                vk::BufferUsageFlags::TRANSFER_SRC,
                Memory::Upload,
                "staging",
            )
            .unwrap();
            // SAFETY: the barrier that is missing is the mistake; lavapipe and the layer survive it.
            let copy = |cmd| unsafe {
                buffer_to_image(&gpu, cmd, &staging, 0, &image, Region::whole(&image))
            };
            headless.run(copy).unwrap();
            expect(&headless, "InvalidImageLayout", "untouched");
        },
    );
}

#[test]
fn core_validation_reports_an_image_beyond_the_limits() {
    control(
        ValidationMode::Core,
        "core_validation_reports_an_image_beyond_the_limits",
        || {
            let headless = headless();
            let gpu = headless.gpu();
            let info = vk::ImageCreateInfo::default()
                .image_type(vk::ImageType::TYPE_3D)
                .format(vk::Format::R8_UNORM)
                .extent(vk::Extent3D {
                    width: 1,
                    height: 1,
                    depth: gpu.limits().max_image_dimension_3d + 1,
                })
                .mip_levels(1)
                .array_layers(1)
                .samples(vk::SampleCountFlags::TYPE_1)
                .usage(vk::ImageUsageFlags::SAMPLED);
            // SAFETY: the extent is the mistake; the image gets no memory and is destroyed at once.
            unsafe {
                if let Ok(image) = gpu.device().create_image(&info, None) {
                    gpu.device().destroy_image(image, None);
                }
            }
            expect(&headless, "VUID-VkImageCreateInfo-extent", "extent");
        },
    );
}

#[test]
fn core_validation_reports_an_object_that_outlives_its_device_and_the_drop_panics() {
    let test = "core_validation_reports_an_object_that_outlives_its_device_and_the_drop_panics";
    control(ValidationMode::Core, test, || {
        let headless = headless();
        let info = vk::BufferCreateInfo::default()
            .size(4)
            .usage(vk::BufferUsageFlags::TRANSFER_DST);
        // SAFETY: that nobody destroys it is the mistake.
        unsafe { headless.gpu().device().create_buffer(&info, None) }.unwrap();
        let dropped = panic::catch_unwind(panic::AssertUnwindSafe(|| drop(headless)));
        let said = *dropped
            .expect_err("a message that nobody took")
            .downcast::<String>()
            .unwrap();
        assert!(
            said.contains("1 messages of STRATAVOX_VALIDATION=core"),
            "{said}"
        );
    });
}

#[test]
fn sync_validation_reports_a_missing_barrier_between_fills() {
    control(
        ValidationMode::Synchronization,
        "sync_validation_reports_a_missing_barrier_between_fills",
        || {
            let mut headless = headless();
            let gpu = Arc::clone(headless.gpu());
            let buffer = readback(&gpu, 64);
            let fill = |cmd, value| {
                // SAFETY: the buffer lives until the run has ended.
                unsafe {
                    gpu.device()
                        .cmd_fill_buffer(cmd, buffer.raw(), 0, vk::WHOLE_SIZE, value)
                };
            };
            headless
                .run(|cmd| {
                    fill(cmd, 1);
                    fill(cmd, 2);
                    Ok(())
                })
                .unwrap();
            expect(&headless, "SYNC-HAZARD-WRITE-AFTER-WRITE", "Fill");
            headless
                .run(|cmd| {
                    fill(cmd, 1);
                    // SAFETY: the buffer lives until the run has ended.
                    unsafe {
                        buffer_barrier(&gpu, cmd, &buffer, Use::TransferWrite, Use::TransferWrite)
                    };
                    fill(cmd, 2);
                    Ok(())
                })
                .unwrap();
            headless.assert_no_validation_messages();
        },
    );
}

/// One dispatch writes `numbers`, the next reads them; `barrier` stands between the two, or does not.
fn write_then_read(has_barrier: bool, shift: u32) -> Headless {
    let mut headless = headless();
    let gpu = Arc::clone(headless.gpu());
    let ring = ParameterRing::new(&gpu, 8, 2, "params").unwrap();
    ring.write(0, bytemuck::cast_slice(&[1_u32, 0])).unwrap();
    ring.write(1, bytemuck::cast_slice(&[shift, 0])).unwrap();
    let (numbers_buffer, sums) = (readback(&gpu, 256), readback(&gpu, 256));
    let write = ComputePipeline::new(&gpu, &ramp()).unwrap();
    let read = ComputePipeline::new(&gpu, &shifted()).unwrap();
    let params = ("params", Resource::Uniform(&ring));
    let first = [params, ("numbers", Resource::Storage(&numbers_buffer))];
    let second = [first[0], first[1], ("sums", Resource::Storage(&sums))];
    let first = Bindings::new(&gpu, write.layout(), &first).unwrap();
    let second = Bindings::new(&gpu, read.layout(), &second).unwrap();
    let offset = ring.offset(1).unwrap();
    // SAFETY: everything lives until the run has ended; the barrier that may be missing is the mistake.
    headless
        .run(|cmd| unsafe {
            write.dispatch(cmd, &first, &[0], [8, 1, 1]);
            if has_barrier {
                buffer_barrier(
                    &gpu,
                    cmd,
                    &numbers_buffer,
                    Use::ComputeWrite,
                    Use::ComputeRead,
                );
            }
            read.dispatch(cmd, &second, &[offset], [8, 1, 1]);
            Ok(())
        })
        .unwrap();
    headless
}

#[test]
fn sync_validation_reports_a_missing_barrier_between_dispatches() {
    let test = "sync_validation_reports_a_missing_barrier_between_dispatches";
    control(ValidationMode::Synchronization, test, || {
        expect(
            &write_then_read(false, 0),
            "SYNC-HAZARD-READ-AFTER-WRITE",
            "Dispatch",
        );
        write_then_read(true, 0).assert_no_validation_messages();
    });
}

#[test]
fn gpu_assisted_validation_reports_a_read_beyond_a_buffer() {
    control(
        ValidationMode::GpuAssisted,
        "gpu_assisted_validation_reports_a_read_beyond_a_buffer",
        || {
            write_then_read(true, 0).assert_no_validation_messages();
            expect(
                &write_then_read(true, 1000),
                "VUID-vkCmdDispatch",
                "out of bounds",
            );
        },
    );
}

#[test]
fn best_practices_report_a_barrier_between_all_commands() {
    control(
        ValidationMode::BestPractices,
        "best_practices_report_a_barrier_between_all_commands",
        || {
            let mut headless = headless();
            let gpu = Arc::clone(headless.gpu());
            let barriers = [vk::MemoryBarrier2::default()
                .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
                .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)];
            let info = vk::DependencyInfo::default().memory_barriers(&barriers);
            // SAFETY: legal, and wasteful on purpose.
            headless
                .run(|cmd| unsafe {
                    gpu.device().cmd_pipeline_barrier2(cmd, &info);
                    Ok(())
                })
                .unwrap();
            expect(
                &headless,
                "BestPractices-pipeline-stage-flags",
                "ALL_COMMANDS",
            );
        },
    );
}

#[test]
fn a_word_that_is_no_mode_is_refused_by_name() {
    const TEST: &str = "validation::a_word_that_is_no_mode_is_refused_by_name";
    if std::env::var_os("STRATAVOX_TEST_CONTROL").is_some() {
        let refused = Headless::new(&DeviceChoice::Default, &Options::default()).map(|_| ());
        return println!("refused: {}", refused.unwrap_err());
    }
    let child = Command::new(std::env::current_exe().unwrap())
        .args([TEST, "--exact", "--nocapture"])
        .env(VALIDATION_VARIABLE, "everything")
        .env("STRATAVOX_TEST_CONTROL", TEST)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&child.stdout);
    let wanted =
        "environment variable STRATAVOX_VALIDATION is `everything`, wanted core, sync, gpu or best";
    assert!(said.contains(wanted), "{said}");
}

#[test]
fn validation_without_the_layer_is_refused_with_the_name_of_its_package() {
    const TEST: &str =
        "validation::validation_without_the_layer_is_refused_with_the_name_of_its_package";
    if std::env::var_os("STRATAVOX_TEST_CONTROL").is_some() {
        let refused = Headless::new(&DeviceChoice::Default, &Options::default()).map(|_| ());
        return println!("refused: {}", refused.unwrap_err());
    }
    let child = Command::new(std::env::current_exe().unwrap())
        .args([TEST, "--exact", "--nocapture"])
        .env(VALIDATION_VARIABLE, "sync")
        .env("VK_LAYER_PATH", "/nonexistent")
        .env("STRATAVOX_TEST_CONTROL", TEST)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&child.stdout);
    let wanted = "validation mode `sync` needs VK_LAYER_KHRONOS_validation, which is not installed \
                  (Debian and Ubuntu: package vulkan-validationlayers)";
    assert!(said.contains(wanted), "{said}");
}
