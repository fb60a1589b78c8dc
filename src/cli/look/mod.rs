//! What `--look auto` chooses once the volume is known, written as the flags that say the same.
//!
//! ```text
//! scene + volume -> light, samples, background -> side -> frame -> samples that the work allows -> a scene of plain flags
//! ```
//!
//! A flag that is given stays. Nothing here asks a clock: the same inputs give the same flags.

mod components;
mod framing;
mod freeze;
mod light;
mod prepared;
mod side;
mod work;

pub use components::leave_out;
pub use framing::{Framing, SHARE, View, box_of, corners, small_of, visible_in};
pub use freeze::frozen;
pub use light::{Seen, Use, with_light};
pub use prepared::{Views, prepared};
pub use side::with_side;

/// What lies behind pictures that people look at: sRGB, opaque.
pub const BACKGROUND: [f64; 4] = [24.0 / 255.0, 24.0 / 255.0, 28.0 / 255.0, 1.0];
