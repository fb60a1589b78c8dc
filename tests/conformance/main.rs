//! `stratavox conformance` judged: by injected driver faults, and by the CPU reference in the place of a device.

#[cfg(feature = "conformance")]
#[path = "../driver_faults/mod.rs"]
mod driver_faults;

#[cfg(feature = "conformance")]
mod injected_faults;
#[cfg(feature = "conformance")]
mod reference;
