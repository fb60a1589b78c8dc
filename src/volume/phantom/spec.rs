//! The words of `phantom:NAME[,key=value]...`.

use crate::volume::{Problem, VoxelType};
use std::ops::RangeInclusive;

/// Every phantom.
pub const NAMES: [&str; 9] = [
    "sphere",
    "gauss",
    "marschner-lobb",
    "fog",
    "shells",
    "storm",
    "flow",
    "cells",
    "head",
];

/// A name, checked, and words that have not been looked at yet.
pub(super) struct Spec<'a> {
    pub name: &'static str,
    words: Vec<(&'a str, &'a str)>,
}

impl<'a> Spec<'a> {
    /// `text` with or without `phantom:` in front.
    pub fn parse(text: &'a str) -> Result<Self, Problem> {
        let text = text.strip_prefix("phantom:").unwrap_or(text);
        let mut parts = text.split(',');
        let wanted_name = parts.next().unwrap_or_default().trim();
        let name = NAMES.into_iter().find(|&name| name == wanted_name);
        let name = name.ok_or_else(|| invalid("name", one_of(&NAMES), wanted_name))?;
        let mut words: Vec<(&str, &str)> = Vec::new();
        for part in parts {
            let (key, value) = part
                .split_once('=')
                .ok_or_else(|| invalid(name, "words such as n=128".into(), part))?;
            let key = key.trim();
            if words.iter().any(|&(before, _)| before == key) {
                return Err(invalid(key, "the word once".into(), part));
            }
            words.push((key, value.trim()));
        }
        Ok(Self { name, words })
    }

    /// A whole number.
    pub fn count(
        &mut self,
        key: &str,
        allowed: RangeInclusive<u32>,
        default: u32,
    ) -> Result<u32, Problem> {
        let Some(text) = self.take(key) else {
            return Ok(default);
        };
        let wanted = || {
            format!(
                "a whole number from {} to {}",
                allowed.start(),
                allowed.end()
            )
        };
        let number = text.parse().ok().filter(|n| allowed.contains(n));
        number.ok_or_else(|| invalid(key, wanted(), text))
    }

    /// A length that is not negative.
    pub fn length(&mut self, key: &str, default: f64) -> Result<f64, Problem> {
        let Some(text) = self.take(key) else {
            return Ok(default);
        };
        let length = text
            .parse()
            .ok()
            .filter(|x: &f64| x.is_finite() && *x >= 0.0);
        length.ok_or_else(|| invalid(key, "a length of 0 or more".into(), text))
    }

    /// One of some words, the first by default, as its index.
    pub fn choice(&mut self, key: &str, choices: &[&str]) -> Result<usize, Problem> {
        let Some(text) = self.take(key) else {
            return Ok(0);
        };
        let index = choices.iter().position(|&choice| choice == text);
        index.ok_or_else(|| invalid(key, one_of(choices), text))
    }

    /// The type of the stored numbers.
    pub fn voxel_type(&mut self, default: VoxelType) -> Result<VoxelType, Problem> {
        let others = [VoxelType::U8, VoxelType::U16, VoxelType::F32];
        let others = others.into_iter().filter(|&other| other != default);
        let types: Vec<_> = std::iter::once(default).chain(others).collect();
        let names: Vec<_> = types.iter().map(|kind| kind.name()).collect();
        Ok(types[self.choice("type", &names)?])
    }

    /// An error where a word was not asked for.
    pub fn finish(self, known: &[&str]) -> Result<(), Problem> {
        match self.words.first() {
            None => Ok(()),
            Some((key, _)) => Err(invalid(key, one_of(known), key)),
        }
    }

    fn take(&mut self, key: &str) -> Option<&'a str> {
        let index = self.words.iter().position(|&(word, _)| word == key)?;
        Some(self.words.remove(index).1)
    }
}

fn one_of(words: &[&str]) -> String {
    format!("one of {}", words.join(", "))
}

fn invalid(field: &str, wanted: String, found: &str) -> Problem {
    Problem::Invalid {
        format: "phantom",
        field: field.escape_debug().to_string(),
        wanted,
        found: format!("`{}`", found.escape_debug()),
    }
}
