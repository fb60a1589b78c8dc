//! Runs the program with a limit of its address space, and measures what it took.

use std::{
    fs::File,
    os::unix::process::ExitStatusExt,
    path::Path,
    process::{Command, ExitStatus, Stdio},
    time::{Duration, Instant},
};

/// How the program ended.
#[derive(Debug)]
pub struct Ended {
    /// `None` where a signal ended it.
    pub code: Option<i32>,
    pub err: String,
    /// Largest resident set. Between fork and exec a child has that of its parent: the test itself stays small.
    pub peak_bytes: u64,
    pub took: Duration,
}

/// Runs the program in `folder` with words separated by spaces.
#[expect(
    clippy::zombie_processes,
    reason = "`wait` waits for it, and gives what it took"
)]
pub fn run(folder: &Path, words: &str, address_space_kib: u64) -> Ended {
    let program = env!("CARGO_BIN_EXE_stratavox");
    let errors = tempfile::NamedTempFile::new().expect("a file");
    let begun = Instant::now();
    let child = Command::new("sh")
        .arg("-c")
        .arg(format!(
            "ulimit -v {address_space_kib} && ulimit -t 60 && exec {program} {words}"
        ))
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(File::create(errors.path()).expect("a file"))
        .spawn()
        .expect("a shell");
    let (status, usage) = wait(child.id());
    let took = begun.elapsed();
    Ended {
        code: status.code(),
        err: String::from_utf8_lossy(&std::fs::read(errors.path()).expect("a file")).into_owned(),
        peak_bytes: usage.ru_maxrss as u64 * 1024,
        took,
    }
}

/// Waits for a child that nobody else waits for.
fn wait(id: u32) -> (ExitStatus, libc::rusage) {
    let mut status = 0;
    // SAFETY: `rusage` is numbers, and zero is a value of each.
    let mut usage: libc::rusage = unsafe { std::mem::zeroed() };
    // SAFETY: both pointers are to values of this function, which outlive the call.
    let ended = unsafe { libc::wait4(id as i32, &mut status, 0, &mut usage) };
    assert_eq!(ended, id as i32, "{}", std::io::Error::last_os_error());
    (ExitStatus::from_raw(status), usage)
}
