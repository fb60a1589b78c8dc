//! What goes together: every cell of `docs/matrix.md`, and what a device must have for it.
#![cfg(feature = "conformance")]

#[path = "../../examples/matrix/cells.rs"]
mod cells;
#[path = "../hooked/mod.rs"]
mod hooked;
#[path = "../../examples/matrix/page.rs"]
mod page;
#[path = "../shared/mod.rs"]
mod shared;

mod every_cell;
mod minimum;
mod requirements;
