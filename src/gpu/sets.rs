//! Descriptor sets out of pools that belong to the device: a new set seldom asks for a new pool.
//!
//! ```text
//! shape(set) = how many descriptors of each type        room(next pool) = room of all pools of its shape before it
//! ```
//!
//! All sets of a pool have one shape. Vulkan promises that freed sets leave no holes then: what fits by number fits.

use super::{Error, Gpu, Layout, layout::descriptor_type, owned::Own};
use crate::shaders::BindingSlot;
use ash::vk::{self, DescriptorType as Type};
use std::sync::Arc;

/// What [`descriptor_type`] says.
const TYPES: [Type; 5] = [
    Type::UNIFORM_BUFFER_DYNAMIC,
    Type::STORAGE_BUFFER,
    Type::SAMPLED_IMAGE,
    Type::SAMPLER,
    Type::STORAGE_IMAGE,
];

type Shape = [u32; TYPES.len()];

/// Sets of the first pool of a shape.
const FIRST: u32 = 8;
/// Empty pools stay for so many times the sets that are in use: a host that changes its function each frame, with
/// three of them in flight, needs up to seven times what it shows.
const SPARE: u32 = 8;

/// A descriptor set, and the pool that it goes back to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Set {
    pub raw: vk::DescriptorSet,
    pool: vk::DescriptorPool,
}

impl Own<Set> {
    /// A set of that layout, in no use. `doing` follows the word "cannot".
    pub fn of(gpu: &Arc<Gpu>, layout: &Layout, doing: impl Fn() -> String) -> Result<Self, Error> {
        let set = gpu.call(doing, |device| gpu.store().sets.take(device, layout))?;
        Ok(Self::new(gpu, set))
    }
}

/// All pools of a device.
#[derive(Debug, Default)]
pub(super) struct Sets(Vec<Pool>);

#[derive(Debug)]
struct Pool {
    raw: vk::DescriptorPool,
    shape: Shape,
    room: u32,
    used: u32,
}

impl Sets {
    fn take(&mut self, device: &ash::Device, layout: &Layout) -> Result<Set, vk::Result> {
        let shape = shape_of(layout.slots());
        let has_room = |pool: &Pool| pool.shape == shape && pool.used < pool.room;
        let at = match self.0.iter().position(has_room) {
            Some(at) => at,
            None => {
                let before = self.0.iter().filter(|pool| pool.shape == shape);
                let room = before.map(|pool| pool.room).sum::<u32>().max(FIRST);
                self.0.push(Pool::new(device, shape, room)?);
                self.0.len() - 1
            }
        };
        let pool = &mut self.0[at];
        let layouts = [layout.set()];
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(pool.raw)
            .set_layouts(&layouts);
        // SAFETY: the pool has room for one more set of this shape; nobody else uses it while the store is locked.
        let raw = unsafe { device.allocate_descriptor_sets(&info) }?[0];
        pool.used += 1;
        Ok(Set {
            raw,
            pool: pool.raw,
        })
    }

    /// Gives a set back, and pools that are too much then.
    ///
    /// # Safety
    /// The set is one of these, and `device` has finished with it.
    pub unsafe fn free(&mut self, device: &ash::Device, set: Set) {
        // SAFETY: the caller's promises; the pool is one of which sets are freed. Vulkan has no way to fail here.
        let _ = unsafe { device.free_descriptor_sets(set.pool, &[set.raw]) };
        let mut pools = self.0.iter_mut();
        let Some(pool) = pools.find(|pool| pool.raw == set.pool) else {
            return debug_assert!(false, "a set of no pool");
        };
        pool.used -= 1;
        if pool.used > 0 {
            return;
        }
        let shape = pool.shape;
        let of_shape = self.0.iter().filter(|pool| pool.shape == shape);
        let used = of_shape.map(|pool| pool.used).sum::<u32>();
        let mut spare = used.saturating_mul(SPARE).max(FIRST);
        self.0.retain(|pool| {
            if pool.shape != shape || pool.used > 0 {
                return true;
            }
            let left = spare.checked_sub(pool.room);
            spare = left.unwrap_or(spare);
            if left.is_none() {
                // SAFETY: no set of it is left.
                unsafe { device.destroy_descriptor_pool(pool.raw, None) };
            }
            left.is_some()
        });
    }

    /// # Safety
    /// `device` has finished with all sets, and none is taken or freed any more.
    pub unsafe fn destroy_all(&mut self, device: &ash::Device) {
        for pool in self.0.drain(..) {
            // SAFETY: the caller's promises.
            unsafe { device.destroy_descriptor_pool(pool.raw, None) };
        }
    }
}

impl Pool {
    fn new(device: &ash::Device, shape: Shape, room: u32) -> Result<Self, vk::Result> {
        let sizes = TYPES.into_iter().zip(shape).filter(|&(_, count)| count > 0);
        let sizes: Vec<_> = sizes
            .map(|(ty, count)| vk::DescriptorPoolSize {
                ty,
                descriptor_count: room * count,
            })
            .collect();
        let info = vk::DescriptorPoolCreateInfo::default()
            .flags(vk::DescriptorPoolCreateFlags::FREE_DESCRIPTOR_SET)
            .max_sets(room)
            .pool_sizes(&sizes);
        // SAFETY: the device is valid.
        let raw = unsafe { device.create_descriptor_pool(&info, None) }?;
        Ok(Self {
            raw,
            shape,
            room,
            used: 0,
        })
    }
}

fn shape_of(slots: &[BindingSlot]) -> Shape {
    let of_type = |ty| {
        slots
            .iter()
            .filter(move |slot| descriptor_type(slot.kind) == ty)
    };
    TYPES.map(|ty| of_type(ty).count() as u32)
}
