//! What is done of a film, in a file beside its frames: after a kill `--resume` goes on from it.
//!
//! One JSON object a line. The first says which film it is: program version, scene, input; each further one is
//! a fact that was found or a frame that is whole, with the size and hash of its files:
//!
//! ```text
//! {"stratavox_journal":1,"version":"0.1.0","film":{...}}
//! {"voxels":{"time":0,"hash":"..."}}
//! {"frame":{"number":0,"files":[{"name":"0000.png","bytes":5123,"hash":"..."}]}}
//! ```
//!
//! The file begins before the first frame: a frame without a journal is somebody else's. A line is on the disk before
//! the next frame is written; a torn last line, as a kill leaves it, counts for nothing. Hashes are those of one build
//! of the program: they find damage and change, not forgery.

use crate::{
    cli::{
        Error,
        resume_check::{difference, hash_of, hash_voxels},
    },
    picture::write_file,
    volume::Volume,
};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::{
    collections::BTreeMap,
    fs::{self, File, OpenOptions},
    hash::Hasher,
    io::{self, Write},
    path::{Path, PathBuf},
};

const VERSION: u32 = 1;

/// Which film a journal is about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Head {
    stratavox_journal: u32,
    version: String,
    film: Value,
}

/// What a line says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Line {
    Frame { number: u32, files: Vec<Mark> },
    Voxels { time: u32, hash: String },
    Device(String),
}

/// A file and what stood in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Mark {
    name: String,
    bytes: u64,
    hash: String,
}

/// The journal of one film.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    head: Head,
    frames: BTreeMap<u32, Vec<Mark>>,
    voxels: BTreeMap<u32, String>,
    device: Option<String>,
    /// Open for more once frames are being written.
    file: Option<File>,
}

impl Journal {
    /// An empty one, not yet on the disk, for the film that `film` describes in full.
    pub fn new(path: &Path, film: Value) -> Self {
        Self {
            path: path.to_owned(),
            head: Head {
                stratavox_journal: VERSION,
                version: env!("CARGO_PKG_VERSION").to_owned(),
                film,
            },
            frames: BTreeMap::new(),
            voxels: BTreeMap::new(),
            device: None,
            file: None,
        }
    }

    /// The one at `path`, where there is one.
    pub fn read(path: &Path) -> Result<Option<Self>, Error> {
        let refused = |problem: String| Error::Input {
            path: path.to_owned(),
            problem,
        };
        let text = match fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(refused(error.to_string())),
        };
        let mut lines = text.lines();
        let head: Head = serde_json::from_str(lines.next().unwrap_or(""))
            .map_err(|error| refused(format!("it is no journal of a film: {error}")))?;
        let mut journal = Self {
            head,
            ..Self::new(path, Value::Null)
        };
        for line in lines {
            // What follows a torn line was never written.
            let Ok(line) = serde_json::from_str(line) else {
                break;
            };
            journal.take(line);
        }
        Ok(Some(journal))
    }

    /// How many frames are done.
    pub fn done(&self) -> usize {
        self.frames.len()
    }

    /// What makes the film of `new` another one than this one's; the first thing that is found.
    pub fn difference(&self, new: &Self) -> Option<String> {
        let (was, is) = (&self.head.version, &new.head.version);
        if self.head.stratavox_journal != VERSION || was != is {
            return Some(format!(
                "it was begun by version {was} of this program, this is {is}"
            ));
        }
        difference("", &self.head.film, &new.head.film)
    }

    /// True where the files of frame `number` in `folder` are those that were written.
    pub fn is_whole(&self, number: u32, folder: &Path) -> bool {
        self.frames.get(&number).is_some_and(|marks| {
            marks
                .iter()
                .all(|mark| Mark::of(&folder.join(&mark.name)).is_ok_and(|found| found == *mark))
        })
    }

    /// Puts the journal on the disk, without what was torn, and keeps it open for more.
    pub fn begin(&mut self) -> Result<(), Error> {
        if self.file.is_some() {
            return Ok(());
        }
        write_file(&self.path, self.text().as_bytes(), true)?;
        let file = OpenOptions::new().append(true).open(&self.path);
        self.file = Some(file.map_err(|cause| Error::output(&self.path, &cause))?);
        Ok(())
    }

    /// Notes that the files of a frame are whole.
    pub fn add_frame(&mut self, number: u32, files: &[PathBuf]) -> Result<(), Error> {
        let marks = files
            .iter()
            .map(|path| Mark::of(path).map_err(|e| Error::output(path, &e)));
        let files = marks.collect::<Result<Vec<_>, _>>()?;
        self.add(Line::Frame { number, files })
    }

    /// Notes what the voxels of a time are, or compares them with those of the frames that are done.
    pub fn saw_volumes(&mut self, time: u32, volumes: &[&Volume]) -> Result<(), Error> {
        let hash = hash_of(|hasher| {
            volumes
                .iter()
                .for_each(|volume| hash_voxels(volume, hasher));
        });
        match self.voxels.get(&time) {
            Some(was) if *was != hash => Err(another("the input holds other voxels than before")),
            Some(_) => Ok(()),
            None => self.add(Line::Voxels { time, hash }),
        }
    }

    /// Notes who draws, or compares it with who drew the frames that are done.
    pub fn saw_device(&mut self, device: &str) -> Result<(), Error> {
        match &self.device {
            Some(was) if was != device => Err(another(&format!("{was} drew it, this is {device}"))),
            Some(_) => Ok(()),
            None => self.add(Line::Device(device.to_owned())),
        }
    }

    fn take(&mut self, line: Line) {
        match line {
            Line::Frame { number, files } => drop(self.frames.insert(number, files)),
            Line::Voxels { time, hash } => drop(self.voxels.insert(time, hash)),
            Line::Device(device) => self.device = Some(device),
        }
    }

    fn add(&mut self, line: Line) -> Result<(), Error> {
        let text = json_line(&line);
        self.take(line);
        // Before the beginning it is remembered alone.
        let Some(file) = &mut self.file else {
            return Ok(());
        };
        file.write_all(text.as_bytes())
            .and_then(|()| file.sync_data())
            .map_err(|cause| Error::output(&self.path, &cause))
    }

    fn text(&self) -> String {
        let mut text = json_line(&self.head);
        if let Some(device) = &self.device {
            text += &json_line(&Line::Device(device.clone()));
        }
        for (&time, hash) in &self.voxels {
            let hash = hash.clone();
            text += &json_line(&Line::Voxels { time, hash });
        }
        for (&number, files) in &self.frames {
            let files = files.clone();
            text += &json_line(&Line::Frame { number, files });
        }
        text
    }
}

/// The film that is to be gone on with is another one.
pub fn another(why: &str) -> Error {
    Error::usage(
        format!("--resume: {why}"),
        "the words and the input of the first run go on with it; --force begins anew",
    )
}

fn json_line(line: &impl Serialize) -> String {
    serde_json::to_string(line).expect("plain data as JSON") + "\n"
}

impl Mark {
    fn of(path: &Path) -> io::Result<Self> {
        let bytes = fs::read(path)?;
        Ok(Self {
            name: path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            bytes: bytes.len() as u64,
            hash: hash_of(|hasher| hasher.write(&bytes)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_journal_comes_back_without_its_torn_end() {
        let folder = tempfile::tempdir().expect("a folder");
        let (path, frame) = (folder.path().join("j"), folder.path().join("0.png"));
        fs::write(&frame, "a picture").expect("a file");
        let mut journal = Journal::new(&path, json!({"scene": 1}));
        journal.saw_device("a card").expect("noted");
        assert!(!path.exists(), "nothing is written yet");
        journal.begin().expect("written");
        journal
            .add_frame(0, std::slice::from_ref(&frame))
            .expect("noted");
        journal
            .add_frame(1, std::slice::from_ref(&frame))
            .expect("noted");
        let mut text = fs::read(&path).expect("a file");
        text.truncate(text.len() - 5);
        fs::write(&path, text).expect("a file");

        let mut back = Journal::read(&path).expect("read").expect("a journal");
        assert_eq!(back.done(), 1);
        assert_eq!(back.difference(&journal), None);
        assert!(back.is_whole(0, folder.path()) && !back.is_whole(1, folder.path()));
        assert_eq!(
            back.saw_device("another").expect_err("refused").exit_code(),
            2
        );
        fs::write(&frame, "a damaged").expect("a file");
        assert!(!back.is_whole(0, folder.path()));
        // What is added after a resume stands after a whole line.
        back.begin().expect("written");
        back.add_frame(2, &[frame]).expect("noted");
        assert_eq!(
            Journal::read(&path)
                .expect("read")
                .expect("a journal")
                .done(),
            2
        );
    }

    #[test]
    fn another_film_is_told_by_what_has_changed() {
        let with = |film| Journal::new(Path::new("j"), film);
        let was = with(json!({"frames": 3, "scene": {"camera": {"zoom": 2.0}}}));
        for (film, wanted) in [
            (
                json!({"frames": 4, "scene": {"camera": {"zoom": 2.0}}}),
                "`frames` was 3, is 4",
            ),
            (
                json!({"frames": 3, "scene": {"camera": {"zoom": 3.0}}}),
                "`scene.camera.zoom` was 2.0, is 3.0",
            ),
            (
                json!({"frames": 3, "scene": {}}),
                "`scene.camera.zoom` was 2.0, is null",
            ),
        ] {
            assert_eq!(was.difference(&with(film)).as_deref(), Some(wanted));
        }
        let mut newer = with(was.head.film.clone());
        assert_eq!(was.difference(&newer), None);
        newer.head.version = "9.9.9".to_owned();
        assert!(
            was.difference(&newer)
                .is_some_and(|text| text.contains("9.9.9"))
        );
    }

    #[test]
    fn a_file_that_is_no_journal_is_an_input_error() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("j");
        fs::write(&path, "dear diary").expect("a file");
        let error = Journal::read(&path).expect_err("refused");
        assert_eq!(error.exit_code(), 3, "{error}");
        assert!(
            Journal::read(&folder.path().join("none"))
                .expect("no file")
                .is_none()
        );
    }
}
