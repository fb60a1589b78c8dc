//! Every fixture, cut: each cut is an error, or has lost bytes that carry nothing. Two formats do not say how much follows:
//! a GRIB file that ends with a whole message, and a legacy VTK file that ends between two arrays, are whole files.
//!
//! A file is cut at each of its first 4096 bytes and at 256 later places. Every sixteenth of these cuts is made here;
//! `STRATAVOX_SWEEP=long` makes all of them, 174 000 at least (`make test-more`).

use crate::sweep;
use std::fs::{self, OpenOptions};
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use std::time::Instant;
use stratavox::format;
use stratavox::volume::{Header, Limits, ReadError, TimeComponent, VolumeSelection, Voxels};

/// Cuts at each byte up to here, then at so many places.
const EACH_BYTES: usize = 4096;
const LATER: usize = 256;

/// Of all cuts one in so many, in the short sweep.
const STRIDE: usize = 16;

/// Cuts that the long sweep must reach.
const LONG_CUTS: usize = 174_000;

/// Small files: what a cut makes of a size is no reason for much memory.
const LIMITS: Limits = Limits {
    max_bytes: 16 << 20,
    max_files: 100,
    max_header_bytes: 1 << 20,
    detached: true,
};

/// All that a file holds, of every variable.
type Content = Vec<(Header, Vec<Voxels>)>;

fn content(path: &Path) -> Result<Content, ReadError> {
    let open = |variable: Option<&String>| {
        let wanted = VolumeSelection {
            variable: variable.cloned(),
            ..VolumeSelection::default()
        };
        format::open(path, &wanted, &LIMITS)
    };
    let first = open(None)?;
    let names = first.header().variables.clone();
    let mut content = Vec::new();
    for name in names
        .iter()
        .map(Some)
        .chain(names.is_empty().then_some(None))
    {
        let source = open(name)?;
        let header = source.header();
        let mut volumes = Vec::new();
        for time in 0..header.times {
            for component in 0..header.components {
                let piece = source.read(TimeComponent { time, component }, header.whole())?;
                volumes.push(piece.voxels);
            }
        }
        content.push((header.clone(), volumes));
    }
    Ok(content)
}

/// The lengths that a file is cut to, the longest first.
fn lengths(bytes: usize) -> Vec<usize> {
    let later = bytes.saturating_sub(EACH_BYTES);
    let places = later.min(LATER);
    let mut lengths: Vec<usize> = (0..bytes.min(EACH_BYTES))
        .chain((0..places).map(|k| EACH_BYTES + k * later / places))
        .collect();
    // The last byte is what is missed most easily.
    if let Some(last) = lengths.last_mut() {
        *last = bytes - 1;
    }
    lengths.reverse();
    lengths
}

fn all_files(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    entries.sort();
    for path in entries {
        match path.is_dir() {
            true => all_files(&path, found),
            false => found.push(path),
        }
    }
}

/// A file with fewer messages or arrays than the fixture, where no count is in the file.
fn is_whole(name: &str, bytes: &[u8], found: &Content, whole: &Content) -> bool {
    match name.rsplit('.').next() {
        Some("grib2") => bytes.ends_with(b"7777"),
        Some("vtk") => found.iter().all(|(header, volumes)| {
            let is_same = |(other, others): &(Header, Vec<Voxels>)| {
                other.dims == header.dims && others == volumes
            };
            whole.iter().any(is_same)
        }),
        _ => false,
    }
}

#[test]
fn a_fixture_cut_anywhere_is_refused() {
    let is_long = sweep::is_long();
    let begun = Instant::now();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    let mut paths = Vec::new();
    for format in FORMATS {
        all_files(&root.join(format), &mut paths);
    }
    let (mut cuts, mut bare, mut shorter, mut files, mut silent) = (0, 0, 0, 0, Vec::new());
    for path in paths {
        let folder = crate::files::Folder::new();
        let name = path.file_name().expect("a name").to_str().expect("UTF-8");
        let bytes = fs::read(&path).expect("a fixture");
        let copy = folder.write(name, &bytes);
        // Fixtures that are refused whole, and files of a set of several, are other tests' subjects.
        let Ok(whole) = content(&copy) else { continue };
        files += 1;
        let file = OpenOptions::new().write(true).open(&copy).expect("a file");
        let step = if is_long { 1 } else { STRIDE };
        for length in lengths(bytes.len()).into_iter().step_by(step) {
            file.set_len(length as u64).expect("a cut");
            let what = format!("{name} cut at {length} of {}", bytes.len());
            let found = catch_unwind(|| content(&copy)).unwrap_or_else(|_| panic!("{what}: panic"));
            cuts += 1;
            match found {
                Err(error) => assert!(crate::files::message(&error).len() > 20, "{what}: {error}"),
                // Padding and line ends behind the voxels.
                Ok(found) if found == whole => bare += 1,
                Ok(found) if is_whole(name, &bytes[..length], &found, &whole) => shorter += 1,
                Ok(_) => silent.push(what),
            }
        }
    }
    let seconds = begun.elapsed().as_secs_f64();
    println!(
        "{cuts} cuts of {files} files in {seconds:.0} s, {bare} of them of bytes that carry nothing, \
         {shorter} between messages or arrays"
    );
    assert!(
        silent.is_empty(),
        "{} give another volume: {silent:#?}",
        silent.len()
    );
    let wanted = if is_long {
        LONG_CUTS
    } else {
        LONG_CUTS / STRIDE
    };
    assert!(cuts >= wanted, "{cuts} cuts, wanted {wanted}");
    assert!(
        shorter < 200,
        "{shorter} cuts end between messages or arrays"
    );
    assert!(files >= 300, "{files} files");
    // Where a reader looked at nothing, all would be bare.
    assert!(bare < cuts / 20, "{bare} of {cuts} cuts change nothing");
}

/// Folders of fixtures.
const FORMATS: [&str; 8] = [
    "dicom", "grib", "hdf5", "netcdf", "npy", "tiff", "vti", "vtk",
];
