//! A [`Source`] over files: fetches the wanted box of one time and component and keeps nothing else.

use super::convert::{Builder, Endian, bytes_in_memory, to_u64};
use super::data::Data;
use super::decode::Encoding;
use super::problem::at;
use super::request::wanted_count;
use super::select::{Row, rows};
use super::stream::Stream;
use crate::volume::{
    Header, Limits, Piece, Problem, ReadError, Source, TimeComponent, VoxelBox, VoxelType,
};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// A [`Source`] over [`Data`]: every reader of files ends in one.
#[derive(Debug)]
pub(crate) struct FileSource {
    path: PathBuf,
    header: Header,
    data: Data,
    max_bytes: u64,
}

impl FileSource {
    /// `header` and `data` speak of the same array. Adds the notes that `data` gives rise to.
    pub(crate) fn new(path: &Path, mut header: Header, data: Data, limits: &Limits) -> Self {
        header.notes.extend(data.notes.iter().cloned());
        if !data.stored.is_kept_exactly() {
            header.notes.push(format!(
                "voxels are stored as {} and kept as f32",
                data.stored.name()
            ));
        }
        Self {
            path: path.to_owned(),
            header,
            data,
            max_bytes: limits.max_bytes,
        }
    }

    fn read_piece(
        &self,
        stream: &mut Stream,
        pick: TimeComponent,
        region: VoxelBox,
    ) -> Result<Piece, ReadError> {
        let data = &self.data;
        let wanted = wanted_count(data.format, &self.header, pick, region, self.max_bytes)
            .map_err(at(&self.path))?;
        let mut builder = Builder::new(data.stored, data.endian, wanted);
        // Raw bytes were seen to be there; of others only the plausible part is believed beforehand.
        let believed = match data.encoding {
            Encoding::Raw => wanted,
            _ => wanted.min(BELIEVED_NUMBERS),
        };
        builder.reserve(believed).map_err(at(&self.path))?;
        self.read_rows(stream, pick, region, |bytes, stride| {
            builder.push(bytes, stride)
        })?;
        self.check_count(builder.len(), wanted)?;
        Ok(builder.finish())
    }

    /// Hands every wanted number to `take`: bytes of which each `stride`th number is wanted, the first one first.
    ///
    /// A call of the system takes as long as copying some kilobytes: rows that lie close are fetched together, with
    /// what stands between them.
    fn read_rows(
        &self,
        stream: &mut Stream,
        pick: TimeComponent,
        region: VoxelBox,
        mut take: impl FnMut(&[u8], usize) -> Result<(), Problem>,
    ) -> Result<(), ReadError> {
        let data = &self.data;
        let mut near = Span::default();
        let pieces = rows(&data.axes, pick, region).flat_map(|row| pieces(row, data.stored));
        for piece in pieces {
            if !near.takes(&piece) {
                near.hand_on(stream, &self.path, &mut take)?;
            }
            near.pieces.push(piece);
        }
        near.hand_on(stream, &self.path, &mut take)
    }

    fn check_count(&self, found: usize, wanted: usize) -> Result<(), ReadError> {
        if found == wanted {
            return Ok(());
        }
        let number_bytes = to_u64(self.data.stored.bytes());
        Err(at(&self.path)(Problem::Size {
            format: self.data.format,
            wanted_bytes: to_u64(wanted).saturating_mul(number_bytes),
            found_bytes: to_u64(found).saturating_mul(number_bytes),
        }))
    }
}

/// Numbers that are reserved before the first byte of a compressed stream is seen.
const BELIEVED_NUMBERS: usize = 1 << 24;

/// Bytes that are fetched and converted at once.
const CHUNK_BYTES: u64 = 1 << 18;

/// Bytes between two rows that are fetched with them.
const GAP_BYTES: u64 = 1 << 13;

/// VolumeSelection numbers that are fetched at once.
#[derive(Clone, Copy, Debug)]
struct RowPiece {
    start_byte: u64,
    bytes: u64,
    /// From one wanted number to the next.
    stride: usize,
}

/// A row in pieces of [`CHUNK_BYTES`]. Where numbers lie far apart, each is fetched alone.
fn pieces(row: Row, stored: VoxelType) -> impl Iterator<Item = RowPiece> {
    let number_bytes = to_u64(stored.bytes());
    let stride_bytes = row.stride.saturating_mul(number_bytes);
    let most = CHUNK_BYTES.checked_div(stride_bytes).unwrap_or(0).max(1);
    let mut done = 0_u64;
    std::iter::from_fn(move || {
        let count = row.count.saturating_sub(done).min(most);
        let piece = RowPiece {
            start_byte: row
                .start
                .saturating_mul(number_bytes)
                .saturating_add(done.saturating_mul(stride_bytes)),
            bytes: count
                .saturating_sub(1)
                .saturating_mul(stride_bytes)
                .saturating_add(number_bytes),
            stride: match count {
                1 => 1,
                _ => usize::try_from(row.stride).unwrap_or(usize::MAX),
            },
        };
        done = done.saturating_add(count);
        (count > 0).then_some(piece)
    })
}

/// Pieces that lie close to each other.
#[derive(Debug, Default)]
struct Span {
    pieces: Vec<RowPiece>,
}

impl Span {
    /// The first byte, and the one behind the last.
    fn ends(&self) -> Option<[u64; 2]> {
        let (first, last) = self.pieces.first().zip(self.pieces.last())?;
        Some([first.start_byte, last.start_byte.saturating_add(last.bytes)])
    }

    /// Whether the next piece is fetched with these.
    fn takes(&self, next: &RowPiece) -> bool {
        self.ends().is_none_or(|[begin, end]| {
            let new_end = next.start_byte.saturating_add(next.bytes);
            next.start_byte.saturating_sub(end) <= GAP_BYTES
                && new_end.saturating_sub(begin) <= CHUNK_BYTES
        })
    }

    /// Fetches the pieces and is empty again.
    fn hand_on(
        &mut self,
        stream: &mut Stream,
        path: &Path,
        take: &mut impl FnMut(&[u8], usize) -> Result<(), Problem>,
    ) -> Result<(), ReadError> {
        let Some([begin, end]) = self.ends() else {
            return Ok(());
        };
        let bytes = stream.read_at(begin, end.saturating_sub(begin))?;
        for piece in self.pieces.drain(..) {
            let from = usize::try_from(piece.start_byte.saturating_sub(begin));
            let count = usize::try_from(piece.bytes);
            let place = from.unwrap_or(usize::MAX)..;
            let wanted = bytes.get(place).unwrap_or_default();
            let wanted = wanted.get(..count.unwrap_or(usize::MAX));
            take(wanted.unwrap_or_default(), piece.stride).map_err(at(path))?;
        }
        Ok(())
    }
}

impl Source for FileSource {
    fn path(&self) -> &Path {
        &self.path
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn reads_parts(&self) -> bool {
        self.data.encoding == Encoding::Raw
    }

    fn reads_whole_rows(&self) -> bool {
        true
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let mut stream = Stream::new(&self.data);
        let piece = self.read_piece(&mut stream, pick, region)?;
        stream.finish()?;
        Ok(piece)
    }

    fn read_slabs(
        &self,
        pick: TimeComponent,
        region: VoxelBox,
        slices: u32,
        take: &mut dyn FnMut(VoxelBox, Piece) -> ControlFlow<()>,
    ) -> Result<(), ReadError> {
        let mut stream = Stream::new(&self.data);
        for slab in region.slabs(slices) {
            if take(slab, self.read_piece(&mut stream, pick, slab)?).is_break() {
                return Ok(());
            }
        }
        stream.finish()
    }

    fn read_bytes(
        &self,
        pick: TimeComponent,
        region: VoxelBox,
    ) -> Result<Option<Vec<u8>>, ReadError> {
        let bytes_each = self.data.stored.bytes();
        let times_kept = to_u64(bytes_each).div_ceil(to_u64(bytes_in_memory(self.data.stored)));
        let max_bytes = self.max_bytes.checked_div(times_kept).unwrap_or(0);
        let wanted = wanted_count(self.data.format, &self.header, pick, region, max_bytes)
            .map_err(at(&self.path))?;
        let mut all = Vec::new();
        let mut stream = Stream::new(&self.data);
        self.read_rows(&mut stream, pick, region, |bytes, stride| {
            for number in bytes.chunks_exact(bytes_each).step_by(stride.max(1)) {
                match self.data.endian {
                    Endian::Little => all.extend_from_slice(number),
                    Endian::Big => all.extend(number.iter().rev()),
                }
            }
            Ok(())
        })?;
        stream.finish()?;
        self.check_count(all.len().checked_div(bytes_each).unwrap_or(0), wanted)?;
        Ok(Some(all))
    }
}
