//! What a technique left behind to linear premultiplied colour.

pub mod reference;
