//! When the frames of a host begin, and that they are done.

use super::Host;
use ash::vk;

/// Two timelines of the host's: frame n begins when `gate` has reached n, and brings `done` to n.
pub struct Pace<'h> {
    gate: vk::Semaphore,
    done: vk::Semaphore,
    host: &'h Host,
}

impl<'h> Pace<'h> {
    pub fn new(host: &'h Host) -> Self {
        let timeline = || {
            let mut kind =
                vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
            let info = vk::SemaphoreCreateInfo::default().push_next(&mut kind);
            // SAFETY: the device has timelines; `drop` destroys them first.
            unsafe { host.device.create_semaphore(&info, None).unwrap() }
        };
        Self {
            gate: timeline(),
            done: timeline(),
            host,
        }
    }

    pub fn done(&self) -> u64 {
        // SAFETY: the semaphores are timelines of this device, here and below.
        unsafe {
            self.host
                .device
                .get_semaphore_counter_value(self.done)
                .unwrap()
        }
    }

    pub fn open(&self, frame: u64) {
        let info = vk::SemaphoreSignalInfo::default()
            .semaphore(self.gate)
            .value(frame);
        // SAFETY: as above; values rise.
        unsafe { self.host.device.signal_semaphore(&info).unwrap() };
    }

    pub fn wait(&self, frame: u64) {
        let (semaphores, values) = ([self.done], [frame]);
        let info = vk::SemaphoreWaitInfo::default()
            .semaphores(&semaphores)
            .values(&values);
        // SAFETY: as above.
        unsafe { self.host.device.wait_semaphores(&info, u64::MAX).unwrap() };
    }

    /// Submits frame `n`, recorded in `cmd`.
    pub fn submit(&self, cmd: vk::CommandBuffer, n: u64) {
        let host = self.host;
        let (cmds, values) = ([cmd], [n]);
        let (waits, signals) = ([self.gate], [self.done]);
        let mut timeline = vk::TimelineSemaphoreSubmitInfo::default()
            .wait_semaphore_values(&values)
            .signal_semaphore_values(&values);
        let submit = vk::SubmitInfo::default()
            .command_buffers(&cmds)
            .wait_semaphores(&waits)
            .wait_dst_stage_mask(&[vk::PipelineStageFlags::ALL_COMMANDS])
            .signal_semaphores(&signals)
            .push_next(&mut timeline);
        // SAFETY: the recording has ended, and the frame is not submitted again before it is finished.
        unsafe {
            host.device
                .queue_submit(host.queue, &[submit], vk::Fence::null())
                .unwrap()
        };
    }
}

impl Drop for Pace<'_> {
    fn drop(&mut self) {
        // A test that fails leaves frames behind a closed gate.
        self.open(u64::from(u32::MAX) / 4);
        // SAFETY: what waits for the semaphores is finished first.
        unsafe {
            self.host.device.device_wait_idle().unwrap();
            self.host.device.destroy_semaphore(self.gate, None);
            self.host.device.destroy_semaphore(self.done, None);
        }
    }
}
