//! Runs the program for each pair, and tells what became of it.

use super::{
    features::{FEATURES, Feature, GIVEN},
    inputs::{self, Input},
    rules::{Class, RULES},
};
use crate::person::{Folder, Ran};
use std::collections::HashMap;
use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// What became of a pair.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// No command line holds both: they are one choice, or no input has both.
    NoPair,
    /// A picture.
    Drawn,
    /// None, by the rule of this number.
    Refused(usize),
    /// None without more words, and a picture with those of the rule.
    DrawnWith(usize),
    /// What must not be; the text says what.
    Wrong(String),
}

/// Pixels of a picture, which has room for three sections.
const SIZE: [usize; 2] = [48, 36];

/// Folders of those that draw at the same time: one picture keeps a core busy half of the time.
const PLACES: [&str; 2] = ["a", "b"];

/// The files of a picture by name.
type Files = Vec<(String, Vec<u8>)>;

/// A command line: one feature or two of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Line {
    first: usize,
    second: Option<usize>,
    input: Input,
    is_streamed: bool,
}

impl Line {
    fn features(self) -> impl Iterator<Item = &'static Feature> {
        let all = [Some(self.first), self.second];
        all.into_iter().flatten().map(|i| &FEATURES[i])
    }

    /// The words, each flag once; `more` words come last.
    fn words(self, more: &str) -> String {
        let words = self.features().map(|feature| feature.words);
        let words: Vec<_> = words.chain([more]).collect();
        let words = self.input.fill(&words.join(" "));
        let mut flags: Vec<&str> = Vec::new();
        for flag in words.split("--").map(str::trim) {
            if !flag.is_empty() && !flags.contains(&flag) {
                flags.push(flag);
            }
        }
        let is_film = self.features().any(|feature| feature.choice == "film");
        let (command, number) = if is_film {
            ("animate", "%d")
        } else {
            ("render", "")
        };
        let input = self.input.words(self.is_streamed);
        let flags: String = flags.iter().map(|flag| format!(" --{flag}")).collect();
        let [width, height] = SIZE;
        format!("{command} {input}{flags} --size {width}x{height} --progress none -o p{number}.npy")
    }
}

/// The line of a pair; `None` where there is none.
fn line_of(first: usize, second: usize) -> Option<Line> {
    let [a, b] = [first, second].map(|i| &FEATURES[i]);
    let input = a.inputs.iter().find(|input| b.inputs.contains(input));
    let input = *input.filter(|_| a.choice != b.choice)?;
    Some(Line {
        first,
        second: Some(second),
        input,
        is_streamed: [a, b].iter().any(|feature| feature.choice == "stream"),
    })
}

/// The outcome of every pair, `[first][second]` with `second < first`; those that are known to be drawn are not drawn again.
pub fn outcomes(is_known: impl Fn(usize, usize) -> bool) -> Vec<Vec<Outcome>> {
    let is_run = |line: &Line| {
        line.second
            .is_some_and(|second| !is_known(line.first, second))
    };
    let of_row = |first| (0..first).map(move |second| line_of(first, second));
    let lines: Vec<Vec<_>> = (0..FEATURES.len())
        .map(|first| of_row(first).collect())
        .collect();
    let all = lines.iter().flatten().flatten().copied();
    let pairs: Vec<Line> = all.filter(is_run).collect();
    // What each feature of a pair draws alone of the same input: where that is what both draw, the other does nothing.
    let mut singles: Vec<Line> = Vec::new();
    for single in pairs.iter().flat_map(|pair| alone(*pair)) {
        if !singles.contains(&single) {
            singles.push(single);
        }
    }
    let folder = Folder::new();
    inputs::write(&folder);
    for place in PLACES {
        fs::create_dir(folder.path(place)).expect("a folder");
    }
    let drawn = in_parallel(&singles, |line, place| {
        let (ran, files) = run(&folder, place, &line.words(""));
        (ran.code == 0).then_some(files)
    });
    let drawn: HashMap<Line, Option<Files>> = singles.into_iter().zip(drawn).collect();
    let mut found =
        in_parallel(&pairs, |&line, place| outcome(&folder, place, line, &drawn)).into_iter();
    let mut of_line = |line: &Option<Line>| match line {
        Some(line) if is_run(line) => found.next().expect("as many as lines"),
        Some(_) => Outcome::Drawn,
        None => Outcome::NoPair,
    };
    lines
        .iter()
        .map(|row| row.iter().map(&mut of_line).collect())
        .collect()
}

fn alone(pair: Line) -> impl Iterator<Item = Line> {
    let all = [Some(pair.first), pair.second].into_iter().flatten();
    all.map(move |first| Line {
        first,
        second: None,
        ..pair
    })
}

fn outcome(
    folder: &Folder,
    place: &str,
    line: Line,
    alone_drawn: &HashMap<Line, Option<Files>>,
) -> Outcome {
    let words = line.words("");
    let wrong = |what: &str, ran: &Ran| Outcome::Wrong(format!("{words}: {what}: {}", ran.err));
    let (ran, files) = run(folder, place, &words);
    if ran.code == 0 {
        if is_empty(&files) {
            return wrong("an empty picture", &ran);
        }
        for (other, alone) in line
            .features()
            .collect::<Vec<_>>()
            .iter()
            .rev()
            .zip(alone(line))
        {
            let pair = [other.name, FEATURES[alone.first].name];
            if other.is_seen
                && !GIVEN.contains(&pair)
                && alone_drawn[&alone].as_ref() == Some(&files)
            {
                return wrong(&format!("{} has no effect", other.name), &ran);
            }
        }
        return Outcome::Drawn;
    }
    if ran.code != 2 || ran.err.contains("panicked") || !ran.err.contains("hint: ") {
        return wrong("neither a picture nor a refusal", &ran);
    }
    let rule = RULES.iter().position(|rule| {
        let is_of = |feature: &Feature| rule.of.contains(&feature.name);
        ran.err.contains(rule.says) && (rule.of.is_empty() || line.features().any(is_of))
    });
    let Some(rule) = rule else {
        return wrong("no known reason", &ran);
    };
    let Class::NeedsMore(more) = RULES[rule].class else {
        return Outcome::Refused(rule);
    };
    let (ran, files) = run(folder, place, &line.words(more));
    match ran.code == 0 && !is_empty(&files) {
        true => Outcome::DrawnWith(rule),
        false => wrong(&format!("not drawn with {more}"), &ran),
    }
}

/// True where all pixels of the picture, or of the first of a film, are alike.
fn is_empty(files: &Files) -> bool {
    let first = files
        .iter()
        .find(|(name, _)| ["p.npy", "p0.npy"].contains(&name.as_str()));
    let (_, bytes) = first.expect("a picture");
    let pixels = &bytes[bytes.len() - 16 * SIZE[0] * SIZE[1]..];
    pixels.chunks(16).all(|pixel| pixel == &pixels[..16])
}

/// Runs the program in a folder of its own, and takes the files that it leaves there.
fn run(folder: &Folder, place: &str, words: &str) -> (Ran, Files) {
    let words = words.replace("-o p", &format!("-o {place}/p"));
    let ran = folder.run(&words);
    let mut files: Files = Vec::new();
    for entry in fs::read_dir(folder.path(place)).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy();
        if name.ends_with(".npy") {
            files.push((name.into_owned(), fs::read(&path).expect("a file")));
        }
        fs::remove_file(&path).expect("removed");
    }
    files.sort();
    (ran, files)
}

/// What `work` makes of each, in each of the folders at the same time.
fn in_parallel<T: Sync, R: Send>(all: &[T], work: impl Fn(&T, &str) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, R)>> = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for place in PLACES {
            let (next, done, work) = (&next, &done, &work);
            scope.spawn(move || {
                while let i = next.fetch_add(1, Ordering::Relaxed)
                    && let Some(one) = all.get(i)
                {
                    let result = work(one, place);
                    let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
                    done.push((i, result));
                }
            });
        }
    });
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(i, _)| *i);
    done.into_iter().map(|(_, result)| result).collect()
}
