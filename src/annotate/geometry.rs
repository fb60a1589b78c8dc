//! What geometry beside a volume means: bars for its colours, sentences for its symbols.

use super::{
    Error, Seen,
    bar::{Bar, Room, Slot},
    degrees::DegreeLine,
    degrees::meets,
    sheet::Sheet,
};
use crate::{
    figure::{Anchor, Mark},
    transfer::TransferFunction,
};

/// What colours of geometry mean.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorLegend {
    /// Colours of values.
    pub function: TransferFunction,
    /// What the values are.
    pub caption: String,
    /// As the file has it.
    pub unit: Option<String>,
}

/// What there is to say of the geometry in a picture.
#[derive(Clone, Copy, Debug, Default)]
pub struct GeometryLegend<'a> {
    /// What colours lines or spheres.
    pub lines: Option<&'a ColorLegend>,
    /// What colours points beside a volume.
    pub points: Option<&'a ColorLegend>,
    /// What colours the ground.
    pub ground: Option<&'a ColorLegend>,
    /// What symbols mean, a sentence each.
    pub words: &'a [String],
    /// Meridians and parallels.
    pub degrees: &'a [DegreeLine],
}

/// From line to line of words in the lower right, in em.
pub(super) const APART: f64 = 1.4;
/// Lines up to which the sentences go where other words are in their place.
const HIGHEST: usize = 5;
/// How much of the picture's width a sentence takes.
const WIDEST: f64 = 0.55;

/// Where the bar of the volume stands.
pub(super) fn slot(sheet: &Sheet, seen: &Seen, room: Room) -> Option<Slot> {
    room.slot(0, count(seen).max(1), sheet.size()[1], sheet.em)
}

fn own(seen: &Seen) -> usize {
    usize::from(seen.function.is_some() || seen.projected.is_some())
}

/// How many bars a picture has.
pub(super) fn count(seen: &Seen) -> usize {
    let others = [
        seen.geometry.lines,
        seen.geometry.points,
        seen.geometry.ground,
    ];
    own(seen) + others.into_iter().flatten().count()
}

/// A bar each of lines, of points and of the ground, below that of the volume; where they begin.
pub(super) fn bars(sheet: &mut Sheet, seen: &Seen, room: Room) -> Result<Option<f64>, Error> {
    let legends = [
        seen.geometry.lines,
        seen.geometry.points,
        seen.geometry.ground,
    ];
    let mut left: Option<f64> = None;
    for (nth, legend) in legends.into_iter().flatten().enumerate() {
        let bar = Bar {
            function: &legend.function,
            depth: None,
            caption: &legend.caption,
            unit: legend.unit.as_deref(),
            is_log: false,
            levels: Vec::new(),
            slot: room.slot(own(seen) + nth, count(seen), sheet.size()[1], sheet.em),
        };
        let own = bar.draw(sheet)?;
        left = [left, own].into_iter().flatten().reduce(f64::min);
    }
    Ok(left)
}

/// The lines of the sentences with their baselines, from the lowest up, in the lower right, so many em above the lower side.
pub(super) fn words(sheet: &Sheet, seen: &Seen, below: f64) -> Vec<(f64, String)> {
    let ([width, height], em) = (sheet.size(), sheet.em);
    let words = seen.geometry.words.iter().map(|words| unparted(words));
    let lines = words.flat_map(|words| sheet.wrapped(&words, 1.0, WIDEST * width, 4));
    let lines: Vec<String> = lines.collect();
    let baseline = |line: usize, up: usize| height - (below + APART * (line + up) as f64) * em;
    // Above other words, where there are some.
    let is_free = |&up: &usize| {
        lines.iter().rev().enumerate().all(|(at, line)| {
            let y = baseline(at, up);
            let low = [width - em - sheet.width(line, 1.0), y - em];
            let high = [width - em, y + 0.25 * em];
            let texts = sheet.figure.marks.iter();
            let mut texts = texts.filter(|mark| matches!(mark, Mark::Text { .. }));
            !texts.any(|mark| meets(mark, low, high))
        })
    };
    let up = (0..HIGHEST).find(is_free).unwrap_or(0);
    let placed = lines.into_iter().rev().enumerate();
    placed.map(|(at, line)| (baseline(at, up), line)).collect()
}

/// Writes them.
pub(super) fn write(sheet: &mut Sheet, lines: &[(f64, String)]) {
    let right = sheet.size()[0] - sheet.em;
    for (y, line) in lines {
        sheet.text_on_ground([right, *y], line, 1.0, Anchor::End);
    }
}

/// A number and its unit stay on one line.
fn unparted(words: &str) -> String {
    let mut kept = String::with_capacity(words.len());
    let mut follows_digit = false;
    for letter in words.chars() {
        kept.push(if letter == ' ' && follows_digit {
            '\u{a0}'
        } else {
            letter
        });
        follows_digit = letter.is_ascii_digit();
    }
    kept
}
