//! A volume on the device: bricks of 3D textures, or of stacks of 2D textures along one axis.
//!
//! The classic 2D way keeps three copies, one a stack: layer s is slice s of axis k, axis (k + 1) mod 3 runs
//! across and axis (k + 2) mod 3 down.

use super::TexelFormat;
use super::bricks::{Cell, cut};
use crate::gpu::{
    Buffer, Error, Gpu, Image, ImageDesc, ImageKind, Region, Sampler, Use, buffer_to_image,
    image_barrier,
};
use crate::volume::{Grid, Volume, VoxelBox};
use ash::vk;
use std::sync::Arc;

/// How voxels lie in textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureLayout {
    /// For ray casting, projection and view-aligned slices.
    Texture3d,
    /// For 2D texture slicing along this axis.
    Stack(usize),
}

impl TextureLayout {
    /// The grid axes that run across, down and in depth (or through the layers) of the textures.
    fn axes(self) -> [usize; 3] {
        match self {
            Self::Texture3d => [0, 1, 2],
            Self::Stack(axis) => [(axis + 1) % 3, (axis + 2) % 3, axis],
        }
    }

    fn kind(self) -> ImageKind {
        match self {
            Self::Texture3d => ImageKind::D3,
            Self::Stack(_) => ImageKind::D2Array,
        }
    }

    /// Nothing is interpolated between the slices of a stack.
    fn halo(self) -> [bool; 3] {
        std::array::from_fn(|k| self != Self::Stack(k))
    }
}

/// A part of a volume that fits the device.
#[derive(Debug)]
pub struct Brick {
    /// Where it lies.
    pub cell: Cell,
    /// The texels of all stored voxels, in [`Use::Sampled`] after an upload.
    pub values: Image,
    /// 1 = valid; `None` where all voxels of the volume are.
    pub validity: Option<Image>,
}

/// A volume. Its textures are made empty; [`GpuVolume::record_upload`] fills them.
#[derive(Debug)]
pub struct GpuVolume {
    gpu: Arc<Gpu>,
    grid: Grid,
    layout: TextureLayout,
    texel: TexelFormat,
    bricks: Vec<Brick>,
    sampler: Sampler,
}

impl GpuVolume {
    /// Objects for a volume like this one: one brick where the device's limits allow it.
    ///
    /// # Errors
    /// Where the device gives no memory, or not even a voxel fits.
    pub fn new(gpu: &Arc<Gpu>, volume: &Volume, layout: TextureLayout) -> Result<Self, Error> {
        let texel = TexelFormat::choose(gpu, volume.voxels.voxel_type(), volume.rescale);
        let desc = |stored: [u32; 3], format, name| ImageDesc {
            kind: layout.kind(),
            extent: layout.axes().map(|axis| stored[axis]),
            format,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
            name,
        };
        let values = |stored| desc(stored, texel.format, "volume");
        let validity = |stored| desc(stored, vk::Format::R8_UINT, "validity");
        let has_holes = volume.validity.is_some();
        let fits = |stored| {
            let values_fit = gpu.check_image(&values(stored)).is_ok();
            values_fit && (!has_holes || gpu.check_image(&validity(stored)).is_ok())
        };
        let Some(cells) = cut(volume.dims, layout.halo(), fits) else {
            // The error that names the limit.
            gpu.check_image(&values(volume.dims))?;
            gpu.check_image(&validity(volume.dims))?;
            unreachable!("what cannot be cut to fit is over a limit");
        };
        let brick = |cell: Cell| {
            let stored = cell.stored.dims();
            let mask = || Image::new(gpu, &validity(stored));
            Ok(Brick {
                cell,
                values: Image::new(gpu, &values(stored))?,
                validity: has_holes.then(mask).transpose()?,
            })
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            grid: volume.grid(),
            layout,
            texel,
            bricks: cells.into_iter().map(brick).collect::<Result<_, Error>>()?,
            sampler: Sampler::linear_clamp(gpu)?,
        })
    }

    /// Where the voxels lie.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// How they lie in the textures.
    pub fn layout(&self) -> TextureLayout {
        self.layout
    }

    /// What texels mean.
    pub fn texel(&self) -> &TexelFormat {
        &self.texel
    }

    /// At least one.
    pub fn bricks(&self) -> &[Brick] {
        &self.bricks
    }

    /// True where some voxels have no value.
    pub fn has_holes(&self) -> bool {
        self.bricks.iter().any(|brick| brick.validity.is_some())
    }

    /// How textures are read between texels.
    pub fn sampler(&self) -> &Sampler {
        &self.sampler
    }

    /// The parts of a brick, each small enough to be staged in `bytes` (or one slice).
    pub fn slabs(&self, brick: &Brick, bytes: u64) -> Vec<VoxelBox> {
        let axis = self.layout.axes()[2];
        let whole = brick.cell.stored;
        let slice = VoxelBox {
            max: with(whole.max, axis, whole.min[axis] + 1),
            ..whole
        };
        let step = (bytes / self.staging_bytes(slice)).clamp(1, u32::MAX.into()) as usize;
        let slab = |first: u32| VoxelBox {
            min: with(whole.min, axis, first),
            max: with(
                whole.max,
                axis,
                first.saturating_add(step as u32).min(whole.max[axis]),
            ),
        };
        (whole.min[axis]..whole.max[axis])
            .step_by(step)
            .map(slab)
            .collect()
    }

    /// The texels of `region` as [`GpuVolume::record_upload`] wants them in a staging buffer: values, then,
    /// from the next multiple of 4 on, validity.
    pub fn staged(&self, volume: &Volume, region: VoxelBox) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.staging_bytes(region) as usize);
        self.texel
            .encode(&volume.voxels, self.indices(region), &mut bytes);
        if let Some(mask) = &volume.validity {
            bytes.resize(bytes.len().next_multiple_of(4), 0);
            bytes.extend(self.indices(region).map(|i| mask[i]));
        }
        bytes
    }

    /// Size of [`GpuVolume::staged`].
    pub fn staging_bytes(&self, region: VoxelBox) -> u64 {
        let voxels: u64 = region.dims().iter().map(|&n| u64::from(n)).product();
        let values = voxels * self.texel.bytes() as u64;
        if self.has_holes() {
            values.next_multiple_of(4) + voxels
        } else {
            values
        }
    }

    /// Records the copy of `region`, a part of what `brick` stores, from the start of `staging`. `before` is
    /// what was last done with the brick: [`Use::Nothing`] before its first upload, else [`Use::Sampled`].
    ///
    /// # Errors
    /// A region outside the brick, a staging buffer that is too small.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; `self` and `staging` live until it has run;
    /// - `staging` holds [`GpuVolume::staged`] of this region when `cmd` runs.
    pub unsafe fn record_upload(
        &self,
        cmd: vk::CommandBuffer,
        staging: &Buffer,
        brick: &Brick,
        region: VoxelBox,
        before: Use,
    ) -> Result<(), Error> {
        let axes = self.layout.axes();
        let part = Region {
            origin: axes.map(|k| region.min[k].wrapping_sub(brick.cell.stored.min[k])),
            extent: axes.map(|k| region.max[k] - region.min[k]),
        };
        let values_bytes = part.bytes(self.texel.format).unwrap_or(u64::MAX / 2);
        let planes = [
            (Some(&brick.values), 0),
            (brick.validity.as_ref(), values_bytes),
        ];
        for (image, offset) in planes {
            let Some(image) = image else { continue };
            let offset = offset.next_multiple_of(4);
            // SAFETY: the caller's promises; the two barriers put the copy between earlier and later uses.
            unsafe {
                image_barrier(&self.gpu, cmd, image, before, Use::TransferWrite);
                buffer_to_image(&self.gpu, cmd, staging, offset, image, part)?;
                image_barrier(&self.gpu, cmd, image, Use::TransferWrite, Use::Sampled);
            }
        }
        Ok(())
    }

    /// Indices of the voxels of a region in the order of the texels.
    fn indices(&self, region: VoxelBox) -> impl Iterator<Item = usize> {
        let [nx, ny, _] = self.grid.dims.map(|n| n as usize);
        let strides = [1, nx, nx * ny];
        let [across, down, deep] = self.layout.axes().map(|axis| {
            let stride = strides[axis];
            (region.min[axis] as usize..region.max[axis] as usize).map(move |i| i * stride)
        });
        deep.flat_map(move |w| {
            let across = across.clone();
            down.clone()
                .flat_map(move |v| across.clone().map(move |u| u + v + w))
        })
    }
}

fn with(mut corner: [u32; 3], axis: usize, value: u32) -> [u32; 3] {
    corner[axis] = value;
    corner
}
