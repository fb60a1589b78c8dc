//! A panic is a mistake of ours: the person gets a sentence and somewhere to take it, not a stack of frames.

use super::error::visible;
use std::{
    io::Write,
    panic::{self, PanicHookInfo},
};

/// The exit code of a bug.
pub const EXIT_CODE: u8 = 101;

/// Runs `work`; where it panics, says so in one sentence on stderr and gives exit code 101.
///
/// Sets the panic hook of the process, so it is for programs alone.
pub fn guarded(work: impl FnOnce() -> u8 + panic::UnwindSafe) -> u8 {
    panic::set_hook(Box::new(|info| {
        // A damaged file that a decoder fell over: the reader says so.
        if crate::fence::is_inside() {
            return;
        }
        // Where stderr is closed there is nobody to tell.
        let _ = std::io::stderr().write_all(report(info).as_bytes());
    }));
    panic::catch_unwind(work).unwrap_or(EXIT_CODE)
}

fn report(info: &PanicHookInfo) -> String {
    let place = info
        .location()
        .map(|place| format!(" ({}:{})", place.file(), place.line()))
        .unwrap_or_default();
    format!(
        "stratavox {}: this is a bug in stratavox, please report it with the command you ran: {}{place}\n",
        env!("CARGO_PKG_VERSION"),
        visible(info.payload_as_str().unwrap_or("no message")),
    )
}
