//! The matrix as a page of Markdown: what the checks of the code say, in a table for each technique.

use super::cells::{FEATURES, FILTERS, Feature, MODES, Matter, Seen, TECHNIQUES, settings};
use std::fmt::Write as _;
use stratavox::technique::{Filter, Mode, Technique};

const HEAD: &str = "# What goes with what

Every technique, mode, filter and feature, and why some do not go together. Printed by `cargo run --example matrix` from
the checks that the renderer itself makes; `tests/matrix/every_cell.rs` holds this page against them, draws every cell that is not
refused on the device, of the linear filter one of two, of others one of five, and in perspective or orthographic by turns, and compares it with the
CPU reference.

*all* is every filter, *narrow* is `nearest` and `linear`, a number is the reason for what is refused.
";

/// The page.
pub fn page(matter: &Matter) -> String {
    let mut reasons = Reasons::default();
    let mut text = HEAD.to_owned();
    for (technique, technique_word) in TECHNIQUES {
        let modes = MODES.map(|mode| format!("`{}`", mode.1)).join(" | ");
        write!(text, "\n## `--technique {technique_word}`\n\n").expect("text");
        writeln!(text, "| | {modes} |\n|---|{}", "---|".repeat(MODES.len())).expect("text");
        for feature in FEATURES {
            let cells = MODES.map(|(mode, _)| reasons.cell(matter, technique, mode, feature));
            let words = match feature.words {
                "" => String::new(),
                words => format!(" ({words})"),
            };
            writeln!(text, "| {}{words} | {} |", feature.name, cells.join(" | ")).expect("text");
        }
    }
    text.push_str("\n## Reasons\n\n");
    for (i, reason) in reasons.texts.iter().enumerate() {
        writeln!(text, "{}. {reason}", i + 1).expect("text");
    }
    text
}

/// Whether a cell can be, and why not.
pub fn refusal(
    matter: &Matter,
    technique: Technique,
    mode: Mode,
    filter: Filter,
    feature: &Feature,
) -> Option<String> {
    let settings = settings(technique, mode, filter, feature);
    let (channels, parts) = (matter.channels(feature.seen), matter.parts(feature.seen));
    let scene = matter.scene(0, feature.seen, &settings, &channels, &parts);
    let bricks = if feature.seen == Seen::Bricked { 2 } else { 1 };
    let checked = Matter::check(&scene, feature.seen).and_then(|()| settings.check_bricks(bricks));
    checked.err().map(|error| error.to_string())
}

/// The same words for every technique, mode and filter that a reason is said of.
fn general(reason: &str, technique: Technique, mode: Mode, filter: Filter) -> String {
    let names = [
        (technique.to_string(), "this technique"),
        (mode.to_string(), "this mode"),
        (format!("the filter {filter}"), "this filter"),
    ];
    names.iter().fold(reason.to_owned(), |text, (name, word)| {
        let text = text.replace(&format!("no mode {name}"), "no such mode");
        let text = text.replace(&format!("mode {name}"), "this mode");
        let at_start = text.strip_prefix(&format!("{name} "));
        let text = at_start.map_or(text.clone(), |rest| format!("{word} {rest}"));
        match text.strip_suffix(&format!(" {name}")) {
            Some(rest) => format!("{rest} {word}"),
            None => text,
        }
    })
}

#[derive(Default)]
struct Reasons {
    texts: Vec<String>,
}

impl Reasons {
    fn cell(
        &mut self,
        matter: &Matter,
        technique: Technique,
        mode: Mode,
        feature: &Feature,
    ) -> String {
        let of = FILTERS.map(|(filter, _)| {
            let reason = refusal(matter, technique, mode, filter, feature)?;
            Some(general(&reason, technique, mode, filter))
        });
        let drawn: Vec<_> = FILTERS
            .iter()
            .zip(&of)
            .filter(|(_, refused)| refused.is_none())
            .map(|(filter, _)| filter.1)
            .collect();
        let drawn = match drawn[..] {
            [] => String::new(),
            ["nearest", "linear"] => "narrow".to_owned(),
            ref some if some.len() == FILTERS.len() => "all".to_owned(),
            ref some => some.join(", "),
        };
        let mut numbers = Vec::new();
        for reason in of.into_iter().flatten() {
            let number = self.number(reason);
            if !numbers.contains(&number) {
                numbers.push(number);
            }
        }
        let numbers: Vec<_> = numbers.iter().map(|n| format!("({n})")).collect();
        let parts = [drawn, numbers.join(" ")];
        let parts: Vec<_> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        parts.join(" ")
    }

    fn number(&mut self, reason: String) -> usize {
        if let Some(at) = self.texts.iter().position(|known| *known == reason) {
            return at + 1;
        }
        self.texts.push(reason);
        self.texts.len()
    }
}
