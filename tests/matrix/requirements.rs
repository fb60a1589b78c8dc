//! The list of what a device must have is true: with no more than it pictures are drawn, and without each of it a
//! device is refused before anything is made.

use crate::hooked::{Host, Lacking, Stage, Tape, hooked};
use std::fmt::Write;
use stratavox::gpu::*;
use stratavox::shaders::{SHADERS, Shader};

/// The features of one need and those of the other.
fn features(needs: &[Need]) -> Features {
    let has = |wanted: Feature| {
        let mut listed = REQUIREMENTS.iter().filter(|one| needs.contains(&one.need));
        listed.any(|one| one.item == Item::Feature(wanted))
    };
    Features {
        dynamic_rendering: has(Feature::DynamicRendering),
        synchronization2: has(Feature::Synchronization2),
        timeline_semaphore: has(Feature::TimelineSemaphore),
        robust_buffer_access: has(Feature::RobustBufferAccess),
        robust_image_access: has(Feature::RobustImageAccess),
        portability_subset: false,
    }
}

#[test]
fn a_device_with_what_is_required_and_nothing_else_draws_without_a_word_of_the_layer() {
    let host = Host::listening();
    if !host.is_listening() {
        println!("skipped: no validation layer to say what is missing");
    }
    let device = host.device(features(&[Need::Required]));
    // SAFETY: the handles are right, and everything made on the device is dropped before it.
    let gpu = unsafe {
        Gpu::from_host(device.handles(crate::hooked::entry().static_fn().get_instance_proc_addr))
    };
    let texels = Stage::new().draw(&device, &gpu.unwrap()).unwrap();
    let pixels: &[[f32; 4]] = bytemuck::cast_slice(&texels);
    let drawn = pixels.iter().filter(|pixel| pixel[3] > 0.1).count();
    assert!(drawn > 300, "only {drawn} pixels show anything");
    drop(device);
    assert_eq!(host.take_messages(), Vec::<String>::new());
}

/// What is taken away from a device to lack one requirement, once for each part of it.
fn without(item: Item, whole: HostDevice<'static>) -> Vec<(HostDevice<'static>, Lacking)> {
    let mut host = whole;
    let nothing = Lacking::default();
    match item {
        Item::ApiVersion(_) => host.api_version = ash::vk::API_VERSION_1_2,
        Item::Queue(_) => host.queue_family = 1000,
        Item::Timestamps => {
            let timestamps = true;
            return vec![(
                host,
                Lacking {
                    timestamps,
                    ..nothing
                },
            )];
        }
        Item::Feature(feature) => {
            let of = &mut host.features;
            *match feature {
                Feature::DynamicRendering => &mut of.dynamic_rendering,
                Feature::Synchronization2 => &mut of.synchronization2,
                Feature::TimelineSemaphore => &mut of.timeline_semaphore,
                Feature::RobustBufferAccess => &mut of.robust_buffer_access,
                Feature::RobustImageAccess => &mut of.robust_image_access,
            } = false;
        }
        Item::Limit(limit, least) => {
            let less = u32::try_from(least - 1).unwrap();
            let of = &mut host.caps;
            *match limit {
                Limit::MaxUniformBufferRange => &mut of.max_uniform_buffer_range,
                Limit::MaxPerStageDescriptorStorageBuffers => &mut of.max_storage_buffers_per_stage,
                Limit::MaxComputeWorkGroupInvocations => &mut of.max_workgroup_invocations,
                Limit::MaxComputeWorkGroupSizeX => &mut of.max_workgroup_size[0],
                Limit::MaxComputeWorkGroupSizeY => &mut of.max_workgroup_size[1],
                Limit::MaxComputeWorkGroupSizeZ => &mut of.max_workgroup_size[2],
                Limit::MaxImageDimension3D => &mut of.max_image_dimension_3d,
                Limit::MaxImageArrayLayers => &mut of.max_image_array_layers,
            } = less;
        }
        Item::Format(format, features) => {
            let bits = (0..32).map(|k| ash::vk::FormatFeatureFlags::from_raw(1 << k));
            let of_it = bits.filter(|&bit| features.contains(bit));
            return of_it
                .map(|bit| {
                    (
                        host,
                        Lacking {
                            format: (format, bit),
                            ..nothing
                        },
                    )
                })
                .collect();
        }
        Item::InstanceExtension(_) => host.debug_utils = false,
        Item::PortabilitySubset => {
            let parts = true;
            return vec![(host, Lacking { parts, ..nothing })];
        }
        Item::DeviceExtension(_) => {
            let nothing = Lacking {
                device_extensions: true,
                ..nothing
            };
            return vec![(host, nothing)];
        }
        other => panic!("nobody takes {other} away"),
    }
    vec![(host, nothing)]
}

#[test]
fn what_is_required_and_missing_is_refused_by_name_before_anything_is_made() {
    let tape = Tape::begin();
    let host = Host::new();
    let device = host.device(features(&[Need::Required, Need::Recommended]));
    let whole = device.handles(hooked);
    let mut taken = 0;
    for requirement in REQUIREMENTS {
        let item = requirement.item;
        for (handles, lacking) in without(item, whole) {
            tape.rewind(None);
            tape.hide(lacking);
            // SAFETY: the handles are right; they say less than there is.
            let (report, made) =
                unsafe { (check_device(&handles.physical()), Gpu::from_host(handles)) };
            // One that is asked for twice, more strictly where it is recommended, is missing twice.
            let missing: Vec<_> = report.missing(requirement.need).collect();
            let named = |finding: &&Finding| finding.requirement.item == item;
            let found = missing.iter().find(|finding| named(finding));
            let found = found.unwrap_or_else(|| panic!("{item} is not missed in {missing:?}"));
            assert!(!found.is_met && !found.found.is_empty(), "{found:?}");
            match requirement.need {
                Need::Required => {
                    let refused = made.err().unwrap_or_else(|| panic!("taken without {item}"));
                    let name = match item {
                        Item::ApiVersion(_) => "Vulkan 1.2.0, wanted 1.3.0".into(),
                        item => format!("{item} (wanted {}, found {}", item.wanted(), found.found),
                    };
                    assert!(refused.to_string().contains(&name), "{refused}: {name}");
                    let calls = tape.calls().into_keys();
                    let making = |name: &&str| name.contains("Create") || name.contains("Allocate");
                    assert_eq!(calls.filter(making).collect::<Vec<_>>(), Vec::<&str>::new());
                }
                Need::Recommended => {
                    assert!(report.is_usable(), "{item}: {report:?}");
                    drop(made.unwrap_or_else(|refused| panic!("{item}: {refused}")));
                }
            }
            taken += 1;
        }
    }
    tape.hide(Lacking::default());
    assert!(
        taken > REQUIREMENTS.len(),
        "only {taken} parts were taken away"
    );
    assert_eq!(tape.books(), Vec::<&str>::new());
}

#[test]
fn a_physical_device_can_be_asked_before_there_is_a_device() {
    let host = Host::new();
    let asked = HostPhysicalDevice {
        get_instance_proc_addr: crate::hooked::entry().static_fn().get_instance_proc_addr,
        instance: host.instance.handle(),
        api_version: API_VERSION,
        physical_device: host.physical_device,
        queue_family: None,
        enabled: None,
        caps: Caps::UNLIMITED,
    };
    // SAFETY: the handles belong together.
    let report = unsafe { check_device(&asked) };
    assert!(report.is_usable(), "{report:?}");
    assert_eq!(report.findings.len(), REQUIREMENTS.len());
    let dynamic_rendering = report
        .findings
        .iter()
        .find(|finding| finding.requirement.item == Item::Feature(Feature::DynamicRendering));
    assert_eq!(dynamic_rendering.unwrap().found, "supported");
    // An instance that is too old is not asked for what came later.
    let old = HostPhysicalDevice {
        api_version: ash::vk::API_VERSION_1_0,
        ..asked
    };
    // SAFETY: as above; less is asked than the instance knows.
    let report = unsafe { check_device(&old) };
    assert!(!report.is_usable());
    assert_eq!(report.findings.len(), 1, "{report:?}");
    assert_eq!(report.findings[0].found, "1.0.0");
}

/// Numbers of SPIR-V (its specification, 3.2 and after).
mod spirv {
    pub const OP_CAPABILITY: u32 = 17;
    pub const OP_TYPE_IMAGE: u32 = 25;
    pub const OP_VARIABLE: u32 = 59;
    pub const OP_DECORATE: u32 = 71;
    pub const NON_WRITABLE: u32 = 24;
    pub const STORAGE_BUFFER: u32 = 12;
    pub const UNIFORM_CONSTANT: u32 = 0;
    pub const SHADER: u32 = 1;
    pub const IMAGE_QUERY: u32 = 50;
    /// Rgba32f, Rgba16f, R32f, Rgba8, Rgba8Snorm, Rgba32i, Rgba16i, Rgba8i, R32i, Rgba32ui, Rgba16ui, Rgba8ui, R32ui:
    /// those whose storage images need no feature.
    pub const FORMATS: [u32; 13] = [1, 2, 3, 4, 5, 21, 22, 23, 24, 30, 31, 32, 33];
}

/// Instructions: operation and operands.
fn instructions(shader: &Shader) -> impl Iterator<Item = (u32, &[u32])> {
    let mut at = 5;
    std::iter::from_fn(move || {
        let &first = shader.spirv().get(at)?;
        let words = (first >> 16) as usize;
        let operands = &shader.spirv()[at + 1..at + words];
        at += words;
        Some((first & 0xffff, operands))
    })
}

#[test]
fn no_shader_asks_for_more_than_the_list() {
    use stratavox::shaders::{BindingKind, BindingSlot, Stage};
    let caps = Caps::VULKAN_MINIMUM;
    let mut most_buffers = 0;
    for shader in SHADERS.iter() {
        let name = shader.name;
        let mut non_writable = Vec::new();
        let (mut storage_buffers, mut images) = (Vec::new(), Vec::new());
        for (op, operands) in instructions(shader) {
            match op {
                spirv::OP_CAPABILITY => assert!(
                    [spirv::SHADER, spirv::IMAGE_QUERY].contains(&operands[0]),
                    "{name}: capability {}",
                    operands[0]
                ),
                // Sampled 2: a storage image.
                spirv::OP_TYPE_IMAGE if operands[6] == 2 => {
                    assert!(
                        spirv::FORMATS.contains(&operands[7]),
                        "{name}: format {}",
                        operands[7]
                    );
                }
                spirv::OP_DECORATE if operands[1] == spirv::NON_WRITABLE => {
                    non_writable.push(operands[0]);
                }
                spirv::OP_VARIABLE if operands[2] == spirv::STORAGE_BUFFER => {
                    storage_buffers.push(operands[1]);
                }
                spirv::OP_VARIABLE if operands[2] == spirv::UNIFORM_CONSTANT => {
                    images.push(operands[1]);
                }
                _ => {}
            }
        }
        if !matches!(shader.stage, Stage::Compute { .. }) {
            for buffer in storage_buffers {
                assert!(
                    non_writable.contains(&buffer),
                    "{name}: a buffer that is written needs fragmentStoresAndAtomics"
                );
            }
            // Textures and samplers are never written, and say nothing of it.
            images.retain(|image| non_writable.contains(image));
            let is_storage = |slot: &&BindingSlot| slot.kind == BindingKind::StorageImage;
            let read = shader.bindings.iter().filter(is_storage).count();
            assert_eq!(
                images.len(),
                read,
                "{name}: an image that is written needs fragmentStoresAndAtomics"
            );
        }
        let count = |wanted: fn(&BindingKind) -> bool| {
            shader
                .bindings
                .iter()
                .filter(|slot| wanted(&slot.kind))
                .count()
        };
        most_buffers = most_buffers.max(count(|kind| matches!(kind, BindingKind::Storage)));
        // The least of each that any device allows ("Required Limits" of Vulkan), which are not in `Caps`.
        assert!(
            count(|kind| matches!(kind, BindingKind::StorageImage)) <= 4,
            "{name}"
        );
        assert!(
            count(|kind| matches!(kind, BindingKind::Texture)) <= 16,
            "{name}"
        );
        assert!(
            count(|kind| matches!(kind, BindingKind::Sampler)) <= 16,
            "{name}"
        );
        assert!(
            count(|kind| matches!(kind, BindingKind::Uniform(_))) <= 8,
            "{name}"
        );
        assert!(shader.bindings.len() <= 128, "{name}");
        for slot in shader.bindings {
            if let BindingKind::Uniform(bytes) = slot.kind {
                assert!(bytes <= caps.max_uniform_buffer_range, "{name}");
                assert!(
                    least(Limit::MaxUniformBufferRange) >= bytes.into(),
                    "{name}"
                );
            }
        }
        if let Stage::Compute { workgroup } = shader.stage {
            let invocations = workgroup.iter().product::<u32>();
            // What only asks a device and draws nothing may want what every Vulkan device has.
            let (most, sizes) = match name.starts_with("probe/") {
                true => (
                    caps.max_workgroup_invocations.into(),
                    caps.max_workgroup_size.map(u64::from),
                ),
                false => (
                    least(Limit::MaxComputeWorkGroupInvocations),
                    [
                        least(Limit::MaxComputeWorkGroupSizeX),
                        least(Limit::MaxComputeWorkGroupSizeY),
                        least(Limit::MaxComputeWorkGroupSizeZ),
                    ],
                ),
            };
            assert!(most >= invocations.into(), "{name}");
            for (size, most) in workgroup.into_iter().zip(sizes) {
                assert!(most >= size.into(), "{name}");
            }
        }
    }
    let asked = REQUIREMENTS.iter().filter_map(|one| match one.item {
        Item::Limit(Limit::MaxPerStageDescriptorStorageBuffers, least) => Some(least),
        _ => None,
    });
    assert_eq!(
        asked.max(),
        Some(most_buffers as u64),
        "storage buffers of a stage"
    );
}

/// What is required of a limit.
fn least(limit: Limit) -> u64 {
    let mut required = REQUIREMENTS.iter().filter_map(|one| match one.item {
        Item::Limit(found, least) if found == limit && one.need == Need::Required => Some(least),
        _ => None,
    });
    required
        .next()
        .unwrap_or_else(|| panic!("{limit:?} is not in the list"))
}

#[test]
fn what_is_required_is_no_more_than_every_device_of_vulkan_1_3_has() {
    for one in REQUIREMENTS.iter().filter(|one| one.need == Need::Required) {
        if let Item::Limit(limit, least) = one.item {
            assert!(limit.of(&Caps::VULKAN_MINIMUM) >= least, "{limit:?}");
        }
    }
}

/// The table of the page, as the list says it.
fn table() -> String {
    let mut text = String::new();
    for (need, title) in [
        (Need::Required, "Required"),
        (Need::Recommended, "Recommended"),
    ] {
        writeln!(text, "| {title} | Wanted | For |\n|---|---|---|").unwrap();
        for one in REQUIREMENTS.iter().filter(|one| one.need == need) {
            let of = match one.item {
                Item::Feature(feature) => format!(" of `{}`", feature.structure()),
                _ => String::new(),
            };
            // A bar would end the cell.
            let wanted = one.item.wanted().replace(" | ", ", ");
            writeln!(text, "| `{}`{of} | {wanted} | {} |", one.item, one.unlocks).unwrap();
        }
        writeln!(text).unwrap();
    }
    text
}

#[test]
fn the_page_says_what_the_list_says() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/requirements.md");
    let page = std::fs::read_to_string(path).unwrap();
    let table = table();
    assert!(
        page.contains(&table),
        "docs/requirements.md is old; its tables are now\n\n{table}"
    );
}
