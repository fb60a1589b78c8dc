//! From unevenly spaced points on an axis to evenly spaced ones: between which two points each lies, and where.

/// Two neighbours of a point: the index of the first, and how far the point lies towards the next, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Knot {
    pub first: u32,
    pub weight: f64,
}

/// Points farther from their even place than this part of a step make an axis uneven.
const EVEN: f64 = 0.01;

/// A resampled axis has at most so many times the points it had,
const MOST_TIMES: usize = 4;
/// and no more than these, unless it had more.
const MOST_POINTS: usize = 512;

/// True where all points lie where evenly spaced ones between the first and the last would.
pub(super) fn is_even(points: &[f64]) -> bool {
    let Some(step) = step(points, points.len()) else {
        return true;
    };
    let first = points.first().copied().unwrap_or(0.0);
    points
        .iter()
        .enumerate()
        .all(|(i, point)| (point - (first + step * i as f64)).abs() <= EVEN * step.abs())
}

/// True where every point lies beyond the one before it, all in one direction.
pub(super) fn is_monotone(points: &[f64]) -> bool {
    let all = |beyond: fn(f64, f64) -> bool| {
        let pairs = points.iter().zip(points.iter().skip(1));
        pairs.into_iter().all(|(a, b)| beyond(*a, *b))
    };
    points.iter().all(|point| point.is_finite()) && (all(|a, b| a < b) || all(|a, b| a > b))
}

/// The distance between `count` evenly spaced points over the same stretch.
pub(super) fn step(points: &[f64], count: usize) -> Option<f64> {
    let gaps = count.checked_sub(1).filter(|&gaps| gaps > 0)?;
    Some((points.last()? - points.first()?) / gaps as f64)
}

/// How many evenly spaced points are as near to each other as the nearest of `points`, within reason.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "bounded from both sides before the cast"
)]
pub(super) fn even_count(points: &[f64]) -> usize {
    let pairs = points.iter().zip(points.iter().skip(1));
    let nearest = pairs
        .map(|(a, b)| (b - a).abs())
        .fold(f64::INFINITY, f64::min);
    let stretch = match (points.first(), points.last()) {
        (Some(first), Some(last)) => (last - first).abs(),
        _ => 0.0,
    };
    let most = points
        .len()
        .max(points.len().saturating_mul(MOST_TIMES).min(MOST_POINTS));
    let gaps = (stretch / nearest).ceil();
    let finest = if gaps < most as f64 {
        gaps as usize
    } else {
        most
    };
    finest.saturating_add(1).clamp(points.len(), most)
}

/// The neighbours of `count` evenly spaced points among `points`, which are monotone and at least two.
pub(super) fn knots(points: &[f64], count: usize) -> Vec<Knot> {
    let first = points.first().copied().unwrap_or(0.0);
    let step = step(points, count).unwrap_or(0.0);
    let last_pair = points.len().saturating_sub(2);
    let mut at = 0_usize;
    (0..count)
        .map(|i| {
            let place = first + step * i as f64;
            // How far along the axis a place is, whichever way it runs.
            let along = |point: f64| (point - first) * step.signum();
            while at < last_pair
                && points
                    .get(at.saturating_add(1))
                    .is_some_and(|&next| along(next) <= along(place))
            {
                at = at.saturating_add(1);
            }
            let pair = points.get(at).zip(points.get(at.saturating_add(1)));
            let weight = pair.map_or(0.0, |(a, b)| ((place - a) / (b - a)).clamp(0.0, 1.0));
            Knot {
                first: u32::try_from(at).unwrap_or(u32::MAX),
                weight,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evenly_spaced_points_are_found_so_whichever_way_they_run() {
        assert!(is_even(&[3.0, 2.0, 1.0, 0.0]));
        assert!(is_even(&[0.333, 0.667, 1.0, 1.333]));
        assert!(is_even(&[5.0]) && is_even(&[]));
        assert!(!is_even(&[1000.0, 850.0, 700.0, 500.0]));
    }

    #[test]
    fn the_finest_distance_is_kept_within_reason() {
        assert_eq!(even_count(&[0.0, 1.0, 3.0, 6.0]), 7);
        assert_eq!(even_count(&[0.0, 0.001, 3.0, 6.0]), 16, "four times");
        let mut long: Vec<f64> = (0..400).map(f64::from).collect();
        long.push(399.001);
        assert_eq!(even_count(&long), 512);
        let longer: Vec<f64> = (0..600).map(|i| f64::from(i).powi(2)).collect();
        assert_eq!(even_count(&longer), 600);
    }

    #[test]
    fn knots_begin_and_end_at_the_ends_and_give_the_place_back() {
        for points in [vec![0.0, 1.0, 3.0, 6.0], vec![9.0, 5.0, 4.0, -2.0]] {
            let count = 13;
            let found = knots(&points, count);
            for (i, knot) in found.iter().enumerate() {
                let [a, b] = [0, 1].map(|k| points[knot.first as usize + k]);
                let place = a + (b - a) * knot.weight;
                let wanted = points[0] + (points[3] - points[0]) * i as f64 / 12.0;
                assert!((place - wanted).abs() < 1e-12, "{place}, not {wanted}");
            }
            assert_eq!((found[0].first, found[0].weight), (0, 0.0));
            assert_eq!((found[12].first, found[12].weight), (2, 1.0));
        }
    }
}
