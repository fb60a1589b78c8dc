//! Scattered points: places in the world, each with a value.
//!
//! ```text
//! x_s, f_s, h_s, m_s        place, value, standard deviation, weight of point s
//! ```
//!
//! [`interpolate`] makes a field of them on a grid, [`PointField`] one that is asked anywhere.
//!
//! Knows nothing of files, and nothing of Vulkan.

mod binned;
mod distances;
mod field;
pub mod interpolate;
mod neighbours;

pub use field::{FieldKernel, FieldPoint, PointField, Quantity};

use glam::DVec3;

/// Points with a value each. They cannot be wrong: there is at least one, all lists are as long as that of places, all
/// numbers are finite, standard deviations are over 0 and weights at least 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    places: Vec<DVec3>,
    values: Vec<f32>,
    stds: Vec<f32>,
    /// Whether these are by distances to neighbours.
    has_default_stds: bool,
    weights: Option<Vec<f32>>,
    /// How much higher they lie than they were given.
    stretch: f64,
}

/// Why there are no points.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("point {index}: {what}")]
pub struct NoPoint {
    /// Of the first that is none.
    pub index: usize,
    /// What is wrong with it.
    pub what: &'static str,
}

impl Points {
    /// Points in the world, in its length. Without `stds` they have half the median distance to the nearest neighbour,
    /// all the same, and of few points at least 1/400 of the diagonal of their box; without `weights` they have 1.
    ///
    /// # Errors
    /// Where there is no point, lists have different lengths, or a number is out of its range.
    pub fn new(
        places: Vec<DVec3>,
        values: Vec<f32>,
        stds: Option<Vec<f32>>,
        weights: Option<Vec<f32>>,
    ) -> Result<Self, NoPoint> {
        let count = places.len();
        let fail = |index, what| Err(NoPoint { index, what });
        let lengths = [Some(&values), stds.as_ref(), weights.as_ref()];
        if count == 0 {
            return fail(0, "there is none");
        }
        if let Some(short) = lengths.into_iter().flatten().find(|l| l.len() != count) {
            return fail(short.len().min(count), "lists have different lengths");
        }
        let first = |is_wrong: &dyn Fn(usize) -> bool| (0..count).find(|&i| is_wrong(i));
        if let Some(i) = first(&|i| !places[i].is_finite()) {
            return fail(i, "its place is not finite");
        }
        if let Some(i) = first(&|i| !values[i].is_finite()) {
            return fail(i, "its value is not finite");
        }
        let of = |list: &Option<Vec<f32>>, i: usize| list.as_ref().map_or(1.0, |list| list[i]);
        if let Some(i) = first(&|i| !(of(&stds, i) > 0.0 && of(&stds, i).is_finite())) {
            return fail(i, "its standard deviation is no number over 0");
        }
        if let Some(i) = first(&|i| !(of(&weights, i) >= 0.0 && of(&weights, i).is_finite())) {
            return fail(i, "its weight is no number from 0");
        }
        let has_default_stds = stds.is_none();
        Ok(Self {
            stds: stds.unwrap_or_else(|| default_stds(&places)),
            places,
            values,
            has_default_stds,
            weights,
            stretch: 1.0,
        })
    }

    /// The same with heights stretched along z; widths that are by distances are those of the new places.
    #[must_use]
    pub fn stretched(mut self, factor: f64) -> Self {
        if factor != 1.0 {
            for place in &mut self.places {
                place.z *= factor;
            }
            self.stretch *= factor;
            if self.has_default_stds {
                self.stds = default_stds(&self.places);
            }
        }
        self
    }

    /// How many there are: at least one.
    #[expect(clippy::len_without_is_empty, reason = "there is at least one")]
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Where they are.
    pub fn places(&self) -> &[DVec3] {
        &self.places
    }

    /// Their values.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Their standard deviations, in world length.
    pub fn stds(&self) -> &[f32] {
        &self.stds
    }

    /// Whether these are by distances to neighbours, and not given.
    pub fn has_default_stds(&self) -> bool {
        self.has_default_stds
    }

    /// Their weights.
    pub fn weight(&self, index: usize) -> f32 {
        self.weights.as_ref().map_or(1.0, |weights| weights[index])
    }

    /// The same with one standard deviation for all, in world length; over 0.
    #[must_use]
    pub fn with_std(mut self, std: f32) -> Self {
        assert!(std > 0.0 && std.is_finite(), "a length over 0");
        self.stds.fill(std);
        self.has_default_stds = false;
        self
    }

    /// The median of standard deviations.
    pub fn median_std(&self) -> f64 {
        f64::from(distances::median(self.stds.clone()))
    }

    /// The most points in one cube as wide as the median standard deviation: there the outlines of their splats lie one
    /// upon the other.
    pub fn most_at_one_place(&self) -> usize {
        let edge = self.median_std();
        let cube = |place: &DVec3| (*place / edge).floor().to_array().map(f64::to_bits);
        let mut cubes: Vec<_> = self.places.iter().map(cube).collect();
        cubes.sort_unstable();
        cubes
            .chunk_by(|a, b| a == b)
            .map(<[_]>::len)
            .max()
            .unwrap_or(1)
    }

    /// Smallest and largest value.
    pub fn value_range(&self) -> [f64; 2] {
        let fold = |of: fn(f32, f32) -> f32| self.values.iter().copied().reduce(of);
        [fold(f32::min), fold(f32::max)].map(|value| f64::from(value.expect("at least one")))
    }
}

fn default_stds(places: &[DVec3]) -> Vec<f32> {
    vec![distances::default_std(places) as f32; places.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_at_one_place_are_those_within_a_standard_deviation() {
        let cluster = (0..7).map(|i| DVec3::splat(0.1 * f64::from(i)));
        let apart = (1..30).map(|i| DVec3::X * 2.5 * f64::from(i));
        let places: Vec<_> = cluster.chain(apart).collect();
        let count = places.len();
        let points = Points::new(places, vec![1.0; count], Some(vec![1.0; count]), None);
        assert_eq!(points.expect("points").most_at_one_place(), 7);
    }

    #[test]
    fn stretched_points_are_as_wide_as_their_new_places_ask_for_unless_it_is_given() {
        let places: Vec<_> = (0..20).map(|i| DVec3::Z * f64::from(i)).collect();
        let values = vec![1.0; 20];
        let default = Points::new(places.clone(), values.clone(), None, None).expect("points");
        let high = default.clone().stretched(3.0);
        assert_eq!(high.places()[5], DVec3::Z * 15.0);
        assert_eq!((default.median_std(), high.median_std()), (0.5, 1.5));
        let given = Points::new(places, values, Some(vec![0.25; 20]), None).expect("points");
        assert_eq!(given.stretched(3.0).median_std(), 0.25);
        assert!(default.has_default_stds() && !default.with_std(2.0).has_default_stds());
    }

    #[test]
    fn what_is_no_point_is_refused_by_its_number() {
        let two = || vec![DVec3::ZERO, DVec3::ONE];
        let refused = |places, values, stds, weights| {
            Points::new(places, values, stds, weights)
                .expect_err("no point")
                .to_string()
        };
        assert!(refused(vec![], vec![], None, None).contains("none"));
        assert!(refused(two(), vec![1.0], None, None).contains("lengths"));
        let text = refused(vec![DVec3::ZERO, DVec3::NAN], vec![1.0; 2], None, None);
        assert_eq!(text, "point 1: its place is not finite");
        assert!(refused(two(), vec![1.0, f32::NAN], None, None).contains("point 1: its value"));
        assert!(refused(two(), vec![1.0; 2], Some(vec![1.0, 0.0]), None).contains("deviation"));
        assert!(refused(two(), vec![1.0; 2], None, Some(vec![-1.0, 0.0])).contains("point 0"));
    }
}
