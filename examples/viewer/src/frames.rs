//! Frames in flight: a command buffer, a fence and a semaphore each, and the counting that tells stratavox when what it
//! dropped is used no more.

use crate::error::{Doing, Error};
use crate::host::Host;
use crate::swapchain::Swapchain;
use ash::vk;

pub struct Frames {
    all: Vec<Frame>,
    next: usize,
    /// How many were submitted: the value of [`stratavox::gpu::Gpu::announce`].
    submitted: u64,
}

struct Frame {
    pool: vk::CommandPool,
    cmd: vk::CommandBuffer,
    /// Signalled when the device has done the frame.
    done: vk::Fence,
    /// Signalled when its image of the window is ours.
    acquired: vk::Semaphore,
    /// Which of the submitted ones it was.
    value: u64,
}

/// A frame that is free, and its image of the window.
#[derive(Clone, Copy)]
pub struct Begun {
    /// Its number: that of a [`stratavox::embed::FrameInfo`].
    pub frame: u32,
    pub cmd: vk::CommandBuffer,
    /// The number of the image.
    pub image: usize,
}

impl Frames {
    pub fn new(host: &Host, count: u32) -> Result<Self, Error> {
        let mut frames = Self {
            all: Vec::new(),
            next: 0,
            submitted: 0,
        };
        for _ in 0..count {
            match Frame::new(host) {
                Ok(frame) => frames.all.push(frame),
                Err(error) => {
                    frames.destroy(host);
                    return Err(error);
                }
            }
        }
        Ok(frames)
    }

    /// How many there are.
    pub fn count(&self) -> u32 {
        self.all.len() as u32
    }

    /// Waits for the next frame in flight, takes an image of the window, and begins recording. `None` where the window
    /// has another size by now.
    pub fn begin(&mut self, host: &Host, swapchain: &Swapchain) -> Result<Option<Begun>, Error> {
        let frame = &self.all[self.next];
        let fences = [frame.done];
        // SAFETY: the fence, the semaphore and the pool are this frame's, which nothing unfinished uses after the wait.
        unsafe {
            host.device
                .wait_for_fences(&fences, true, u64::MAX)
                .doing("wait for a frame")?;
            // One queue does all in order: what came before this frame is done too.
            host.gpu().retire(frame.value);
            let none = vk::Fence::null();
            let raw = swapchain.raw;
            let acquired = host
                .swapchains
                .acquire_next_image(raw, u64::MAX, frame.acquired, none);
            let image = match acquired {
                // An image of the wrong size is ours all the same: it is shown, and the next has the right one.
                Ok((image, _)) => image as usize,
                Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => return Ok(None),
                Err(cause) => return Err(cause).doing("take an image of the window"),
            };
            host.gpu().announce(self.submitted + 1);
            let flags = vk::CommandPoolResetFlags::empty();
            let begun = host.device.reset_command_pool(frame.pool, flags);
            begun.doing("begin a frame")?;
            let info = vk::CommandBufferBeginInfo::default()
                .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            let begun = host.device.begin_command_buffer(frame.cmd, &info);
            begun.doing("begin a frame")?;
            Ok(Some(Begun {
                frame: self.next as u32,
                cmd: frame.cmd,
                image,
            }))
        }
    }

    /// Submits what was recorded and shows it. False where the window wants images of another size.
    pub fn show(
        &mut self,
        host: &Host,
        swapchain: &Swapchain,
        begun: Begun,
    ) -> Result<bool, Error> {
        self.submitted += 1;
        let frame = &mut self.all[self.next];
        frame.value = self.submitted;
        let drawn = swapchain.images[begun.image].drawn;
        let info = |semaphore, stage| {
            [vk::SemaphoreSubmitInfo::default()
                .semaphore(semaphore)
                .stage_mask(stage)]
        };
        // The image is first touched where it becomes a color target: all before that need not wait for it.
        let waits = info(
            frame.acquired,
            vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
        );
        // Presentation begins after all of the frame, copies of it too.
        let signals = info(drawn, vk::PipelineStageFlags2::ALL_COMMANDS);
        let cmds = [vk::CommandBufferSubmitInfo::default().command_buffer(frame.cmd)];
        let submit = [vk::SubmitInfo2::default()
            .wait_semaphore_infos(&waits)
            .command_buffer_infos(&cmds)
            .signal_semaphore_infos(&signals)];
        let (swapchains, images, semaphores) = ([swapchain.raw], [begun.image as u32], [drawn]);
        let present = vk::PresentInfoKHR::default()
            .wait_semaphores(&semaphores)
            .swapchains(&swapchains)
            .image_indices(&images);
        // SAFETY: the recording is ours; the queue is this thread's alone; the fence was waited for.
        unsafe {
            let device = &host.device;
            let ended = device.end_command_buffer(frame.cmd);
            ended.doing("record a frame")?;
            let reset = device.reset_fences(&[frame.done]);
            reset.doing("reset a fence")?;
            let submitted = device.queue_submit2(host.queue, &submit, frame.done);
            submitted.doing("submit a frame")?;
            self.next = (self.next + 1) % self.all.len();
            match host.swapchains.queue_present(host.queue, &present) {
                Ok(is_suboptimal) => Ok(!is_suboptimal),
                Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => Ok(false),
                Err(cause) => Err(cause).doing("show a frame"),
            }
        }
    }

    /// The device has finished: what was dropped is destroyed.
    pub fn retire_all(&self, host: &Host) {
        // SAFETY: the caller's promise.
        unsafe { host.gpu().retire(self.submitted) };
    }

    /// The device has finished.
    pub fn destroy(&mut self, host: &Host) {
        for frame in self.all.drain(..) {
            frame.destroy(host);
        }
    }
}

impl Frame {
    fn new(host: &Host) -> Result<Self, Error> {
        let mut frame = Self {
            pool: vk::CommandPool::null(),
            cmd: vk::CommandBuffer::null(),
            done: vk::Fence::null(),
            acquired: vk::Semaphore::null(),
            value: 0,
        };
        match frame.fill(host) {
            Ok(()) => Ok(frame),
            Err(error) => {
                frame.destroy(host);
                Err(error)
            }
        }
    }

    fn fill(&mut self, host: &Host) -> Result<(), Error> {
        let device = &host.device;
        // SAFETY: plain Vulkan on the host's device.
        unsafe {
            let info = vk::CommandPoolCreateInfo::default()
                .flags(vk::CommandPoolCreateFlags::TRANSIENT)
                .queue_family_index(host.gpu().queue_family());
            let pool = device.create_command_pool(&info, None);
            self.pool = pool.doing("make a command pool")?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(self.pool)
                .command_buffer_count(1);
            let cmds = device.allocate_command_buffers(&info);
            self.cmd = cmds.doing("make a command buffer")?[0];
            // As if a frame had been done, so that the first wait is over at once.
            let info = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
            self.done = device.create_fence(&info, None).doing("make a fence")?;
            let info = vk::SemaphoreCreateInfo::default();
            let acquired = device.create_semaphore(&info, None);
            self.acquired = acquired.doing("make a semaphore")?;
        }
        Ok(())
    }

    fn destroy(self, host: &Host) {
        // SAFETY: nothing unfinished uses them; null is ignored.
        unsafe {
            host.device.destroy_semaphore(self.acquired, None);
            host.device.destroy_fence(self.done, None);
            host.device.destroy_command_pool(self.pool, None);
        }
    }
}
