//! The variables of a file, each with what its own header says.

use super::text::{MAX_LINES, Page};
use super::{text::Lines, unit};
use crate::cli::flags::InputFlags;
use crate::volume::Limits;

impl Page<'_> {
    /// The others in the file, each with what its own header says.
    pub fn variables(&self, lines: &mut Lines, limits: &Limits) {
        for (i, name) in self.header.variables.iter().take(MAX_LINES).enumerate() {
            let flags = InputFlags {
                variable: Some(name.clone()),
                ..self.input.clone()
            };
            let what = match flags.open(limits) {
                Ok(source) => {
                    let header = source.header();
                    let [x, y, z] = header.dims;
                    let times = match header.times {
                        1 => String::new(),
                        times => format!(", {times} times"),
                    };
                    let unit = unit(header).map_or(String::new(), |unit| format!(", {unit}"));
                    let what = match &header.long_name {
                        Some(what) => format!(", {what}"),
                        None => String::new(),
                    };
                    let stored = header.stored.name();
                    format!("{x} x {y} x {z}, {stored}{times}{unit}{what}")
                }
                Err(error) => error.to_string(),
            };
            let title = if i == 0 { "variables" } else { "" };
            lines.say(title, format!("{name:<16} {what}"));
        }
        self.rest(lines, self.header.variables.len());
        lines.say("", "--variable NAME takes one");
    }
}
