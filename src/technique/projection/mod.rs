//! MIP and its relatives: one ray a pixel in a compute pass, one number a ray.

pub mod reference;
