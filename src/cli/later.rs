//! Verbs that are promised and not built yet: known, and refused by name.

use super::Error;
use clap::{Args, Subcommand};

/// The verbs, with whatever words follow them.
#[derive(Debug, Subcommand)]
pub enum Later {
    /// Not built yet: the histogram of a volume
    #[command(after_help = INFO)]
    Histogram(Rest),
    /// Not built yet: a volume in another format
    #[command(after_help = INFO)]
    Convert(Rest),
    /// Not built yet: a device tested against exact answers
    #[command(after_help = DEVICES)]
    Conformance(Rest),
    /// Not built yet: transfer functions of ours and of other programs
    #[command(after_help = PRESET)]
    Preset(Rest),
}

const INFO: &str = "Example of what is there:\n  stratavox info phantom:head --json";
const DEVICES: &str = "Example of what is there:\n  stratavox devices";
const PRESET: &str =
    "Example of what is there:\n  stratavox render phantom:head --preset ct-bone -o head.png";

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
            Self::Histogram(_) => "histogram",
            Self::Convert(_) => "convert",
            Self::Conformance(_) => "conformance",
            Self::Preset(_) => "preset",
        };
        Err(Error::NotBuilt(format!("`stratavox {name}`")))
    }
}
