//! Ctrl-C, and limits on the size of files: both end in an exit code, never in half a file.
//!
//! The handler stops the process at once, unless a file is just being put in its place: then it waits for
//! that one file to be whole. A file that takes long to write has its unfinished part removed instead. Threads of
//! a driver may be at work at that moment, so the process ends without running anybody's exit handlers.

use super::output::say_aside;
use std::{
    path::PathBuf,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::Instant,
};

/// The exit code of a process that was asked to stop.
pub const INTERRUPTED: u8 = 130;

/// Held while a file is written: an interrupt waits for it. Holds the unfinished file that it removes or speaks of.
/// Made as the program begins, it knows when that was.
#[derive(Clone, Debug)]
pub struct Gate {
    unfinished: Arc<Mutex<Option<Unfinished>>>,
    early: Arc<Early>,
    begun: Instant,
}

/// Work that the first interrupt ends early, with what there is.
#[derive(Debug, Default)]
struct Early {
    is_possible: AtomicBool,
    asked: Arc<AtomicBool>,
}

/// A file that is being written.
#[derive(Debug)]
enum Unfinished {
    /// Nobody can go on with it.
    Removed(PathBuf),
    /// This is how one goes on with it.
    Kept(String),
}

impl Default for Gate {
    fn default() -> Self {
        Self {
            unfinished: Arc::default(),
            early: Arc::default(),
            begun: Instant::now(),
        }
    }
}

impl Gate {
    /// When the program began.
    pub fn begun(&self) -> Instant {
        self.begun
    }

    /// From here on the first interrupt does not end the process but sets the flag, which ends what is being made early.
    pub fn ends_early(&self) -> Arc<AtomicBool> {
        self.early.is_possible.store(true, Ordering::SeqCst);
        Arc::clone(&self.early.asked)
    }

    /// Whether something was asked to end early.
    pub fn was_asked(&self) -> bool {
        self.early.asked.load(Ordering::SeqCst)
    }

    /// Runs `write` so that no interrupt comes between its beginning and its end.
    pub fn whole<T>(&self, write: impl FnOnce() -> T) -> T {
        let _held = self.held();
        write()
    }

    /// Makes an unfinished file with `make`, which an interrupt from here on removes.
    pub fn unfinished<T, E>(
        &self,
        make: impl FnOnce() -> Result<T, E>,
        part: impl FnOnce(&T) -> PathBuf,
    ) -> Result<T, E> {
        let mut held = self.held();
        let made = make()?;
        *held = Some(Unfinished::Removed(part(&made)));
        Ok(made)
    }

    /// An interrupt from here on leaves an unfinished file where it is and says this.
    pub fn keeps(&self, hint: String) {
        *self.held() = Some(Unfinished::Kept(hint));
    }

    /// Runs `end`, which gives the unfinished file its name or removes it: there is nothing to remove any more.
    pub fn finished<T>(&self, end: impl FnOnce() -> T) -> T {
        let mut held = self.held();
        let outcome = end();
        *held = None;
        outcome
    }

    fn held(&self) -> MutexGuard<'_, Option<Unfinished>> {
        self.unfinished
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }
}

/// From here on an interrupt or a wish to terminate ends the process with [`INTERRUPTED`], and a file that
/// grows beyond the process's limit is an error of the write instead of a signal.
pub fn install(gate: &Gate) {
    let gate = gate.clone();
    // A second call in one process is refused by ctrlc: the first handler stays, which is as good.
    let _ = ctrlc::set_handler(move || {
        let early = &gate.early;
        if early.is_possible.load(Ordering::SeqCst) && !early.asked.swap(true, Ordering::SeqCst) {
            return say_aside(
                "interrupted: the picture is written with the paths that it has; once more stops at once",
            );
        }
        let unfinished = gate.held();
        match unfinished.as_ref() {
            Some(Unfinished::Removed(part)) => drop(std::fs::remove_file(part)),
            Some(Unfinished::Kept(hint)) => say_aside(hint),
            None => {}
        }
        super::stdin::discard();
        exit_now(INTERRUPTED)
    });
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
