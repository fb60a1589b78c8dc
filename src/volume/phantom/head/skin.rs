//! The outside: skull cap, face, ears and neck.

use super::shape::{at, capsule, chain, cone, cut, ellipsoid, join, sphere};
use glam::DVec3;

/// Distance to the skin; `p.x` is not negative.
pub(super) fn distance(p: DVec3) -> f64 {
    let back = ellipsoid(p, at(0.0, -22.0, 38.0), at(77.0, 84.0, 74.5));
    let front = ellipsoid(p, at(0.0, 21.0, 33.0), at(67.0, 68.0, 71.0));
    let cap = join(back, front, 24.0);
    // Nothing else is up here.
    if p.z > 60.0 {
        return cap;
    }
    let neck = neck(p);
    let head = join(cap, neck, 30.0);
    let head = if p.y > -65.0 {
        join(head, face(p), 16.0)
    } else {
        head
    };
    let near_ear = p.x > 55.0 && p.y.abs() < 50.0 && p.z.abs() < 60.0;
    if near_ear {
        join(head, ear(p), 3.0)
    } else {
        head
    }
}

fn neck(p: DVec3) -> f64 {
    let throat = cone(p, at(0.0, -20.0, -30.0), at(0.0, -30.0, -150.0), 47.0, 50.0);
    // Flatter from front to back than a round cone, and two muscles beside the nape.
    let nape = cone(
        p,
        at(16.0, -48.0, -20.0),
        at(24.0, -58.0, -150.0),
        32.0,
        34.0,
    );
    let front = capsule(p, at(0.0, 4.0, -84.0), at(0.0, 0.0, -150.0), 24.0);
    let spine = capsule(p, at(0.0, -58.0, -20.0), at(0.0, -68.0, -150.0), 22.0);
    let apple = sphere(p, at(0.0, 23.0, -108.0), 5.0);
    join(
        join(join(throat, join(nape, spine, 20.0), 18.0), front, 14.0),
        apple,
        10.0,
    )
}

fn face(p: DVec3) -> f64 {
    let middle = ellipsoid(p, at(0.0, 26.0, -12.0), at(60.0, 58.0, 62.0));
    let mouth = ellipsoid(p, at(0.0, 42.0, -48.0), at(40.0, 46.5, 36.0));
    let jaw = cone(p, at(39.0, 6.0, -54.0), at(17.0, 62.0, -78.0), 19.0, 16.0);
    let chin = ellipsoid(p, at(0.0, 70.0, -83.0), at(17.0, 15.5, 13.0));
    let floor = ellipsoid(p, at(0.0, 30.0, -70.0), at(42.0, 42.0, 25.0));
    let cheek = sphere(p, at(41.0, 50.0, -14.0), 22.0);
    let side = cone(p, at(47.0, 36.0, -12.0), at(51.0, -22.0, -12.0), 18.0, 17.0);
    let angle = cone(p, at(50.0, 0.0, -16.0), at(44.0, 8.0, -60.0), 16.0, 14.0);
    let buccal = ellipsoid(p, at(35.0, 38.0, -40.0), at(18.0, 27.0, 24.0));
    let brow = chain(
        p,
        &[
            at(0.0, 81.0, 25.0),
            at(26.0, 80.0, 27.0),
            at(46.0, 63.0, 22.0),
        ],
        7.5,
    );
    let mut d = join(middle, mouth, 16.0);
    d = join(d, jaw, 18.0);
    d = join(d, floor, 16.0);
    d = join(d, chin, 14.0);
    d = join(d, cheek, 14.0);
    d = join(d, side, 20.0);
    d = join(d, buccal, 20.0);
    d = join(d, angle, 20.0);
    d = join(d, brow, 18.0);
    // What follows is small: far from it the face stays as it is.
    if p.y < 45.0 || p.x > 70.0 {
        return d;
    }
    if p.z > -25.0 && p.z < 45.0 {
        d = eye(p, d);
    }
    if p.x < 35.0 && p.z > -50.0 {
        d = join(d, nose(p), 5.0);
    }
    if p.x < 45.0 && p.z < -20.0 {
        d = lips(p, d);
    }
    d
}

fn eye(p: DVec3, face: f64) -> f64 {
    let lids = ellipsoid(p, at(31.5, 69.0, 6.5), at(15.5, 13.6, 13.5));
    let slit = [
        at(20.0, 81.0, 5.5),
        at(26.0, 83.5, 4.5),
        at(34.0, 83.5, 4.2),
        at(42.0, 78.5, 5.5),
    ];
    let hollow = cut(face, sphere(p, at(31.0, 93.0, 7.0), 14.0), 12.0);
    cut(join(hollow, lids, 4.0), chain(p, &slit, 0.7), 1.6)
}

fn nose(p: DVec3) -> f64 {
    let bridge = cone(p, at(0.0, 80.0, 18.0), at(0.0, 98.0, -16.0), 7.0, 7.0);
    let tip = sphere(p, at(0.0, 98.5, -19.5), 8.4);
    let wing = ellipsoid(p, at(9.8, 89.0, -24.0), at(6.4, 9.6, 6.8));
    let root = cone(p, at(0.0, 80.0, 8.0), at(10.0, 82.0, -24.0), 9.0, 12.0);
    let septum = capsule(p, at(0.0, 95.0, -25.0), at(0.0, 86.0, -31.0), 3.4);
    let mut d = join(bridge, tip, 9.0);
    d = join(d, wing, 8.0);
    d = join(d, root, 10.0);
    d = join(d, septum, 4.0);
    cut(d, nostril(p), 1.5)
}

/// The way in: skin does not cover it.
pub(super) fn nostril(p: DVec3) -> f64 {
    let turn = at(7.0, 86.0, -22.0);
    let outside = capsule(p, at(6.4, 92.0, -34.0), turn, 3.3);
    outside.min(capsule(p, turn, at(5.5, 72.0, -20.0), 4.0))
}

fn lips(p: DVec3, face: f64) -> f64 {
    // The groove under the nose.
    let philtrum = capsule(p, at(0.0, 93.5, -32.0), at(0.0, 94.5, -41.0), 2.2);
    let upper = cone(p, at(3.0, 87.4, -45.8), at(12.0, 85.4, -46.8), 4.3, 3.9);
    let upper = upper.min(cone(
        p,
        at(12.0, 85.4, -46.8),
        at(23.0, 78.5, -49.6),
        3.9,
        1.6,
    ));
    let lower = cone(p, at(0.0, 85.8, -53.4), at(11.0, 84.4, -52.8), 5.0, 4.6);
    let lower = lower.min(cone(
        p,
        at(11.0, 84.4, -52.8),
        at(22.0, 78.5, -50.4),
        4.6,
        1.6,
    ));
    let line = cone(p, at(0.0, 92.0, -49.3), at(12.0, 90.0, -49.5), 1.0, 0.9);
    let line = line.min(cone(
        p,
        at(12.0, 90.0, -49.5),
        at(25.0, 81.5, -50.4),
        0.9,
        0.4,
    ));
    let mut d = cut(face, philtrum, 4.0);
    d = join(d, join(upper, lower, 2.0), 8.0);
    d = cut(d, line, 2.6);
    // Under the lower lip the face falls back to the chin.
    cut(
        d,
        capsule(p, at(0.0, 98.0, -66.0), at(14.0, 94.0, -65.0), 7.0),
        12.0,
    )
}

/// A shell that stands off the head, a rim around it, a hollow and a lobe.
fn ear(p: DVec3) -> f64 {
    let center = at(74.0, -14.0, -2.0);
    // Its own axes: forward, outward from the head, up and a little back.
    let q = p - center;
    let forward = 0.90 * q.y + 0.34 * q.x + 0.17 * q.z;
    let outward = 0.94 * q.x - 0.34 * q.y;
    let up = 0.98 * q.z - 0.17 * q.y;
    let local = at(forward, outward, up);
    let disc = ellipsoid(local, at(-2.0, 0.0, 2.0), at(16.0, 4.6, 29.0));
    let around = ((forward + 2.0) / 15.5).hypot((up - 4.0) / 26.0);
    // Open at the front, where the rim runs into the cheek.
    let rim_ring = ((around - 1.0) * 19.0).hypot(outward - 3.0) - 2.9;
    let rim = rim_ring.max(forward - 9.0);
    let inner_ring = ((around - 0.62) * 19.0).hypot(outward - 2.2) - 2.0;
    let inner = inner_ring.max(forward - 1.0).max(up - 16.0);
    let hollow = ellipsoid(local, at(3.0, 4.5, -3.0), at(8.5, 6.0, 11.0));
    let lobe = ellipsoid(local, at(1.0, 0.5, -25.0), at(8.0, 4.0, 9.0));
    let flap = ellipsoid(local, at(11.5, 2.0, -5.0), at(3.5, 3.5, 6.0));
    let mut d = join(disc, rim, 2.5);
    d = join(d, inner, 2.5);
    d = join(d, lobe, 5.0);
    d = cut(d, hollow, 3.0);
    d = join(d, flap, 3.0);
    d
}
