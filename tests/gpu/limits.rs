//! What a device cannot hold is refused before the call, naming the limit, what was wanted and what is allowed.

use crate::gpu_shared::*;
use ash::vk;
use stratavox::gpu::*;
use stratavox::shaders::{BindingKind, BindingSlot, Shader, Stage};

const SAMPLED: vk::ImageUsageFlags = vk::ImageUsageFlags::SAMPLED;

fn image(kind: ImageKind, extent: [u32; 3], format: vk::Format) -> ImageDesc<'static> {
    ImageDesc {
        kind,
        extent,
        format,
        usage: SAMPLED,
        name: "large",
    }
}

/// The limit that refuses; nothing may have been made.
#[track_caller]
fn refused_by<T>(gpu: &Gpu, made: Result<T, Error>) -> (&'static str, u64, u64) {
    let error = made.map(|_| ()).expect_err("more than the limits allow");
    let alive = gpu.live_objects();
    assert!(
        !alive.contains_key("image") && !alive.contains_key("buffer"),
        "{error}: made {alive:?}"
    );
    match error {
        Error::Limit {
            limit,
            wanted,
            allowed,
            ..
        } => (limit, wanted, allowed),
        other => panic!("{other}"),
    }
}

#[test]
fn an_image_larger_than_any_allocation_is_refused_whatever_the_driver_would_say() {
    let headless = clamped(Caps::VULKAN_MINIMUM);
    let gpu = headless.gpu();
    let cube = |side, format| Image::new(gpu, &image(ImageKind::D3, [side; 3], format));
    let r16 = vk::Format::R16_UNORM;
    assert_eq!(
        refused_by(gpu, cube(257, r16)),
        ("maxImageDimension3D", 257, 256)
    );
    assert_eq!(
        refused_by(gpu, cube(2048, r16)),
        ("maxImageDimension3D", 2048, 256)
    );

    let wide = Caps {
        max_image_dimension_3d: u32::MAX,
        max_resource_bytes: u64::MAX,
        ..Caps::VULKAN_MINIMUM
    };
    let headless = clamped(Caps {
        max_allocation_bytes: 1 << 20,
        ..wide
    });
    let gpu = headless.gpu();
    let cube = |side| Image::new(gpu, &image(ImageKind::D3, [side; 3], r16));
    assert_eq!(
        refused_by(gpu, cube(128)),
        ("maxMemoryAllocationSize", 4 << 20, 1 << 20)
    );
    cube(64).unwrap();

    let headless = clamped(Caps {
        max_heap_bytes: 1 << 20,
        ..wide
    });
    let gpu = headless.gpu();
    let made = Image::new(gpu, &image(ImageKind::D3, [128; 3], r16));
    assert_eq!(
        refused_by(gpu, made),
        ("the largest memory heap", 4 << 20, 1 << 20)
    );

    let headless = clamped(Caps {
        max_resource_bytes: 1 << 20,
        ..wide
    });
    let gpu = headless.gpu();
    let made = Image::new(gpu, &image(ImageKind::D3, [128; 3], r16));
    assert_eq!(refused_by(gpu, made), ("maxResourceSize", 4 << 20, 1 << 20));
}

#[test]
fn the_device_s_own_limits_hold_where_nothing_is_clamped() {
    let headless = headless();
    let gpu = headless.gpu();
    let limits = gpu.limits();
    let side = limits.max_image_dimension_3d;
    let made = Image::new(
        gpu,
        &image(ImageKind::D3, [1, side + 1, 1], vk::Format::R8_UNORM),
    );
    assert_eq!(
        refused_by(gpu, made),
        ("maxImageDimension3D", u64::from(side) + 1, side.into())
    );
    // 16 GiB and more: lavapipe would take it.
    let made = Image::new(
        gpu,
        &image(ImageKind::D3, [side.min(2048); 3], vk::Format::R16_UNORM),
    );
    if limits.max_allocation_bytes < 2 * u64::from(side.min(2048)).pow(3) {
        let (limit, ..) = refused_by(gpu, made);
        assert!(
            ["maxResourceSize", "maxMemoryAllocationSize"].contains(&limit),
            "{limit}"
        );
    } else {
        println!(
            "skipped: this device may hold {} bytes in one allocation",
            limits.max_allocation_bytes
        );
    }
    let layers = limits.max_image_array_layers + 1;
    let made = Image::new(
        gpu,
        &image(ImageKind::D2Array, [1, 1, layers], vk::Format::R8_UNORM),
    );
    assert_eq!(refused_by(gpu, made).0, "maxImageArrayLayers");
    let side = limits.max_image_dimension_2d + 1;
    let made = Image::new(
        gpu,
        &image(ImageKind::D2, [side, 1, 1], vk::Format::R8_UNORM),
    );
    assert_eq!(refused_by(gpu, made).0, "maxImageDimension2D");
}

#[test]
fn extents_that_no_device_takes_are_refused_without_overflow() {
    let headless = headless();
    let gpu = headless.gpu();
    let largest = image(
        ImageKind::D3,
        [u32::MAX; 3],
        vk::Format::R32G32B32A32_SFLOAT,
    );
    assert_eq!(
        refused_by(gpu, gpu.check_image(&largest)).1,
        u64::from(u32::MAX)
    );
    for (kind, extent) in [
        (ImageKind::D3, [0, 1, 1]),
        (ImageKind::D2Array, [1, 1, 0]),
        (ImageKind::D2, [4, 4, 2]),
    ] {
        let refused = gpu.check_image(&image(kind, extent, vk::Format::R8_UNORM));
        assert!(
            matches!(refused, Err(Error::Argument { .. })),
            "{kind:?} {extent:?}: {refused:?}"
        );
    }
    let usage = vk::ImageUsageFlags::TRANSFER_DST;
    let refused = gpu.check_image(&ImageDesc {
        usage,
        ..image(ImageKind::D3, [4; 3], vk::Format::R8_UNORM)
    });
    assert!(refused.is_err(), "an image that cannot have a view");
}

#[test]
fn formats_are_asked_before_they_are_used() {
    let headless = headless();
    let gpu = headless.gpu();
    let integer = gpu.format_features(vk::Format::R16_UINT);
    assert!(
        integer.sampled && !integer.linear && !integer.blend,
        "{integer:?}"
    );
    // Vulkan demands these of every device.
    let half = gpu.format_features(vk::Format::R16G16B16A16_SFLOAT);
    let all = FormatFeatures {
        sampled: true,
        linear: true,
        storage: true,
        color: true,
        blend: true,
        depth: false,
    };
    assert_eq!(half, all);
    // No device writes to shared exponents, and we have no size for them.
    let shared = image(ImageKind::D2, [4, 4, 1], vk::Format::E5B9G9R9_UFLOAT_PACK32);
    assert!(matches!(
        gpu.check_image(&shared),
        Err(Error::Format { .. })
    ));
    let (vertex, fragment) = (cover(), flat());
    let desc = RasterDesc {
        vertex: &vertex,
        fragment: &fragment,
        target: vk::Format::R16_UINT.into(),
        blend: Blend::Over,
        depth: DepthUse::Ignored,
    };
    let refused = RasterPipeline::new(gpu, &desc)
        .map(|_| ())
        .expect_err("integers do not blend")
        .to_string();
    assert!(
        refused.contains("test.flat") && refused.contains("blending for R16_UINT"),
        "{refused}"
    );
}

#[test]
fn buffers_beyond_the_limits_of_their_usage_are_refused() {
    let headless = clamped(Caps::VULKAN_MINIMUM);
    let gpu = headless.gpu();
    let make = |bytes, usage| Buffer::new(gpu, bytes, usage, Memory::Device, "large");
    let (storage, transfer) = (
        vk::BufferUsageFlags::STORAGE_BUFFER,
        vk::BufferUsageFlags::TRANSFER_DST,
    );
    let bytes = (1 << 27) + 1;
    assert_eq!(
        refused_by(gpu, make(bytes, storage)),
        ("maxStorageBufferRange", bytes, 1 << 27)
    );
    gpu.check_buffer(bytes, transfer, "large").unwrap();
    let bytes = (1 << 30) + 1;
    assert_eq!(
        refused_by(gpu, make(bytes, transfer)),
        ("maxBufferSize", bytes, 1 << 30)
    );
    assert!(matches!(make(0, transfer), Err(Error::Argument { .. })));
    let ring = ParameterRing::new(gpu, 16_385, 1, "params");
    assert_eq!(
        refused_by(gpu, ring),
        ("maxUniformBufferRange", 16_385, 16_384)
    );
}

#[test]
fn workgroups_and_dispatches_beyond_the_limits_are_refused() {
    let headless = clamped(Caps {
        max_workgroup_invocations: 128,
        ..Caps::UNLIMITED
    });
    let gpu = headless.gpu();
    let mut shader = ramp();
    shader.stage = Stage::Compute {
        workgroup: [16, 16, 1],
    };
    let refused = refused_by(gpu, ComputePipeline::new(gpu, &shader));
    assert_eq!(refused, ("maxComputeWorkGroupInvocations", 256, 128));
    shader.stage = Stage::Compute {
        workgroup: [1, 1, u32::MAX],
    };
    assert_eq!(
        refused_by(gpu, ComputePipeline::new(gpu, &shader)).0,
        "maxComputeWorkGroupSize.z"
    );

    let headless = clamped(Caps {
        max_workgroup_count: [100, 65_535, 65_535],
        ..Caps::UNLIMITED
    });
    let pipeline = ComputePipeline::new(headless.gpu(), &ramp()).unwrap();
    assert_eq!(pipeline.groups([800, 3, 1]).unwrap(), [100, 3, 1]);
    let refused = refused_by(headless.gpu(), pipeline.groups([801, 1, 1]));
    assert_eq!(refused, ("maxComputeWorkGroupCount.x", 101, 100));
}

#[test]
fn color_targets_beyond_the_framebuffer_are_refused() {
    let headless = clamped(Caps {
        max_framebuffer: [64, 32],
        ..Caps::UNLIMITED
    });
    let gpu = headless.gpu();
    let target = |extent| ImageDesc {
        usage: vk::ImageUsageFlags::COLOR_ATTACHMENT,
        ..image(ImageKind::D2, extent, vk::Format::R8G8B8A8_UNORM)
    };
    gpu.check_image(&target([64, 32, 1])).unwrap();
    assert_eq!(
        refused_by(gpu, gpu.check_image(&target([64, 33, 1]))),
        ("maxFramebufferHeight", 33, 32)
    );
    gpu.check_image(&image(
        ImageKind::D2,
        [64, 33, 1],
        vk::Format::R8G8B8A8_UNORM,
    ))
    .unwrap();
}

#[test]
fn a_clamp_can_only_make_limits_stricter() {
    let (own, least) = (*headless().gpu().limits(), Caps::VULKAN_MINIMUM);
    assert_eq!(own.clamped_to(&Caps::UNLIMITED), own);
    let clamped = own.clamped_to(&least);
    assert_eq!(clamped.clamped_to(&own), clamped);
    assert!(
        clamped.max_image_dimension_3d <= 256 && clamped.min_uniform_offset_alignment >= 256,
        "{clamped:?}"
    );
    assert_eq!(clamped.timestamp_period_ns, own.timestamp_period_ns);
}

#[test]
fn a_shader_with_more_storage_buffers_than_a_stage_may_have_is_refused() {
    let headless = clamped(Caps::VULKAN_MINIMUM);
    let gpu = headless.gpu();
    // None of the library's has so many.
    const FIVE: &[BindingSlot] = &[
        slot(0, "a", BindingKind::Storage),
        slot(1, "b", BindingKind::Storage),
        slot(2, "c", BindingKind::Storage),
        slot(3, "d", BindingKind::Storage),
        slot(4, "e", BindingKind::Storage),
    ];
    let of_five = Shader {
        bindings: FIVE,
        ..ramp()
    };
    assert_eq!(
        refused_by(gpu, ComputePipeline::new(gpu, &of_five)),
        ("maxPerStageDescriptorStorageBuffers", 5, 4)
    );
}
