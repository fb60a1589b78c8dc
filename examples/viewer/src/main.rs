//! A window on a volume: the model of a host that draws through [`stratavox::embed`].
//!
//! ```text
//! words      the command line                    subject    the volume, and what its values look like
//! app        winit: events in, frames out        look, eye  how it is shown, and from where (fit: at first)
//! host       instance, device, queue             view       all of that, and what a person is told
//! swapchain  images of the window                panel      egui: what is laid out and what a hand does
//! frames     frames in flight, fences            curve      the transfer function under the hand
//! drawing    stratavox, into an image of ours    reader     times of a series, on another thread
//! painter    that image and egui's triangles     script     a hand for tests;  shot  pictures into files
//! marks      words and scales in the picture
//! ```
//!
//! A frame, in `window/mod.rs`: egui lays it out; what it changed goes to the renderer (`set_function`, `set_settings`,
//! `set_volume`, `resize`, or another renderer where pipelines or textures are others); the volume is drawn where
//! anything of its picture changed; the window shows that picture, and the panel beside it.

mod app;
mod curve;
mod drawing;
mod error;
mod eye;
mod fit;
mod frames;
mod host;
mod keys;
mod look;
mod marks;
mod painter;
mod panel;
mod reader;
mod resting;
mod script;
mod shot;
mod subject;
mod swapchain;
mod view;
mod window;
mod words;

use clap::{Parser, ValueEnum};
use error::Error;
use std::process::ExitCode;
use words::{Arguments, Layer};

fn main() -> ExitCode {
    match run(Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("stratavox-viewer: {error}");
            let mut cause = std::error::Error::source(&error);
            while let Some(because) = cause {
                eprintln!("  because: {because}");
                cause = because.source();
            }
            ExitCode::from(error.exit_code())
        }
    }
}

fn run(mut words: Arguments) -> Result<(), Error> {
    if words.validation.is_none() {
        words.validation = layer_of_environment()?;
    }
    app::run(words)
}

fn layer_of_environment() -> Result<Option<Layer>, Error> {
    let variable = stratavox::gpu::VALIDATION_VARIABLE;
    let Some(word) = std::env::var_os(variable).filter(|word| !word.is_empty()) else {
        return Ok(None);
    };
    let layer = word
        .to_str()
        .and_then(|word| Layer::from_str(word, false).ok());
    let wrong = || Error::Arguments(format!("{variable} is {word:?}, wanted core or sync"));
    layer.map(Some).ok_or_else(wrong)
}
