//! Exact answers, as functions that say how far a way to make pictures is from them. The tests of the
//! library ask them to hold, those of mutants ask them to catch.

mod density;
mod light;
mod shapes;

pub use density::{atmosphere, linear_density, order_of_convergence, quadratic_density};
pub use light::{constant_color, homogeneous};
pub use shapes::{
    Gaussian, absorbing_sphere, emissive_sphere, gaussian_maximum, gaussian_ratio, gaussian_xray,
};

use super::{PictureCase, Way};

fn what(answer: &str, way: &dyn Way, shot: &PictureCase) -> String {
    format!("{answer}, {}, {}", way.name(), shot.what())
}
