//! A [`Source`] over files: fetches the wanted box of one time and component and keeps nothing else.

use super::convert::{Builder, Endian, bytes_in_memory, to_u64};
use super::data::Data;
use super::decode::Encoding;
use super::problem::at;
use super::request::wanted_count;
use super::select::rows;
use super::stream::Stream;
use crate::volume::{Header, Limits, Pick, Piece, Problem, ReadError, Source, VoxelBox};
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

    fn read_piece(&self, pick: Pick, region: VoxelBox, wanted: usize) -> Result<Piece, ReadError> {
        let data = &self.data;
        let mut builder = Builder::new(data.stored, data.endian, wanted);
        // Raw bytes were seen to be there; of others only the plausible part is believed beforehand.
        let believed = match data.encoding {
            Encoding::Raw => wanted,
            _ => wanted.min(BELIEVED_NUMBERS),
        };
        builder.reserve(believed).map_err(at(&self.path))?;
        self.read_rows(pick, region, |bytes, stride| builder.push(bytes, stride))?;
        self.check_count(builder.len(), wanted)?;
        Ok(builder.finish())
    }

    /// Hands every wanted number to `take`: bytes of which each `stride`th number is wanted, the first one first.
    fn read_rows(
        &self,
        pick: Pick,
        region: VoxelBox,
        mut take: impl FnMut(&[u8], usize) -> Result<(), Problem>,
    ) -> Result<(), ReadError> {
        let data = &self.data;
        let number_bytes = to_u64(data.stored.bytes());
        let mut stream = Stream::new(data);
        for row in rows(&data.axes, pick, region) {
            let stride_bytes = row.stride.saturating_mul(number_bytes);
            let mut at_byte = row.start.saturating_mul(number_bytes);
            let mut left = row.count;
            // Where numbers lie far apart, each is fetched alone.
            let batch = CHUNK_BYTES.checked_div(stride_bytes).unwrap_or(0).max(1);
            while left > 0 {
                let count = left.min(batch);
                let span = count
                    .saturating_sub(1)
                    .saturating_mul(stride_bytes)
                    .saturating_add(number_bytes);
                let bytes = stream.read_at(at_byte, span)?;
                let stride = match count {
                    1 => 1,
                    _ => usize::try_from(row.stride).unwrap_or(usize::MAX),
                };
                take(bytes, stride).map_err(at(&self.path))?;
                at_byte = at_byte.saturating_add(count.saturating_mul(stride_bytes));
                left = left.saturating_sub(count);
            }
        }
        stream.finish()
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

    fn read(&self, pick: Pick, region: VoxelBox) -> Result<Piece, ReadError> {
        let wanted = wanted_count(self.data.format, &self.header, pick, region, self.max_bytes)
            .map_err(at(&self.path))?;
        self.read_piece(pick, region, wanted)
    }

    fn read_bytes(&self, pick: Pick, region: VoxelBox) -> Result<Option<Vec<u8>>, ReadError> {
        let bytes_each = self.data.stored.bytes();
        let times_kept = to_u64(bytes_each).div_ceil(to_u64(bytes_in_memory(self.data.stored)));
        let max_bytes = self.max_bytes.checked_div(times_kept).unwrap_or(0);
        let wanted = wanted_count(self.data.format, &self.header, pick, region, max_bytes)
            .map_err(at(&self.path))?;
        let mut all = Vec::new();
        self.read_rows(pick, region, |bytes, stride| {
            for number in bytes.chunks_exact(bytes_each).step_by(stride.max(1)) {
                match self.data.endian {
                    Endian::Little => all.extend_from_slice(number),
                    Endian::Big => all.extend(number.iter().rev()),
                }
            }
            Ok(())
        })?;
        self.check_count(all.len().checked_div(bytes_each).unwrap_or(0), wanted)?;
        Ok(Some(all))
    }
}
