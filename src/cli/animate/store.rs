//! Where the finished frames of a film lie, and which are still to be drawn.
//!
//! Frames of a sequence lie under their own names with a hidden journal beside them. Those of a film in one file
//! lie in a hidden folder beside it until the film is whole: a film that was stopped goes on from there.

use super::{
    journal::{Journal, another},
    target::Frames,
};
use crate::{
    cli::{Error, output, progress::Progress, signals::Gate},
    picture::{EncodedPicture, LayerKind, Picture, PictureFormat, WriteOptions},
};
use serde_json::Value;
use std::{
    collections::HashSet,
    fs,
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// What the words say about files.
#[derive(Clone, Copy, Debug)]
pub struct Wishes<'a> {
    /// Go on where a run before stopped.
    pub resume: bool,
    /// Replace what is there.
    pub force: bool,
    /// Layers that go with each frame.
    pub layers: &'a [LayerKind],
    /// Files that are read.
    pub inputs: &'a [PathBuf],
}

/// The frames of a film in a folder.
#[derive(Debug)]
pub struct Store {
    frames: Frames,
    count: u32,
    missing: Vec<u32>,
    options: WriteOptions,
    layers: Vec<LayerKind>,
    gate: Gate,
    journal: Mutex<Journal>,
}

impl Store {
    /// The frames of the film that `film` describes in full. Writes nothing yet.
    pub fn new(
        frames: Frames,
        count: u32,
        film: Value,
        wishes: Wishes,
        options: WriteOptions,
        gate: &Gate,
    ) -> Result<Self, Error> {
        let path = journal_path(&frames);
        let new = Journal::new(&path, film);
        let mut store = Self {
            frames,
            count,
            missing: (0..count).collect(),
            options,
            layers: wishes.layers.to_vec(),
            gate: gate.clone(),
            journal: Mutex::new(new),
        };
        store.check_folder()?;
        if wishes.resume && store.frames.folder.is_dir() {
            store.remove_parts()?;
        }
        // One without a frame is in nobody's way.
        let past = Journal::read(&path)?.filter(|past| wishes.resume || past.done() > 0);
        if let Some(past) = past {
            let difference = past.difference(&store.journal());
            match difference {
                None if wishes.resume => {
                    store.take_over(past);
                    return Ok(store);
                }
                Some(why) if wishes.resume && !wishes.force => return Err(another(&why)),
                _ if !wishes.force => {
                    return Err(Error::Output {
                        path: store.frames.path(0),
                        problem: format!("{} of {count} frames are there", past.done()),
                        hint: Some("--resume goes on with the film, --force begins anew"),
                    });
                }
                _ => {}
            }
        }
        store.check_files(wishes)?;
        Ok(store)
    }

    /// Goes on from what a run before has done.
    fn take_over(&mut self, past: Journal) {
        let folder = &self.frames.folder;
        self.missing
            .retain(|&number| !past.is_whole(number, folder));
        // What a kill has left under these names is ours.
        self.options.force = true;
        self.journal = Mutex::new(past);
    }

    /// Frames that are not there yet, ascending.
    pub fn missing(&self) -> &[u32] {
        &self.missing
    }

    /// What is done.
    pub fn journal(&self) -> MutexGuard<'_, Journal> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What the files of a frame will hold.
    pub fn encode(&self, number: u32, picture: &Picture) -> Result<EncodedPicture, Error> {
        let path = self.frames.path(number);
        Ok(EncodedPicture::new(picture, &path, self.options)?)
    }

    /// Writes a frame, whole or not at all.
    pub fn write(&self, number: u32, frame: &EncodedPicture) -> Result<(), Error> {
        if !self.frames.folder.is_dir() {
            fs::create_dir(&self.frames.folder)
                .map_err(|cause| Error::output(&self.frames.folder, &cause))?;
        }
        self.gate.whole(|| self.journal().begin())?;
        self.gate.whole(|| frame.write(self.options.force))?;
        let mut journal = self.journal();
        journal.add_frame(number, &self.files(number))?;
        #[cfg(debug_assertions)]
        stop_for_a_test(journal.done());
        Ok(())
    }

    /// Where they lie.
    pub fn frames(&self) -> &Frames {
        &self.frames
    }

    /// Removes the frames of a film that is whole, with their folder.
    pub fn remove(&self) -> Result<(), Error> {
        clear(&self.frames)
    }

    /// Says what a run that has failed leaves behind.
    pub fn say_what_is_kept(&self, progress: &Progress) {
        let done = self.journal().done();
        if done > 0 {
            let folder = self.frames.folder.display();
            progress.note(&format!(
                "{done} of {} frames are kept in {folder}: --resume goes on",
                self.count
            ));
        }
    }

    /// The files of one frame.
    fn files(&self, number: u32) -> Vec<PathBuf> {
        let path = self.frames.path(number);
        let beside: &[LayerKind] = match self.frames.format {
            PictureFormat::Npy => &self.layers,
            _ => &[],
        };
        let layers = beside
            .iter()
            .map(|layer| path.with_extension(format!("{}.npy", layer.name())));
        [path.clone()].into_iter().chain(layers).collect()
    }

    /// A folder that is not there is made later, in one that is.
    fn check_folder(&self) -> Result<(), Error> {
        match self.frames.folder.is_dir() {
            true => Ok(()),
            false => output::check(std::slice::from_ref(&self.frames.folder), &[], false),
        }
    }

    fn check_files(&self, wishes: Wishes) -> Result<(), Error> {
        if !self.frames.folder.is_dir() {
            return Ok(());
        }
        for number in 0..self.count {
            let files = self.files(number);
            // Thousands of frames: only what is there needs a closer look, and the first to see the folder.
            let is_there = |path: &PathBuf| path.symlink_metadata().is_ok();
            if number == 0 || files.iter().any(is_there) {
                output::check(&files, wishes.inputs, wishes.force).map_err(about_resume)?;
            }
        }
        Ok(())
    }

    /// Removes what a kill has left of frames that were being written.
    fn remove_parts(&self) -> Result<(), Error> {
        let files = self.missing.iter().flat_map(|&number| self.files(number));
        let files = files.chain([journal_path(&self.frames)]);
        let names = files.filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()));
        let names: HashSet<String> = names.collect();
        let folder = &self.frames.folder;
        let failed = |path: &Path, cause| Error::output(path, &cause);
        for entry in fs::read_dir(folder).map_err(|cause| failed(folder, cause))? {
            let path = entry.map_err(|cause| failed(folder, cause))?.path();
            let name = path.file_name().and_then(|name| name.to_str());
            if name
                .and_then(whose_part)
                .is_some_and(|of| names.contains(of))
            {
                fs::remove_file(&path).map_err(|cause| failed(&path, cause))?;
            }
        }
        Ok(())
    }
}

/// Ends the program as a kill does, where a test asks for it after so many frames. No other thread gets to the journal:
/// the caller holds it.
#[cfg(debug_assertions)]
fn stop_for_a_test(frames_done: usize) {
    let wanted = std::env::var("STRATAVOX_STOP_AFTER_FRAMES");
    if wanted.is_ok_and(|wanted| wanted == frames_done.to_string()) {
        std::process::abort();
    }
}

/// Removes the folder of the frames of a film in one file, if it is ours: it holds a journal, or nothing.
pub fn clear(frames: &Frames) -> Result<(), Error> {
    let failed = |cause| Error::output(&frames.folder, &cause);
    if frames.folder.symlink_metadata().is_err() {
        return Ok(());
    }
    if journal_path(frames).is_file() {
        return fs::remove_dir_all(&frames.folder).map_err(failed);
    }
    fs::remove_dir(&frames.folder).map_err(failed)
}

fn journal_path(frames: &Frames) -> PathBuf {
    frames.folder.join(format!(".{}.journal", frames.template))
}

/// The file that was to become of `.NAMExxxxxx.part`.
fn whose_part(name: &str) -> Option<&str> {
    const RANDOM: usize = 6;
    let name = name.strip_prefix('.')?.strip_suffix(".part")?;
    name.get(..name.len().checked_sub(RANDOM)?)
}

fn about_resume(error: Error) -> Error {
    match error {
        Error::Output {
            path,
            problem,
            hint: Some("--force replaces it"),
        } => Error::Output {
            path,
            problem,
            hint: Some("--force replaces all frames"),
        },
        error => error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn picture(level: f32) -> Picture {
        Picture {
            width: 2,
            height: 1,
            pixels: vec![[level, level, level, 1.0]; 2],
            color_space: Default::default(),
            layers: Vec::new(),
        }
    }

    fn store(folder: &Path, film: Value, resume: bool, force: bool) -> Result<Store, Error> {
        let frames = Frames {
            folder: folder.join("frames"),
            template: "%d.png".to_owned(),
            format: PictureFormat::Png,
        };
        let wishes = Wishes {
            resume,
            force,
            layers: &[],
            inputs: &[],
        };
        let options = WriteOptions {
            force,
            ..WriteOptions::default()
        };
        Store::new(frames, 3, film, wishes, options, &Gate::default())
    }

    fn write(store: &Store, number: u32, picture: &Picture) {
        let frame = store.encode(number, picture).expect("encoded");
        store.write(number, &frame).expect("written");
    }

    #[test]
    fn a_stopped_film_is_gone_on_with_by_resume_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let film = json!({"scene": 1});
        let first = store(folder.path(), film.clone(), false, false).expect("a store");
        assert!(!folder.path().join("frames").exists(), "made too early");
        write(&first, 0, &picture(0.1));
        write(&first, 2, &picture(0.2));
        // As a kill leaves it: a part of a frame, and a frame that no line of the journal speaks of.
        let frames = folder.path().join("frames");
        fs::write(frames.join(".1.pngabc123.part"), "half").expect("a file");
        fs::write(frames.join("1.png"), "whole, yet not noted").expect("a file");
        fs::write(frames.join(".1.pngmine.part"), "somebody's own").expect("a file");

        let error = store(folder.path(), film.clone(), false, false).expect_err("refused");
        assert!(
            error.exit_code() == 4 && error.to_string().contains("2 of 3"),
            "{error}"
        );
        let error = store(folder.path(), json!({"scene": 2}), true, false).expect_err("refused");
        assert!(
            error.exit_code() == 2 && error.to_string().contains("`scene` was 1, is 2"),
            "{error}"
        );

        let again = store(folder.path(), film.clone(), true, false).expect("a store");
        assert_eq!(again.missing(), [1]);
        // Over what is there.
        write(&again, 1, &picture(0.3));
        assert!(!frames.join(".1.pngabc123.part").exists());
        assert!(frames.join(".1.pngmine.part").exists());
        let done = store(folder.path(), film.clone(), true, false).expect("a store");
        assert!(done.missing().is_empty(), "{:?}", done.missing());
        fs::write(frames.join("0.png"), "damaged").expect("a file");
        let damaged = store(folder.path(), film, true, false).expect("a store");
        assert_eq!(damaged.missing(), [0]);
    }

    #[test]
    fn frames_of_somebody_else_are_kept_unless_forced() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir(folder.path().join("frames")).expect("a folder");
        fs::write(folder.path().join("frames/2.png"), "a holiday").expect("a file");
        for resume in [false, true] {
            let error = store(folder.path(), json!(1), resume, false).expect_err("refused");
            assert!(
                error.exit_code() == 4 && error.to_string().contains("2.png"),
                "{error}"
            );
        }
        let forced = store(folder.path(), json!(1), false, true).expect("a store");
        assert_eq!(forced.missing(), [0, 1, 2]);
    }
}
