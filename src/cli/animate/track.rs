//! Numbers that change along a film: some keys, and what lies between them.
//!
//! With keys `x_k` at `u_k`, and `s = (u - u_k) / (u_k+1 - u_k)`:
//!
//! ```text
//! linear    x = x_k + s (x_k+1 - x_k)
//! smooth    x = h(s), the cubic with h(0) = x_k, h(1) = x_k+1 and the slopes m_k, m_k+1
//!           m_k = (x_k+1 - x_k-1) / (u_k+1 - u_k-1), at an end that of the only neighbour
//! ```
//!
//! The second is the spline of Catmull and Rom ("A class of local interpolating splines", 1974) for keys at any
//! distance. Before the first key and after the last one their numbers hold.

use serde::Deserialize;

/// What lies between two keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Easing {
    /// A straight line.
    #[default]
    Linear,
    /// A curve without corners, which may swing beyond its keys.
    Smooth,
}

/// `N` numbers along a film.
#[derive(Clone, Debug, PartialEq)]
pub struct Track<const N: usize> {
    keys: Vec<(f64, [f64; N])>,
    easing: Easing,
}

impl<const N: usize> Track<N> {
    /// With these keys, at places that ascend.
    pub fn new(keys: Vec<(f64, [f64; N])>, easing: Easing) -> Self {
        Self { keys, easing }
    }

    /// True where no key says anything.
    pub fn is_empty(&self) -> bool {
        self.keys.is_empty()
    }

    /// The numbers at `u`; `None` without a key.
    pub fn at(&self, u: f64) -> Option<[f64; N]> {
        let passed = self.keys.iter().take_while(|key| key.0 <= u).count();
        let after = self.keys.get(passed);
        let Some(k) = passed.checked_sub(1) else {
            return after.map(|key| key.1);
        };
        let (u0, x0) = self.keys[k];
        let Some(&(u1, x1)) = after else {
            return Some(x0);
        };
        let s = (u - u0) / (u1 - u0);
        if self.easing == Easing::Linear || s == 0.0 {
            return Some(std::array::from_fn(|c| x0[c] + s * (x1[c] - x0[c])));
        }
        let (m0, m1) = (self.slope(k), self.slope(k + 1));
        let width = u1 - u0;
        // Hermite's four cubics.
        let (s2, s3) = (s * s, s * s * s);
        let (h00, h10) = (2.0 * s3 - 3.0 * s2 + 1.0, s3 - 2.0 * s2 + s);
        let (h01, h11) = (3.0 * s2 - 2.0 * s3, s3 - s2);
        Some(std::array::from_fn(|c| {
            h00 * x0[c] + h10 * width * m0[c] + h01 * x1[c] + h11 * width * m1[c]
        }))
    }

    fn slope(&self, k: usize) -> [f64; N] {
        let (u0, x0) = self.keys[k.saturating_sub(1)];
        let (u1, x1) = self.keys[(k + 1).min(self.keys.len() - 1)];
        std::array::from_fn(|c| (x1[c] - x0[c]) / (u1 - u0))
    }
}

impl Track<1> {
    /// The one number at `u`.
    pub fn number(&self, u: f64) -> Option<f64> {
        self.at(u).map(|[x]| x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(keys: &[(f64, f64)], easing: Easing) -> Track<1> {
        Track::new(keys.iter().map(|&(u, x)| (u, [x])).collect(), easing)
    }

    #[test]
    fn a_line_goes_from_key_to_key_and_holds_at_its_ends() {
        let line = track(&[(0.25, 10.0), (0.75, 20.0), (1.0, 0.0)], Easing::Linear);
        for (u, wanted) in [
            (0.0, 10.0),
            (0.25, 10.0),
            (0.375, 12.5),
            (0.75, 20.0),
            (0.875, 10.0),
            (1.0, 0.0),
        ] {
            assert_eq!(line.number(u), Some(wanted), "at {u}");
        }
        assert_eq!(track(&[], Easing::Linear).number(0.5), None);
        assert_eq!(track(&[(0.5, 3.0)], Easing::Smooth).number(0.1), Some(3.0));
    }

    #[test]
    fn a_smooth_track_meets_its_keys_and_keeps_a_parabola_away_from_the_ends() {
        // The slope between the neighbours at equal distances is that of the parabola itself.
        let keys: Vec<_> = (0..=4).map(|k| (f64::from(k), f64::from(k * k))).collect();
        let smooth = track(&keys, Easing::Smooth);
        for (u, x) in keys {
            assert_eq!(smooth.number(u), Some(x), "at {u}");
        }
        for u in [1.25, 1.5, 2.75] {
            let found = smooth.number(u).expect("a number");
            assert!((found - u * u).abs() < 1e-14, "at {u}: {found}");
        }
        // At an end the slope is that to the neighbour: h = 1 h01 + 1 h10 + 2 h11 = 0.5 + 0.125 - 0.25.
        assert_eq!(smooth.number(0.5), Some(0.375));
    }

    #[test]
    fn two_keys_make_a_line_in_both_ways() {
        let keys = [(0.0, -1.0), (1.0, 7.0)];
        let (line, smooth) = (track(&keys, Easing::Linear), track(&keys, Easing::Smooth));
        for u in [0.0, 0.25, 0.5, 0.9, 1.0] {
            let apart = line.number(u).expect("a number") - smooth.number(u).expect("a number");
            assert!(apart.abs() < 1e-15, "at {u}: {apart}");
        }
    }
}
