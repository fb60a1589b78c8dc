//! Points at one place become one: its value is the mean by weight (the plain mean where no weight is above 0), its weight
//! their sum.

use glam::DVec3;

/// Places that differ, in the order in which they came first.
#[derive(Clone, Debug)]
pub(super) struct Distinct {
    pub places: Vec<DVec3>,
    pub values: Vec<f64>,
    pub weights: Vec<f64>,
    /// Places that stand for several points.
    pub merged: usize,
}

impl Distinct {
    /// Of places with their values and weights.
    pub fn of(points: impl Iterator<Item = (DVec3, f64, f64)>) -> Self {
        let all: Vec<(DVec3, f64, f64)> = points.collect();
        // The two zeros are one place.
        let bits = |i: u32| all[i as usize].0.to_array().map(|x| (x + 0.0).to_bits());
        let mut order: Vec<u32> = (0..all.len() as u32).collect();
        order.sort_unstable_by_key(|&i| (bits(i), i));
        let mut groups: Vec<&[u32]> = order.chunk_by(|&a, &b| bits(a) == bits(b)).collect();
        groups.sort_unstable_by_key(|group| group[0]);
        let mut distinct = Self {
            places: Vec::with_capacity(groups.len()),
            values: Vec::with_capacity(groups.len()),
            weights: Vec::with_capacity(groups.len()),
            merged: groups.iter().filter(|group| group.len() > 1).count(),
        };
        for group in groups {
            let points = || group.iter().map(|&i| all[i as usize]);
            let weight: f64 = points().map(|(_, _, weight)| weight).sum();
            let value = match group {
                [one] => all[*one as usize].1,
                _ if weight > 0.0 => points().map(|(_, value, w)| w * value).sum::<f64>() / weight,
                _ => points().map(|(_, value, _)| value).sum::<f64>() / group.len() as f64,
            };
            distinct
                .places
                .push(points().next().expect("at least one").0);
            distinct.values.push(value);
            distinct.weights.push(weight);
        }
        distinct
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_at_one_place_are_their_mean_and_the_order_stays() {
        let [a, b] = [DVec3::ONE, DVec3::ZERO];
        let points = [(a, 1.0, 1.0), (b, 5.0, 0.0), (a, 4.0, 2.0), (-b, 7.0, 0.0)];
        let distinct = Distinct::of(points.into_iter());
        assert_eq!(distinct.places, [a, b]);
        assert_eq!(distinct.values, [3.0, 6.0]);
        assert_eq!(distinct.weights, [3.0, 0.0]);
        assert_eq!(distinct.merged, 2);
    }
}
