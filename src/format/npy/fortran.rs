//! Arrays in Fortran order: in memory the first axis is the fastest, z of `[z, y, x]`.

use super::NPY;
use crate::format::convert::{Builder, Endian, to_u64};
use crate::format::file_source::FileSource;
use crate::format::problem::at;
use crate::format::request::wanted_count;
use crate::volume::{Header, Piece, ReadError, Source, TimeComponent, VoxelBox};
use std::path::Path;

/// Bytes of the file that are put in order at once.
const SLAB_BYTES: u64 = 64 << 20;

/// The array of a file, x and z exchanged.
#[derive(Debug)]
pub(super) struct FortranSource {
    /// Its x is z of the array.
    file: FileSource,
    header: Header,
    max_bytes: u64,
}

impl FortranSource {
    /// `file` takes the fastest axis of space in memory as x.
    pub(super) fn new(file: FileSource, max_bytes: u64) -> Self {
        let mut header = file.header().clone();
        header.dims.reverse();
        Self {
            file,
            header,
            max_bytes,
        }
    }

    /// The numbers of `region`, x fastest, as little-endian bytes of the type in the file.
    fn bytes(&self, pick: TimeComponent, region: VoxelBox) -> Result<Vec<u8>, ReadError> {
        let mut in_file = region;
        in_file.min.reverse();
        in_file.max.reverse();
        let bytes = self.file.read_bytes(pick, in_file)?.unwrap_or_default();
        Ok(x_fastest(&bytes, region.dims(), self.header.stored.bytes()))
    }
}

/// Numbers of `number_bytes` each, of which z is the fastest, with x as the fastest.
fn x_fastest(z_fastest: &[u8], dims: [u32; 3], number_bytes: usize) -> Vec<u8> {
    let [nx, ny, nz] = dims.map(|n| usize::try_from(n).unwrap_or(usize::MAX));
    let layer = nx.saturating_mul(ny).max(1);
    let number_bytes = number_bytes.max(1);
    let column_bytes = nz.saturating_mul(number_bytes).max(1);
    let mut out = vec![0; z_fastest.len()];
    for (column, numbers) in z_fastest.chunks_exact(column_bytes).enumerate() {
        let [x, y] =
            [column.checked_div(ny), column.checked_rem(ny)].map(Option::unwrap_or_default);
        let places = out
            .chunks_exact_mut(number_bytes)
            .skip(nx.saturating_mul(y).saturating_add(x))
            .step_by(layer);
        for (to, number) in places.zip(numbers.chunks_exact(number_bytes)) {
            to.copy_from_slice(number);
        }
    }
    out
}

impl Source for FortranSource {
    fn path(&self) -> &Path {
        self.file.path()
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let failed = |problem| at(self.path())(problem);
        let wanted =
            wanted_count(NPY, &self.header, pick, region, self.max_bytes).map_err(failed)?;
        let mut builder = Builder::new(self.header.stored, Endian::Little, wanted);
        builder.reserve(wanted).map_err(failed)?;
        let [nx, ny, _] = region.dims().map(u64::from);
        let slice_bytes = nx
            .saturating_mul(ny)
            .saturating_mul(to_u64(self.header.stored.bytes()));
        let slices = SLAB_BYTES.checked_div(slice_bytes).unwrap_or(0).max(1);
        for slab in region.slabs(u32::try_from(slices).unwrap_or(u32::MAX)) {
            let bytes = self.bytes(pick, slab)?;
            builder.push(&bytes, 1).map_err(failed)?;
        }
        Ok(builder.finish())
    }

    fn read_bytes(
        &self,
        pick: TimeComponent,
        region: VoxelBox,
    ) -> Result<Option<Vec<u8>>, ReadError> {
        self.bytes(pick, region).map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_out_x_fastest() {
        // Number zyx of 2 x 3 x 2 voxels, two bytes each.
        let mut file = Vec::new();
        for x in 0..2 {
            for y in 0..3 {
                for z in 0..2 {
                    file.extend([10 * z + y, x]);
                }
            }
        }
        let mut wanted = Vec::new();
        for z in 0..2 {
            for y in 0..3 {
                for x in 0..2 {
                    wanted.extend([10 * z + y, x]);
                }
            }
        }
        assert_eq!(x_fastest(&file, [2, 3, 2], 2), wanted);
    }
}
