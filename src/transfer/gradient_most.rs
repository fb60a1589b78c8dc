//! The most that gradients make of a range of values, whatever the gradient: what bounds of extinctions are made of.
//!
//! ```text
//! sigma(f, s) <= max share sigma(f) + sum over widgets of extinction(a_n max over s of shape_n(f, s))
//! ```

use super::{Cells, GradientTransfer, Shape, Widget};

impl GradientTransfer {
    /// The largest share of the opacity of the value.
    pub(crate) fn most_share(&self) -> f64 {
        let shares = self.share.iter().map(|point| point.opacity);
        shares.reduce(f64::max).unwrap_or(1.0)
    }

    /// The most opacity of each widget between two values, both included.
    pub(crate) fn most_opacities(&self, range: [f64; 2]) -> impl Iterator<Item = f64> {
        let most = move |widget: &Widget| widget.opacity * most_of(&widget.shape, range);
        self.widgets.iter().map(most)
    }

    /// The values beyond which no widget has more than at these; `None` where each is everywhere or there is none.
    pub(crate) fn span(&self) -> Option<[f64; 2]> {
        let spans = self
            .widgets
            .iter()
            .filter_map(|widget| match &widget.shape {
                Shape::Contour { .. } => None,
                Shape::Region { points } => {
                    let ends = points.first().zip(points.last());
                    ends.map(|(first, last)| [first.value, last.value])
                }
                Shape::Triangle {
                    value, half_width, ..
                } => Some([value - half_width.abs(), value + half_width.abs()]),
                // As far as exp(-8) of what it is in the middle.
                Shape::Gaussian {
                    value, sigma_value, ..
                } => Some([
                    value - 4.0 * sigma_value.abs(),
                    value + 4.0 * sigma_value.abs(),
                ]),
                Shape::Rectangle { values, .. } | Shape::Image { values, .. } => Some(*values),
            });
        spans.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }
}

/// The largest share of a shape between two values, whatever the gradient.
fn most_of(shape: &Shape, [low, high]: [f64; 2]) -> f64 {
    let away = |value: f64| (low - value).max(value - high).max(0.0);
    let meets = |[from, to]: [f64; 2]| from <= high && to >= low;
    match shape {
        Shape::Contour { .. } => 1.0,
        Shape::Region { points } => {
            let pairs = points.windows(2);
            let met = pairs.filter(|pair| meets([pair[0].value, pair[1].value]));
            let most = met.map(|pair| pair[0].opacity.max(pair[1].opacity));
            most.fold(0.0, f64::max)
        }
        Shape::Triangle {
            value, half_width, ..
        } => match away(*value) {
            0.0 => 1.0,
            away => (1.0 - away / half_width.abs()).max(0.0),
        },
        Shape::Rectangle { values, .. } => f64::from(u8::from(meets(*values))),
        Shape::Gaussian {
            value, sigma_value, ..
        } => (-0.5 * (away(*value) / sigma_value).powi(2)).exp(),
        Shape::Image {
            values: [from, to],
            columns,
            cells,
            ..
        } => {
            let width = (to - from) / *columns as f64;
            // Between the middles of cells: each reaches the middle of the next, and another for rounding.
            let reach = |i: usize| [i as f64 - 1.0, i as f64 + 2.0].map(|x| from + x * width);
            let share = |i: usize| match cells {
                Cells::Shares(shares) => shares[i],
                Cells::Rgba(colors) => f64::from(colors[i][3]) / 255.0,
            };
            let met = (0..cells.count()).filter(|i| meets(reach(i % columns)));
            met.map(share).fold(0.0, f64::max)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::ColorSpace;
    use crate::transfer::{
        GradientMagnitude, Interpolation, OpacityPoint, PackedWidgets, TransferFunction,
        classify_by_gradient, extinction,
    };

    /// Each kind of widget, beside a share of what the value has.
    #[test]
    fn no_gradient_makes_more_of_values_between_two_than_the_bound_says() {
        let point = |value, opacity| OpacityPoint { value, opacity };
        let gradients = [0.1, 0.9];
        let cells = Cells::Shares((0..12).map(|i| f64::from(i * 5 % 12) / 11.0).collect());
        let shapes = [
            Shape::Contour {
                value: 3.0,
                half_width: 2.0,
            },
            Shape::Region {
                points: vec![point(1.0, 0.2), point(4.0, 0.9), point(6.0, 0.1)],
            },
            Shape::Triangle {
                value: 5.0,
                half_width: 1.5,
                threshold: 0.1,
                top: 0.8,
            },
            Shape::Rectangle {
                values: [2.0, 4.5],
                gradients,
            },
            Shape::Gaussian {
                value: 6.0,
                gradient: 0.4,
                sigma_value: 0.7,
                sigma_gradient: 0.3,
            },
            Shape::Image {
                values: [1.0, 9.0],
                gradients,
                columns: 4,
                cells,
            },
        ];
        for shape in shapes {
            let name = format!("{shape:?}");
            let transfer = GradientTransfer {
                steepest: Some(1.0),
                share: vec![point(0.2, 0.3), point(0.7, 0.8)],
                widgets: vec![Widget {
                    srgb: None,
                    opacity: 0.8,
                    shape,
                    second: None,
                }],
            };
            let function = TransferFunction {
                color: Vec::new(),
                opacity: vec![point(0.0, 0.0), point(10.0, 0.6)],
                reference_length: None,
                interpolation: Interpolation::Linear,
                gradient_transfer: Some(transfer.clone()),
                medium: None,
            };
            let packed = PackedWidgets::new(&function, 1.0, ColorSpace::Linear);
            let mut is_reached = false;
            for from in 0..20 {
                let [low, high] = [0.5 * f64::from(from), 0.5 * f64::from(from + 1)];
                let own: f64 = extinction(function.opacity(high), 1.0);
                let widgets = transfer.most_opacities([low, high]);
                let bound = transfer.most_share() * own
                    + widgets.map(|opacity| extinction(opacity, 1.0)).sum::<f64>();
                for i in 0..=20 {
                    let value = low + (high - low) * f64::from(i) / 20.0;
                    for magnitude in (0..=40).map(|k| f64::from(k) / 40.0) {
                        let own = [1.0, 1.0, 1.0, extinction(function.opacity(value), 1.0)];
                        let steep = GradientMagnitude {
                            magnitude,
                            second: 0.0,
                            smallest_spacing: 1.0,
                        };
                        let found = classify_by_gradient(&packed, own, value, steep)[3];
                        assert!(found <= bound * (1.0 + 1e-6), "{name} {value} {magnitude}");
                        is_reached |= found > 0.8 * bound;
                    }
                }
            }
            assert!(is_reached, "{name}: the bound is far off");
        }
    }
}
