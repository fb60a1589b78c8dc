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
    /// Where it stands; `None` where there is no room for it.
    pub slot: Option<Slot>,
}

/// Where captions and bars begin at the farthest, in a picture of a width.
pub fn column(width: f64, em: f64) -> f64 {
    (1.0 - WIDEST_CAPTION) * width - em
}

/// Rows of the picture that bars may take, from above to below.
#[derive(Clone, Copy, Debug)]
pub struct Room {
    /// The first.
    pub top: f64,
    /// The one behind the last.
    pub bottom: f64,
}

/// The place of one bar, in rows of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slot {
    rows: [f64; 2],
    /// Where its middle is where nothing is in the way.
    middle: f64,
    /// How tall it is where nothing is in the way.
    tall: f64,
}

/// Of the bar's height in that of the picture.
const HEIGHT: f64 = 0.45;
/// The same of several, of the part of the picture that each has.
const HEIGHT_OF_SEVERAL: f64 = 0.58;
/// Em from line to line of a caption, above and below a bar together, and along the smallest bar, which has room for three numbers.
const LINE: f64 = 1.3;
const AROUND: f64 = 1.4;
const SHORTEST: f64 = 3.2;
/// A bar that had to be shorter than so many em is not drawn.
const LEAST: f64 = 2.0;
/// Of a caption, lines and how much of the picture's width they take.
const MOST_LINES: usize = 3;
const WIDEST_CAPTION: f64 = 0.28;
/// Greys of the check, sRGB.
const CHECK: [f64; 2] = [0.45, 0.65];

impl Room {
    /// Whether so many bars with captions of one line have room.
    pub fn has(self, count: usize, em: f64) -> bool {
        self.bottom - self.top >= count as f64 * (LINE + AROUND + SHORTEST) * em
    }

    /// That of the nth of so many bars, one below the other, in a picture of a height; where the last ones have no room, the
    /// first ones share it.
    pub fn slot(self, nth: usize, count: usize, height: f64, em: f64) -> Option<Slot> {
        let fits = (1..=count).rev().find(|&count| self.has(count, em));
        let count = fits.unwrap_or(1);
        let part = (self.bottom - self.top) / count as f64;
        let from = self.top + nth as f64 * part;
        let (middle, share) = match count {
            1 => (0.5 * height, HEIGHT),
            _ => (from + 0.5 * part, HEIGHT_OF_SEVERAL / count as f64),
        };
        (nth < count).then_some(Slot {
            rows: [from, from + part],
            middle,
            tall: (share * height).round(),
        })
    }
}

impl Slot {
    /// How tall a bar is whose caption has so many lines.
    fn tall(&self, lines: usize, em: f64) -> f64 {
        let [from, to] = self.rows;
        let free = to - from - (LINE * lines as f64 + AROUND) * em;
        self.tall.min(free.floor())
    }

    /// The row between the upper side of its caption and the lower side of the bar.
    fn middle(&self, lines: usize, em: f64) -> f64 {
        let half = 0.5 * (self.tall(lines, em) + (LINE * lines as f64 + AROUND) * em);
        let [from, to] = self.rows;
        self.middle.min(to - half).max(from + half)
    }
}

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
        let (Some([low, high]), Some(slot)) = (self.range(), self.slot) else {
            return Ok(None);
        };
        if self.is_log && low <= 0.0 {
            return Err(Error::NoLogarithm(low));
        }
        let [width, _] = sheet.size();
        let em = sheet.em;
        let (unit, factor) = units::scaled(self.unit, low.abs().max(high.abs()));
        let ticks_of = |tall: f64| {
            let most = (tall / (1.7 * em)) as usize;
            match self.is_log {
                true => (units::log_ticks([low * factor, high * factor], most), 0),
                false => {
                    let ticks = units::ticks([low * factor, high * factor], most);
                    (ticks.at, ticks.exponent)
                }
            }
        };
        // The power of ten is that of the range, however many numbers there are.
        let (_, exponent) = ticks_of(slot.tall(1, em));
        let mut caption = self.caption_lines(sheet, unit.as_deref(), exponent, MOST_LINES);
        while caption.len() > 1 && slot.tall(caption.len(), em) < SHORTEST * em {
            let fewer = caption.len() - 1;
            caption = self.caption_lines(sheet, unit.as_deref(), exponent, fewer);
        }
        let lines = caption.len();
        let tall = slot.tall(lines, em);
        if tall < LEAST * em {
            return Ok(None);
        }
        let (ticks, _) = ticks_of(tall);
        let ticks: Vec<(f64, String)> = ticks
            .into_iter()
            .map(|(value, text)| (value / factor, units::signed(&text)))
            .collect();
        let widths = ticks.iter().map(|(_, text)| sheet.width(text, 1.0));
        let numbers = widths.fold(0.0, f64::max);
        let right = width - em;
        let across = em.round().max(6.0);
        let left = (right - numbers - 0.75 * em - across).round();
        let line = LINE * em;
        let top = (slot.middle(lines, em) - 0.5 * tall + 0.5 * line * lines as f64).round();
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
    fn caption_lines(
        &self,
        sheet: &Sheet,
        unit: Option<&str>,
        exponent: i32,
        most: usize,
    ) -> Vec<String> {
        let unit = unit.map(str::to_owned);
        let parts: Vec<String> = units::power(exponent).into_iter().chain(unit).collect();
        // Not to be parted.
        let unit = parts.join(" ").replace(' ', "\u{a0}");
        let words = match (self.caption, unit.as_str()) {
            (caption, "") => caption.to_owned(),
            ("", unit) => unit.to_owned(),
            (caption, unit) => format!("{caption} ({unit})"),
        };
        sheet.wrapped(&words, 1.0, WIDEST_CAPTION * sheet.size()[0], most)
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

#[cfg(test)]
mod tests {
    use super::*;

    const EM: f64 = 11.0;

    /// Rows from the upper side of a caption of so many lines to the lower side of the bar.
    fn rows(slot: Slot, lines: usize) -> [f64; 2] {
        let half = 0.5 * (slot.tall(lines, EM) + LINE * EM * lines as f64);
        [slot.middle(lines, EM) - half, slot.middle(lines, EM) + half]
    }

    #[test]
    fn bars_with_room_are_where_they_are_by_themselves() {
        let room = Room {
            top: 0.0,
            bottom: 240.0,
        };
        let slot = room.slot(0, 1, 240.0, EM).expect("room");
        assert_eq!((slot.tall(1, EM), slot.middle(1, EM)), (108.0, 120.0));
        // Words below it move it up, and it stays as tall.
        let less = Room {
            bottom: 170.0,
            ..room
        };
        let moved = less.slot(0, 1, 240.0, EM).expect("room");
        assert_eq!(moved.tall(1, EM), 108.0);
        assert!(moved.middle(1, EM) < 120.0);
    }

    #[test]
    fn bars_and_their_captions_stay_in_their_rows_and_the_last_are_left_out() {
        for bottom in [60.0, 100.0, 147.0, 180.0, 240.0, 600.0] {
            let room = Room { top: 37.0, bottom };
            for count in 1..=4 {
                let slots = (0..count).filter_map(|nth| room.slot(nth, count, 240.0, EM));
                let slots: Vec<Slot> = slots.collect();
                assert_eq!(slots.len() == count, count == 1 || room.has(count, EM));
                let mut last = room.top;
                for slot in slots {
                    if slot.tall(1, EM) < LEAST * EM {
                        assert!(!room.has(1, EM));
                        continue;
                    }
                    let [from, to] = rows(slot, 1);
                    assert!(
                        from >= last - 1e-9 && to <= bottom + 1e-9,
                        "{bottom} {count}"
                    );
                    last = to;
                }
            }
        }
    }
}
