//! `stratavox completions` and `stratavox man`: what a shell and a manual know of the words.

use super::{
    Error,
    output::{self, say, write_whole},
    signals::Gate,
};
use clap::{Args, Command};
use clap_complete::Shell;
use std::path::PathBuf;

const NAME: &str = "stratavox";

/// Print what a shell needs to complete the words of this program
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  stratavox completions bash")]
pub struct Completions {
    /// The shell
    #[arg(value_enum, value_name = "SHELL")]
    shell: Shell,
}

impl Completions {
    /// Prints the script.
    pub fn run(self, mut words: Command) -> Result<(), Error> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut words, NAME, &mut script);
        say(&String::from_utf8_lossy(&script))
    }
}

/// Print the manual page of this program, or write those of all verbs
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  stratavox man\n  stratavox man -o .")]
pub struct Man {
    /// Write stratavox.1 and a page for each verb into this folder
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long, requires = "output")]
    force: bool,
}

impl Man {
    /// Prints or writes.
    pub fn run(self, words: Command, gate: &Gate) -> Result<(), Error> {
        let mut words = words;
        words.build();
        let Some(folder) = self.output else {
            return say(&String::from_utf8_lossy(&page(words)));
        };
        let mut pages = vec![(folder.join(format!("{NAME}.1")), page(words.clone()))];
        for verb in words.get_subcommands() {
            add_pages(&folder, NAME, verb, &mut pages);
        }
        let paths: Vec<PathBuf> = pages.iter().map(|(path, _)| path.clone()).collect();
        output::check(&paths, &[], self.force)?;
        for (path, page) in pages {
            write_whole(&path, &page, self.force, gate)?;
        }
        Ok(())
    }
}

/// The page of a verb and those of the verbs below it, named as manuals are: `stratavox-preset-show.1`.
fn add_pages(
    folder: &std::path::Path,
    above: &str,
    verb: &Command,
    pages: &mut Vec<(PathBuf, Vec<u8>)>,
) {
    if verb.get_name() == "help" {
        return;
    }
    let name = format!("{above}-{}", verb.get_name());
    let named = verb.clone().name(name.clone()).display_name(name.clone());
    pages.push((folder.join(format!("{name}.1")), page(named)));
    for below in verb.get_subcommands() {
        add_pages(folder, &name, below, pages);
    }
}

fn page(words: Command) -> Vec<u8> {
    let mut page = Vec::new();
    let written = clap_mangen::Man::new(words).render(&mut page);
    written.expect("a vector takes what is written");
    page
}
