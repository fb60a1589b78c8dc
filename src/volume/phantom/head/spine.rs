//! The vertebrae of the neck and what lies in their canal.

use super::shape::{at, capsule, cone, cut, ellipsoid, join};
use glam::DVec3;

/// Height of a vertebra with its disc.
const LEVEL: f64 = 16.5;
/// The middle of the second vertebra's body.
const SECOND: f64 = -58.0;

/// What the spine is at a point.
pub(super) struct Spine {
    /// Distance to bone.
    pub bone: f64,
    /// Distance to the discs.
    pub disc: f64,
    /// Distance to the canal of the spinal cord.
    pub canal: f64,
    /// Distance to the spinal cord.
    pub cord: f64,
}

/// The neck bends forward in its middle: y of the bodies' middle.
pub(super) fn body_y(z: f64) -> f64 {
    -12.0 - 0.006 * (z + 78.0).powi(2)
}

pub(super) fn at_point(p: DVec3) -> Spine {
    let y = p.y - body_y(p.z);
    let canal = (p.x / 1.25).hypot(y + 19.0) - 8.2;
    let canal = canal.max(p.z + 26.0);
    let cord = ((p.x / 1.2).hypot(y + 19.0) - 4.6).max(p.z + 20.0);
    let level = ((SECOND - p.z) / LEVEL).round().max(0.0);
    let local = at(p.x, y, p.z - (SECOND - level * LEVEL));
    let column = (p.x / 14.0).hypot(y / 9.0) * 9.0 - 9.0;
    let body = column.max(local.z.abs() - 6.0);
    let disc = (column + 0.5)
        .max(local.z.abs() - LEVEL + 5.0)
        .max(p.z - SECOND);
    let mut bone = join(body, arch(local, level), 3.0);
    if p.z > SECOND - 8.0 {
        bone = join(bone, first_two(p), 2.0);
    }
    Spine {
        bone: cut(bone, canal, 1.0),
        disc,
        canal,
        cord,
    }
}

/// Pillars, side and back processes; `p` from the middle of the body.
fn arch(p: DVec3, level: f64) -> f64 {
    let pillar = ellipsoid(p, at(20.0, -15.0, -1.0), at(6.5, 7.5, 8.0));
    let side = cone(p, at(11.0, -2.0, 0.0), at(26.0, -4.0, -2.0), 4.2, 3.0);
    let ring = ((p.x / 1.25).hypot(p.y + 19.0) - 10.2).abs() - 1.9;
    let ring = ring.max((p.z + 1.0).abs() - 5.0).max(p.y + 10.0);
    let longer = if level > 4.0 { 14.0 } else { 0.0 };
    let back = cone(
        p,
        at(1.0, -30.0, -1.0),
        at(3.0, -46.0 - longer, -9.0),
        3.6,
        3.4,
    );
    join(join(join(pillar, side, 3.0), ring, 3.0), back, 4.0)
}

/// The ring of the first vertebra, and the peg of the second in it.
fn first_two(p: DVec3) -> f64 {
    const FIRST: f64 = -41.0;
    let y = p.y - body_y(FIRST);
    let ring =
        ((p.x / 21.0).hypot((y + 14.0) / 24.0) * 21.0 - 21.0).hypot(1.1 * (p.z - FIRST)) - 4.0;
    let mass = ellipsoid(p, at(20.0, body_y(FIRST) - 10.0, FIRST), at(8.0, 11.0, 8.0));
    let side = capsule(p, at(24.0, -30.0, FIRST), at(39.0, -32.0, FIRST), 3.8);
    let peg = capsule(
        p,
        at(0.0, body_y(SECOND), SECOND),
        at(0.0, body_y(FIRST) - 1.0, FIRST + 5.0),
        5.2,
    );
    join(join(join(ring, mass, 3.0), side, 3.0), peg, 1.0)
}
