//! `stratavox view`: starts the viewer, which is a program of its own because it opens windows.

use super::Error;
use clap::Args;
use std::ffi::OsString;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::Command;

/// Look at a volume in a window, with the program stratavox-viewer
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  stratavox view FILE\n\n\
    The viewer is looked for beside this program, then in PATH.")]
pub struct View {
    /// What the viewer takes: a volume, and flags; `stratavox view --help` of the viewer is `stratavox-viewer --help`
    #[arg(
        value_name = "INPUT",
        required = true,
        trailing_var_arg = true,
        allow_hyphen_values = true
    )]
    words: Vec<OsString>,
}

/// The name of the program.
const VIEWER: &str = "stratavox-viewer";

impl View {
    /// Runs the viewer until its window is closed.
    pub fn run(self) -> Result<(), Error> {
        let status = Command::new(program()).args(&self.words).status();
        match status {
            Ok(status) if status.success() => Ok(()),
            // It has said what was wrong.
            Ok(status) => Err(Error::Other(status.code().unwrap_or(1) as u8)),
            Err(cause) if cause.kind() == ErrorKind::NotFound => Err(Error::usage(
                format!("{VIEWER} is not installed: it is neither beside this program nor in PATH"),
                "cargo install --path examples/viewer, in a checkout, installs it",
            )),
            Err(cause) => Err(Error::Input {
                path: program(),
                problem: cause.to_string(),
            }),
        }
    }
}

/// The viewer beside this program, else by its name in PATH.
fn program() -> PathBuf {
    let name = format!("{VIEWER}{}", std::env::consts::EXE_SUFFIX);
    let here = std::env::current_exe().ok();
    let beside = here.and_then(|path| Some(path.parent()?.join(&name)));
    beside
        .filter(|path| path.is_file())
        .unwrap_or_else(|| name.into())
}
