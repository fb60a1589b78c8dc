//! Ranges of macro cells after voxels of a box have changed: those of the cells that look at it, and no others.

use super::cell_ranges::{CellBox, ranges};
use super::macro_cells::{MacroCells, Ranging};
use crate::gpu::{Buffer, Error, Use, buffer_barrier, buffer_to_buffer};
use crate::volume::{VoxelBox, VoxelPart};
use ash::vk;

/// Ranges that change with voxels of a box, where they are not found on the device.
#[derive(Debug, Default)]
pub(crate) struct ChangedCells {
    /// Pairs of f32, those of one row of cells after those of another.
    pub ranges: Vec<[f32; 2]>,
    /// Where they go; sources are counted from the first of them.
    copies: Vec<vk::BufferCopy>,
}

impl MacroCells {
    /// The voxels that are looked at where those of `region` change. Where the device looks itself, nobody else does.
    pub(crate) fn looks_at(&self, region: VoxelBox) -> VoxelBox {
        let grids = self.grids.iter().filter(|_| self.pass.is_none());
        grids.fold(region, |all, grid| match CellBox::that_see(grid, region) {
            Some(cells) => all.around(&cells.looks_at(grid)),
            None => all,
        })
    }

    /// What changes with the voxels of `region`; `part` holds all that is looked at.
    pub(crate) fn changed(&self, part: &VoxelPart, region: VoxelBox) -> ChangedCells {
        let mut changed = ChangedCells::default();
        for grid in self.grids.iter().filter(|_| self.pass.is_none()) {
            let Some(cells) = CellBox::that_see(grid, region) else {
                continue;
            };
            let row_bytes = 8 * u64::from(cells.max[0] - cells.min[0]);
            let mut from = 8 * changed.ranges.len() as u64;
            for z in cells.min[2]..cells.max[2] {
                for y in cells.min[1]..cells.max[1] {
                    let at = cells.min[0] + grid.cells[0] * (y + grid.cells[1] * z);
                    changed.copies.push(vk::BufferCopy {
                        src_offset: from,
                        dst_offset: 8 * u64::from(grid.first + at),
                        size: row_bytes,
                    });
                    from += row_bytes;
                }
            }
            changed.ranges.extend(ranges(part, grid, cells));
        }
        changed
    }

    /// Records what changes with the voxels of `region`, which are there: between what reads the ranges before and what
    /// reads them later.
    ///
    /// # Errors
    /// A staging buffer that is too small.
    ///
    /// # Safety
    /// As [`MacroCells::record`]; `staging` holds the ranges of `changed` from byte `first` on when `cmd` runs.
    pub(crate) unsafe fn record_changed(
        &self,
        cmd: vk::CommandBuffer,
        region: VoxelBox,
        changed: &ChangedCells,
        staging: &Buffer,
        first: u64,
    ) -> Result<(), Error> {
        let gpu = &self.gpu;
        let write = match &self.pass {
            Some(_) => Use::ComputeWrite,
            None => Use::TransferWrite,
        };
        // SAFETY: outside rendering; the buffers live until `cmd` has run.
        unsafe {
            buffer_barrier(gpu, cmd, &self.ranges, Use::ComputeRead, write);
            match &self.pass {
                Some(pass) => {
                    let bricks = self.grids.iter().zip(&pass.bindings);
                    for (slot, (grid, bindings)) in (0..).zip(bricks) {
                        let Some(cells) = CellBox::that_see(grid, region) else {
                            continue;
                        };
                        let [min, max] = [cells.min, cells.max].map(Ranging::threads);
                        let groups = pass.pipeline.groups_around(min, max);
                        let offset = [pass.ring.offset(slot)?];
                        let pipeline = &pass.pipeline;
                        pipeline.dispatch_boxes(cmd, bindings, &offset, [groups]);
                    }
                }
                None => {
                    let copies = changed.copies.iter().map(|copy| vk::BufferCopy {
                        src_offset: first + copy.src_offset,
                        ..*copy
                    });
                    let copies: Vec<_> = copies.collect();
                    buffer_to_buffer(gpu, cmd, staging, &self.ranges, &copies)?;
                }
            }
            buffer_barrier(gpu, cmd, &self.ranges, write, Use::ComputeRead);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{DeviceChoice, Gpu, Headless, Memory, Options};
    use crate::resident::{GpuVolume, Halo, TextureLayout};
    use crate::volume::{Rescale, Volume, Voxels};
    use glam::DAffine3;
    use std::sync::Arc;

    const DIMS: [u32; 3] = [21, 18, 11];
    const REGION: VoxelBox = VoxelBox {
        min: [7, 3, 8],
        max: [12, 9, 9],
    };

    /// Numbers without an order; `changed`: others in the region.
    fn volume(changed: bool) -> Volume {
        let voxels = (0..DIMS[2]).flat_map(|z| {
            (0..DIMS[1]).flat_map(move |y| {
                (0..DIMS[0]).map(move |x| {
                    let p = [x, y, z];
                    let is_in = (0..3).all(|k| (REGION.min[k]..REGION.max[k]).contains(&p[k]));
                    let number = x * 7 + y * 31 + z * 57;
                    if is_in && changed {
                        200 + number % 50
                    } else {
                        number % 100
                    }
                })
            })
        });
        let voxels = Voxels::U8(voxels.map(|n| n as u8).collect());
        let (place, rescale) = (DAffine3::IDENTITY, Rescale::default());
        Volume::from_voxels(DIMS, place, voxels, rescale, None).expect("a right volume")
    }

    fn uploaded(device: &mut Headless, gpu: &Arc<Gpu>, volume: &Volume) -> GpuVolume {
        let made = GpuVolume::new(gpu, volume, TextureLayout::Texture3d).expect("textures");
        let staging = made.stage(volume).expect("staged");
        // SAFETY: outside rendering; `run` waits.
        let upload = |cmd| unsafe { made.record_upload_all(cmd, &staging) };
        device.run(upload).expect("uploaded");
        made
    }

    /// What the device has found; `record` comes first.
    fn found(
        device: &mut Headless,
        cells: &MacroCells,
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), Error>,
    ) -> Vec<u8> {
        let (gpu, bytes) = (Arc::clone(device.gpu()), cells.ranges.bytes());
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let back = Buffer::new(&gpu, bytes, usage, Memory::Readback, "back").expect("a buffer");
        let all = [vk::BufferCopy::default().size(bytes)];
        let copied = device.run(|cmd| {
            record(cmd)?;
            // SAFETY: outside rendering, barriers around; `run` waits.
            unsafe {
                let (written, read) = (Use::ComputeWrite, Use::TransferRead);
                buffer_barrier(&gpu, cmd, &cells.ranges, written, read);
                buffer_to_buffer(&gpu, cmd, &cells.ranges, &back, &all)?;
                buffer_barrier(&gpu, cmd, &back, Use::TransferWrite, Use::HostRead);
            }
            Ok::<_, Error>(())
        });
        copied.expect("copied");
        let mut numbers = vec![0; bytes as usize];
        back.read(0, &mut numbers).expect("read");
        numbers
    }

    #[test]
    fn ranges_that_the_device_finds_anew_are_those_of_the_changed_volume() {
        let mut device = Headless::new(&DeviceChoice::Default, &Options::default())
            .expect("a Vulkan device (`make test` installs one)");
        let gpu = Arc::clone(device.gpu());
        let halo = Halo {
            voxels: 1,
            overshoot: 0.0,
            is_mixed: true,
        };
        let (old, new) = (volume(false), volume(true));
        let there = uploaded(&mut device, &gpu, &old);
        let cells = MacroCells::new(&gpu, &there, halo).expect("cells");
        // SAFETY: outside rendering; `run` waits; the volume is uploaded.
        let before = found(&mut device, &cells, |cmd| unsafe { cells.record(cmd) });
        assert_eq!(cells.looks_at(REGION), REGION, "the device looks itself");
        let changed = cells.changed(&(&new).into(), REGION);
        assert!(changed.ranges.is_empty(), "nothing to copy");
        let staging = there.stage(&new).expect("staged");
        let after = found(&mut device, &cells, |cmd| {
            // SAFETY: as above; all voxels once more, of which the region has changed.
            unsafe {
                there.record_upload_all(cmd, &staging)?;
                cells.record_changed(cmd, REGION, &changed, &staging, 0)
            }
        });
        let fresh = uploaded(&mut device, &gpu, &new);
        let wanted = MacroCells::new(&gpu, &fresh, halo).expect("cells");
        // SAFETY: as above.
        let wanted = found(&mut device, &wanted, |cmd| unsafe { wanted.record(cmd) });
        assert!(before != wanted && after == wanted);
    }
}
