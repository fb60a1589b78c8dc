//! What the values of a whole source are like, one time in memory after another.
//!
//! Over voxels that are finite and not the fill, after rescale; sums in f64.

use super::histogram::{Bins, Histogram};
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
        if tally.valid == 0 {
            return Ok(tally.statistics_without_values());
        }
        let is_float = header.stored.is_float();
        let mut bins = Bins::over([tally.min, tally.max], is_float, Histogram::MAX_BINS);
        for &pick in &picks {
            match kept.take() {
                Some(voxels) => bins.add(&voxels, header.fill),
                None => bins.add(&source.read(pick, header.whole())?.voxels, header.fill),
            }
        }
        let rescale = header.rescale;
        let value = |stored: f64| stored * rescale.slope + rescale.intercept;
        let ends = [tally.min, tally.max].map(|stored| value(stored.into()));
        Ok(Self {
            min: ends[0].min(ends[1]),
            max: ends[0].max(ends[1]),
            mean: value(tally.sum / tally.valid as f64),
            valid_count: tally.valid,
            non_finite_count: tally.non_finite,
            fill_count: tally.fill,
            loss: tally.loss,
            histogram: bins.histogram(rescale),
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
            histogram: Histogram::empty(),
        }
    }
}
