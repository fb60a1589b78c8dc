//! Ranges of cells that the device finds after updates, as graphics cards do: read back, they are those of a new
//! volume. A software driver is made to do as they do.

use super::{Update, Volume};
use crate::gpu::{
    Buffer, Caps, DeviceChoice, Error, Gpu, Headless, Memory, Options, Use, buffer_barrier,
    buffer_to_buffer,
};
use crate::resident::MacroCells;
use crate::technique::{Filter, Settings};
use crate::volume::{self, Rescale, VoxelBox, Voxels};
use ash::vk;
use glam::DAffine3;
use std::sync::Arc;

const DIMS: [u32; 3] = [37, 22, 27];

/// Numbers without an order; those of a box have `more` added.
fn voxels(more: u32, region: VoxelBox, is_float: bool) -> volume::Volume {
    let [nx, ny, nz] = DIMS;
    let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    let numbers = all.map(|p| {
        let is_in = (0..3).all(|k| (region.min[k]..region.max[k]).contains(&p[k]));
        let number = (p[0] * 7 + p[1] * 31 + p[2] * 57) % 101;
        number + if is_in { more } else { 0 }
    });
    let voxels = match is_float {
        true => Voxels::F32(numbers.map(|n| n as f32).collect()),
        false => Voxels::U8(numbers.map(|n| n as u8).collect()),
    };
    let made =
        volume::Volume::from_voxels(DIMS, DAffine3::IDENTITY, voxels, Rescale::default(), None);
    let mut made = made.expect("a right volume");
    made.value_range = [0.0, 255.0];
    made
}

/// A volume whose cells the device finds, uploaded.
fn uploaded(device: &mut Headless, voxels: &volume::Volume, settings: &Settings) -> Volume {
    let gpu = Arc::clone(device.gpu());
    let mut made = Volume::new(&gpu, voxels, settings).expect("a volume");
    made.find_cells_on_device(&gpu).expect("cells");
    let upload = |cmd| {
        // SAFETY: outside rendering; `run` waits.
        unsafe { made.record_upload(&gpu, cmd).expect("recorded") };
        Ok(())
    };
    device.run(upload).expect("uploaded");
    made
}

fn ranges(device: &mut Headless, of: &Volume) -> Vec<u8> {
    let gpu: Arc<Gpu> = Arc::clone(device.gpu());
    let there = of.cells().map(MacroCells::ranges).expect("cells");
    let (usage, bytes) = (vk::BufferUsageFlags::TRANSFER_DST, there.bytes());
    let back = Buffer::new(&gpu, bytes, usage, Memory::Readback, "back").expect("a buffer");
    let copied = device.run(|cmd| {
        // SAFETY: outside rendering, barriers around; `run` waits.
        unsafe {
            buffer_barrier(&gpu, cmd, there, Use::ComputeRead, Use::TransferRead);
            let all = [vk::BufferCopy::default().size(bytes)];
            buffer_to_buffer(&gpu, cmd, there, &back, &all)?;
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
fn cells_that_the_device_finds_after_an_update_are_those_of_a_new_volume() {
    let boxes = [
        ([0, 0, 0], DIMS),
        ([8, 8, 8], [16, 16, 16]),
        ([7, 3, 8], [12, 9, 9]),
        ([36, 21, 26], DIMS),
        ([0, 15, 3], [37, 16, 25]),
    ];
    let bricks = Caps {
        max_image_dimension_3d: 14,
        ..Caps::UNLIMITED
    };
    for (caps, is_float) in [(Caps::UNLIMITED, false), (bricks, false), (bricks, true)] {
        let options = Options {
            caps,
            ..Options::default()
        };
        let mut device = Headless::new(&DeviceChoice::Default, &options)
            .expect("a Vulkan device (`make test` installs one)");
        for filter in [Filter::Linear, Filter::CatmullRom] {
            let settings = Settings {
                filter,
                ..Settings::default()
            };
            for (n, (min, max)) in boxes.into_iter().enumerate() {
                let region = VoxelBox { min, max };
                let old = voxels(0, region, is_float);
                let changed = voxels(90, region, is_float);
                let there = uploaded(&mut device, &old, &settings);
                let before = ranges(&mut device, &there);
                let mut update: Update = there
                    .stage_update(region, (&changed).into())
                    .expect("staged");
                // At once, and a piece a submission.
                let count = if n % 2 == 0 { u64::MAX } else { 1 };
                while update.parts() > 0 {
                    let part = |cmd| {
                        // SAFETY: as above.
                        let left = unsafe { there.record_update_part(cmd, &mut update, count) };
                        left.expect("recorded");
                        Ok(())
                    };
                    device.run(part).expect("submitted");
                }
                let found = ranges(&mut device, &there);
                let fresh = uploaded(&mut device, &changed, &settings);
                let wanted = ranges(&mut device, &fresh);
                assert!(before != wanted, "{region:?} changes nothing");
                assert!(found == wanted, "{region:?}, {filter:?}, {caps:?}");
            }
        }
    }
}
