//! Colour of one function, opacity of another.

use super::{
    ColorPoint, Interpolation, MediumPoint, MediumTransfer, OpacityPoint, TransferFunction,
};

impl TransferFunction {
    /// This function with the colours of `other`.
    pub fn with_color_of(&self, other: &Self) -> Self {
        let (own, other) = alike(self, other);
        Self {
            medium: own.medium_of_colors(&other),
            color: other.color,
            ..own
        }
    }

    /// This function with the opacity of `other`: its points, the length that they are for, and what the gradient
    /// makes of them.
    pub fn with_opacity_of(&self, other: &Self) -> Self {
        let (own, other) = alike(self, other);
        Self {
            medium: other.medium_of_colors(&own),
            color: own.color,
            ..other
        }
    }

    /// The same law by straight lines: a step is a line of no length.
    fn by_lines(&self) -> Self {
        if self.interpolation == Interpolation::Linear {
            return self.clone();
        }
        Self {
            color: steps(&self.color, |left, right| ColorPoint {
                value: right.value,
                ..*left
            }),
            opacity: steps(&self.opacity, |left, right| OpacityPoint {
                value: right.value,
                ..*left
            }),
            medium: self.medium.as_ref().map(|medium| {
                let by_lines = |points: &[MediumPoint]| {
                    steps(points, |left, right| MediumPoint {
                        value: right.value,
                        ..*left
                    })
                };
                Box::new(MediumTransfer {
                    extinction: by_lines(&medium.extinction),
                    albedo: by_lines(&medium.albedo),
                    emission: by_lines(&medium.emission),
                    phase: medium.phase,
                })
            }),
            interpolation: Interpolation::Linear,
            ..self.clone()
        }
    }
}

/// Both with one interpolation.
fn alike(a: &TransferFunction, b: &TransferFunction) -> (TransferFunction, TransferFunction) {
    if a.interpolation == b.interpolation {
        (a.clone(), b.clone())
    } else {
        (a.by_lines(), b.by_lines())
    }
}

/// Before each point but the first one that goes on with what was left of it.
fn steps<P: Clone>(points: &[P], held: impl Fn(&P, &P) -> P) -> Vec<P> {
    let first = points.first().cloned();
    let pairs = points.windows(2);
    let rest = pairs.flat_map(|pair| [held(&pair[0], &pair[1]), pair[1].clone()]);
    first.into_iter().chain(rest).collect()
}
