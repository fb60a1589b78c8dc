//! Volumes to files: NRRD, MetaImage, NIfTI-1, NumPy, bricks.
//!
//! ```text
//! Source -> what is written (Selection, NumberType) -> Layout -> header of the format -> numbers, slab by slab
//! ```
//!
//! Stored numbers are kept as they are where the format can say what they mean. Memory holds one slab of one time
//! at a time, [`SLAB_BYTES`] or one slice, whichever is more.

mod bricks;
mod layout;
mod metaimage;
mod nifti;
mod npy;
mod nrrd;
mod numbers;
mod rows;
mod slabs;
mod unpacked;

use crate::volume::{Header, ReadError, Source, VoxelBox, VoxelType};
#[cfg(feature = "cli")]
pub(crate) use bricks::has_coarser_levels;
use layout::Layout;
pub use rows::DoneBricks;
use std::io::{self, Read, Seek, Write};
use std::ops::Range;
use std::path::Path;
pub use unpacked::Unpacked;

/// Bytes of voxels that are read at once, all components together, if a slice is not larger. A compressed source
/// is decoded from its beginning for each slab, so slabs are large.
pub const SLAB_BYTES: u64 = 512 << 20;

/// A kind of file that is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VolumeFormat {
    /// One file, gzip.
    Nrrd,
    /// One file, zlib.
    MetaImage,
    /// NIfTI-1 in one file, gzip where the name ends in `.gz`.
    Nifti {
        /// True for `.nii.gz`.
        gzip: bool,
    },
    /// `[time,] z, y, x [, component]`: no place in space.
    Npy,
    /// Our own: bricks and coarser levels, for volumes that are drawn without being in memory.
    Bricks,
}

impl VolumeFormat {
    /// The format of a name, in capitals or not.
    pub fn of_path(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?.to_ascii_lowercase();
        let ends = |ending: &str| name.len() > ending.len() && name.ends_with(ending);
        Some(match () {
            () if ends(".nrrd") => Self::Nrrd,
            () if ends(".mha") => Self::MetaImage,
            () if ends(".nii") => Self::Nifti { gzip: false },
            () if ends(".nii.gz") => Self::Nifti { gzip: true },
            () if ends(".npy") => Self::Npy,
            () if ends(".svb") => Self::Bricks,
            () => return None,
        })
    }
}

/// Which part of a source is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selection {
    /// Voxels.
    pub region: VoxelBox,
    /// Time steps; not empty.
    pub times: Range<u32>,
    /// Numbers of a voxel; not empty.
    pub components: Range<u32>,
}

impl Selection {
    /// All of it.
    pub fn all(header: &Header) -> Self {
        Self {
            region: header.whole(),
            times: 0..header.times,
            components: 0..header.components,
        }
    }
}

/// Which numbers are written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum NumberType {
    /// Those that are stored, where the format can say what they mean; else their values.
    #[default]
    Stored,
    /// Values, rounded to a type; what does not fit becomes the nearest number that does.
    Values(VoxelType),
    /// Values from the first to the second spread over a type: 0 to its largest number, or 0 to 1 for floats.
    Spread(VoxelType, [f64; 2]),
}

/// How a volume is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WriteVolumeOptions {
    /// The kind of file.
    pub format: VolumeFormat,
    /// Its numbers.
    pub numbers: NumberType,
    /// False writes NRRD and MetaImage as they are, for programs that read parts of them.
    pub compress: bool,
}

/// What stood in the way of a file.
#[derive(Debug, thiserror::Error)]
pub enum WriteVolumeError {
    /// The source.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The file, after so many bytes of voxels.
    #[error("cannot write its bytes")]
    Write(#[from] io::Error),
    /// The format has no room for it.
    #[error("{0}")]
    NoRoom(String),
}

/// What a person should know before and after a file is written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Written {
    /// What the file does not keep of the source, one sentence each.
    pub notes: Vec<String>,
    /// Bytes of numbers, before compression.
    pub voxel_bytes: u64,
}

/// Writes a part of `source` to `out`, which is at its beginning. `progress` hears how many of how many slabs are done.
///
/// # Errors
/// Where the source cannot be read, `out` takes no more, or the format has no room for the volume.
pub fn write_volume(
    source: &dyn Source,
    selection: &Selection,
    options: &WriteVolumeOptions,
    out: &mut (impl Read + Write + Seek),
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Written, WriteVolumeError> {
    if options.format == VolumeFormat::Bricks {
        let done = DoneBricks::default();
        let numbers = options.numbers;
        return write_bricks(
            source,
            selection,
            numbers,
            out,
            done,
            &mut |_| Ok(()),
            progress,
        );
    }
    let mut layout = Layout::of(source.header(), selection, options)?;
    let mut slabs = slabs::Slabs {
        source,
        selection,
        layout: &layout.clone(),
        tally: numbers::Tally::default(),
        progress,
    };
    match options.format {
        VolumeFormat::Nrrd => nrrd::write(&layout, options.compress, out, &mut slabs)?,
        VolumeFormat::MetaImage => metaimage::write(&layout, options.compress, out, &mut slabs)?,
        VolumeFormat::Nifti { gzip } => nifti::write(&mut layout, gzip, out, &mut slabs)?,
        VolumeFormat::Npy => npy::write(&layout, out, &mut slabs)?,
        VolumeFormat::Bricks => unreachable!("written above"),
    }
    let mut notes = layout.notes.clone();
    notes.extend(slabs.tally.notes(layout.number));
    Ok(Written {
        notes,
        voxel_bytes: layout.voxel_bytes().unwrap_or(u64::MAX),
    })
}

/// Writes a part of `source` as bricks to `out`, which ends where those that are `done` end. `note` hears a line of
/// each row of bricks that is in the file: [`DoneBricks::read`] takes them back, and the file is that of one who was
/// never stopped.
///
/// # Errors
/// Those of [`write_volume`], and where the bricks that are done are not those of this volume.
pub fn write_bricks(
    source: &dyn Source,
    selection: &Selection,
    numbers: NumberType,
    out: &mut (impl Read + Write + Seek),
    done: DoneBricks,
    note: &mut dyn FnMut(&str) -> io::Result<()>,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Written, WriteVolumeError> {
    let options = WriteVolumeOptions {
        format: VolumeFormat::Bricks,
        // Bricks are kept as they are in memory.
        numbers: match numbers {
            NumberType::Stored if !source.header().stored.is_kept_exactly() => {
                NumberType::Values(VoxelType::F32)
            }
            numbers => numbers,
        },
        compress: true,
    };
    let layout = Layout::of(source.header(), selection, &options)?;
    if !layout.number.is_kept_exactly() {
        let name = layout.number.name();
        return Err(WriteVolumeError::NoRoom(format!(
            "a file of bricks holds u8, i8, u16, i16, f16 or f32, not {name}"
        )));
    }
    let course = bricks::Course {
        done,
        note,
        progress,
    };
    bricks::write(source, selection, &layout, out, course)
}
