//! The host's device, and everything that is made on it.

use super::handles::{self, Kind, Table};
use super::host::{caps, features, sv_host_device, sv_vk_function};
use super::status::{Failure, guard, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use crate::gpu::{API_VERSION, Gpu, HostDevice};
use ash::vk::{self, Handle};
use std::ffi::{c_char, c_void};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

/// A device of the host's, and all that is made on it. 0 is none.
pub type sv_device = u64;

/// Memory of a device that is the library's.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_memory {
    /// `sizeof(sv_memory)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// Bytes in use.
    pub used_bytes: u64,
    /// Bytes taken from the driver, in use or kept for later.
    pub reserved_bytes: u64,
    /// The most bytes that were taken at once.
    pub peak_bytes: u64,
    /// Vulkan objects that exist, those that wait for sv_device_retire among them.
    pub vulkan_objects: u64,
    /// Handles that are not destroyed yet.
    pub handles: u64,
    /// The most bytes that may be reserved, or 0 where there is no budget.
    pub budget_bytes: u64,
    /// In how many pieces they were taken, which `maxMemoryAllocationCount` counts.
    pub allocations: u64,
    /// What the driver says that this process may use of the device's own memory; 0 without `VK_EXT_memory_budget`.
    pub device_budget_bytes: u64,
    /// What the driver says that it uses, the host's own with it; 0 without that.
    pub device_used_bytes: u64,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_memory {
    const NAME: &'static str = "sv_memory";
}

/// Who hears that the device is lost.
struct Listener {
    call: unsafe extern "C" fn(*mut c_void, *const c_char),
    user: *mut c_void,
}

// SAFETY: the host was told that it is called from any thread that calls us.
unsafe impl Send for Listener {}

pub(super) struct Device {
    // Fields are dropped in this order: objects before what they are made on.
    pub objects: Mutex<Table>,
    pub gpu: Arc<Gpu>,
    pub serial: u64,
    announced: AtomicU64,
    is_lost: AtomicBool,
    listener: Mutex<Option<Listener>>,
}

impl Kind for Device {
    const NUMBER: u64 = 1;
    const NAME: &'static str = "sv_device";
}

impl Device {
    /// Refuses work for a device that is gone.
    pub fn check(&self) -> Result<(), Failure> {
        match self.is_lost.load(Ordering::Relaxed) {
            false => Ok(()),
            true => Err(Failure::new(
                sv_status::SV_E_DEVICE_LOST,
                "the device was lost before: what is on it can only be destroyed",
            )),
        }
    }

    /// Runs `body`, and hears whether it meets a lost device.
    pub fn run<T>(&self, body: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
        self.check()?;
        let ended = body();
        if let Err(failure) = &ended
            && failure.status == sv_status::SV_E_DEVICE_LOST
            && !self.is_lost.swap(true, Ordering::Relaxed)
        {
            let heard = self.listener.lock().map(|mut listener| listener.take());
            if let Ok(Some(listener)) = heard {
                let text = failure.text.replace('\0', " ");
                let text = std::ffi::CString::new(text).unwrap_or_default();
                // SAFETY: the host's function, with what the host gave for it.
                unsafe { (listener.call)(listener.user, text.as_ptr()) };
            }
        }
        ended
    }
}

/// Takes a host's device into use. It stays the host's, and only what is made here is destroyed by us.
///
/// The handles belong together; by sv_device_destroy, the device has finished everything that was recorded with them.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_device_from_host(
    host: *const sv_host_device,
    device: *mut sv_device,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the sv_device", device)?;
        // SAFETY: the caller's promise.
        let (host, limits) = unsafe {
            let host = structure::read(host)?;
            (host, structure::read_or_zero(host.limits)?)
        };
        let name = |what: &str| Failure::argument(format!("sv_host_device.{what} is NULL"));
        let null = [
            ("instance", host.instance),
            ("physical_device", host.physical_device),
            ("device", host.device),
        ];
        for (what, pointer) in null {
            if pointer.is_null() {
                return Err(name(what));
            }
        }
        let Some(proc_addr) = host.get_instance_proc_addr else {
            return Err(name("get_instance_proc_addr"));
        };
        let features = features(host.features)?;
        // SAFETY: as many bytes as the host says.
        let pipeline_cache = unsafe {
            structure::array(
                "bytes of sv_host_device.pipeline_cache",
                host.pipeline_cache.cast::<u8>(),
                host.pipeline_cache_bytes,
                1 << 30,
            )?
        };
        // SAFETY: the same function, with handles where C has pointers to them. The handles are the host's promise.
        let gpu = unsafe {
            Gpu::from_host(HostDevice {
                get_instance_proc_addr: std::mem::transmute::<
                    unsafe extern "C" fn(*mut c_void, *const c_char) -> sv_vk_function,
                    vk::PFN_vkGetInstanceProcAddr,
                >(proc_addr),
                instance: vk::Instance::from_raw(host.instance as u64),
                physical_device: vk::PhysicalDevice::from_raw(host.physical_device as u64),
                device: vk::Device::from_raw(host.device as u64),
                queue_family: host.queue_family,
                api_version: match host.api_version {
                    0 => API_VERSION,
                    version => version,
                },
                features,
                debug_utils: host.has_debug_utils != 0,
                caps: caps(&limits),
                pipeline_cache,
            })?
        };
        gpu.set_memory_budget((host.memory_budget > 0).then_some(host.memory_budget));
        let listener = host.device_lost.map(|call| Listener {
            call,
            user: host.user,
        });
        let made = handles::add_device(|serial| Device {
            objects: Mutex::default(),
            gpu,
            serial,
            announced: AtomicU64::new(0),
            is_lost: AtomicBool::new(false),
            listener: Mutex::new(listener),
        })?;
        // SAFETY: not NULL; the caller's promise.
        unsafe { device.write(made) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Destroys everything that was made on the device, in the right order, and what waits for sv_device_retire. Handles of
/// all of it are stale from now on. The `VkDevice` stays, and has finished all that was recorded here, or is lost.
/// Threads: no other call on the device or on what is made on it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_device_destroy(
    device: sv_device,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || handles::remove_device(device).map(drop);
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Says that what is recorded from now on is done when the host's count of submissions (or its timeline) reaches
/// `value`. What is destroyed later waits for it. Values only rise. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_device_announce(
    device: sv_device,
    value: u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        let device = handles::device(device)?;
        let last = device.announced.fetch_max(value, Ordering::Relaxed);
        if value < last {
            let text = format!("announce {value}: values only rise, and {last} was announced");
            return Err(Failure::argument(text));
        }
        device.gpu.announce(value);
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Frees what was destroyed and waited for `completed` or less. The device has finished all that was recorded under
/// announced values up to it. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_device_retire(
    device: sv_device,
    completed: u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        let device = handles::device(device)?;
        let last = device.announced.load(Ordering::Relaxed);
        if completed > last {
            let text = format!("retire {completed}: {last} was announced last");
            return Err(Failure::argument(text));
        }
        // SAFETY: the caller's promise.
        unsafe { device.gpu.retire(completed) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// How much memory the library uses on the device. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_device_memory(
    device: sv_device,
    memory: *mut sv_memory,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        let device = handles::device(device)?;
        let gpu = &device.gpu;
        let memory_use = gpu.memory();
        let local = memory_use.heaps.iter().filter(|heap| heap.is_device_local);
        let objects = gpu.live_objects().values().sum::<usize>();
        let handles = device.objects.lock().map_or(0, |table| table.len());
        let found = sv_memory {
            struct_size: 0,
            next: std::ptr::null(),
            used_bytes: memory_use.used_bytes,
            reserved_bytes: memory_use.reserved_bytes,
            peak_bytes: memory_use.peak_bytes,
            vulkan_objects: objects as u64,
            handles: handles as u64,
            budget_bytes: memory_use.budget_bytes.unwrap_or(0),
            allocations: memory_use.allocations,
            device_budget_bytes: local.clone().map(|heap| heap.budget_bytes).sum(),
            device_used_bytes: local.map(|heap| heap.used_bytes).sum(),
        };
        // SAFETY: the caller's promise.
        unsafe { structure::write(memory, &found) }
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Takes no more memory from the driver than so many bytes from now on: what would is SV_E_LIMIT, before the driver is
/// asked. 0: no budget. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_device_set_memory_budget(
    device: sv_device,
    bytes: u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        let device = handles::device(device)?;
        device.gpu.set_memory_budget((bytes > 0).then_some(bytes));
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// The host has heard that its device is lost, as it submits and waits itself: from now on every call for work is
/// SV_E_DEVICE_LOST, and nothing calls the device but what destroys. `device_lost` is not called for it. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_device_declare_lost(
    device: sv_device,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        let device = handles::device(device)?;
        device.gpu.declare_lost();
        device.is_lost.store(true, Ordering::Relaxed);
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// How many pipelines were made so far: after the last sv_renderer_create it stays. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_device_pipelines_made(
    device: sv_device,
    count: *mut u32,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the count", count)?;
        let made = handles::device(device)?.gpu.pipelines_made();
        // SAFETY: not NULL; the caller's promise.
        unsafe { count.write(made) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// What the driver has compiled so far, for sv_host_device of a later run. With `data` NULL, `bytes` is set to what
/// there is; else as many bytes are written, where `bytes` says that there is room for them. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_device_pipeline_cache(
    device: sv_device,
    bytes: *mut u64,
    data: *mut c_void,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the number of bytes", bytes)?;
        let device = handles::device(device)?;
        device.run(|| {
            let found = device.gpu.pipeline_cache_data()?;
            let wanted = found.len() as u64;
            // SAFETY: not NULL; as much room as the caller says.
            unsafe {
                let room = bytes.replace(wanted);
                if data.is_null() {
                    return Ok(());
                }
                if room < wanted {
                    let doing = "write the pipeline cache";
                    return Err(Failure::limit(doing, wanted, room));
                }
                data.cast::<u8>()
                    .copy_from_nonoverlapping(found.as_ptr(), found.len());
            }
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}
