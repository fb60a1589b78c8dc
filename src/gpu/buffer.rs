//! A buffer and its memory.

#[cfg(feature = "conformance")]
use super::recorder;
use super::{Error, Gpu, owned::Own, owned::OwnMemory};
use ash::vk;
use gpu_allocator::{
    MemoryLocation,
    vulkan::{AllocationCreateDesc, AllocationScheme},
};
use std::sync::{Arc, Mutex, PoisonError};

/// Who reaches the memory of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// The device only.
    Device,
    /// The host writes, the device reads.
    Upload,
    /// The device writes, the host reads.
    Readback,
}

/// A buffer with memory of its own.
///
/// Memory that the host reaches is mapped for the buffer's whole life and coherent: Vulkan offers such
/// memory for every buffer, and the allocator asks for it, so nothing is flushed or invalidated.
#[derive(Debug)]
pub struct Buffer {
    raw: Own<vk::Buffer>,
    // After `raw`: fields are dropped in this order, and memory goes last.
    memory: OwnMemory,
    bytes: u64,
    usage: vk::BufferUsageFlags,
    reached_by: Memory,
    name: String,
    /// One host access at a time: two writes to the same bytes would be a data race.
    host_access: Mutex<()>,
}

impl Buffer {
    /// A buffer whose content is undefined. Sizes are compared with the limits first ([`Gpu::check_buffer`]).
    pub fn new(
        gpu: &Arc<Gpu>,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        reached_by: Memory,
        name: &str,
    ) -> Result<Self, Error> {
        gpu.check_buffer(bytes, usage, name)?;
        let doing = || format!("make buffer `{name}` of {bytes} bytes");
        let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
        // SAFETY: the device is valid; sizes and usage were checked.
        let raw = gpu.call(doing, |device| unsafe { device.create_buffer(&info, None) })?;
        let raw = Own::new(gpu, raw);
        gpu.name(raw.get(), name);
        // SAFETY: the buffer was made on this device.
        let requirements = unsafe { gpu.device().get_buffer_memory_requirements(raw.get()) };
        let desc = AllocationCreateDesc {
            name,
            requirements,
            location: match reached_by {
                Memory::Device => MemoryLocation::GpuOnly,
                Memory::Upload => MemoryLocation::CpuToGpu,
                Memory::Readback => MemoryLocation::GpuToCpu,
            },
            linear: true,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        };
        let alone = AllocationScheme::DedicatedBuffer(raw.get());
        let memory = OwnMemory::new(gpu, &desc, alone, doing)?;
        let allocation = memory.get();
        // SAFETY: the memory was allocated for this buffer's requirements and is bound once.
        gpu.call(doing, |device| unsafe {
            device.bind_buffer_memory(raw.get(), allocation.memory(), allocation.offset())
        })?;
        Ok(Self {
            raw,
            memory,
            bytes,
            usage,
            reached_by,
            name: name.into(),
            host_access: Mutex::new(()),
        })
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::Buffer {
        self.raw.get()
    }

    /// The size that was asked for.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The usage that was asked for.
    pub fn usage(&self) -> vk::BufferUsageFlags {
        self.usage
    }

    /// The name in errors and validation messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Copies `data` to `offset`. The device sees it in what is submitted later; what it is using now is not to
    /// be written.
    pub fn write(&self, offset: u64, data: &[u8]) -> Result<(), Error> {
        self.write_with(offset, data.len() as u64, |bytes| {
            bytes.copy_from_slice(data)
        })
    }

    /// Lets `write` fill `count` bytes at `offset` in place. What stands there before is undefined, and reading it
    /// may be slow.
    pub fn write_with(
        &self,
        offset: u64,
        count: u64,
        write: impl FnOnce(&mut [u8]),
    ) -> Result<(), Error> {
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        let mapped = self.mapped("write", offset, count)?;
        let _one_at_a_time = self
            .host_access
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        // SAFETY: `mapped` starts `count` mapped bytes; the lock keeps other host accesses away.
        let bytes = unsafe { std::slice::from_raw_parts_mut(mapped, count) };
        write(bytes);
        #[cfg(feature = "conformance")]
        recorder::note(recorder::Event::Written {
            buffer: &self.name,
            offset,
            bytes,
        });
        Ok(())
    }

    /// Copies from `offset` into `data` what the device has finished writing.
    pub fn read(&self, offset: u64, data: &mut [u8]) -> Result<(), Error> {
        let mapped = self.mapped("read", offset, data.len())?;
        let _one_at_a_time = self
            .host_access
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        // SAFETY: as in `write_with`.
        unsafe { std::ptr::copy_nonoverlapping(mapped, data.as_mut_ptr(), data.len()) };
        #[cfg(feature = "conformance")]
        recorder::note(recorder::Event::Read {
            buffer: &self.name,
            offset,
            bytes: data,
        });
        Ok(())
    }

    /// The mapped byte at `offset`, of which `count` lie inside the buffer.
    fn mapped(&self, verb: &str, offset: u64, count: usize) -> Result<*mut u8, Error> {
        let doing = || format!("{verb} {count} bytes at {offset} of buffer `{}`", self.name);
        let is_inside = offset
            .checked_add(count as u64)
            .is_some_and(|end| end <= self.bytes);
        if !is_inside {
            let wanted = format!("a range inside its {} bytes", self.bytes);
            return Err(Error::Argument {
                doing: doing(),
                wanted,
                found: "one that ends outside".into(),
            });
        }
        // Some devices map all their memory: the answer is the same on every one.
        let is_reached = self.reached_by != Memory::Device;
        let mapped = self.memory.get().mapped_ptr().filter(|_| is_reached);
        let mapped = mapped.ok_or_else(|| Error::Argument {
            doing: doing(),
            wanted: "memory that the host reaches".into(),
            found: "device memory".into(),
        })?;
        // SAFETY: the allocation holds at least `bytes` bytes, and `offset` does not pass them.
        Ok(unsafe { mapped.cast::<u8>().as_ptr().add(offset as usize) })
    }
}
