//! The skull: a shell around the brain, the bones of the face, the jaw.

use super::shape::{at, capsule, chain, cone, cut, ellipsoid, join, smoothstep, sphere};
use glam::DVec3;

/// Bone of the skull cap, inner table to outer table.
pub(super) const CAP_THICKNESS: f64 = 7.0;

/// Distance to the room of the brain; the skull is where it is 0 to [`CAP_THICKNESS`].
pub(super) fn brain_room(p: DVec3) -> f64 {
    let back = ellipsoid(p, at(0.0, -22.0, 38.0), at(64.5, 71.5, 62.0));
    let front = ellipsoid(p, at(0.0, 20.0, 34.0), at(54.5, 56.0, 58.5));
    let cap = join(back, front, 20.0);
    if p.z > 45.0 {
        return cap;
    }
    // Not quite a distance where the floor is steep.
    let floor = 0.85 * (floor_height(p.x, p.y) - p.z);
    -join(-cap, -floor, 8.0)
}

/// The three steps of the skull base: over the eyes, over the ears, around the cerebellum.
fn floor_height(x: f64, y: f64) -> f64 {
    let over_eyes =
        22.0 + 5.0 * (-((x - 32.0) / 17.0).powi(2)).exp() - 4.0 * smoothstep(9.0, 3.0, x);
    let saddle = 9.0 + 5.0 * smoothstep(14.0, 22.0, y) - 3.0 * smoothstep(4.0, 10.0, y);
    let over_ears = -5.0 + (saddle + 5.0) * smoothstep(19.0, 11.0, x);
    let hollow = -24.0 + 0.006 * (y + 45.0).powi(2);
    let ridge = 2.0 - 0.5 * x;
    let ear_ridge = 9.0 * (-((y - ridge) / 6.0).powi(2)).exp() * smoothstep(12.0, 20.0, x);
    let back = hollow + (over_ears - hollow) * smoothstep(-14.0, 2.0, y - ridge);
    back + ear_ridge + (over_eyes - back) * smoothstep(-11.0, 11.0, y - 36.0 + 0.12 * x)
}

/// Where the spinal cord leaves.
pub(super) fn great_hole(p: DVec3) -> f64 {
    let tube = (p.x / 1.0).hypot((p.y + 33.0) / 1.15) - 14.0;
    tube.max(p.z + 8.0)
}

/// All bone of the skull but for the jaw, from the distances to the room of the brain and to the face.
pub(super) fn skull(p: DVec3, brain_room: f64, face: f64) -> f64 {
    let shell = (brain_room - 0.5 * CAP_THICKNESS).abs() - 0.5 * CAP_THICKNESS;
    if p.z > 50.0 {
        return shell + seam(p);
    }
    let shell = cut(shell, great_hole(p), 2.0);
    let ear = ear_bone(p);
    let skull = join(shell, ear, 5.0);
    if p.y < -5.0 && p.x < 40.0 {
        return skull;
    }
    join(skull, face, 4.0)
}

/// How deep the seams between the plates of the skull cap are: from ear to ear, and from there back.
fn seam(p: DVec3) -> f64 {
    let across = p.y - 16.0 + 0.3 * (p.z - 90.0) + 1.2 * (0.9 * p.x).sin();
    let along = if across < 0.0 { p.x } else { f64::INFINITY };
    let aside = across.abs().min(along) / 1.3;
    // None where the face begins.
    1.3 * (-aside * aside).exp() * smoothstep(50.0, 60.0, p.z)
}

fn ear_bone(p: DVec3) -> f64 {
    let pyramid = cone(p, at(18.0, -4.0, -4.0), at(54.0, -22.0, -3.0), 7.0, 11.0);
    let mastoid = cone(p, at(54.0, -24.0, -6.0), at(51.0, -19.0, -29.0), 12.0, 6.0);
    let condyle = ellipsoid(p, at(17.0, -20.0, -29.0), at(7.0, 11.0, 6.0));
    join(join(pyramid, mastoid, 8.0), condyle, 6.0)
}

/// The room of the eye: from the opening back to where the nerve enters.
pub(super) fn orbit(p: DVec3) -> f64 {
    let q = at(p.x, p.y, 8.0 + (p.z - 8.0) * 1.12);
    cone(q, at(14.0, 30.0, 9.0), at(37.0, 82.0, 8.0), 4.0, 21.5)
}

/// The bones of the face, before air is taken out.
pub(super) fn face(p: DVec3) -> f64 {
    let orbit = orbit(p);
    let opening = p.y - 72.5 + 0.38 * (p.x - 30.0).max(0.0);
    let orbit_wall = (orbit - 2.8).max(opening);
    let brow = chain(
        p,
        &[
            at(4.0, 80.0, 22.0),
            at(30.0, 77.5, 28.0),
            at(46.0, 66.0, 22.0),
        ],
        5.0,
    );
    let outer_rim = chain(
        p,
        &[
            at(47.0, 65.0, 21.0),
            at(49.0, 61.0, 6.0),
            at(46.0, 62.0, -8.0),
        ],
        4.4,
    );
    let lower_rim = chain(
        p,
        &[
            at(46.0, 63.0, -9.0),
            at(32.0, 70.0, -13.5),
            at(17.0, 74.0, -6.0),
        ],
        4.0,
    );
    let beside_nose = chain(
        p,
        &[
            at(7.0, 80.0, 20.0),
            at(13.0, 77.0, 2.0),
            at(17.0, 74.0, -24.0),
        ],
        4.0,
    );
    let nose_bone = cone(p, at(2.5, 79.0, 18.0), at(3.6, 86.0, 3.0), 4.4, 3.4);
    let cheek = ellipsoid(p, at(45.0, 59.0, -14.0), at(11.0, 11.0, 9.0));
    let arch = chain(
        p,
        &[
            at(49.0, 54.0, -13.0),
            at(59.0, 32.0, -13.0),
            at(62.0, 10.0, -9.0),
            at(59.0, -6.0, -6.0),
        ],
        3.4,
    );
    let strut = cone(p, at(44.0, 57.0, -18.0), at(33.0, 52.0, -34.0), 8.0, 5.0);
    let upper_jaw = ellipsoid(p, at(0.0, 46.0, -20.0), at(38.0, 32.5, 27.0));
    let palate = ellipsoid(p, at(0.0, 46.0, -53.0), at(20.0, 27.0, 18.0));
    let mut d = join(cut(upper_jaw, palate, 4.0), cheek, 8.0);
    d = join(d, strut, 6.0);
    d = join(d, tooth_bed(p, 76.5, -31.0), 6.0);
    d = join(d, beside_nose, 5.0);
    d = join(d, lower_rim, 5.0);
    d = join(d, outer_rim, 6.0);
    d = join(d, brow, 6.0);
    // Room for the sinuses over the brows.
    d = join(
        d,
        ellipsoid(p, at(0.0, 77.0, 31.0), at(22.0, 8.0, 13.0)),
        6.0,
    );
    d = join(d, orbit_wall, 3.0);
    d = join(d, arch, 4.0);
    d = join(d, wings(p), 4.0);
    d = cut(d, orbit, 2.0);
    d = cut(d, nose_opening(p), 3.0);
    join(d, nose_bone, 4.0)
}

/// Behind the upper jaw: the sphenoid's body and its wings downwards.
fn wings(p: DVec3) -> f64 {
    let body = ellipsoid(p, at(0.0, 10.0, 1.0), at(16.0, 17.0, 11.0));
    let slope = cone(p, at(0.0, 0.0, -2.0), at(0.0, -16.0, -24.0), 9.0, 6.0);
    let plate = ellipsoid(p, at(15.0, 18.0, -20.0), at(2.2, 7.0, 17.0));
    join(join(body, slope, 6.0), plate, 4.0)
}

/// The pear-shaped hole that shows in every skull.
fn nose_opening(p: DVec3) -> f64 {
    let below = ellipsoid(p, at(4.0, 82.0, -19.0), at(9.5, 16.0, 9.5));
    let above = ellipsoid(p, at(0.0, 84.0, -10.0), at(6.0, 14.0, 14.0));
    join(below, above, 6.0)
}

/// A horseshoe of bone that carries teeth; its front lies at `front`.
fn tooth_bed(p: DVec3, front: f64, z: f64) -> f64 {
    let (across, along) = arch(p, front);
    // Rounded: the box is smaller by the radius that its surface then stands off.
    let outside = at(across.abs() - 3.0, along - 50.0, (p.z - z).abs() - 6.5);
    outside.max(DVec3::ZERO).length() - 2.5 + outside.max_element().min(0.0)
}

/// Distance across the parabola y = front - 0.058 x^2 (outwards) and length along it from the middle.
pub(super) fn arch(p: DVec3, front: f64) -> (f64, f64) {
    const CURVE: f64 = 0.116;
    let height = p.y - front + 0.5 * CURVE * p.x * p.x;
    let slope = CURVE * p.x;
    let steepness = 1.0 + slope * slope;
    let foot = (p.x - height * slope / steepness).max(0.0);
    let a = CURVE * foot;
    let along = 0.5 * (foot * (1.0 + a * a).sqrt() + a.asinh() / CURVE);
    (height / steepness.sqrt(), along)
}

/// The lower jaw.
pub(super) fn jaw(p: DVec3) -> f64 {
    // Taller than thick.
    let q = at(p.x, p.y, -76.0 + (p.z + 76.0) * 0.52);
    let points = [
        at(0.0, 75.5, -76.0),
        at(17.0, 69.0, -76.0),
        at(33.0, 46.0, -75.0),
        at(46.0, 16.0, -72.5),
    ];
    let body = chain(q, &points, 5.6);
    let chin = ellipsoid(p, at(0.0, 74.5, -85.0), at(13.0, 6.5, 7.0));
    // A plate from the angle up to the joint and to the hook in front of it.
    let up = ((p.z + 72.0) / 46.0).clamp(0.0, 1.0);
    let from_plate = at(p.x - 46.0 - 4.5 * up, p.y - 14.0 + 9.0 * up, p.z + 50.0);
    let outside = from_plate.abs() - at(0.4, 7.5 - 2.5 * up, 19.0);
    let outline = outside.y.max(0.0).hypot(outside.z.max(0.0)) - 7.0;
    let plate =
        outline.max(0.0).hypot(outside.x.max(0.0)) + outline.min(0.0).max(outside.x.min(0.0)) - 2.6;
    let notch = sphere(p, at(50.0, 7.0, -19.0), 8.5);
    let neck = capsule(p, at(50.5, -3.0, -30.0), at(51.5, -3.0, -16.0), 4.2);
    let head = ellipsoid(p, at(51.0, -3.0, -13.5), at(9.0, 4.8, 4.8));
    let mut d = join(body, chin, 8.0);
    d = join(d, cut(plate, notch, 3.0), 6.0);
    d = join(d, neck, 5.0);
    d = join(d, head, 4.0);
    join(d, tooth_bed(p, 73.0, -67.0), 5.0)
}
