//! Variants of shaders from the files that they are made of: part of `build.rs`, and of the library where it says what a
//! shader was made from.

use super::variants::{SILENT, Slot, filled};
use std::collections::{BTreeMap, BTreeSet};

/// Every way to take one word from each slot.
pub fn combinations(slots: &[Slot]) -> Vec<Vec<&'static str>> {
    slots.iter().fold(vec![Vec::new()], |sets, (_, words)| {
        let extended = |set: &Vec<&'static str>| {
            let set = set.clone();
            words.iter().map(move |word| [&set[..], &[*word]].concat())
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
    let names = slots.iter().map(|slot| slot.0);
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
        source.append(format!("{file}.wgsl"), fills, read, &mut BTreeSet::new());
        source
    }

    fn append(
        &mut self,
        path: String,
        fills: &BTreeMap<&str, &str>,
        read: &dyn Fn(&str) -> String,
        seen: &mut BTreeSet<String>,
    ) {
        if !seen.insert(path.clone()) {
            return;
        }
        for (number, line) in read(&path).lines().enumerate() {
            if let Some(name) = line.strip_prefix("#import ") {
                let path = format!("lib/{}.wgsl", filled(name, fills));
                self.append(path, fills, read, seen);
            } else {
                self.text.push_str(line);
                self.text.push('\n');
                self.lines.push((path.clone(), number + 1));
            }
        }
    }
}
