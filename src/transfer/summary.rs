//! What the values of a volume look like as a whole: enough to choose a transfer function by.

use super::{Quantity, Window};

/// Bins of the largest histogram.
const MAX_BINS: usize = 4096;
/// Voxels looked at, at most; more are passed over evenly.
const MAX_SAMPLES: usize = 1 << 22;
/// More kinds of whole numbers than this are no labels.
const MAX_LABELS: usize = 256;

/// Statistics of values, after rescale, valid voxels only.
#[derive(Clone, Debug, PartialEq)]
pub struct ValueSummary {
    /// Smallest and largest value.
    pub range: [f64; 2],
    /// Counts of equal bins from `edges[0]` to `edges[1]`; whole numbers sit in the middle of their bins.
    pub histogram: Vec<u64>,
    /// Where the first bin begins and the last one ends.
    pub edges: [f64; 2],
    /// The labels, ascending, and how many voxels have each, where the voxels look like a label map.
    pub labels: Option<Vec<(i64, u64)>>,
    /// Every value is a whole number.
    pub integers: bool,
    /// Values are known to be Hounsfield units.
    pub hounsfield: bool,
    /// What values measure, by their unit.
    pub quantity: Quantity,
    /// World length of the diagonal of the grid box.
    pub diagonal: f64,
}

impl ValueSummary {
    /// Of `count` voxels, x fastest; `value` gives each one's value after rescale, `None` for no data.
    ///
    /// `range` is the smallest and largest value, `diagonal` the world length of the grid's diagonal. Above
    /// four million voxels an even choice of them is looked at.
    ///
    /// ```
    /// # use stratavox::{transfer::ValueSummary, volume::Volume};
    /// fn summary(volume: &Volume) -> ValueSummary {
    ///     let dims = glam::UVec3::from_array(volume.dims).as_dvec3();
    ///     let diagonal = volume.world_from_voxel.transform_vector3(dims).length();
    ///     let count = volume.voxels.len();
    ///     ValueSummary::of(count, volume.value_range, diagonal, volume.hounsfield, |i| {
    ///         let valid = volume.validity.as_ref().is_none_or(|mask| mask[i] == 1);
    ///         let stored = f64::from(volume.voxels.stored(i));
    ///         valid.then(|| stored * volume.rescale.slope + volume.rescale.intercept)
    ///     })
    /// }
    /// ```
    pub fn of(
        count: usize,
        range: [f64; 2],
        diagonal: f64,
        hounsfield: bool,
        value: impl Fn(usize) -> Option<f64>,
    ) -> Self {
        let stride = Self::stride(count);
        let sampled = || (0..count).step_by(stride);
        let [low, high] = range;
        let integers = sampled().all(|i| value(i).is_none_or(|v| v.fract() == 0.0));
        let (edges, bins) = if integers && high - low < MAX_BINS as f64 {
            ([low - 0.5, high + 0.5], (high - low) as usize + 1)
        } else {
            ([low, high], MAX_BINS)
        };
        let per_value = bins as f64 / (edges[1] - edges[0]);
        let mut histogram = vec![0; bins];
        for value in sampled().filter_map(&value) {
            let bin = (value - edges[0]) * per_value;
            histogram[(bin as usize).min(bins - 1)] += 1;
        }
        let labels = (integers && bins < MAX_BINS)
            .then(|| labels(&histogram, low as i64))
            .flatten()
            .filter(|labels| {
                let neighbours = sampled().filter_map(|i| {
                    let next = if i + 1 < count { value(i + 1) } else { None };
                    Some([value(i)?, next?])
                });
                look_like_labels(labels, neighbours)
            });
        Self {
            range,
            histogram,
            edges,
            labels,
            integers,
            hounsfield,
            quantity: Quantity::Unknown,
            diagonal,
        }
    }

    /// From one of `count` voxels that are looked at to the next; of each, the one behind it may be looked at too.
    pub(crate) fn stride(count: usize) -> usize {
        // Odd, so that no power-of-two row length makes all samples lie in few columns.
        (count / MAX_SAMPLES).max(1) | 1
    }

    /// The same of values that measure `quantity`.
    pub fn measuring(self, quantity: Quantity) -> Self {
        Self { quantity, ..self }
    }

    /// The value that a share `q` of the voxels lies below, 0 to 1.
    pub fn quantile(&self, q: f64) -> f64 {
        let total: u64 = self.histogram.iter().sum();
        let wanted = q * total as f64;
        let mut below = 0.0;
        for (bin, &count) in self.histogram.iter().enumerate() {
            let count = count as f64;
            if below + count >= wanted && count > 0.0 {
                let inside = ((wanted - below) / count).clamp(0.0, 1.0);
                return self.at_bin(bin as f64 + inside);
            }
            below += count;
        }
        self.range[1]
    }

    /// Where most values lie that are no background: from the value that a share of 0.005 of them lies below to the one
    /// that as many lie above.
    ///
    /// Background is what lies within a fiftieth of the range (from quantile 0.001 to 0.999) of the fullest bin of the
    /// dark class, where that is three voxels in ten or more.
    pub fn most(&self) -> Window {
        let [low, high] = [self.quantile(0.001), self.quantile(0.999)];
        let mode = self.mode_below(self.threshold(low, high));
        let near = 0.02 * (high - low);
        let [below, not_above] = [mode - near, mode + near].map(|value| self.share_below(value));
        // The share of all voxels that holds this share of those outside of the background.
        let at = |share: f64| {
            let (background, before) = match not_above - below >= 0.3 {
                true => (not_above - below, below),
                false => (0.0, 0.0),
            };
            let foreground = share * (1.0 - background);
            let is_behind = foreground > before;
            self.quantile(foreground + if is_behind { background } else { 0.0 })
        };
        Window::new(at(0.005), at(0.995)).unwrap_or(Window::of_range(self.range))
    }

    /// The share of voxels below `value`, 0 to 1.
    pub fn share_below(&self, value: f64) -> f64 {
        let total: u64 = self.histogram.iter().sum();
        let below = self.histogram.iter().enumerate();
        let below = below.filter(|&(bin, _)| self.at_bin(bin as f64 + 0.5) < value);
        let below: u64 = below.map(|(_, &count)| count).sum();
        below as f64 / total.max(1) as f64
    }

    /// The middle of the fullest bin among those below `limit`: the background, where there is one.
    pub fn mode_below(&self, limit: f64) -> f64 {
        let bins = self.histogram.iter().enumerate();
        let bins = bins.filter(|&(bin, _)| bin == 0 || self.at_bin(bin as f64 + 0.5) < limit);
        // `max_by_key` takes the last of equals; the lowest value is wanted.
        let fullest = bins.rev().max_by_key(|&(_, &count)| count);
        self.at_bin(fullest.map_or(0.0, |(bin, _)| bin as f64 + 0.5))
    }

    /// The value that best parts the voxels of `[low, high]` into a dark and a bright class: largest
    /// variance between the classes (Otsu, IEEE Trans. SMC 9(1), 1979).
    pub fn threshold(&self, low: f64, high: f64) -> f64 {
        let bins = self.histogram.iter().enumerate();
        let bins = bins.map(|(bin, &count)| (self.at_bin(bin as f64 + 0.5), count as f64));
        let bins = bins.map(|(value, count)| (value.clamp(low, high), count));
        let (all, moment) = bins.clone().fold((0.0, 0.0), |(n, m), (value, count)| {
            (n + count, m + value * count)
        });
        let (mut dark, mut dark_moment) = (0.0, 0.0);
        let mut best = (0.0, low, low);
        for (value, count) in bins {
            let bright = all - dark;
            if dark > 0.0 && bright > 0.0 {
                let apart = dark_moment / dark - (moment - dark_moment) / bright;
                let variance = dark * bright * apart * apart;
                if variance > best.0 * (1.0 + 1e-12) {
                    best = (variance, value, value);
                } else if variance >= best.0 {
                    // Empty bins between the classes all part them equally well.
                    best.2 = value;
                }
            }
            dark += count;
            dark_moment += value * count;
        }
        (best.1 + best.2) / 2.0
    }

    fn at_bin(&self, bin: f64) -> f64 {
        let t = bin / self.histogram.len() as f64;
        (self.edges[0] + t * (self.edges[1] - self.edges[0])).clamp(self.range[0], self.range[1])
    }
}

/// The kinds of values in a histogram of whole numbers from `low` on; `None` where they are too many.
fn labels(histogram: &[u64], low: i64) -> Option<Vec<(i64, u64)>> {
    let kinds = histogram.iter().zip(low..).filter(|&(&count, _)| count > 0);
    let kinds: Vec<_> = kinds.map(|(&count, label)| (label, count)).collect();
    (2..=MAX_LABELS).contains(&kinds.len()).then_some(kinds)
}

/// Labels are the same over many neighbours and then jump anywhere; images change everywhere a little.
fn look_like_labels(labels: &[(i64, u64)], neighbours: impl Iterator<Item = [f64; 2]>) -> bool {
    if labels.len() <= 3 {
        return true;
    }
    let background = labels.iter().max_by_key(|&&(_, count)| count);
    let background = background.map_or(0.0, |&(label, _)| label as f64);
    let (mut same, mut near, mut other) = (0_u64, 0_u64, 0_u64);
    for [a, b] in neighbours {
        if a == b {
            same += u64::from(a != background);
        } else if (a - b).abs() <= 2.0 {
            near += 1;
        } else {
            other += 1;
        }
    }
    same > 2 * (near + other) && other > near
}
