//! What `--look auto` chooses once the volume is known, written as the flags that say the same.
//!
//! ```text
//! scene + volume -> light, samples, background -> side -> frame -> samples that the work allows -> a scene of plain flags
//! ```
//!
//! A flag that is given stays. Nothing here asks a clock: the same inputs give the same flags.

mod framing;
mod freeze;
mod light;
mod prepared;
mod side;
mod work;

pub use framing::{Framing, View};
pub use freeze::frozen;
pub use light::Use;
pub use prepared::{Views, prepared};

/// What lies behind pictures that people look at: sRGB, opaque.
pub const BACKGROUND: [f64; 4] = [24.0 / 255.0, 24.0 / 255.0, 28.0 / 255.0, 1.0];
