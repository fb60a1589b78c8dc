//! Runs the program as a person does and looks at what it leaves.

use std::{
    path::{Path, PathBuf},
    process::{Command, Output},
};

/// A folder for one test, gone at its end.
#[derive(Debug)]
pub struct Folder(tempfile::TempDir);

/// What the program did.
#[derive(Debug)]
pub struct Ran {
    /// Exit code.
    pub code: i32,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

impl Folder {
    /// An empty one.
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    /// A path inside.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// A file inside with this content.
    pub fn file(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, content).expect("a file");
        path
    }

    /// Names of what lies inside, in order.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).expect("a folder");
        let name = |entry: std::io::Result<std::fs::DirEntry>| {
            entry
                .expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        };
        let mut names: Vec<String> = entries.map(name).collect();
        names.sort();
        names
    }

    /// Runs the program in this folder with words separated by spaces.
    pub fn run(&self, words: &str) -> Ran {
        Ran::of(self.command(words).output().expect("the program runs"))
    }

    /// The program with words separated by spaces, not yet started.
    pub fn command(&self, words: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stratavox"));
        command
            .args(words.split_whitespace())
            .current_dir(self.0.path());
        command
    }
}

impl Ran {
    fn of(output: Output) -> Self {
        Self {
            code: output.status.code().unwrap_or(-1),
            out: String::from_utf8_lossy(&output.stdout).into_owned(),
            err: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }

    /// Fails unless the program said what is wrong with this exit code, in a few lines, and did not panic.
    #[track_caller]
    pub fn assert_refused(&self, code: i32, words: &[&str]) {
        assert_eq!(self.code, code, "{self:#?}");
        let lines = self.err.lines().count();
        assert!((1..=6).contains(&lines), "{lines} lines: {self:#?}");
        assert!(!self.err.contains("panicked"), "{self:#?}");
        for word in words {
            assert!(self.err.contains(word), "no {word:?}: {self:#?}");
        }
    }

    /// Fails unless the program did what it was asked.
    #[track_caller]
    pub fn assert_done(&self) {
        assert_eq!(self.code, 0, "{self:#?}");
    }
}

/// Fails unless `path` begins with these bytes.
#[track_caller]
pub fn assert_begins(path: &Path, wanted: &[u8]) {
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let found = &bytes[..wanted.len().min(bytes.len())];
    assert_eq!(found, wanted, "{}", path.display());
}
