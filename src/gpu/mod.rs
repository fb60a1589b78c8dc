//! Thin owners over Vulkan. Knows nothing of volumes.
//!
//! A [`Gpu`] is a device, the host's or that of [`Headless`], and what we add to it: limits that are
//! compared before each call, an allocator, and the queue of what waits to be destroyed. Each owner
//! ([`Buffer`], [`Image`], [`Sampler`], [`ComputePipeline`], [`RasterPipeline`], [`Bindings`],
//! [`ParameterRing`], [`Timer`]) holds an `Arc<Gpu>`, has `raw()`, and never waits when it is dropped:
//!
//! ```text
//! gpu.announce(n)      what is recorded from now on is done when the timeline reaches n
//! drop(owner)          its raw objects wait for n
//! gpu.retire(n)        the timeline has reached n: they are destroyed
//! ```
//!
//! A host without a timeline counts its submissions and calls `retire` after its own fence.
//! Recording (`unsafe fn`s that take a command buffer) creates, destroys and waits for nothing.

mod barrier;
mod bindings;
mod blocks;
mod buffer;
mod cache;
mod caps;
mod check;
mod choice;
mod commands;
mod copy;
mod devices;
mod error;
mod format;
mod headless;
mod host;
mod identity;
mod image;
mod instance;
mod layout;
mod loss;
mod memory;
mod own_device;
pub(crate) mod owned;
mod pace;
mod parameters;
pub(crate) mod pipeline;
mod pipelines;
mod portability;
mod raster;
#[cfg(feature = "conformance")]
pub(crate) mod recorder;
mod rendering;
mod requirements;
mod sampler;
mod sets;
mod shared_device;
mod tile;
mod timer;
mod validation;

pub use barrier::{Target, TargetState, Use, buffer_barrier, image_barrier};
pub(crate) use barrier::{barriers, image_barriers};
pub use bindings::{Bindings, Resource};
pub(crate) use blocks::Blocks;
pub use buffer::{Buffer, Memory};
pub use cache::PipelineCache;
pub use caps::Caps;
pub use choice::DeviceChoice;
pub use commands::{Commands, TimelinePoint};
pub(crate) use copy::buffer_to_buffer;
#[doc(hidden)]
pub use copy::{Region, buffer_to_image, clear_image, image_to_buffer};
pub use devices::{DeviceReport, Enabled, Finding, HostPhysicalDevice, check_device, list_devices};
pub use error::Error;
#[doc(hidden)]
pub use format::{FormatFeatures, texel_bytes};
pub use headless::{Headless, Options, Submissions};
pub use host::{Features, HostDevice};
pub use identity::{DeviceKind, Identity};
pub(crate) use image::DEPTH_FORMAT;
pub use image::{Image, ImageDesc, ImageKind};
#[doc(hidden)]
pub use layout::Layout;
pub use memory::{HeapUse, MemoryUse};
pub(crate) use pace::{Pace, TARGET_MS};
pub use parameters::ParameterRing;
pub use pipeline::ComputePipeline;
pub(crate) use portability::{PORTABILITY_SUBSET, portability_subset};
pub use raster::{Blend, DepthClass, DepthUse, HostPass, RasterDesc, RasterPipeline, TargetClass};
pub(crate) use rendering::begin_rendering_behind;
pub use rendering::{
    Load, begin_rendering, begin_rendering_of, end_rendering, set_area, set_area_of,
};
pub use requirements::{Feature, Item, Limit, Need, REQUIREMENTS, Requirement};
#[doc(hidden)]
pub use sampler::Sampler;
pub use shared_device::SharedDevice;
pub use tile::Tile;
pub(crate) use tile::{Groups, boxes, group_count, within};
#[doc(hidden)]
pub use timer::Timer;
pub use validation::{Message, VARIABLE as VALIDATION_VARIABLE, Validation, ValidationMode};

use ash::vk;
use gpu_allocator::{
    AllocationSizes, AllocatorDebugSettings,
    vulkan::{Allocator, AllocatorCreateDesc},
};
use identity::version_text;
use own_device::OwnDevice;
use owned::Store;
use std::{
    collections::BTreeMap,
    ffi::CString,
    fmt,
    sync::{
        Arc, Mutex, MutexGuard, OnceLock, PoisonError,
        atomic::{AtomicBool, AtomicU32, Ordering},
    },
};

/// The Vulkan version that everything here is written for.
pub const API_VERSION: u32 = vk::API_VERSION_1_3;

/// Memory is taken from the driver in blocks: small ones first, so that a small host pays little.
const SMALLEST_BLOCK_BYTES: u64 = 4 << 20;
const LARGEST_BLOCK_BYTES: u64 = 64 << 20;

/// A device and what we add to it. Lives until its last owner is gone, and then destroys what we made.
pub struct Gpu {
    instance: ash::Instance,
    device: ash::Device,
    physical_device: vk::PhysicalDevice,
    queue_family: u32,
    timestamp_bits: u32,
    identity: Identity,
    features: Features,
    limits: Caps,
    debug_utils: Option<ash::ext::debug_utils::Device>,
    pipeline_cache: vk::PipelineCache,
    pipelines_made: AtomicU32,
    is_lost: AtomicBool,
    /// Whether the driver tells of its heaps, once somebody has asked.
    tells_heaps: OnceLock<bool>,
    store: Mutex<Store>,
    /// A device of our own; last, because fields are dropped in this order.
    own_device: Option<Arc<OwnDevice>>,
}

impl Gpu {
    /// Takes a host's device into use. It stays the host's: we destroy only what we made on it.
    ///
    /// # Errors
    ///
    /// What the device is too old for, or what is not enabled on it, by name.
    ///
    /// # Safety
    ///
    /// - The handles are valid, belong together, and live until the last owner made on this `Gpu` and the
    ///   `Gpu` itself are dropped;
    /// - by then, the device has finished everything recorded with it;
    /// - `features`, `debug_utils` and `api_version` say no more than what was enabled.
    pub unsafe fn from_host(host: HostDevice<'_>) -> Result<Arc<Self>, Error> {
        // SAFETY: the caller's promises.
        unsafe { Self::new(host, None) }
    }

    /// # Safety
    /// As [`Gpu::from_host`], where `own_device` may be what keeps the handles alive.
    unsafe fn new(
        host: HostDevice<'_>,
        own_device: Option<Arc<OwnDevice>>,
    ) -> Result<Arc<Self>, Error> {
        if host.api_version < API_VERSION {
            return Err(too_old("the host's instance", host.api_version));
        }
        let entry = ash::StaticFn {
            get_instance_proc_addr: host.get_instance_proc_addr,
        };
        // SAFETY: the handles are valid and belong together (the caller's promise).
        let (instance, report, families) = unsafe {
            let instance = ash::Instance::load(&entry, host.instance);
            let report = check_device(&host.physical());
            let families =
                instance.get_physical_device_queue_family_properties(host.physical_device);
            (instance, report, families)
        };
        let identity = &report.identity;
        let found = identity.api_version;
        if found < identity::version(API_VERSION) {
            let [major, minor, patch] = found;
            let found = vk::make_api_version(0, major, minor, patch);
            return Err(too_old(&identity.name, found));
        }
        report.require()?;
        let identity = report.identity;
        // SAFETY: as above; instance and device speak Vulkan 1.3, and there is such a family.
        let (device, mut limits) = unsafe {
            (
                ash::Device::load(instance.fp_v1_0(), host.device),
                Caps::of(&instance, host.physical_device).clamped_to(&host.caps),
            )
        };
        if own_device.is_none() {
            limits.max_point_pixels = 1;
        }
        let family = families[host.queue_family as usize];
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.clone(),
            device: device.clone(),
            physical_device: host.physical_device,
            debug_settings: AllocatorDebugSettings::default(),
            buffer_device_address: false,
            allocation_sizes: AllocationSizes::new(SMALLEST_BLOCK_BYTES, SMALLEST_BLOCK_BYTES)
                .with_max_device_memblock_size(LARGEST_BLOCK_BYTES)
                .with_max_host_memblock_size(LARGEST_BLOCK_BYTES),
        });
        let allocator = allocator.map_err(|cause| Error::Allocation {
            doing: "set up the memory allocator".into(),
            cause,
        })?;
        let mut gpu = Self {
            debug_utils: host
                .debug_utils
                .then(|| ash::ext::debug_utils::Device::new(&instance, &device)),
            instance,
            device,
            physical_device: host.physical_device,
            queue_family: host.queue_family,
            timestamp_bits: family.timestamp_valid_bits,
            identity,
            features: host.features,
            limits,
            pipeline_cache: vk::PipelineCache::null(),
            pipelines_made: AtomicU32::new(0),
            is_lost: AtomicBool::new(false),
            tells_heaps: OnceLock::new(),
            store: Mutex::new(Store::new(allocator)),
            own_device,
        };
        let data = if is_pipeline_cache_of(&gpu.identity, host.pipeline_cache) {
            host.pipeline_cache
        } else {
            &[]
        };
        let info = vk::PipelineCacheCreateInfo::default().initial_data(data);
        // SAFETY: the device is valid; the data was made by this very driver.
        gpu.pipeline_cache = gpu.call(
            || "make a pipeline cache".into(),
            |device| unsafe { device.create_pipeline_cache(&info, None) },
        )?;
        Ok(Arc::new(gpu))
    }

    /// What is recorded from now on is done when the timeline reaches `value`. Values only rise.
    pub fn announce(&self, value: u64) {
        self.store().announce(value);
    }

    /// Destroys what was dropped and waited for `completed` or less.
    ///
    /// # Safety
    ///
    /// The device has finished all that was recorded under announced values up to `completed`.
    pub unsafe fn retire(&self, completed: u64) {
        // SAFETY: the caller's promise.
        unsafe { self.store().retire(&self.device, completed) };
    }

    /// How many raw objects of each kind exist: those with an owner and those that wait to be destroyed. Pipelines of a
    /// device of our own belong to it, and are not counted.
    pub fn live_objects(&self) -> BTreeMap<&'static str, usize> {
        self.store().live()
    }

    /// The functions of the device.
    pub fn device(&self) -> &ash::Device {
        &self.device
    }

    /// The functions of the instance.
    pub fn instance(&self) -> &ash::Instance {
        &self.instance
    }

    /// The physical device.
    pub fn physical_device(&self) -> vk::PhysicalDevice {
        self.physical_device
    }

    /// The family of the queues that our recordings are for.
    pub fn queue_family(&self) -> u32 {
        self.queue_family
    }

    /// Which device and driver this is.
    pub fn identity(&self) -> &Identity {
        &self.identity
    }

    /// The device's name.
    pub fn device_name(&self) -> &str {
        &self.identity.name
    }

    /// True where the "GPU" is a driver that computes on the CPU.
    pub fn is_cpu(&self) -> bool {
        self.identity.kind == DeviceKind::Cpu
    }

    /// Whether shaders that fetch and weigh voxels themselves were found to be faster than the driver's sampler: those
    /// of llvmpipe are, by a half and more, and those of SwiftShader take twice as long (`docs/log/performance.md`).
    pub fn has_slow_sampler(&self) -> bool {
        self.is_llvmpipe()
    }

    /// Whether shaders are made for a processor that runs invocations side by side under a mask.
    pub(crate) fn is_llvmpipe(&self) -> bool {
        self.identity().driver_id == vk::DriverId::MESA_LLVMPIPE
    }

    /// Whether floats become whole numbers by shifts (`src/shaders/float_to_int.rs`): some llvmpipe converts with saturation,
    /// which processors of other families than x86 have an instruction for (`docs/performance.md`).
    pub(crate) fn has_slow_conversions(&self) -> bool {
        cfg!(any(target_arch = "x86", target_arch = "x86_64"))
            && self.identity.saturates_conversions()
    }

    /// Whether fragments were found to take long over each parameter that they ask for: llvmpipe reads it once for
    /// every pixel (`shaders/flat_varyings.rs`).
    pub fn has_slow_parameters(&self) -> bool {
        self.has_slow_sampler()
    }

    /// Whether squares of a picture are drawn as points of at most so many pixels, not as two triangles: llvmpipe
    /// shades twice what these share (`shaders/lib/patch_points.wgsl`).
    pub(crate) fn draws_squares_as_points(&self, most_pixels: u32) -> bool {
        self.is_llvmpipe() && self.limits.max_point_pixels >= most_pixels
    }

    /// The limits that every size is compared with.
    pub fn limits(&self) -> &Caps {
        &self.limits
    }

    /// What is enabled on the device.
    pub fn features(&self) -> Features {
        self.features
    }

    /// Pipelines made so far: after a warm-up this number stays.
    pub fn pipelines_made(&self) -> u32 {
        self.pipelines_made.load(Ordering::Relaxed)
    }

    /// What the driver has compiled so far, for [`HostDevice::pipeline_cache`] of a later run.
    pub fn pipeline_cache_data(&self) -> Result<Vec<u8>, Error> {
        // SAFETY: the cache was made on this device.
        self.call(
            || "read the pipeline cache".into(),
            |device| unsafe { device.get_pipeline_cache_data(self.pipeline_cache) },
        )
    }

    /// Names an object for validation messages and debuggers, where the instance can.
    fn name(&self, handle: impl vk::Handle, name: &str) {
        if let Ok(name) = CString::new(name) {
            self.set_name(
                vk::DebugUtilsObjectNameInfoEXT::default().object_name(&name),
                handle,
            );
        }
    }

    /// Takes a name away, for drivers that do not free it with the object.
    fn unname(&self, handle: impl vk::Handle) {
        if !self.is_lost() {
            self.set_name(vk::DebugUtilsObjectNameInfoEXT::default(), handle);
        }
    }

    fn set_name(&self, info: vk::DebugUtilsObjectNameInfoEXT, handle: impl vk::Handle) {
        if let Some(debug_utils) = &self.debug_utils {
            let info = info.object_handle(handle);
            // SAFETY: the handle was made on this device. A name is a courtesy: its failure changes nothing.
            let _ = unsafe { debug_utils.set_debug_utils_object_name(&info) };
        }
    }

    fn store(&self) -> MutexGuard<'_, Store> {
        // A panic elsewhere leaves the store consistent: every step under the lock is a push or a pop.
        self.store.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Debug for Gpu {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Gpu")
            .field("device", &self.identity.name)
            .finish_non_exhaustive()
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        // SAFETY: the host promised that its device has finished; on our own we wait for it. No owner is left,
        // each holds an Arc of us. The cache may be null.
        unsafe {
            if let Some(own) = &self.own_device {
                own.wait_idle();
            }
            self.device
                .destroy_pipeline_cache(self.pipeline_cache, None);
            let store = self.store.get_mut().unwrap_or_else(PoisonError::into_inner);
            store.destroy_all(&self.device);
        }
    }
}

fn too_old(what: &str, found: u32) -> Error {
    Error::ApiVersion {
        what: what.into(),
        wanted: version_text(API_VERSION),
        found: version_text(found),
    }
}

/// Reads the header that every pipeline cache starts with (`VkPipelineCacheHeaderVersionOne`).
fn is_pipeline_cache_of(identity: &Identity, data: &[u8]) -> bool {
    let word = |k: usize| {
        data.get(4 * k..4 * k + 4)
            .map(|bytes| u32::from_le_bytes(bytes.try_into().unwrap()))
    };
    word(1) == Some(1)
        && word(2) == Some(identity.vendor_id)
        && word(3) == Some(identity.device_id)
        && data.get(16..32) == Some(&identity.pipeline_cache_uuid)
}
