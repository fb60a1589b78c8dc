//! `stratavox conformance`: whether a device conforms.

mod cases;
mod check;
mod hearing;
mod outputs;
mod run;
mod summary;
mod words;

use super::{Error, Source, signals::Gate};
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// Ask a device for pictures with exact answers, and judge it
#[derive(Args, Debug)]
#[command(args_conflicts_with_subcommands = true)]
#[command(after_help = "Examples:\n  \
    stratavox conformance --filter 'probe.math.*' --json math.json --junit math.xml --html math\n  \
    stratavox conformance diff FILE OTHER\n  \
    stratavox conformance --profile full --json FILE\n  \
    stratavox conformance --filter probe.math.exp --in-process --repeat 10\n  \
    stratavox conformance verify FILE")]
pub struct Conformance {
    #[command(subcommand)]
    verb: Option<Verb>,
    #[command(flatten)]
    run: run::Run,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Check that a package is a whole and unchanged run of its profile without a failure
    #[command(
        after_help = "Example:\n  stratavox conformance --filter probe.math.exp --json a && stratavox conformance verify --partial a"
    )]
    Verify {
        /// Of what a filter or a shard was asked for: whole as far as it goes
        #[arg(long)]
        partial: bool,
        /// What `--json` has written
        package: PathBuf,
    },
    /// Compare the packages of two runs or two drivers
    #[command(
        after_help = "Example:\n  stratavox conformance --filter probe.math.exp --json a && stratavox conformance diff a a"
    )]
    Diff {
        /// What `--json` has written
        a: PathBuf,
        /// The same of another run
        b: PathBuf,
    },
}

impl Conformance {
    /// Runs, verifies or compares.
    pub fn run(self, source: Source, gate: &Gate) -> Result<(), Error> {
        match self.verb {
            None => self.run.run(source, gate),
            Some(Verb::Verify { partial, package }) => check::verify(&package, partial),
            Some(Verb::Diff { a, b }) => check::diff(&a, &b),
        }
    }
}
