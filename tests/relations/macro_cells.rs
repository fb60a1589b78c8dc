//! What is known of macro cells: their ranges, and how far away matter is.

use crate::shared::{device, device_with, volume_of};
use crate::skipping_shared::{Numbers, balls};
use ash::vk;
use bytemuck::Zeroable;
use glam::{DAffine3, DVec3};
use std::sync::Arc;
use stratavox::gpu::{self, Buffer, Caps, Headless, Memory, Use, buffer_barrier};
use stratavox::resident::{EmptySpace, GpuVolume, MacroCells, TextureLayout};
use stratavox::shaders::{CELLS_PER_WORD, Frame, REACH};
use stratavox::technique::{Filter, Settings};
use stratavox::transfer::{
    ColorPoint, Interpolation, OpacityPoint, TransferFunction, VisibleRanges,
};

/// All words of a buffer, once what is recorded by `record` has run.
fn read_back(
    device: &mut Headless,
    written: &Buffer,
    record: impl FnOnce(vk::CommandBuffer) -> Result<(), gpu::Error>,
) -> Vec<u32> {
    let gpu = Arc::clone(device.gpu());
    let (bytes, usage) = (written.bytes(), vk::BufferUsageFlags::TRANSFER_DST);
    let back = Buffer::new(&gpu, bytes, usage, Memory::Readback, "back").expect("a buffer");
    let regions = [vk::BufferCopy::default().size(bytes)];
    let copied = device.run(|cmd| {
        record(cmd)?;
        // SAFETY: recorded outside rendering, with barriers around; `run` waits, and both buffers live meanwhile.
        unsafe {
            buffer_barrier(&gpu, cmd, written, Use::ComputeWrite, Use::TransferRead);
            gpu.device()
                .cmd_copy_buffer(cmd, written.raw(), back.raw(), &regions);
            buffer_barrier(&gpu, cmd, &back, Use::TransferWrite, Use::HostRead);
        }
        Ok::<_, gpu::Error>(())
    });
    copied.expect("copied");
    let mut found = vec![0; bytes as usize];
    back.read(0, &mut found).expect("read");
    let word = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().expect("four"));
    found.chunks_exact(4).map(word).collect()
}

#[test]
fn ranges_are_the_same_from_voxels_and_from_textures() {
    let mut numbers = Numbers(23);
    let halo = |filter| {
        Settings {
            filter,
            ..Settings::default()
        }
        .halo()
    };
    for (as_bytes, filter) in [
        (true, Filter::Linear),
        (false, Filter::Linear),
        (true, Filter::CatmullRom),
    ] {
        let volume = balls(&mut numbers, as_bytes);
        for max_image_dimension_3d in [u32::MAX, 19] {
            let mut device = device_with(Caps {
                max_image_dimension_3d,
                ..Caps::UNLIMITED
            });
            let gpu = Arc::clone(device.gpu());
            let made = GpuVolume::new(&gpu, &volume, TextureLayout::Texture3d).expect("textures");
            let staging = made.stage(&volume).expect("staged");
            // SAFETY: recorded outside rendering; `run` waits, and all of it lives meanwhile.
            let upload = |cmd| unsafe { made.record_upload_all(cmd, &staging) };
            device.run(upload).expect("uploaded");
            let by_host = MacroCells::of_voxels(&gpu, &made, halo(filter), &volume).expect("cells");
            let by_device = MacroCells::new(&gpu, &made, halo(filter)).expect("cells");
            let [found, wanted] = [&by_host, &by_device].map(|cells| {
                // SAFETY: as above; the volume has been uploaded.
                let record = |cmd| unsafe { cells.record(cmd) };
                let words = read_back(&mut device, cells.ranges(), record);
                words.into_iter().map(f32::from_bits).collect::<Vec<_>>()
            });
            assert!(found.len() > 2 * 60, "{} numbers", found.len());
            let largest = wanted.iter().fold(0.0f32, |m, v| m.max(v.abs()));
            for (found, wanted) in found.iter().zip(&wanted) {
                // A product and a sum, rounded once or twice.
                assert!(
                    (found - wanted).abs() <= 2f32.powi(-22) * largest,
                    "{found} {wanted}"
                );
            }
        }
    }
}

/// What shows all values over 1.
fn function() -> TransferFunction {
    let point = |(value, opacity)| OpacityPoint { value, opacity };
    TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: [(1.0, 0.0), (100.0, 0.9)].map(point).into(),
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// `distances` of `cells` along each axis are the distances to those that are 0, counted one by one.
fn check_distances(distances: &[u8], cells: [u32; 3]) {
    let all = || {
        let [nx, ny, nz] = cells.map(|n| n as i32);
        let rows = (0..nz).flat_map(move |z| (0..ny).map(move |y| (y, z)));
        rows.flat_map(move |(y, z)| (0..nx).map(move |x| [x, y, z]))
    };
    let matter: Vec<_> = all()
        .zip(distances)
        .filter(|(_, distance)| **distance == 0)
        .map(|(cell, _)| cell)
        .collect();
    for (cell, &distance) in all().zip(distances) {
        let away = |other: &[i32; 3]| (0..3).map(|k| (other[k] - cell[k]).unsigned_abs()).max();
        let nearest = matter.iter().filter_map(away).min();
        let wanted = nearest.map_or(REACH, |nearest| nearest.min(REACH));
        assert_eq!(u32::from(distance), wanted, "{cell:?} of {cells:?}");
    }
}

#[test]
fn distance_maps_hold_distances_to_the_nearest_cell_with_matter() {
    let mut numbers = Numbers(31);
    // Rows of cells that end a word and that do not, longer than anything is looked for.
    for (dims, bright_count) in [
        ([293, 20, 150], 3),
        ([30, 170, 40], 2),
        ([256, 9, 9], 5),
        ([7, 300, 17], 1),
        ([70, 70, 70], 40),
        ([9, 9, 9], 0),
    ] {
        let mut any = |n: u32| numbers.below(n as usize) as u32;
        let bright: Vec<_> = (0..bright_count).map(|_| dims.map(&mut any)).collect();
        let field = |p: DVec3| {
            let at = [p.x as u32, p.y as u32, p.z as u32];
            100.0 * f64::from(bright.contains(&at))
        };
        let volume = volume_of(dims, DAffine3::IDENTITY, field);
        let mut device = device();
        let gpu = Arc::clone(device.gpu());
        let made = GpuVolume::new(&gpu, &volume, TextureLayout::Texture3d).expect("textures");
        let halo = Settings::default().halo();
        let cells = MacroCells::of_voxels(&gpu, &made, halo, &volume).expect("cells");
        let empty =
            EmptySpace::new(&gpu, &cells, &VisibleRanges::new(&function())).expect("distance_map");
        // SAFETY: recorded outside rendering; `run` waits, and all of it lives meanwhile.
        let record = |cmd| unsafe {
            cells.record(cmd)?;
            empty.record(cmd)
        };
        let words = read_back(&mut device, empty.distance_map(), record);
        let mut frame = Frame::zeroed();
        cells.tell(0, &mut frame);
        assert_eq!(frame.cells, dims.map(|n| n.div_ceil(8)));
        let row = frame.cells[0].div_ceil(CELLS_PER_WORD) as usize;
        let distances: Vec<_> = words[frame.cells_first as usize..]
            .chunks_exact(row)
            .take((frame.cells[1] * frame.cells[2]) as usize)
            .flat_map(|row| {
                let bytes = row.iter().flat_map(|word| word.to_le_bytes());
                bytes.take(frame.cells[0] as usize).collect::<Vec<_>>()
            })
            .collect();
        let with_matter = distances.iter().filter(|distance| **distance == 0).count();
        // A voxel is seen in its cell and at most in seven beside.
        let range = bright_count.min(1)..=8 * bright_count;
        assert!(range.contains(&with_matter), "{with_matter} of {dims:?}");
        check_distances(&distances, frame.cells);
    }
}
