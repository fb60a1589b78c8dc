//! Where a ray meets a triangle.
//!
//! ```text
//! a, b, c from the origin of the ray      w_a = d.(b x c),  w_b = d.(c x a),  w_c = d.(a x b)
//! met where no two of them differ in sign;   at  (w_a a + w_b b + w_c c) / (w_a + w_b + w_c)
//! ```
//!
//! An edge has exactly the opposite weight in the triangle on its other side, so that no ray passes between two that share
//! it (Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013).

use glam::DVec3;

/// What a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// How far along the ray, in units of its direction.
    pub distance: f64,
    /// What part of it each corner is; their sum is 1.
    pub weights: [f64; 3],
}

/// Where a ray with a unit direction meets a triangle, from either side; `None` where it does not, where it lies in its
/// plane, and where the triangle is behind the origin.
pub fn triangle_hit(corners: [DVec3; 3], origin: DVec3, direction: DVec3) -> Option<TriangleHit> {
    let [a, b, c] = corners.map(|corner| corner - origin);
    let weights = [b.cross(c), c.cross(a), a.cross(b)].map(|normal| direction.dot(normal));
    let is_outside = weights.iter().any(|&w| w < 0.0) && weights.iter().any(|&w| w > 0.0);
    let sum: f64 = weights.iter().sum();
    if is_outside || sum == 0.0 {
        return None;
    }
    let weights = weights.map(|w| w / sum);
    let place = weights[0] * a + weights[1] * b + weights[2] * c;
    let distance = place.dot(direction);
    (distance > 0.0).then_some(TriangleHit { distance, weights })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    const CORNERS: [DVec3; 3] = [
        DVec3::new(1.0, 0.0, 2.0),
        DVec3::new(-0.5, 1.5, 1.0),
        DVec3::new(0.0, -1.0, 3.0),
    ];

    #[test]
    fn a_ray_to_a_place_of_a_triangle_meets_it_there_from_both_sides() {
        let [a, b, c] = CORNERS;
        for i in 1..20 {
            for j in 1..20 - i {
                let [s, t] = [i, j].map(|n| f64::from(n) / 20.0);
                let wanted = [1.0 - s - t, s, t];
                let place = wanted[0] * a + s * b + t * c;
                for origin in [dvec3(0.3, 0.2, -7.0), dvec3(4.0, -3.0, 900.0)] {
                    let way = place - origin;
                    let hit = triangle_hit(CORNERS, origin, way.normalize()).expect("a hit");
                    assert!((hit.distance - way.length()).abs() < 1e-11);
                    for (found, wanted) in hit.weights.into_iter().zip(wanted) {
                        assert!((found - wanted).abs() < 1e-10, "{hit:?}");
                    }
                    assert!(triangle_hit(CORNERS, origin, -way.normalize()).is_none());
                }
                // As far on the other side of an edge.
                for (outside, edge) in [(a, 0.5 * (b + c)), (b, 0.5 * (c + a)), (c, 0.5 * (a + b))]
                {
                    let beyond = place + (s + 1.0) * (edge - outside) + (edge - place);
                    let origin = dvec3(0.3, 0.2, -7.0);
                    assert!(triangle_hit(CORNERS, origin, (beyond - origin).normalize()).is_none());
                }
            }
        }
    }

    #[test]
    fn no_ray_passes_between_triangles_that_share_an_edge() {
        // A fan around a corner; rays to places on its edges, which rounding puts on either side.
        let rim = |i: u32| {
            let turn = f64::from(i) * 0.7;
            dvec3(turn.cos(), turn.sin() * 1.1, 0.3 * (3.0 * turn).sin())
        };
        let middle = dvec3(0.01, 0.02, 0.1);
        for i in 0..8 {
            for k in 0..500 {
                let place = middle.lerp(rim(i + 1), f64::from(k) / 501.0 + 1e-3);
                let origin = dvec3(3.0, -2.0, 11.0);
                let direction = (place - origin).normalize();
                let is_met = |j: u32| {
                    triangle_hit([middle, rim(j), rim(j + 1)], origin, direction).is_some()
                };
                assert!(is_met(i) || is_met(i + 1), "edge {i}, place {k}");
            }
        }
    }

    #[test]
    fn a_triangle_without_area_is_never_met() {
        let line = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
        let origin = dvec3(0.5, 0.0, 3.0);
        assert!(triangle_hit(line, origin, DVec3::NEG_Z).is_none());
        assert!(triangle_hit([DVec3::X; 3], origin, DVec3::NEG_Z).is_none());
    }
}
