//! A drawing of areas, lines, words and coloured cells, described once and written twice: as SVG text and as
//! the pixels of a PNG. Lengths are in units of the figure, y down; a PNG has more pixels than the figure units.

mod axis;
mod font;
mod letters;
mod raster;
#[cfg(feature = "png")]
mod svg;

pub use axis::{Ticks, log_ticks, short};
pub use font::{letter_lacking, strokes};
pub use raster::linear_pixels;
#[cfg(feature = "png")]
pub use raster::{SCALE, png};

/// The thickness of letters, in em.
pub const LETTER_WIDTH: f64 = raster::LETTER_WIDTH;
#[cfg(feature = "png")]
pub use svg::svg;

/// A point of a figure: x to the right, y down.
pub type Point = [f64; 2];

/// sRGB and opacity, 0 to 255.
pub type Color = [u8; 4];

/// What is drawn, from back to front, over white.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Width and height.
    pub size: [f64; 2],
    /// What the figure shows, for those who cannot see it.
    pub title: String,
    /// From back to front.
    pub marks: Vec<Mark>,
}

/// One thing that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A filled polygon.
    Area {
        /// Its corners.
        points: Vec<Point>,
        /// Its colour.
        fill: Color,
    },
    /// Straight lines from point to point.
    Line {
        /// At least one.
        points: Vec<Point>,
        /// Its colour.
        color: Color,
        /// How thick it is.
        width: f64,
    },
    /// Words on one line.
    Text {
        /// On the baseline, at the end that `anchor` says.
        at: Point,
        /// The words.
        text: String,
        /// Of an em.
        size: f64,
        /// Which part of the words lies at `at`.
        anchor: Anchor,
        /// Written from below upward instead of from left to right.
        upward: bool,
        /// Their colour.
        color: Color,
    },
    /// Rows of cells of equal size, the top row first.
    Cells {
        /// The upper left corner.
        at: Point,
        /// Width and height of all of them.
        size: [f64; 2],
        /// Cells in a row.
        columns: usize,
        /// Their colours.
        colors: Vec<[u8; 3]>,
    },
}

/// Which part of the words lies at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// The colour of words and axes.
pub const INK: Color = [40, 44, 52, 255];
/// The colour of words that matter less.
pub const FAINT: Color = [110, 116, 128, 255];
/// The colour of lines of a grid.
pub const GRID: Color = [226, 229, 234, 255];

impl Figure {
    /// An empty one.
    pub fn new(size: [f64; 2], title: String) -> Self {
        Self {
            size,
            title,
            marks: Vec::new(),
        }
    }

    /// Adds a straight line.
    pub fn line(&mut self, from: Point, to: Point, color: Color, width: f64) {
        let points = vec![from, to];
        self.marks.push(Mark::Line {
            points,
            color,
            width,
        });
    }

    /// Adds words from left to right.
    pub fn text(&mut self, at: Point, text: impl Into<String>, size: f64, anchor: Anchor) {
        self.words(at, text, size, anchor, INK);
    }

    /// Adds words that matter less.
    pub fn faint(&mut self, at: Point, text: impl Into<String>, size: f64, anchor: Anchor) {
        self.words(at, text, size, anchor, FAINT);
    }

    /// Adds words from below upward.
    pub fn upward(&mut self, at: Point, text: impl Into<String>, size: f64, color: Color) {
        self.marks.push(Mark::Text {
            at,
            text: text.into(),
            size,
            anchor: Anchor::Middle,
            upward: true,
            color,
        });
    }

    /// Adds words of any colour from left to right.
    pub fn words(
        &mut self,
        at: Point,
        text: impl Into<String>,
        size: f64,
        anchor: Anchor,
        color: Color,
    ) {
        self.marks.push(Mark::Text {
            at,
            text: text.into(),
            size,
            anchor,
            upward: false,
            color,
        });
    }

    /// Adds the outline of a box.
    pub fn frame(&mut self, [left, top]: Point, [right, bottom]: Point, color: Color) {
        let points = vec![
            [left, top],
            [right, top],
            [right, bottom],
            [left, bottom],
            [left, top],
        ];
        self.marks.push(Mark::Line {
            points,
            color,
            width: 1.0,
        });
    }
}
