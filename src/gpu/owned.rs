//! Who owns a raw object, and what becomes of it when its owner is dropped.
//!
//! An owner's `Drop` never waits: it hands the raw object to the [`Store`] with the newest value that
//! the timeline was announced to reach. [`Store::retire`] destroys what the timeline has passed.

use super::sets::{Set, Sets};
use super::{Error, Gpu, LARGEST_BLOCK_BYTES, MemoryUse, error::within, memory::BUDGET};
use ash::vk;
use gpu_allocator::AllocationError;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme, Allocator};
use std::{
    collections::{BTreeMap, VecDeque},
    sync::Arc,
};

/// A raw object together with the duty to destroy it once, when the GPU is done with it.
#[derive(Debug)]
pub(crate) struct Own<H: Handle> {
    gpu: Arc<Gpu>,
    handle: H,
}

impl<H: Handle> Own<H> {
    /// Takes over a handle that was just created on `gpu`'s device.
    pub fn new(gpu: &Arc<Gpu>, handle: H) -> Self {
        gpu.store().adopt(H::WORD);
        Self {
            gpu: Arc::clone(gpu),
            handle,
        }
    }

    pub fn get(&self) -> H {
        self.handle
    }

    pub fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }
}

impl<H: Handle> Drop for Own<H> {
    fn drop(&mut self) {
        self.gpu.store().discard(self.handle.into());
    }
}

/// Memory of one buffer or image, with the duty to free it.
#[derive(Debug)]
pub(crate) struct OwnMemory {
    gpu: Arc<Gpu>,
    allocation: Option<Allocation>,
}

impl OwnMemory {
    /// Allocates, after `desc` was compared with the limits. `alone` stands for memory of its own. `doing` follows the
    /// word "cannot".
    pub fn new(
        gpu: &Arc<Gpu>,
        desc: &AllocationCreateDesc<'_>,
        alone: AllocationScheme,
        doing: impl Fn() -> String,
    ) -> Result<Self, Error> {
        let limits = gpu.limits();
        let size = desc.requirements.size;
        within(
            &doing,
            "maxMemoryAllocationSize",
            size,
            limits.max_allocation_bytes,
        )?;
        within(
            &doing,
            "the largest memory heap",
            size,
            limits.max_heap_bytes,
        )?;
        let most = limits.max_allocations;
        let allocation = gpu.store().allocate(desc, alone, most, &doing)?;
        Ok(Self {
            gpu: Arc::clone(gpu),
            allocation: Some(allocation),
        })
    }

    pub fn get(&self) -> &Allocation {
        self.allocation
            .as_ref()
            .expect("memory is taken only by drop")
    }
}

impl Drop for OwnMemory {
    fn drop(&mut self) {
        if let Some(allocation) = self.allocation.take() {
            self.gpu.store().discard(Raw::Memory(allocation));
        }
    }
}

/// A kind of raw object that we create and destroy.
pub(crate) trait Handle: Copy + std::fmt::Debug + Into<Raw> {
    /// What live objects of this kind are counted under.
    const WORD: &'static str;
}

macro_rules! handles {
    ($($kind:ident $handle:ty, $word:literal, $destroy:ident;)*) => {
        /// A raw object without its owner.
        #[derive(Debug)]
        pub(crate) enum Raw {
            $($kind($handle),)*
            Set(Set),
            Memory(Allocation),
        }

        $(
            impl From<$handle> for Raw {
                fn from(handle: $handle) -> Self {
                    Self::$kind(handle)
                }
            }

            impl Handle for $handle {
                const WORD: &'static str = $word;
            }
        )*

        impl Raw {
            fn word(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => $word,)*
                    Self::Set(_) => Set::WORD,
                    Self::Memory(_) => "memory",
                }
            }

            /// # Safety
            /// The object belongs to `device`, whose store this is and which has finished with it.
            unsafe fn destroy(self, device: &ash::Device, store: &mut Store) {
                match self {
                    // SAFETY: the caller's promise is what each of these calls asks.
                    $(Self::$kind(handle) => unsafe { device.$destroy(handle, None) },)*
                    // SAFETY: as above.
                    Self::Set(set) => unsafe { store.sets.free(device, set) },
                    Self::Memory(allocation) => {
                        let freed = store.allocator.as_mut().map(|allocator| allocator.free(allocation));
                        debug_assert!(matches!(freed, Some(Ok(()))), "memory freed twice: {freed:?}");
                    }
                }
            }
        }
    };
}

handles! {
    Buffer vk::Buffer, "buffer", destroy_buffer;
    Image vk::Image, "image", destroy_image;
    ImageView vk::ImageView, "image view", destroy_image_view;
    Sampler vk::Sampler, "sampler", destroy_sampler;
    SetLayout vk::DescriptorSetLayout, "descriptor set layout", destroy_descriptor_set_layout;
    PipelineLayout vk::PipelineLayout, "pipeline layout", destroy_pipeline_layout;
    Pipeline vk::Pipeline, "pipeline", destroy_pipeline;
    ShaderModule vk::ShaderModule, "shader module", destroy_shader_module;
    QueryPool vk::QueryPool, "query pool", destroy_query_pool;
    CommandPool vk::CommandPool, "command pool", destroy_command_pool;
    Fence vk::Fence, "fence", destroy_fence;
    Semaphore vk::Semaphore, "semaphore", destroy_semaphore;
    Event vk::Event, "event", destroy_event;
}

impl From<Set> for Raw {
    fn from(set: Set) -> Self {
        Self::Set(set)
    }
}

impl Handle for Set {
    const WORD: &'static str = "descriptor set";
}

/// What the allocator hands on as text only.
const SAID: [vk::Result; 2] = [
    vk::Result::ERROR_OUT_OF_HOST_MEMORY,
    vk::Result::ERROR_OUT_OF_DEVICE_MEMORY,
];

/// The allocator, what is alive, and what waits for the timeline.
#[derive(Debug)]
pub(super) struct Store {
    /// `None` only while the device goes: memory is freed before it.
    allocator: Option<Allocator>,
    /// Where descriptor sets come from.
    pub sets: Sets,
    /// The newest value that a recording was announced to reach.
    announced: u64,
    /// In the order of their values, and of one owner's parts: an image before its memory.
    waiting: VecDeque<(u64, Raw)>,
    live: BTreeMap<&'static str, usize>,
    /// Bytes of memory that have an owner.
    owned_bytes: u64,
    /// The most that was taken from the driver at once.
    peak_bytes: u64,
    /// The most that may be.
    budget_bytes: Option<u64>,
}

impl Store {
    pub fn new(allocator: Allocator) -> Self {
        Self {
            allocator: Some(allocator),
            sets: Sets::default(),
            announced: 0,
            waiting: VecDeque::new(),
            live: BTreeMap::new(),
            owned_bytes: 0,
            peak_bytes: 0,
            budget_bytes: None,
        }
    }

    /// Values only rise: what is dropped from now on waits for the largest one.
    pub fn announce(&mut self, value: u64) {
        self.announced = self.announced.max(value);
    }

    fn adopt(&mut self, word: &'static str) {
        *self.live.entry(word).or_default() += 1;
    }

    fn discard(&mut self, raw: Raw) {
        if let Raw::Memory(allocation) = &raw {
            self.owned_bytes = self.owned_bytes.saturating_sub(allocation.size());
        }
        self.waiting.push_back((self.announced, raw));
    }

    /// # Safety
    /// `device` is the one everything was created on and has finished all work up to `completed`.
    pub unsafe fn retire(&mut self, device: &ash::Device, completed: u64) {
        while self
            .waiting
            .front()
            .is_some_and(|&(value, _)| value <= completed)
        {
            let (_, raw) = self.waiting.pop_front().expect("the front was just seen");
            let live = self.live.entry(raw.word()).or_default();
            *live = live.saturating_sub(1);
            // SAFETY: the caller promises that work up to this object's value is done.
            unsafe { raw.destroy(device, self) };
        }
    }

    /// # Safety
    /// As [`Store::retire`], for all work; nothing is created afterwards.
    pub unsafe fn destroy_all(&mut self, device: &ash::Device) {
        // SAFETY: the caller's promise.
        unsafe {
            self.retire(device, u64::MAX);
            self.sets.destroy_all(device);
        }
        self.allocator = None;
    }

    pub fn live(&self) -> BTreeMap<&'static str, usize> {
        self.live
            .iter()
            .filter(|&(_, &count)| count > 0)
            .map(|(&word, &count)| (word, count))
            .collect()
    }

    /// Bytes that are allocated from the driver, whether in use or kept for later.
    fn reserved_bytes(&self) -> u64 {
        self.allocator.as_ref().map_or(0, Allocator::capacity)
    }

    pub fn set_budget(&mut self, bytes: Option<u64>) {
        self.budget_bytes = bytes;
    }

    /// Without the driver's word.
    pub fn memory(&self) -> MemoryUse {
        let blocks = |allocator: &Allocator| allocator.generate_report().blocks.len() as u64;
        MemoryUse {
            budget_bytes: self.budget_bytes,
            used_bytes: self.owned_bytes,
            reserved_bytes: self.reserved_bytes(),
            peak_bytes: self.peak_bytes,
            allocations: self.allocator.as_ref().map_or(0, blocks),
            heaps: Vec::new(),
        }
    }

    fn allocate(
        &mut self,
        desc: &AllocationCreateDesc<'_>,
        alone: AllocationScheme,
        max_allocations: u64,
        doing: impl Fn() -> String,
    ) -> Result<Allocation, Error> {
        let mut desc = desc.clone();
        if let Some(budget) = self.budget_bytes {
            let (size, reserved) = (desc.requirements.size, self.reserved_bytes());
            within(&doing, BUDGET, reserved.saturating_add(size), budget)?;
            if reserved.saturating_add(size.max(LARGEST_BLOCK_BYTES)) > budget {
                desc.allocation_scheme = alone;
            }
        }
        let allocator = self
            .allocator
            .as_mut()
            .expect("the allocator outlives every owner");
        // Blocks hold one allocation or more, and one block for each of at most 32 memory types may stand empty:
        // counting the blocks costs a walk over all of them, so it is done near the limit only,
        // and one allocation that would still find room in a block may be refused there.
        let live = *self.live.get("memory").unwrap_or(&0) as u64;
        if live + vk::MAX_MEMORY_TYPES as u64 >= max_allocations {
            let blocks = allocator.generate_report().blocks.len() as u64;
            within(
                &doing,
                "maxMemoryAllocationCount",
                blocks + 1,
                max_allocations,
            )?;
        }
        let allocation = allocator.allocate(&desc).map_err(|cause| match &cause {
            AllocationError::OutOfMemory => {
                Error::vulkan(doing(), vk::Result::ERROR_OUT_OF_DEVICE_MEMORY)
            }
            AllocationError::Internal(text) | AllocationError::FailedToMap(text) => {
                match SAID.into_iter().find(|result| {
                    text.contains(&format!("{result:?}")) || text.contains(&result.to_string())
                }) {
                    Some(result) => Error::vulkan(doing(), result),
                    None => Error::Allocation {
                        doing: doing(),
                        cause,
                    },
                }
            }
            _ => Error::Allocation {
                doing: doing(),
                cause,
            },
        })?;
        self.adopt("memory");
        self.owned_bytes = self.owned_bytes.saturating_add(allocation.size());
        self.peak_bytes = self.peak_bytes.max(self.reserved_bytes());
        Ok(allocation)
    }
}
