//! A device of our own, for the tool and the tests: the only place that makes one, submits and waits.

use super::{
    API_VERSION, Caps, DeviceChoice, Error, Features, Gpu, HostDevice, Message, PipelineCache,
    Validation, ValidationMode, cache, devices, error::Doing, instance::Candidate,
    instance::OwnInstance, owned::Own, validation::Messages,
};
use ash::vk;
use std::{
    fmt,
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::Instant,
};

/// How to set up a [`Headless`].
#[derive(Clone, Debug)]
pub struct Options {
    /// Limits stricter than the device's own.
    pub caps: Caps,
    /// Where compiled pipelines are kept.
    pub pipeline_cache: PipelineCache,
    /// Whether the validation layer listens.
    pub validation: Validation,
}

impl Default for Options {
    /// The device's own limits, the user's cache folder, validation as the environment says.
    fn default() -> Self {
        Self {
            caps: Caps::UNLIMITED,
            pipeline_cache: PipelineCache::default(),
            validation: Validation::default(),
        }
    }
}

/// What was submitted so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Submissions {
    /// How many there were.
    pub count: u64,
    /// How long the longest took, from its submission until the device was heard to have done it.
    pub longest_ms: f64,
    /// The same of the last one.
    pub last_ms: f64,
}

/// A device, one queue, and a fence that says when what was submitted to it has ended.
#[derive(Debug)]
pub struct Headless {
    pool: Own<vk::CommandPool>,
    cmd: vk::CommandBuffer,
    done: Own<vk::Fence>,
    queue: vk::Queue,
    /// The newest value that was submitted.
    submitted: u64,
    is_lost: bool,
    submissions: Submissions,
    stop: Option<Arc<AtomicBool>>,
    cache_file: Option<PathBuf>,
    gpu: Arc<Gpu>,
    /// Last: what the destruction of all the others has to say is heard.
    messages: Option<Arc<Messages>>,
}

impl Headless {
    /// Makes a device.
    ///
    /// # Errors
    ///
    /// No loader, no driver, no device that matches `choice` (the error lists those that exist), a feature that the
    /// device lacks, validation that is wanted and not installed.
    pub fn new(choice: &DeviceChoice, options: &Options) -> Result<Self, Error> {
        let mode = options.validation.mode()?;
        let instance = OwnInstance::new(mode)?;
        let messages = instance.messages().cloned();
        let is_usable = |device: &Candidate| instance.report(device).is_usable();
        let device = choice.pick(instance.devices()?, is_usable)?;
        instance.report(&device).require()?;
        let cache_file = options.pipeline_cache.file(&device.identity);
        let pipeline_cache = cache_file.as_deref().map(cache::load).unwrap_or_default();
        let own = OwnDevice::new(instance, &device, mode)?;
        let host = HostDevice {
            get_instance_proc_addr: own.instance.entry().static_fn().get_instance_proc_addr,
            instance: own.instance.raw().handle(),
            physical_device: device.physical_device,
            device: own.device.handle(),
            queue_family: own.queue_family,
            api_version: API_VERSION,
            features: own.features,
            debug_utils: messages.is_some(),
            caps: options.caps,
            pipeline_cache: &pipeline_cache,
        };
        // SAFETY: the handles are our own and live in `own`, which goes with the `Gpu`.
        let gpu = unsafe { Gpu::new(host, Some(Box::new(own)))? };
        Self::on(gpu, cache_file, messages)
    }

    fn on(
        gpu: Arc<Gpu>,
        cache_file: Option<PathBuf>,
        messages: Option<Arc<Messages>>,
    ) -> Result<Self, Error> {
        let device = gpu.device();
        let info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::TRANSIENT)
            .queue_family_index(gpu.queue_family());
        // SAFETY: the device is ours and valid, here and below; the family is the one it was made with.
        let pool = unsafe { device.create_command_pool(&info, None) }
            .doing(|| "make a command pool".into())?;
        let pool = Own::new(&gpu, pool);
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(pool.get())
            .command_buffer_count(1);
        // SAFETY: as above.
        let cmd = unsafe { device.allocate_command_buffers(&info) }
            .doing(|| "make a command buffer".into())?[0];
        let info = vk::FenceCreateInfo::default();
        // SAFETY: as above.
        let done = unsafe { device.create_fence(&info, None) }.doing(|| "make a fence".into())?;
        let done = Own::new(&gpu, done);
        // SAFETY: as above; the device was made with one queue of this family.
        let queue = unsafe { device.get_device_queue(gpu.queue_family(), 0) };
        gpu.name(done.get(), "headless submission");
        Ok(Self {
            pool,
            cmd,
            done,
            queue,
            submitted: 0,
            is_lost: false,
            submissions: Submissions::default(),
            stop: None,
            cache_file,
            gpu,
            messages,
        })
    }

    /// The device.
    pub fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// What was submitted so far.
    pub fn submissions(&self) -> Submissions {
        self.submissions
    }

    /// From here on nothing is submitted while `stop` is true: [`Error::Stopped`] instead.
    pub fn stop_when(&mut self, stop: Arc<AtomicBool>) {
        self.stop = Some(stop);
    }

    /// Records with `record`, submits, and waits until the device has done it. What it wrote to mapped memory can then
    /// be read, and what was dropped meanwhile is destroyed.
    ///
    /// # Errors
    ///
    /// Those of `record`, and [`Error::Stopped`]: nothing is submitted then. After [`Error::DeviceLost`] every further run says the same.
    pub fn run<R>(
        &mut self,
        record: impl FnOnce(vk::CommandBuffer) -> Result<R, Error>,
    ) -> Result<R, Error> {
        if self.is_lost {
            return Err(Error::DeviceLost {
                doing: "record on a device that was lost before".into(),
            });
        }
        if self
            .stop
            .as_ref()
            .is_some_and(|stop| stop.load(Ordering::Relaxed))
        {
            return Err(Error::Stopped);
        }
        let value = self.submitted + 1;
        self.gpu.announce(value);
        let result = self.record(record).and_then(|result| {
            self.submit(value)?;
            Ok(result)
        });
        self.is_lost |= matches!(result, Err(Error::DeviceLost { .. }));
        let result = result?;
        // SAFETY: the submission that signals `value` has ended.
        unsafe { self.gpu.retire(value) };
        Ok(result)
    }

    /// Destroys what was dropped since the last run, and not only with the next one.
    pub fn tidy(&mut self) {
        // What was submitted to a lost device may still run.
        if !self.is_lost {
            // SAFETY: every run has waited for its submission, and nothing was recorded since.
            unsafe { self.gpu.retire(self.submitted) };
        }
    }

    /// Removes and returns what the validation layer has said so far. Nothing where validation is off.
    pub fn take_validation_messages(&self) -> Vec<Message> {
        self.messages
            .as_ref()
            .map(|messages| messages.take())
            .unwrap_or_default()
    }

    /// Panics where the validation layer has said anything that was not taken. So does dropping.
    pub fn assert_no_validation_messages(&self) {
        let messages = self.take_validation_messages();
        let text: Vec<_> = messages.iter().map(Message::to_string).collect();
        assert!(
            messages.is_empty(),
            "{} validation messages:\n{}",
            messages.len(),
            text.join("\n")
        );
    }

    fn record<R>(
        &self,
        record: impl FnOnce(vk::CommandBuffer) -> Result<R, Error>,
    ) -> Result<R, Error> {
        let device = self.gpu.device();
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // All by which a recording can write to mapped buffers.
        let to_host = [vk::MemoryBarrier2::default()
            .src_stage_mask(
                vk::PipelineStageFlags2::COMPUTE_SHADER | vk::PipelineStageFlags2::ALL_TRANSFER,
            )
            .src_access_mask(
                vk::AccessFlags2::SHADER_STORAGE_WRITE | vk::AccessFlags2::TRANSFER_WRITE,
            )
            .dst_stage_mask(vk::PipelineStageFlags2::HOST)
            .dst_access_mask(vk::AccessFlags2::HOST_READ)];
        let to_host = vk::DependencyInfo::default().memory_barriers(&to_host);
        // SAFETY: every earlier submission was waited for, so the buffer is free; it is ours alone.
        unsafe {
            device
                .reset_command_pool(self.pool.get(), vk::CommandPoolResetFlags::empty())
                .and_then(|()| device.begin_command_buffer(self.cmd, &begin))
                .doing(|| "begin recording".into())?;
            let result = record(self.cmd)?;
            device.cmd_pipeline_barrier2(self.cmd, &to_host);
            device
                .end_command_buffer(self.cmd)
                .doing(|| "end recording".into())?;
            Ok(result)
        }
    }

    /// Submits what was recorded and waits for it.
    fn submit(&mut self, value: u64) -> Result<(), Error> {
        let device = self.gpu.device();
        // A fence, not a timeline: waiting for one, validation 1.3.239 races with its own queue thread and crashes
        // once in some ten thousand submissions (KhronosGroup/Vulkan-ValidationLayers#4968 is of that kind).
        let (commands, fences) = ([self.cmd], [self.done.get()]);
        let submit = vk::SubmitInfo::default().command_buffers(&commands);
        let start = Instant::now();
        // SAFETY: the recording has ended; the queue is ours, and `&mut self` makes us its only user. The last
        // submission was waited for, so nothing uses the fence.
        unsafe {
            device
                .reset_fences(&fences)
                .and_then(|()| device.queue_submit(self.queue, &[submit], fences[0]))
        }
        .doing(|| "submit".into())?;
        self.submitted = value;
        // SAFETY: the fence is ours. A driver that hangs is found by its watchdog, which makes this call fail.
        let waited = unsafe { device.wait_for_fences(&fences, true, u64::MAX) };
        let last_ms = 1e3 * start.elapsed().as_secs_f64();
        self.submissions = Submissions {
            count: self.submissions.count + 1,
            longest_ms: self.submissions.longest_ms.max(last_ms),
            last_ms,
        };
        if waited.is_err() {
            // Whatever the reason, what was submitted may still run: nothing may be recorded over it.
            self.is_lost = true;
        }
        waited.doing(|| "wait for the device".into())
    }
}

impl Drop for Headless {
    fn drop(&mut self) {
        let Some(file) = self
            .cache_file
            .as_deref()
            .filter(|_| !self.is_lost && self.gpu.pipelines_made() > 0)
        else {
            return;
        };
        if let Ok(data) = self.gpu.pipeline_cache_data()
            && cache::load(file) != data
        {
            // Losing it costs time in the next run, and nothing else.
            let _ = cache::save(file, &data);
        }
    }
}

/// A device that we made, destroyed when dropped. Everything made on it must be gone by then.
struct OwnDevice {
    device: ash::Device,
    queue_family: u32,
    features: Features,
    // Last: fields are dropped in this order, after the device was destroyed.
    instance: OwnInstance,
}

impl OwnDevice {
    /// `from` has everything that is required.
    fn new(
        instance: OwnInstance,
        from: &Candidate,
        mode: Option<ValidationMode>,
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
        let mut core = vk::PhysicalDeviceFeatures::default()
            .robust_buffer_access(features.robust_buffer_access);
        if mode == Some(ValidationMode::GpuAssisted) {
            // What the instrumented shaders need, where the device has it.
            // SAFETY: as above.
            let supported = unsafe {
                instance
                    .raw()
                    .get_physical_device_features(from.physical_device)
            };
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
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(queue_family)
            .queue_priorities(&[1.0])];
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_features(&core)
            .push_next(&mut features12)
            .push_next(&mut features13);
        // SAFETY: only what the device supports is enabled.
        let device = unsafe {
            instance
                .raw()
                .create_device(from.physical_device, &info, None)
        }
        .doing(|| format!("make a device of {}", from.title()))?;
        Ok(Self {
            device,
            queue_family,
            features,
            instance,
        })
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
        unsafe { self.device.destroy_device(None) };
    }
}
