//! View-aligned slicing: planes parallel to the picture, cut in the vertex shader, blended in hardware
//! ([`super::Slicer`]).

pub mod cover;
mod planes;
pub mod reference;

pub use planes::set_planes;
