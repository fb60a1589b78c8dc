//! Files to [`Source`]s, one reader a format.
//!
//! A header only promises. [`open`] compares its promises with the bytes that are there before anything is
//! allocated, and [`Source::read`] again as it goes; a file that is too short, too long once decompressed or
//! damaged is an error, never a volume. A header may name files in its own folder only.
//!
//! ```text
//! path -> what it holds -> reader of that format -> Header, Data (files, offsets, encoding, axes) -> Source
//! ```

#![forbid(unsafe_code)]
#![cfg_attr(
    not(test),
    deny(
        clippy::arithmetic_side_effects,
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        clippy::cast_sign_loss,
        clippy::expect_used,
        clippy::indexing_slicing,
        clippy::panic,
        clippy::unwrap_used
    )
)]

mod absent;
mod base64;
mod blocks;
mod bricked;
#[cfg(any(feature = "grib", feature = "netcdf"))]
mod cf;
mod convert;
mod data;
mod decode;
#[cfg(feature = "dicom")]
mod dicom;
pub(crate) mod earth;
#[cfg(any(feature = "grib", feature = "netcdf"))]
mod fence;
mod file_source;
mod find;
#[cfg(feature = "json")]
pub mod geographic;
pub(crate) mod geometry;
mod grib;
#[cfg(feature = "netcdf")]
mod hdf5;
#[cfg(feature = "json")]
pub mod mesh;
mod metaimage;
#[cfg(feature = "netcdf")]
mod netcdf;
mod nifti;
mod npy;
mod nrrd;
mod pieces;
mod place;
mod ply;
pub mod points;
mod problem;
pub mod raw;
mod request;
mod select;
mod sequence;
mod stream;
mod text;
mod textual;
#[cfg(feature = "tiff")]
mod tiff;
mod vti;
mod vtk;
pub mod write;
#[cfg(feature = "zarr")]
mod zarr;
#[cfg(any(feature = "netcdf", feature = "tiff", feature = "zarr"))]
mod zstd;

#[cfg(not(feature = "dicom"))]
use absent::dicom;
#[cfg(not(feature = "tiff"))]
use absent::tiff;
#[cfg(not(feature = "netcdf"))]
use absent::{hdf5, netcdf};
#[cfg(feature = "cli")]
pub(crate) use sequence::expand as numbered_name;

pub use find::{Found, Search, find, stem};
pub use points::{
    NoColumns, PointColumns, PointFile, holds_points, holds_samples, open_npy, open_points,
};

use crate::volume::{Limits, Problem, ReadError, Source, VolumeSelection};
use problem::at;
use std::path::Path;

/// Bytes that a format is recognized by.
const FIRST_BYTES: u64 = 4096;

/// Opens a file of any format that we read, known by its content.
///
/// Of several volumes in it `wanted` takes one; without a word the first is taken, and the header lists them all.
///
/// # Errors
/// The file cannot be read, is of no known format, says something that cannot be, or promises more voxels than
/// there are bytes. The error names the file, the field, what was wanted and what was found.
pub fn open(
    path: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    if path.is_dir() {
        let reader = FOLDERS
            .iter()
            .find(|reader| (reader.recognizes)(path, limits));
        let reader =
            reader.ok_or_else(|| at(path)(Problem::UnknownFormat(UNKNOWN_FOLDER.into())))?;
        return (reader.open)(path, wanted, limits);
    }
    let first = first_bytes(path).map_err(at(path))?;
    // The content decides. Where it is no format's, the name does, and that reader says what is wrong.
    let by_content = READERS.iter().find(|reader| (reader.recognizes)(&first));
    if let Some(reader) = by_content.or_else(|| Reader::of_name(path)) {
        (reader.open)(path, wanted, limits)
    } else if let Some(sidecar) = raw::sidecar_of(path) {
        raw::open_sidecar(&sidecar, limits)
    } else {
        Err(at(path)(unknown(&first)))
    }
}

type Open = fn(&Path, &VolumeSelection, &Limits) -> Result<Box<dyn Source>, ReadError>;

/// A reader of files.
struct Reader {
    /// True where a file begins as the format does.
    recognizes: fn(&[u8]) -> bool,
    /// What follows the last dot (or the last two) of names, in small letters.
    endings: &'static [&'static str],
    open: Open,
}

impl Reader {
    /// The one of files that are called so.
    fn of_name(path: &Path) -> Option<&'static Self> {
        let name = path.file_name()?.to_str()?.to_ascii_lowercase();
        let ends = |ending: &&str| {
            name.strip_suffix(*ending)
                .is_some_and(|stem| stem.ends_with('.'))
        };
        READERS
            .iter()
            .find(|reader| reader.endings.iter().any(ends))
    }
}

/// A reader of folders.
struct FolderReader {
    recognizes: fn(&Path, &Limits) -> bool,
    open: Open,
}

/// The first that recognizes a file reads it.
const READERS: &[Reader] = &[
    Reader {
        recognizes: bricked::recognizes,
        endings: &["svb"],
        open: |path, wanted, limits| Ok(Box::new(bricked::open(path, wanted, limits)?)),
    },
    Reader {
        recognizes: nrrd::recognizes,
        endings: &["nrrd", "nhdr"],
        open: |path, _, limits| Ok(Box::new(nrrd::open(path, limits)?)),
    },
    Reader {
        recognizes: dicom::recognizes,
        endings: &["dcm", "dicom"],
        open: dicom::open,
    },
    Reader {
        recognizes: tiff::recognizes,
        endings: &["tif", "tiff"],
        open: tiff::open,
    },
    Reader {
        recognizes: npy::recognizes,
        endings: &["npy"],
        open: |path, _, limits| npy::open(path, limits),
    },
    Reader {
        recognizes: netcdf::recognizes,
        endings: &["nc", "cdf"],
        open: netcdf::open,
    },
    Reader {
        recognizes: hdf5::recognizes,
        endings: &["h5", "hdf5", "hdf", "nc4"],
        open: hdf5::open,
    },
    Reader {
        recognizes: |first| ply::recognizes(first) || points::recognizes_vtp(first),
        // A table of text has no mark of its own.
        endings: &["csv", "tsv", "ply", "vtp"],
        open: points::open,
    },
    Reader {
        recognizes: vti::recognizes,
        endings: &["vti", "pvti", "vtr", "vts", "vtu"],
        open: vti::open,
    },
    Reader {
        recognizes: grib::recognizes,
        endings: &["grib", "grib2", "grb", "grb2"],
        open: grib::open,
    },
    Reader {
        recognizes: vtk::recognizes,
        endings: &["vtk"],
        open: vtk::open,
    },
    // Those with weaker marks come last.
    Reader {
        recognizes: metaimage::recognizes,
        endings: &["mha", "mhd"],
        open: |path, _, limits| Ok(Box::new(metaimage::open(path, limits)?)),
    },
    Reader {
        recognizes: nifti::recognizes,
        endings: &["nii", "hdr", "img", "nii.gz", "hdr.gz", "img.gz"],
        open: |path, _, limits| Ok(Box::new(nifti::open(path, limits)?)),
    },
    #[cfg(feature = "dicom")]
    Reader {
        recognizes: dicom::recognizes_bare,
        endings: &[],
        open: dicom::open,
    },
];

/// The first that recognizes a folder reads it.
const FOLDERS: &[FolderReader] = &[
    #[cfg(feature = "zarr")]
    FolderReader {
        recognizes: |path, _| zarr::recognizes(path),
        open: zarr::open,
    },
    #[cfg(feature = "tiff")]
    FolderReader {
        recognizes: |path, _| tiff::recognizes_folder(path),
        open: tiff::open_folder,
    },
    #[cfg(feature = "dicom")]
    FolderReader {
        recognizes: dicom::is_folder_of_pictures,
        open: dicom::open,
    },
];

const UNKNOWN_FOLDER: &str =
    ": this is a folder that holds no DICOM pictures, no stack of TIFF pages and no Zarr arrays";

fn first_bytes(path: &Path) -> Result<Vec<u8>, Problem> {
    let (mut file, metadata) = place::open_regular(path)?;
    if metadata.len() == 0 {
        return Err(Problem::UnknownFormat(": the file is empty".to_owned()));
    }
    place::first_bytes(&mut file, FIRST_BYTES)
}

fn unknown(first: &[u8]) -> Problem {
    let shown: Vec<String> = first
        .iter()
        .take(8)
        .map(|byte| format!("{byte:02x}"))
        .collect();
    Problem::UnknownFormat(format!(
        ": the file begins with the bytes {}; we read nifti, nrrd, metaimage, dicom, tiff, vti, vtk, npy, hdf5, netcdf, zarr, bricks, points in csv, ply and vtp, and raw voxels that a spec or a sidecar describes",
        shown.join(" ")
    ))
}
