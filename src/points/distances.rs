//! How far points are from their nearest neighbours.
//!
//! ```text
//! default standard deviation = max(median over points of |x_s - nearest other place| / 2, d / 400 min(1, (4096 / n)^(1/3)))
//! ```
//!
//! with d the diagonal of the box of n points. The second is what is seen of points that lie in clusters, much nearer to
//! each other than the pixels of a picture.
//!
//! Points are sorted into cells of about one each; around a point, shells of cells are searched until no nearer one can
//! lie beyond. Of many points some stand for all, fewer the more there are: a search may look at all points.

use glam::{DVec3, IVec3};
use std::collections::HashMap;

/// So many points are asked for their neighbours.
const MOST_ASKED: usize = 4096;
/// Distances that are taken at most, where all points lie in one cell.
const MOST_DISTANCES: usize = 1 << 28;
/// Parts of the diagonal of the box that a standard deviation of few points is at least.
const THINNEST: f64 = 400.0;
/// So many are few.
const FEW: f64 = 4096.0;
/// Cells along an edge of the box, at most.
const MOST_CELLS: f64 = 1024.0;

/// The formula above; of points that all lie at one place, 1.
pub(super) fn default_std(places: &[DVec3]) -> f64 {
    let [low, high] = bounds(places.iter().copied());
    let extent = high - low;
    let longest = extent.max_element();
    if longest <= 0.0 {
        return 1.0;
    }
    // Points may lie on a line or in a plane: flat sides count as a cell.
    let axes = extent
        .to_array()
        .into_iter()
        .filter(|&e| e > 1e-6 * longest);
    let (volume, dimensions) = axes.fold((1.0, 0), |(v, d), e| (v * e, d + 1));
    let cell = (volume / places.len() as f64)
        .powf(1.0 / f64::from(dimensions))
        .max(longest / MOST_CELLS);
    let cell_of = |p: DVec3| ((p - low) / cell).floor().as_ivec3();
    let mut cells: HashMap<IVec3, Vec<u32>> = HashMap::new();
    for (i, &place) in places.iter().enumerate() {
        cells.entry(cell_of(place)).or_default().push(i as u32);
    }
    let last = cell_of(high);
    let nearest = |place: DVec3| {
        let home = cell_of(place);
        let mut best = f64::INFINITY;
        let farthest = last.max_element() + 1;
        for shell in 0..=farthest {
            // All of the next shell is farther than this.
            if best <= f64::from(shell - 1) * cell {
                break;
            }
            for other in shell_of(home, shell, last) {
                for &i in cells.get(&other).into_iter().flatten() {
                    let distance = places[i as usize].distance(place);
                    if distance > 0.0 {
                        best = best.min(distance);
                    }
                }
            }
        }
        best as f32
    };
    let found = places
        .iter()
        .step_by(step_of(places.len()))
        .map(|&place| nearest(place));
    let half = 0.5 * f64::from(median(found.collect()));
    let share = (FEW / places.len() as f64).cbrt().min(1.0);
    half.max(extent.length() / THINNEST * share)
}

/// Of so many points one in this many is asked.
fn step_of(count: usize) -> usize {
    let asked = MOST_ASKED.min(MOST_DISTANCES / count).max(1);
    count.div_ceil(asked)
}

/// Cells at Chebyshev distance `shell` from `home`, as far as there are any.
fn shell_of(home: IVec3, shell: i32, last: IVec3) -> impl Iterator<Item = IVec3> {
    let low = (home - shell).max(IVec3::ZERO);
    let high = (home + shell).min(last);
    let is_end = move |z: i32, y: i32| (z - home.z).abs() == shell || (y - home.y).abs() == shell;
    (low.z..=high.z).flat_map(move |z| {
        (low.y..=high.y).flat_map(move |y| {
            let step = if is_end(z, y) { 1 } else { (2 * shell).max(1) };
            let first = if is_end(z, y) { low.x } else { home.x - shell };
            (first..=high.x)
                .step_by(step as usize)
                .filter(move |&x| x >= low.x)
                .map(move |x| IVec3::new(x, y, z))
        })
    })
}

/// Corners of the box around places.
pub(super) fn bounds(places: impl IntoIterator<Item = DVec3>) -> [DVec3; 2] {
    let start = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    places.into_iter().fold(start, |[low, high], place| {
        [low.min(place), high.max(place)]
    })
}

/// The upper median; NaN of none.
pub(super) fn median(mut numbers: Vec<f32>) -> f32 {
    let middle = numbers.len() / 2;
    if numbers.is_empty() {
        return f32::NAN;
    }
    *numbers.select_nth_unstable_by(middle, f32::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shells_find_the_nearest_as_a_search_through_all_does() {
        let mut state = 5_u32;
        let mut unit = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24)
        };
        for flat in [DVec3::ONE, glam::dvec3(1.0, 1.0, 0.0), DVec3::X] {
            let mut place = || glam::dvec3(unit(), unit(), unit()) * flat;
            let places: Vec<_> = (0..400).map(|_| place() * 7.0 - 3.0).collect();
            let brute = |p: &DVec3| {
                let others = places.iter().map(|q| q.distance(*p)).filter(|&d| d > 0.0);
                others.fold(f64::INFINITY, f64::min) as f32
            };
            let half = 0.5 * f64::from(median(places.iter().map(brute).collect()));
            // 400 are few.
            let [low, high] = bounds(places.iter().copied());
            assert_eq!(
                default_std(&places),
                half.max((high - low).length() / 400.0)
            );
        }
    }

    #[test]
    fn many_points_in_one_cell_are_not_all_asked_for_all_others() {
        for count in [1_usize, 1707, 65_536, 1_000_000, 300_000_000] {
            let asked = count.div_ceil(step_of(count));
            assert!(
                asked == 1 || asked * count <= MOST_DISTANCES,
                "{count}: {asked}"
            );
        }
        assert_eq!([1, 1707, 4096].map(step_of), [1; 3]);
    }

    #[test]
    fn points_at_one_place_have_a_width_too() {
        assert_eq!(default_std(&[DVec3::ONE; 3]), 1.0);
        let two = [DVec3::ZERO, DVec3::X * 3.0];
        assert_eq!(default_std(&two), 1.5);
    }
}
