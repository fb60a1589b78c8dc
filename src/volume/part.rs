//! Voxels of a box, cut out of those of a larger one.

use super::{Volume, VoxelBox, Voxels};

/// Voxels of a box of a grid, all of which need not be at hand.
#[derive(Clone, Copy, Debug)]
pub struct VoxelPart<'a> {
    /// The box that they fill.
    pub held: VoxelBox,
    /// x fastest, then y, then z.
    pub voxels: &'a Voxels,
    /// As [`Volume::validity`], of the same box.
    pub validity: Option<&'a [u8]>,
}

impl<'a> From<&'a Volume> for VoxelPart<'a> {
    fn from(volume: &'a Volume) -> Self {
        Self {
            held: VoxelBox {
                min: [0; 3],
                max: volume.dims,
            },
            voxels: &volume.voxels,
            validity: volume.validity.as_deref(),
        }
    }
}

impl VoxelPart<'_> {
    /// The index of the first voxel of each row of `region`, which lies in it.
    pub(crate) fn rows(&self, region: VoxelBox) -> impl Iterator<Item = usize> {
        let [nx, ny, _] = self.held.dims().map(|n| n as usize);
        let [x0, y0, z0] = std::array::from_fn(|k| (region.min[k] - self.held.min[k]) as usize);
        let [_, rows, slices] = region.dims().map(|n| n as usize);
        (z0..z0 + slices).flat_map(move |z| (y0..y0 + rows).map(move |y| (z * ny + y) * nx + x0))
    }
}

/// The numbers of `part` of a box of `dims`.
pub(crate) fn part_of(voxels: &Voxels, dims: [u32; 3], part: VoxelBox) -> Voxels {
    match voxels {
        Voxels::U8(v) => Voxels::U8(rows(v, dims, part)),
        Voxels::I8(v) => Voxels::I8(rows(v, dims, part)),
        Voxels::U16(v) => Voxels::U16(rows(v, dims, part)),
        Voxels::I16(v) => Voxels::I16(rows(v, dims, part)),
        Voxels::F16(v) => Voxels::F16(rows(v, dims, part)),
        Voxels::F32(v) => Voxels::F32(rows(v, dims, part)),
    }
}

fn rows<T: Copy>(numbers: &[T], dims: [u32; 3], part: VoxelBox) -> Vec<T> {
    let [nx, ny, _] = dims.map(|n| n as usize);
    let [x0, y0, z0] = part.min.map(|n| n as usize);
    let [x1, y1, z1] = part.max.map(|n| n as usize);
    let mut found = Vec::with_capacity((x1 - x0) * (y1 - y0) * (z1 - z0));
    for z in z0..z1 {
        for y in y0..y1 {
            let row = (z * ny + y) * nx;
            found.extend_from_slice(&numbers[row + x0..row + x1]);
        }
    }
    found
}
