//! Each Vulkan call that can fail does: an error comes, nothing leaks, and the next picture is right.

#[path = "../hooked/mod.rs"]
mod hooked;
#[path = "../shared/mod.rs"]
mod shared;

mod calls;
mod device_loss;
mod embedded;
mod sweep;
