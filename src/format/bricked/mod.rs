//! Our own file of bricks, `.svb`: each brick with its neighbours, as it comes to the device, and coarser levels.
//!
//! ```text
//! "stratavox bricks" | index begins at u64 | index bytes u64 | bricks ... | index
//! index = lines `key: words`, an empty line, then of each level, time, component and brick, x fastest:
//!         begins at u64 | bytes u32 | coding u32 (0 one number, 1 as they are, 2 LZ4) | low f32 | high f32 | CRC-32 u32
//! ```
//!
//! All numbers are little-endian. Level 0 is the volume; a voxel of level k is the mean of 2^3 of level k - 1. A brick
//! has `side` voxels of its own along each axis, the last ones fewer, and `halo` of its neighbours' on each side; low
//! and high are its smallest and largest stored number, NaN where none is valid (`docs/formats.md`).

mod index;
mod lines;
mod region;

pub(crate) use index::{Coding, Entry, FRONT_BYTES, Index, Level, MAGIC, checksum};
pub(crate) use region::{Bricks, stored_box};

use super::place::open_regular;
use super::problem::{self, at};
use super::request::wanted_count;
use crate::volume::{
    Header, Limits, Overview, Piece, Problem, ReadError, Source, Survey, Surveyed, TimeComponent,
    VolumeSelection, VoxelBox,
};
use std::fs::File;
use std::path::{Path, PathBuf};

/// The word of errors.
pub(crate) const BRICKS: &str = "bricks";

/// True where a file begins as every file of bricks does.
pub(super) fn recognizes(first: &[u8]) -> bool {
    first.starts_with(MAGIC)
}

/// Opens one level of a file.
pub(super) fn open(
    path: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<BrickSource, ReadError> {
    let (mut file, metadata) = open_regular(path).map_err(at(path))?;
    let index = Index::read(&mut file, metadata.len(), limits).map_err(at(path))?;
    let level = wanted.level.unwrap_or(0);
    let last = index.levels.len().saturating_sub(1);
    if index.levels.get(level as usize).is_none() {
        return Err(at(path)(problem::invalid(
            BRICKS,
            "level",
            format!("0 to {last}"),
            &level.to_string(),
        )));
    }
    let mut header = index.header_of(level);
    if let Some([largest, rms]) = index.error_of(level) {
        // Five digits, written as people do.
        let rms: f64 = format!("{rms:.4e}").parse().unwrap_or(rms);
        header.notes.push(format!(
            "level {level} of {last}: values of its voxels differ from those of level 0 by at most {largest}, {rms} by root mean square"
        ));
    }
    Ok(BrickSource {
        path: path.to_owned(),
        header,
        level,
        bricks: Bricks::new(file, index),
        max_bytes: limits.max_bytes,
    })
}

/// A level of a file of bricks.
#[derive(Debug)]
pub(super) struct BrickSource {
    path: PathBuf,
    header: Header,
    level: u32,
    bricks: Bricks<File>,
    max_bytes: u64,
}

impl BrickSource {
    /// The finest level with at most so many voxels.
    fn overview(&self, pick: TimeComponent, most: u64) -> Result<Overview, Problem> {
        let index = self.bricks.index();
        let levels = index.levels.iter().zip(0_u32..).skip(self.level as usize);
        let mut fits = levels.filter(|(level, _)| level.voxel_count() <= most);
        let last = || index.levels.iter().zip(0_u32..).last();
        let Some((level, number)) = fits.next().or_else(last) else {
            return Err(problem::missing(BRICKS, "levels"));
        };
        let voxels = self.bricks.read(number, pick, level.whole())?;
        let every = 1_u32.checked_shl(number.saturating_sub(self.level));
        let header = Header {
            notes: Vec::new(),
            ..index.header_of(number)
        };
        let every = every.unwrap_or(u32::MAX);
        Ok(Overview::new(&self.path, header, voxels, every))
    }
}

impl Source for BrickSource {
    fn path(&self) -> &Path {
        &self.path
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        wanted_count(BRICKS, &self.header, pick, region, self.max_bytes).map_err(at(&self.path))?;
        let voxels = self.bricks.read(self.level, pick, region);
        Ok(voxels.map_err(at(&self.path))?.into())
    }

    fn surveyed(&self, pick: TimeComponent, most_seen: u64) -> Result<Option<Surveyed>, ReadError> {
        let index = self.bricks.index();
        let Some(entries) = index.entries_of(self.level, pick) else {
            return Ok(None);
        };
        let rescale = self.header.rescale;
        let value = |stored: f32| f64::from(stored).mul_add(rescale.slope, rescale.intercept);
        let range = |entry: &Entry| {
            let [a, b] = [entry.low, entry.high].map(value);
            (entry.low <= entry.high).then(|| [a.min(b), a.max(b)])
        };
        let overview = self.overview(pick, most_seen).map_err(at(&self.path))?;
        let ranges = entries.iter().map(range).collect();
        let survey = Survey::known(ranges, index.has_holes, overview);
        Ok(Some(Surveyed {
            side: index.side,
            survey,
        }))
    }
}
