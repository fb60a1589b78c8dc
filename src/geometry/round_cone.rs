//! Where a ray meets a round cone first.
//!
//! ```text
//! u = b - a,  v = o - a,  dr = r_a - r_b,  d2 = u.u - dr^2              d2 <= 0: one sphere holds the other
//! side     d2 |v + t d|^2 - y'^2 + 2 y' dr r_a - u.u r_a^2 = 0,   y' = u.(v + t d)
//!          where 0 < y < d2,  y = y' - r_a dr:  between the circles in which the cone touches the spheres
//! spheres  t = -m - sqrt(m^2 - q + r^2),   m = d.(o - c),  q = |o - c|^2
//! ```
//!
//! It is solid: a ray that begins inside meets its cut, where a sphere of the hull holds the point p. With u = |b - a|,
//! y along the axis and h beside it the nearest of them lies at
//!
//! ```text
//! x = y - h k / sqrt(1 - k^2),  k = dr / u,  0 <= x <= u       inside: |p - c(x)| <= r_a - k x
//! ```
//!
//! The origin of the ray is moved to where it is nearest to the middle, so that nothing is lost far away.

use glam::DVec3;

/// The hull of two spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundCone {
    /// Centres of the spheres, world.
    pub ends: [DVec3; 2],
    /// Their radii, world length.
    pub radii: [f64; 2],
}

/// What a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// How far along the ray, in units of its direction.
    pub distance: f64,
    /// A unit vector out of the surface.
    pub normal: DVec3,
    /// Between the ends: 0 at the first, 1 at the second.
    pub part: f64,
}

impl RoundCone {
    /// Where a ray with a unit direction meets it first; `None` where it does not, and where it begins inside.
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let ([a, b], [ra, rb]) = (self.ends, self.radii);
        let nearer = (0.5 * (a + b) - origin).dot(direction);
        let found = self.hit_from(origin + nearer * direction, direction, [a, b], [ra, rb])?;
        let distance = nearer + found.distance;
        (distance > 0.0).then_some(Hit { distance, ..found })
    }

    /// Where a ray that begins so far along it, at a cut through `face`, meets it first: at the cut where that lies inside.
    pub fn hit_after(
        &self,
        origin: DVec3,
        direction: DVec3,
        begin: f64,
        face: DVec3,
    ) -> Option<Hit> {
        if let Some(part) = self.part_inside(origin + begin * direction) {
            return Some(Hit {
                distance: begin,
                normal: face,
                part,
            });
        }
        // It is convex: what lies behind the cut begins there.
        let found = self.hit(origin, direction);
        found.filter(|hit| hit.distance >= begin)
    }

    /// Between the ends, where it holds a point.
    fn part_inside(&self, p: DVec3) -> Option<f64> {
        let ([a, b], [ra, rb]) = (self.ends, self.radii);
        let (axis, from) = (b - a, p - a);
        let length = axis.length();
        // One sphere holds the other: cosines past their ends.
        let slope = ((ra - rb) / length.max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0);
        let along = axis.normalize_or_zero();
        let y = from.dot(along);
        let beside = (from - y * along).length();
        let nearest = match slope.abs() < 1.0 {
            true => y - beside * slope / (1.0 - slope * slope).sqrt(),
            false if slope > 0.0 => 0.0,
            false => length,
        };
        let x = nearest.clamp(0.0, length);
        let radius = match x {
            0.0 => ra,
            x => ra + (rb - ra) * (x / length),
        };
        let is_inside = (from - x * along).length_squared() <= radius * radius;
        is_inside.then(|| x / length.max(f64::MIN_POSITIVE))
    }

    fn hit_from(&self, o: DVec3, d: DVec3, [a, b]: [DVec3; 2], [ra, rb]: [f64; 2]) -> Option<Hit> {
        let (ba, oa, ob) = (b - a, o - a, o - b);
        let rr = ra - rb;
        let (m0, m1, m2, m3) = (ba.dot(ba), ba.dot(oa), ba.dot(d), d.dot(oa));
        let (m5, m6, m7) = (oa.dot(oa), ob.dot(d), ob.dot(ob));
        let d2 = m0 - rr * rr;
        if d2 > 0.0 {
            let k2 = d2 - m2 * m2;
            let k1 = d2 * m3 - m1 * m2 + m2 * rr * ra;
            let k0 = d2 * m5 - m1 * m1 + 2.0 * m1 * rr * ra - m0 * ra * ra;
            let h = k1 * k1 - k0 * k2;
            if h < 0.0 {
                return None;
            }
            // Along the axis of a cylinder there is no side.
            let t = (-h.sqrt() - k1) / k2;
            let y = m1 - ra * rr + t * m2;
            if k2 != 0.0 && y > 0.0 && y < d2 {
                return Some(Hit {
                    distance: t,
                    normal: (d2 * (oa + t * d) - y * ba).normalize_or_zero(),
                    part: y / d2,
                });
            }
        }
        let sphere = |m: f64, q: f64, r: f64, part: f64, from: DVec3| {
            let h = m * m - q + r * r;
            (h >= 0.0).then(|| {
                let distance = -m - h.sqrt();
                Hit {
                    distance,
                    normal: (from + distance * d) / r,
                    part,
                }
            })
        };
        let [first, second] = [sphere(m3, m5, ra, 0.0, oa), sphere(m6, m7, rb, 1.0, ob)];
        match (first, second) {
            (Some(first), Some(second)) if second.distance < first.distance => Some(second),
            (first, second) => first.or(second),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    /// Distance to the surface: the least over all spheres of the hull, found by trying.
    fn distance(cone: &RoundCone, p: DVec3) -> f64 {
        let ([a, b], [ra, rb]) = (cone.ends, cone.radii);
        let of = |s: f64| (p - a.lerp(b, s)).length() - (ra + s * (rb - ra));
        // The distance is convex in s: by golden sections.
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..100 {
            let (x, y) = (
                low + (high - low) * 0.381_966,
                low + (high - low) * 0.618_034,
            );
            match of(x) < of(y) {
                true => high = y,
                false => low = x,
            }
        }
        of(0.5 * (low + high))
    }

    /// By steps that never pass a surface.
    fn traced(cone: &RoundCone, o: DVec3, d: DVec3) -> Option<f64> {
        let mut t = 0.0;
        for _ in 0..4000 {
            let step = distance(cone, o + t * d);
            if step < 1e-12 {
                return Some(t);
            }
            t += step;
            if t > 100.0 {
                return None;
            }
        }
        Some(t)
    }

    fn cones() -> [RoundCone; 4] {
        let cone = |a, b, radii| RoundCone {
            ends: [a, b],
            radii,
        };
        [
            cone(dvec3(-1.0, 0.2, 0.3), dvec3(1.2, -0.4, 0.1), [0.5, 0.2]),
            cone(dvec3(0.0, 0.0, -1.0), dvec3(0.0, 0.5, 1.0), [0.3, 0.3]),
            cone(dvec3(0.1, 0.0, 0.0), dvec3(0.2, 0.0, 0.0), [0.9, 0.3]),
            cone(dvec3(0.5, 0.5, 0.5), dvec3(0.5, 0.5, 0.5), [0.7, 0.7]),
        ]
    }

    #[test]
    fn rays_meet_cones_where_steps_along_them_do() {
        let mut hits = 0;
        for cone in &cones() {
            for i in 0..400 {
                let turn = f64::from(i) * 2.399_963;
                let height = f64::from(i) / 200.0 - 0.9975;
                let side = (1.0 - height * height).sqrt();
                let o = 6.0 * dvec3(side * turn.cos(), side * turn.sin(), height);
                let aim = dvec3(
                    0.7 * (3.0 * turn).sin(),
                    0.6 * turn.cos(),
                    0.5 * (2.0 * turn).cos(),
                );
                let d = (aim - o).normalize();
                let (found, wanted) = (cone.hit(o, d), traced(cone, o, d));
                let Some(found) = found else {
                    // A grazing ray may be told either way.
                    assert!(
                        wanted.is_none_or(|t| distance(cone, o + t * d).abs() > 1e-9 || {
                            (0..100)
                                .all(|k| distance(cone, o + (t + f64::from(k) * 1e-3) * d) > -1e-6)
                        })
                    );
                    continue;
                };
                hits += 1;
                let wanted = wanted.expect("a hit");
                assert!((found.distance - wanted).abs() < 1e-6, "{cone:?} {i}");
                // The normal is the gradient of the distance.
                let p = o + found.distance * d;
                for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                    let slope =
                        (distance(cone, p + 1e-5 * axis) - distance(cone, p - 1e-5 * axis)) / 2e-5;
                    assert!(
                        (slope - found.normal.dot(axis)).abs() < 1e-5,
                        "{cone:?} {i}"
                    );
                }
                assert!((0.0..=1.0).contains(&found.part));
            }
        }
        assert!(hits > 400, "{hits}");
    }

    #[test]
    fn a_ray_that_begins_inside_meets_the_cut_and_one_behind_nothing() {
        let (mut cuts, mut surfaces, mut missed) = (0, 0, 0);
        for cone in &cones() {
            for i in 0..900 {
                let turn = f64::from(i) * 2.399_963;
                let aim = dvec3((3.0 * turn).sin(), turn.cos(), (2.0 * turn).cos());
                let o = dvec3(4.0 * turn.sin(), 4.0 * (0.7 * turn).cos(), 5.0);
                let d = (0.8 * aim - o).normalize();
                let begin = 3.0 + 0.004 * f64::from(i);
                let inside = distance(cone, o + begin * d);
                if inside.abs() < 1e-9 {
                    continue;
                }
                let found = cone.hit_after(o, d, begin, DVec3::Z);
                if inside < 0.0 {
                    let found = found.expect("the cut");
                    assert_eq!((found.distance, found.normal), (begin, DVec3::Z));
                    assert!((0.0..=1.0).contains(&found.part));
                    cuts += 1;
                    continue;
                }
                assert_eq!(found, cone.hit(o, d).filter(|hit| hit.distance >= begin));
                match found {
                    Some(_) => surfaces += 1,
                    None => missed += 1,
                }
            }
        }
        let counts = [cuts, surfaces, missed];
        assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
    }

    #[test]
    fn far_away_nothing_is_lost() {
        let cone = cones()[0];
        for scale in [1e3, 1e6] {
            let d = dvec3(0.3, -0.2, 0.93).normalize();
            let o = dvec3(0.1, 0.0, 0.2) - scale * d;
            let near = cone.hit(o + (scale - 5.0) * d, d).expect("a hit").distance;
            let far = cone.hit(o, d).expect("a hit").distance;
            // Rounding of the origin itself.
            assert!((far - (scale - 5.0) - near).abs() < 4.0 * scale * f64::EPSILON + 1e-12);
        }
    }

    #[test]
    fn what_lies_behind_or_around_the_eye_is_not_met() {
        let cone = cones()[3];
        assert!(cone.hit(dvec3(0.5, 0.5, 0.5), DVec3::X).is_none());
        assert!(cone.hit(dvec3(5.0, 0.5, 0.5), DVec3::X).is_none());
        assert!(cone.hit(dvec3(5.0, 0.5, 0.5), DVec3::NEG_X).is_some());
    }
}
