//! Command buffers of ours for a queue of the host's: recorded and submitted by us, where a host wants that.

use super::{Error, Feature, Gpu, owned::Own};
use ash::vk;
use std::sync::Arc;

/// A timeline semaphore of the host's, and one of its values.
pub type TimelinePoint = (vk::Semaphore, u64);

/// One command buffer for each frame in flight, and the pool that they come from.
#[derive(Debug)]
pub struct Commands {
    pool: Own<vk::CommandPool>,
    fence: Own<vk::Fence>,
    buffers: Vec<vk::CommandBuffer>,
}

impl Commands {
    /// Command buffers for queues of [`Gpu::queue_family`].
    ///
    /// # Errors
    /// Where `timelineSemaphore` is not enabled on the device; no memory.
    pub fn new(gpu: &Arc<Gpu>, count: u32) -> Result<Self, Error> {
        gpu.require(Feature::TimelineSemaphore)?;
        let doing = || "make command buffers".into();
        let info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER)
            .queue_family_index(gpu.queue_family());
        // SAFETY: the device is valid.
        let pool = gpu.call(doing, |device| unsafe {
            device.create_command_pool(&info, None)
        })?;
        let pool = Own::new(gpu, pool);
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(pool.get())
            .command_buffer_count(count);
        // SAFETY: the pool is ours.
        let buffers = gpu.call(doing, |device| unsafe {
            device.allocate_command_buffers(&info)
        })?;
        let info = vk::FenceCreateInfo::default();
        // SAFETY: the device is valid.
        let fence = gpu.call(doing, |device| unsafe { device.create_fence(&info, None) })?;
        Ok(Self {
            pool,
            fence: Own::new(gpu, fence),
            buffers,
        })
    }

    /// Records command buffer number `frame`, for [`Commands::submit`].
    ///
    /// # Errors
    /// Those of `record`; a number that there is no buffer of.
    ///
    /// # Safety
    /// The device has finished what was submitted with this number before.
    pub unsafe fn record<E: From<Error>>(
        &self,
        frame: u32,
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), E>,
    ) -> Result<(), E> {
        let gpu = self.pool.gpu();
        let cmd = self.buffer(frame)?;
        let info = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        gpu.call(
            || "begin a command buffer".into(),
            // SAFETY: the caller's promise: the buffer is in no use.
            |device| unsafe { device.begin_command_buffer(cmd, &info) },
        )?;
        let recorded = record(cmd);
        // SAFETY: it is recording.
        let ended = gpu.call(
            || "end a command buffer".into(),
            |device| unsafe { device.end_command_buffer(cmd) },
        );
        recorded?;
        Ok(ended?)
    }

    /// Submits what was recorded last with this number: it begins when all of `waits` are reached, and all of `signals`
    /// are reached when it is done.
    ///
    /// # Errors
    /// A device that is lost; a number that there is no buffer of.
    ///
    /// # Safety
    /// - [`Commands::record`] has recorded it since it was submitted last;
    /// - nobody else uses the queue meanwhile; it is of the family that the buffers were made for;
    /// - semaphores are timelines of the device, and live until the submission is done;
    /// - after one that `is_fenced`, [`Commands::wait`] comes before the next one.
    pub unsafe fn submit(
        &self,
        queue: vk::Queue,
        frame: u32,
        waits: &[TimelinePoint],
        signals: &[TimelinePoint],
        is_fenced: bool,
    ) -> Result<(), Error> {
        let point = |&(semaphore, value): &TimelinePoint| {
            vk::SemaphoreSubmitInfo::default()
                .semaphore(semaphore)
                .value(value)
                .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
        };
        let waits: Vec<_> = waits.iter().map(point).collect();
        let signals: Vec<_> = signals.iter().map(point).collect();
        let cmds = [vk::CommandBufferSubmitInfo::default().command_buffer(self.buffer(frame)?)];
        let submit = [vk::SubmitInfo2::default()
            .wait_semaphore_infos(&waits)
            .command_buffer_infos(&cmds)
            .signal_semaphore_infos(&signals)];
        let fence = match is_fenced {
            true => self.fence.get(),
            false => vk::Fence::null(),
        };
        // SAFETY: the caller's promises; synchronization2 was required of the device.
        self.pool.gpu().call(
            || "submit a frame".into(),
            |device| unsafe { device.queue_submit2(queue, &submit, fence) },
        )
    }

    /// Waits for what was submitted last with `is_fenced`.
    ///
    /// # Errors
    /// A device that is lost.
    pub fn wait(&self) -> Result<(), Error> {
        let fence = [self.fence.get()];
        self.pool.gpu().call(
            || "wait for a part of a frame".into(),
            // SAFETY: the fence is ours, and in no use when the wait is over.
            |device| unsafe {
                device.wait_for_fences(&fence, true, u64::MAX)?;
                device.reset_fences(&fence)
            },
        )
    }

    fn buffer(&self, frame: u32) -> Result<vk::CommandBuffer, Error> {
        let wrong = || Error::Argument {
            doing: "record a frame of ours".into(),
            wanted: format!("a frame in flight below {}", self.buffers.len()),
            found: frame.to_string(),
        };
        let buffer = self.buffers.get(frame as usize);
        buffer.copied().ok_or_else(wrong)
    }
}
