//! Ctrl-C, and limits on the size of files: both end in an exit code, never in half a file.
//!
//! The handler stops the process at once, unless a file is just being put in its place: then it waits for
//! that one file to be whole. Threads of a driver may be at work at that moment, so the process ends without
//! running anybody's exit handlers.

use std::sync::{Arc, Mutex, PoisonError};

/// The exit code of a process that was asked to stop.
pub const INTERRUPTED: u8 = 130;

/// Held while a file is written: an interrupt waits for it.
#[derive(Clone, Debug, Default)]
pub struct Gate(Arc<Mutex<()>>);

impl Gate {
    /// Runs `write` so that no interrupt comes between its beginning and its end.
    pub fn whole<T>(&self, write: impl FnOnce() -> T) -> T {
        let _held = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        write()
    }
}

/// From here on an interrupt or a wish to terminate ends the process with [`INTERRUPTED`], and a file that
/// grows beyond the process's limit is an error of the write instead of a signal.
pub fn install(gate: &Gate) {
    let gate = gate.clone();
    // A second call in one process is refused by ctrlc: the first handler stays, which is as good.
    let _ = ctrlc::set_handler(move || gate.whole(|| exit_now(INTERRUPTED)));
    ignore_file_size_signal();
}

#[cfg(unix)]
fn exit_now(code: u8) -> ! {
    // SAFETY: `_exit` has no preconditions; it takes the process down from any thread.
    unsafe { libc::_exit(code.into()) }
}

#[cfg(not(unix))]
fn exit_now(code: u8) -> ! {
    std::process::exit(code.into())
}

#[cfg(unix)]
fn ignore_file_size_signal() {
    // SAFETY: ignoring a signal installs no handler, so no code of ours runs in a signal's context.
    unsafe { libc::signal(libc::SIGXFSZ, libc::SIG_IGN) };
}

#[cfg(not(unix))]
fn ignore_file_size_signal() {}
