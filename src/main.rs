//! The `stratavox` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(stratavox::cli::run(std::env::args_os()))
}
