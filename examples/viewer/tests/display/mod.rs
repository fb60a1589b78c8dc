//! A display without a screen, and the viewer on it.
//!
//! Where there is no Xvfb nothing can be tested: that is said as `skipped: ...`, past the harness.

#![allow(dead_code, reason = "each test file uses its part")]

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

/// A display without a screen; dropping it ends it.
pub struct Display {
    server: Child,
    pub name: String,
}

impl Display {
    /// `None` where there is none to be had, which is said.
    pub fn new() -> Option<Self> {
        let mut command = Command::new("Xvfb");
        command.args([
            "-displayfd",
            "1",
            "-screen",
            "0",
            "1400x900x24",
            "-nolisten",
            "tcp",
        ]);
        let server = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let Ok(mut server) = server else {
            return skipped("there is no Xvfb");
        };
        let mut number = String::new();
        let told = BufReader::new(server.stdout.take()?).read_line(&mut number);
        assert!(told.is_ok_and(|bytes| bytes > 0), "Xvfb did not start");
        let name = format!(":{}", number.trim());
        Some(Self { server, name })
    }

    pub fn viewer(&self, folder: &Path) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stratavox-viewer"));
        command.current_dir(folder).env("DISPLAY", &self.name);
        command.env_remove("WAYLAND_DISPLAY");
        command
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        // It is gone already where it crashed.
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

#[allow(
    clippy::explicit_write,
    reason = "the harness keeps what `eprintln!` writes for itself"
)]
pub fn skipped<T>(why: &str) -> Option<T> {
    writeln!(std::io::stderr(), "skipped: {why}").unwrap();
    None
}

pub fn texts(output: &Output) -> String {
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    text(&output.stdout) + &text(&output.stderr)
}
