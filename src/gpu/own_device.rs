//! A device of our own, on which everything is enabled that we use and it has.

use super::{
    Error, Features, ValidationMode, devices, error::Doing, instance::Candidate,
    instance::OwnInstance, pipelines::Pipelines, portability_subset,
};
use ash::{khr, vk};
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// A device that we made, destroyed when dropped. Everything made on it must be gone by then.
pub(super) struct OwnDevice {
    pub device: ash::Device,
    pub queue_family: u32,
    /// Those that were asked for. Whoever holds one may submit to it.
    pub queues: Vec<Arc<Mutex<vk::Queue>>>,
    pub features: Features,
    pub pipelines: Pipelines,
    // Last: fields are dropped in this order, after the device was destroyed.
    pub instance: OwnInstance,
}

impl OwnDevice {
    /// `from` has everything that is required; of `queues` there will be as many as it has.
    pub fn new(
        instance: OwnInstance,
        from: &Candidate,
        mode: Option<ValidationMode>,
        queues: u32,
    ) -> Result<Self, Error> {
        // SAFETY: the device was listed by this instance, here and below.
        let families = unsafe {
            instance
                .raw()
                .get_physical_device_queue_family_properties(from.physical_device)
        };
        let queue_family = devices::queue_family(&families).unwrap_or_default();
        // SAFETY: as above; `from` speaks Vulkan 1.3.
        let features = unsafe { devices::supported(instance.raw(), from.physical_device) };
        // SAFETY: as above.
        let supported = unsafe {
            instance
                .raw()
                .get_physical_device_features(from.physical_device)
        };
        let mut core = vk::PhysicalDeviceFeatures::default()
            .robust_buffer_access(features.robust_buffer_access)
            .large_points(supported.large_points == vk::TRUE);
        if mode == Some(ValidationMode::GpuAssisted) {
            // What the instrumented shaders need, where the device has it.
            core.fragment_stores_and_atomics = supported.fragment_stores_and_atomics;
            core.vertex_pipeline_stores_and_atomics = supported.vertex_pipeline_stores_and_atomics;
            core.shader_int64 = supported.shader_int64;
        }
        let mut features12 = vk::PhysicalDeviceVulkan12Features::default()
            .timeline_semaphore(features.timeline_semaphore);
        let mut features13 = vk::PhysicalDeviceVulkan13Features::default()
            .dynamic_rendering(features.dynamic_rendering)
            .synchronization2(features.synchronization2)
            .robust_image_access(features.robust_image_access);
        // SAFETY: as above.
        let mut subset = unsafe { portability_subset(instance.raw(), from.physical_device) };
        let extensions: Vec<_> = subset
            .iter()
            .map(|_| khr::portability_subset::NAME.as_ptr())
            .collect();
        let there = families.get(queue_family as usize);
        let queue_count = there.map_or(1, |family| family.queue_count.min(queues).max(1));
        let priorities = vec![1.0; queue_count as usize];
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(queue_family)
            .queue_priorities(&priorities)];
        let mut info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .enabled_features(&core)
            .push_next(&mut features12)
            .push_next(&mut features13);
        if let Some(subset) = &mut subset {
            info = info.push_next(subset);
        }
        // SAFETY: only what the device supports is enabled.
        let device = unsafe {
            instance
                .raw()
                .create_device(from.physical_device, &info, None)
        }
        .doing(|| format!("make a device of {}", from.title()))?;
        let queue = |index| {
            // SAFETY: the device was made with so many queues of this family.
            Arc::new(Mutex::new(unsafe {
                device.get_device_queue(queue_family, index)
            }))
        };
        Ok(Self {
            queues: (0..queue_count).map(queue).collect(),
            device,
            queue_family,
            features,
            pipelines: Pipelines::default(),
            instance,
        })
    }

    /// Waits until nothing runs on the device, and lets nobody submit meanwhile.
    pub fn wait_idle(&self) {
        let queues = self.queues.iter();
        let _held: Vec<_> = queues
            .map(|queue| queue.lock().unwrap_or_else(PoisonError::into_inner))
            .collect();
        // SAFETY: the device is ours, and all of its queues are held.
        // A lost device has nothing left to finish, and destroying stays legal.
        let _ = unsafe { self.device.device_wait_idle() };
    }
}

impl fmt::Debug for OwnDevice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OwnDevice")
            .field("instance", &self.instance)
            .finish_non_exhaustive()
    }
}

impl Drop for OwnDevice {
    fn drop(&mut self) {
        // SAFETY: we made it, and everything made on it is gone: the `Gpu` that owns us sees to that.
        unsafe {
            self.pipelines.destroy_all(&self.device);
            self.device.destroy_device(None);
        }
    }
}
