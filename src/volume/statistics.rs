//! What the values of a whole source are like, one time in memory after another.
//!
//! Over voxels that are finite and not the fill, after rescale; sums in f64.

use super::read::check_memory;
use super::voxels::{Stored, with_numbers};
use super::{Limits, Loss, Pick, Piece, ReadError, Source, Voxels};
use std::ops::Range;

/// Smallest, largest and mean value, and how many voxels count.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistics {
    /// NaN where no voxel is valid.
    pub min: f64,
    /// NaN where no voxel is valid.
    pub max: f64,
    /// NaN where no voxel is valid.
    pub mean: f64,
    /// Voxels that min, max, mean and the histogram are made from.
    pub valid_count: u64,
    /// Voxels that are NaN or infinite.
    pub non_finite_count: u64,
    /// Finite voxels that equal the fill.
    pub fill_count: u64,
    /// What rounding to f32 changed, in stored units.
    pub loss: Loss,
    /// How often each value occurs.
    pub histogram: Histogram,
}

/// Bins of equal width. Those of integers hold a whole number of codes each, or they would beat.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// Where the first bin begins and the last one ends, ascending; `[0.0, 0.0]` where no voxel is valid.
    pub value_range: [f64; 2],
    /// At most [`Histogram::MAX_BINS`]; empty where no voxel is valid.
    pub counts: Vec<u64>,
}

impl Histogram {
    /// So many bins that a picture of them has one a pixel.
    pub const MAX_BINS: usize = 1024;
}

impl Statistics {
    /// Of all times and some components of `source`. Reads it twice, unless one read gives all of it.
    ///
    /// # Errors
    /// Where one time needs more memory than `limits` allow, and whatever the source meets.
    pub fn of(
        source: &dyn Source,
        components: Range<u32>,
        limits: &Limits,
    ) -> Result<Self, ReadError> {
        let header = source.header();
        check_memory(header, header.whole(), limits).map_err(|problem| ReadError {
            path: source.path().to_owned(),
            problem,
        })?;
        let picks: Vec<Pick> = (0..header.times)
            .flat_map(|time| {
                components
                    .clone()
                    .map(move |component| Pick { time, component })
            })
            .collect();
        let mut tally = Tally::default();
        let mut kept = None;
        for &pick in &picks {
            let Piece { voxels, loss } = source.read(pick, header.whole())?;
            tally.add(&voxels, header.fill);
            tally.loss = tally.loss.and(loss);
            kept = (picks.len() == 1).then_some(voxels);
        }
        let Some(mut bins) = Bins::over(&tally, header.stored.is_float()) else {
            return Ok(tally.statistics_without_values());
        };
        for &pick in &picks {
            match kept.take() {
                Some(voxels) => bins.add(&voxels, header.fill),
                None => bins.add(&source.read(pick, header.whole())?.voxels, header.fill),
            }
        }
        let rescaled = |stored: f64| stored * header.rescale.slope + header.rescale.intercept;
        let ordered = |ends: [f64; 2]| {
            let [a, b] = ends.map(rescaled);
            [a.min(b), a.max(b)]
        };
        let [min, max] = ordered([tally.min.into(), tally.max.into()]);
        if header.rescale.slope < 0.0 {
            bins.counts.reverse();
        }
        Ok(Self {
            min,
            max,
            mean: rescaled(tally.sum / tally.valid as f64),
            valid_count: tally.valid,
            non_finite_count: tally.non_finite,
            fill_count: tally.fill,
            loss: tally.loss,
            histogram: Histogram {
                value_range: ordered([
                    bins.start,
                    bins.start + bins.width * bins.counts.len() as f64,
                ]),
                counts: bins.counts,
            },
        })
    }
}

/// The first pass: stored numbers.
struct Tally {
    min: f32,
    max: f32,
    sum: f64,
    valid: u64,
    non_finite: u64,
    fill: u64,
    loss: Loss,
}

impl Default for Tally {
    fn default() -> Self {
        Self {
            min: f32::INFINITY,
            max: f32::NEG_INFINITY,
            sum: 0.0,
            valid: 0,
            non_finite: 0,
            fill: 0,
            loss: Loss::default(),
        }
    }
}

impl Tally {
    fn add(&mut self, voxels: &Voxels, fill: Option<f64>) {
        with_numbers!(voxels, numbers => self.add_numbers(numbers, fill));
    }

    fn add_numbers<T: Stored>(&mut self, numbers: &[T], fill: Option<f64>) {
        let fill = fill.and_then(T::from_fill);
        for &number in numbers {
            let stored = number.to_f32();
            if !stored.is_finite() {
                self.non_finite += 1;
            } else if Some(number) == fill {
                self.fill += 1;
            } else {
                self.min = self.min.min(stored);
                self.max = self.max.max(stored);
                self.sum += f64::from(stored);
                self.valid += 1;
            }
        }
    }

    fn statistics_without_values(&self) -> Statistics {
        Statistics {
            min: f64::NAN,
            max: f64::NAN,
            mean: f64::NAN,
            valid_count: 0,
            non_finite_count: self.non_finite,
            fill_count: self.fill,
            loss: self.loss,
            histogram: Histogram {
                value_range: [0.0; 2],
                counts: Vec::new(),
            },
        }
    }
}

/// The second pass: bins over stored numbers.
struct Bins {
    start: f64,
    width: f64,
    counts: Vec<u64>,
}

impl Bins {
    fn over(tally: &Tally, is_float: bool) -> Option<Self> {
        if tally.valid == 0 {
            return None;
        }
        let (min, max) = (f64::from(tally.min), f64::from(tally.max));
        let range = max - min;
        let (start, width, count) = if is_float {
            // One value alone has a bin of width 1 around it.
            let width = range / Histogram::MAX_BINS as f64;
            if width.is_normal() {
                (min, width, Histogram::MAX_BINS)
            } else {
                (min - 0.5, 1.0, 1)
            }
        } else {
            let width = ((range + 1.0) / Histogram::MAX_BINS as f64).ceil();
            (min - 0.5, width, ((range + 1.0) / width).ceil() as usize)
        };
        Some(Self {
            start,
            width,
            counts: vec![0; count],
        })
    }

    fn add(&mut self, voxels: &Voxels, fill: Option<f64>) {
        with_numbers!(voxels, numbers => self.add_numbers(numbers, fill));
    }

    fn add_numbers<T: Stored>(&mut self, numbers: &[T], fill: Option<f64>) {
        let fill = fill.and_then(T::from_fill);
        let last = self.counts.len() - 1;
        for &number in numbers {
            let stored = number.to_f32();
            if stored.is_finite() && Some(number) != fill {
                let bin = (f64::from(stored) - self.start) / self.width;
                self.counts[(bin as usize).min(last)] += 1;
            }
        }
    }
}
