//! Who owns what, and when it is destroyed; what is bound to which name.

use crate::gpu_shared::*;
use ash::vk;
use std::{collections::BTreeMap, sync::Arc};
use stratavox::gpu::*;
use stratavox::shaders::{BindingKind, BindingSlot};

const TRANSFER: vk::BufferUsageFlags = vk::BufferUsageFlags::TRANSFER_DST;

fn small(gpu: &Arc<Gpu>) -> Buffer {
    Buffer::new(gpu, 64, TRANSFER, Memory::Device, "small").unwrap()
}

fn count(gpu: &Gpu, word: &str) -> usize {
    gpu.live_objects().get(word).copied().unwrap_or(0)
}

#[test]
fn what_is_dropped_lives_until_the_timeline_has_passed_the_value_announced_before() {
    let headless = headless();
    let gpu = headless.gpu();
    let [first, second, third] = [(); 3].map(|()| small(gpu));
    gpu.announce(5);
    drop(first);
    gpu.announce(7);
    drop(second);
    drop(third);
    let mut alive = Vec::new();
    for completed in [0, 4, 5, 6, 7] {
        // SAFETY: nothing was submitted.
        unsafe { gpu.retire(completed) };
        alive.push(count(gpu, "buffer"));
    }
    assert_eq!(alive, [3, 3, 2, 2, 0]);
    assert_eq!(count(gpu, "memory"), 0);
}

#[test]
fn an_announced_value_that_falls_says_nothing() {
    let headless = headless();
    let gpu = headless.gpu();
    gpu.announce(7);
    gpu.announce(6);
    drop(small(gpu));
    // SAFETY: nothing was submitted, here and below.
    unsafe { gpu.retire(6) };
    assert_eq!(count(gpu, "buffer"), 1);
    // SAFETY: as above.
    unsafe { gpu.retire(7) };
    assert_eq!(count(gpu, "buffer"), 0);
}

#[test]
fn a_device_is_shared_between_threads_and_an_error_is_sent() {
    fn shared<T: Send + Sync + 'static>() {}
    shared::<Gpu>();
    shared::<Headless>();
    shared::<Error>();
    shared::<(Buffer, Image, Sampler, Bindings, ParameterRing, Timer)>();
    shared::<(ComputePipeline, RasterPipeline)>();
}

#[test]
fn what_is_dropped_before_anything_was_announced_goes_at_the_next_retire() {
    let headless = headless();
    drop(small(headless.gpu()));
    // SAFETY: nothing was submitted.
    unsafe { headless.gpu().retire(0) };
    assert_eq!(count(headless.gpu(), "buffer"), 0);
}

#[test]
fn every_kind_of_owner_is_gone_after_drop_and_retire() {
    let headless = headless();
    let gpu = headless.gpu();
    let before = gpu.live_objects();
    {
        let _buffer = small(gpu);
        let usage = vk::ImageUsageFlags::SAMPLED;
        let format = vk::Format::R16_UNORM;
        let desc = ImageDesc {
            kind: ImageKind::D2Array,
            extent: [4, 4, 3],
            format,
            usage,
            name: "stack",
        };
        let _image = Image::new(gpu, &desc).unwrap();
        let _samplers = [
            Sampler::linear_clamp(gpu).unwrap(),
            Sampler::nearest_clamp(gpu).unwrap(),
        ];
        let _compute = ComputePipeline::new(gpu, &ramp()).unwrap();
        let (vertex, fragment) = (cover(), flat());
        let desc = RasterDesc {
            vertex: &vertex,
            fragment: &fragment,
            target: vk::Format::R8G8B8A8_UNORM.into(),
            blend: Blend::Over,
            depth: DepthUse::Ignored,
        };
        let raster = RasterPipeline::new(gpu, &desc).unwrap();
        let ring = ParameterRing::new(gpu, 16, 2, "params").unwrap();
        let _bindings = Bindings::new(
            gpu,
            raster.layout(),
            &[("params", Resource::Uniform(&ring))],
        )
        .unwrap();
        let _timer = Timer::new(gpu).unwrap();
        let alive = gpu.live_objects();
        let kinds = [
            "buffer",
            "image",
            "image view",
            "sampler",
            "descriptor set layout",
            "pipeline layout",
        ];
        let kinds = kinds
            .iter()
            .chain(&["shader module", "descriptor set", "memory"]);
        for kind in kinds {
            assert!(alive.contains_key(kind), "no {kind} in {alive:?}");
        }
    }
    // SAFETY: nothing was submitted.
    unsafe { gpu.retire(0) };
    assert_eq!(gpu.live_objects(), before);
    assert_eq!(before, BTreeMap::from([("command pool", 1), ("fence", 1)]));
}

#[test]
fn a_constructor_that_fails_halfway_leaves_nothing_behind() {
    let headless = clamped(Caps {
        max_allocations: 0,
        ..Caps::UNLIMITED
    });
    let gpu = headless.gpu();
    let before = gpu.live_objects();
    let buffer = Buffer::new(gpu, 64, TRANSFER, Memory::Device, "unlucky");
    let usage = vk::ImageUsageFlags::SAMPLED;
    let format = vk::Format::R8_UNORM;
    let desc = ImageDesc {
        kind: ImageKind::D3,
        extent: [4; 3],
        format,
        usage,
        name: "unlucky",
    };
    let image = Image::new(gpu, &desc);
    for failed in [buffer.map(|_| ()), image.map(|_| ())] {
        let limit = "maxMemoryAllocationCount";
        assert!(
            matches!(&failed, Err(Error::Limit { limit: found, .. }) if *found == limit),
            "{failed:?}"
        );
    }
    // SAFETY: nothing was submitted.
    unsafe { gpu.retire(0) };
    assert_eq!(gpu.live_objects(), before);
}

#[test]
fn a_small_user_takes_little_memory_from_the_driver() {
    let headless = headless();
    let _buffer = small(headless.gpu());
    assert_eq!(headless.gpu().memory().reserved_bytes, 4 << 20);
}

#[test]
fn host_access_outside_of_a_buffer_is_refused() {
    let headless = headless();
    let gpu = headless.gpu();
    let buffer = Buffer::new(gpu, 10, TRANSFER, Memory::Readback, "ten").unwrap();
    buffer.write(4, &[1, 2, 3, 4, 5, 6]).unwrap();
    let mut back = [0; 6];
    buffer.read(4, &mut back).unwrap();
    assert_eq!(back, [1, 2, 3, 4, 5, 6]);
    buffer.write(10, &[]).unwrap();
    for (offset, count) in [(5, 6), (10, 1), (11, 0), (u64::MAX, 1), (0, 11)] {
        let mut bytes = vec![0; count];
        assert!(
            buffer.write(offset, &bytes).is_err(),
            "write {count} at {offset}"
        );
        assert!(
            buffer.read(offset, &mut bytes).is_err(),
            "read {count} at {offset}"
        );
    }
    let device = Buffer::new(gpu, 10, TRANSFER, Memory::Device, "device").unwrap();
    assert!(device.write(0, &[0]).is_err(), "wrote into device memory");
}

#[test]
fn slots_of_a_ring_lie_a_multiple_of_256_bytes_apart() {
    let headless = clamped(Caps {
        min_uniform_offset_alignment: 1024,
        ..Caps::UNLIMITED
    });
    let wide = ParameterRing::new(headless.gpu(), 100, 3, "wide").unwrap();
    assert_eq!(
        [0, 1, 2].map(|slot| wide.offset(slot).unwrap()),
        [0, 1024, 2048]
    );
    let headless = crate::gpu_shared::headless();
    let gpu = headless.gpu();
    for (bytes, stride) in [(1, 256), (256, 256), (257, 512), (1000, 1024)] {
        let ring = ParameterRing::new(gpu, bytes, 4, "params").unwrap();
        let found = [0, 1, 2, 3].map(|slot| ring.offset(slot).unwrap());
        assert_eq!(found, [0, stride, 2 * stride, 3 * stride], "{bytes} bytes");
        let alignment = gpu.limits().min_uniform_offset_alignment as u32;
        assert!(
            stride.is_multiple_of(alignment),
            "{stride} and the device's {alignment}"
        );
        assert!(
            ring.offset(4).is_err() && ring.write(4, &[0]).is_err(),
            "slot 4 of 4"
        );
        assert!(
            ring.write(0, &vec![0; bytes as usize + 1]).is_err(),
            "{bytes} bytes and one"
        );
        ring.write(3, &vec![0; bytes as usize]).unwrap();
    }
}

#[test]
fn a_ring_whose_offsets_do_not_fit_32_bits_is_refused() {
    let headless = headless();
    let refused = ParameterRing::new(headless.gpu(), 256, 1 << 24, "endless").map(|_| ());
    assert!(
        matches!(
            refused,
            Err(Error::Limit {
                wanted: 0x1_0000_0000,
                ..
            })
        ),
        "{refused:?}"
    );
}

/// Binds `resources` to the shader `test.ramp`, and says what was refused.
fn refusal(gpu: &Arc<Gpu>, resources: &[(&str, Resource<'_>)]) -> String {
    let pipeline = ComputePipeline::new(gpu, &ramp()).unwrap();
    Bindings::new(gpu, pipeline.layout(), resources)
        .expect_err("a mistake")
        .to_string()
}

#[test]
fn a_wrong_binding_is_refused_by_name() {
    let headless = headless();
    let gpu = headless.gpu();
    let ring = ParameterRing::new(gpu, 8, 1, "params").unwrap();
    let short_ring = ParameterRing::new(gpu, 4, 1, "short").unwrap();
    let (buffer, no_storage) = (readback(gpu, 64), small(gpu));
    let (params, numbers) = (
        ("params", Resource::Uniform(&ring)),
        ("numbers", Resource::Storage(&buffer)),
    );
    let cases: [(&[(&str, Resource<'_>)], &str); 7] = [
        (&[params], "nothing is given for `numbers`"),
        (
            &[params, numbers, ("volume", numbers.1)],
            "it has no `volume`, it declares params, numbers",
        ),
        (&[params, numbers, numbers], "`numbers` is given twice"),
        (
            &[params, ("numbers", params.1)],
            "`numbers` takes Storage, found a parameter ring",
        ),
        (
            &[("params", numbers.1), numbers],
            "`params` takes Uniform(8), found a buffer",
        ),
        (
            &[("params", Resource::Uniform(&short_ring)), numbers],
            "takes 8 bytes, a slot of the ring has 4",
        ),
        (
            &[params, ("numbers", Resource::Storage(&no_storage))],
            "buffer `small` was made without that usage",
        ),
    ];
    for (resources, wanted) in cases {
        let found = refusal(gpu, resources);
        assert!(
            found.contains(wanted) && found.contains("test.ramp"),
            "{found}"
        );
    }
}

#[test]
fn stages_that_disagree_about_a_binding_are_refused() {
    const OTHER: &[BindingSlot] = &[slot(0, "camera", BindingKind::Uniform(16))];
    let headless = headless();
    let (mut vertex, fragment) = (cover(), flat());
    vertex.bindings = OTHER;
    let desc = RasterDesc {
        vertex: &vertex,
        fragment: &fragment,
        target: vk::Format::R8G8B8A8_UNORM.into(),
        blend: Blend::Replace,
        depth: DepthUse::Ignored,
    };
    let refused = RasterPipeline::new(headless.gpu(), &desc)
        .expect_err("a mistake")
        .to_string();
    assert!(
        refused.contains("binding 0 is `camera`") && refused.contains("`params`"),
        "{refused}"
    );
}

#[test]
fn a_shader_of_the_wrong_stage_is_refused() {
    let headless = headless();
    let refused = ComputePipeline::new(headless.gpu(), &cover())
        .expect_err("a mistake")
        .to_string();
    assert!(
        refused.contains("wanted a compute shader, found `test.cover`, which is Vertex"),
        "{refused}"
    );
}

#[test]
fn pipelines_are_counted_as_they_are_made() {
    let headless = headless();
    let gpu = headless.gpu();
    assert_eq!(gpu.pipelines_made(), 0);
    let _first = ComputePipeline::new(gpu, &ramp()).unwrap();
    let _again = ComputePipeline::new(gpu, &ramp()).unwrap();
    assert_eq!(gpu.pipelines_made(), 1, "a device has each of them once");
    let _other = ComputePipeline::new(gpu, &shifted()).unwrap();
    assert_eq!(gpu.pipelines_made(), 2);
    let (vertex, fragment) = (cover(), flat());
    for blend in [Blend::Replace, Blend::Over, Blend::Replace] {
        let desc = RasterDesc {
            vertex: &vertex,
            fragment: &fragment,
            target: vk::Format::R8G8B8A8_UNORM.into(),
            blend,
            depth: DepthUse::Ignored,
        };
        let _raster = RasterPipeline::new(gpu, &desc).unwrap();
    }
    assert_eq!(gpu.pipelines_made(), 4);
}

#[test]
fn owners_may_outlive_the_device_s_maker() {
    let mut headless = headless();
    let gpu = Arc::clone(headless.gpu());
    let buffer = small(&gpu);
    // SAFETY: the buffer lives until the run has ended.
    headless
        .run(|cmd| unsafe {
            gpu.device()
                .cmd_fill_buffer(cmd, buffer.raw(), 0, vk::WHOLE_SIZE, 1);
            Ok(())
        })
        .unwrap();
    drop(headless);
    assert_eq!(count(&gpu, "buffer"), 1);
    drop(gpu);
    drop(buffer);
}
