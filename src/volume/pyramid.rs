//! A volume with half as many voxels along each axis, again and again.
//!
//! ```text
//! coarse[i] = mean of the valid fine[2 i .. 2 i + 2]        |f_0 - f_k| <= sum over j < k of |f_j - f_(j+1)|
//! ```
//!
//! The bound on the right holds for the largest difference and for the root mean square alike.

use super::reduce::Blocks;
use super::voxels::{Stored, with_numbers};
use super::{VoxelBox, Voxels};

/// What one box holds, in stored numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Held {
    /// Smallest and largest valid number; NaN where none is.
    pub range: [f32; 2],
    pub has_holes: bool,
    /// All numbers are the same.
    pub is_same: bool,
}

/// How far two levels are apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Difference {
    pub largest: f64,
    sum_of_squares: f64,
    count: u64,
}

impl Difference {
    /// Largest, sum of squares, and how many.
    pub(crate) fn parts(self) -> (f64, f64, u64) {
        (self.largest, self.sum_of_squares, self.count)
    }

    pub(crate) fn of_parts(largest: f64, sum_of_squares: f64, count: u64) -> Self {
        Self {
            largest,
            sum_of_squares,
            count,
        }
    }

    pub(crate) fn and(self, more: Self) -> Self {
        Self {
            largest: self.largest.max(more.largest),
            sum_of_squares: self.sum_of_squares + more.sum_of_squares,
            count: self.count + more.count,
        }
    }

    pub(crate) fn root_mean_square(self) -> f64 {
        match self.count {
            0 => 0.0,
            count => (self.sum_of_squares / count as f64).sqrt(),
        }
    }
}

/// Looks at all numbers.
pub(crate) fn held(voxels: &Voxels, fill: Option<f64>) -> Held {
    with_numbers!(voxels, numbers => held_numbers(numbers, fill))
}

fn held_numbers<T: Stored>(numbers: &[T], fill: Option<f64>) -> Held {
    let fill = fill.and_then(T::from_fill);
    let is_valid = |x: T| x.is_finite() && Some(x) != fill;
    let valid = || numbers.iter().copied().filter(|&x| is_valid(x));
    let Some(first) = valid().next() else {
        return Held {
            range: [f32::NAN; 2],
            has_holes: true,
            is_same: numbers.windows(2).all(|pair| pair[0] == pair[1]),
        };
    };
    let (mut low, mut high, mut all) = (first, first, true);
    for &x in numbers {
        let valid = is_valid(x);
        all &= valid;
        let kept = if valid { x } else { first };
        low = if kept < low { kept } else { low };
        high = if kept > high { kept } else { high };
    }
    Held {
        range: [low.to_f32(), high.to_f32()],
        has_holes: !all,
        is_same: all && low == high,
    }
}

/// Half as many along each axis, of a box that begins at even voxels; of labels one of each block.
pub(crate) fn halved(
    voxels: &Voxels,
    dims: [u32; 3],
    fill: Option<f64>,
    is_labels: bool,
) -> Voxels {
    let blocks = Blocks {
        from: dims.map(|n| n as usize),
        to: dims.map(|n| n.div_ceil(2) as usize),
        factor: 2,
        fill,
        is_labels,
    };
    blocks.reduce(voxels)
}

/// How far the fine voxels of `part` of the coarse ones are from those. Voxels without data do not count.
pub(crate) fn difference(
    [fine, coarse]: [&Voxels; 2],
    fine_dims: [u32; 3],
    part: VoxelBox,
    fill: Option<f64>,
) -> Difference {
    let coarse = |i: usize| coarse.stored(i);
    with_numbers!(fine, numbers => difference_of(numbers, coarse, fine_dims, part, fill))
}

fn difference_of<T: Stored>(
    fine: &[T],
    coarse: impl Fn(usize) -> f32,
    fine_dims: [u32; 3],
    part: VoxelBox,
    fill: Option<f64>,
) -> Difference {
    let fill = fill.and_then(T::from_fill);
    let [nx, ny, nz] = fine_dims.map(|n| n as usize);
    let [half_x, half_y] = [nx, ny].map(|n| n.div_ceil(2));
    let ends = |k: usize, n: usize| {
        let [first, end] = [part.min[k], part.max[k]].map(|n| 2 * n as usize);
        first..end.min(n)
    };
    let mut found = Difference::default();
    for z in ends(2, nz) {
        for y in ends(1, ny) {
            for x in ends(0, nx) {
                let number = fine[(z * ny + y) * nx + x];
                if !number.is_finite() || Some(number) == fill {
                    continue;
                }
                let mean = coarse((z / 2 * half_y + y / 2) * half_x + x / 2);
                let apart = f64::from((number.to_f32() - mean).abs());
                found.largest = found.largest.max(apart);
                found.sum_of_squares += apart * apart;
                found.count += 1;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coarse_voxel_is_the_mean_of_those_that_are_there_and_knows_how_far_they_are() {
        // 3 x 2 x 1: blocks of 2 x 2 and of 1 x 2.
        let fine = Voxels::F32(vec![1.0, 3.0, 10.0, 5.0, f32::NAN, 20.0]);
        let coarse = halved(&fine, [3, 2, 1], None, false);
        assert_eq!(coarse, Voxels::F32(vec![3.0, 15.0]));
        let part = VoxelBox {
            min: [0; 3],
            max: [2, 1, 1],
        };
        let found = difference([&fine, &coarse], [3, 2, 1], part, None);
        assert_eq!(found.largest, 5.0);
        let mean: f64 = (4.0 + 0.0 + 4.0 + 25.0 + 25.0) / 5.0;
        assert!((found.root_mean_square() - mean.sqrt()).abs() < 1e-12);
        let all = held(&fine, Some(20.0));
        assert_eq!(all.range, [1.0, 10.0]);
        assert!(all.has_holes && !all.is_same);
        let same = held(&Voxels::U8(vec![7; 4]), None);
        assert!(same.is_same && !same.has_holes);
        assert!(held(&Voxels::U8(vec![7; 4]), Some(7.0)).range[0].is_nan());
    }
}
