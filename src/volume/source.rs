//! Where voxels come from: a header that promises, and a `read` that keeps the promise.

#[cfg(doc)]
use super::Survey;
use super::{Header, ReadError, Surveyed, VoxelBox, Voxels};
use std::ops::ControlFlow;
use std::path::Path;

/// A volume that can be read in parts: a file, a folder, or a formula.
pub trait Source: Send + Sync {
    /// The file, folder or phantom, as errors name it.
    fn path(&self) -> &Path;

    /// What the source holds, checked once when it was opened.
    fn header(&self) -> &Header;

    /// The stored numbers of `region` at one time and component, x fastest.
    ///
    /// `pick` and `region` lie inside the header; integers of 32 and 64 bits and f64 are rounded to f32,
    /// and [`Piece::loss`] says what that cost.
    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError>;

    /// Does now what the first read would do otherwise and takes long, and tells how much of it is done, 0 to 1, from any thread.
    fn prepare(&self, watch: &(dyn Fn(f64) + Sync)) {
        let _ = watch;
    }

    /// False where a part is found only by reading all that stands before it, as in a file that is compressed as a
    /// whole.
    fn reads_parts(&self) -> bool {
        true
    }

    /// True where a part of a row of voxels costs about what the whole row does, as in files of plain rows or of
    /// slices: neighbours along x are read together then.
    fn reads_whole_rows(&self) -> bool {
        false
    }

    /// What the source knows of its bricks, with an overview of about `most_seen` voxels; `None` where somebody has to
    /// look ([`Survey::of`]).
    ///
    /// # Errors
    /// What reading meets.
    fn surveyed(&self, pick: TimeComponent, most_seen: u64) -> Result<Option<Surveyed>, ReadError> {
        let _ = (pick, most_seen);
        Ok(None)
    }

    /// Hands `region` to `take` in slabs of so many slices along z, the first one first, until it breaks off. A file
    /// that is compressed as a whole is decoded once.
    ///
    /// # Errors
    /// What reading meets.
    fn read_slabs(
        &self,
        pick: TimeComponent,
        region: VoxelBox,
        slices: u32,
        take: &mut dyn FnMut(VoxelBox, Piece) -> ControlFlow<()>,
    ) -> Result<(), ReadError> {
        for slab in region.slabs(slices) {
            if take(slab, self.read(pick, slab)?).is_break() {
                break;
            }
        }
        Ok(())
    }

    /// The same numbers as little-endian bytes of the type in the file, none of them rounded. `None` from a source
    /// that has them in the types of [`Voxels`] only.
    fn read_bytes(
        &self,
        pick: TimeComponent,
        region: VoxelBox,
    ) -> Result<Option<Vec<u8>>, ReadError> {
        let _ = (pick, region);
        Ok(None)
    }
}

/// What one [`Source::read`] brings.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The stored numbers, x fastest.
    pub voxels: Voxels,
    /// What rounding them to f32 changed.
    pub loss: PrecisionLoss,
}

impl From<Voxels> for Piece {
    /// Voxels that needed no rounding.
    fn from(voxels: Voxels) -> Self {
        Self {
            voxels,
            loss: PrecisionLoss::default(),
        }
    }
}

/// What rounding 32- and 64-bit integers and f64 to f32 changed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PrecisionLoss {
    /// How many numbers are not what the file holds. A NaN that stays NaN is not changed.
    pub changed: u64,
    /// The largest distance between a number in the file and the one kept; infinite where one left the range of f32.
    pub worst: f64,
}

impl PrecisionLoss {
    /// True where every number is exactly that of the file.
    pub fn is_none(&self) -> bool {
        self.changed == 0
    }

    /// The loss of two pieces together.
    pub fn and(self, other: Self) -> Self {
        Self {
            changed: self.changed.saturating_add(other.changed),
            worst: self.worst.max(other.worst),
        }
    }
}

/// Which of several volumes in one source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct TimeComponent {
    /// Index of the time step.
    pub time: u32,
    /// Index of the component of a voxel.
    pub component: u32,
}
