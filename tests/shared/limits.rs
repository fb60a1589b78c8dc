//! The limits of a test's device: its own, or with `STRATAVOX_LIMITS=least` the least that Vulkan allows (`make
//! least`).

use stratavox::gpu::Caps;

/// The least of every limit, but for one that `tests/matrix/minimum.rs` is for, since pictures that want more are refused by
/// name: whether 32-bit floats are blended is a format's feature and no limit.
const LEAST: Caps = Caps {
    float32_blend: true,
    ..Caps::VULKAN_MINIMUM
};

/// What a test asks for, and not more than this run allows.
pub fn allowed(caps: Caps) -> Caps {
    match std::env::var("STRATAVOX_LIMITS").as_deref() {
        Err(_) => caps,
        Ok("least") => caps.clamped_to(&LEAST),
        Ok(other) => panic!("STRATAVOX_LIMITS={other}: `least`, or not set"),
    }
}
