//! Each Vulkan call that can fail does: an error comes, nothing leaks, and the next picture is right.
#![cfg(feature = "conformance")]

#[path = "../hooked/mod.rs"]
mod hooked;
#[path = "../shared/mod.rs"]
mod shared;

mod calls;
mod device_loss;
mod embedded;
mod sweep;
