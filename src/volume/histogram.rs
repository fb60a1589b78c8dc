//! How often each value occurs: bins of equal width.
//!
//! ```text
//! bin = floor((stored - start) / width),   stored numbers from start to start + width * bins
//! ```
//!
//! Bins of integers hold a whole number of codes each, or neighbours would hold 3 and 4 in turn and the
//! counts would beat.

use super::voxels::{Stored, with_numbers};
use super::{Rescale, Volume, Voxels};

/// How often each value occurs, after rescale, voxels without data left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// Where the first bin begins and the last one ends, ascending; `[0.0, 0.0]` where no voxel is valid.
    pub value_range: [f64; 2],
    /// Ascending by value; empty where no voxel is valid.
    pub counts: Vec<u64>,
}

impl Histogram {
    /// So many bins that a picture of them has one a pixel.
    pub const MAX_BINS: usize = 1024;

    /// Of the valid voxels of `volume`, in at most `max_bins` bins (at least one).
    pub fn of(volume: &Volume, max_bins: usize) -> Self {
        let Some(mut bins) = Bins::of_volume(volume, max_bins) else {
            return Self::empty();
        };
        let validity = volume.validity.as_deref();
        with_numbers!(&volume.voxels, numbers => bins.add_valid(numbers, validity));
        bins.histogram(volume.rescale)
    }

    /// Of no voxel.
    pub(super) fn empty() -> Self {
        Self {
            value_range: [0.0; 2],
            counts: Vec::new(),
        }
    }

    /// Where bins begin and end: one more than there are bins, none where there are none.
    pub fn edges(&self) -> Vec<f64> {
        edges(self.value_range, self.counts.len())
    }
}

/// The ends of `bins` equal parts of `range`.
pub(super) fn edges([low, high]: [f64; 2], bins: usize) -> Vec<f64> {
    let at = |edge: usize| low + (high - low) * (edge as f64 / bins as f64);
    match bins {
        0 => Vec::new(),
        _ => (0..=bins).map(at).collect(),
    }
}

/// Counts over stored numbers.
pub(super) struct Bins {
    start: f64,
    width: f64,
    counts: Vec<u64>,
}

impl Bins {
    /// Empty bins for stored numbers from `min` to `max`.
    pub(super) fn over([min, max]: [f32; 2], is_float: bool, max_bins: usize) -> Self {
        let (min, max) = (f64::from(min), f64::from(max));
        let (range, most) = (max - min, max_bins.max(1));
        let (start, width, count) = if is_float {
            // One value alone has a bin of width 1 around it.
            let width = range / most as f64;
            if width.is_normal() {
                (min, width, most)
            } else {
                (min - 0.5, 1.0, 1)
            }
        } else {
            let width = ((range + 1.0) / most as f64).ceil();
            (min - 0.5, width, ((range + 1.0) / width).ceil() as usize)
        };
        Self {
            start,
            width,
            counts: vec![0; count],
        }
    }

    /// Empty bins for the valid voxels of `volume`; `None` where there are none.
    pub(super) fn of_volume(volume: &Volume, max_bins: usize) -> Option<Self> {
        let validity = volume.validity.as_deref();
        if validity.is_some_and(|mask| mask.iter().all(|&valid| valid == 0)) {
            return None;
        }
        // A hole holds the number of a valid voxel: the ends of all are the ends of the valid.
        let ends = with_numbers!(&volume.voxels, numbers => ends(numbers));
        let is_float = volume.voxels.voxel_type().is_float();
        // Integers of 32 bits have become floats on the way here.
        let is_float = is_float && with_numbers!(&volume.voxels, numbers => !are_whole(numbers));
        Some(Self::over(ends, is_float, max_bins))
    }

    /// The bin of a stored number between the ends.
    pub(super) fn bin(&self, stored: f64) -> usize {
        let bin = (stored - self.start) / self.width;
        (bin as usize).min(self.counts.len() - 1)
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.counts.len()
    }

    /// The values, after rescale, where the first bin begins and the last one ends, ascending.
    pub(super) fn value_range(&self, rescale: Rescale) -> [f64; 2] {
        let end = self.start + self.width * self.counts.len() as f64;
        let value = |stored: f64| stored * rescale.slope + rescale.intercept;
        let [a, b] = [self.start, end].map(value);
        [a.min(b), a.max(b)]
    }

    /// The counts by value.
    pub(super) fn histogram(mut self, rescale: Rescale) -> Histogram {
        let value_range = self.value_range(rescale);
        if rescale.slope < 0.0 {
            self.counts.reverse();
        }
        Histogram {
            value_range,
            counts: self.counts,
        }
    }

    /// Counts what is finite and not the fill.
    pub(super) fn add(&mut self, voxels: &Voxels, fill: Option<f64>) {
        with_numbers!(voxels, numbers => self.add_numbers(numbers, fill));
    }

    fn add_numbers<T: Stored>(&mut self, numbers: &[T], fill: Option<f64>) {
        let fill = fill.and_then(T::from_fill);
        for &number in numbers {
            let stored = number.to_f32();
            if stored.is_finite() && Some(number) != fill {
                let bin = self.bin(stored.into());
                self.counts[bin] += 1;
            }
        }
    }

    fn add_valid<T: Stored>(&mut self, numbers: &[T], validity: Option<&[u8]>) {
        for (i, number) in numbers.iter().enumerate() {
            if validity.is_none_or(|mask| mask[i] != 0) {
                let bin = self.bin(number.to_f32().into());
                self.counts[bin] += 1;
            }
        }
    }
}

fn ends<T: Stored>(numbers: &[T]) -> [f32; 2] {
    let start = [f32::INFINITY, f32::NEG_INFINITY];
    numbers.iter().fold(start, |[low, high], number| {
        [low.min(number.to_f32()), high.max(number.to_f32())]
    })
}

fn are_whole<T: Stored>(numbers: &[T]) -> bool {
    numbers.iter().all(|number| number.to_f32().fract() == 0.0)
}
