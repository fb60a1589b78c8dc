//! Ray casting: one ray a pixel in a compute pass, emission and absorption front to back (Levoy 1988).

pub mod reference;
