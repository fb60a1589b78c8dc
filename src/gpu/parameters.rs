//! A ring of uniform slots: the parameters of one recording each.
//!
//! ```text
//! offset(slot) = slot * stride,   stride = slot bytes rounded up to max(256, minUniformBufferOffsetAlignment)
//! ```
//!
//! 256 is the largest alignment that a device may ask for, so offsets are the same on every device.

use super::{Buffer, Error, Gpu, Memory, error::within};
use ash::vk;
use std::sync::Arc;

const LEAST_ALIGNMENT_BYTES: u64 = 256;

/// Host-visible slots for uniform parameters. A host sizes it by frames in flight times views.
#[derive(Debug)]
pub struct ParameterRing {
    buffer: Buffer,
    slot_bytes: u32,
    stride_bytes: u64,
    slots: u32,
}

impl ParameterRing {
    /// `slots` slots for parameters of up to `slot_bytes` bytes.
    pub fn new(gpu: &Arc<Gpu>, slot_bytes: u32, slots: u32, name: &str) -> Result<Self, Error> {
        let doing =
            || format!("make parameter ring `{name}` of {slots} slots of {slot_bytes} bytes");
        let limits = gpu.limits();
        let allowed = limits.max_uniform_buffer_range.into();
        within(doing, "maxUniformBufferRange", slot_bytes.into(), allowed)?;
        let alignment = limits
            .min_uniform_offset_alignment
            .max(LEAST_ALIGNMENT_BYTES);
        let stride_bytes = u64::from(slot_bytes).next_multiple_of(alignment);
        let bytes = stride_bytes * u64::from(slots);
        within(doing, "a dynamic offset of 32 bits", bytes, u32::MAX.into())?;
        // The other usage: its buffer stands in for storage buffers that are not read.
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER | vk::BufferUsageFlags::STORAGE_BUFFER;
        let buffer = Buffer::new(gpu, bytes, usage, Memory::Upload, name)?;
        Ok(Self {
            buffer,
            slot_bytes,
            stride_bytes,
            slots,
        })
    }

    /// The Vulkan handle of the buffer of all slots.
    pub fn raw(&self) -> vk::Buffer {
        self.buffer.raw()
    }

    /// The buffer of all slots.
    pub fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// The size that a slot was asked for.
    pub fn slot_bytes(&self) -> u32 {
        self.slot_bytes
    }

    /// How many slots there are.
    pub fn slots(&self) -> u32 {
        self.slots
    }

    /// Fills a slot that no unfinished recording reads.
    pub fn write(&self, slot: u32, parameters: &[u8]) -> Result<(), Error> {
        if parameters.len() > self.slot_bytes as usize {
            return Err(Error::Argument {
                doing: format!(
                    "write slot {slot} of parameter ring `{}`",
                    self.buffer.name()
                ),
                wanted: format!("up to {} bytes", self.slot_bytes),
                found: parameters.len().to_string(),
            });
        }
        self.buffer.write(self.offset(slot)?.into(), parameters)
    }

    /// The dynamic offset of a slot.
    pub fn offset(&self, slot: u32) -> Result<u32, Error> {
        if slot >= self.slots {
            return Err(Error::Argument {
                doing: format!("use parameter ring `{}`", self.buffer.name()),
                wanted: format!("a slot below {}", self.slots),
                found: slot.to_string(),
            });
        }
        Ok((u64::from(slot) * self.stride_bytes) as u32)
    }
}
