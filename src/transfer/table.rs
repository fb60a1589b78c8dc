//! A transfer function as a table for nearest lookup.
//!
//! ```text
//! i = clamp(floor((value - first) scale), 0, n - 1)       entry i holds the specification at the middle of cell i
//! ```
//!
//! A cell is w = 1/scale wide, a power of two, and `first` is a multiple of w. So a control point at a whole
//! number (or any multiple of w) is the border of two cells, and a jump there is exact: a label never takes
//! its neighbour's colour. At least one cell lies before the first control point and one behind the last:
//! beyond the ends the table is exact too.
//!
//! Where the specification rises by s per unit of value, an entry is off by at most s w / 2; w is the largest that
//! keeps opacity and sRGB numbers within 1/4096, the rounding of `value - first` in f32 (2^-6 of a cell at
//! most) counted in. Only the entry that holds a jump between multiples of w is off by more.

use super::{Absorption, ColorPoint, Interpolation, MediumPoint, OpacityPoint, TransferFunction};
use crate::color::ColorSpace;
use crate::real::Real;

/// Entries of the smallest table.
pub const MIN_ENTRIES: usize = 1024;
/// Entries of the largest table.
pub const MAX_ENTRIES: usize = 262_144;
/// How far an entry may be from the specification.
const TOLERANCE: f64 = 1.0 / 4096.0;
/// Cells between a value and the middle of the cell it finds, at most.
const CELLS_OFF: f64 = 0.5 + 1.0 / 64.0;

/// A transfer function, sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// (red, green, blue, absorption), colour as it is blended; a power of two of them.
    pub entries: Vec<[f32; 4]>,
    /// Value where entry 0 begins.
    pub first: f32,
    /// Entries per unit of value; a power of two.
    pub scale: f32,
    /// How far opacity and sRGB numbers are from the specification, jumps left out. Above 1/4096 only where a ramp is
    /// too steep for [`MAX_ENTRIES`].
    pub off_by: f64,
}

/// How values are cut into cells.
pub(super) struct Cut {
    /// Where cell 0 begins.
    pub first: f64,
    /// A power of two.
    pub width: f64,
    /// A power of two.
    pub count: usize,
    off_by: f64,
}

/// Cells of a function that jumps where no cell of its table begins.
const SLAB_CELLS: usize = 65_536;

impl Cut {
    /// The cut of a table of single values.
    pub(super) fn new(function: &TransferFunction) -> Self {
        Self::with(function, |_| false)
    }

    /// That of a table of integrals.
    pub(super) fn for_slabs(function: &TransferFunction) -> Self {
        let is_coarse = |cells: f64| cells * 2.0 < SLAB_CELLS as f64;
        let jumps = jumps(function);
        let plain = Self::new(function);
        match jumps.iter().all(|jump| (jump / plain.width).fract() == 0.0) {
            true => plain,
            false => Self::with(function, is_coarse),
        }
    }

    /// As wide as the tolerance allows, but not while `is_coarse` says so of the cells over the span.
    fn with(function: &TransferFunction, is_coarse: impl Fn(f64) -> bool) -> Self {
        let limit = f64::from(f32::MAX);
        let values = || {
            let color = function.color.iter().map(|p| p.value);
            let opacity = function.opacity.iter().map(|p| p.value);
            let albedo = albedo(function).iter().map(|p| p.value);
            let all = color.chain(opacity).chain(albedo);
            let finite = all.filter(|value| value.is_finite());
            finite.map(|value| value.clamp(-limit, limit))
        };
        let start = values().reduce(f64::min).unwrap_or(0.0);
        let end = values().reduce(f64::max).unwrap_or(0.0);
        let jumps = jumps(function);
        let slope = steepest(function);

        // The distance of neighbouring f32 out there: finer cells would never be hit.
        let finest = power_of_two_at_or_below(start.abs().max(end.abs())) * 2f64.powi(-23);
        let finest = finest.max(2f64.powi(-100));
        let smallest =
            power_of_two_at_or_above((end - start) / (MAX_ENTRIES - 4) as f64).max(finest);
        let largest = power_of_two_at_or_above((end - start) / MIN_ENTRIES as f64).max(smallest);
        let off_by = |w: f64| slope * w * CELLS_OFF;
        let fits = |w: f64| off_by(w) <= TOLERANCE && !is_coarse((end - start) / w);
        let on_borders = |w: f64| jumps.iter().all(|&jump| (jump / w).fract() == 0.0);
        let widths = || {
            std::iter::successors(Some(largest), |w| Some(w / 2.0)).take_while(|&w| w >= smallest)
        };
        let width = widths()
            .find(|&w| fits(w) && on_borders(w))
            .or_else(|| widths().find(|&w| fits(w)))
            .unwrap_or(smallest);

        let first = (start / width).floor() * width - width;
        let wanted = ((end - first) / width).floor() as usize + 1;
        Self {
            first,
            width,
            count: wanted.next_power_of_two().clamp(MIN_ENTRIES, MAX_ENTRIES),
            off_by: off_by(width),
        }
    }
}

impl Table {
    /// The table of `function`.
    pub fn new(function: &TransferFunction, absorption: Absorption, space: ColorSpace) -> Self {
        let Cut {
            first,
            width,
            count,
            off_by,
        } = Cut::new(function);
        let entries = (0..count).map(|i| {
            let value = first + (i as f64 + 0.5) * width;
            absorption
                .classified(function, value, space)
                .map(|x| x as f32)
        });
        Self {
            entries: entries.collect(),
            first: first as f32,
            scale: (1.0 / width) as f32,
            off_by,
        }
    }
}

/// (red, green, blue, absorption) at `value`; colour as it is blended.
pub fn classify_by_table<N: Real>(table: &Table, value: N) -> [N; 4] {
    let n = |x: f32| N::from_f64(x.into());
    let cell = ((value - n(table.first)) * n(table.scale)).floor().to_f64();
    let last = table.entries.len() - 1;
    table.entries[(cell.max(0.0) as usize).min(last)].map(n)
}

/// Of a medium, where its keys say it.
fn albedo(function: &TransferFunction) -> &[MediumPoint] {
    let medium = function.medium.as_ref();
    medium.map_or(&[], |medium| &medium.albedo)
}

/// Where the specification jumps.
fn jumps(function: &TransferFunction) -> Vec<f64> {
    let step = function.interpolation == Interpolation::Step;
    let of = |pair: [f64; 2]| (step || pair[0] == pair[1]).then_some(pair[1]);
    let color = function.color.windows(2);
    let opacity = function.opacity.windows(2);
    let albedo = albedo(function).windows(2);
    color
        .filter_map(|p| of([p[0].value, p[1].value]))
        .chain(opacity.filter_map(|p| of([p[0].value, p[1].value])))
        .chain(albedo.filter_map(|p| of([p[0].value, p[1].value])))
        .collect()
}

/// The largest rise of opacity or of an sRGB number per unit of value, jumps left out.
fn steepest(function: &TransferFunction) -> f64 {
    if function.interpolation == Interpolation::Step {
        return 0.0;
    }
    let color = |p: &[ColorPoint]| {
        let rise = (0..3).map(|c| (p[1].srgb[c] - p[0].srgb[c]).abs());
        (rise.fold(0.0, f64::max), p[1].value - p[0].value)
    };
    let opacity =
        |p: &[OpacityPoint]| ((p[1].opacity - p[0].opacity).abs(), p[1].value - p[0].value);
    let color = function.color.windows(2).map(color);
    let albedo = |p: &[MediumPoint]| {
        let rise = (0..3).map(|c| (p[1].linear[c] - p[0].linear[c]).abs());
        (rise.fold(0.0, f64::max), p[1].value - p[0].value)
    };
    let albedo = self::albedo(function).windows(2).map(albedo);
    let opacity = function.opacity.windows(2).map(opacity);
    let all = color.chain(opacity).chain(albedo);
    all.filter(|&(_, run)| run > 0.0)
        .map(|(rise, run)| rise / run)
        .fold(0.0, f64::max)
}

/// The largest normal power of two that is not above `x`, or the smallest there is.
fn power_of_two_at_or_below(x: f64) -> f64 {
    f64::from_bits(x.max(f64::MIN_POSITIVE).to_bits() & (0x7ff << 52))
}

/// The smallest normal power of two that is not below `x`, which is not negative.
fn power_of_two_at_or_above(x: f64) -> f64 {
    let below = power_of_two_at_or_below(x);
    if below < x { below * 2.0 } else { below }
}
