//! The window of `--window LO,HI`: the interval of values that a function is spread over.

use super::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};

/// An interval of values, `low < high`, both finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    low: f64,
    high: f64,
}

/// What a mode classifies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Classified {
    /// Every sample of a ray: composite.
    Samples,
    /// One projected value a ray: mip, minip, average, xray, lmip.
    Projection,
}

impl Window {
    /// `None` unless `low < high` and both are finite.
    pub fn new(low: f64, high: f64) -> Option<Self> {
        let right = low < high && (high - low).is_finite();
        right.then_some(Self { low, high })
    }

    /// The window of a range of values; widened about a range of one value.
    pub fn of_range([low, high]: [f64; 2]) -> Self {
        Self::new(low, high).unwrap_or_else(|| {
            let middle = if low.is_finite() { low } else { 0.0 };
            let half = (middle.abs() * 1e-3).max(0.5);
            Self {
                low: middle - half,
                high: middle + half,
            }
        })
    }

    /// Where it begins.
    pub fn low(self) -> f64 {
        self.low
    }

    /// Where it ends.
    pub fn high(self) -> f64 {
        self.high
    }

    fn length(self) -> f64 {
        self.high - self.low
    }

    /// The value at a fraction of the window: 0 its low end, 1 its high end.
    pub fn at(self, t: f64) -> f64 {
        self.low + t * (self.high - self.low)
    }

    /// Preset `grey`: sRGB grey level t, the value's fraction of the window; opacity t/20 per smallest voxel
    /// spacing, or 1 where one value a ray is classified.
    pub fn grey(self, classified: Classified) -> TransferFunction {
        let opacity = match classified {
            Classified::Samples => [0.0, 1.0 / 20.0],
            Classified::Projection => [1.0, 1.0],
        };
        let values = [self.low, self.high];
        let color = values
            .iter()
            .zip([0.0, 1.0])
            .map(|(&value, level)| ColorPoint {
                value,
                srgb: [level; 3],
            });
        let opacity = values
            .iter()
            .zip(opacity)
            .map(|(&value, opacity)| OpacityPoint { value, opacity });
        TransferFunction {
            color: color.collect(),
            opacity: opacity.collect(),
            reference_length: None,
            interpolation: Interpolation::Linear,
            gradient_transfer: None,
            medium: None,
        }
    }
}

impl TransferFunction {
    /// This function, whose points stand at fractions of `window`, with them at its values.
    pub fn of_fractions(&self, window: Window) -> Self {
        let mut placed = self.clone();
        for point in &mut placed.color {
            point.value = window.at(point.value);
        }
        for point in &mut placed.opacity {
            point.value = window.at(point.value);
        }
        let medium = placed.medium.map(|m| m.moved(|v| window.at(v)));
        placed.medium = medium.map(Box::new);
        let gradient_transfer = self.gradient_transfer.as_ref();
        placed.gradient_transfer = gradient_transfer
            .map(|gradient_transfer| gradient_transfer.moved(|v| window.at(v), window.length()));
        placed
    }

    /// This function spread over `window`: its first control point (of colour or opacity) moves to the low
    /// end, its last one to the high end, the others keep their fractions. Points that all lie at one value
    /// move to the middle.
    pub fn spread_over(&self, window: Window) -> Self {
        let values = || {
            let color = self.color.iter().map(|p| p.value);
            let medium = self.medium.iter().flat_map(|medium| medium.values());
            let opacity = self.opacity.iter().map(|p| p.value);
            color.chain(opacity).chain(medium)
        };
        let first = values().fold(f64::INFINITY, f64::min);
        let last = values().fold(f64::NEG_INFINITY, f64::max);
        let moved = |value: f64| {
            if last > first {
                window.at((value - first) / (last - first))
            } else {
                window.at(0.5)
            }
        };
        let mut spread = self.clone();
        for point in &mut spread.color {
            point.value = moved(point.value);
        }
        for point in &mut spread.opacity {
            point.value = moved(point.value);
        }
        let medium = spread.medium.map(|medium| medium.moved(moved));
        spread.medium = medium.map(Box::new);
        let slope = if last > first {
            window.length() / (last - first)
        } else {
            1.0
        };
        let gradient_transfer = self.gradient_transfer.as_ref();
        spread.gradient_transfer =
            gradient_transfer.map(|gradient_transfer| gradient_transfer.moved(moved, slope));
        spread
    }
}
