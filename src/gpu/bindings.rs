//! Resources bound to the names that shaders give them.

use super::{
    Buffer, Error, Gpu, Image, Layout, ParameterRing, Sampler, layout::descriptor_type, owned::Own,
    sets::Set,
};
use crate::shaders::{BindingKind, BindingSlot};
use ash::vk;
use std::sync::Arc;

/// What can be bound to a name.
#[derive(Clone, Copy, Debug)]
pub enum Resource<'a> {
    /// The slots of a ring; which one is said when recording, as a dynamic offset.
    Uniform(&'a ParameterRing),
    /// All of a buffer.
    Storage(&'a Buffer),
    /// An image to sample or fetch from, and the layout it will be in.
    Texture(vk::ImageView, vk::ImageLayout),
    /// A sampler.
    Sampler(&'a Sampler),
    /// An image to write, or to read without a sampler, in layout `GENERAL`.
    StorageImage(vk::ImageView),
}

impl<'a> Resource<'a> {
    /// An image of ours that is read in [`super::Use::ComputeSampled`] or [`super::Use::FragmentSampled`].
    pub fn sampled(image: &Image) -> Self {
        Self::Texture(image.view(), vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)
    }

    /// An image of ours that is sampled in [`super::Use::SampledOrRead`].
    pub fn sampled_or_read(image: &Image) -> Self {
        Self::Texture(image.view(), vk::ImageLayout::GENERAL)
    }

    /// An image of ours that is read in [`super::Use::ComputeRead`] or [`super::Use::SampledOrRead`].
    pub fn read(image: &Image) -> Self {
        Self::StorageImage(image.view())
    }

    /// An image of ours that is written in [`super::Use::ComputeWrite`].
    pub fn written(image: &Image) -> Self {
        Self::StorageImage(image.view())
    }
}

/// One descriptor set, written once.
#[derive(Debug)]
pub struct Bindings {
    set: Own<Set>,
}

impl Bindings {
    /// Binds each name that `layout` declares to one resource.
    ///
    /// # Errors
    ///
    /// A name that is missing, superfluous or given twice, and a resource of the wrong kind or size, by name.
    pub fn new(
        gpu: &Arc<Gpu>,
        layout: &Layout,
        resources: &[(&str, Resource<'_>)],
    ) -> Result<Self, Error> {
        let doing = || format!("make the descriptor set of `{}`", layout.name());
        let infos = match_names(layout, resources)?;
        let set = Own::of(gpu, layout, doing)?;
        gpu.name(set.get().raw, layout.name());
        let writes: Vec<_> = layout
            .slots()
            .iter()
            .zip(&infos)
            .map(|(slot, info)| info.write(set.get().raw, slot))
            .collect();
        // SAFETY: the set is in no use yet; the resources are of the kinds that its layout declares.
        unsafe { gpu.device().update_descriptor_sets(&writes, &[]) };
        Ok(Self { set })
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::DescriptorSet {
        self.set.get().raw
    }

    /// The device that the bindings were made on.
    pub fn gpu(&self) -> &Arc<Gpu> {
        self.set.gpu()
    }
}

impl Drop for Bindings {
    /// A set that is freed keeps its name in lavapipe (Mesa 22.3).
    fn drop(&mut self) {
        self.gpu().unname(self.raw());
    }
}

/// What a descriptor points to.
enum Info {
    Buffer([vk::DescriptorBufferInfo; 1]),
    Image([vk::DescriptorImageInfo; 1]),
}

impl Info {
    fn write(&self, set: vk::DescriptorSet, slot: &BindingSlot) -> vk::WriteDescriptorSet<'_> {
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(slot.binding)
            .descriptor_type(descriptor_type(slot.kind));
        match self {
            Self::Buffer(info) => write.buffer_info(info),
            Self::Image(info) => write.image_info(info),
        }
    }
}

/// One info for each slot, in the order of the slots.
fn match_names(layout: &Layout, resources: &[(&str, Resource<'_>)]) -> Result<Vec<Info>, Error> {
    let wrong = |problem: String| Error::Binding {
        shader: format!("`{}`", layout.name()),
        problem,
    };
    for (k, (name, _)) in resources.iter().enumerate() {
        if !layout.slots().iter().any(|slot| slot.name == *name) {
            let declared: Vec<_> = layout.slots().iter().map(|slot| slot.name).collect();
            return Err(wrong(format!(
                "it has no `{name}`, it declares {}",
                declared.join(", ")
            )));
        }
        if resources[..k].iter().any(|(earlier, _)| earlier == name) {
            return Err(wrong(format!("`{name}` is given twice")));
        }
    }
    let find = |slot: &BindingSlot| {
        let (_, resource) = resources
            .iter()
            .find(|(name, _)| *name == slot.name)
            .ok_or_else(|| wrong(format!("nothing is given for `{}`", slot.name)))?;
        info(slot, resource).map_err(|problem| wrong(format!("`{}` {problem}", slot.name)))
    };
    layout.slots().iter().map(find).collect()
}

fn info(slot: &BindingSlot, resource: &Resource<'_>) -> Result<Info, String> {
    let image = |view, layout, sampler| {
        Ok(Info::Image([vk::DescriptorImageInfo {
            image_view: view,
            image_layout: layout,
            sampler,
        }]))
    };
    match (slot.kind, *resource) {
        (BindingKind::Uniform(bytes), Resource::Uniform(ring)) => {
            if ring.slot_bytes() < bytes {
                return Err(format!(
                    "takes {bytes} bytes, a slot of the ring has {}",
                    ring.slot_bytes()
                ));
            }
            Ok(Info::Buffer([vk::DescriptorBufferInfo {
                buffer: ring.raw(),
                offset: 0,
                range: bytes.into(),
            }]))
        }
        (BindingKind::Storage, Resource::Storage(buffer)) => {
            if !buffer
                .usage()
                .contains(vk::BufferUsageFlags::STORAGE_BUFFER)
            {
                return Err(format!(
                    "takes a storage buffer, buffer `{}` was made without that usage",
                    buffer.name()
                ));
            }
            Ok(Info::Buffer([vk::DescriptorBufferInfo {
                buffer: buffer.raw(),
                offset: 0,
                range: vk::WHOLE_SIZE,
            }]))
        }
        (BindingKind::Texture, Resource::Texture(view, layout)) => {
            image(view, layout, vk::Sampler::null())
        }
        (BindingKind::StorageImage, Resource::StorageImage(view)) => {
            image(view, vk::ImageLayout::GENERAL, vk::Sampler::null())
        }
        (BindingKind::Sampler, Resource::Sampler(sampler)) => image(
            vk::ImageView::null(),
            vk::ImageLayout::UNDEFINED,
            sampler.raw(),
        ),
        (kind, found) => Err(format!("takes {kind:?}, found {}", found.word())),
    }
}

impl Resource<'_> {
    fn word(&self) -> &'static str {
        match self {
            Self::Uniform(_) => "a parameter ring",
            Self::Storage(_) => "a buffer",
            Self::Texture(..) => "a texture",
            Self::Sampler(_) => "a sampler",
            Self::StorageImage(_) => "a storage image",
        }
    }
}
