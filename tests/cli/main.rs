//! The program as a person meets it: words, exit codes, files.
#![cfg(feature = "cli")]

mod device;
mod errors;
#[cfg(unix)]
mod interrupt;
mod memory;
mod person;
mod pictures;
mod real;
mod sheet;
mod weather;
mod words;
