//! A device that is lost: heard once, remembered, and not called again.
//!
//! Vulkan lets everything made on a lost device be destroyed, and that is all that is done from then on: no object is
//! made, no command recorded, nothing asked of the device.

use super::{Error, Gpu, error::Doing};
use ash::vk;
use std::sync::atomic::Ordering;

impl Gpu {
    /// True once the device was lost: every call that could fail says so from then on, nothing is recorded, and what
    /// was made can be dropped as ever.
    pub fn is_lost(&self) -> bool {
        self.is_lost.load(Ordering::Relaxed)
    }

    /// A host tells that its device was lost: it submits and waits, so it is the first to hear.
    pub fn declare_lost(&self) {
        self.is_lost.store(true, Ordering::Relaxed);
    }

    /// Refuses what would record nothing. `doing` follows the word "cannot".
    pub(crate) fn check_alive(&self, doing: &str) -> Result<(), Error> {
        self.call(|| doing.into(), |_| Ok(()))
    }

    /// Makes a call that can fail, unless the device is lost. `doing` follows the word "cannot".
    pub(super) fn call<T>(
        &self,
        doing: impl FnOnce() -> String,
        call: impl FnOnce(&ash::Device) -> Result<T, vk::Result>,
    ) -> Result<T, Error> {
        let result = match self.is_lost() {
            true => Err(vk::Result::ERROR_DEVICE_LOST),
            false => call(&self.device),
        };
        if matches!(result, Err(vk::Result::ERROR_DEVICE_LOST)) {
            self.declare_lost();
        }
        result.doing(doing)
    }

    /// Records commands, unless the device is lost: nothing would run them.
    pub(crate) fn record(&self, record: impl FnOnce(&ash::Device)) {
        if !self.is_lost() {
            record(&self.device);
        }
    }
}
