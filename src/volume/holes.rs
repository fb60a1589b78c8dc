//! Voxels without data: found, and filled with the nearest valid number.
//!
//! A voxel is no data where it is not finite or equals the fill. Nearest is by Euclidean distance in
//! voxels, exact up to 4096 voxels (squared distances are f32). One axis after the other: the nearest
//! along a row, then of each column the lower envelope of the parabolas
//!
//! ```text
//! d(q)^2 = min over r of d(r)^2 + (q - r)^2
//! ```
//!
//! Felzenszwalb, Huttenlocher, "Distance Transforms of Sampled Functions", Theory of Computing 8, 2012.
//! The time is proportional to the number of voxels.

use super::voxels::{Stored, Voxels, with_numbers};

/// One byte a voxel, 1 = valid; `None` where all are valid.
pub(super) fn validity(voxels: &Voxels, fill: Option<f64>) -> Option<Vec<u8>> {
    with_numbers!(voxels, numbers => validity_of(numbers, fill))
}

/// Bytes that [`fill`] and the mask take for one voxel.
pub(super) const BYTES_PER_VOXEL: u64 = 1 + size_of::<f32>() as u64;

/// Gives every invalid voxel the stored number of the nearest valid one, or 0 where none is valid.
pub(super) fn fill(voxels: &mut Voxels, validity: &[u8], dims: [u32; 3]) {
    with_numbers!(voxels, numbers => fill_numbers(numbers, validity, dims.map(|n| n as usize)));
}

fn validity_of<T: Stored>(numbers: &[T], fill: Option<f64>) -> Option<Vec<u8>> {
    let fill = fill.and_then(T::from_fill);
    let is_valid = |x: &T| x.is_finite() && Some(*x) != fill;
    // Without a way out inside of a block the compiler makes vectors of it.
    let all_valid = |block: &[T]| block.iter().fold(true, |all, x| all & is_valid(x));
    if numbers.chunks(4096).all(all_valid) {
        return None;
    }
    Some(numbers.iter().map(|x| u8::from(is_valid(x))).collect())
}

fn fill_numbers<T: Stored>(numbers: &mut [T], validity: &[u8], dims: [usize; 3]) {
    if validity.iter().all(|&valid| valid == 0) {
        numbers.fill(T::default());
        return;
    }
    let mut squared = vec![0.0; numbers.len()];
    let [nx, ny, nz] = dims;
    let rows = numbers.chunks_exact_mut(nx).zip(validity.chunks_exact(nx));
    for ((numbers, validity), squared) in rows.zip(squared.chunks_exact_mut(nx)) {
        fill_row(numbers, validity, squared);
    }
    let mut column = Column::default();
    for z in 0..nz {
        for x in 0..nx {
            column.fill(numbers, &mut squared, z * ny * nx + x, nx, ny);
        }
    }
    for xy in 0..ny * nx {
        column.fill(numbers, &mut squared, xy, ny * nx, nz);
    }
}

/// Fills runs of holes from their two ends; the first wins a tie. A row of holes is infinitely far.
fn fill_row<T: Stored>(numbers: &mut [T], validity: &[u8], squared: &mut [f32]) {
    let end = numbers.len();
    let mut start = 0;
    while let Some(hole) = (start..end).find(|&i| validity[i] == 0) {
        let after = (hole..end).find(|&i| validity[i] != 0);
        let stop = after.unwrap_or(end);
        for i in hole..stop {
            let before = (hole > 0).then(|| (i + 1 - hole, numbers[hole - 1]));
            let after = after.map(|j| (j - i, numbers[j]));
            let nearest = [before, after]
                .into_iter()
                .flatten()
                .min_by_key(|&(d, _)| d);
            squared[i] = f32::INFINITY;
            if let Some((distance, number)) = nearest {
                squared[i] = (distance * distance) as f32;
                numbers[i] = number;
            }
        }
        start = stop;
    }
}

/// Work space for one column.
#[derive(Default)]
struct Column<T> {
    /// Squared distance and number of each voxel before this pass.
    voxels: Vec<(f32, T)>,
    /// Parabolas of the lower envelope: their vertex, and where they begin to be the lowest.
    envelope: Vec<(usize, f64)>,
}

impl<T: Stored> Column<T> {
    fn fill(
        &mut self,
        numbers: &mut [T],
        squared: &mut [f32],
        start: usize,
        stride: usize,
        n: usize,
    ) {
        let at = |q: usize| start + q * stride;
        if (0..n).all(|q| squared[at(q)] == 0.0) {
            return;
        }
        self.voxels.clear();
        self.voxels
            .extend((0..n).map(|q| (squared[at(q)], numbers[at(q)])));
        self.find_envelope();
        let mut k = 0;
        for q in 0..n {
            while k + 1 < self.envelope.len() && self.envelope[k + 1].1 < q as f64 {
                k += 1;
            }
            if let Some(&(r, _)) = self.envelope.get(k) {
                let (height, number) = self.voxels[r];
                let distance = q.abs_diff(r);
                squared[at(q)] = height + (distance * distance) as f32;
                numbers[at(q)] = number;
            }
        }
    }

    fn find_envelope(&mut self) {
        self.envelope.clear();
        for (q, &(height, _)) in self.voxels.iter().enumerate() {
            if height == f32::INFINITY {
                continue;
            }
            let raised = |q: usize, height: f32| f64::from(height) + (q * q) as f64;
            let mut begin = f64::NEG_INFINITY;
            while let Some(&(r, r_begin)) = self.envelope.last() {
                begin = (raised(q, height) - raised(r, self.voxels[r].0)) / (2 * (q - r)) as f64;
                if begin > r_begin {
                    break;
                }
                self.envelope.pop();
                begin = f64::NEG_INFINITY;
            }
            self.envelope.push((q, begin));
        }
    }
}
