//! A device of our own, for the tool and the tests: the only place that makes one, submits and waits.

use super::{
    Caps, DeviceChoice, Error, Gpu, Message, PipelineCache, Validation, ValidationMode, cache,
    instance::OwnInstance, owned::Own, shared_device::SharedDevice, validation::Messages,
};
use ash::vk;
use std::{
    path::PathBuf,
    sync::{
        Arc, Mutex, PoisonError,
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
    /// Held while something is submitted: others may have the same one.
    queue: Arc<Mutex<vk::Queue>>,
    /// The newest value that was submitted.
    submitted: u64,
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
        Self::of(OwnInstance::new(mode)?, mode, choice, options)
    }

    /// The same through a `vkGetInstanceProcAddr` of the caller's in place of the loader of this machine: what stands
    /// between the two hears, and may answer, every call.
    ///
    /// # Errors
    ///
    /// As [`Headless::new`].
    ///
    /// # Safety
    ///
    /// It gives functions that do what Vulkan says, and stays until the device is gone.
    pub unsafe fn through(
        get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
        choice: &DeviceChoice,
        options: &Options,
    ) -> Result<Self, Error> {
        let mode = options.validation.mode()?;
        let functions = ash::StaticFn {
            get_instance_proc_addr,
        };
        // SAFETY: the caller's promise.
        let entry = unsafe { ash::Entry::from_static_fn(functions) };
        Self::of(OwnInstance::through(entry, mode)?, mode, choice, options)
    }

    fn of(
        instance: OwnInstance,
        mode: Option<ValidationMode>,
        choice: &DeviceChoice,
        options: &Options,
    ) -> Result<Self, Error> {
        SharedDevice::of(instance, mode, choice, 1)?.headless(0, options)
    }

    pub(super) fn on(
        gpu: Arc<Gpu>,
        queue: Arc<Mutex<vk::Queue>>,
        cache_file: Option<PathBuf>,
        messages: Option<Arc<Messages>>,
    ) -> Result<Self, Error> {
        let info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::TRANSIENT)
            .queue_family_index(gpu.queue_family());
        // SAFETY: the device is ours and valid, here and below; the family is the one it was made with.
        let pool = gpu.call(
            || "make a command pool".into(),
            |device| unsafe { device.create_command_pool(&info, None) },
        )?;
        let pool = Own::new(&gpu, pool);
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(pool.get())
            .command_buffer_count(1);
        // SAFETY: as above.
        let cmd = gpu.call(
            || "make a command buffer".into(),
            |device| unsafe { device.allocate_command_buffers(&info) },
        )?[0];
        let info = vk::FenceCreateInfo::default();
        // SAFETY: as above.
        let done = gpu.call(
            || "make a fence".into(),
            |device| unsafe { device.create_fence(&info, None) },
        )?;
        let done = Own::new(&gpu, done);
        gpu.name(done.get(), "headless submission");
        Ok(Self {
            pool,
            cmd,
            done,
            queue,
            submitted: 0,
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
    /// Those of `record`, and [`Error::Stopped`]: nothing is submitted then. After [`Error::DeviceLost`] every further
    /// run says the same.
    pub fn run<R>(
        &mut self,
        record: impl FnOnce(vk::CommandBuffer) -> Result<R, Error>,
    ) -> Result<R, Error> {
        if self.gpu.is_lost() {
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
        let result = result?;
        #[cfg(feature = "conformance")]
        super::recorder::note(super::recorder::Event::Submitted);
        // SAFETY: the submission that signals `value` has ended.
        unsafe { self.gpu.retire(value) };
        Ok(result)
    }

    /// Runs `work` with the queue, to which nobody submits meanwhile.
    #[cfg(feature = "conformance")]
    pub(crate) fn on_queue<R>(&self, work: impl FnOnce(vk::Queue) -> R) -> R {
        work(*self.queue.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Destroys what was dropped since the last run, and not only with the next one.
    pub fn tidy(&mut self) {
        // What was submitted to a lost device may still run.
        if !self.gpu.is_lost() {
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
        let gpu = &self.gpu;
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
            gpu.call(
                || "begin recording".into(),
                |device| {
                    let flags = vk::CommandPoolResetFlags::empty();
                    device.reset_command_pool(self.pool.get(), flags)?;
                    device.begin_command_buffer(self.cmd, &begin)
                },
            )?;
            let result = record(self.cmd)?;
            gpu.record(|device| device.cmd_pipeline_barrier2(self.cmd, &to_host));
            gpu.call(
                || "end recording".into(),
                |device| device.end_command_buffer(self.cmd),
            )?;
            Ok(result)
        }
    }

    /// Submits what was recorded and waits for it.
    fn submit(&mut self, value: u64) -> Result<(), Error> {
        let gpu = Arc::clone(&self.gpu);
        // A fence, not a timeline: waiting for one, validation 1.3.239 races with its own queue thread and crashes
        // once in some ten thousand submissions (KhronosGroup/Vulkan-ValidationLayers#4968 is of that kind).
        let (commands, fences) = ([self.cmd], [self.done.get()]);
        let submit = vk::SubmitInfo::default().command_buffers(&commands);
        let start = Instant::now();
        let queue = self.queue.lock().unwrap_or_else(PoisonError::into_inner);
        gpu.call(
            || "submit".into(),
            // SAFETY: the recording has ended; who holds the queue is its only user. The last submission was waited
            // for, so nothing uses the fence.
            |device| unsafe {
                device.reset_fences(&fences)?;
                device.queue_submit(*queue, &[submit], fences[0])
            },
        )?;
        drop(queue);
        self.submitted = value;
        // SAFETY: the fence is ours. A driver that hangs is found by its watchdog, which makes this call fail.
        let waited = gpu.call(
            || "wait for the device".into(),
            |device| unsafe { device.wait_for_fences(&fences, true, u64::MAX) },
        );
        let last_ms = 1e3 * start.elapsed().as_secs_f64();
        self.submissions = Submissions {
            count: self.submissions.count + 1,
            longest_ms: self.submissions.longest_ms.max(last_ms),
            last_ms,
        };
        if waited.is_err() {
            // Whatever the reason, what was submitted may still run: nothing may be recorded over it.
            gpu.declare_lost();
        }
        waited
    }
}

impl Drop for Headless {
    fn drop(&mut self) {
        // The device, whose end says the same, may be shared and stay.
        if !std::thread::panicking() {
            self.assert_no_validation_messages();
        }
        let Some(file) = self
            .cache_file
            .as_deref()
            .filter(|_| !self.gpu.is_lost() && self.gpu.pipelines_made() > 0)
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
