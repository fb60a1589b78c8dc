//! What was compressed as a whole, decoded once into a file without a name: parts of it can be read from there.
//!
//! ```text
//! for each component and time: slabs along z, the first one first -> numbers as they are in memory, little-endian
//! ```
//!
//! Memory holds one slab, whatever the source holds; the disk holds all of it, uncompressed, until the source is
//! dropped.

use super::numbers::Bytes;
use super::{Selection, WriteVolumeError};
use crate::format::convert::{Builder, Endian, to_u64};
use crate::format::problem::{at, io};
use crate::volume::{
    Header, Piece, PrecisionLoss, ReadError, Source, TimeComponent, VoxelBox, VoxelType,
};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Bytes of a slab, if a slice is not larger.
const SLAB_BYTES: u64 = 32 << 20;

/// A [`Source`] of what lies decoded on the disk.
pub struct Unpacked {
    of: Box<dyn Source>,
    selection: Selection,
    /// The type that numbers have in memory, and so in the file.
    number: VoxelType,
    file: Mutex<File>,
    /// What decoding changed, told with the first piece.
    loss: Mutex<PrecisionLoss>,
}

impl std::fmt::Debug for Unpacked {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Unpacked")
            .field("path", &self.of.path())
            .field("selection", &self.selection)
            .finish_non_exhaustive()
    }
}

impl Unpacked {
    /// Decodes what is selected of `source` into a file in `folder`. `progress` hears how many slices are done of how
    /// many.
    ///
    /// # Errors
    /// Where the source cannot be read, or the folder takes no more.
    pub fn new(
        source: Box<dyn Source>,
        selection: &Selection,
        folder: &Path,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, WriteVolumeError> {
        let header = source.header();
        let number = match header.stored.is_kept_exactly() {
            true => header.stored,
            false => VoxelType::F32,
        };
        let [x, y, z] = selection.region.dims();
        let slice = u64::from(x)
            .saturating_mul(y.into())
            .saturating_mul(to_u64(number.bytes()));
        let slices = SLAB_BYTES.checked_div(slice).unwrap_or(1).max(1);
        let slices = u32::try_from(slices).unwrap_or(u32::MAX);
        let mut file = tempfile::tempfile_in(folder)?;
        let picks = picks(selection);
        let of = picks.len().saturating_mul(z as usize);
        let (mut done, mut loss) = (0_usize, PrecisionLoss::default());
        for pick in picks {
            let mut failed = None;
            source.read_slabs(pick, selection.region, slices, &mut |slab, piece| {
                loss = loss.and(piece.loss);
                done = done.saturating_add(slab.dims()[2] as usize);
                progress(done, of);
                failed = file.write_all(&Bytes::of(&piece.voxels).bytes).err();
                match failed {
                    None => ControlFlow::Continue(()),
                    Some(_) => ControlFlow::Break(()),
                }
            })?;
            failed.map_or(Ok(()), Err)?;
        }
        Ok(Self {
            of: source,
            selection: selection.clone(),
            number,
            file: Mutex::new(file),
            loss: Mutex::new(loss),
        })
    }

    /// What decoding changed is not told again: a run before has told it.
    #[must_use]
    pub fn told(self) -> Self {
        Self {
            loss: Mutex::default(),
            ..self
        }
    }

    /// Whole rows of the selection, of one slice.
    fn rows(
        &self,
        pick: TimeComponent,
        z: u32,
        [y0, y1]: [u32; 2],
        bytes: &mut Vec<u8>,
    ) -> std::io::Result<()> {
        let Selection { region, .. } = &self.selection;
        let [nx, ny, nz] = region.dims().map(u64::from);
        let nth = picks(&self.selection).iter().position(|&of| of == pick);
        let slice = to_u64(nth.unwrap_or(0))
            .saturating_mul(nz)
            .saturating_add(z.saturating_sub(region.min[2]).into());
        let row = slice
            .saturating_mul(ny)
            .saturating_add(y0.saturating_sub(region.min[1]).into());
        let row_bytes = nx.saturating_mul(to_u64(self.number.bytes()));
        let length = row_bytes.saturating_mul(y1.saturating_sub(y0).into());
        bytes.resize(usize::try_from(length).unwrap_or(usize::MAX), 0);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(row.saturating_mul(row_bytes)))?;
        file.read_exact(bytes)
    }
}

/// In the order of the file.
fn picks(selection: &Selection) -> Vec<TimeComponent> {
    let components = selection.components.clone();
    let times = |component| {
        selection
            .times
            .clone()
            .map(move |time| TimeComponent { time, component })
    };
    components.flat_map(times).collect()
}

impl Source for Unpacked {
    fn path(&self) -> &Path {
        self.of.path()
    }

    fn header(&self) -> &Header {
        self.of.header()
    }

    fn reads_whole_rows(&self) -> bool {
        true
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let whole = self.selection.region;
        let ([x0, y0, z0], [x1, y1, z1]) = (region.min, region.max);
        let count = region.dims().map(|n| n as usize).iter().product();
        let mut builder = Builder::new(self.number, Endian::Little, count);
        let mut bytes = Vec::new();
        let number_bytes = self.number.bytes();
        let width = (whole.dims()[0] as usize).saturating_mul(number_bytes);
        let [from, end] = [x0, x1].map(|x| {
            let first = whole.min[0];
            (x.saturating_sub(first) as usize).saturating_mul(number_bytes)
        });
        builder.reserve(count).map_err(at(self.path()))?;
        for z in z0..z1 {
            self.rows(pick, z, [y0, y1], &mut bytes)
                .map_err(io("reading what was decoded"))
                .map_err(at(self.path()))?;
            for row in bytes.chunks_exact(width.max(1)) {
                let part = row.get(from..end).unwrap_or_default();
                builder.push(part, 1).map_err(at(self.path()))?;
            }
        }
        let mut loss = self.loss.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(Piece {
            loss: std::mem::take(&mut loss),
            ..builder.finish()
        })
    }
}
