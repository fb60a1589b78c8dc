//! A budget of memory is obeyed: what does not fit is refused by name, and what fits draws the same picture.

use crate::embed_shared::{Host, HostImage, Stage};
use ash::vk;
use std::sync::Arc;
use stratavox::embed::{self, FrameInfo, Renderer, RendererDesc, Volume};
use stratavox::gpu::{self, Load};
use stratavox::technique::{Settings, Technique};
use stratavox::transfer::{Classified, Window};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

fn stage(technique: Technique) -> Stage {
    Stage::new(Settings {
        technique,
        ..Settings::default()
    })
}

/// All that a picture takes, or the first refusal.
fn picture(host: &Host, stage: &Stage) -> Result<Vec<[f64; 4]>, embed::Error> {
    let gpu = host.gpu();
    let mut volume = Volume::new(gpu, &stage.volume, &stage.settings)?;
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(gpu, cmd).unwrap() });
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: 1,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
    };
    let (volume, function) = (Arc::new(volume), Some(&stage.transfer));
    let mut renderer = Renderer::new(gpu, &volume, function, class, stage.extent, &[])?;
    let image = HostImage::new(host, FORMAT, stage.extent);
    let target = image.target();
    let shot = FrameInfo {
        frame: 0,
        camera: &stage.camera,
        depth: None,
    };
    // SAFETY: recorded in order; `run` waits.
    host.run(|cmd| unsafe {
        let load = Load::Clear([0.0; 4]);
        renderer.record_into(cmd, &shot, &target, load).unwrap();
        image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    });
    Ok(image.numbers())
}

#[test]
fn twenty_budgets_give_the_picture_or_a_refusal_and_are_never_passed() {
    for technique in [Technique::Raycast, Technique::Slices2d] {
        let stage = stage(technique);
        // What it takes where each object has memory of its own.
        let host = Host::new();
        host.gpu().set_memory_budget(Some(60 << 20));
        let wanted = picture(&host, &stage).unwrap();
        let most = host.gpu().memory().peak_bytes;
        let mut refusals = 0;
        for part in 1..=20 {
            let budget = most * part / 20;
            let host = Host::new();
            host.gpu().set_memory_budget(Some(budget));
            match picture(&host, &stage) {
                Ok(found) => assert!(found == wanted, "{technique:?} in {budget} bytes"),
                Err(embed::Error::Gpu(gpu::Error::Limit {
                    limit,
                    wanted,
                    allowed,
                    ..
                })) => {
                    assert_eq!(limit, "the memory budget of the host");
                    assert!(allowed == budget && wanted > budget, "{wanted} in {budget}");
                    refusals += 1;
                }
                Err(other) => panic!("{technique:?} in {budget} bytes: {other}"),
            }
            let memory = host.gpu().memory();
            assert_eq!(memory.budget_bytes, Some(budget));
            assert!(memory.peak_bytes <= budget, "{memory:?}");
            assert!(memory.used_bytes <= memory.reserved_bytes, "{memory:?}");
        }
        assert!((1..20).contains(&refusals), "{refusals} refusals");
    }
}

#[test]
fn a_volume_beyond_the_budget_is_refused_before_anything_is_made() {
    let host = Host::new();
    let (gpu, stage) = (host.gpu(), stage(Technique::Raycast));
    let (dims, stored) = (stage.volume.dims, stage.volume.voxels.voxel_type());
    let plan = Volume::plan(gpu, dims, stored, false, &stage.settings).unwrap();
    let needed = plan.device_bytes + plan.staging_bytes;
    gpu.set_memory_budget(Some(needed - 1));
    let refused = Volume::new(gpu, &stage.volume, &stage.settings).map(drop);
    let Err(embed::Error::Gpu(gpu::Error::Limit {
        doing,
        wanted,
        allowed,
        ..
    })) = refused
    else {
        panic!("{refused:?}");
    };
    assert_eq!((wanted, allowed), (needed, needed - 1));
    assert_eq!(doing, "make a volume of [19, 22, 16] voxels");
    assert!(gpu.live_objects().is_empty() && gpu.memory().allocations == 0);
    // Without the budget it is there, and counted.
    gpu.set_memory_budget(None);
    let made = Volume::new(gpu, &stage.volume, &stage.settings).unwrap();
    let memory = gpu.memory();
    assert!(
        memory.allocations > 0 && memory.used_bytes >= needed,
        "{memory:?}"
    );
    assert!(
        memory.used_bytes <= memory.reserved_bytes && memory.reserved_bytes <= memory.peak_bytes
    );
    // No driver here has the extension, or it tells of every heap.
    assert!(memory.heaps.iter().all(|heap| heap.budget_bytes > 0));
    drop(made);
}

#[test]
fn what_no_longer_fits_leaves_a_renderer_as_it_was() {
    let host = Host::new();
    let (gpu, stage) = (host.gpu(), stage(Technique::Raycast));
    let wanted = picture(&host, &stage).unwrap();
    let volume = {
        let mut volume = Volume::new(gpu, &stage.volume, &stage.settings).unwrap();
        // SAFETY: outside rendering; `run` waits.
        host.run(|cmd| unsafe { volume.record_upload(gpu, cmd).unwrap() });
        Arc::new(volume)
    };
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: 1,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
    };
    let function = Some(&stage.transfer);
    let mut renderer = Renderer::new(gpu, &volume, function, class, stage.extent, &[]).unwrap();
    gpu.set_memory_budget(Some(gpu.memory().reserved_bytes + 4096));
    let refused = renderer.resize([1000, 1000], &[]);
    assert!(
        matches!(refused, Err(embed::Error::Gpu(gpu::Error::Limit { .. }))),
        "{refused:?}"
    );
    assert_eq!(renderer.extent(), stage.extent);
    let image = HostImage::new(&host, FORMAT, stage.extent);
    let target = image.target();
    let shot = FrameInfo {
        frame: 0,
        camera: &stage.camera,
        depth: None,
    };
    // SAFETY: recorded in order; `run` waits.
    host.run(|cmd| unsafe {
        let load = Load::Clear([0.0; 4]);
        renderer.record_into(cmd, &shot, &target, load).unwrap();
        image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    });
    assert!(image.numbers() == wanted);
}

/// A driver that has `VK_EXT_memory_budget`, made of one that may not have it.
mod with_budget {
    use ash::vk;
    use std::ffi::{CStr, c_char};
    use std::mem::transmute;
    use std::sync::OnceLock;

    pub const BUDGET_BYTES: u64 = 1000 << 20;
    pub const USED_BYTES: u64 = 3 << 20;

    type Function = unsafe extern "system" fn();
    static LOADER: OnceLock<ash::Entry> = OnceLock::new();
    static PROPERTIES: OnceLock<vk::PFN_vkGetPhysicalDeviceMemoryProperties> = OnceLock::new();

    /// # Safety
    /// As `vkGetInstanceProcAddr`.
    pub unsafe extern "system" fn proc_addr(
        instance: vk::Instance,
        name: *const c_char,
    ) -> vk::PFN_vkVoidFunction {
        // SAFETY: the loader is trusted; arguments are handed on; functions are what their names say.
        unsafe {
            let loader = LOADER.get_or_init(|| ash::Entry::load().expect("a Vulkan loader"));
            let real = loader.static_fn().get_instance_proc_addr;
            let plain = real(instance, c"vkGetPhysicalDeviceMemoryProperties".as_ptr());
            if let Some(plain) = plain {
                PROPERTIES.get_or_init(|| {
                    transmute::<Function, vk::PFN_vkGetPhysicalDeviceMemoryProperties>(plain)
                });
            }
            if CStr::from_ptr(name) == c"vkEnumerateDeviceExtensionProperties" {
                type Listing = vk::PFN_vkEnumerateDeviceExtensionProperties;
                return Some(transmute::<Listing, Function>(list));
            }
            if CStr::from_ptr(name) == c"vkGetPhysicalDeviceMemoryProperties2" {
                type Asking = vk::PFN_vkGetPhysicalDeviceMemoryProperties2;
                return Some(transmute::<Asking, Function>(ask));
            }
            real(instance, name)
        }
    }

    unsafe extern "system" fn list(
        _: vk::PhysicalDevice,
        _: *const c_char,
        count: *mut u32,
        out: *mut vk::ExtensionProperties,
    ) -> vk::Result {
        let name = ash::ext::memory_budget::NAME;
        let named = vk::ExtensionProperties::default().extension_name(name);
        // SAFETY: the caller has room for one where it asks for it.
        unsafe {
            *count = 1;
            if !out.is_null() {
                out.write(named.expect("a short name"));
            }
        }
        vk::Result::SUCCESS
    }

    unsafe extern "system" fn ask(
        device: vk::PhysicalDevice,
        out: *mut vk::PhysicalDeviceMemoryProperties2<'_>,
    ) {
        // SAFETY: the caller's structure and its chain, of which one is known here.
        unsafe {
            let plain = PROPERTIES.get().expect("set before this is given away");
            plain(device, &raw mut (*out).memory_properties);
            let budget = (*out)
                .p_next
                .cast::<vk::PhysicalDeviceMemoryBudgetPropertiesEXT<'_>>();
            assert_eq!(
                (*budget).s_type,
                vk::StructureType::PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT
            );
            (*budget).heap_budget[0] = BUDGET_BYTES;
            (*budget).heap_usage[0] = USED_BYTES;
        }
    }
}

#[test]
fn what_the_driver_says_of_its_heaps_is_told() {
    let host = Host::new();
    let theirs = host.gpu();
    // SAFETY: the host's handles, once more; what is enabled is what the host has enabled.
    let gpu = unsafe {
        gpu::Gpu::from_host(gpu::HostDevice {
            get_instance_proc_addr: with_budget::proc_addr,
            instance: theirs.instance().handle(),
            physical_device: theirs.physical_device(),
            device: theirs.device().handle(),
            queue_family: theirs.queue_family(),
            api_version: gpu::API_VERSION,
            features: theirs.features(),
            debug_utils: false,
            caps: gpu::Caps::UNLIMITED,
            pipeline_cache: &[],
        })
    };
    let heaps = gpu.unwrap().memory().heaps;
    let first = heaps.first().expect("a heap");
    assert!(first.is_device_local && first.bytes > 0, "{first:?}");
    let told = (first.budget_bytes, first.used_bytes);
    assert_eq!(told, (with_budget::BUDGET_BYTES, with_budget::USED_BYTES));
}

#[test]
fn rays_that_keep_no_depth_take_one_image_a_frame() {
    const MIB: u64 = 1 << 20;
    // Of gentle slopes, with a table of 4096 entries: those of steep ones take up to 8 MiB.
    let function = Window::of_range([0.0, 100.0]).grey(Classified::Samples);
    let stage = stage(Technique::Raycast);
    for (extent, frames_in_flight, most) in
        [([3840, 2160], 3, 400 * MIB), ([1920, 1080], 2, 72 * MIB)]
    {
        let host = Host::new();
        let gpu = host.gpu();
        let mut volume = Volume::new(gpu, &stage.volume, &stage.settings).unwrap();
        // SAFETY: outside rendering; `run` waits.
        host.run(|cmd| unsafe { volume.record_upload(gpu, cmd).unwrap() });
        let volume = Arc::new(volume);
        let of = |picks| {
            let before = gpu.memory().used_bytes;
            let class = RendererDesc {
                settings: stage.settings.clone(),
                target: FORMAT.into(),
                frames_in_flight,
                host_depth: false,
                gives_depth: false,
                picks,
                slice_blending: Default::default(),
            };
            let made = Renderer::new(gpu, &volume, Some(&function), class, extent, &[]).unwrap();
            let bytes = gpu.memory().used_bytes - before;
            drop(made);
            bytes
        };
        let bytes = of(false);
        println!(
            "{extent:?} in {frames_in_flight} frames: {:.2} MiB",
            bytes as f64 / MIB as f64
        );
        assert!(bytes <= most, "{bytes} bytes");
        // Whoever picks pays for it.
        let an_image = 16 * u64::from(extent[0] * extent[1]);
        assert!(of(true) >= bytes + u64::from(frames_in_flight) * an_image - MIB);
    }
}
