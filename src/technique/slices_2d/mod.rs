//! 2D texture slicing: three stacks of axis-aligned slices, blended in hardware ([`super::Slicer`]).

pub mod between;
pub mod reference;
mod stack;

pub use between::planes_per_slice;
pub use stack::{set_slices, stack_axis, stack_shares};
