//! Widgets as numbers for a shader, and what they make of a sample: CPU reference of `shaders/lib/widgets.wgsl`.
//!
//! ```text
//! entry 0                  1 / steepest, count of shares, count of widgets, 1 where second derivatives count
//! shares                   gradient, share, 0, 0
//! five entries a widget    kind, opacity, 1 with a colour of its own (2: that of its cells), 1 where its end is included
//!                          numbers of the shape
//!                          colour as it is blended, kind of its weight by the second derivative
//!                          of an image: its first entry, columns, rows, 0
//!                          numbers of that weight
//! images                   cells, one an entry: share, and the colour as it is blended times the share
//! ```

use super::{
    Cells, GradientTransfer, OpacityPoint, SecondDerivative, Shape, TransferFunction, Widget,
    extinction, opacity_over,
};
use crate::color::{ColorSpace, decode_srgb};
use crate::real::Real;

/// Entries a widget.
const STRIDE: usize = 5;
const CONTOUR: f32 = 0.0;
const REGION: f32 = 1.0;
const TRIANGLE: f32 = 2.0;
const RECTANGLE: f32 = 3.0;
const GAUSSIAN: f32 = 4.0;
const IMAGE: f32 = 5.0;
/// Kinds of weights by the second derivative.
const TRAPEZOID: f32 = 1.0;
const BELL: f32 = 2.0;
/// In the place of 1: a colour that its cells have.
const PAINTED: f32 = 2.0;

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
        let empty = GradientTransfer::default();
        let gradient_transfer = function.gradient_transfer.as_ref().unwrap_or(&empty);
        // Where nothing is steep no gradient counts.
        let steepest = gradient_transfer
            .steepest
            .filter(|&g| g > 0.0 && g.is_finite());
        let mut packed = Packing {
            widgets: Vec::new(),
            cells: Vec::new(),
            space,
        };
        for widget in &gradient_transfer.widgets {
            packed.push(widget);
        }
        let count = packed.widgets.len();
        let shares = gradient_transfer.share.iter().map(point);
        let per_steepest = steepest.map_or(0.0, |steepest| (1.0 / steepest) as f32);
        let wants_second = f32::from(gradient_transfer.needs_second());
        let head = [
            per_steepest,
            gradient_transfer.share.len() as f32,
            count as f32,
            wants_second,
        ];
        let first_cell = 1 + gradient_transfer.share.len() + STRIDE * count;
        for [_, _, _, image, _] in &mut packed.widgets {
            image[0] += first_cell as f32;
        }
        let widgets = packed.widgets.into_iter().flatten();
        Self {
            entries: [head]
                .into_iter()
                .chain(shares)
                .chain(widgets)
                .chain(packed.cells)
                .collect(),
            reference_length,
        }
    }
}

impl PackedWidgets {
    /// True where a second derivative counts.
    pub fn needs_second(&self) -> bool {
        self.entries[0][3] != 0.0
    }
}

fn point(p: &OpacityPoint) -> [f32; 4] {
    [p.value as f32, p.opacity as f32, 0.0, 0.0]
}

struct Packing {
    widgets: Vec<[[f32; 4]; STRIDE]>,
    cells: Vec<[f32; 4]>,
    space: ColorSpace,
}

impl Packing {
    fn blended(&self, srgb: [f64; 3]) -> [f64; 3] {
        match self.space {
            ColorSpace::Linear => srgb.map(decode_srgb),
            ColorSpace::Display => srgb,
        }
    }

    fn push_cells(&mut self, cells: &Cells) {
        let entries: Vec<_> = match cells {
            Cells::Shares(shares) => shares.iter().map(|&s| [s as f32, 0.0, 0.0, 0.0]).collect(),
            Cells::Rgba(colors) => {
                let entry = |rgba: &[u8; 4]| {
                    let [r, g, b, share] = rgba.map(|code| f64::from(code) / 255.0);
                    let [r, g, b] = self.blended([r, g, b]).map(|c| (share * c) as f32);
                    [share as f32, r, g, b]
                };
                colors.iter().map(entry).collect()
            }
        };
        self.cells.extend(entries);
    }

    fn push(&mut self, widget: &Widget) {
        let mut image = [0.0; 4];
        let color = widget.srgb.map(|srgb| self.blended(srgb));
        let is_painted = widget.has_color() && color.is_none();
        let has_color = if is_painted {
            PAINTED
        } else {
            f32::from(color.is_some())
        };
        let (second_kind, second) = match widget.second {
            None => (0.0, [0.0; 4]),
            Some(SecondDerivative::Trapezoid(corners)) => (TRAPEZOID, corners),
            Some(SecondDerivative::Bell { middle, sigma }) => {
                (BELL, [middle, 1.0 / sigma, 0.0, 0.0])
            }
        };
        let opacity = widget.opacity as f32;
        if let Shape::Image { columns, cells, .. } = &widget.shape {
            let rows = cells.count() / columns.max(&1);
            image = [self.cells.len() as f32, *columns as f32, rows as f32, 0.0];
            self.push_cells(cells);
        }
        let mut push = |kind, numbers: [f64; 4], end_is_in: bool| {
            let [r, g, b] = color.unwrap_or_default();
            self.widgets.push([
                [kind, opacity, has_color, f32::from(end_is_in)],
                numbers.map(|x| x as f32),
                [r as f32, g as f32, b as f32, second_kind],
                image,
                second.map(|x| x as f32),
            ]);
        };
        match &widget.shape {
            Shape::Contour { value, half_width } => {
                push(CONTOUR, [*value, *half_width, 0.0, 0.0], false);
            }
            Shape::Region { points } => {
                for (i, pair) in points.windows(2).enumerate() {
                    let [a, b] = [pair[0], pair[1]];
                    let numbers = [a.value, b.value, a.opacity, b.opacity];
                    push(REGION, numbers, i + 2 == points.len());
                }
            }
            Shape::Triangle {
                value,
                half_width,
                threshold,
                top,
            } => push(TRIANGLE, [*value, *half_width, *threshold, *top], false),
            Shape::Rectangle {
                values: [v0, v1],
                gradients: [s0, s1],
            } => push(RECTANGLE, [*v0, *v1, *s0, *s1], false),
            Shape::Gaussian {
                value,
                gradient,
                sigma_value,
                sigma_gradient,
            } => {
                let numbers = [*value, *gradient, 1.0 / sigma_value, 1.0 / sigma_gradient];
                push(GAUSSIAN, numbers, false);
            }
            Shape::Image {
                values: [v0, v1],
                gradients: [s0, s1],
                ..
            } => push(IMAGE, [*v0, *v1, *s0, *s1], false),
        }
    }
}

/// How steep the values are where a sample lies.
#[derive(Clone, Copy, Debug)]
pub struct GradientMagnitude<N> {
    /// The gradient magnitude, per world length.
    pub magnitude: N,
    /// The second derivative along the gradient, per square of world length; looked at where a widget asks for it.
    pub second: N,
    /// Of the grid, in world length.
    pub smallest_spacing: N,
}

/// The material (red, green, blue, extinction) of a sample of a value that the function alone gives `material`,
/// where the values are so steep.
pub fn classify_by_gradient<N: Real>(
    packed: &PackedWidgets,
    material: [N; 4],
    value: N,
    steep: GradientMagnitude<N>,
) -> [N; 4] {
    let n = N::from_f64;
    let entry = |i: usize| packed.entries[i].map(N::from_f32);
    let [per_steepest, shares, widgets, _] = packed.entries[0];
    let (shares, widgets) = (shares as usize, widgets as usize);
    let reference_length = n(packed.reference_length);
    let steepness = steep.magnitude * N::from_f32(per_steepest);
    let second = steep.second * steep.smallest_spacing * N::from_f32(per_steepest);
    let [r, g, b, mut sum] = material;
    if shares > 0 {
        let share = share_at(&packed.entries[1..=shares], steepness);
        sum = extinction(
            opacity_over(sum, reference_length) * share,
            reference_length,
        );
    }
    if widgets == 0 {
        return [r, g, b, sum];
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
        let mut share = shape.share(value, steep, steepness);
        let color = if has_color == PAINTED {
            shape.color(value, steepness)
        } else if has_color != 0.0 {
            entry(first + 2)
        } else {
            material
        };
        let second_kind = packed.entries[first + 2][3];
        if second_kind != 0.0 {
            share = share * second_share(second_kind, entry(first + 4), second);
        }
        let own = extinction(N::from_f32(opacity) * share, reference_length);
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

/// What the second derivative leaves.
fn second_share<N: Real>(kind: f32, [a, b, c, d]: [N; 4], second: N) -> N {
    let n = N::from_f64;
    if kind == BELL {
        let x = (second - a) * b;
        return (n(-0.5) * x * x).exp();
    }
    if second < a || second > d {
        n(0.0)
    } else if second < b {
        (second - a) / (b - a)
    } else if second > c {
        (d - second) / (d - c)
    } else {
        n(1.0)
    }
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
    fn share(&self, value: N, steep: GradientMagnitude<N>, steepness: N) -> N {
        let n = N::from_f64;
        let [a, b, c, d] = self.numbers;
        let is_between = |x: N, low: N, high: N| low <= x && x <= high;
        match self.kind {
            CONTOUR => {
                let reach = b * steep.smallest_spacing * steep.magnitude;
                tent((value - a).abs(), reach)
            }
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
                self.bilinear(value, steepness)[0]
            }
            _ => n(0.0),
        }
    }

    /// The colour that the cells of an image have there.
    fn color(&self, value: N, steepness: N) -> [N; 4] {
        let zero = N::from_f64(0.0);
        let [share, r, g, b] = self.bilinear(value, steepness);
        if share > zero {
            [r / share, g / share, b / share, zero]
        } else {
            [zero; 4]
        }
    }

    /// Between the middles of cells of an image.
    fn bilinear(&self, value: N, steepness: N) -> [N; 4] {
        let [a, b, c, d] = self.numbers;
        let x = (value - a) / (b - a);
        let y = (steepness - c) / (d - c);
        let [first, columns, rows, _] = self.image;
        let (x0, x1, part_x) = cells_at(x, columns);
        let (y0, y1, part_y) = cells_at(y, rows);
        let cell = |x: usize, y: usize| self.entries[first + y * columns + x].map(N::from_f32);
        let lerp = |a: [N; 4], b: [N; 4], t: N| -> [N; 4] {
            std::array::from_fn(|k| a[k] + t * (b[k] - a[k]))
        };
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
