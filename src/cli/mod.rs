//! The `stratavox` program: words to scenes, errors to exit codes.
//!
//! ```text
//! words -> one struct a verb (clap) -> flags laid over a scene file -> checked once -> the library
//! ```
//!
//! One file a verb; `flags` holds what verbs share. Everything that can be refused is refused before the
//! first voxel is read: words, outputs that exist, folders that do not.

mod animate;
mod bench;
mod bug;
mod cameras_file;
mod compare;
mod conformance;
mod convert;
mod devices;
mod error;
mod exaggerate;
mod figure;
mod flags;
mod histogram;
mod info;
mod labels;
mod line;
mod load;
mod manuals;
mod memory;
mod output;
mod preset;
mod progress;
mod readable;
mod reasons;
mod render;
mod renderer;
mod scene_file;
mod sheet;
mod shown;
mod signals;
mod small_file;
mod stamp;
mod surface;
mod thumbnails;
mod timings;
mod unfinished;
mod untrusted;

pub use bug::guarded;
pub use error::Error;

use clap::{CommandFactory, Parser, Subcommand};
use signals::Gate;
use std::ffi::OsString;

/// Volume rendering on Vulkan: texture slicing, ray casting, maximum intensity projection
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true, max_term_width = 100)]
#[command(after_help = "Example:\n  stratavox render phantom:head -o head.png")]
struct Words {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Render(Box<render::Render>),
    Animate(Box<animate::Animate>),
    Thumbnails(Box<thumbnails::Thumbnails>),
    Info(info::Info),
    Convert(convert::Convert),
    Devices(devices::Devices),
    Compare(compare::Compare),
    Bench(Box<bench::Bench>),
    Sheet(sheet::Sheet),
    Histogram(Box<histogram::HistogramVerb>),
    Preset(preset::PresetVerb),
    Completions(manuals::Completions),
    Man(manuals::Man),
    Conformance(Box<conformance::Conformance>),
    #[cfg(target_os = "linux")]
    #[command(hide = true)]
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
        match obey(words, source, &gate) {
            Ok(()) => 0,
            Err(error) => {
                // Where stderr is closed the exit code has to do.
                let _ = std::io::Write::write_all(&mut std::io::stderr(), error.lines().as_bytes());
                error.exit_code()
            }
        }
    })
}

fn obey(words: Vec<OsString>, source: Source, gate: &Gate) -> Result<(), Error> {
    let words = match Words::try_parse_from(words) {
        Ok(words) => words,
        // Help and version are answers, not errors.
        Err(answer) if !answer.use_stderr() => return output::say(&answer.render().to_string()),
        Err(error) => return Err(Error::Words(error.render().to_string())),
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
        Verb::Completions(completions) => completions.run(Words::command()),
        Verb::Man(man) => man.run(Words::command(), gate),
        Verb::Conformance(conformance) => conformance.run(source, gate),
        #[cfg(target_os = "linux")]
        Verb::ReadUntrusted(reader) => reader.run(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_are_put_together_without_contradiction() {
        Words::command().debug_assert();
    }

    #[test]
    fn every_verb_shows_an_example_in_its_help() {
        for verb in Words::command().get_subcommands() {
            let help = verb.clone().render_long_help().to_string();
            assert!(help.contains("Example"), "{}: {help}", verb.get_name());
            assert!(help.contains("stratavox "), "{}: {help}", verb.get_name());
        }
    }
}
