//! The `stratavox` program: words to scenes, errors to exit codes.
//!
//! ```text
//! words -> one struct a verb (clap) -> flags laid over a scene file -> checked once -> the library
//! ```
//!
//! One file a verb; `flags` holds what verbs share. Everything that can be refused is refused before the
//! first voxel is read: words, outputs that exist, folders that do not.

mod animate;
mod annotation;
mod bench;
mod bug;
mod cameras_file;
mod compare;
mod conformance;
mod convert;
mod devices;
mod error;
mod exaggerate;
mod flags;
mod flow;
mod ground;
mod help;
mod histogram;
mod info;
mod inputs;
mod intermediate;
mod kept_samples;
mod labels;
mod line;
mod load;
mod look;
mod manuals;
mod map;
mod memory;
mod output;
mod planes;
mod preset;
mod progress;
mod readable;
mod reasons;
mod registration;
mod render;
mod renderer;
mod resume_check;
mod sample_limit;
mod scene_file;
mod scene_inputs;
mod shape;
mod sheet;
mod show;
mod signals;
mod small_file;
mod stdin;
mod surface;
mod technique_hints;
mod thumbnails;
mod timings;
mod unfinished;
mod untrusted;
mod view;

pub use bug::guarded;
pub use error::Error;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use signals::Gate;
use std::ffi::OsString;
use std::path::Path;

/// Volume rendering on Vulkan: texture slicing, ray casting, maximum intensity projection
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true, max_term_width = 100)]
#[command(
    override_usage = "stratavox FILE [OPTIONS], as render draws it, or stratavox <COMMAND> [OPTIONS]"
)]
#[command(
    after_help = "Examples:\n  stratavox phantom:head\n  stratavox render phantom:head -o left.png --view left"
)]
struct Arguments {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Render(Box<render::Render>),
    Animate(Box<animate::Animate>),
    Thumbnails(Box<thumbnails::Thumbnails>),
    Info(Box<info::Info>),
    Convert(Box<convert::Convert>),
    Devices(devices::Devices),
    Compare(compare::Compare),
    Bench(Box<bench::Bench>),
    Sheet(sheet::Sheet),
    Histogram(Box<histogram::HistogramVerb>),
    Preset(preset::PresetVerb),
    Completions(manuals::Completions),
    Man(manuals::Man),
    View(view::View),
    Conformance(Box<conformance::Conformance>),
    #[cfg(target_os = "linux")]
    #[command(hide = true, name = untrusted::VERB)]
    ReadUntrusted(untrusted::ReadUntrusted),
}

/// What the program was built from.
#[derive(Clone, Copy, Debug)]
pub struct Source {
    /// The commit, where the build was told: as of `git describe --always --dirty --abbrev=40`.
    pub commit: Option<&'static str>,
    /// The text of `Cargo.lock`.
    pub cargo_lock: &'static str,
}

/// Runs the program with these words (the first is its own name) and gives its exit code.
///
/// Installs a panic hook and signal handlers: it is for a process of its own.
pub fn run(words: impl IntoIterator<Item = OsString>, source: Source) -> u8 {
    let gate = Gate::default();
    let words: Vec<OsString> = words.into_iter().collect();
    guarded(move || {
        signals::install(&gate);
        let done = obey(with_verb(words), source, &gate);
        stdin::discard();
        match done {
            Ok(()) => 0,
            Err(error) => {
                // Where stderr is closed the exit code has to do.
                let _ = std::io::Write::write_all(&mut std::io::stderr(), error.lines().as_bytes());
                error.exit_code()
            }
        }
    })
}

/// `stratavox scan.nii.gz` is `stratavox render scan.nii.gz`. A verb wins over a file of its name.
fn with_verb(mut words: Vec<OsString>) -> Vec<OsString> {
    let Some(first) = words.get(1) else {
        return words;
    };
    let is_verb = |name: &str| {
        let command = Arguments::command();
        name == "help"
            || command
                .get_subcommands()
                .any(|verb| verb.get_name() == name)
    };
    let text = first.to_string_lossy();
    // What looks like a path and is not there is a missing file, no verb that is spelt wrongly.
    let is_path = || text.contains(['.', '/', '\\']) || Path::new(first).exists();
    let is_input = text == stdin::STANDARD
        || text.starts_with(flags::PHANTOM)
        || !text.starts_with('-') && is_path();
    if is_input && !is_verb(&text) {
        words.insert(1, "render".into());
    }
    words
}

fn obey(words: Vec<OsString>, source: Source, gate: &Gate) -> Result<(), Error> {
    let matches = help::command().try_get_matches_from(words);
    let words = match matches.and_then(|matches| Arguments::from_arg_matches(&matches)) {
        Ok(words) => words,
        // Help and version are answers, not errors.
        Err(answer) if !answer.use_stderr() => return output::say(&answer.render().to_string()),
        Err(error) => return Err(Error::Arguments(with_hint(&error))),
    };
    match words.verb {
        Verb::Render(render) => render.run(gate),
        Verb::Animate(animate) => animate.run(gate),
        Verb::Thumbnails(thumbnails) => thumbnails.run(gate),
        Verb::Info(info) => info.run(),
        Verb::Convert(convert) => convert.run(gate),
        Verb::Devices(devices) => devices.run(),
        Verb::Compare(compare) => compare.run(gate),
        Verb::Bench(bench) => bench.run(gate),
        Verb::Sheet(sheet) => sheet.run(gate),
        Verb::Histogram(histogram) => histogram.run(gate),
        Verb::Preset(preset) => preset.run(gate),
        Verb::Completions(completions) => completions.run(help::command()),
        Verb::Man(man) => man.run(help::command(), gate),
        Verb::View(view) => view.run(),
        Verb::Conformance(conformance) => conformance.run(source, gate),
        #[cfg(target_os = "linux")]
        Verb::ReadUntrusted(reader) => reader.run(),
    }
}

/// What clap says of words that it cannot follow, with a hint as all other errors have it.
fn with_hint(error: &clap::Error) -> String {
    let text = error.render().to_string();
    // Its own last line names help without saying of which verb.
    let end = text.find("\nFor more information").unwrap_or(text.len());
    let verb = std::env::args_os().nth(1).filter(|word| {
        let word = word.to_string_lossy();
        let command = Arguments::command();
        command
            .get_subcommands()
            .any(|verb| verb.get_name() == word)
    });
    let verb = verb.map_or_else(String::new, |verb| format!("{} ", verb.to_string_lossy()));
    format!(
        "{}\n  hint: `stratavox {verb}--help` shows examples and lists every flag\n",
        text[..end].trim_end()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_are_put_together_without_contradiction() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn every_verb_shows_an_example_in_its_help() {
        for verb in Arguments::command().get_subcommands() {
            let help = verb.clone().render_long_help().to_string();
            assert!(help.contains("Example"), "{}: {help}", verb.get_name());
            assert!(help.contains("stratavox "), "{}: {help}", verb.get_name());
        }
    }
}
