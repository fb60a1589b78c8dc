//! Widgets as numbers for a shader, and what they make of a sample: twin of `shaders/lib/widgets.wgsl`.
//!
//! ```text
//! entry 0                  1 / steepest, count of shares, count of widgets, 0
//! shares                   gradient, share, 0, 0
//! four entries a widget    kind, opacity, 1 with a colour of its own, 1 where its end is included
//!                          numbers of the shape
//!                          colour as it is blended, 0
//!                          of an image: its first entry, columns, rows, 0
//! images                   cells, one an entry
//! ```

use super::{Graded, OpacityPoint, Shape, TransferFunction, extinction, opacity_over};
use crate::color::{ColorSpace, decode_srgb};
use crate::real::Real;

/// Entries a widget.
const STRIDE: usize = 4;
const CONTOUR: f32 = 0.0;
const REGION: f32 = 1.0;
const TRIANGLE: f32 = 2.0;
const RECTANGLE: f32 = 3.0;
const GAUSSIAN: f32 = 4.0;
const IMAGE: f32 = 5.0;

/// What the gradient does to a function, for a shader.
#[derive(Clone, Debug, PartialEq)]
pub struct PackedWidgets {
    /// As above; at least one.
    pub entries: Vec<[f32; 4]>,
    /// World length that opacities are for.
    reference_length: f64,
}

impl PackedWidgets {
    /// Those of `function`, whose opacities are for `reference_length`, blended in `space`. A function
    /// of the value alone has none.
    pub fn new(function: &TransferFunction, reference_length: f64, space: ColorSpace) -> Self {
        let empty = Graded::default();
        let graded = function.graded.as_ref().unwrap_or(&empty);
        // Where nothing is steep no gradient counts.
        let steepest = graded.steepest.filter(|&g| g > 0.0 && g.is_finite());
        let mut packed = Packing {
            widgets: Vec::new(),
            cells: Vec::new(),
        };
        for widget in &graded.widgets {
            let srgb = widget.srgb.map(|srgb| match space {
                ColorSpace::Linear => srgb.map(decode_srgb),
                ColorSpace::Display => srgb,
            });
            packed.push(&widget.shape, widget.opacity, srgb);
        }
        let count = packed.widgets.len();
        let shares = graded.share.iter().map(point);
        let per_steepest = steepest.map_or(0.0, |steepest| (1.0 / steepest) as f32);
        let head = [per_steepest, graded.share.len() as f32, count as f32, 0.0];
        let first_cell = 1 + graded.share.len() + STRIDE * count;
        for [_, _, _, image] in &mut packed.widgets {
            image[0] += first_cell as f32;
        }
        let widgets = packed.widgets.into_iter().flatten();
        let cells = packed.cells.into_iter().map(|cell| [cell, 0.0, 0.0, 0.0]);
        Self {
            entries: [head]
                .into_iter()
                .chain(shares)
                .chain(widgets)
                .chain(cells)
                .collect(),
            reference_length,
        }
    }
}

fn point(p: &OpacityPoint) -> [f32; 4] {
    [p.value as f32, p.opacity as f32, 0.0, 0.0]
}

struct Packing {
    widgets: Vec<[[f32; 4]; STRIDE]>,
    cells: Vec<f32>,
}

impl Packing {
    fn push(&mut self, shape: &Shape, opacity: f64, color: Option<[f64; 3]>) {
        let mut image = [0.0; 4];
        let mut push = |kind, numbers: [f64; 4], end_is_in: bool, image| {
            let [r, g, b] = color.unwrap_or_default();
            self.widgets.push([
                [
                    kind,
                    opacity as f32,
                    f32::from(color.is_some()),
                    f32::from(end_is_in),
                ],
                numbers.map(|x| x as f32),
                [r as f32, g as f32, b as f32, 0.0],
                image,
            ]);
        };
        match shape {
            Shape::Contour { value, half_width } => {
                push(CONTOUR, [*value, *half_width, 0.0, 0.0], false, image);
            }
            Shape::Region { points } => {
                for (i, pair) in points.windows(2).enumerate() {
                    let [a, b] = [pair[0], pair[1]];
                    let numbers = [a.value, b.value, a.opacity, b.opacity];
                    push(REGION, numbers, i + 2 == points.len(), image);
                }
            }
            Shape::Triangle {
                value,
                half_width,
                threshold,
                top,
            } => push(
                TRIANGLE,
                [*value, *half_width, *threshold, *top],
                false,
                image,
            ),
            Shape::Rectangle {
                values: [v0, v1],
                gradients: [s0, s1],
            } => push(RECTANGLE, [*v0, *v1, *s0, *s1], false, image),
            Shape::Gaussian {
                value,
                gradient,
                sigma_value,
                sigma_gradient,
            } => {
                let numbers = [*value, *gradient, 1.0 / sigma_value, 1.0 / sigma_gradient];
                push(GAUSSIAN, numbers, false, image);
            }
            Shape::Image {
                values: [v0, v1],
                gradients: [s0, s1],
                columns,
                cells,
            } => {
                let rows = cells.len() / columns.max(&1);
                image = [self.cells.len() as f32, *columns as f32, rows as f32, 0.0];
                push(IMAGE, [*v0, *v1, *s0, *s1], false, image);
                self.cells.extend(cells.iter().map(|&cell| cell as f32));
            }
        }
    }
}

/// The material (red, green, blue, extinction) of a sample of a value that the function alone gives `material`,
/// where the values rise by `magnitude` per world length, on a grid of this smallest spacing.
pub fn classify_by_gradient<N: Real>(
    packed: &PackedWidgets,
    material: [N; 4],
    value: N,
    magnitude: N,
    smallest_spacing: N,
) -> [N; 4] {
    let n = N::from_f64;
    let entry = |i: usize| packed.entries[i].map(N::from_f32);
    let [per_steepest, shares, widgets, _] = packed.entries[0];
    let (shares, widgets) = (shares as usize, widgets as usize);
    let reference_length = n(packed.reference_length);
    let steepness = magnitude * N::from_f32(per_steepest);
    let [r, g, b, mut sum] = material;
    if shares > 0 {
        let share = share_at(&packed.entries[1..=shares], steepness);
        sum = extinction(
            opacity_over(sum, reference_length) * share,
            reference_length,
        );
    }
    let mut light = [r, g, b].map(|c| sum * c);
    for widget in 0..widgets {
        let first = 1 + shares + STRIDE * widget;
        let [kind, opacity, has_color, _] = packed.entries[first];
        let shape = Lobe {
            kind,
            end_is_in: packed.entries[first][3] != 0.0,
            numbers: entry(first + 1),
            image: packed.entries[first + 3].map(|x| x as usize),
            entries: &packed.entries,
        };
        let share = shape.share(value, smallest_spacing, magnitude, steepness);
        let own = extinction(N::from_f32(opacity) * share, reference_length);
        let color = if has_color != 0.0 {
            entry(first + 2)
        } else {
            material
        };
        light = std::array::from_fn(|c| light[c] + own * color[c]);
        sum = sum + own;
    }
    if sum == n(0.0) {
        return [n(0.0); 4];
    }
    let [r, g, b] = light.map(|c| c / sum);
    [r, g, b, sum]
}

/// Between the points that a steepness lies between, constant beyond them.
fn share_at<N: Real>(points: &[[f32; 4]], steepness: N) -> N {
    let point = |i: usize| points[i].map(N::from_f32);
    let mut share = point(0)[1];
    for i in 0..points.len() {
        let left = point(i);
        if left[0] > steepness {
            break;
        }
        share = left[1];
        if i + 1 < points.len() && point(i + 1)[0] > steepness {
            let right = point(i + 1);
            let t = (steepness - left[0]) / (right[0] - left[0]);
            share = left[1] + t * (right[1] - left[1]);
        }
    }
    share
}

/// One shape, unpacked.
struct Lobe<'a, N> {
    kind: f32,
    end_is_in: bool,
    numbers: [N; 4],
    image: [usize; 4],
    entries: &'a [[f32; 4]],
}

impl<N: Real> Lobe<'_, N> {
    /// What is opaque of it.
    fn share(&self, value: N, smallest_spacing: N, magnitude: N, steepness: N) -> N {
        let n = N::from_f64;
        let [a, b, c, d] = self.numbers;
        let is_between = |x: N, low: N, high: N| low <= x && x <= high;
        match self.kind {
            CONTOUR => tent((value - a).abs(), b * smallest_spacing * magnitude),
            REGION => {
                let is_in = a <= value && (value < b || (self.end_is_in && value <= b));
                if !is_in {
                    return n(0.0);
                }
                // A boundary that is a jump has no length: its upper end rules.
                let t = if b > a { (value - a) / (b - a) } else { n(1.0) };
                steepness.min(n(1.0)) * (c + t * (d - c))
            }
            TRIANGLE if is_between(steepness, c, d) => tent((value - a).abs(), b * steepness / d),
            RECTANGLE if is_between(value, a, b) && is_between(steepness, c, d) => n(1.0),
            GAUSSIAN => {
                let (x, y) = ((value - a) * c, (steepness - b) * d);
                (n(-0.5) * (x * x + y * y)).exp()
            }
            IMAGE if is_between(value, a, b) && is_between(steepness, c, d) => {
                let x = (value - a) / (b - a);
                let y = (steepness - c) / (d - c);
                self.bilinear(x, y)
            }
            _ => n(0.0),
        }
    }

    /// Between the middles of cells, at fractions of the image.
    fn bilinear(&self, x: N, y: N) -> N {
        let [first, columns, rows, _] = self.image;
        let (x0, x1, part_x) = cells_at(x, columns);
        let (y0, y1, part_y) = cells_at(y, rows);
        let cell = |x: usize, y: usize| N::from_f32(self.entries[first + y * columns + x][0]);
        let lerp = |a: N, b: N, t: N| a + t * (b - a);
        let low = lerp(cell(x0, y0), cell(x1, y0), part_x);
        let high = lerp(cell(x0, y1), cell(x1, y1), part_x);
        lerp(low, high, part_y)
    }
}

/// 1 at no distance, 0 at `reach`.
fn tent<N: Real>(distance: N, reach: N) -> N {
    let n = N::from_f64;
    if distance == n(0.0) {
        n(1.0)
    } else if distance <= reach {
        n(1.0) - distance / reach
    } else {
        n(0.0)
    }
}

/// The two cells about a fraction of a row of them, and the weight of the second.
fn cells_at<N: Real>(fraction: N, count: usize) -> (usize, usize, N) {
    let at = fraction * N::from_f64(count as f64) - N::from_f64(0.5);
    let below = at.floor();
    let last = count as i32 - 1;
    let cell = |i: i32| i.clamp(0, last) as usize;
    let first = below.to_i32();
    (cell(first), cell(first + 1), at - below)
}
