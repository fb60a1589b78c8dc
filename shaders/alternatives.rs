//! One module of several variants that specialization constants choose among: part of `build.rs`.
//!
//! Files that stand for different words of a constant slot define functions of the same names. Each keeps its own
//! under a name of its own, and a function of the shared name chooses, which drivers fold away:
//!
//! ```text
//! fn filtered(..)     ->    fn filtered_of_filter_nearest(..)   fn filtered_of_filter_linear(..)
//!                           fn filtered(..) { switch FILTER { case 0u: { return filtered_of_filter_nearest(..); } .. } }
//! ```
//!
//! What is defined twice with the same text stands once. What differs in its parameters, and structures and constants
//! that differ, are private to their file: that another file uses them is a build error.

use super::compose::{IMPORT, Source, combinations};
use super::variants::{CONSTANTS, Slot};
use std::collections::{BTreeMap, BTreeSet};

/// The text of all variants of `file` in one. `fills` has the words of its other slots.
pub fn merged(
    file: &str,
    slots: &[Slot],
    fills: &BTreeMap<&str, &str>,
    read: &dyn Fn(&str) -> String,
) -> Source {
    let sets = combinations(slots);
    let mut files: Vec<File> = Vec::new();
    for (number, words) in sets.iter().enumerate() {
        let mut fills = fills.clone();
        fills.extend(
            slots
                .iter()
                .map(|slot| slot.name)
                .zip(words.iter().copied()),
        );
        for path in Source::files(file, &fills, read) {
            match files.iter_mut().find(|file| file.path == path) {
                Some(file) => _ = file.sets.insert(number),
                None => files.push(File::parse(path, number, read)),
            }
        }
    }
    let mut merging = Merging {
        slots,
        sets: &sets,
        owners: owners(&files),
        files,
    };
    merging.part();
    merging.text()
}

/// A file, and for which combinations of words it is imported.
struct File {
    path: String,
    sets: BTreeSet<usize>,
    items: Vec<Item>,
}

/// A declaration with the comments before it.
#[derive(Clone)]
struct Item {
    /// Empty for text that declares nothing.
    name: String,
    text: String,
    /// Its number in the file.
    first_line: usize,
}

impl File {
    fn parse(path: String, set: usize, read: &dyn Fn(&str) -> String) -> Self {
        let mut items = vec![Item::new(1)];
        for (number, line) in read(&path).lines().enumerate() {
            if line.starts_with(IMPORT) {
                items.push(Item::new(number + 2));
                continue;
            }
            let declared = declared(line);
            let item = items.last_mut().expect("one");
            item.text += line;
            item.text.push('\n');
            if let Some(name) = declared {
                assert!(
                    item.name.is_empty(),
                    "{path}:{}: two declarations",
                    number + 1
                );
                item.name = name.to_owned();
            }
            // A declaration ends with its block, or with a semicolon.
            let is_last = !line.starts_with([' ', '/']) && line.ends_with([';', '}']);
            if !item.name.is_empty() && is_last {
                items.push(Item::new(number + 2));
            }
        }
        Self {
            path,
            sets: [set].into(),
            items,
        }
    }

    fn stem(&self) -> &str {
        let name = self.path.rsplit('/').next().unwrap_or_default();
        name.trim_end_matches(".wgsl")
    }
}

impl Item {
    fn new(first_line: usize) -> Self {
        Self {
            name: String::new(),
            text: String::new(),
            first_line,
        }
    }

    /// Without comments and empty lines.
    fn code(&self) -> String {
        let lines = self.text.lines();
        let lines = lines.map(|line| line.split("//").next().unwrap_or_default().trim_end());
        lines
            .filter(|line| !line.is_empty())
            .collect::<Vec<_>>()
            .join("\n")
    }

    /// `fn name(parameters) -> type` of a function.
    fn signature(&self) -> Option<String> {
        let code = self.code();
        let from = code.find("fn ")?;
        let is_own = code[..from].lines().all(|line| line.starts_with('@'));
        let end = code[from..].find(" {\n")?;
        is_own.then(|| code[from..from + end].to_owned())
    }
}

/// What a line at the left edge declares.
fn declared(line: &str) -> Option<&str> {
    let mut rest = line;
    while rest.starts_with('@') {
        rest = rest.split_once(' ')?.1;
    }
    let words = ["fn ", "struct ", "const ", "alias ", "var"];
    let word = words.into_iter().find(|word| rest.starts_with(word))?;
    rest = &rest[word.len()..];
    if word == "var" {
        rest = match rest.strip_prefix('<') {
            Some(space) => space.split_once("> ")?.1,
            None => rest.trim_start(),
        };
    }
    Some(&rest[..rest.find(|c: char| !is_of_name(c)).unwrap_or(rest.len())])
}

fn is_of_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// Which files declare a name.
fn owners(files: &[File]) -> BTreeMap<String, Vec<usize>> {
    let mut owners: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (number, file) in files.iter().enumerate() {
        for item in file.items.iter().filter(|item| !item.name.is_empty()) {
            owners.entry(item.name.clone()).or_default().push(number);
        }
    }
    owners
}

struct Merging<'a> {
    slots: &'a [Slot],
    sets: &'a [Vec<&'static str>],
    files: Vec<File>,
    owners: BTreeMap<String, Vec<usize>>,
}

impl Merging<'_> {
    /// Gives what differs names of its own, and leaves of what is alike the first.
    fn part(&mut self) {
        let mut apart: BTreeSet<String> = BTreeSet::new();
        loop {
            let before = apart.len();
            for (name, owners) in &self.owners {
                let texts: BTreeSet<String> = owners
                    .iter()
                    .map(|&file| self.item(file, name).code())
                    .collect();
                // What uses something that is not the same is not the same either.
                let uses = || {
                    owners.len() > 1
                        && apart.iter().any(|other| {
                            other != name
                                && owners.iter().any(|&file| self.declares(file, other))
                                && texts.iter().any(|text| mentions(text, other))
                        })
                };
                if texts.len() > 1 || uses() {
                    apart.insert(name.clone());
                }
            }
            if apart.len() == before {
                break;
            }
        }
        for (name, owners) in &self.owners {
            if apart.contains(name) {
                continue;
            }
            for &file in &owners[1..] {
                self.files[file].items.retain(|item| item.name != *name);
            }
        }
        let choosing: Vec<Item> = apart
            .iter()
            .filter_map(|name| self.choosing(name))
            .collect();
        for name in &apart {
            for &file in &self.owners[name] {
                let own = own_name(name, self.files[file].stem());
                for item in &mut self.files[file].items {
                    item.text = renamed(&item.text, name, &own);
                }
            }
        }
        self.files.push(File {
            path: "(chosen by constants)".into(),
            sets: BTreeSet::new(),
            items: choosing,
        });
    }

    fn item(&self, file: usize, name: &str) -> &Item {
        let mut items = self.files[file].items.iter();
        items
            .find(|item| item.name == name)
            .expect("declared there")
    }

    fn declares(&self, file: usize, name: &str) -> bool {
        self.owners
            .get(name)
            .is_some_and(|owners| owners.contains(&file))
    }

    /// The function that chooses among those of a name; `None` where no other file uses it.
    fn choosing(&self, name: &str) -> Option<Item> {
        let owners = &self.owners[name];
        let users: Vec<&str> = (0..self.files.len())
            .filter(|file| !owners.contains(file))
            .filter(|&file| {
                self.files[file]
                    .items
                    .iter()
                    .any(|item| mentions(&item.code(), name))
            })
            .map(|file| self.files[file].path.as_str())
            .collect();
        if users.is_empty() {
            return None;
        }
        let of = |&file: &usize| self.item(file, name).signature();
        let signature = of(&owners[0]).unwrap_or_else(|| {
            panic!(
                "`{name}` is no function, differs between {:?} and is used by {users:?}",
                self.paths(owners)
            )
        });
        for file in owners {
            let other = self.item(*file, name).signature();
            assert_eq!(
                types_of(&signature),
                types_of(&other.unwrap_or_default()),
                "`{name}` has other parameters in {:?}, and is used by {users:?}",
                self.paths(owners)
            );
        }
        let arguments = parameters_of(&signature);
        let arguments: Vec<&str> = arguments.iter().map(|(name, _)| name.as_str()).collect();
        let call = |file: usize| {
            let own = own_name(name, self.files[file].stem());
            let call = format!("{own}({});", arguments.join(", "));
            match signature.contains("->") {
                true => format!("return {call}"),
                false => call,
            }
        };
        let of_set = |set: usize| {
            owners
                .iter()
                .copied()
                .find(|&file| self.files[file].sets.contains(&set))
        };
        let known: BTreeMap<usize, usize> = (0..self.sets.len())
            .filter_map(|set| Some((set, of_set(set)?)))
            .collect();
        let text = format!("{signature} {{\n{}}}\n", self.chosen(&known, 0, &call));
        Some(Item {
            name: name.to_owned(),
            text,
            first_line: 1,
        })
    }

    /// The call for these combinations of words and files, whose slots before the given one are known.
    fn chosen(
        &self,
        known: &BTreeMap<usize, usize>,
        slot: usize,
        call: &dyn Fn(usize) -> String,
    ) -> String {
        let files: BTreeSet<usize> = known.values().copied().collect();
        if files.len() == 1 {
            return format!("    {}\n", call(*files.first().expect("one")));
        }
        let words = self.slots[slot].words;
        let of_word = |word: &str| -> BTreeMap<usize, usize> {
            let known = known
                .iter()
                .filter(|(set, _)| self.sets[**set][slot] == word);
            known.map(|(&set, &file)| (set, file)).collect()
        };
        let cases: Vec<(usize, String)> = (0..)
            .zip(words)
            .map(|(value, word)| (value, of_word(word)))
            .filter(|(_, known)| !known.is_empty())
            .map(|(value, known)| (value, self.chosen(&known, slot + 1, call)))
            .collect();
        if cases.iter().all(|case| case.1 == cases[0].1) {
            return cases[0].1.clone();
        }
        let mut text = format!("    switch {} {{\n", self.slots[slot].constant());
        for (number, (value, inner)) in cases.iter().enumerate() {
            match number + 1 == cases.len() {
                true => text += "    default: {\n",
                false => text += &format!("    case {value}u: {{\n"),
            }
            text += inner;
            text += "    }\n";
        }
        text + "    }\n"
    }

    fn paths(&self, files: &[usize]) -> Vec<&str> {
        files
            .iter()
            .map(|&file| self.files[file].path.as_str())
            .collect()
    }

    fn text(&self) -> Source {
        let mut source = Source::default();
        for slot in self.slots {
            let id = id_of(slot.name);
            let line = format!("@id({id}) override {}: u32 = 0u;", slot.constant());
            source.push("(constants)", id, &line);
        }
        for file in &self.files {
            for item in &file.items {
                for (number, line) in (item.first_line..).zip(item.text.lines()) {
                    source.push(&file.path, number, line);
                }
            }
        }
        source
    }
}

/// The `SpecId` of a slot.
pub fn id_of(slot: &str) -> usize {
    let found = CONSTANTS.iter().position(|name| *name == slot);
    found.unwrap_or_else(|| panic!("`{slot}` stands in no list of constants"))
}

fn own_name(name: &str, stem: &str) -> String {
    match name.chars().next().is_some_and(char::is_uppercase) {
        true => format!("{name}Of_{stem}"),
        false => format!("{name}_of_{stem}"),
    }
}

/// Parameters of a signature: names and types.
fn parameters_of(signature: &str) -> Vec<(String, String)> {
    let from = signature.find('(').expect("a signature") + 1;
    let to = signature
        .rfind(") ->")
        .unwrap_or_else(|| signature.rfind(')').expect("a signature"));
    let mut depth = 0;
    let mut parameters = vec![String::new()];
    for c in signature[from..to].chars() {
        match c {
            '<' => depth += 1,
            '>' => depth -= 1,
            ',' if depth == 0 => {
                parameters.push(String::new());
                continue;
            }
            _ => {}
        }
        parameters.last_mut().expect("one").push(c);
    }
    let parted = parameters
        .iter()
        .filter_map(|parameter| parameter.split_once(':'));
    parted
        .map(|(name, ty)| (name.trim().to_owned(), ty.trim().to_owned()))
        .collect()
}

/// What callers must know of a signature.
fn types_of(signature: &str) -> (Vec<String>, String) {
    let types = parameters_of(signature)
        .into_iter()
        .map(|(_, ty)| ty)
        .collect();
    let made = signature.rsplit_once("->").map_or("", |(_, made)| made);
    (types, made.trim().to_owned())
}

/// Where a name stands in a text as a whole word, and not as a member.
fn places<'t>(text: &'t str, name: &'t str) -> impl Iterator<Item = usize> + 't {
    text.match_indices(name)
        .map(|(at, _)| at)
        .filter(move |&at| {
            let before = text[..at].chars().next_back();
            let after = text[at + name.len()..].chars().next();
            // Variables may be called as functions are.
            let is_call = name.starts_with(char::is_uppercase) || after == Some('(');
            !before.is_some_and(|c| is_of_name(c) || c == '.')
                && !after.is_some_and(is_of_name)
                && is_call
        })
}

fn mentions(code: &str, name: &str) -> bool {
    places(code, name).next().is_some()
}

fn renamed(text: &str, name: &str, own: &str) -> String {
    let mut made = String::new();
    let mut from = 0;
    for at in places(text, name) {
        made += &text[from..at];
        made += own;
        from = at + name.len();
    }
    made + &text[from..]
}
