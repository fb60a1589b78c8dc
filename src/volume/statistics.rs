//! What the values of a whole source are like, one time, or a slab of a large one, in memory after another.
//!
//! Over voxels that are finite and not the fill, after rescale; sums in f64.

use super::histogram::{Bins, Histogram};
use super::read::check_memory;
use super::voxels::{Stored, with_numbers};
use super::{Header, Limits, PrecisionLoss, ReadError, Source, TimeComponent, Voxels};
use std::ops::{ControlFlow, Range};

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
    pub loss: PrecisionLoss,
    /// How often each value occurs.
    pub histogram: Histogram,
}

impl Statistics {
    /// Of all times and some components of `source`. Reads it twice, slab by slab, unless one slab is all of it.
    ///
    /// # Errors
    /// Where what has to be read at once needs more memory than `limits` allow, and whatever the source meets.
    pub fn of(
        source: &dyn Source,
        components: Range<u32>,
        limits: &Limits,
    ) -> Result<Self, ReadError> {
        let header = source.header();
        let slices = slices_of_slab(header, limits.max_bytes);
        let first = header.whole().slabs(slices).next();
        check_memory(header, first.unwrap_or(header.whole()), limits).map_err(|problem| {
            ReadError {
                path: source.path().to_owned(),
                problem,
            }
        })?;
        let picks: Vec<TimeComponent> = (0..header.times)
            .flat_map(|time| {
                components
                    .clone()
                    .map(move |component| TimeComponent { time, component })
            })
            .collect();
        let is_one_slab = picks.len() == 1 && slices >= header.dims[2];
        let mut tally = Tally::default();
        let mut kept = None;
        for &pick in &picks {
            source.read_slabs(pick, header.whole(), slices, &mut |_, piece| {
                tally.add(&piece.voxels, header.fill);
                tally.loss = tally.loss.and(piece.loss);
                kept = is_one_slab.then_some(piece.voxels);
                ControlFlow::Continue(())
            })?;
        }
        if tally.valid == 0 {
            return Ok(tally.statistics_without_values());
        }
        let is_float = header.stored.is_float();
        let mut bins = Bins::over([tally.min, tally.max], is_float, Histogram::MAX_BINS);
        if let Some(voxels) = kept.take() {
            bins.add(&voxels, header.fill);
        } else {
            for &pick in &picks {
                source.read_slabs(pick, header.whole(), slices, &mut |_, piece| {
                    bins.add(&piece.voxels, header.fill);
                    ControlFlow::Continue(())
                })?;
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

/// Slices along z that are read at once of a volume whatever its size.
pub(crate) fn slices_of_slab(header: &Header, max_bytes: u64) -> u32 {
    const SLAB_BYTES: u64 = 128 << 20;
    let [x, y, z] = header.dims;
    let slice_bytes = u64::from(x) * u64::from(y) * header.stored.bytes() as u64;
    (SLAB_BYTES.min(max_bytes) / slice_bytes.max(1)).clamp(1, z.into()) as u32
}

/// The first pass: stored numbers.
struct Tally {
    min: f32,
    max: f32,
    sum: f64,
    valid: u64,
    non_finite: u64,
    fill: u64,
    loss: PrecisionLoss,
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
            loss: PrecisionLoss::default(),
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
