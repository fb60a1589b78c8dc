//! The colour bar: the colours of values as they reach the screen.
//!
//! Opacity is that of an eighth of the box's diagonal full of the value, `1 - (1 - a)^(D / 8 d0)` for an opacity `a`
//! per length `d0`; in modes that classify one value a ray it is `a`. Below it lies a check of two greys.

use super::{Error, sheet::Sheet, units};
use crate::{
    color::{decode_srgb, encode_srgb},
    figure::{Anchor, Mark},
    transfer::TransferFunction,
};

/// What a bar shows.
pub struct Bar<'a> {
    /// Colours and opacities of values.
    pub function: &'a TransferFunction,
    /// How many of the function's reference lengths light goes through; `None`: opaque.
    pub depth: Option<f64>,
    /// What the values are.
    pub caption: &'a str,
    /// As the file has it.
    pub unit: Option<&'a str>,
    /// Values are spread by their logarithms.
    pub is_log: bool,
    /// Values of surfaces.
    pub levels: Vec<f64>,
    /// Which of so many bars, one below the other.
    pub slot: [usize; 2],
}

/// Of the bar's height in that of the picture.
const HEIGHT: f64 = 0.45;
/// The same of several, of the part of the picture that each has.
const HEIGHT_OF_SEVERAL: f64 = 0.58;
/// Greys of the check, sRGB.
const CHECK: [f64; 2] = [0.45, 0.65];

impl Bar<'_> {
    /// The values at the two ends; `None` where the function has no colours, or one value alone.
    pub fn range(&self) -> Option<[f64; 2]> {
        let color = self.function.color.iter().map(|point| point.value);
        let opacity = self.function.opacity.iter().map(|point| point.value);
        let range = color
            .chain(opacity)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| {
                [a.min(v), b.max(v)]
            });
        (!self.function.color.is_empty() && range[0] < range[1]).then_some(range)
    }

    /// Draws it at the right side, and gives the pixel where it begins.
    pub fn draw(&self, sheet: &mut Sheet) -> Result<Option<f64>, Error> {
        let Some([low, high]) = self.range() else {
            return Ok(None);
        };
        if self.is_log && low <= 0.0 {
            return Err(Error::NoLogarithm(low));
        }
        let [width, height] = sheet.size();
        let em = sheet.em;
        let (unit, factor) = units::scaled(self.unit, low.abs().max(high.abs()));
        let [nth, count] = self.slot.map(|n| n as f64);
        let share = if count > 1.0 {
            HEIGHT_OF_SEVERAL
        } else {
            HEIGHT
        };
        let tall = (share * height / count).round();
        // Words stand below the last of several.
        let below = if count > 1.0 { 3.0 * em } else { 0.0 };
        let middle = (nth + 0.5) / count * (height - below);
        let most = (tall / (1.7 * em)) as usize;
        let (ticks, exponent) = match self.is_log {
            true => (units::log_ticks([low * factor, high * factor], most), 0),
            false => {
                let ticks = units::ticks([low * factor, high * factor], most);
                (ticks.at, ticks.exponent)
            }
        };
        let ticks: Vec<(f64, String)> = ticks
            .into_iter()
            .map(|(value, text)| (value / factor, units::signed(&text)))
            .collect();
        let widths = ticks.iter().map(|(_, text)| sheet.width(text, 1.0));
        let numbers = widths.fold(0.0, f64::max);
        let right = width - em;
        let across = em.round().max(6.0);
        let left = (right - numbers - 0.75 * em - across).round();
        let caption = self.caption_lines(sheet, unit, exponent);
        let line = 1.3 * em;
        let top = (middle - 0.5 * tall + 0.5 * line * caption.len() as f64).round();
        let ink = sheet.ink([left, top - line], [right, top + tall]);
        for (at, text) in caption.iter().rev().enumerate() {
            let y = top - 0.8 * em - line * at as f64;
            sheet.text_on_ground([right, y], text, 1.0, Anchor::End);
        }
        let place = |value: f64| top + tall * (1.0 - self.fraction([low, high], value));
        for (value, text) in &ticks {
            let y = place(*value);
            let end = left + across;
            // Under the frame and joined to it: apart from it a tick were a minus.
            sheet.line(vec![[end, y], [end + 0.22 * em, y]], sheet.thin(), ink);
            sheet.text(
                [end + 0.75 * em, y + 0.35 * em],
                text,
                1.0,
                Anchor::Start,
                ink,
            );
        }
        let frame = [
            [left, top],
            [left + across, top],
            [left + across, top + tall],
            [left, top + tall],
            [left, top],
        ];
        sheet.line(frame.to_vec(), sheet.thin(), ink);
        sheet.figure.marks.push(Mark::Cells {
            at: [left, top],
            size: [across, tall],
            columns: across as usize,
            colors: self.cells([low, high], across as usize, tall as usize),
        });
        for &level in self
            .levels
            .iter()
            .filter(|level| (low..=high).contains(*level))
        {
            let y = place(level);
            sheet.line(
                vec![[left - 0.3 * em, y], [left + across, y]],
                1.5 * sheet.thin(),
                ink,
            );
        }
        Ok(Some(left))
    }

    /// What the values are, with power and unit.
    fn caption_lines(&self, sheet: &Sheet, unit: Option<String>, exponent: i32) -> Vec<String> {
        let parts: Vec<String> = units::power(exponent).into_iter().chain(unit).collect();
        // Not to be parted.
        let unit = parts.join(" ").replace(' ', "\u{a0}");
        let words = match (self.caption, unit.as_str()) {
            (caption, "") => caption.to_owned(),
            ("", unit) => unit.to_owned(),
            (caption, unit) => format!("{caption} ({unit})"),
        };
        sheet.wrapped(&words, 1.0, 0.28 * sheet.size()[0], 3)
    }

    /// 0 at the low end, 1 at the high one.
    fn fraction(&self, [low, high]: [f64; 2], value: f64) -> f64 {
        match self.is_log {
            true => (value / low).ln() / (high / low).ln(),
            false => (value - low) / (high - low),
        }
    }

    /// Rows from the high end down.
    fn cells(&self, [low, high]: [f64; 2], columns: usize, rows: usize) -> Vec<[u8; 3]> {
        let side = (columns / 2).max(1);
        let mut cells = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            let t = 1.0 - (row as f64 + 0.5) / rows as f64;
            let value = match self.is_log {
                true => low * (high / low).powf(t),
                false => low + t * (high - low),
            };
            let color = self.function.srgb(value).map(decode_srgb);
            let alpha = self.alpha(value);
            for column in 0..columns {
                let check = decode_srgb(CHECK[(row / side + column / side) % 2]);
                cells.push(color.map(|c| {
                    let mixed = alpha * c + (1.0 - alpha) * check;
                    (255.0 * encode_srgb(mixed)).round() as u8
                }));
            }
        }
        cells
    }

    fn alpha(&self, value: f64) -> f64 {
        let opacity = self.function.opacity(value).clamp(0.0, 1.0);
        self.depth
            .map_or(1.0, |depth| 1.0 - (1.0 - opacity).powf(depth))
    }
}

/// A line for each surface or channel: a patch of its colour and what it is. Gives the pixel where it begins.
pub fn legend(sheet: &mut Sheet, entries: &[([f64; 3], String)]) -> Option<f64> {
    let [width, height] = sheet.size();
    let em = sheet.em;
    let widths = entries.iter().map(|(_, text)| sheet.width(text, 1.0));
    let words = widths.fold(0.0, f64::max).min(0.35 * width);
    let right = width - em;
    let left = (right - words - 1.5 * em).round();
    let line = 1.6 * em;
    let top = 0.5 * (height - line * entries.len() as f64);
    for (at, (srgb, text)) in entries.iter().enumerate() {
        let y = (top + line * at as f64).round();
        let ink = sheet.ink([left, y], [right, y + em]);
        let end = [left + em.round(), y + em.round()];
        let frame = [[left, y], [end[0], y], end, [left, end[1]], [left, y]];
        sheet.line(frame.to_vec(), sheet.thin(), ink);
        sheet.figure.marks.push(Mark::Cells {
            at: [left, y],
            size: [em.round(); 2],
            columns: 1,
            colors: vec![srgb.map(|c| (255.0 * c.clamp(0.0, 1.0)).round() as u8)],
        });
        let text = sheet.shortened(text, 1.0, words);
        sheet.text(
            [left + 1.5 * em, y + 0.85 * em],
            &text,
            1.0,
            Anchor::Start,
            ink,
        );
    }
    (!entries.is_empty()).then_some(left)
}
