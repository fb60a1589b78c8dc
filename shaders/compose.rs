//! Variants of shaders from the files that they are made of: part of `build.rs`, and of the library where it says what a
//! shader was made from.

use super::variants::{SILENT, Slot, filled};
use std::collections::BTreeMap;

/// Every way to take one word from each slot.
pub fn combinations(slots: &[Slot]) -> Vec<Vec<&'static str>> {
    slots.iter().fold(vec![Vec::new()], |sets, slot| {
        let extended = |set: &Vec<&'static str>| {
            let set = set.clone();
            slot.words
                .iter()
                .map(move |word| [&set[..], &[*word]].concat())
        };
        sets.iter().flat_map(extended).collect()
    })
}

/// The name of a variant.
pub fn name(file: &str, words: &[&str]) -> String {
    let named = words.iter().copied().filter(|word| !SILENT.contains(word));
    [file]
        .into_iter()
        .chain(named)
        .collect::<Vec<_>>()
        .join(".")
}

/// The word of each slot.
pub fn fills<'w>(slots: &[Slot], words: &[&'w str]) -> BTreeMap<&'static str, &'w str> {
    let names = slots.iter().map(|slot| slot.name);
    names.zip(words.iter().copied()).collect()
}

/// One entry file with its imports, and where each of its lines came from.
#[derive(Debug, Default)]
pub struct Source {
    pub text: String,
    /// The file of each line, under `shaders`, and its number there.
    pub lines: Vec<(String, usize)>,
}

impl Source {
    /// Of `file`, without its ending, with the texts that `read` gives for files under `shaders`.
    pub fn read(file: &str, fills: &BTreeMap<&str, &str>, read: &dyn Fn(&str) -> String) -> Self {
        let mut source = Self::default();
        for path in Self::files(file, fills, read) {
            for (number, line) in (1..).zip(read(&path).lines()) {
                if !line.starts_with(IMPORT) {
                    source.push(&path, number, line);
                }
            }
        }
        source
    }

    /// Paths of `file` and of all that it imports, each once.
    pub fn files(
        file: &str,
        fills: &BTreeMap<&str, &str>,
        read: &dyn Fn(&str) -> String,
    ) -> Vec<String> {
        let mut files = Vec::new();
        append(&mut files, format!("{file}.wgsl"), fills, read);
        files
    }

    /// Another line.
    pub fn push(&mut self, path: &str, number: usize, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
        self.lines.push((path.to_owned(), number));
    }
}

/// What a line that names another file begins with.
pub const IMPORT: &str = "#import ";

fn append(
    files: &mut Vec<String>,
    path: String,
    fills: &BTreeMap<&str, &str>,
    read: &dyn Fn(&str) -> String,
) {
    if files.contains(&path) {
        return;
    }
    let text = read(&path);
    files.push(path);
    for name in text.lines().filter_map(|line| line.strip_prefix(IMPORT)) {
        append(
            files,
            format!("lib/{}.wgsl", filled(name, fills)),
            fills,
            read,
        );
    }
}
