//! A figure as the pixels of a PNG: areas by the share of a pixel that they cover, lines by their distance
//! from its centre, words as the lines of [`super::font`].

use super::{Anchor, Color, Figure, Mark, Point, font};
use crate::color::decode_srgb;
#[cfg(feature = "png")]
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

/// Pixels across a unit of a figure.
pub const SCALE: f64 = 1.5;
/// Lines of samples in the height of a pixel.
const SUBLINES: usize = 4;
/// The thickness of letters, in em.
pub(super) const LETTER_WIDTH: f64 = 0.09;

/// The bytes of a PNG file.
#[cfg(feature = "png")]
pub fn png(figure: &Figure) -> Vec<u8> {
    let canvas = Canvas::of(figure, SCALE, [255_u8; 3]);
    let extent = [canvas.width, canvas.height].map(|n| n as u32);
    encode_rgb(extent, canvas.pixels.as_flattened())
}

/// The bytes of a PNG file of these pixels.
#[cfg(feature = "png")]
pub fn encode_rgb([width, height]: [u32; 2], rgb: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(rgb, width, height, ExtendedColorType::Rgb8)
        .expect("pixels for every place, in memory");
    bytes
}

/// The marks of a figure whose units are pixels, without a ground: linear light, premultiplied, rows from the top.
pub fn linear_pixels(figure: &Figure) -> Vec<[f32; 4]> {
    Canvas::of(figure, 1.0, [0.0_f32; 4]).pixels
}

/// A pixel that marks are drawn over.
trait Pixel: Copy {
    /// Covers a share of it with an sRGB colour.
    fn cover(&mut self, srgb: [u8; 3], share: f64);
}

/// An opaque sRGB colour, mixed as it stands.
impl Pixel for [u8; 3] {
    fn cover(&mut self, srgb: [u8; 3], share: f64) {
        for (below, over) in self.iter_mut().zip(srgb) {
            let mixed = f64::from(*below) + share * (f64::from(over) - f64::from(*below));
            *below = mixed.round() as u8;
        }
    }
}

/// Linear light, premultiplied.
impl Pixel for [f32; 4] {
    fn cover(&mut self, [r, g, b]: [u8; 3], share: f64) {
        let [r, g, b] = [r, g, b].map(|code| decode_srgb(f64::from(code) / 255.0));
        for (below, over) in self.iter_mut().zip([r, g, b, 1.0]) {
            *below = (f64::from(*below) * (1.0 - share) + share * over) as f32;
        }
    }
}

struct Canvas<P> {
    width: usize,
    height: usize,
    /// Pixels across a unit of the figure.
    scale: f64,
    pixels: Vec<P>,
}

impl<P: Pixel> Canvas<P> {
    fn of(figure: &Figure, scale: f64, ground: P) -> Self {
        let [width, height] = figure.size.map(|length| (scale * length).ceil() as usize);
        let mut canvas = Self {
            width,
            height,
            scale,
            pixels: vec![ground; width * height],
        };
        for mark in &figure.marks {
            canvas.draw(mark);
        }
        canvas
    }

    fn draw(&mut self, mark: &Mark) {
        match mark {
            Mark::Area { points, fill } => self.area(&self.scaled(points), *fill),
            Mark::Line {
                points,
                color,
                width,
            } => self.lines(&[self.scaled(points)], *color, self.scale * width),
            Mark::Text {
                at,
                text,
                size,
                anchor,
                upward,
                color,
            } => {
                let (lines, width) = font::strokes(text, *size);
                let shift = match anchor {
                    Anchor::Start => 0.0,
                    Anchor::Middle => -0.5 * width,
                    Anchor::End => -width,
                };
                let place = |[x, y]: Point| {
                    let [right, down] = [x + shift, y];
                    match upward {
                        false => [at[0] + right, at[1] + down],
                        true => [at[0] + down, at[1] - right],
                    }
                };
                let lines = lines.into_iter().map(|line| {
                    let line: Vec<Point> = line.into_iter().map(place).collect();
                    self.scaled(&line)
                });
                let lines: Vec<_> = lines.collect();
                self.lines(&lines, *color, self.scale * LETTER_WIDTH * size);
            }
            Mark::Cells {
                at,
                size,
                columns,
                colors,
            } => self.cells(*at, *size, *columns, colors),
        }
    }

    /// Even-odd; exact along x, by sublines along y.
    fn area(&mut self, points: &[Point], fill: Color) {
        let Some([low, high]) = self.span(points, 1, 0.0, self.height) else {
            return;
        };
        for y in low..high {
            let mut cover = vec![0.0; self.width];
            for subline in 0..SUBLINES {
                let height = y as f64 + (subline as f64 + 0.5) / SUBLINES as f64;
                let mut crossings = crossings(points, height);
                crossings.sort_by(f64::total_cmp);
                for pair in crossings.chunks_exact(2) {
                    let [from, to] = [pair[0], pair[1]].map(|x| x.clamp(0.0, self.width as f64));
                    for (x, cover) in cover
                        .iter_mut()
                        .enumerate()
                        .take(to.ceil() as usize)
                        .skip(from as usize)
                    {
                        let inside = to.min(x as f64 + 1.0) - from.max(x as f64);
                        *cover += inside.max(0.0) / SUBLINES as f64;
                    }
                }
            }
            for (x, cover) in cover.into_iter().enumerate() {
                self.blend(x, y, fill, cover);
            }
        }
    }

    /// Where lines of one mark cross, they are not drawn twice.
    fn lines(&mut self, lines: &[Vec<Point>], color: Color, width: f64) {
        // Thinner than a pixel is a fainter pixel.
        let (half, strength) = (0.5 * width.max(1.0), width.min(1.0));
        let all: Vec<Point> = lines.concat();
        let reach = half + 1.0;
        let (Some([left, right]), Some([top, bottom])) = (
            self.span(&all, 0, reach, self.width),
            self.span(&all, 1, reach, self.height),
        ) else {
            return;
        };
        let mut cover = vec![0.0_f64; (right - left) * (bottom - top)];
        for line in lines {
            let ends = line.windows(2).map(|pair| [pair[0], pair[1]]);
            let dot = line.first().filter(|_| line.len() == 1).map(|&p| [p, p]);
            for segment in ends.chain(dot) {
                let (Some([x0, x1]), Some([y0, y1])) = (
                    self.span(&segment, 0, reach, self.width),
                    self.span(&segment, 1, reach, self.height),
                ) else {
                    continue;
                };
                for y in y0..y1 {
                    for x in x0..x1 {
                        let center = [x as f64 + 0.5, y as f64 + 0.5];
                        let inside = (half + 0.5 - distance(center, segment)).clamp(0.0, 1.0);
                        let cover = &mut cover[(y - top) * (right - left) + x - left];
                        *cover = cover.max(inside);
                    }
                }
            }
        }
        for (i, cover) in cover.into_iter().enumerate() {
            let (x, y) = (left + i % (right - left), top + i / (right - left));
            self.blend(x, y, color, cover * strength);
        }
    }

    fn cells(&mut self, at: Point, size: [f64; 2], columns: usize, colors: &[[u8; 3]]) {
        let rows = colors.len().checked_div(columns).unwrap_or(0);
        let corner = at.map(|x| (self.scale * x).round());
        let [width, height] = size.map(|length| (self.scale * length).round());
        if rows == 0 || !(width >= 1.0 && height >= 1.0) {
            return;
        }
        for y in 0..height as usize {
            let row = ((y as f64 + 0.5) / height * rows as f64) as usize;
            for x in 0..width as usize {
                let column = ((x as f64 + 0.5) / width * columns as f64) as usize;
                let [r, g, b] = colors[row.min(rows - 1) * columns + column.min(columns - 1)];
                self.blend(
                    x + corner[0] as usize,
                    y + corner[1] as usize,
                    [r, g, b, 255],
                    1.0,
                );
            }
        }
    }

    /// The pixels along one axis that points and `reach` around them touch; `None` where there are none.
    fn span(&self, points: &[Point], axis: usize, reach: f64, pixels: usize) -> Option<[usize; 2]> {
        let low = points.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min) - reach;
        let high = points
            .iter()
            .map(|p| p[axis])
            .fold(f64::NEG_INFINITY, f64::max)
            + reach;
        let inside = |x: f64| x.clamp(0.0, pixels as f64) as usize;
        let span = [inside(low.floor()), inside(high.ceil())];
        (low.is_finite() && high.is_finite() && span[0] < span[1]).then_some(span)
    }

    fn blend(&mut self, x: usize, y: usize, [r, g, b, a]: Color, cover: f64) {
        if x >= self.width || y >= self.height || cover <= 0.0 {
            return;
        }
        let share = cover.min(1.0) * f64::from(a) / 255.0;
        self.pixels[y * self.width + x].cover([r, g, b], share);
    }

    fn scaled(&self, points: &[Point]) -> Vec<Point> {
        points.iter().map(|p| p.map(|x| self.scale * x)).collect()
    }
}

/// Where the outline of a polygon crosses a height.
fn crossings(points: &[Point], height: f64) -> Vec<f64> {
    let next = points.iter().cycle().skip(1);
    let crossing = |(&[x0, y0], &[x1, y1]): (&Point, &Point)| {
        ((y0 <= height) != (y1 <= height)).then(|| x0 + (height - y0) / (y1 - y0) * (x1 - x0))
    };
    points.iter().zip(next).filter_map(crossing).collect()
}

fn distance([x, y]: Point, [[x0, y0], [x1, y1]]: [Point; 2]) -> f64 {
    let (dx, dy) = (x1 - x0, y1 - y0);
    let square = dx * dx + dy * dy;
    let t = if square > 0.0 {
        (((x - x0) * dx + (y - y0) * dy) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (x0 + t * dx - x).hypot(y0 + t * dy - y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ink(figure: &Figure) -> f64 {
        let canvas = Canvas::of(figure, SCALE, [255_u8; 3]);
        let dark = |pixel: &[u8; 3]| 1.0 - f64::from(pixel[0]) / 255.0;
        canvas.pixels.iter().map(dark).sum::<f64>() / (SCALE * SCALE)
    }

    fn of(mark: Mark) -> Figure {
        Figure {
            marks: vec![mark],
            ..Figure::new([40.0, 40.0], String::new())
        }
    }

    #[test]
    fn an_area_covers_as_much_as_its_formula_says() {
        let black = [0, 0, 0, 255];
        let square = [[3.3, 4.7], [23.3, 4.7], [23.3, 14.7], [3.3, 14.7]].to_vec();
        let found = ink(&of(Mark::Area {
            points: square,
            fill: black,
        }));
        assert!((found - 200.0).abs() < 2.0, "{found}");
        let triangle = [[1.0, 1.0], [31.0, 1.0], [1.0, 21.0]].to_vec();
        let found = ink(&of(Mark::Area {
            points: triangle,
            fill: [0, 0, 0, 51],
        }));
        assert!((found - 60.0).abs() < 1.0, "a fifth of 300, not {found}");
    }

    #[test]
    fn a_line_covers_its_length_times_its_width_and_its_round_ends() {
        let points = [[5.0, 7.0], [29.0, 25.0]].to_vec();
        let line = Mark::Line {
            points,
            color: [0, 0, 0, 255],
            width: 2.0,
        };
        let found = ink(&of(line));
        let wanted = 30.0 * 2.0 + std::f64::consts::PI;
        assert!(
            (found - wanted).abs() < 0.03 * wanted,
            "{found}, not {wanted}"
        );
    }

    #[test]
    fn what_lies_outside_is_left_out_and_words_leave_a_trace() {
        let points = [[-500.0, -500.0], [900.0, -3.0]].to_vec();
        let outside = Mark::Line {
            points,
            color: [0, 0, 0, 255],
            width: 2.0,
        };
        assert_eq!(ink(&of(outside)), 0.0);
        let mut figure = Figure::new([40.0, 40.0], String::new());
        figure.text([20.0, 20.0], "Ag", 12.0, Anchor::Middle);
        assert!(ink(&figure) > 10.0, "{}", ink(&figure));
    }
}
