//! The program as a person meets it: words, exit codes, files.
#![cfg(feature = "cli")]

mod device;
mod errors;
mod examples;
mod figures;
mod info;
#[cfg(unix)]
mod interrupt;
mod manuals;
mod person;
mod pictures;
mod presets;
mod real;
mod words;
