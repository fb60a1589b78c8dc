//! Distances to simple bodies, negative inside, millimetres; those of ellipsoids and cones are close to
//! the truth near their surface only, which is where they count.
//!
//! Quilez, "Distance functions" and "Smooth minimum", iquilezles.org: the formulas.

use glam::{DVec2, DVec3};

/// A point or three half axes.
pub(super) const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// k0 (k0 - 1) / k1 with k0 = |p / r|, k1 = |p / r^2|.
pub(super) fn ellipsoid(p: DVec3, center: DVec3, radii: DVec3) -> f64 {
    let q = (p - center) / radii;
    let k0 = q.length();
    let k1 = (q / radii).length();
    k0 * (k0 - 1.0) / k1.max(1e-9)
}

/// [`ellipsoid`], turned about the x axis: its y axis rises by the angle whose sine and cosine are given.
pub(super) fn tilted_ellipsoid(p: DVec3, center: DVec3, radii: DVec3, rise: DVec2) -> f64 {
    let q = p - center;
    let turned = at(
        q.x,
        q.y * rise.x + q.z * rise.y,
        q.z * rise.x - q.y * rise.y,
    );
    ellipsoid(turned, DVec3::ZERO, radii)
}

pub(super) fn sphere(p: DVec3, center: DVec3, radius: f64) -> f64 {
    (p - center).length() - radius
}

pub(super) fn capsule(p: DVec3, a: DVec3, b: DVec3, radius: f64) -> f64 {
    cone(p, a, b, radius, radius)
}

/// A capsule whose radius goes from `radius_a` to `radius_b`.
pub(super) fn cone(p: DVec3, a: DVec3, b: DVec3, radius_a: f64, radius_b: f64) -> f64 {
    let (pa, ba) = (p - a, b - a);
    let h = (pa.dot(ba) / ba.length_squared()).clamp(0.0, 1.0);
    (pa - h * ba).length() - (radius_a + h * (radius_b - radius_a))
}

/// The nearest of capsules from point to point.
pub(super) fn chain(p: DVec3, points: &[DVec3], radius: f64) -> f64 {
    let links = points.windows(2);
    links.fold(f64::INFINITY, |d, ends| {
        d.min(capsule(p, ends[0], ends[1], radius))
    })
}

/// The union with a fillet of width `k`: min(a, b) - h^2 k / 4, h = max(k - |a - b|, 0) / k.
pub(super) fn join(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k / 4.0
}

/// `a` without `b`, with a fillet of width `k`.
pub(super) fn cut(a: f64, b: f64, k: f64) -> f64 {
    -join(-a, b, k)
}

/// 3f^2 - 2f^3 between `low` and `high`.
pub(super) fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let f = ((x - low) / (high - low)).clamp(0.0, 1.0);
    f * f * (3.0 - 2.0 * f)
}
