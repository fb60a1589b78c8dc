//! The transfer function under the hand: opacity as a curve over the histogram, colours as a strip below.
//!
//! Heights are cube roots of opacities, for most of what shows a volume well is below a tenth; bars are logarithms of
//! counts.

use egui::{
    Color32, CursorIcon, Mesh, PointerButton, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, pos2,
    vec2,
};
use stratavox::color::ColorSpace;
use stratavox::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use stratavox::volume::Histogram;

const CURVE_HEIGHT: f32 = 168.0;
const STRIP_HEIGHT: f32 = 18.0;
const MARKER_HEIGHT: f32 = 12.0;
/// How near to a point a hand has to be, in points of the screen.
const REACH: f32 = 9.0;
/// More points are no handles, but labels.
const MOST_HANDLES: usize = 64;

/// A point of the function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grip {
    Opacity(usize),
    Color(usize),
}

/// What is kept from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct Curve {
    dragged: Option<Grip>,
    pub chosen: Option<Grip>,
    /// Where the handles were drawn, for scripts.
    pub handles: Vec<(Grip, Pos2)>,
}

/// The values from the left end to the right.
#[derive(Clone, Copy)]
struct Axis {
    values: [f64; 2],
    rect: Rect,
}

impl Axis {
    fn x(&self, value: f64) -> f32 {
        let [low, high] = self.values;
        let t = (value - low) / (high - low);
        self.rect.left() + t as f32 * self.rect.width()
    }

    fn value(&self, x: f32) -> f64 {
        let t = f64::from((x - self.rect.left()) / self.rect.width()).clamp(0.0, 1.0);
        self.values[0] + t * (self.values[1] - self.values[0])
    }

    fn y(&self, opacity: f64) -> f32 {
        self.rect.bottom() - opacity.clamp(0.0, 1.0).cbrt() as f32 * self.rect.height()
    }

    fn opacity(&self, y: f32) -> f64 {
        f64::from((self.rect.bottom() - y) / self.rect.height())
            .clamp(0.0, 1.0)
            .powi(3)
    }
}

impl Curve {
    /// Shows `function` over `histogram`, from the first of `values` to the second, and lets it be changed.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        function: &mut TransferFunction,
        histogram: Option<&Histogram>,
        values: [f64; 2],
    ) {
        let size = vec2(
            ui.available_width(),
            CURVE_HEIGHT + STRIP_HEIGHT + MARKER_HEIGHT,
        );
        let response = ui.allocate_response(size, Sense::click_and_drag());
        let all = response.rect;
        let rect =
            Rect::from_min_size(all.min, vec2(all.width(), CURVE_HEIGHT)).shrink2(vec2(6.0, 0.0));
        let rect = rect.with_min_y(rect.top() + 6.0);
        let axis = Axis { values, rect };
        let strip = Rect::from_min_size(
            pos2(rect.left(), rect.bottom() + 2.0),
            vec2(rect.width(), STRIP_HEIGHT),
        );
        self.handles = handles(function, axis, strip);
        self.obey(ui, &response, function, axis);
        self.handles = handles(function, axis, strip);
        self.paint(ui, function, histogram, axis, strip, all);
    }

    fn nearest(&self, pointer: Pos2) -> Option<Grip> {
        let far = |(_, at): &&(Grip, Pos2)| (*at - pointer).length();
        let nearest = self.handles.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
        nearest
            .filter(|handle| far(handle) <= REACH)
            .map(|(grip, _)| *grip)
    }

    fn obey(&mut self, ui: &Ui, response: &Response, function: &mut TransferFunction, axis: Axis) {
        let Some(pointer) = response.interact_pointer_pos() else {
            self.dragged = None;
            if response
                .hover_pos()
                .is_some_and(|at| self.nearest(at).is_some())
            {
                ui.set_cursor_icon(CursorIcon::Grab);
            }
            return;
        };
        let pressed_at = ui.input(|input| input.pointer.press_origin());
        if response.drag_started_by(PointerButton::Primary) {
            self.dragged = pressed_at.and_then(|at| self.nearest(at));
            self.chosen = self.dragged.or(self.chosen);
        }
        let is_in_strip = pointer.y > axis.rect.bottom();
        if response.double_clicked() && self.nearest(pointer).is_none() {
            self.chosen = Some(add(function, axis, pointer, is_in_strip));
        } else if response.clicked() {
            self.chosen = self.nearest(pointer);
        }
        if response.secondary_clicked()
            && let Some(grip) = self.nearest(pointer)
        {
            remove(function, grip);
            self.chosen = None;
        }
        if let Some(grip) = self.dragged
            && response.dragged()
        {
            let value = axis.value(pointer.x);
            match grip {
                Grip::Opacity(i) => {
                    set_opacity(function, i, value, axis.opacity(pointer.y));
                }
                Grip::Color(i) => set_color_value(function, i, value),
            }
            ui.set_cursor_icon(CursorIcon::Grabbing);
        }
    }

    fn paint(
        &self,
        ui: &Ui,
        function: &TransferFunction,
        histogram: Option<&Histogram>,
        axis: Axis,
        strip: Rect,
        all: Rect,
    ) {
        let painter = ui.painter_at(all);
        let rect = axis.rect;
        painter.rect_filled(rect, 3.0, Color32::from_gray(14));
        let columns = rect.width().max(1.0) as usize;
        let heights = histogram.map(|histogram| bars(histogram, axis.values, columns));
        for (column, height) in heights.iter().flatten().enumerate() {
            let x = rect.left() + column as f32 + 0.5;
            let top = rect.bottom() - 0.92 * height * rect.height();
            painter.vline(
                x,
                top..=rect.bottom(),
                Stroke::new(1.0, Color32::from_gray(58)),
            );
        }
        // Lines where opacity is a thousandth, a hundredth, a tenth.
        for opacity in [0.001, 0.01, 0.1] {
            let stroke = Stroke::new(1.0, Color32::from_white_alpha(14));
            painter.hline(rect.x_range(), axis.y(opacity), stroke);
        }
        let mut under = Mesh::default();
        for column in 0..=columns {
            let x = rect.left() + column as f32;
            let value = axis.value(x);
            let [r, g, b] = shown(function.color(value, ColorSpace::Display));
            let y = axis.y(function.opacity(value));
            under.colored_vertex(pos2(x, y), Color32::from_rgba_unmultiplied(r, g, b, 150));
            under.colored_vertex(
                pos2(x, rect.bottom()),
                Color32::from_rgba_unmultiplied(r, g, b, 60),
            );
            if column > 0 {
                let k = 2 * column as u32;
                under.add_triangle(k - 2, k - 1, k);
                under.add_triangle(k - 1, k, k + 1);
            }
        }
        painter.add(Shape::mesh(under));
        painter.add(Shape::line(
            outline(function, axis),
            Stroke::new(1.5, Color32::from_gray(225)),
        ));
        let mut colors = Mesh::default();
        for column in 0..=columns {
            let x = strip.left() + column as f32;
            let [r, g, b] = shown(function.color(axis.value(x), ColorSpace::Display));
            colors.colored_vertex(pos2(x, strip.top()), Color32::from_rgb(r, g, b));
            colors.colored_vertex(pos2(x, strip.bottom()), Color32::from_rgb(r, g, b));
            if column > 0 {
                let k = 2 * column as u32;
                colors.add_triangle(k - 2, k - 1, k);
                colors.add_triangle(k - 1, k, k + 1);
            }
        }
        painter.add(Shape::mesh(colors));
        for &(grip, at) in &self.handles {
            let is_chosen = self.chosen == Some(grip);
            let stroke = Stroke::new(1.5, Color32::from_gray(if is_chosen { 255 } else { 210 }));
            match grip {
                Grip::Opacity(i) => {
                    let value = function.opacity[i].value;
                    let [r, g, b] = shown(function.color(value, ColorSpace::Display));
                    let radius = if is_chosen { 5.5 } else { 4.0 };
                    painter.circle(at, radius, Color32::from_rgb(r, g, b), stroke);
                }
                Grip::Color(i) => {
                    let [r, g, b] = shown(function.color[i].srgb);
                    let half = if is_chosen { 5.5 } else { 4.5 };
                    let corners = vec![
                        at + vec2(0.0, -half),
                        at + vec2(half, half),
                        at + vec2(-half, half),
                    ];
                    painter.add(Shape::convex_polygon(
                        corners,
                        Color32::from_rgb(r, g, b),
                        stroke,
                    ));
                }
            }
        }
    }
}

fn shown(srgb: [f64; 3]) -> [u8; 3] {
    srgb.map(|c| (255.0 * c).round().clamp(0.0, 255.0) as u8)
}

fn handles(function: &TransferFunction, axis: Axis, strip: Rect) -> Vec<(Grip, Pos2)> {
    let mut handles = Vec::new();
    let is_inside = |value: f64| (axis.values[0]..=axis.values[1]).contains(&value);
    if function.opacity.len() <= MOST_HANDLES {
        for (i, point) in function.opacity.iter().enumerate() {
            if is_inside(point.value) {
                let at = pos2(axis.x(point.value), axis.y(point.opacity));
                handles.push((Grip::Opacity(i), at));
            }
        }
    }
    if function.color.len() <= MOST_HANDLES {
        for (i, point) in function.color.iter().enumerate() {
            if is_inside(point.value) {
                let at = pos2(axis.x(point.value), strip.bottom() + 0.4 * MARKER_HEIGHT);
                handles.push((Grip::Color(i), at));
            }
        }
    }
    handles
}

/// Heights of bars, 0 to 1, a pixel each.
fn bars(histogram: &Histogram, values: [f64; 2], columns: usize) -> Vec<f32> {
    let counts = &histogram.counts;
    let [low, high] = histogram.value_range;
    if counts.is_empty() || high <= low {
        return vec![0.0; columns];
    }
    let log = |count: u64| (1.0 + count as f64).ln();
    let most = counts
        .iter()
        .max()
        .map_or(1.0, |&count| log(count))
        .max(1.0);
    let bin = |value: f64| (value - low) / (high - low) * counts.len() as f64;
    let edge =
        |column: usize| bin(values[0] + (values[1] - values[0]) * column as f64 / columns as f64);
    let bar = |column: usize| {
        let [first, last] = [edge(column), edge(column + 1)].map(|bin| bin.floor());
        if last < 0.0 || first >= counts.len() as f64 {
            return 0.0;
        }
        let last = (last as usize).min(counts.len() - 1);
        let range = first.max(0.0) as usize..=last;
        let count = counts[range].iter().max().copied().unwrap_or(0);
        (log(count) / most) as f32
    };
    (0..columns).map(bar).collect()
}

/// The curve of opacity, with its points and its steps.
fn outline(function: &TransferFunction, axis: Axis) -> Vec<Pos2> {
    let columns = axis.rect.width().max(1.0) as usize;
    let xs = (0..=columns).map(|column| axis.rect.left() + column as f32);
    let points = function.opacity.iter().map(|point| axis.x(point.value));
    let inside = points.filter(|x| axis.rect.x_range().contains(*x));
    let mut xs: Vec<f32> = xs.chain(inside).collect();
    xs.sort_by(f32::total_cmp);
    xs.into_iter()
        .map(|x| pos2(x, axis.y(function.opacity(axis.value(x)))))
        .collect()
}

fn add(function: &mut TransferFunction, axis: Axis, pointer: Pos2, is_color: bool) -> Grip {
    let value = axis.value(pointer.x);
    if is_color {
        let srgb = function.color(value, ColorSpace::Display);
        let at = function.color.partition_point(|point| point.value <= value);
        function.color.insert(at, ColorPoint { value, srgb });
        Grip::Color(at)
    } else {
        let opacity = axis.opacity(pointer.y);
        let at = function
            .opacity
            .partition_point(|point| point.value <= value);
        function.opacity.insert(at, OpacityPoint { value, opacity });
        Grip::Opacity(at)
    }
}

fn remove(function: &mut TransferFunction, grip: Grip) {
    match grip {
        Grip::Opacity(i) if function.opacity.len() > 1 => {
            function.opacity.remove(i);
        }
        Grip::Color(i) if function.color.len() > 1 => {
            function.color.remove(i);
        }
        _ => {}
    }
}

/// A point stays between its neighbours.
pub fn set_opacity(function: &mut TransferFunction, i: usize, value: f64, opacity: f64) {
    let points = &mut function.opacity;
    let low = if i > 0 {
        points[i - 1].value
    } else {
        f64::NEG_INFINITY
    };
    let high = points.get(i + 1).map_or(f64::INFINITY, |next| next.value);
    points[i] = OpacityPoint {
        value: value.max(low).min(high),
        opacity: opacity.clamp(0.0, 1.0),
    };
}

/// As [`set_opacity`].
pub fn set_color_value(function: &mut TransferFunction, i: usize, value: f64) {
    let points = &mut function.color;
    let low = if i > 0 {
        points[i - 1].value
    } else {
        f64::NEG_INFINITY
    };
    let high = points.get(i + 1).map_or(f64::INFINITY, |next| next.value);
    points[i].value = value.max(low).min(high);
}
