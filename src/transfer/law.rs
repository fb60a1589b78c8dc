//! What a transfer function says of a value, exactly (`sampling.md` 4).
//!
//! ```text
//! sigma = -ln(1 - min(a0, 1 - 2^-12)) / d0        extinction, per world length
//! alpha = 1 - exp(-x),  x = sigma d               opacity of a segment of length d
//!       = x (1 - x/2 + x^2/6)                     below x = 0.01
//! ```
//!
//! In f32 the first form loses three digits at x = 1e-4; the series is off by x^3/24 < 5e-8 of alpha.

use super::{Interpolation, TransferFunction};
use crate::color::{ColorSpace, decode_srgb};
use crate::real::Real;

/// Opacities above this count as this: one sample never makes an infinite extinction.
pub const MAX_OPACITY: f64 = 1.0 - 1.0 / 4096.0;

/// How a classified value absorbs: the fourth number beside its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Absorption {
    /// Extinction per world length, for modes that add up along the ray.
    Extinction {
        /// World length that opacities are for.
        reference_length: f64,
    },
    /// Opacity itself, 1 included, for modes that classify one value a ray.
    Opacity,
    /// Extinction per world length of matter that scatters light, times `density`: what a function says of it, or its
    /// opacity. Colours are albedos.
    Medium {
        /// World length that opacities are for.
        reference_length: f64,
        /// What extinctions are multiplied by.
        density: f64,
    },
}

impl Absorption {
    /// Extinction of `opacity`, or `opacity` itself.
    pub fn of<N: Real>(self, opacity: N) -> N {
        match self {
            Self::Extinction { reference_length } => {
                extinction(opacity, N::from_f64(reference_length))
            }
            Self::Opacity => opacity,
            Self::Medium {
                reference_length,
                density,
            } => extinction(opacity, N::from_f64(reference_length / density)),
        }
    }

    /// The length that opacities are for, so much less of denser matter; 1 where there is none.
    pub fn reference_length(self) -> f64 {
        match self {
            Self::Extinction { reference_length } => reference_length,
            Self::Opacity => 1.0,
            Self::Medium {
                reference_length,
                density,
            } => reference_length / density,
        }
    }

    /// Colour as it is blended in `space`, and the fourth number, of a function at a value.
    pub(super) fn classified(
        self,
        function: &TransferFunction,
        value: f64,
        space: ColorSpace,
    ) -> [f64; 4] {
        let ([r, g, b], fourth) = match self {
            Self::Medium {
                reference_length,
                density,
            } => {
                let extinctions = function.extinctions(value, reference_length);
                let mean = extinctions.iter().sum::<f64>() / 3.0;
                (function.albedo(value), density * mean)
            }
            Self::Extinction { .. } | Self::Opacity => {
                let opacity = function.opacity(value);
                (function.color(value, space), self.of(opacity))
            }
        };
        [r, g, b, fourth]
    }
}

impl TransferFunction {
    /// Opacity per reference length, 0 to 1.
    pub fn opacity(&self, value: f64) -> f64 {
        let points = self.opacity.iter().map(|p| (p.value, [p.opacity]));
        between(points, self.interpolation, value)[0]
    }

    /// sRGB numbers, 0 to 1.
    pub fn srgb(&self, value: f64) -> [f64; 3] {
        let points = self.color.iter().map(|p| (p.value, p.srgb));
        between(points, self.interpolation, value)
    }

    /// The colour as it is blended in `space`.
    pub fn color(&self, value: f64, space: ColorSpace) -> [f64; 3] {
        match space {
            ColorSpace::Linear => self.srgb(value).map(decode_srgb),
            ColorSpace::Display => self.srgb(value),
        }
    }
}

/// Extinction per world length of an opacity per `reference_length`.
pub fn extinction<N: Real>(opacity: N, reference_length: N) -> N {
    let limit = N::from_f64(MAX_OPACITY);
    let opacity = if opacity < limit { opacity } else { limit };
    -(N::from_f64(1.0) - opacity).ln() / reference_length
}

/// Opacity of a segment of world length `length`.
pub fn opacity_over<N: Real>(extinction: N, length: N) -> N {
    let n = N::from_f64;
    let x = extinction * length;
    if x < n(0.01) {
        x * (n(1.0) - x * n(0.5) + x * x * n(1.0 / 6.0))
    } else {
        n(1.0) - (-x).exp()
    }
}

/// What stands at `value`; all zeros without points.
pub(super) fn between<const C: usize>(
    points: impl Iterator<Item = (f64, [f64; C])>,
    interpolation: Interpolation,
    value: f64,
) -> [f64; C] {
    let mut left = None;
    for (at, right) in points {
        if at <= value {
            left = Some((at, right));
            continue;
        }
        return match (left, interpolation) {
            (None, _) => right,
            (Some((_, left)), Interpolation::Step) => left,
            (Some((start, left)), Interpolation::Linear) => {
                let t = (value - start) / (at - start);
                std::array::from_fn(|c| left[c] + t * (right[c] - left[c]))
            }
        };
    }
    left.map_or([0.0; C], |(_, last)| last)
}
