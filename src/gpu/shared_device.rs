//! A device of our own and its queues, for one thread or for several with a [`Headless`] each.

use super::{
    API_VERSION, DeviceChoice, Error, Gpu, Headless, HostDevice, Options, Validation,
    ValidationMode, cache, instance::Candidate, instance::OwnInstance, own_device::OwnDevice,
    validation::Messages,
};
use std::sync::Arc;

/// A device and the queues that were asked for, as far as it has so many.
#[derive(Debug)]
pub struct SharedDevice {
    own: Arc<OwnDevice>,
    from: Candidate,
    messages: Option<Arc<Messages>>,
}

impl SharedDevice {
    /// Makes a device with up to so many queues.
    ///
    /// # Errors
    /// As [`Headless::new`].
    pub fn new(choice: &DeviceChoice, validation: Validation, queues: u32) -> Result<Self, Error> {
        let mode = validation.mode()?;
        Self::of(OwnInstance::new(mode)?, mode, choice, queues)
    }

    pub(super) fn of(
        instance: OwnInstance,
        mode: Option<ValidationMode>,
        choice: &DeviceChoice,
        queues: u32,
    ) -> Result<Self, Error> {
        let messages = instance.messages().cloned();
        let is_usable = |device: &Candidate| instance.report(device).is_usable();
        let from = choice.pick(instance.devices()?, is_usable)?;
        instance.report(&from).require()?;
        Ok(Self {
            own: Arc::new(OwnDevice::new(instance, &from, mode, queues)?),
            from,
            messages,
        })
    }

    /// How many queues there are.
    pub fn queues(&self) -> usize {
        self.own.queues.len()
    }

    /// What the `user`th of its users, from 0, works with: a queue, which it has for itself where there are as many as
    /// users, and memory and a command buffer of its own. Pipelines are shared. The device lives until the last of these
    /// is gone.
    ///
    /// # Errors
    /// As [`Headless::new`].
    pub fn headless(&self, user: usize, options: &Options) -> Result<Headless, Error> {
        let own = &self.own;
        let cache_file = options.pipeline_cache.file(&self.from.identity);
        let pipeline_cache = cache_file.as_deref().map(cache::load).unwrap_or_default();
        let host = HostDevice {
            get_instance_proc_addr: own.instance.entry().static_fn().get_instance_proc_addr,
            instance: own.instance.raw().handle(),
            physical_device: self.from.physical_device,
            device: own.device.handle(),
            queue_family: own.queue_family,
            api_version: API_VERSION,
            features: own.features,
            debug_utils: self.messages.is_some(),
            caps: options.caps,
            pipeline_cache: &pipeline_cache,
        };
        // SAFETY: the handles are our own and live in `own`, of which the `Gpu` has a share.
        let gpu = unsafe { Gpu::new(host, Some(Arc::clone(own)))? };
        let queue = Arc::clone(&own.queues[user % own.queues.len()]);
        Headless::on(gpu, queue, cache_file, self.messages.clone())
    }
}
