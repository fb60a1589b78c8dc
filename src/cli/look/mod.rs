//! What `--look auto` chooses once the volume is known, written as the flags that say the same.
//!
//! ```text
//! scene + volume -> light, samples, background -> side -> frame -> samples that the work allows -> a scene of plain flags
//! ```
//!
//! A flag that is given stays. What is chosen stands in [`crate::look`].

mod framing;
mod freeze;
mod light;
mod prepared;
mod side;

pub use framing::{Framing, View, short, target_word};
pub use freeze::{Chosen, base_of, ends_of, without_parts};
pub use light::{Seen, Use, with_light};
pub use prepared::{Views, prepared};
pub use side::{side_words, with_side};
