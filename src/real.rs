//! f32 or f64: the twins are written once for both.
