//! Words that choose cases, and the files that they name.

use super::super::{Error, output::say_aside, small_file::parsed};
use super::words::{ProfileWord, shard};
use crate::conformance::case::Case;
use crate::conformance::selection::{Selection, lines, unmatched};
use clap::Args;
use std::path::{Path, PathBuf};

/// Names of 80 characters of a hundred times as many cases as there are.
const MOST_BYTES: u64 = 32 << 20;

/// Which cases.
#[derive(Args, Debug)]
pub struct Cases {
    /// Cases by name: * for any characters, ? for one, | between patterns
    #[arg(long, value_name = "GLOB", default_value = "*")]
    filter: String,
    /// Names or patterns, one a line and nothing behind #: the cases run in their order
    #[arg(long, value_name = "FILE")]
    caselist: Option<PathBuf>,
    /// Names or patterns of cases that do not run, in the same form
    #[arg(long, value_name = "FILE")]
    exclude: Option<PathBuf>,
    /// Which list
    #[arg(long, value_enum, default_value_t)]
    profile: ProfileWord,
    /// One part of the cases: 2/4 is the second of four
    #[arg(long, value_name = "I/N", value_parser = shard, default_value = "1/1")]
    shard: [u32; 2],
}

impl Cases {
    /// The files that are read.
    pub fn inputs(&self) -> impl Iterator<Item = &PathBuf> {
        self.caselist.iter().chain(&self.exclude)
    }

    /// What the words and their files choose.
    ///
    /// # Errors
    /// A file that cannot be read; a line of the case list that means no case.
    pub fn selection(&self, list: &[Case]) -> Result<Selection, Error> {
        let profile = self.profile.into();
        let caselist = self.caselist.as_deref().map(read).transpose()?;
        if let (Some(path), Some(text)) = (&self.caselist, &caselist) {
            let wrong = |problem| Error::Input {
                path: path.clone(),
                problem,
            };
            let lines = lines(text);
            if lines.is_empty() {
                return Err(wrong("it names no case".to_owned()));
            }
            if let Some((number, problem)) = unmatched(&lines, list, profile).first() {
                return Err(wrong(format!("line {number}: {problem}")));
            }
        }
        let exclude = self.exclude.as_deref().map(read).transpose()?;
        if let (Some(path), Some(text)) = (&self.exclude, &exclude) {
            for (number, problem) in unmatched(&lines(text), list, profile) {
                say_aside(&format!(
                    "note: {}, line {number}: {problem}",
                    path.display()
                ));
            }
        }
        let bare = |text: Option<String>| {
            let text = text.unwrap_or_default();
            let lines = lines(&text).into_iter();
            lines.map(|(_, line)| line.to_owned()).collect()
        };
        Ok(Selection {
            profile,
            filter: self.filter.clone(),
            caselist: bare(caselist),
            exclude: bare(exclude),
            shard: self.shard,
        })
    }

    /// Where no case is left.
    pub fn none_left(&self) -> Error {
        let mut words = format!("--filter {}", self.filter);
        for (word, path) in [("--caselist", &self.caselist), ("--exclude", &self.exclude)] {
            if let Some(path) = path {
                words.push_str(&format!(" {word} {}", path.display()));
            }
        }
        Error::usage(
            format!("{words}: no case of this profile and shard has such a name"),
            "`stratavox conformance --list` says their names",
        )
    }
}

fn read(path: &Path) -> Result<String, Error> {
    parsed(path, "a list of cases", MOST_BYTES, |bytes| {
        let text = std::str::from_utf8(bytes).map_err(|_| "it is not UTF-8".to_owned())?;
        Ok(text.to_owned())
    })
}
