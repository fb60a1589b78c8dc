//! Voxels through staging memory to textures: what to stage, and the copies.
//!
//! ```text
//! all at once    stage -> record_upload_all
//! in slabs       slabs -> staged -> record_upload, for each
//! ```

use super::GpuVolume;
use crate::gpu::{Buffer, Error, Memory, Region, Use, buffer_to_image, image_barrier};
use crate::volume::{Volume, VoxelBox, VoxelPart};
use ash::vk;
use std::ops::Range;

/// Copies from a buffer begin at multiples of so many bytes.
const ALIGNMENT: usize = 4;
const ALIGNMENT_BYTES: u64 = ALIGNMENT as u64;

/// A part of a brick that is staged and copied at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slab {
    /// Index into [`GpuVolume::bricks`].
    pub brick: usize,
    /// Voxels of the volume, all of them stored by the brick.
    pub region: VoxelBox,
    /// What was last done with the brick: [`Use::Nothing`] gives up all it holds, [`Use::Sampled`] keeps the rest.
    pub before: Use,
}

impl GpuVolume {
    /// All of the volume in parts small enough to be staged in `bytes` (or one row of a slice), for its first upload:
    /// the first slab of a brick comes after [`Use::Nothing`], the others after [`Use::Sampled`].
    pub fn slabs(&self, bytes: u64) -> Vec<Slab> {
        let numbered = self.bricks().iter().enumerate();
        let whole = numbered.map(|(brick, there)| Slab {
            brick,
            region: there.cell.stored,
            before: Use::Nothing,
        });
        whole.flat_map(|slab| self.cut(slab, bytes)).collect()
    }

    /// What each brick stores of `region`, in parts of so many bytes, for copies into a volume that was uploaded
    /// before.
    pub fn slabs_in(&self, region: VoxelBox, bytes: u64) -> impl Iterator<Item = Slab> {
        let numbered = self.bricks().iter().enumerate();
        let stored = numbered.filter_map(move |(brick, there)| {
            Some(Slab {
                brick,
                region: there.cell.stored.and(&region)?,
                before: Use::Sampled,
            })
        });
        stored.flat_map(move |slab| self.cut(slab, bytes))
    }

    /// Slices of a slab, as many as fit into `bytes`; of slices that do not fit, rows.
    fn cut(&self, slab: Slab, bytes: u64) -> Vec<Slab> {
        let [_, down, deep] = self.layout().axes();
        let fits = |part: &VoxelBox| self.staging_bytes(*part) <= bytes;
        let slices = self.cut_along(slab.region, deep, bytes);
        let parts = slices.flat_map(|part| match fits(&part) {
            true => self.cut_along(part, down, u64::MAX),
            false => self.cut_along(part, down, bytes),
        });
        let parts = parts.enumerate().map(|(number, region)| Slab {
            region,
            before: if number == 0 {
                slab.before
            } else {
                Use::Sampled
            },
            ..slab
        });
        parts.collect()
    }

    /// Parts along an axis, each as long as fits into `bytes`, or of length one.
    fn cut_along(
        &self,
        whole: VoxelBox,
        axis: usize,
        bytes: u64,
    ) -> impl Iterator<Item = VoxelBox> + use<> {
        let part = move |first: u32, end: u32| {
            let mut part = whole;
            (part.min[axis], part.max[axis]) = (first, end);
            part
        };
        let (first, end) = (whole.min[axis], whole.max[axis]);
        let one = self.staging_bytes(part(first, first + 1)).max(1);
        let count = (bytes / one).clamp(1, u32::MAX.into()) as u32;
        let firsts = (first..end).step_by(count as usize);
        firsts.map(move |first| part(first, first.saturating_add(count).min(end)))
    }

    /// The texels of `region` as [`GpuVolume::record_upload`] wants them in a staging buffer: values, then,
    /// from the next multiple of 4 on, validity.
    pub fn staged(&self, volume: &Volume, region: VoxelBox) -> Vec<u8> {
        let mut bytes = vec![0; self.staging_bytes(region) as usize];
        self.write_staged(volume, region, &mut bytes);
        bytes
    }

    /// Writes what [`GpuVolume::staged`] gives into `bytes`, of which there are [`GpuVolume::staging_bytes`].
    ///
    /// # Panics
    /// Where there are fewer bytes, or the region is not one of the volume.
    pub fn write_staged(&self, volume: &Volume, region: VoxelBox, bytes: &mut [u8]) {
        let part = VoxelPart {
            held: self.held,
            ..volume.into()
        };
        self.write_part(&part, region, bytes);
    }

    /// The same where other voxels are at hand than those of the whole.
    pub(crate) fn write_part(&self, part: &VoxelPart, region: VoxelBox, bytes: &mut [u8]) {
        let held = part.held;
        let voxels = region.dims().map(|n| n as usize).iter().product::<usize>();
        let texel_bytes = self.staged_texel_bytes();
        let values_bytes = (voxels * texel_bytes).next_multiple_of(ALIGNMENT);
        let (values, validity) = bytes.split_at_mut(values_bytes);
        if self.has_texels {
            self.write_runs(held, region, texel_bytes, values, |first, stride, out| {
                self.texel().encode(part.voxels, first, stride, out);
            });
        }
        match part.validity {
            Some(mask) if self.has_holes() => {
                self.write_runs(held, region, 1, validity, |first, stride, out| {
                    let mask = mask[first..].iter().step_by(stride);
                    out.iter_mut()
                        .zip(mask)
                        .for_each(|(out, &valid)| *out = valid);
                });
            }
            // Holes elsewhere in the volume.
            _ => validity.fill(1),
        }
    }

    /// Room for [`GpuVolume::staged`]; the next slab may begin behind it.
    pub fn staging_bytes(&self, region: VoxelBox) -> u64 {
        let voxels: u64 = region.dims().iter().map(|&n| u64::from(n)).product();
        let values = voxels * self.staged_texel_bytes() as u64;
        let values = values.next_multiple_of(ALIGNMENT_BYTES);
        if self.has_holes() {
            values + voxels.next_multiple_of(ALIGNMENT_BYTES)
        } else {
            values
        }
    }

    /// None where the values lie elsewhere.
    fn staged_texel_bytes(&self) -> usize {
        match self.has_texels {
            true => self.texel().bytes(),
            false => 0,
        }
    }

    /// Records the copy of a slab from byte `offset` (a multiple of 4) of `staging`.
    ///
    /// # Errors
    /// A region outside the brick, a staging buffer that is too small.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; `self` and `staging` live until it has run;
    /// - `staging` holds [`GpuVolume::staged`] of the slab's region when `cmd` runs;
    /// - `slab.before` is true.
    pub unsafe fn record_upload(
        &self,
        cmd: vk::CommandBuffer,
        staging: &Buffer,
        offset: u64,
        slab: &Slab,
    ) -> Result<(), Error> {
        let axes = self.layout().axes();
        let brick = &self.bricks()[slab.brick];
        let (region, stored) = (slab.region, brick.cell.stored);
        let part = Region {
            origin: axes.map(|k| region.min[k].wrapping_sub(stored.min[k])),
            extent: axes.map(|k| region.max[k] - region.min[k]),
        };
        let values_bytes = match self.has_texels {
            true => part.bytes(self.texel().format).unwrap_or(u64::MAX / 2),
            false => 0,
        };
        let validity_offset = offset.saturating_add(values_bytes.next_multiple_of(ALIGNMENT_BYTES));
        if slab.before == Use::Nothing {
            let values = (!self.has_texels).then_some(&brick.values);
            let once = [self.no_mask(), self.no_depth()];
            let once = once.into_iter().filter(|_| slab.brick == 0);
            for image in values.into_iter().chain(once) {
                // SAFETY: the caller's promises; the one texel is not looked at, but for its layout.
                unsafe { image_barrier(self.gpu(), cmd, image, Use::Nothing, Use::Sampled) };
            }
            if slab.brick == 0 {
                // SAFETY: the caller's promises.
                unsafe { self.blue_noise.record_upload(self.gpu(), cmd) }?;
            }
        }
        let planes = [
            (self.has_texels.then_some(&brick.values), offset),
            (brick.validity.as_ref(), validity_offset),
        ];
        for (image, offset) in planes {
            let Some(image) = image else { continue };
            // SAFETY: the caller's promises; the two barriers put the copy between earlier and later uses.
            unsafe {
                image_barrier(self.gpu(), cmd, image, slab.before, Use::TransferWrite);
                buffer_to_image(self.gpu(), cmd, staging, offset, image, part)?;
                image_barrier(self.gpu(), cmd, image, Use::TransferWrite, Use::Sampled);
            }
        }
        Ok(())
    }

    /// A staging buffer that holds all of `volume`, for [`GpuVolume::record_upload_all`].
    ///
    /// # Errors
    /// Where the device has no buffer of that size: go in [`GpuVolume::slabs`] then.
    pub fn stage(&self, volume: &Volume) -> Result<Buffer, Error> {
        let slabs = self.slabs(u64::MAX);
        let bytes = slabs.iter().map(|s| self.staging_bytes(s.region)).sum();
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let staging = Buffer::new(self.gpu(), bytes, usage, Memory::Upload, "staging")?;
        let mut offset = 0;
        for slab in slabs {
            let bytes = self.staging_bytes(slab.region);
            staging.write_with(offset, bytes, |out| {
                self.write_staged(volume, slab.region, out);
            })?;
            offset += bytes;
        }
        Ok(staging)
    }

    /// Records the first upload of all of the volume from what [`GpuVolume::stage`] gave.
    ///
    /// # Errors
    /// A staging buffer that is too small.
    ///
    /// # Safety
    /// As [`GpuVolume::record_upload`].
    pub unsafe fn record_upload_all(
        &self,
        cmd: vk::CommandBuffer,
        staging: &Buffer,
    ) -> Result<(), Error> {
        let mut offset = 0;
        for slab in self.slabs(u64::MAX) {
            // SAFETY: the caller's promises; slabs lie in the buffer in this order.
            unsafe { self.record_upload(cmd, staging, offset, &slab)? };
            offset += self.staging_bytes(slab.region);
        }
        Ok(())
    }

    /// Calls `write` with the first of the voxels of `held`, the stride between voxels and the place of each run of
    /// texels of a region, of `texel_bytes` each. Goes through blocks: where texels lie along other axes than voxels,
    /// what one run brings into the cache serves its neighbours.
    fn write_runs(
        &self,
        held: VoxelBox,
        region: VoxelBox,
        texel_bytes: usize,
        texels: &mut [u8],
        write: impl Fn(usize, usize, &mut [u8]),
    ) {
        let [nx, ny, _] = held.dims().map(|n| n as usize);
        let axes = self.layout().axes();
        let strides = axes.map(|axis| [1, nx, nx * ny][axis]);
        let origin = axes.map(|axis| (region.min[axis] - held.min[axis]) as usize);
        let dims = axes.map(|axis| (region.max[axis] - region.min[axis]) as usize);
        let run_length = if strides[0] == 1 { dims[0] } else { BLOCK };
        for deep in blocks(dims[2], BLOCK) {
            for down in blocks(dims[1], BLOCK) {
                for across in blocks(dims[0], run_length) {
                    let rows = deep.clone().flat_map(|w| down.clone().map(move |v| (v, w)));
                    for (v, w) in rows {
                        let at = [across.start, v, w];
                        let first = (0..3).map(|k| (origin[k] + at[k]) * strides[k]).sum();
                        let begin = ((w * dims[1] + v) * dims[0] + across.start) * texel_bytes;
                        let end = begin + across.len() * texel_bytes;
                        write(first, strides[0], &mut texels[begin..end]);
                    }
                }
            }
        }
    }
}

/// Voxels along each side of a block.
const BLOCK: usize = 64;

/// `0..count` in parts of `length`.
fn blocks(count: usize, length: usize) -> impl Iterator<Item = Range<usize>> {
    let starts = (0..count).step_by(length.max(1));
    starts.map(move |start| start..(start + length).min(count))
}
