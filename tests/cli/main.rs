//! The program as a person meets it: words, exit codes, files.
#![cfg(feature = "cli")]

mod convert;
mod device;
mod errors;
#[cfg(unix)]
mod interrupt;
mod memory;
mod mixed;
mod person;
mod pictures;
mod real;
mod sheet;
mod words;
