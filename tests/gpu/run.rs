//! What is recorded runs, and arrives.

use crate::gpu_shared::*;
use ash::vk;
use std::sync::Arc;
use stratavox::gpu::*;
use stratavox::shaders::{BindingKind, BindingSlot, Shader, Stage};

#[test]
fn a_dispatch_reads_the_slot_of_its_offset_and_the_host_reads_what_it_wrote() {
    let mut headless = headless();
    let gpu = Arc::clone(headless.gpu());
    let pipeline = ComputePipeline::new(&gpu, &ramp()).unwrap();
    let ring = ParameterRing::new(&gpu, 8, 3, "params").unwrap();
    let numbers_buffer = readback(&gpu, 256);
    let resources = [
        ("numbers", Resource::Storage(&numbers_buffer)),
        ("params", Resource::Uniform(&ring)),
    ];
    let bindings = Bindings::new(&gpu, pipeline.layout(), &resources).unwrap();
    for (slot, [factor, term]) in [[3_u32, 7], [5, 1], [11, 2]].into_iter().enumerate() {
        let slot = slot as u32;
        ring.write(slot, bytemuck::cast_slice(&[factor, term]))
            .unwrap();
        let groups = pipeline.groups([64, 1, 1]).unwrap();
        let offset = ring.offset(slot).unwrap();
        // SAFETY: everything lives until the run has ended.
        headless
            .run(|cmd| unsafe {
                pipeline.dispatch(cmd, &bindings, &[offset], groups);
                Ok(())
            })
            .unwrap();
        let wanted: Vec<u32> = (0..64).map(|i| factor * i + term).collect();
        assert_eq!(numbers::<u32>(&numbers_buffer), wanted, "slot {slot}");
    }
    headless.assert_no_validation_messages();
}

#[test]
fn a_run_that_fails_to_record_submits_nothing_and_the_next_one_works() {
    let mut headless = headless();
    let gpu = Arc::clone(headless.gpu());
    let buffer = readback(&gpu, 16);
    let fill = |cmd, value| {
        // SAFETY: the buffer lives until the run has ended.
        unsafe {
            gpu.device()
                .cmd_fill_buffer(cmd, buffer.raw(), 0, vk::WHOLE_SIZE, value)
        };
        Ok(())
    };
    headless.run(|cmd| fill(cmd, 1)).unwrap();
    let refused = headless.run(|cmd| {
        fill(cmd, 2)?;
        buffer.write(15, &[0, 0])
    });
    assert!(
        matches!(refused, Err(Error::Argument { .. })),
        "{refused:?}"
    );
    assert_eq!(numbers::<u32>(&buffer), [1; 4]);
    headless.run(|cmd| fill(cmd, 3)).unwrap();
    assert_eq!(numbers::<u32>(&buffer), [3; 4]);
}

/// Copies a box of counted bytes into the middle of an image of zeros, and reads the whole image back.
fn box_through_an_image(kind: ImageKind) {
    let mut headless = headless();
    let gpu = Arc::clone(headless.gpu());
    let extent = [7, 5, 4];
    use vk::ImageUsageFlags as Usage;
    let usage = Usage::SAMPLED | Usage::TRANSFER_DST | Usage::TRANSFER_SRC;
    let desc = ImageDesc {
        kind,
        extent,
        format: vk::Format::R8_UNORM,
        usage,
        name: "box",
    };
    let image = Image::new(&gpu, &desc).unwrap();
    let inner = Region {
        origin: [2, 1, 1],
        extent: [3, 2, 2],
    };
    let staging = Buffer::new(
        &gpu,
        160,
        vk::BufferUsageFlags::TRANSFER_SRC,
        Memory::Upload,
        "staging",
    )
    .unwrap();
    staging.write(0, &[0; 140]).unwrap();
    staging.write(144, &(1..=12).collect::<Vec<u8>>()).unwrap();
    let back = readback(&gpu, 144);
    let whole = Region::whole(&image);
    // SAFETY: everything lives until the run has ended, and each use is ordered by a barrier.
    headless
        .run(|cmd| unsafe {
            image_barrier(&gpu, cmd, &image, Use::Nothing, Use::TransferWrite);
            buffer_to_image(&gpu, cmd, &staging, 0, &image, whole)?;
            image_barrier(&gpu, cmd, &image, Use::TransferWrite, Use::TransferWrite);
            buffer_to_image(&gpu, cmd, &staging, 144, &image, inner)?;
            image_barrier(&gpu, cmd, &image, Use::TransferWrite, Use::TransferRead);
            image_to_buffer(&gpu, cmd, &image, whole, &back, 4)
        })
        .unwrap();
    let found = numbers::<u8>(&back);
    let mut wanted = 1_u8;
    for z in 0..4 {
        for y in 0..5 {
            for x in 0..7 {
                let is_inner = (2..5).contains(&x) && (1..3).contains(&y) && (1..3).contains(&z);
                let found = found[4 + x + 7 * (y + 5 * z)];
                assert_eq!(
                    found,
                    if is_inner { wanted } else { 0 },
                    "{kind:?} at {x} {y} {z}"
                );
                wanted += u8::from(is_inner);
            }
        }
    }
    headless.assert_no_validation_messages();
}

#[test]
fn a_box_of_texels_arrives_in_a_3d_image() {
    box_through_an_image(ImageKind::D3);
}

#[test]
fn a_box_of_texels_arrives_in_the_layers_of_an_array() {
    box_through_an_image(ImageKind::D2Array);
}

#[test]
fn copies_outside_of_image_or_buffer_are_refused() {
    let mut headless = headless();
    let gpu = Arc::clone(headless.gpu());
    use vk::ImageUsageFlags as Usage;
    let usage = Usage::SAMPLED | Usage::TRANSFER_DST | Usage::TRANSFER_SRC;
    let format = vk::Format::R16_UNORM;
    let desc = ImageDesc {
        kind: ImageKind::D3,
        extent: [4, 4, 4],
        format,
        usage,
        name: "small",
    };
    let image = Image::new(&gpu, &desc).unwrap();
    let buffer = readback(&gpu, 128);
    let region = |origin, extent| Region { origin, extent };
    let cases = [
        (0, region([1, 0, 0], [4, 4, 4])),
        (0, region([0, 0, 4], [1, 1, 1])),
        (0, region([0, u32::MAX, 0], [1, 2, 1])),
        (0, region([0, 0, 0], [0, 1, 1])),
        (4, region([0, 0, 0], [4, 4, 4])),
        (2, region([0, 0, 0], [1, 1, 1])),
        (u64::MAX - 3, region([0, 0, 0], [1, 1, 1])),
    ];
    for (offset, region) in cases {
        // SAFETY: nothing is recorded.
        let refused = headless
            .run(|cmd| unsafe { image_to_buffer(&gpu, cmd, &image, region, &buffer, offset) });
        assert!(
            matches!(refused, Err(Error::Argument { .. })),
            "{region:?} at {offset}: {refused:?}"
        );
    }
}

/// Writes where `position` falls between the two texels of an image, through a linear sampler.
fn between() -> Shader {
    const BINDINGS: &[BindingSlot] = &[
        slot(3, "volume", BindingKind::Texture),
        slot(4, "volume_sampler", BindingKind::Sampler),
        slot(7, "target_image", BindingKind::StorageImage),
    ];
    let text = "
        @group(0) @binding(3) var volume: texture_3d<f32>;
        @group(0) @binding(4) var volume_sampler: sampler;
        @group(0) @binding(7) var target_image: texture_storage_2d<rgba32float, write>;
        @compute @workgroup_size(8)
        fn main(@builtin(global_invocation_id) id: vec3<u32>) {
            let position = vec3<f32>((f32(id.x) + 0.5) / 8.0, 0.5, 0.5);
            textureStore(target_image, id.xy, textureSampleLevel(volume, volume_sampler, position, 0.0));
        }";
    shader(
        "test.between",
        Stage::Compute {
            workgroup: [8, 1, 1],
        },
        BINDINGS,
        text,
    )
}

#[test]
fn a_texture_is_sampled_and_a_storage_image_is_written() {
    let mut headless = headless();
    let gpu = Arc::clone(headless.gpu());
    let make = |kind, extent, format, usage, name| {
        Image::new(
            &gpu,
            &ImageDesc {
                kind,
                extent,
                format,
                usage,
                name,
            },
        )
        .unwrap()
    };
    use vk::ImageUsageFlags as Usage;
    let read = Usage::SAMPLED | Usage::TRANSFER_DST;
    let volume = make(
        ImageKind::D3,
        [2, 1, 1],
        vk::Format::R16_UNORM,
        read,
        "volume",
    );
    let written = Usage::STORAGE | Usage::TRANSFER_SRC;
    let target = make(
        ImageKind::D2,
        [8, 1, 1],
        vk::Format::R32G32B32A32_SFLOAT,
        written,
        "target",
    );
    let staging = Buffer::new(
        &gpu,
        4,
        vk::BufferUsageFlags::TRANSFER_SRC,
        Memory::Upload,
        "staging",
    )
    .unwrap();
    staging
        .write(0, bytemuck::cast_slice(&[0_u16, u16::MAX]))
        .unwrap();
    let back = readback(&gpu, 128);
    let pipeline = ComputePipeline::new(&gpu, &between()).unwrap();
    let run = |headless: &mut Headless, sampler: &Sampler| {
        let resources = [
            ("volume", Resource::sampled(&volume)),
            ("volume_sampler", Resource::Sampler(sampler)),
            ("target_image", Resource::written(&target)),
        ];
        let bindings = Bindings::new(&gpu, pipeline.layout(), &resources).unwrap();
        // SAFETY: everything lives until the run has ended, and each use is ordered by a barrier.
        headless
            .run(|cmd| unsafe {
                image_barrier(&gpu, cmd, &volume, Use::Nothing, Use::TransferWrite);
                buffer_to_image(&gpu, cmd, &staging, 0, &volume, Region::whole(&volume))?;
                image_barrier(&gpu, cmd, &volume, Use::TransferWrite, Use::ComputeSampled);
                image_barrier(&gpu, cmd, &target, Use::Nothing, Use::ComputeWrite);
                pipeline.dispatch(cmd, &bindings, &[], pipeline.groups([8, 1, 1])?);
                image_barrier(&gpu, cmd, &target, Use::ComputeWrite, Use::TransferRead);
                image_to_buffer(&gpu, cmd, &target, Region::whole(&target), &back, 0)
            })
            .unwrap();
        numbers::<[f32; 4]>(&back)
            .iter()
            .map(|color| color[0])
            .collect::<Vec<_>>()
    };
    let nearest = run(&mut headless, &Sampler::nearest_clamp(&gpu).unwrap());
    assert_eq!(nearest, [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]);
    // Texel centres are at 1/4 and 3/4. A weight is off by 2^-bits at most, and so is this value, whose step is 1.
    let allowed = 0.5_f32.powi(gpu.limits().subtexel_bits as i32);
    let linear = run(&mut headless, &Sampler::linear_clamp(&gpu).unwrap());
    for (k, found) in linear.into_iter().enumerate() {
        let wanted = (((k as f32 + 0.5) / 8.0 - 0.25) * 2.0).clamp(0.0, 1.0);
        assert!(
            (found - wanted).abs() <= allowed,
            "{k}: {found}, not {wanted}"
        );
    }
    headless.assert_no_validation_messages();
}

#[test]
fn every_blend_is_its_formula() {
    // Sums and products of these numbers are exact in 32 bits.
    let (old, new) = ([0.25_f32, 0.5, 0.0, 0.5], [0.5_f32, 0.125, 0.25, 0.75]);
    let each = |formula: fn(f32, f32) -> f32| std::array::from_fn(|k| formula(new[k], old[k]));
    let cases: [(Blend, [f32; 4]); 6] = [
        (Blend::Replace, new),
        (Blend::Over, each(|new, old| new + (1.0 - 0.75) * old)),
        (Blend::Under, each(|new, old| (1.0 - 0.5) * new + old)),
        (Blend::Add, each(|new, old| new + old)),
        (Blend::Max, each(f32::max)),
        (Blend::Min, each(f32::min)),
    ];
    let mut headless = headless();
    let gpu = Arc::clone(headless.gpu());
    let format = vk::Format::R32G32B32A32_SFLOAT;
    if !gpu.format_features(format).blend {
        println!("skipped: this device does not blend {format:?}");
        return;
    }
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
    let extent = [3, 2, 1];
    let image = ImageDesc {
        kind: ImageKind::D2,
        extent,
        format,
        usage,
        name: "target",
    };
    let image = Image::new(&gpu, &image).unwrap();
    let target = Target {
        image: image.raw(),
        view: image.view(),
        format,
        extent: [3, 2],
        before: Use::Nothing.into(),
        after: Use::TransferRead.into(),
    };
    let back = readback(&gpu, 96);
    let ring = ParameterRing::new(&gpu, 16, 1, "params").unwrap();
    ring.write(0, bytemuck::cast_slice(&new)).unwrap();
    let (cover, flat) = (cover(), flat());
    for (blend, wanted) in cases {
        let desc = RasterDesc {
            vertex: &cover,
            fragment: &flat,
            target: format.into(),
            blend,
            depth: DepthUse::Ignored,
        };
        let pipeline = RasterPipeline::new(&gpu, &desc).unwrap();
        let bindings = Bindings::new(
            &gpu,
            pipeline.layout(),
            &[("params", Resource::Uniform(&ring))],
        )
        .unwrap();
        // SAFETY: everything lives until the run has ended, and each use is ordered by a barrier.
        headless
            .run(|cmd| unsafe {
                target.enter(&gpu, cmd, Use::ColorTarget);
                begin_rendering(&gpu, cmd, &[(target.view, Load::Clear(old))], target.extent);
                set_area(&gpu, cmd, target.extent);
                pipeline.draw(cmd, &bindings, &[0], 3, 0..1);
                end_rendering(&gpu, cmd);
                target.leave(&gpu, cmd, Use::ColorTarget);
                image_to_buffer(&gpu, cmd, &image, Region::whole(&image), &back, 0)
            })
            .unwrap();
        assert_eq!(numbers::<[f32; 4]>(&back), [wanted; 6], "{blend:?}");
    }
    headless.assert_no_validation_messages();
}

#[test]
fn a_timer_measures_what_lies_between_its_marks() {
    let mut headless = headless();
    let gpu = Arc::clone(headless.gpu());
    let Some(timer) = Timer::new(&gpu).unwrap() else {
        println!("skipped: this device has no timestamps");
        return;
    };
    let buffer = readback(&gpu, 16 << 20);
    let fill = |cmd| {
        // SAFETY: the buffer lives until the run has ended.
        unsafe {
            gpu.device()
                .cmd_fill_buffer(cmd, buffer.raw(), 0, vk::WHOLE_SIZE, 7)
        };
    };
    let wall = std::time::Instant::now();
    // SAFETY: the timer lives until the run has ended.
    headless
        .run(|cmd| unsafe {
            timer.start(cmd);
            fill(cmd);
            timer.stop(cmd);
            Ok(())
        })
        .unwrap();
    let wall_ms = 1e3 * wall.elapsed().as_secs_f64();
    let gpu_ms = timer.elapsed_ms().unwrap().expect("the run has ended");
    // What was measured lies inside the run, by whatever clock: a wrong unit would be off by a thousand.
    assert!(
        gpu_ms > 0.0 && gpu_ms <= wall_ms,
        "{gpu_ms} ms of {wall_ms} ms"
    );
    headless.assert_no_validation_messages();
}
