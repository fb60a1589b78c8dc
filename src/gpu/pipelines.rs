//! Pipelines of a device of our own, each made once: llvmpipe takes some 17 ms for each of the tests.
//!
//! A host's pipelines go with their owners, since its device must be given back clean; so do those for a render pass of a
//! host's, whose handle may come again for another.

use super::{Blend, DepthUse, Error, Gpu, TargetClass, owned::Own};
#[cfg(feature = "conformance")]
use super::{pipeline::words, recorder};
use crate::shaders::Shader;
use ash::vk;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// All that a pipeline is made of.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Key {
    pub shaders: Vec<Shader>,
    /// Of pipelines that draw.
    pub raster: Option<(vk::PrimitiveTopology, TargetClass, Blend, DepthUse)>,
}

/// The pipelines of a device, by what they are made of.
#[derive(Debug, Default)]
pub(super) struct Pipelines(Mutex<HashMap<Key, vk::Pipeline>>);

impl Pipelines {
    fn map(&self) -> MutexGuard<'_, HashMap<Key, vk::Pipeline>> {
        // Nothing under the lock panics halfway.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// # Safety
    /// The pipelines are of `device`, and nothing uses them any more.
    pub unsafe fn destroy_all(&self, device: &ash::Device) {
        for (_, pipeline) in self.map().drain() {
            // SAFETY: the caller's promise.
            unsafe { device.destroy_pipeline(pipeline, None) };
        }
    }
}

/// A pipeline for its user.
#[derive(Debug)]
pub(crate) enum Pipeline {
    /// The device's, which lives as long as the `Gpu`.
    Kept(Arc<Gpu>, vk::Pipeline),
    /// The user's own.
    Own(Own<vk::Pipeline>),
}

impl Pipeline {
    /// The pipeline of `key`: the device's, where it has one, or what `make` makes.
    pub fn new(
        gpu: &Arc<Gpu>,
        key: Key,
        name: &str,
        make: impl FnOnce() -> Result<vk::Pipeline, Error>,
    ) -> Result<Self, Error> {
        let is_of_pass = key
            .raster
            .is_some_and(|(_, target, ..)| target.pass.is_some());
        let own_device = gpu.own_device.as_ref().filter(|_| !is_of_pass);
        let there = own_device.and_then(|own| own.pipelines.map().get(&key).copied());
        if let Some(raw) = there {
            #[cfg(feature = "conformance")]
            if recorder::is_heard() {
                key.shaders.iter().for_each(|shader| {
                    recorder::note(recorder::Event::Shader {
                        shader,
                        words: &words(gpu, shader),
                    });
                });
            }
            return Ok(Self::Kept(Arc::clone(gpu), raw));
        }
        // Others may look for theirs meanwhile.
        let made = make()?;
        gpu.name(made, name);
        let Some(own_device) = own_device else {
            return Ok(Self::Own(Own::new(gpu, made)));
        };
        let raw = *own_device.pipelines.map().entry(key).or_insert(made);
        if raw != made {
            // Another thread has made it too, and sooner.
            drop(Own::new(gpu, made));
        }
        Ok(Self::Kept(Arc::clone(gpu), raw))
    }

    pub fn get(&self) -> vk::Pipeline {
        match self {
            Self::Kept(_, raw) => *raw,
            Self::Own(own) => own.get(),
        }
    }

    pub fn gpu(&self) -> &Arc<Gpu> {
        match self {
            Self::Kept(gpu, _) => gpu,
            Self::Own(own) => own.gpu(),
        }
    }
}
