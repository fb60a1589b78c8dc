//! A file of bricks that is being written, and what is done of it: whoever was stopped goes on with `--resume`.
//!
//! ```text
//! .X.svb.unfinished   the bricks; no reader takes it for a whole file: its front is empty until all is there
//! .X.svb.journal      {"stratavox_bricks":1,"version":"0.1.0","conversion":{...}}, then a line of each row of bricks
//! ```
//!
//! A line is written behind its bricks, and nothing waits for the disk: what a loss of power has left of bricks is
//! found by their checksums, which are compared before anybody goes on.

use super::{Error, resume_check::difference, signals::Gate};
use crate::format::write::DoneBricks;
use serde_json::{Value, json};
use std::{
    ffi::OsString,
    fs::{self, File, OpenOptions, TryLockError},
    io::{self, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};

/// The file and its journal, open for more.
#[derive(Debug)]
pub struct Unfinished {
    output: PathBuf,
    /// The bricks.
    pub file: File,
    journal: File,
}

/// What is there of a run before.
struct Past {
    file: File,
    text: String,
}

impl Unfinished {
    /// What will be `output`, of the conversion that `conversion` describes in full, and what is done of it.
    pub fn open(
        output: &Path,
        conversion: Value,
        resume: bool,
        force: bool,
    ) -> Result<(Self, DoneBricks), Error> {
        let head = json!({
            "stratavox_bricks": 1,
            "version": env!("CARGO_PKG_VERSION"),
            "conversion": conversion,
        });
        if let Some(past) = Past::find(output)? {
            let is_begun = past.rows().next().is_some();
            let other = past.head().and_then(|was| difference("", &was, &head));
            match other {
                None if resume => return past.taken_over(output),
                Some(why) if resume && !force => {
                    return Err(Error::usage(
                        format!("--resume: {why}"),
                        "the words and the input of the first run go on with it; --force begins anew",
                    ));
                }
                _ if is_begun && !force => {
                    return Err(Error::Output {
                        path: output.to_owned(),
                        problem: "an unfinished conversion is there".to_owned(),
                        hint: Some("--resume goes on with it, --force begins anew"),
                    });
                }
                _ => {}
            }
        }
        let failed = |cause: io::Error| Error::output(output, &cause);
        Self::remove(output);
        let new = |path: PathBuf| {
            let mut options = OpenOptions::new();
            options.read(true).write(true).create_new(true).open(path)
        };
        let mut journal = new(journal_of(output)).map_err(failed)?;
        journal
            .write_all(format!("{head}\n").as_bytes())
            .map_err(failed)?;
        let file = new(part_of(output)).map_err(failed)?;
        lock(&file, output)?;
        let output = output.to_owned();
        let unfinished = Self {
            output,
            file,
            journal,
        };
        Ok((unfinished, DoneBricks::default()))
    }

    /// The file, and who notes what is done of it.
    pub fn parts(&mut self) -> (&mut File, impl FnMut(&str) -> io::Result<()>) {
        let journal = &mut self.journal;
        let note = |line: &str| journal.write_all(format!("{line}\n").as_bytes());
        (&mut self.file, note)
    }

    /// What to say of a file that stays unfinished.
    pub fn hint(&self) -> String {
        format!(
            "what is done of {} is kept beside it: the same words and --resume go on",
            self.output.display()
        )
    }

    /// Gives the whole file its name. Only `force` takes it from another.
    pub fn publish(self, force: bool, gate: &Gate) -> Result<(), Error> {
        let failed = |cause: io::Error| Error::output(&self.output, &cause);
        // Takes long, and may be interrupted.
        self.file.sync_all().map_err(failed)?;
        gate.finished(|| {
            let part = tempfile::TempPath::try_from_path(part_of(&self.output)).map_err(failed)?;
            let renamed = match force {
                true => part.persist(&self.output),
                false => part.persist_noclobber(&self.output),
            };
            renamed.map_err(|refused| {
                // It is whole but for its name.
                let _ = refused.path.keep();
                failed(refused.error)
            })?;
            Self::remove(&self.output);
            Ok(())
        })
    }

    /// Leaves nothing behind.
    pub fn remove(output: &Path) {
        // What is not there needs no removing; what cannot be removed is told when it is made anew.
        for path in [part_of(output), journal_of(output)] {
            let _ = fs::remove_file(path);
        }
    }
}

impl Past {
    fn find(output: &Path) -> Result<Option<Self>, Error> {
        let failed = |cause: io::Error| Error::output(output, &cause);
        let options = OpenOptions::new().read(true).write(true).to_owned();
        let file = match options.open(part_of(output)) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(failed(error)),
        };
        lock(&file, output)?;
        match fs::read_to_string(journal_of(output)) {
            Ok(text) => Ok(Some(Self { file, text })),
            // Bricks that nobody noted are no beginning.
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(failed(error)),
        }
    }

    fn head(&self) -> Option<Value> {
        serde_json::from_str(self.text.lines().next()?).ok()
    }

    fn rows(&self) -> impl Iterator<Item = &str> {
        self.text.lines().skip(1)
    }

    /// Without what is torn or damaged.
    fn taken_over(mut self, output: &Path) -> Result<(Unfinished, DoneBricks), Error> {
        let failed = |cause: io::Error| Error::output(output, &cause);
        let done = DoneBricks::read(self.text.lines().skip(1), &mut self.file).map_err(failed)?;
        let kept = self.text.lines().take(1 + done.rows());
        let kept_bytes: usize = kept.map(|line| line.len() + 1).sum();
        let mut journal = OpenOptions::new()
            .write(true)
            .open(journal_of(output))
            .map_err(failed)?;
        let cut = journal
            .set_len(kept_bytes as u64)
            .and_then(|()| journal.seek(SeekFrom::End(0)))
            .and_then(|_| self.file.set_len(done.end_bytes()));
        cut.map_err(failed)?;
        let unfinished = Unfinished {
            output: output.to_owned(),
            file: self.file,
            journal,
        };
        Ok((unfinished, done))
    }
}

/// Nobody else writes the same file. Where a file system knows no locks, there is none.
fn lock(file: &File, output: &Path) -> Result<(), Error> {
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(Error::Output {
            path: output.to_owned(),
            problem: "another run is writing it".to_owned(),
            hint: Some("wait for its end, or choose another name"),
        }),
        Ok(()) | Err(TryLockError::Error(_)) => Ok(()),
    }
}

fn part_of(output: &Path) -> PathBuf {
    beside(output, ".unfinished")
}

fn journal_of(output: &Path) -> PathBuf {
    beside(output, ".journal")
}

fn beside(output: &Path, ending: &str) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(output.file_name().unwrap_or_default());
    name.push(ending);
    output.with_file_name(name)
}
