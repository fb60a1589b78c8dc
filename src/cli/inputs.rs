//! The words of the command line to the volumes that they mean.

use crate::{
    cli::{Error, error::visible, flags::InputFlags},
    format::{self, Search},
};
use std::{
    collections::HashSet,
    path::{Path, PathBuf},
};

/// Volumes, each once, and how much was passed over.
#[derive(Debug, Default)]
pub struct Inputs {
    /// Words as `render` takes them.
    pub volumes: Vec<String>,
    /// Files in folders that are none.
    pub left_alone: usize,
    /// Volumes in folders that cannot be named.
    pub failures: Vec<Error>,
}

impl Inputs {
    /// What these words mean: folders that are no volumes are looked into.
    pub fn find(words: &[String], flags: &InputFlags, recursive: bool) -> Result<Self, Error> {
        let limits = flags.limits();
        let search = Search {
            recursive,
            with_raw: flags.raw.is_some(),
        };
        let mut inputs = Self::default();
        let mut known = HashSet::new();
        for word in words {
            let path = Path::new(word);
            let is_file = InputFlags {
                path: Some(word.clone()),
                ..InputFlags::default()
            }
            .file()
            .is_some();
            if !is_file || !path.is_dir() {
                inputs.add(word.clone(), &mut known);
                continue;
            }
            let found = format::find(path, search, &limits)?;
            inputs.left_alone += found.left_alone;
            if found.volumes.is_empty() {
                inputs.failures.push(Error::Input {
                    path: path.to_owned(),
                    problem: format!(
                        "the folder holds no volume, and {} files and folders that are none",
                        found.left_alone
                    ),
                });
            }
            for volume in found.volumes {
                let Some(text) = volume.to_str() else {
                    inputs.failures.push(Error::Input {
                        path: volume,
                        problem: "its name is not UTF-8".to_owned(),
                    });
                    continue;
                };
                inputs.add(text.to_owned(), &mut known);
            }
        }
        match inputs.volumes.is_empty() && !inputs.failures.is_empty() {
            true => Err(inputs.failures.swap_remove(0)),
            false => Ok(inputs),
        }
    }

    /// Sentences about what was passed over, where something was.
    pub fn notes(&self) -> Vec<String> {
        let n = self.left_alone;
        let others =
            (n > 0).then(|| format!("{n} files and folders that are no volume are left alone"));
        let failures = self
            .failures
            .iter()
            .map(|error| visible(&format!("left out: {error}")));
        others.into_iter().chain(failures).collect()
    }

    /// The same file under two names is one volume.
    fn add(&mut self, word: String, known: &mut HashSet<PathBuf>) {
        let place = Path::new(&word).canonicalize();
        if known.insert(place.unwrap_or_else(|_| PathBuf::from(&word))) {
            self.volumes.push(word);
        }
    }
}
