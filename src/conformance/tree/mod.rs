//! All cases, by name. The list is the same on every device: what a device lacks is for the verdict to say.

mod drawn;
mod exact;
mod ground;
mod main_axis;
mod points;
mod probe;
mod reference;
mod relation;
mod runs;
mod scatter;
mod seen;
mod shadow;
mod slab;
mod splat;
mod surface;
mod warp;

use super::case::Case;

pub use ground::{PLACEMENTS, Placement, grid, oblique_camera, ramps, waves};

/// Every case of every profile, in the order in which they run.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    cases.extend(probe::cases());
    cases.extend(exact::cases());
    cases.extend(seen::cases());
    cases.extend(surface::cases());
    cases.extend(slab::cases());
    cases.extend(main_axis::cases());
    cases.extend(shadow::cases());
    cases.extend(relation::cases());
    cases.extend(reference::cases());
    cases.extend(warp::cases());
    cases.extend(runs::cases());
    cases.extend(splat::cases());
    cases.extend(points::cases());
    cases.extend(scatter::cases());
    cases
}
