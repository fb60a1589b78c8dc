//! Exact answers, in f64 and from camera and grid alone: none of it calls the functions of the shaders' CPU references.
//!
//! ```text
//! PictureCase -> Chord (what a ray meets, where its samples lie) -> Answer (what the mode makes of them, and how exact f32 is)
//! ```

mod answer;
mod chord;
mod field;
mod light;
mod matter;
pub mod places;
mod seen;
mod tracked;
mod voxels;

pub use answer::{Answer, Classes, DERIVATION, SamplerPrecision, answer};
pub use chord::{Chord, PictureCase};
pub use field::{Field, Kind};
pub use light::Open;
pub use matter::Part;
pub use seen::{FILTERS, Seen, seen, seen_through};
pub use tracked::Tracked;
pub use voxels::Numbers;
