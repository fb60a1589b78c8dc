//! Stream, path and streak lines of a velocity field.
//!
//! ```text
//! dx/dt = v(t, x)
//! stream line    the solution with t held in v: tangent to the velocity of one instant
//! path line      the solution: the way of one particle
//! streak line    where particles are now that passed one place, one after the other
//! ```
//!
//! Places are those of the drawn world before heights are exaggerated. Knows nothing of files that it reads, and nothing
//! of Vulkan.

pub mod dormand_prince;
