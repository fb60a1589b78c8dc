//! Ranges of macro cells that the device makes: with the voxels around a cell, which samples in it touch.

use crate::driver_faults::{HALO_FAULT, alone, faulty, tell, told};
use crate::shared::volume_of;
use ash::vk;
use glam::{DAffine3, DVec3};
use std::sync::Arc;
use stratavox::gpu::{
    self, Buffer, DeviceChoice, Headless, Memory, Options, PipelineCache, Use, Validation,
    buffer_barrier,
};
use stratavox::resident::{GpuVolume, MacroCells, TextureLayout};
use stratavox::technique::Settings;

/// One voxel beside the face of two cells: both know of it, whoever makes their ranges, and a shader that leaves out what lies
/// around a cell is found by it.
#[test]
fn ranges_hold_the_voxels_around_a_cell() {
    let volume = volume_of([16, 8, 8], DAffine3::IDENTITY, |p| {
        f64::from(u8::from(p == DVec3::new(8.5, 4.5, 4.5)))
    });
    let options = Options {
        pipeline_cache: PipelineCache::Off,
        validation: Validation::Off,
        ..Options::default()
    };
    let _alone = alone();
    let most = |by_device: bool| {
        // SAFETY: its functions are Vulkan's, but for shaders that are others.
        let device = unsafe { Headless::through(faulty, &DeviceChoice::Default, &options) };
        let mut device = device.expect("a device");
        let gpu = Arc::clone(device.gpu());
        let made = GpuVolume::new(&gpu, &volume, TextureLayout::Texture3d).expect("textures");
        let staging = made.stage(&volume).expect("staged");
        let halo = Settings::default().halo();
        let cells = match by_device {
            true => MacroCells::new(&gpu, &made, halo),
            false => MacroCells::of_voxels(&gpu, &made, halo, &volume),
        };
        let cells = cells.expect("cells");
        let (written, usage) = (cells.ranges(), vk::BufferUsageFlags::TRANSFER_DST);
        let bytes = written.bytes();
        let back = Buffer::new(&gpu, bytes, usage, Memory::Readback, "back").expect("a buffer");
        let regions = [vk::BufferCopy::default().size(bytes)];
        // SAFETY: recorded outside rendering; `run` waits, and all of it lives meanwhile.
        let uploaded = device.run(|cmd| unsafe { made.record_upload_all(cmd, &staging) });
        uploaded.expect("uploaded");
        // SAFETY: as above, with barriers around.
        let ran = device.run(|cmd| unsafe {
            cells.record(cmd)?;
            buffer_barrier(&gpu, cmd, written, Use::ComputeWrite, Use::TransferRead);
            gpu.device()
                .cmd_copy_buffer(cmd, written.raw(), back.raw(), &regions);
            buffer_barrier(&gpu, cmd, &back, Use::TransferWrite, Use::HostRead);
            Ok::<_, gpu::Error>(())
        });
        ran.expect("copied");
        let mut found = vec![0; bytes as usize];
        back.read(0, &mut found).expect("read");
        let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().expect("four"));
        let numbers: Vec<_> = found.chunks_exact(4).map(number).collect();
        // The largest value of each cell, but for what a sampler may be off.
        [numbers[1], numbers[3]].map(f32::round)
    };
    assert_eq!(most(false), [1.0; 2]);
    assert_eq!(most(true), [1.0; 2]);
    tell(Some(HALO_FAULT));
    let without = most(true);
    assert!(told() > 0, "no shader has it");
    tell(None);
    assert_eq!(without, [0.0, 1.0]);
}
