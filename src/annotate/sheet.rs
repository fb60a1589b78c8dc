//! The ground that marks are drawn on: which ink is read there, and words and lines with a halo.

use crate::{
    color::decode_srgb,
    figure::{Anchor, Color, Figure, LETTER_WIDTH, Mark, Point, strokes},
    picture::{ColorSpace, Picture},
};

/// Pixels of the halo on each side of a line.
const HALO_PIXELS: f64 = 2.0;
/// Opacity of the halo, of 255.
const HALO_OPACITY: u8 = 210;
const DARK: [u8; 3] = [0; 3];
const LIGHT: [u8; 3] = [255; 3];
/// Luminance at which black and white have the same contrast, 4.58: (1 + 0.05) / (L + 0.05) = (L + 0.05) / 0.05.
const EVEN_LUMINANCE: f64 = 0.179_128_78;

/// The colour of a mark, and that of its halo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ink {
    /// Of lines and words.
    pub color: Color,
    halo: Color,
}

impl Ink {
    fn new(color: [u8; 3], halo: [u8; 3]) -> Self {
        let opaque = |[r, g, b]: [u8; 3], a| [r, g, b, a];
        Self {
            color: opaque(color, 255),
            halo: opaque(halo, HALO_OPACITY),
        }
    }
}

/// Marks over a picture, in its pixels.
pub struct Sheet<'a> {
    /// The marks.
    pub figure: Figure,
    /// Pixels of an em.
    pub em: f64,
    picture: &'a Picture,
    color: Option<[f64; 3]>,
}

impl<'a> Sheet<'a> {
    /// An empty one over `picture`, which has its background; `color` instead of black and white.
    pub fn new(picture: &'a Picture, em: f64, color: Option<[f64; 3]>) -> Self {
        let size = [picture.width, picture.height].map(f64::from);
        Self {
            figure: Figure::new(size, "annotation".to_owned()),
            em,
            picture,
            color,
        }
    }

    /// Pixels across and down.
    pub fn size(&self) -> [f64; 2] {
        self.figure.size
    }

    /// The ink that is read on what lies in a rectangle.
    pub fn ink(&self, min: Point, max: Point) -> Ink {
        if let Some(srgb) = self.color {
            let light = luminance(srgb.map(decode_srgb));
            let halo = if light > EVEN_LUMINANCE { DARK } else { LIGHT };
            return Ink::new(srgb.map(|c| (255.0 * c).round() as u8), halo);
        }
        if self.mean_luminance(min, max) > EVEN_LUMINANCE {
            Ink::new(DARK, LIGHT)
        } else {
            Ink::new(LIGHT, DARK)
        }
    }

    /// Of the picture over black.
    fn mean_luminance(&self, min: Point, max: Point) -> f64 {
        let [width, height] = self.size();
        let ends = |k: usize, most: f64| {
            let from = min[k].clamp(0.0, most - 1.0) as usize;
            let to = max[k].clamp(0.0, most) as usize;
            from..to.max(from + 1)
        };
        let (mut sum, mut count) = (0.0, 0.0);
        for y in ends(1, height) {
            for x in ends(0, width) {
                let [r, g, b, _] = self.picture.pixels[y * width as usize + x].map(f64::from);
                let color = match self.picture.color_space {
                    ColorSpace::Linear => [r, g, b],
                    ColorSpace::Display => [r, g, b].map(decode_srgb),
                };
                sum += luminance(color.map(|c| c.clamp(0.0, 1.0)));
                count += 1.0;
            }
        }
        sum / count
    }

    /// How wide words of so many ems are.
    pub fn width(&self, text: &str, ems: f64) -> f64 {
        strokes(text, ems * self.em).1
    }

    /// Words on the baseline `at`.
    pub fn text(&mut self, at: Point, text: &str, ems: f64, anchor: Anchor, ink: Ink) {
        let size = ems * self.em;
        let (lines, width) = strokes(text, size);
        let shift = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * width,
            Anchor::End => -width,
        };
        for line in lines {
            let points = line
                .into_iter()
                .map(|[x, y]| [at[0] + shift + x, at[1] + y]);
            self.figure.marks.push(Mark::Line {
                points: points.collect(),
                color: ink.halo,
                width: LETTER_WIDTH * size + 2.0 * HALO_PIXELS,
            });
        }
        self.figure.words(at, text, size, anchor, ink.color);
    }

    /// Words that are read on what lies under them.
    pub fn text_on_ground(&mut self, at: Point, text: &str, ems: f64, anchor: Anchor) {
        let (width, em) = (self.width(text, ems), ems * self.em);
        let left = match anchor {
            Anchor::Start => at[0],
            Anchor::Middle => at[0] - 0.5 * width,
            Anchor::End => at[0] - width,
        };
        let ink = self.ink([left, at[1] - em], [left + width, at[1] + 0.25 * em]);
        self.text(at, text, ems, anchor, ink);
    }

    /// A line from point to point, so many pixels thick.
    pub fn line(&mut self, points: Vec<Point>, width: f64, ink: Ink) {
        for (color, width) in [(ink.halo, width + 2.0 * HALO_PIXELS), (ink.color, width)] {
            self.figure.marks.push(Mark::Line {
                points: points.clone(),
                color,
                width,
            });
        }
    }

    /// How thick lines are.
    pub fn thin(&self) -> f64 {
        (LETTER_WIDTH * self.em).max(1.0)
    }

    /// As much of a text as a width has room for.
    pub fn shortened(&self, text: &str, ems: f64, width: f64) -> String {
        if self.width(text, ems) <= width {
            return text.to_owned();
        }
        let mut kept: String = text.to_owned();
        while !kept.is_empty() && self.width(&format!("{kept}…"), ems) > width {
            kept.pop();
        }
        format!("{}…", kept.trim_end())
    }

    /// Words in lines of a width, no more than `most` of them.
    pub fn wrapped(&self, text: &str, ems: f64, width: f64, most: usize) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        for word in text.split(' ').filter(|word| !word.is_empty()) {
            let longer = lines.last().map(|line| format!("{line} {word}"));
            match longer {
                Some(line) if self.width(&line, ems) <= width || lines.len() == most => {
                    *lines.last_mut().expect("there is one") = line;
                }
                _ => lines.push(word.to_owned()),
            }
        }
        let shortened = |line: &String| self.shortened(line, ems, width);
        lines.iter().map(shortened).collect()
    }
}

/// Of linear light (IEC 61966-2-1).
fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::linear_pixels;

    #[test]
    fn words_have_a_contrast_of_4_and_a_half_on_every_ground() {
        let greys = [0.0, 0.2, 0.5, 1.0].map(|grey| [grey as f32; 3]);
        for ground in greys.into_iter().chain([[1.0, 0.0, 0.0]]) {
            let [r, g, b] = ground;
            let mut picture = Picture {
                width: 120,
                height: 40,
                pixels: vec![[r, g, b, 1.0]; 4800],
                color_space: ColorSpace::Linear,
                layers: Vec::new(),
            };
            let mut sheet = Sheet::new(&picture, 16.0, None);
            sheet.text_on_ground([10.0, 28.0], "HU −1000", 1.0, Anchor::Start);
            let over = linear_pixels(&sheet.figure);
            picture.lay_over(&over);
            let light = |pixel: &[f32; 4]| luminance([0, 1, 2].map(|k| f64::from(pixel[k])));
            let under = luminance(ground.map(f64::from));
            let contrast = |a: f64| (a.max(under) + 0.05) / (a.min(under) + 0.05);
            let best = picture.pixels.iter().map(|p| contrast(light(p)));
            let best = best.fold(0.0, f64::max);
            assert!(best >= 4.5, "{ground:?}: {best}");
        }
    }

    #[test]
    fn long_words_are_broken_and_cut() {
        let picture = Picture {
            width: 4,
            height: 4,
            pixels: vec![[0.0; 4]; 16],
            color_space: ColorSpace::Linear,
            layers: Vec::new(),
        };
        let sheet = Sheet::new(&picture, 10.0, None);
        let lines = sheet.wrapped("Water vapor mixing ratio", 1.0, 80.0, 2);
        assert_eq!(lines.len(), 2);
        assert!(
            lines.iter().all(|line| sheet.width(line, 1.0) <= 80.0),
            "{lines:?}"
        );
        assert!(sheet.shortened("Wasserdampf", 1.0, 40.0).ends_with('…'));
    }
}
