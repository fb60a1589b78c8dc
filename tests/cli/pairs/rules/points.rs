//! Scattered points and spheres.

use super::{Rule, no_meaning, of};

/// In their order.
pub const RULES: &[Rule] = &[
    of(
        &["scattered points", "scattered points as spheres"],
        no_meaning(
            "is for volumes, and",
            "scattered points have neither voxels nor a grid",
        ),
    ),
    no_meaning(
        "spheres are no volume",
        "spheres are surfaces, lit already: a ray takes no samples of them",
    ),
];
