//! Verbs that are promised and not built yet: known, and refused by name.

use super::Error;
use clap::{Args, Subcommand};

/// The verbs, with whatever words follow them.
#[derive(Debug, Subcommand)]
pub enum Later {
    /// Not built yet: a device tested against exact answers
    #[command(after_help = DEVICES)]
    Conformance(Rest),
}

const DEVICES: &str = "Example of what is there:\n  stratavox devices";

/// Any words.
#[derive(Args, Debug)]
pub struct Rest {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    _words: Vec<String>,
}

impl Later {
    /// Says which verb is not built.
    pub fn refuse(&self) -> Result<(), Error> {
        let name = match self {
            Self::Conformance(_) => "conformance",
        };
        Err(Error::NotBuilt(format!("`stratavox {name}`")))
    }
}
