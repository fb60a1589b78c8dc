//! How much memory of the device is ours, and how much it may be.
//!
//! ```text
//! used <= reserved <= budget      used has an owner; reserved is what was taken from the driver, in blocks
//! ```

use super::{Error, Gpu, devices::has_extension, error::within};
use ash::vk;

/// The name of a budget in errors: no limit of Vulkan's.
pub(super) const BUDGET: &str = "the memory budget of the host";

const BUDGET_EXTENSION: &str = "VK_EXT_memory_budget";

/// Memory of a device that is ours.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MemoryUse {
    /// What the host allows ([`Gpu::set_memory_budget`]).
    pub budget_bytes: Option<u64>,
    /// Bytes that have an owner, padded as the driver wants them; what waits to be retired has none, and is reserved
    /// still.
    pub used_bytes: u64,
    /// Bytes taken from the driver, in use or kept for later.
    pub reserved_bytes: u64,
    /// The most bytes that were taken at once.
    pub peak_bytes: u64,
    /// In how many pieces: what `maxMemoryAllocationCount` counts.
    pub allocations: u64,
    /// What the driver says of each heap, where the device has `VK_EXT_memory_budget`; else none.
    pub heaps: Vec<HeapUse>,
}

/// A heap of a device, as all programs use it (`VkPhysicalDeviceMemoryBudgetPropertiesEXT`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HeapUse {
    /// Whether it is memory of the device itself.
    pub is_device_local: bool,
    /// Its size.
    pub bytes: u64,
    /// How much of it this process may use before something fails or becomes slow.
    pub budget_bytes: u64,
    /// How much of it this process uses, the host's own and ours.
    pub used_bytes: u64,
}

impl Gpu {
    /// Takes no more memory from the driver than so many bytes from now on: what would is refused with
    /// [`Error::Limit`], before the driver is asked. What is taken already stays. `None`: no budget but the device's.
    ///
    /// Memory is taken in blocks of 4 to 64 MiB, which count whole; where a block more would be too much, objects get
    /// memory of their own.
    pub fn set_memory_budget(&self, bytes: Option<u64>) {
        self.store().set_budget(bytes);
    }

    /// How much memory is ours, and of what.
    pub fn memory(&self) -> MemoryUse {
        let heaps = self.heaps();
        MemoryUse {
            heaps,
            ..self.store().memory()
        }
    }

    /// Refuses what will take so many bytes in all and does not fit the budget. `doing` follows the word "cannot".
    ///
    /// # Errors
    /// [`Error::Limit`], with what would be reserved then and what is allowed.
    pub fn check_budget(&self, doing: impl Fn() -> String, bytes: u64) -> Result<(), Error> {
        let there = self.store().memory();
        let Some(budget) = there.budget_bytes else {
            return Ok(());
        };
        within(
            doing,
            BUDGET,
            there.reserved_bytes.saturating_add(bytes),
            budget,
        )
    }

    /// Empty where the device has no such extension: it need not be enabled to be asked.
    fn heaps(&self) -> Vec<HeapUse> {
        let (instance, physical_device) = (&self.instance, self.physical_device);
        // SAFETY: the handles are valid.
        let has_budget = || unsafe { has_extension(instance, physical_device, BUDGET_EXTENSION) };
        if !self.tells_heaps.get_or_init(has_budget) {
            return Vec::new();
        }
        let mut budgets = vk::PhysicalDeviceMemoryBudgetPropertiesEXT::default();
        let mut properties = vk::PhysicalDeviceMemoryProperties2::default().push_next(&mut budgets);
        // SAFETY: as above; the device has the extension that the chain is of.
        unsafe {
            instance.get_physical_device_memory_properties2(physical_device, &mut properties);
        }
        let heaps = properties.memory_properties;
        let numbers = budgets.heap_budget.into_iter().zip(budgets.heap_usage);
        let heaps = heaps.memory_heaps_as_slice().iter().zip(numbers);
        heaps
            .map(|(heap, (budget_bytes, used_bytes))| HeapUse {
                is_device_local: heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL),
                bytes: heap.size,
                budget_bytes,
                used_bytes,
            })
            .collect()
    }
}
