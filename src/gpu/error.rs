//! What can go wrong between us and Vulkan, in one sentence each.

use super::Finding;
use ash::vk;

/// What was being done on the GPU, to what, and why it was refused.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The Vulkan loader is not on this machine.
    #[error("cannot load the Vulkan loader: {cause}")]
    NoLoader {
        /// What the system said.
        cause: ash::LoadingError,
    },
    /// A loader, but no driver that finds a device.
    #[error("no Vulkan device: the loader works, but no installed driver offers a device")]
    NoDriver,
    /// There are devices, but not the one asked for.
    #[error("no Vulkan device matches {wanted}; there are: {}", list(devices))]
    NoMatch {
        /// What was asked for.
        wanted: String,
        /// What there is, in the order of their index.
        devices: Vec<String>,
    },
    /// An instance or a device that is too old.
    #[error("{what} speaks Vulkan {found}, wanted {wanted} or later")]
    ApiVersion {
        /// The loader, the host's instance or a device.
        what: String,
        /// The version that we need.
        wanted: String,
        /// The version that was found.
        found: String,
    },
    /// The device cannot do (or the host did not enable) what nothing can be drawn without.
    #[error("{device} lacks {}", missing.iter().map(Finding::to_string).collect::<Vec<_>>().join(", "))]
    Unfit {
        /// The device.
        device: String,
        /// Each requirement that is not met, what is wanted and what was found.
        missing: Vec<Finding>,
    },
    /// Validation was asked for and cannot be had.
    #[error(
        "validation mode `{mode}` needs {missing}, which is not installed \
         (Debian and Ubuntu: package vulkan-validationlayers)"
    )]
    NoValidation {
        /// The word that asked for it.
        mode: &'static str,
        /// The layer or the extension of the layer.
        missing: &'static str,
    },
    /// An environment variable says something that we do not know.
    #[error("environment variable {variable} is `{found}`, wanted {wanted}")]
    Environment {
        /// The variable.
        variable: &'static str,
        /// Its text, escaped.
        found: String,
        /// The words that would do.
        wanted: &'static str,
    },
    /// More than the device (or the clamp that the caller set) allows.
    #[error("cannot {doing}: {limit} allows {allowed}, wanted {wanted}")]
    Limit {
        /// What was being done, to what.
        doing: String,
        /// The limit by the name that the Vulkan specification gives it.
        limit: &'static str,
        /// What was wanted.
        wanted: u64,
        /// What is allowed.
        allowed: u64,
    },
    /// The device cannot use a format this way.
    #[error("cannot {doing}: this device has no {lacks} for {format:?}")]
    Format {
        /// What was being done, to what.
        doing: String,
        /// The format.
        format: vk::Format,
        /// The use that it does not support.
        lacks: &'static str,
    },
    /// Whoever waits wants no more of it ([`Headless::stop_when`](super::Headless::stop_when)).
    #[error("stopped between two submissions")]
    Stopped,
    /// An argument that no device would take.
    #[error("cannot {doing}: wanted {wanted}, found {found}")]
    Argument {
        /// What was being done, to what.
        doing: String,
        /// What would do.
        wanted: String,
        /// What was given.
        found: String,
    },
    /// The resources given do not fit what a shader declares.
    #[error("cannot bind resources to {shader}: {problem}")]
    Binding {
        /// The shader or pipeline.
        shader: String,
        /// Which name, and what is wrong with it.
        problem: String,
    },
    /// There is not enough memory.
    #[error("cannot {doing}: out of {memory} memory")]
    OutOfMemory {
        /// What was being done, to what.
        doing: String,
        /// `host` or `device`.
        memory: &'static str,
    },
    /// The allocator refused for another reason than lack of memory.
    #[error("cannot {doing}: {cause}")]
    Allocation {
        /// What was being done, to what.
        doing: String,
        /// The allocator's word.
        #[source]
        cause: gpu_allocator::AllocationError,
    },
    /// The device is gone; everything made on it is lost, and destroying it stays safe.
    #[error("cannot {doing}: the device was lost")]
    DeviceLost {
        /// What was being done when it was noticed.
        doing: String,
    },
    /// Any other refusal by the driver.
    #[error("cannot {doing}: {result}")]
    Vulkan {
        /// What was being done, to what.
        doing: String,
        /// The driver's word.
        #[source]
        result: vk::Result,
    },
}

fn list(devices: &[String]) -> String {
    let numbered = devices
        .iter()
        .enumerate()
        .map(|(index, name)| format!("{index}: {name}"));
    numbered.collect::<Vec<_>>().join(", ")
}

impl Error {
    /// A driver's refusal, sorted into what a caller can act upon.
    pub(super) fn vulkan(doing: impl Into<String>, result: vk::Result) -> Self {
        let doing = doing.into();
        match result {
            vk::Result::ERROR_DEVICE_LOST => Self::DeviceLost { doing },
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => Self::OutOfMemory {
                doing,
                memory: "device",
            },
            vk::Result::ERROR_OUT_OF_HOST_MEMORY => Self::OutOfMemory {
                doing,
                memory: "host",
            },
            result => Self::Vulkan { doing, result },
        }
    }
}

/// Says what was being done when a call failed.
pub(super) trait Doing<T> {
    /// `doing` follows the word "cannot".
    fn doing(self, doing: impl FnOnce() -> String) -> Result<T, Error>;
}

impl<T> Doing<T> for Result<T, vk::Result> {
    fn doing(self, doing: impl FnOnce() -> String) -> Result<T, Error> {
        self.map_err(|result| Error::vulkan(doing(), result))
    }
}

/// Refuses `wanted` beyond `allowed`.
pub(super) fn within(
    doing: impl FnOnce() -> String,
    limit: &'static str,
    wanted: u64,
    allowed: u64,
) -> Result<(), Error> {
    if wanted <= allowed {
        return Ok(());
    }
    Err(Error::Limit {
        doing: doing(),
        limit,
        wanted,
        allowed,
    })
}
