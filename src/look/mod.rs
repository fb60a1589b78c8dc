//! How a picture looks where nobody says how: the frame, the light and the side that suit a volume, and what of it is
//! left out.
//!
//! ```text
//! values   what a file says of its values, and what they look like     light   where there is light, and which
//! side     the face of a slab, or the best of six sides                frame   a camera fitted to what is visible
//! work     samples of a picture                                        components   thin matter of CT at faces
//! height   the surface of what falls with height                       surface   values where a surface passes
//! ```
//!
//! `stratavox render --look auto` and the viewer choose by these functions. Nothing here asks a clock: the same inputs give
//! the same choice.

mod components;
mod frame;
mod height;
mod light;
mod side;
mod surface;
mod values;
mod work;

pub use components::leave_out;
pub use frame::{
    SHARE, SMALL_PIXELS, box_of, corners, fit_to_visible, frames_the_box, small_of, visible_in,
};
pub use height::{falls_with_height, mean_at_a_third};
pub use light::{LIGHT, MATERIAL, Origin, STILL_SAMPLES, half_gradient, is_lit, light, may_choose};
pub use side::{SIDES, best_side, face};
pub use surface::summary_at;
pub use values::{context, first_variable, is_cloud, summary};
pub use work::{MOST_SAMPLES, samples};

/// What lies behind pictures that people look at: sRGB and opacity, `#18181c`.
pub const BACKGROUND: [f64; 4] = [24.0 / 255.0, 24.0 / 255.0, 28.0 / 255.0, 1.0];
