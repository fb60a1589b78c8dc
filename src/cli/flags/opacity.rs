//! What is opaque by another number than the one that is coloured: the words.

use super::{Component, Error, InputFlags, Numbers, input::PHANTOM};
use clap::Args;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

const HEADING: &str = "Opacity from other numbers";

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OpacityFlags {
    /// Another variable of INPUT that says how opaque each place is; INPUT's own variable says the colour
    #[arg(long, value_name = "NAME", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opacity_variable: Option<String>,
    /// Another number of each voxel that says how opaque it is, counted from 0
    #[arg(long, value_name = "N", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opacity_component: Option<u32>,
    /// Another file that says how opaque each place is, on a grid of its own if need be
    #[arg(long, value_name = "FILE", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opacity_from: Option<PathBuf>,
    /// The values of those numbers that their opacity is spread over [default: by the values; --opacity-tf says more]
    #[arg(
        long,
        value_name = "LO,HI",
        allow_hyphen_values = true,
        help_heading = HEADING
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opacity_window: Option<Numbers<2>>,
}

impl OpacityFlags {
    /// True where words name other numbers.
    pub fn are_given(&self) -> bool {
        self.opacity_variable.is_some()
            || self.opacity_component.is_some()
            || self.opacity_from.is_some()
    }

    /// The first word that was given.
    pub fn word(&self) -> &'static str {
        if self.opacity_from.is_some() {
            "--opacity-from"
        } else if self.opacity_variable.is_some() {
            "--opacity-variable"
        } else {
            "--opacity-component"
        }
    }

    /// A window alone says nothing.
    pub fn check(&self) -> Result<(), Error> {
        if self.opacity_window.is_some() && !self.are_given() {
            return Err(Error::usage(
                "--opacity-window is for the numbers of --opacity-variable, --opacity-component or --opacity-from",
                "--window LO,HI is for the numbers of INPUT",
            ));
        }
        Ok(())
    }

    /// The words that name the other numbers, beside those of the volume that is coloured.
    pub fn input(&self, colored: &InputFlags) -> InputFlags {
        let component = self.opacity_component.map(Component::Number);
        let variable = self.opacity_variable.clone();
        match &self.opacity_from {
            None => InputFlags {
                variable: variable.or(colored.variable.clone()),
                component: component.or(colored.component),
                ..colored.clone()
            },
            // What picks a volume in one file means nothing in another one, but for the time.
            Some(file) => InputFlags {
                path: Some(file.to_string_lossy().into_owned()),
                variable,
                component,
                raw: None,
                series: None,
                ..colored.clone()
            },
        }
    }

    /// The other file, where it is one.
    pub fn file(&self) -> Option<&Path> {
        let is_file = |path: &&Path| !path.to_string_lossy().starts_with(PHANTOM);
        self.opacity_from.as_deref().filter(is_file)
    }

    /// The same words with another path.
    pub fn with_paths(&self, path: impl Fn(&Path) -> PathBuf) -> Self {
        Self {
            opacity_from: self.file().map(path).or(self.opacity_from.clone()),
            ..self.clone()
        }
    }
}
