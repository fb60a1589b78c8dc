//! Colours of lines.
//!
//! ```text
//! colour = map((value - low) / (high - low)),   low 0 of speeds, else the lowest value;   high: 99.9 % of vertices are under it
//! ```

use crate::color::{decode_srgb, encode_srgb};
use crate::flow::write::LineValues;
use crate::transfer::{ColorPoint, Colormap, Interpolation, TransferFunction};

/// Colours span up to the value that this part of the vertices does not exceed.
const MOST: f64 = 0.999;
/// From yellow to violet, the strongest: matplotlib's plasma from here to here.
const MAP: &str = "plasma";
const ENDS: [f64; 2] = [0.97, 0.2];
/// Pieces of the colours of a bar.
const POINTS: u32 = 64;

/// From the values of lines to linear colours.
#[derive(Clone, Debug)]
pub(super) struct LineColors {
    one: Option<[f32; 3]>,
    map: Option<Colormap>,
    /// The part of the map.
    ends: [f64; 2],
    /// Where colours begin and end.
    pub range: [f64; 2],
}

impl LineColors {
    /// Of one sRGB colour, or of the values over their range, by a map of this name.
    pub fn new(
        values: &LineValues,
        one: Option<[f32; 3]>,
        map: Option<&str>,
        range: Option<[f64; 2]>,
    ) -> Self {
        Self {
            one: one.map(|color| color.map(decode_srgb)),
            map: Colormap::from_name(map.unwrap_or(MAP)),
            ends: if map.is_some() { [0.0, 1.0] } else { ENDS },
            range: range.unwrap_or_else(|| range_of(values)),
        }
    }

    /// The colours over their range.
    pub fn function(&self) -> TransferFunction {
        let [low, high] = self.range;
        let point = |i: u32| {
            let value = low + f64::from(i) / f64::from(POINTS) * (high - low);
            let srgb = self.of(value).map(|c| f64::from(encode_srgb(c)));
            ColorPoint { value, srgb }
        };
        TransferFunction {
            color: (0..=POINTS).map(point).collect(),
            opacity: Vec::new(),
            reference_length: None,
            interpolation: Interpolation::Linear,
            gradient_transfer: None,
            medium: None,
        }
    }

    /// The linear colour of a value; grey where there is none.
    pub fn of(&self, value: f64) -> [f32; 3] {
        if let Some(one) = self.one {
            return one;
        }
        let [low, high] = self.range;
        let part = ((value - low) / (high - low)).clamp(0.0, 1.0);
        let part = self.ends[0] + part * (self.ends[1] - self.ends[0]);
        match self.map.as_ref().filter(|_| part.is_finite()) {
            Some(map) => map.srgb(part).map(|n| decode_srgb(n as f32)),
            None => [0.5; 3],
        }
    }
}

/// From 0, or the lowest value where it is under that, to what few vertices exceed.
fn range_of(values: &LineValues) -> [f64; 2] {
    let all = values.numbers.iter().flatten().copied();
    let mut all: Vec<f64> = all.filter(|n| n.is_finite()).collect();
    if all.is_empty() {
        return [0.0, 1.0];
    }
    all.sort_by(f64::total_cmp);
    let low = if values.name == "speed" { 0.0 } else { all[0] };
    let high = all[(MOST * (all.len() - 1) as f64) as usize];
    [low, if high > low { high } else { low + 1.0 }]
}
