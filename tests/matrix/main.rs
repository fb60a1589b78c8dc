//! What goes together: every cell of `docs/matrix.md`, and what a device must have for it.

#[path = "../hooked/mod.rs"]
mod hooked;
#[path = "../shared/mod.rs"]
mod shared;

mod every_cell;
mod minimum;
mod requirements;
