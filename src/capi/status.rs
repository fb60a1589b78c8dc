//! How a call ends: a status, and a text in memory of the caller's.
//!
//! Every entry runs inside [`guard`]: what goes wrong becomes a status and a sentence, a panic too.

use super::structure::HEADER_BYTES;
use std::ffi::{c_char, c_void};
use std::mem::offset_of;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// How a call ended. What failed has changed nothing, unless its function says otherwise.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_status {
    /// Done.
    SV_OK = 0,
    /// An argument that can never do: a null pointer, a stale handle, a number out of its range.
    SV_E_ARGUMENT = -1,
    /// Nothing wrong with it, but neither the library nor this device can do it.
    SV_E_UNSUPPORTED = -2,
    /// More than a limit allows, of the device or of the library: see `wanted` and `allowed`.
    SV_E_LIMIT = -3,
    /// No memory, of the host or of the device.
    SV_E_MEMORY = -4,
    /// The device is lost. What is on it can only be destroyed, which stays safe.
    SV_E_DEVICE_LOST = -5,
    /// Right, but not now: something else comes first, or another thread uses the object.
    SV_E_STATE = -6,
    /// A structure of another version of this header: see `struct_size` and `next`.
    SV_E_VERSION = -7,
    /// A mistake of the library's own. Please report it with the text.
    SV_E_INTERNAL = -8,
    /// The driver refused, and gave no better reason than its number, which the text has.
    SV_E_DRIVER = -9,
}
use sv_status::*;

/// Bytes of the text, with the zero at its end.
pub const TEXT_BYTES: usize = 256;

/// What went wrong: memory of the caller's, written by calls that fail.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_diagnostic {
    /// `sizeof(sv_diagnostic)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// What the call returned.
    pub status: sv_status,
    /// What was wanted, where a limit was in the way; else 0.
    pub wanted: u64,
    /// What the limit allows.
    pub allowed: u64,
    /// What was being done, wanted and found: UTF-8 that ends with a zero, cut where it is longer.
    pub text: [c_char; 256],
}

/// Why a call fails.
#[derive(Debug)]
pub(super) struct Failure {
    pub status: sv_status,
    pub text: String,
    pub wanted: u64,
    pub allowed: u64,
}

impl Failure {
    pub fn new(status: sv_status, text: impl Into<String>) -> Self {
        Self {
            status,
            text: text.into(),
            wanted: 0,
            allowed: 0,
        }
    }

    pub fn argument(text: impl Into<String>) -> Self {
        Self::new(SV_E_ARGUMENT, text)
    }

    pub fn state(text: impl Into<String>) -> Self {
        Self::new(SV_E_STATE, text)
    }

    /// `what` follows the word "cannot".
    pub fn limit(what: impl Into<String>, wanted: u64, allowed: u64) -> Self {
        let text = format!(
            "cannot {}: wanted {wanted}, allowed are {allowed}",
            what.into()
        );
        Self {
            wanted,
            allowed,
            ..Self::new(SV_E_LIMIT, text)
        }
    }
}

/// Refuses a number by its name.
pub(super) fn number(name: &str, wanted: &str, found: f64, is_right: bool) -> Result<(), Failure> {
    match is_right {
        true => Ok(()),
        false => Err(Failure::argument(format!(
            "{name}: wanted {wanted}, found {found}"
        ))),
    }
}

/// Refuses what is not zero where nothing is told yet.
pub(super) fn reserved(name: &str, found: u32) -> Result<(), Failure> {
    number(name, "0", found.into(), found == 0)
}

/// Runs `body`, and tells the caller how it ended. Nothing unwinds from here into C.
///
/// # Safety
/// `diagnostic` is NULL, or points to memory of the size that stands at its beginning.
pub(super) unsafe fn guard(
    diagnostic: *mut sv_diagnostic,
    body: impl FnOnce() -> Result<(), Failure>,
) -> sv_status {
    if !diagnostic.is_null() {
        // SAFETY: the caller's promise: at least the header is there.
        let (size, next) = unsafe {
            (
                (&raw const (*diagnostic).struct_size).read_unaligned(),
                (&raw const (*diagnostic).next).read_unaligned(),
            )
        };
        // Without room for a text there is nobody to tell it to.
        if (size as usize) < size_of::<sv_diagnostic>() || !next.is_null() {
            return SV_E_VERSION;
        }
    }
    let failure = match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(())) => return SV_OK,
        Ok(Err(failure)) => failure,
        Err(panic) => {
            let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
            let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
            let text = text.unwrap_or("no word of it".into());
            // What was thrown may panic where it is dropped.
            std::mem::forget(panic);
            Failure::new(
                SV_E_INTERNAL,
                format!("a mistake of stratavox, please report it: {text}"),
            )
        }
    };
    if !diagnostic.is_null() {
        // SAFETY: it is as large as it says, and that is enough.
        unsafe { tell(diagnostic, &failure) };
    }
    failure.status
}

/// # Safety
/// `diagnostic` points to a whole structure.
unsafe fn tell(diagnostic: *mut sv_diagnostic, failure: &Failure) {
    let mut end = failure.text.len().min(TEXT_BYTES - 1);
    while !failure.text.is_char_boundary(end) {
        end -= 1;
    }
    let mut text = [0u8; TEXT_BYTES];
    text[..end].copy_from_slice(&failure.text.as_bytes()[..end]);
    // A zero in the text would hide what follows it.
    text[..end]
        .iter_mut()
        .filter(|byte| **byte == 0)
        .for_each(|byte| *byte = b' ');
    // SAFETY: the caller's promise; memory of C's may be aligned to anything.
    unsafe {
        (&raw mut (*diagnostic).status).write_unaligned(failure.status);
        (&raw mut (*diagnostic).wanted).write_unaligned(failure.wanted);
        (&raw mut (*diagnostic).allowed).write_unaligned(failure.allowed);
        (&raw mut (*diagnostic).text)
            .cast::<[u8; TEXT_BYTES]>()
            .write_unaligned(text);
    }
}

const _: () = assert!(offset_of!(sv_diagnostic, status) == HEADER_BYTES);

#[cfg(test)]
mod tests {
    use super::*;

    fn blank() -> sv_diagnostic {
        sv_diagnostic {
            struct_size: size_of::<sv_diagnostic>() as u32,
            next: std::ptr::null(),
            status: SV_OK,
            wanted: 7,
            allowed: 7,
            text: [1; TEXT_BYTES],
        }
    }

    fn text(diagnostic: &sv_diagnostic) -> String {
        let bytes = diagnostic.text.map(|c| c as u8);
        let end = bytes.iter().position(|&b| b == 0).expect("it ends");
        String::from_utf8(bytes[..end].to_vec()).expect("UTF-8")
    }

    #[test]
    fn a_panic_becomes_a_status_and_a_sentence() {
        let mut told = blank();
        // SAFETY: a whole structure.
        let found = unsafe { guard(&raw mut told, || panic!("number {}", 3)) };
        assert_eq!((found, told.status), (SV_E_INTERNAL, SV_E_INTERNAL));
        assert!(text(&told).ends_with("number 3"), "{}", text(&told));
        // SAFETY: NULL.
        let found = unsafe { guard(std::ptr::null_mut(), || panic!()) };
        assert_eq!(found, SV_E_INTERNAL);
    }

    #[test]
    fn a_long_text_is_cut_between_characters() {
        let mut told = blank();
        let failure = || Err(Failure::argument("ä".repeat(400)));
        // SAFETY: a whole structure.
        assert_eq!(unsafe { guard(&raw mut told, failure) }, SV_E_ARGUMENT);
        assert_eq!(text(&told), "ä".repeat(127));
    }

    #[test]
    fn a_call_that_succeeds_writes_nothing() {
        let mut told = blank();
        // SAFETY: a whole structure.
        assert_eq!(unsafe { guard(&raw mut told, || Ok(())) }, SV_OK);
        assert_eq!((told.wanted, told.text), (7, [1; TEXT_BYTES]));
    }
}
