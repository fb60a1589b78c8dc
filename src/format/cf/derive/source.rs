//! A [`Source`] whose voxels are computed from those of others on the same grid.
//!
//! ```text
//! value = f(a1, a2, ...),   a = offset + sum of scale_k x_k     x_k the value of a variable at the same voxel
//! ```
//!
//! In f64, rounded once at the end. A voxel has no data where one of its parts has none.

use super::super::grid::{SLAB_BYTES, check};
use super::super::regular::valid_numbers;
use super::formula::Formula;
use crate::format::problem::at;
use crate::volume::{Header, Piece, ReadError, Source, TimeComponent, VoxelBox, Voxels};
use std::path::Path;

/// One argument of a formula.
pub(super) struct Argument {
    /// Each with what it is multiplied by.
    pub terms: Vec<(Numbers, f64)>,
    pub offset: f64,
}

/// Where the numbers of a part come from.
pub(super) enum Numbers {
    /// Voxels of the grid; of one time where they hold for all.
    Voxels(Box<dyn Source>),
    /// One for each layer of the grid.
    Layers(Vec<f64>),
}

/// Voxels by a formula.
pub(super) struct Derived {
    pub header: Header,
    pub formula: Formula,
    pub arguments: Vec<Argument>,
    pub max_bytes: u64,
}

/// Bytes of f32 that are computed at once: what a read takes beside its voxels is a few times as much.
const PIECE_BYTES: u64 = SLAB_BYTES / 4;

impl Argument {
    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Vec<f64>, ReadError> {
        let dims = region.dims().map(u64::from);
        let layer = usize::try_from(dims[0].saturating_mul(dims[1])).unwrap_or(usize::MAX);
        let count = dims.iter().fold(1_u64, |n, &size| n.saturating_mul(size));
        let mut sums = vec![self.offset; usize::try_from(count).unwrap_or(0)];
        for (numbers, scale) in &self.terms {
            match numbers {
                Numbers::Voxels(source) => {
                    let header = source.header();
                    let time = if header.times == 1 { 0 } else { pick.time };
                    let voxels = source.read(TimeComponent { time, ..pick }, region)?.voxels;
                    let stored = valid_numbers(&voxels, header.fill);
                    drop(voxels);
                    let (slope, intercept) = (header.rescale.slope, header.rescale.intercept);
                    for (sum, stored) in sums.iter_mut().zip(stored) {
                        *sum += scale * (f64::from(stored) * slope + intercept);
                    }
                }
                Numbers::Layers(layers) => {
                    let first = usize::try_from(region.min[2]).unwrap_or(usize::MAX);
                    let inside = layers.iter().skip(first);
                    for (sums, number) in sums.chunks_mut(layer.max(1)).zip(inside) {
                        sums.iter_mut().for_each(|sum| *sum += scale * number);
                    }
                }
            }
        }
        Ok(sums)
    }
}

impl Source for Derived {
    fn path(&self) -> &Path {
        let mut terms = self.arguments.iter().flat_map(|argument| &argument.terms);
        let path = terms.find_map(|(numbers, _)| match numbers {
            Numbers::Voxels(source) => Some(source.path()),
            Numbers::Layers(_) => None,
        });
        path.unwrap_or(Path::new(""))
    }

    fn header(&self) -> &Header {
        &self.header
    }

    #[allow(
        clippy::cast_possible_truncation,
        reason = "rounding the value to the type of voxels"
    )]
    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        check(&self.header, pick, region, self.max_bytes).map_err(at(self.path()))?;
        let [nx, ny, _] = region.dims().map(u64::from);
        let layer_bytes = nx.saturating_mul(ny).saturating_mul(4).max(1);
        let layers = PIECE_BYTES.checked_div(layer_bytes).unwrap_or(1).max(1);
        let layers = u32::try_from(layers).unwrap_or(u32::MAX);
        let mut values = Vec::new();
        let mut arguments = Vec::new();
        for slab in region.slabs(layers) {
            let read = self.arguments.iter().map(|a| a.read(pick, slab));
            let read = read.collect::<Result<Vec<_>, _>>()?;
            let count = read.first().map_or(0, Vec::len);
            values.extend((0..count).map(|i| {
                arguments.clear();
                let all = read.iter().filter_map(|numbers| numbers.get(i));
                arguments.extend(all.copied());
                self.formula.value(&arguments) as f32
            }));
        }
        Ok(Voxels::F32(values).into())
    }
}
