//! `stratavox conformance` judged: by injected driver faults, and by the CPU reference in the place of a device.

#[cfg(feature = "conformance")]
#[path = "../lying/mod.rs"]
mod lying;

#[cfg(feature = "conformance")]
mod injected_faults;
#[cfg(feature = "conformance")]
mod reference;
