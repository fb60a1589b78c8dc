//! The Khronos validation layer, one mode a run, and the messages it has.
//!
//! `STRATAVOX_VALIDATION` is `core`, `sync`, `gpu` or `best`. Nobody's silence is trusted:
//! `tests/gpu/validation.rs` makes one mistake for each mode and wants it reported.

use super::Error;
use ash::vk;
use std::{
    ffi::{CStr, c_void},
    fmt,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

/// The environment variable that [`Validation::FromEnvironment`] reads.
pub const VARIABLE: &str = "STRATAVOX_VALIDATION";

/// The layer.
pub(super) const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Messages of one device that are kept; more are counted.
const MOST_KEPT: usize = 256;

/// What the layer says when a thread of its own that follows queues, fences and timeline semaphores is late, after ten
/// seconds (it misspells "likely" of fences): seen with threads that share a queue on a machine whose cores are all busy.
const LAYERS_OWN: &str = "state to update. This is most lik";
const LAYERS_OWN_REASON: &str =
    "a wait inside of the layer; work that stands still ends our waits with an error of ours";

/// Complaints that we know and do not heed: the mode, the id, a part of the text, and the reason.
const ALLOWED: &[(ValidationMode, &str, &str, &str)] = &[
    (
        ValidationMode::Core,
        "UNASSIGNED-VkSemaphore-state-timeout",
        LAYERS_OWN,
        LAYERS_OWN_REASON,
    ),
    (
        ValidationMode::Core,
        "UNASSIGNED-VkFence-state-timeout",
        LAYERS_OWN,
        LAYERS_OWN_REASON,
    ),
    (
        ValidationMode::Core,
        "UNASSIGNED-VkQueue-state-timeout",
        LAYERS_OWN,
        LAYERS_OWN_REASON,
    ),
    (
        ValidationMode::Synchronization,
        "UNASSIGNED-VkSemaphore-state-timeout",
        LAYERS_OWN,
        LAYERS_OWN_REASON,
    ),
    (
        ValidationMode::Synchronization,
        "UNASSIGNED-VkFence-state-timeout",
        LAYERS_OWN,
        LAYERS_OWN_REASON,
    ),
    (
        ValidationMode::Synchronization,
        "UNASSIGNED-VkQueue-state-timeout",
        LAYERS_OWN,
        LAYERS_OWN_REASON,
    ),
    (
        ValidationMode::BestPractices,
        "UNASSIGNED-BestPractices-vkCreateInstance-specialuse-extension-debugging",
        "",
        "the extensions by which the layer itself is asked for",
    ),
    (
        ValidationMode::GpuAssisted,
        "UNASSIGNED-GPU-Assisted Validation Warning",
        "No buffer device address checking",
        "devices without shaderInt64: we use no buffer addresses",
    ),
];

/// Whether a [`super::Headless`] is validated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Validation {
    /// As the environment variable [`VARIABLE`] says; off where it is not set.
    #[default]
    FromEnvironment,
    /// No.
    Off,
    /// In this mode, or not at all: a layer that is missing is an error.
    On(ValidationMode),
}

/// What the layer looks for. Its documentation asks for one at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValidationMode {
    /// Arguments, layouts, lifetimes, threads.
    Core,
    /// Missing barriers.
    Synchronization,
    /// Accesses outside of buffers, seen by instrumented shaders.
    GpuAssisted,
    /// What is legal and unwise.
    BestPractices,
}

impl ValidationMode {
    /// The word in [`VARIABLE`].
    pub fn word(self) -> &'static str {
        match self {
            Self::Core => "core",
            Self::Synchronization => "sync",
            Self::GpuAssisted => "gpu",
            Self::BestPractices => "best",
        }
    }

    fn of(word: &str) -> Option<Self> {
        let modes = [
            Self::Core,
            Self::Synchronization,
            Self::GpuAssisted,
            Self::BestPractices,
        ];
        modes.into_iter().find(|mode| mode.word() == word)
    }

    /// What the layer has to be told beyond its presence.
    pub(super) fn enables(self) -> &'static [vk::ValidationFeatureEnableEXT] {
        use vk::ValidationFeatureEnableEXT as Enable;
        match self {
            Self::Core => &[],
            Self::Synchronization => &[Enable::SYNCHRONIZATION_VALIDATION],
            Self::GpuAssisted => &[
                Enable::GPU_ASSISTED,
                Enable::GPU_ASSISTED_RESERVE_BINDING_SLOT,
            ],
            Self::BestPractices => &[Enable::BEST_PRACTICES],
        }
    }
}

impl Validation {
    /// The mode that is wanted, if any.
    pub fn mode(self) -> Result<Option<ValidationMode>, Error> {
        match self {
            Self::Off => Ok(None),
            Self::On(mode) => Ok(Some(mode)),
            Self::FromEnvironment => {
                let Some(text) = std::env::var_os(VARIABLE).filter(|text| !text.is_empty()) else {
                    return Ok(None);
                };
                let mode = text.to_str().and_then(ValidationMode::of);
                mode.map(Some).ok_or_else(|| Error::Environment {
                    variable: VARIABLE,
                    found: text.to_string_lossy().escape_default().to_string(),
                    wanted: "core, sync, gpu or best",
                })
            }
        }
    }
}

/// One complaint of the layer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// `VUID-...`, `SYNC-HAZARD-...`, `UNASSIGNED-...`.
    pub id: String,
    /// True for an error, false for a warning.
    pub is_error: bool,
    /// What the layer says.
    pub text: String,
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = if self.is_error { "error" } else { "warning" };
        write!(f, "validation {severity} {}: {}", self.id, self.text)
    }
}

/// The messages of one instance that nobody has taken yet.
///
/// None is lost: when the instance is gone, what is left is printed, and the program panics (unless it
/// panics already), because validation is on to find mistakes.
#[derive(Debug)]
pub(super) struct Messages {
    mode: ValidationMode,
    collected: Mutex<Collected>,
}

#[derive(Debug, Default)]
struct Collected {
    kept: Vec<Message>,
    beyond: u64,
}

impl Messages {
    pub fn new(mode: ValidationMode) -> Arc<Self> {
        Arc::new(Self {
            mode,
            collected: Mutex::default(),
        })
    }

    /// Removes and returns what has come in. Beyond [`MOST_KEPT`], a last message gives their number.
    pub fn take(&self) -> Vec<Message> {
        let Collected { mut kept, beyond } = std::mem::take(&mut *self.lock());
        if beyond > 0 {
            let text = format!("{beyond} more messages were not kept");
            kept.push(Message {
                id: "stratavox".into(),
                is_error: true,
                text,
            });
        }
        kept
    }

    /// A messenger that collects here.
    ///
    /// `self` must live until the messenger, and the instance made with it, are destroyed.
    pub fn messenger(self: &Arc<Self>) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
        use vk::{
            DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type,
        };
        // The loader and drivers speak in GENERAL; the layer speaks in the other two.
        vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(Severity::ERROR | Severity::WARNING)
            .message_type(Type::VALIDATION | Type::PERFORMANCE)
            .pfn_user_callback(Some(collect))
            .user_data(Arc::as_ptr(self).cast_mut().cast())
    }

    fn add(&self, message: Message) {
        let is_allowed = ALLOWED.iter().any(|&(mode, id, part, _reason)| {
            mode == self.mode && id == message.id && message.text.contains(part)
        });
        if is_allowed {
            return;
        }
        let mut collected = self.lock();
        if collected.kept.len() < MOST_KEPT {
            collected.kept.push(message);
        } else {
            collected.beyond += 1;
        }
    }

    fn lock(&self) -> MutexGuard<'_, Collected> {
        self.collected
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Messages {
    fn drop(&mut self) {
        let left = self.take();
        for message in &left {
            eprintln!("{message}");
        }
        let mode = self.mode.word();
        if !left.is_empty() && !std::thread::panicking() {
            panic!("{} messages of {VARIABLE}={mode}; see above", left.len());
        }
    }
}

/// # Safety
/// `data` is the layer's, valid during the call; `messages` is the [`Messages`] that the messenger was made by.
unsafe extern "system" fn collect(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the caller's promise.
    let (data, messages) = unsafe { (&*data, &*messages.cast::<Messages>()) };
    let text = |text: *const std::ffi::c_char| {
        if text.is_null() {
            return String::new();
        }
        // SAFETY: the layer's texts end with a zero.
        unsafe { CStr::from_ptr(text) }
            .to_string_lossy()
            .into_owned()
    };
    messages.add(Message {
        id: text(data.p_message_id_name),
        is_error: severity.contains(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR),
        text: text(data.p_message),
    });
    vk::FALSE
}
