//! The `stratavox` program.

use std::process::ExitCode;
use stratavox::cli::{self, Source};

/// Here and not in the library: a new commit links the program anew and compiles nothing else.
const SOURCE: Source = Source {
    commit: match option_env!("STRATAVOX_COMMIT") {
        Some(told) if !told.is_empty() => Some(told),
        _ => option_env!("STRATAVOX_PACKAGED_COMMIT"),
    },
    cargo_lock: include_str!("../Cargo.lock"),
};

fn main() -> ExitCode {
    ExitCode::from(cli::run(std::env::args_os(), SOURCE))
}
