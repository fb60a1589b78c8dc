//! Opacity by value and gradient magnitude.
//!
//! A function of one value `opacity(f)`, weighted by how steep the values are, and beside it widgets, each an
//! emitter of its own. Emitters in one place add up their extinction (Max 1995), so their opacities combine as
//!
//! ```text
//! alpha = 1 - (1 - opacity(f) share(s)) product of (1 - a_n shape_n(f, s))
//! ```
//!
//! which is how Levoy (1988, IEEE CG&A 8(3), section 3) puts several isovalue contours together. The colour is the
//! mean of theirs, weighted by extinction. `s` is the gradient magnitude as a fraction of the steepest one.
//!
//! | shape | its share | source |
//! |---|---|---|
//! | contour | max(0, 1 - \|f - v\| / (r \|grad f\|)); 1 where f = v | Levoy 1988, equation 3 |
//! | region | min(s, 1) lerp(a_n, a_n+1) for v_n <= f <= v_n+1, else 0 | Levoy 1988, equation 4 |
//! | triangle | max(0, 1 - \|f - v\| / (w s / top)) for threshold <= s <= top | Kniss, Kindlmann & Hansen 2002 |
//! | rectangle | 1 for v0 <= f <= v1 and s0 <= s <= s1 | Kniss, Kindlmann & Hansen 2002 |
//! | gaussian | exp(-((f - v)^2 / sigma_v^2 + (s - s0)^2 / sigma_s^2) / 2) | Kniss et al. 2003 |
//! | image | bilinear between the middles of its cells, 0 outside of it | Kindlmann & Durkin 1998 |
//!
//! Each may be weighted by the second derivative along the gradient as a third axis (Kindlmann & Durkin 1998), with
//! f'' = g^T H g / |g|^2, which is 0 in the middle of a boundary: by a trapezoid, or by a bell, which makes a gaussian
//! one of three axes. It counts in the steepest gradient per smallest voxel spacing, so that 1 is a gradient that grows
//! from nothing to the steepest within a voxel.
//!
//! The half-width r of a contour is counted in smallest voxel spacings h: r h |grad f| is how far the value runs on
//! that way, whatever the slope, so the contour is as thick everywhere.

use super::{OpacityPoint, TransferFunction};

/// What a transfer function makes of the gradient magnitude.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GradientTransfer {
    /// The gradient magnitude, in values per world length, that counts as 1; `None`: the largest of the volume
    /// ([`TransferFunction::with_steepest`]).
    pub steepest: Option<f64>,
    /// Share of the opacity of the value, 0 to 1, by the fraction of the steepest gradient; no point: all of it.
    pub share: Vec<OpacityPoint>,
    /// Emitters of their own.
    pub widgets: Vec<Widget>,
}

/// An emitter over value and gradient magnitude.
#[derive(Clone, Debug, PartialEq)]
pub struct Widget {
    /// sRGB, 0 to 1; `None`: the colour that the function gives the value.
    pub srgb: Option<[f64; 3]>,
    /// Where the shape is 1, per reference length, 0 to 1.
    pub opacity: f64,
    /// Where it is opaque.
    pub shape: Shape,
    /// What the second derivative makes of that; `None`: nothing.
    pub second: Option<SecondDerivative>,
}

/// A share, 0 to 1, of the second derivative along the gradient, in steepest gradients per smallest voxel spacing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SecondDerivative {
    /// Begins, is full, is full no longer, ends; where two of them are one, that end is included.
    Trapezoid([f64; 4]),
    /// exp(-((second - middle) / sigma)^2 / 2).
    Bell {
        /// Its middle.
        middle: f64,
        /// Its standard deviation.
        sigma: f64,
    },
}

/// Cells of an image, row by row, those of the smallest gradients first.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Shares from 0 to 1.
    Shares(Vec<f64>),
    /// sRGB red, green, blue, not multiplied, and the share, from 0 to 255: the widget's own colour is not used.
    Rgba(Vec<[u8; 4]>),
}

impl Cells {
    /// How many there are.
    pub fn count(&self) -> usize {
        match self {
            Self::Shares(shares) => shares.len(),
            Self::Rgba(colors) => colors.len(),
        }
    }
}

/// A share, 0 to 1, of value and gradient magnitude; gradients are fractions of the steepest.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A tent about the surface of a value.
    Contour {
        /// The value.
        value: f64,
        /// In smallest voxel spacings.
        half_width: f64,
    },
    /// Opacities of substances, and of what lies between them, as far as there is a boundary.
    Region {
        /// At least two, by ascending value.
        points: Vec<OpacityPoint>,
    },
    /// A tent over values that widens with the gradient from nothing.
    Triangle {
        /// Its middle.
        value: f64,
        /// In values, where the gradient is `top`.
        half_width: f64,
        /// The smallest gradient.
        threshold: f64,
        /// The largest gradient.
        top: f64,
    },
    /// All between, both ends included.
    Rectangle {
        /// Values.
        values: [f64; 2],
        /// Gradients.
        gradients: [f64; 2],
    },
    /// A bell.
    Gaussian {
        /// Its middle.
        value: f64,
        /// Its middle.
        gradient: f64,
        /// Standard deviation in values.
        sigma_value: f64,
        /// Standard deviation in gradients.
        sigma_gradient: f64,
    },
    /// Shares in cells.
    Image {
        /// Where the first column begins and the last one ends.
        values: [f64; 2],
        /// Where the first row begins and the last one ends.
        gradients: [f64; 2],
        /// Cells across.
        columns: usize,
        /// What stands in them.
        cells: Cells,
    },
}

impl Widget {
    /// True where it does not take the colour of the value.
    pub fn has_color(&self) -> bool {
        let is_painted = |cells: &Cells| matches!(cells, Cells::Rgba(_));
        self.srgb.is_some()
            || matches!(&self.shape, Shape::Image { cells, .. } if is_painted(cells))
    }
}

impl GradientTransfer {
    /// True where some gradient is a fraction of the steepest, so that one must be known.
    pub fn needs_steepest(&self) -> bool {
        let is_fraction = |widget: &Widget| {
            widget.second.is_some() || !matches!(widget.shape, Shape::Contour { .. })
        };
        !self.share.is_empty() || self.widgets.iter().any(is_fraction)
    }

    /// True where a second derivative counts.
    pub fn needs_second(&self) -> bool {
        self.widgets.iter().any(|widget| widget.second.is_some())
    }

    /// This with its values moved: `moved` is a straight line that rises by `slope`.
    pub(super) fn moved(&self, moved: impl Fn(f64) -> f64, slope: f64) -> Self {
        let mut gradient_transfer = self.clone();
        // Where values are stretched, so are gradients.
        gradient_transfer.steepest = gradient_transfer.steepest.map(|steepest| steepest * slope);
        for widget in &mut gradient_transfer.widgets {
            match &mut widget.shape {
                Shape::Contour { value, .. } => *value = moved(*value),
                Shape::Region { points } => {
                    for point in points {
                        point.value = moved(point.value);
                    }
                }
                Shape::Triangle {
                    value, half_width, ..
                } => (*value, *half_width) = (moved(*value), *half_width * slope),
                Shape::Gaussian {
                    value, sigma_value, ..
                } => (*value, *sigma_value) = (moved(*value), *sigma_value * slope),
                Shape::Rectangle { values, .. } | Shape::Image { values, .. } => {
                    *values = values.map(&moved);
                }
            }
        }
        gradient_transfer
    }
}

impl TransferFunction {
    /// True where opacity or colour depends on the gradient.
    pub fn uses_gradient(&self) -> bool {
        self.gradient_transfer.is_some()
    }

    /// This function with `steepest` as the gradient that counts as 1, where it names none and needs one.
    pub fn with_steepest(mut self, steepest: impl FnOnce() -> f64) -> Self {
        if let Some(gradient_transfer) = &mut self.gradient_transfer
            && gradient_transfer.steepest.is_none()
            && gradient_transfer.needs_steepest()
        {
            gradient_transfer.steepest = Some(steepest());
        }
        self
    }
}
