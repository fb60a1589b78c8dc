//! Degrees at the ends of meridians and parallels.
//!
//! ```text
//! 20°N      at the end of a line that is nearer to the eye, or where the line leaves the picture there
//! ```
//!
//! All meridians have their degrees on one side of the map, and so have all parallels; where both sides are as near, on the lower
//! or the left one. What would lie over other marks is left out.

use super::{projector::Projector, sheet::Sheet};
use crate::figure::{Anchor, Mark, Point, strokes};
use glam::DVec3;

/// A meridian or a parallel, as far as it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct DegreeLine {
    /// Of longitude, positive to the east, or of latitude, positive to the north.
    pub degrees: f64,
    /// True of a line of one longitude.
    pub is_meridian: bool,
    /// Along it from the south to the north or from the west to the east, in the world as it is drawn.
    pub places: Vec<DVec3>,
}

/// How much a pixel to the left counts, where one further down counts 1.
const LEFT: f64 = 0.25;
/// Sides are as near where their distances differ by less than this part.
const AS_NEAR: f64 = 0.02;
/// Ends lie on one side of the map that are as far out up to this part of it.
const ON_SIDE: f64 = 1e-6;
/// Height of words.
const EMS: f64 = 0.9;
/// From the end of a line to the middle of its words, in em.
const AWAY: f64 = 1.1;

impl DegreeLine {
    /// How it is written.
    fn words(&self) -> String {
        let [positive, negative] = match self.is_meridian {
            true => ["E", "W"],
            false => ["N", "S"],
        };
        // Hundredths are enough for what is a tenth of a degree apart.
        let degrees = (100.0 * self.degrees.abs()).round() / 100.0;
        let is_bare = degrees == 0.0 || self.is_meridian && degrees == 180.0;
        let side = match (is_bare, self.degrees > 0.0) {
            (true, _) => "",
            (_, true) => positive,
            (_, false) => negative,
        };
        format!("{degrees}°{side}")
    }

    fn end(&self, end: usize) -> Option<DVec3> {
        let ends = [self.places.first(), self.places.last()];
        ends[end].copied()
    }

    /// Where it is seen, from one end (0) or the other (1); nothing where a part of it lies behind the eye.
    fn seen(&self, projector: &Projector, end: usize) -> Option<Vec<Point>> {
        let mut points = Vec::with_capacity(self.places.len());
        for &place in &self.places {
            if projector.is_perspective() && projector.depth(place) <= 0.0 {
                return None;
            }
            points.push(projector.point(place));
        }
        if end == 1 {
            points.reverse();
        }
        (points.len() > 1).then_some(points)
    }
}

/// Writes the degrees of all lines.
pub(super) fn draw(sheet: &mut Sheet, projector: &Projector, lines: &[DegreeLine]) {
    for is_meridian in [true, false] {
        let family = lines.iter().filter(|line| line.is_meridian == is_meridian);
        let family: Vec<&DegreeLine> = family.collect();
        let end = nearer_end(projector, &family);
        let family = on_one_side(family, end);
        for line in family {
            if let Some(points) = line.seen(projector, end) {
                write(sheet, &points, &line.words());
            }
        }
    }
}

/// The end of all lines that is to have their degrees.
fn nearer_end(projector: &Projector, family: &[&DegreeLine]) -> usize {
    let mean = |end: usize, of: &dyn Fn(DVec3) -> f64| {
        let ends = family
            .iter()
            .filter(|line| line.seen(projector, end).is_some());
        let numbers: Vec<f64> = ends.filter_map(|line| line.end(end)).map(of).collect();
        numbers.iter().sum::<f64>() / numbers.len().max(1) as f64
    };
    let depths = [0, 1].map(|end| mean(end, &|place| projector.depth(place)));
    if (depths[0] - depths[1]).abs() > AS_NEAR * depths[0].abs().max(depths[1].abs()) {
        return usize::from(depths[1] < depths[0]);
    }
    let low_and_left = |place| {
        let [x, y] = projector.point(place);
        y - LEFT * x
    };
    let scores = [0, 1].map(|end| mean(end, &low_and_left));
    usize::from(scores[1] > scores[0])
}

/// The lines that end on the side of the map where most of them can: meridians that reach its south or its north, and
/// parallels that reach its west or its east.
fn on_one_side(family: Vec<&DegreeLine>, end: usize) -> Vec<&DegreeLine> {
    let across = |place: DVec3, is_meridian: bool| if is_meridian { place.y } else { place.x };
    let out = |line: &DegreeLine, end: usize| {
        let place = line.end(end)?;
        Some(across(place, line.is_meridian))
    };
    let both = family.iter().flat_map(|line| [out(line, 0), out(line, 1)]);
    let [low, high] = both
        .flatten()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
            [low.min(at), high.max(at)]
        });
    // Lines go from the south to the north, and from the west to the east.
    let side = if end == 0 { low } else { high };
    let is_on = |line: &&DegreeLine| {
        out(line, end).is_some_and(|at| (at - side).abs() <= ON_SIDE * (high - low))
    };
    family.into_iter().filter(is_on).collect()
}

fn write(sheet: &mut Sheet, points: &[Point], words: &str) {
    let ([width, height], em) = (sheet.size(), sheet.em);
    let half = [0.5 * sheet.width(words, EMS), 0.5 * em];
    let ends = [half[0] + 0.3 * em, half[1] + 0.3 * em];
    let is_inside = |p: &Point| (0.0..=width).contains(&p[0]) && (0.0..=height).contains(&p[1]);
    let Some(at) = points.iter().position(is_inside) else {
        return;
    };
    // Away from what of the line is seen.
    let from = points[(at + 1).min(points.len() - 1)];
    let to = if at + 1 < points.len() {
        points[at]
    } else {
        points[at - 1]
    };
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    if length == 0.0 {
        return;
    }
    let middle = |k: usize, most: f64| {
        let away = AWAY.max(0.6 + half[k] / em * ((to[k] - from[k]) / length).abs());
        let wanted = points[at][k] + away * em * (to[k] - from[k]) / length;
        wanted.clamp(ends[k], (most - ends[k]).max(ends[k]))
    };
    let center = [middle(0, width), middle(1, height)];
    let low = [0, 1].map(|k| center[k] - half[k] - 0.25 * em);
    let high = [0, 1].map(|k| center[k] + half[k] + 0.25 * em);
    let marks = &sheet.figure.marks;
    if marks.iter().any(|mark| meets(mark, low, high)) {
        return;
    }
    let at = [center[0], center[1] + 0.32 * em];
    sheet.text_on_ground(at, words, EMS, Anchor::Middle);
}

/// Whether a mark lies in a rectangle.
pub(super) fn meets(mark: &Mark, low: Point, high: Point) -> bool {
    let is_over = |from: Point, to: Point| {
        (0..2).all(|k| from[k].min(to[k]) <= high[k] && from[k].max(to[k]) >= low[k])
    };
    match mark {
        Mark::Area { points, .. } | Mark::Line { points, .. } => match points.as_slice() {
            [one] => is_over(*one, *one),
            points => points
                .windows(2)
                .any(|pair| crosses(pair[0], pair[1], low, high)),
        },
        Mark::Text {
            at,
            text,
            size,
            anchor,
            ..
        } => {
            let width = strokes(text, *size).1;
            let left = match anchor {
                Anchor::Start => at[0],
                Anchor::Middle => at[0] - 0.5 * width,
                Anchor::End => at[0] - width,
            };
            is_over([left, at[1] - size], [left + width, at[1] + 0.25 * size])
        }
        // Its numbers stand on the right.
        Mark::Cells { at, size, .. } => is_over(*at, [f64::INFINITY, at[1] + size[1]]),
    }
}

/// Whether a straight piece goes through a rectangle (Liang and Barsky 1984).
fn crosses(a: Point, b: Point, low: Point, high: Point) -> bool {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for k in [0, 1] {
        let way = b[k] - a[k];
        for (distance, slope) in [(a[k] - low[k], -way), (high[k] - a[k], way)] {
            if slope == 0.0 && distance < 0.0 {
                return false;
            }
            if slope < 0.0 {
                from = from.max(distance / slope);
            } else if slope > 0.0 {
                to = to.min(distance / slope);
            }
        }
    }
    from <= to
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Projection};
    use crate::picture::{ColorSpace, Picture};
    use glam::dvec3;

    fn line(degrees: f64, is_meridian: bool, places: [DVec3; 2]) -> DegreeLine {
        DegreeLine {
            degrees,
            is_meridian,
            places: places.to_vec(),
        }
    }

    #[test]
    fn degrees_have_their_side_of_the_globe() {
        let words = |degrees, is_meridian| line(degrees, is_meridian, [DVec3::ZERO; 2]).words();
        assert_eq!(words(20.0, false), "20°N");
        assert_eq!(words(-35.5, false), "35.5°S");
        assert_eq!(words(-90.0, true), "90°W");
        assert_eq!(words(0.1 * 3.0, true), "0.3°E");
        assert_eq!(words(0.0, true), "0°");
        assert_eq!(words(-0.0, false), "0°");
        assert_eq!(words(-180.0, true), "180°");
    }

    /// From above, a pixel a unit, the middle of the picture in the origin.
    fn texts(size: u32, lines: &[DegreeLine]) -> Vec<(String, Point)> {
        let camera = Camera {
            eye: dvec3(0.0, 0.0, 9.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Orthographic {
                view_height: f64::from(size),
            },
            zoom: 1.0,
        };
        let picture = Picture {
            width: size,
            height: size,
            pixels: vec![[0.0; 4]; (size * size) as usize],
            color_space: ColorSpace::Linear,
            layers: Vec::new(),
        };
        let mut sheet = Sheet::new(&picture, 12.0, None);
        let projector = Projector::new(&camera, sheet.size());
        draw(&mut sheet, &projector, lines);
        let marks = sheet.figure.marks.iter();
        let text = |mark: &Mark| match mark {
            Mark::Text { at, text, .. } => Some((text.clone(), *at)),
            _ => None,
        };
        marks.filter_map(text).collect()
    }

    #[test]
    fn meridians_have_them_below_and_parallels_on_the_left() {
        let [w, e] = [-60.0, 60.0];
        let found = texts(
            240,
            &[
                line(-90.0, true, [dvec3(w, -80.0, 0.0), dvec3(w, 80.0, 0.0)]),
                line(-80.0, true, [dvec3(e, -80.0, 0.0), dvec3(e, 80.0, 0.0)]),
                line(25.0, false, [dvec3(-80.0, 0.0, 0.0), dvec3(80.0, 0.0, 0.0)]),
            ],
        );
        let words: Vec<&str> = found.iter().map(|(text, _)| text.as_str()).collect();
        assert_eq!(words, ["90°W", "80°W", "25°N"]);
        let places: Vec<Point> = found.iter().map(|(_, at)| *at).collect();
        // Below the ends at 80 south, left of the end at 80 west.
        assert!((places[0][0] - 60.0).abs() < 1e-9 && places[0][1] > 200.0);
        assert!((places[1][0] - 180.0).abs() < 1e-9 && places[1][1] > 200.0);
        assert!(places[2][0] < 40.0 && (places[2][1] - 120.0).abs() < 6.0);
    }

    #[test]
    fn a_line_that_ends_on_another_side_of_the_map_has_none_and_the_nearer_side_has_them() {
        let meridian = |degrees: f64, south: f64| {
            let x = 4.0 * degrees;
            line(degrees, true, [dvec3(x, south, 0.0), dvec3(x, 80.0, 0.0)])
        };
        // The one in the west begins at the western side.
        let lines = [
            meridian(-20.0, -30.0),
            meridian(-10.0, -80.0),
            meridian(10.0, -80.0),
        ];
        let found = texts(240, &lines);
        let words: Vec<&str> = found.iter().map(|(text, _)| text.as_str()).collect();
        assert_eq!(words, ["10°W", "10°E"]);
        // From the north the northern ends are nearer, where all of them end.
        for (y, wanted) in [(-400.0, 0), (400.0, 1)] {
            let camera = Camera {
                eye: dvec3(0.0, y, 200.0),
                target: DVec3::ZERO,
                up: DVec3::Z,
                projection: Projection::Perspective { fov_degrees: 30.0 },
                zoom: 1.0,
            };
            let projector = Projector::new(&camera, [240.0; 2]);
            let all: Vec<&DegreeLine> = lines.iter().collect();
            let end = nearer_end(&projector, &all);
            assert_eq!(end, wanted);
            assert_eq!(on_one_side(all, end).len(), 2 + wanted);
        }
    }

    #[test]
    fn a_line_that_leaves_the_picture_has_them_at_its_border_and_none_lies_over_another() {
        let along = |y: f64| {
            let place = |i: i32| dvec3(10.0 * f64::from(i) - 500.0, y, 0.0);
            DegreeLine {
                degrees: y,
                is_meridian: false,
                places: (0..=100).map(place).collect(),
            }
        };
        let found = texts(240, &[along(0.0), along(5.0), along(30.0)]);
        let words: Vec<&str> = found.iter().map(|(text, _)| text.as_str()).collect();
        assert_eq!(words, ["0°", "30°N"]);
        assert!(
            found.iter().all(|(_, [x, _])| (8.0..40.0).contains(x)),
            "{found:?}"
        );
        // Outside of the picture altogether.
        assert!(texts(240, &[along(150.0)]).is_empty());
    }
    #[test]
    fn none_lies_over_a_bar_or_between_its_numbers() {
        let bar = Mark::Cells {
            at: [100.0, 20.0],
            size: [10.0, 80.0],
            columns: 1,
            colors: vec![[0; 3]; 2],
        };
        let at = |x: f64, y: f64| meets(&bar, [x, y], [x + 20.0, y + 10.0]);
        assert!(at(95.0, 50.0) && at(130.0, 50.0));
        assert!(!at(70.0, 50.0) && !at(130.0, 105.0) && !at(130.0, 5.0));
    }
}
