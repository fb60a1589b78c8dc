//! Matter without an end, by Chandrasekhar's H functions (1950):
//!
//! ```text
//! 1 / H(mu) = sqrt(1 - w) + w/2 integral of m H(m) / (mu + m) over m from 0 to 1            w the albedo
//! L = w/4 mu0 / (mu + mu0) H(mu) H(mu0)
//! ```

use super::{assert_near, at, light, radiance};
use stratavox::technique::pathtrace::PathTracing;

/// H of one albedo: cosines, their weights in integrals over 0 to 1, and its values there.
struct H {
    albedo: f64,
    nodes: Vec<[f64; 3]>,
}

impl H {
    /// Midpoints of u, m = u^3 (10 - 15 u + 6 u^2): flat at both ends, where the slope of H has none.
    fn of(albedo: f64) -> Self {
        const COUNT: u32 = 100;
        // Behind them H of .99 changes by 4e-10, of others by less.
        const TURNS: u32 = 100;
        let node = |i: u32| {
            let u = (f64::from(i) + 0.5) / f64::from(COUNT);
            let weight = 30.0 * (u * (1.0 - u)).powi(2) / f64::from(COUNT);
            [u.powi(3) * (10.0 + u * (6.0 * u - 15.0)), weight, 1.0]
        };
        let mut h = Self {
            albedo,
            nodes: (0..COUNT).map(node).collect(),
        };
        for _ in 0..TURNS {
            let next: Vec<f64> = h.nodes.iter().map(|node| h.at(node[0])).collect();
            for (node, next) in h.nodes.iter_mut().zip(next) {
                node[2] = next;
            }
        }
        h
    }

    fn at(&self, mu: f64) -> f64 {
        let parts = self
            .nodes
            .iter()
            .map(|[m, weight, h]| weight * m * h / (mu + m));
        let of_all = 0.5 * self.albedo * parts.sum::<f64>();
        1.0 / ((1.0 - self.albedo).sqrt() + of_all)
    }
}

#[test]
fn h_functions_are_those_of_the_table() {
    for (albedo, table) in [
        (
            0.5,
            [1.0, 1.07237, 1.11346, 1.14389, 1.18774, 1.21856, 1.25126],
        ),
        (
            0.9,
            [1.0, 1.17214, 1.29143, 1.39135, 1.55603, 1.68935, 1.85010],
        ),
        (
            0.99,
            [1.0, 1.22488, 1.39977, 1.55871, 1.84860, 2.11262, 2.47279],
        ),
    ] {
        let h = H::of(albedo);
        for (mu, wanted) in [0.0, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0].into_iter().zip(table) {
            let found = h.at(mu);
            assert!(
                (found - wanted).abs() < 1e-5,
                "{albedo} {mu}: {found}, {wanted}"
            );
        }
        let integral: f64 = h.nodes.iter().map(|[_, weight, h]| weight * h).sum();
        let squared = (1.0 - 0.5 * albedo * integral).powi(2);
        assert!(
            (squared - (1.0 - albedo)).abs() < 1e-5,
            "{albedo}: {squared}"
        );
    }
}

#[test]
fn matter_without_an_end_reflects_what_chandrasekhar_says() {
    for (albedo, mu, mu0) in [(0.9, 1.0, 1.0), (0.9, 0.5, 0.8), (0.99, 0.7, 0.3)] {
        let path = PathTracing {
            samples: 24,
            albedo,
            lights: vec![light(at(mu0, 1.0))],
            ..PathTracing::default()
        };
        let h = H::of(albedo);
        let wanted = 0.25 * albedo * mu0 / (mu + mu0) * h.at(mu) * h.at(mu0);
        let found = radiance(path, 60.0, mu);
        assert_near(&format!("{albedo} {mu} {mu0}"), found, wanted);
    }
}
