//! View-aligned slicing: planes parallel to the picture, cut in the vertex shader, blended in hardware
//! ([`super::Slicer`]). With shadows, planes half way between the picture and the light ([`HalfAngleSlicer`]).

pub mod cover;
pub mod half_angle;
mod planes;
pub mod reference;

pub use half_angle::HalfAngleSlicer;
pub use planes::set_planes;
