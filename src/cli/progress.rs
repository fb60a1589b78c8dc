//! What is being done at the moment, on stderr: a line for a person, or JSON for a program.

use super::output::say_aside;
use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressStyle};
use std::{io::IsTerminal, time::Duration};

/// Every word of `--progress`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ProgressWord {
    /// A line where stderr is a terminal
    #[default]
    Auto,
    /// One JSON object a line
    Json,
    /// Nothing
    None,
}

/// Tells how far the work is.
#[derive(Debug)]
pub enum Progress {
    /// To nobody.
    Silent,
    /// To a person.
    Line(ProgressBar),
    /// To a program: `{"device":"..."}`, `{"stage":"draw","done":1,"of":3}`.
    Json,
}

impl Progress {
    /// As `--progress` says.
    pub fn new(word: ProgressWord) -> Self {
        match word {
            ProgressWord::Json => Self::Json,
            ProgressWord::Auto if std::io::stderr().is_terminal() => {
                let style = ProgressStyle::with_template("{spinner} {msg} [{elapsed}]");
                let line =
                    ProgressBar::new_spinner().with_style(style.expect("a template that is right"));
                line.enable_steady_tick(Duration::from_millis(200));
                Self::Line(line)
            }
            ProgressWord::Auto | ProgressWord::None => Self::Silent,
        }
    }

    /// `done` of `of` parts of a stage are done.
    pub fn stage(&self, stage: &'static str, done: usize, of: usize) {
        match self {
            Self::Silent => {}
            Self::Line(line) if of > 1 => line.set_message(format!("{stage} {done}/{of}")),
            Self::Line(line) => line.set_message(stage),
            Self::Json => say_json(&serde_json::json!({ "stage": stage, "done": done, "of": of })),
        }
    }

    /// Which device was chosen.
    pub fn device(&self, name: &str) {
        match self {
            Self::Silent => {}
            Self::Line(_) => self.note(&format!("on {name}")),
            Self::Json => say_json(&serde_json::json!({ "device": name })),
        }
    }

    /// Says something that stays.
    pub fn note(&self, text: &str) {
        match self {
            Self::Line(line) => line.suspend(|| say_aside(text)),
            Self::Silent | Self::Json => say_aside(text),
        }
    }
}

fn say_json(line: &serde_json::Value) {
    // Nobody reads a closed stderr.
    let _ = std::io::Write::write_all(&mut std::io::stderr(), format!("{line}\n").as_bytes());
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Self::Line(line) = self {
            line.finish_and_clear();
        }
    }
}
