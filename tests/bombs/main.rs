//! Small files that ask for gigabytes: sizes that lie, streams that expand a thousandfold, structures without an end.
//! The program refuses each by its name, in a few seconds and in little memory.
#![cfg(all(feature = "cli", target_os = "linux"))]

#[path = "../shared/dicom.rs"]
mod dicom;
#[path = "../shared/encode.rs"]
mod encode;
#[path = "../shared/files.rs"]
mod files;
mod headers;
mod images;
mod limited;
mod nested;
#[path = "../shared/nifti.rs"]
mod nifti;
mod scientific;
mod streams;
#[path = "../shared/tiff.rs"]
mod tiff;
#[path = "../shared/zarr.rs"]
mod zarr;

use files::Folder;
use limited::Ended;
use std::time::Duration;

/// Address space of the program: a reservation of gigabytes fails even where no page of it is touched.
const ADDRESS_SPACE_KIB: u64 = 1 << 20;
/// Resident memory that the program may have had at its peak, the program itself included.
const MOST_BYTES: u64 = 128 << 20;
const MOST_TIME: Duration = Duration::from_secs(10);
/// A bomb is a small file.
const MOST_FILE_BYTES: u64 = 9 << 20;

/// One hostile file in the folder of the test.
struct Bomb {
    name: String,
    /// The command line.
    words: String,
    /// What the error says beside the name of the file. `None`: the file is read, and what is too much of it left.
    said: Option<&'static str>,
}

/// The folder, and what was put there.
struct Bombs {
    folder: Folder,
    all: Vec<Bomb>,
}

impl Bombs {
    /// A volume for `info`.
    fn volume(&mut self, name: &str, bytes: impl AsRef<[u8]>, said: &'static str) {
        self.folder.write(name, bytes);
        self.run(name, &format!("info {name}"), said);
    }

    /// What is there already, for any command.
    fn run(&mut self, name: &str, words: &str, said: &'static str) {
        self.all.push(Bomb {
            name: name.to_owned(),
            words: words.to_owned(),
            said: Some(said),
        });
    }

    /// A volume that is read as every program reads it: what its stream holds beyond its voxels is not looked at.
    fn harmless(&mut self, name: &str, bytes: impl AsRef<[u8]>) {
        self.folder.write(name, bytes);
        self.all.push(Bomb {
            name: name.to_owned(),
            words: format!("info {name}"),
            said: None,
        });
    }
}

/// What is wrong with how a command ended, if anything.
fn complaint(bomb: &Bomb, ended: &Ended) -> Option<String> {
    let ended_well = match bomb.said {
        // 3: the file is wrong. 6: it is right, and too large for the limit of the command.
        Some(said) => {
            let is_named = ended.err.contains(&bomb.name) && ended.err.contains(said);
            matches!(ended.code, Some(3 | 6)) && is_named
        }
        None => ended.code == Some(0),
    };
    let brief = ended.err.lines().count() <= 6 && !ended.err.contains("panicked");
    let small = ended.peak_bytes < MOST_BYTES && ended.took < MOST_TIME;
    let good = ended_well && brief && small;
    (!good).then(|| format!("{} ({:?} wanted): {ended:?}", bomb.words, bomb.said))
}

#[test]
fn hostile_files_are_refused_in_little_time_and_memory() {
    let mut bombs = Bombs {
        folder: Folder::new(),
        all: Vec::new(),
    };
    headers::add(&mut bombs);
    streams::add(&mut bombs);
    scientific::add(&mut bombs);
    images::add(&mut bombs);
    nested::add(&mut bombs);
    let folder = bombs.folder.path(".");
    let (mut peak_bytes, mut took) = (0, Duration::ZERO);
    let mut complaints = Vec::new();
    for bomb in &bombs.all {
        let bytes = std::fs::metadata(folder.join(&bomb.name)).map_or(0, |data| data.len());
        let is_sparse = bomb.name.starts_with("sparse");
        assert!(
            is_sparse || bytes < MOST_FILE_BYTES,
            "{}: {bytes}",
            bomb.name
        );
        let ended = limited::run(&folder, &bomb.words, ADDRESS_SPACE_KIB);
        complaints.extend(complaint(bomb, &ended));
        peak_bytes = peak_bytes.max(ended.peak_bytes);
        took = took.max(ended.took);
    }
    println!(
        "{} hostile files: at most {} MiB of memory and {:.1} s",
        bombs.all.len(),
        peak_bytes >> 20,
        took.as_secs_f64()
    );
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(bombs.all.len() >= 60, "{} files", bombs.all.len());
}
