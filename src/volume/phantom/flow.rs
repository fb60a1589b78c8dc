//! Velocities whose lines are known, in a cube from -1 to 1 m along each axis.
//!
//! ```text
//! helix          v = (-y, x, 1/4)                                    lines x^2 + y^2 = r^2, a quarter of a metre up a radian
//! saddle         v = (x, -y, 0)                                      lines x y = c,  x = x0 exp t,  y = y0 exp -t
//! taylor-green   v = (sin px cos py, -cos px sin py, 0)              lines sin px sin py = c,  p = pi
//! abc            v = (sin pz + cos py, sin px + cos pz, sin py + cos px)      chaos between vortices
//! ```
//!
//! In m/s. Helix and saddle are linear: trilinear interpolation reproduces them between the centres of voxels. All are free of
//! divergence. Taylor and Green, Proc. R. Soc. A 158, 1937; Dombre et al., "Chaotic streamlines in the ABC flows", J. Fluid Mech.
//! 167, 1986.

use crate::volume::field::Field;
use glam::DVec3;
use std::f64::consts::PI;

/// Half of the side of the cube, in metres.
pub(super) const HALF_SIDE: f64 = 1.0;
/// What no component of any of them leaves.
pub(super) const RANGE: [f64; 2] = [-2.0, 2.0];
/// By UDUNITS.
pub(super) const UNIT: &str = "m s-1";

/// The words of `kind`; the first is the default.
pub(super) const KINDS: [&str; 4] = ["helix", "saddle", "taylor-green", "abc"];

/// One component of one of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flow {
    kind: usize,
    component: usize,
}

impl Flow {
    /// Of a number in [`KINDS`]; 0 is the component along x.
    pub fn new(kind: usize, component: u32) -> Self {
        Self {
            kind,
            component: component as usize,
        }
    }
}

impl Field for Flow {
    fn value(&self, p: DVec3) -> f64 {
        let ([sx, sy, sz], [cx, cy, cz]) = (
            (PI * p).to_array().map(f64::sin),
            (PI * p).to_array().map(f64::cos),
        );
        let velocity = match KINDS[self.kind] {
            "helix" => [-p.y, p.x, 0.25],
            "saddle" => [p.x, -p.y, 0.0],
            "taylor-green" => [sx * cy, -cx * sy, 0.0],
            _ => [sz + cy, sx + cz, sy + cx],
        };
        velocity[self.component]
    }
}
