//! How long the device worked on a part of a recording.
//!
//! ```text
//! milliseconds = ((stop - start) modulo 2^timestampValidBits) * timestampPeriod * 1e-6
//! ```

use super::{Error, Gpu, owned::Own};
use ash::vk;
use std::sync::Arc;

/// A mark is passed when all that was recorded before it has ended.
const END_OF_WORK: vk::PipelineStageFlags2 = vk::PipelineStageFlags2::BOTTOM_OF_PIPE;

/// Two timestamps around a part of one recording.
#[derive(Debug)]
pub struct Timer {
    pool: Own<vk::QueryPool>,
}

impl Timer {
    /// `None` where the queue family cannot take timestamps.
    pub fn new(gpu: &Arc<Gpu>) -> Result<Option<Self>, Error> {
        if gpu.timestamp_bits == 0 {
            return Ok(None);
        }
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::TIMESTAMP)
            .query_count(2);
        // SAFETY: the device is valid.
        let pool = gpu.call(
            || "make a timer".into(),
            |device| unsafe { device.create_query_pool(&info, None) },
        )?;
        gpu.name(pool, "timer");
        Ok(Some(Self {
            pool: Own::new(gpu, pool),
        }))
    }

    /// The clock starts when what was recorded before has ended.
    ///
    /// # Safety
    ///
    /// `cmd` is recording on our device, outside rendering; the timer lives until it has run, and is started in one
    /// unfinished recording only.
    pub unsafe fn start(&self, cmd: vk::CommandBuffer) {
        // SAFETY: the caller's promises; synchronization2 was required of the device.
        self.pool.gpu().record(|device| unsafe {
            device.cmd_reset_query_pool(cmd, self.raw(), 0, 2);
            device.cmd_write_timestamp2(cmd, END_OF_WORK, self.raw(), 0);
        });
    }

    /// The clock stops when everything recorded so far has ended.
    ///
    /// # Safety
    ///
    /// As [`Timer::start`], which was recorded into the same command buffer.
    pub unsafe fn stop(&self, cmd: vk::CommandBuffer) {
        // SAFETY: the caller's promises; synchronization2 was required of the device.
        self.pool.gpu().record(|device| unsafe {
            device.cmd_write_timestamp2(cmd, END_OF_WORK, self.raw(), 1);
        });
    }

    /// What was measured; `None` while the device has not passed both marks. Does not wait.
    ///
    /// The recording with [`Timer::start`] must have been submitted.
    pub fn elapsed_ms(&self) -> Result<Option<f64>, Error> {
        let gpu = self.pool.gpu();
        let mut ticks = [0_u64; 2];
        // SAFETY: the pool is ours and has two queries.
        let is_ready = gpu.call(
            || "read a timer".into(),
            |device| unsafe {
                let flags = vk::QueryResultFlags::TYPE_64;
                match device.get_query_pool_results(self.raw(), 0, &mut ticks, flags) {
                    Err(vk::Result::NOT_READY) => Ok(false),
                    found => found.map(|()| true),
                }
            },
        )?;
        if !is_ready {
            return Ok(None);
        }
        let valid = u64::MAX >> (64 - gpu.timestamp_bits.min(64));
        let elapsed = ticks[1].wrapping_sub(ticks[0]) & valid;
        Ok(Some(
            elapsed as f64 * f64::from(gpu.limits().timestamp_period_ns) * 1e-6,
        ))
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::QueryPool {
        self.pool.get()
    }
}
