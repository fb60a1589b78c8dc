//! Columns that begin over the ground, filled down to it.
//!
//! ```text
//! value(z) = value(lowest z with data),   z under it
//! ```

/// Gives voxels without data (NaN) under the lowest with data the number of that one. `is_rising` where z grows upwards.
pub fn filled_down(values: &mut [f32], [nx, ny, nz]: [u32; 3], is_rising: bool) {
    let layer = nx as usize * ny as usize;
    let layers = nz as usize;
    for column in 0..layer.min(values.len()) {
        let at = |k: usize| match is_rising {
            true => k * layer + column,
            false => (layers - 1 - k) * layer + column,
        };
        let lowest = (0..layers).find(|&k| values[at(k)].is_finite());
        for k in 0..lowest.unwrap_or(0) {
            values[at(k)] = values[at(lowest.unwrap_or(0))];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::filled_down;

    #[test]
    fn only_what_lies_under_the_lowest_number_is_filled() {
        let hole = f32::NAN;
        let mut values = [hole, 1.0, 2.0, hole, 3.0, 4.0, hole, hole];
        filled_down(&mut values, [1, 2, 4], true);
        assert_eq!(values[..3], [2.0, 1.0, 2.0]);
        assert_eq!(values[4..6], [3.0, 4.0]);
        // A hole between numbers, and one over them.
        assert!([3, 6, 7].iter().all(|&i: &usize| values[i].is_nan()));
        let mut falling = [hole, 5.0, hole];
        filled_down(&mut falling, [1, 1, 3], false);
        assert!(falling[0].is_nan() && falling[1..] == [5.0, 5.0]);
    }
}
