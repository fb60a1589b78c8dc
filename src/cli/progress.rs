//! What is being done at the moment, on stderr: a line for a person, or JSON for a program.

use super::{output::say_aside, timings::Loaded};
use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressStyle};
use std::{
    collections::BTreeSet,
    io::IsTerminal,
    sync::{Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};

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

/// Tells how far the work is, and keeps what reading took.
#[derive(Debug)]
pub struct Progress {
    told: Told,
    loaded: Mutex<Loaded>,
    last: Mutex<Last>,
    said: Mutex<BTreeSet<String>>,
}

/// The stage that was told last, and when it or a part of it was.
#[derive(Debug)]
struct Last {
    stage: &'static str,
    done: usize,
    of: usize,
    told: Instant,
    /// Of a picture of paths, for a person: how many there are, how much noise, how long the rest takes.
    paths: String,
}

/// Parts of a picture are told no more often.
const PART_EVERY: Duration = Duration::from_millis(200);

#[derive(Debug)]
enum Told {
    /// To nobody.
    Silent,
    /// To a person.
    Line(ProgressBar),
    /// To a program: `{"device":"..."}`, `{"stage":"draw","done":1,"of":3}`, and while one of them takes long
    /// `{"stage":"draw","done":1,"of":3,"part":0.25}`.
    Json,
    /// To nobody yet: notes are kept.
    Kept(Mutex<Vec<String>>),
}

impl Progress {
    /// As `--progress` says.
    pub fn new(word: ProgressWord) -> Self {
        let told = match word {
            ProgressWord::Json => Told::Json,
            ProgressWord::Auto if std::io::stderr().is_terminal() => {
                let style = ProgressStyle::with_template("{spinner} {msg} [{elapsed}]");
                let line =
                    ProgressBar::new_spinner().with_style(style.expect("a template that is right"));
                line.enable_steady_tick(Duration::from_millis(200));
                Told::Line(line)
            }
            ProgressWord::Auto | ProgressWord::None => Told::Silent,
        };
        Self::telling(told)
    }

    fn telling(told: Told) -> Self {
        Self {
            told,
            loaded: Mutex::default(),
            said: Mutex::default(),
            last: Mutex::new(Last {
                stage: "",
                done: 0,
                of: 0,
                told: Instant::now(),
                paths: String::new(),
            }),
        }
    }

    /// For a part of the work whose notes are said later, or elsewhere.
    pub fn of_part() -> Self {
        Self::telling(Told::Kept(Mutex::default()))
    }

    /// What [`Progress::of_part`] has kept.
    pub fn into_notes(self) -> Vec<String> {
        match &self.told {
            Told::Kept(notes) => {
                std::mem::take(&mut *notes.lock().unwrap_or_else(PoisonError::into_inner))
            }
            _ => Vec::new(),
        }
    }

    /// A volume more was read.
    pub fn loaded(&self, more: Loaded) {
        let mut all = self.kept();
        *all = all.and(more);
    }

    /// What all volumes took together.
    pub fn all_loaded(&self) -> Loaded {
        *self.kept()
    }

    fn kept(&self) -> MutexGuard<'_, Loaded> {
        self.loaded.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// `done` of `of` parts of a stage are done.
    pub fn stage(&self, stage: &'static str, done: usize, of: usize) {
        *self.last() = Last {
            stage,
            done,
            of,
            told: Instant::now(),
            paths: String::new(),
        };
        match &self.told {
            Told::Silent | Told::Kept(_) => {}
            Told::Line(line) if of > 1 => line.set_message(format!("{stage} {done}/{of}")),
            Told::Line(line) => line.set_message(stage),
            Told::Json => say_json(&serde_json::json!({ "stage": stage, "done": done, "of": of })),
        }
    }

    /// Of what is being done such a part, 0 to 1, is done too. Not told of what takes no time.
    pub fn part(&self, part: f64) {
        let mut last = self.last();
        if last.told.elapsed() < PART_EVERY {
            return;
        }
        last.told = Instant::now();
        let Last {
            stage,
            done,
            of,
            ref paths,
            ..
        } = *last;
        let percent = (100.0 * part) as u32;
        match &self.told {
            Told::Silent | Told::Kept(_) => {}
            Told::Line(line) if of > 1 => {
                line.set_message(format!("{stage} {done}/{of}, {percent} %{paths}"));
            }
            Told::Line(line) => line.set_message(format!("{stage} {percent} %{paths}")),
            Told::Json => say_json(
                &serde_json::json!({ "stage": stage, "done": done, "of": of, "part": part }),
            ),
        }
    }

    /// So many of so many paths a pixel are traced, with this noise left and so many seconds to go, where that is known.
    pub fn paths(&self, [done, of]: [u32; 2], noise: Option<f64>, left: Option<f64>) {
        let mut last = self.last();
        match &self.told {
            Told::Silent | Told::Kept(_) => {}
            Told::Line(_) => {
                let noise = noise.map_or(String::new(), |noise| {
                    format!(", noise {:.1} %", 100.0 * noise)
                });
                let left = left.map(Duration::try_from_secs_f64).and_then(Result::ok);
                let left = left.map_or(String::new(), |left| format!(", {} left", shown(left)));
                last.paths = format!(": {done} of {of} paths{noise}{left}");
            }
            Told::Json => say_json(&serde_json::json!({
                "stage": last.stage, "samples": done, "of_samples": of, "noise": noise, "seconds_left": left,
            })),
        }
    }

    fn last(&self) -> MutexGuard<'_, Last> {
        self.last.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// `done` of `of` frames are written; `left` is the time that the others will take, once that is known.
    pub fn frames(&self, done: usize, of: usize, left: Option<Duration>) {
        self.counted(["frame", "frames"], done, of, left);
    }

    /// The same of volumes that are drawn.
    pub fn volumes(&self, done: usize, of: usize, left: Option<Duration>) {
        self.counted(["volume", "volumes"], done, of, left);
    }

    fn counted(&self, [one, all]: [&str; 2], done: usize, of: usize, left: Option<Duration>) {
        match &self.told {
            Told::Silent | Told::Kept(_) => {}
            Told::Line(line) => {
                let left = left.map_or(String::new(), |left| format!(", {} left", shown(left)));
                line.set_message(format!("{one} {done}/{of}{left}"));
            }
            Told::Json => {
                let left = left.map(|left| left.as_secs_f64());
                say_json(
                    &serde_json::json!({ "stage": all, "done": done, "of": of, "seconds_left": left }),
                );
            }
        }
    }

    /// What became of a volume, from one of its views where it has several: its picture, or why there is none.
    pub fn volume(
        &self,
        input: &str,
        view: Option<&str>,
        picture: Option<&str>,
        error: Option<&str>,
    ) {
        if let Told::Json = &self.told {
            let mut line =
                serde_json::json!({ "volume": input, "picture": picture, "error": error });
            if let Some(view) = view {
                line["view"] = view.into();
            }
            say_json(&line);
        }
    }

    /// Which device was chosen.
    pub fn device(&self, name: &str) {
        match &self.told {
            Told::Silent | Told::Kept(_) => {}
            Told::Line(_) => self.note(&format!("on {name}")),
            Told::Json => say_json(&serde_json::json!({ "device": name })),
        }
    }

    /// Says something that stays, once.
    pub fn note(&self, text: &str) {
        let mut said = self.said.lock().unwrap_or_else(PoisonError::into_inner);
        if !said.insert(text.to_owned()) {
            return;
        }
        match &self.told {
            Told::Line(line) => line.suspend(|| say_aside(text)),
            Told::Json => say_json(&serde_json::json!({ "note": text })),
            Told::Silent => say_aside(text),
            Told::Kept(notes) => {
                let mut notes = notes.lock().unwrap_or_else(PoisonError::into_inner);
                notes.push(text.to_owned());
            }
        }
    }
}

/// A time to come, for a person.
fn shown(left: Duration) -> String {
    let seconds = left.as_secs_f64().ceil() as u64;
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {:02} s", seconds / 60, seconds % 60),
        _ => format!("{} h {:02} min", seconds / 3600, seconds / 60 % 60),
    }
}

fn say_json(line: &serde_json::Value) {
    // Nobody reads a closed stderr.
    let _ = std::io::Write::write_all(&mut std::io::stderr(), format!("{line}\n").as_bytes());
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Told::Line(line) = &self.told {
            line.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_to_come_is_told_in_two_units_at_most() {
        for (seconds, wanted) in [
            (0.2, "1 s"),
            (59.0, "59 s"),
            (61.0, "1 min 01 s"),
            (7322.0, "2 h 02 min"),
        ] {
            assert_eq!(shown(Duration::from_secs_f64(seconds)), wanted);
        }
    }
}
