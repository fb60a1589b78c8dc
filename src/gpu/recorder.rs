//! What passes between the host and a device, told to one listener: for dumps of conformance cases.

use crate::shaders::Shader;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Something that the library asks of the device.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// A shader was loaded.
    Shader {
        shader: &'a Shader,
        /// Its SPIR-V, as the driver gets it.
        words: &'a [u32],
    },
    /// The host wrote to a buffer.
    Written {
        /// Its name.
        buffer: &'a str,
        /// Where, in bytes.
        offset: u64,
        /// What.
        bytes: &'a [u8],
    },
    /// The host read from a buffer.
    Read {
        /// Its name.
        buffer: &'a str,
        /// Where, in bytes.
        offset: u64,
        /// What.
        bytes: &'a [u8],
    },
    /// Workgroups were recorded.
    Dispatch {
        /// The compute shader.
        shader: &'a str,
        /// The first workgroup.
        base: [u32; 3],
        /// How many, along each axis.
        groups: [u32; 3],
    },
    /// As many workgroups were recorded as a buffer says.
    DispatchIndirect {
        /// The compute shader.
        shader: &'a str,
        /// The name of the buffer.
        buffer: &'a str,
    },
    /// A draw was recorded.
    Draw {
        /// The shaders.
        shader: &'a str,
        /// How many vertices.
        vertices: u32,
        /// The first instance and the one behind the last.
        instances: [u32; 2],
    },
    /// A draw was recorded of as much as a buffer says.
    DrawIndirect {
        /// The shaders.
        shader: &'a str,
        /// The name of the buffer.
        buffer: &'a str,
    },
    /// What was recorded was submitted, and the device has done it.
    Submitted,
}

type Listener = Box<dyn FnMut(&Event<'_>) + Send>;

static IS_HEARD: AtomicBool = AtomicBool::new(false);
static LISTENER: Mutex<Option<Listener>> = Mutex::new(None);

/// Whether there is a listener.
pub(super) fn is_heard() -> bool {
    IS_HEARD.load(Ordering::Relaxed)
}

/// Tells the listener, where there is one.
pub(super) fn note(event: Event<'_>) {
    if !is_heard() {
        return;
    }
    let mut listener = LISTENER.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(listener) = listener.as_mut() {
        listener(&event);
    }
}

/// From now on `listener` is told of every event of this process, or nobody is.
pub fn listen(listener: Option<Listener>) {
    IS_HEARD.store(listener.is_some(), Ordering::Relaxed);
    *LISTENER.lock().unwrap_or_else(PoisonError::into_inner) = listener;
}
