//! How noisy a picture of paths is that frames add up: summed up on the device, and read where a frame in flight comes round.
//!
//! ```text
//! record      paths; deviations of each pixel, sums of tiles, sums of the picture -> 12 bytes that the host reaches
//! noise       what was told by the frame that had the same number before the last one
//! ```
//!
//! The rule is that of offscreen pictures (`technique::pathtrace`), of which each frame is a block. Nothing waits: a host records
//! with a number of a frame in flight when nothing unfinished has it.

use super::Error;
use crate::gpu::{
    Bindings, Buffer, ComputePipeline, Gpu, Memory, ParameterRing, Resource, Use, barriers,
};
use crate::shaders::{NOISE_TILE, shader};
use crate::technique::gather::{Canvas, PICTURE, Player};
use crate::technique::pathtrace::PathBlocks;
use ash::vk;
use std::sync::Arc;

/// The passes.
#[derive(Debug)]
pub(super) struct NoisePass {
    pixels: ComputePipeline,
    picture: ComputePipeline,
}

impl NoisePass {
    /// Compiles them.
    pub fn new(gpu: &Arc<Gpu>) -> Result<Self, Error> {
        Ok(Self {
            pixels: ComputePipeline::new(gpu, shader("path_noise"))?,
            picture: ComputePipeline::new(gpu, shader("path_noise_sums"))?,
        })
    }
}

/// What is known of the picture that frames of one size add up.
#[derive(Debug)]
pub(super) struct Noise {
    pixels: Bindings,
    of_frames: Vec<OfFrame>,
    known: Option<f64>,
    /// Of each pixel, and of each tile: bound above.
    _sums: [Buffer; 2],
}

/// What one frame in flight tells.
#[derive(Debug)]
struct OfFrame {
    told: Buffer,
    picture: Bindings,
    /// What of, where the frame was recorded and its picture goes on.
    of: Option<PathBlocks>,
}

/// As `shaders/path_noise_sums.wgsl` tells it; no paths: nothing was told.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
struct Told {
    deviations: f32,
    squares: f32,
    paths: u32,
}

/// Mean luminance and deviation of a pixel, and both sums of a tile.
const BYTES_OF_TWO: u64 = 8;

impl Noise {
    /// Buffers and descriptor sets for frames that add up in `mean`; `None` where the device has no storage buffer that large.
    pub fn new(
        gpu: &Arc<Gpu>,
        pass: &NoisePass,
        ring: &ParameterRing,
        mean: &Canvas,
        frames: u32,
    ) -> Result<Option<Self>, Error> {
        let bytes_of = |[across, down]: [u32; 2]| {
            let count = u64::from(across) * u64::from(down);
            BYTES_OF_TWO * count
        };
        let of_pixels = bytes_of(mean.extent());
        if of_pixels > u64::from(gpu.limits().max_storage_buffer_range) {
            return Ok(None);
        }
        let buffer = |bytes, reached_by, name| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
            Buffer::new(gpu, bytes, usage, reached_by, name)
        };
        let deviations = buffer(of_pixels, Memory::Device, "deviations of paths")?;
        let of_tiles = bytes_of(tiles(mean.extent()));
        let tile_sums = buffer(of_tiles, Memory::Device, "noise of tiles")?;
        let of_frame = |_| -> Result<OfFrame, Error> {
            let told = buffer(size_of::<Told>() as u64, Memory::Readback, "noise of paths")?;
            let given = [
                ("frame", Resource::Uniform(ring)),
                ("tile_sums", Resource::Storage(&tile_sums)),
                ("told", Resource::Storage(&told)),
            ];
            Ok(OfFrame {
                picture: Bindings::new(gpu, pass.picture.layout(), &given)?,
                told,
                of: None,
            })
        };
        let of_frames = (0..frames).map(of_frame).collect::<Result<_, _>>()?;
        let given = [
            ("frame", Resource::Uniform(ring)),
            ("picture", Resource::sampled(mean.image(PICTURE))),
            ("deviations", Resource::Storage(&deviations)),
            ("tile_sums", Resource::Storage(&tile_sums)),
        ];
        Ok(Some(Self {
            pixels: Bindings::new(gpu, pass.pixels.layout(), &given)?,
            of_frames,
            known: None,
            _sums: [deviations, tile_sums],
        }))
    }

    /// What was told last, of the picture that goes on.
    pub fn known(&self) -> Option<f64> {
        self.known
    }

    /// Another picture begins, of which nothing is known.
    pub fn forget(&mut self) {
        self.known = None;
        for frame in &mut self.of_frames {
            frame.of = None;
        }
    }

    /// Reads what a frame has told that is done. One that was never submitted has told nothing.
    pub fn read(&mut self, frame: usize) -> Result<(), Error> {
        let there = &mut self.of_frames[frame];
        let Some(of) = there.of.take() else {
            return Ok(());
        };
        let mut told = Told::default();
        there.told.read(0, bytemuck::bytes_of_mut(&mut told))?;
        if told.paths == of.paths {
            self.known = of.noise(told.deviations.into(), told.squares.into());
        }
        Ok(())
    }

    /// Records the sums of a frame, by its parameters at `offset` of the ring, whose paths the picture is the mean of now.
    ///
    /// # Safety
    /// `player` records outside rendering, for the canvas that this was made for, after the paths of the frame, which are some; the
    /// frame with that number before is done.
    pub unsafe fn record(
        &mut self,
        player: &mut Player,
        pass: &NoisePass,
        (frame, offset): (usize, u32),
        of: PathBlocks,
    ) -> Result<(), Error> {
        let there = &mut self.of_frames[frame];
        there.told.write(0, bytemuck::bytes_of(&Told::default()))?;
        let (gpu, cmd) = (player.gpu, player.cmd);
        let [across, down] = tiles(player.canvas.extent());
        let in_turn = [(Use::ComputeWrite, Use::ComputeWrite)];
        // SAFETY: the caller's promises; all that is bound lives as long as the frame, and then until it is retired.
        unsafe {
            player.bring([(PICTURE, Use::ComputeSampled)]);
            // Frames in flight share the deviations.
            barriers(gpu, cmd, in_turn, [], []);
            let groups = [across, down, 1];
            pass.pixels.dispatch(cmd, &self.pixels, &[offset], groups);
            barriers(gpu, cmd, in_turn, [], []);
            pass.picture
                .dispatch(cmd, &there.picture, &[offset], [1; 3]);
            let told = (&there.told, Use::ComputeWrite, Use::HostRead);
            barriers(gpu, cmd, [], [told], []);
            player.bring([(PICTURE, Use::FragmentSampled)]);
        }
        there.of = Some(of);
        Ok(())
    }
}

/// Workgroups across and down.
fn tiles(extent: [u32; 2]) -> [u32; 2] {
    extent.map(|pixels| pixels.div_ceil(NOISE_TILE))
}
