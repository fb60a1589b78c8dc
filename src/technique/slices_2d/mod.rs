//! 2D texture slicing: three stacks of axis-aligned slices, blended in hardware ([`super::Slicer`]).

pub mod reference;
mod stack;

pub use stack::{set_slices, stack_axis};
