//! What a host can do with single parts: tiles in any order over any submissions, and runs of slices.

use super::EXTENT;
use crate::shared::{
    device_with, oblique_camera, projections, ramps, sheared_affine, volume_of, waves,
};
use ash::vk;
use std::sync::Arc;
use stratavox::gpu::{
    self, Buffer, Caps, Gpu, Headless, Image, Load, Memory, ParameterRing, Region, Tile, Use,
    begin_rendering, begin_rendering_of, end_rendering, image_barrier, image_to_buffer,
};
use stratavox::picture::ColorSpace;
use stratavox::resident::{GpuTransfer, GpuVolume};
use stratavox::technique::blend::Drawn;
use stratavox::technique::raycast::Raycast;
use stratavox::technique::{
    ACCUMULATION_FORMAT, InPixel, Inputs, Mode, Order, RayTiles, Settings, ShaderVariant, Skip,
    Slicer, Technique, View, accumulation, parameter_ring,
};

/// Numbers that look random and are the same each time (Knuth's linear congruence).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 33) as usize % count
    }

    fn shuffle<T>(&mut self, things: &mut [T]) {
        for end in (1..things.len()).rev() {
            let other = self.below(end + 1);
            things.swap(end, other);
        }
    }
}

/// A picture cut at random where workgroups begin, in a random order.
fn random_tiles(numbers: &mut Numbers) -> Vec<Tile> {
    let mut tiles = vec![Tile::whole(EXTENT)];
    for _ in 0..8 {
        let tile = tiles.swap_remove(numbers.below(tiles.len()));
        let axis = numbers.below(2);
        let blocks = tile.extent[axis].div_ceil(Tile::STEP);
        if blocks < 2 {
            tiles.push(tile);
            continue;
        }
        let cut = (1 + numbers.below(blocks as usize - 1) as u32) * Tile::STEP;
        let [mut first, mut second] = [tile; 2];
        first.extent[axis] = cut;
        second.origin[axis] += cut;
        second.extent[axis] -= cut;
        tiles.extend([first, second]);
    }
    numbers.shuffle(&mut tiles);
    tiles
}

/// What techniques read, on a device whose textures make bricks of the volume.
struct Ready {
    device: Headless,
    gpu: Arc<Gpu>,
    volume: GpuVolume,
    transfer: GpuTransfer,
    ring: ParameterRing,
    /// Of each brick in its order: which, offset, slices.
    recorded: Vec<(usize, u32, u32)>,
    words: ShaderVariant,
    picture: Image,
    layers: Image,
    readback: Buffer,
}

impl Ready {
    fn new(settings: &Settings) -> Self {
        let caps = Caps {
            max_image_dimension_3d: 13,
            ..Caps::UNLIMITED
        };
        let mut device = device_with(caps);
        let gpu = Arc::clone(device.gpu());
        let there = volume_of([17, 9, 13], sheared_affine(), waves);
        let grid = there.grid();
        let camera = oblique_camera(&grid, projections(&grid)[1]);
        let view = View {
            grid: &grid,
            camera: &camera,
            extent_pixels: EXTENT,
            in_pixel: InPixel::CENTER,
            settings,
        };
        let volume = GpuVolume::new(&gpu, &there, view.texture_layout()).unwrap();
        let staging = volume.stage(&there).unwrap();
        let function = ramps();
        let length = grid.smallest_spacing();
        let transfer = GpuTransfer::new(&gpu, &function, length, ColorSpace::Linear).unwrap();
        // SAFETY: recorded outside rendering; `run` waits, and all of it lives meanwhile.
        device
            .run(|cmd| unsafe {
                volume.record_upload_all(cmd, &staging)?;
                transfer.record_upload(cmd)
            })
            .unwrap();
        let recordings = view.recordings(&volume, Some(&transfer)).unwrap();
        assert!(recordings.len() > 2, "several bricks");
        let ring = parameter_ring(&gpu, recordings.len() as u32).unwrap();
        let recorded = (0..).zip(&recordings).map(|(slot, recording)| {
            let offset = recording.write(&ring, slot).unwrap();
            (recording.brick, offset, recording.slices)
        });
        let bytes = u64::from(EXTENT[0] * EXTENT[1] * 16);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        Self {
            recorded: recorded.collect(),
            words: ShaderVariant::of(settings, &volume),
            picture: accumulation(&gpu, EXTENT, "picture").unwrap(),
            layers: accumulation(&gpu, EXTENT, "layers").unwrap(),
            readback: Buffer::new(&gpu, bytes, usage, Memory::Readback, "read back").unwrap(),
            ring,
            transfer,
            volume,
            device,
            gpu,
        }
    }

    fn bind<B>(&self, bind: impl Fn(&Inputs) -> Result<B, gpu::Error>) -> Vec<B> {
        let bound = self.recorded.iter().map(|&(brick, ..)| {
            bind(&Inputs {
                ring: &self.ring,
                volume: &self.volume,
                brick: &self.volume.bricks()[brick],
                transfer: Some(&self.transfer),
                beside: &[],
                light: None,
                points: None,
                field: None,
                sky: None,
                skip: Skip::Nothing,
            })
            .unwrap()
        });
        bound.collect()
    }

    fn read(&mut self, before: Use) -> Vec<[u32; 4]> {
        let (gpu, picture, readback) = (&self.gpu, &self.picture, &self.readback);
        // SAFETY: recorded outside rendering; `run` waits, and all of it lives meanwhile.
        self.device
            .run(|cmd| unsafe {
                image_barrier(gpu, cmd, picture, before, Use::TransferRead);
                image_to_buffer(gpu, cmd, picture, Region::whole(picture), readback, 0)
            })
            .unwrap();
        let mut pixels = vec![[0; 4]; (EXTENT[0] * EXTENT[1]) as usize];
        let bytes = bytemuck::cast_slice_mut(&mut pixels);
        self.readback.read(0, bytes).unwrap();
        pixels
    }

    /// Premultiplied colours by rays, `tiles` in a submission each.
    fn by_rays(&mut self, submissions: &[Vec<Tile>]) -> Vec<[u32; 4]> {
        let pass = Raycast::new(&self.gpu, &self.words).unwrap();
        let list = RayTiles::new(&self.gpu, EXTENT).unwrap();
        let bound = self.bind(|inputs| pass.bind(inputs, &self.picture, &self.layers, &list));
        let mut before = Use::Nothing;
        for tiles in submissions {
            let (gpu, images) = (&self.gpu, [&self.picture, &self.layers]);
            let recorded = self.recorded.iter().zip(&bound);
            // SAFETY: recorded outside rendering, barriers between bricks; `run` waits, and all of it lives meanwhile.
            self.device
                .run(|cmd| unsafe {
                    for ((_, offset, _), bound) in recorded {
                        for image in images {
                            image_barrier(gpu, cmd, image, before, Use::ComputeWrite);
                        }
                        before = Use::ComputeWrite;
                        let tiles = tiles.iter().copied();
                        pass.record_tiles(cmd, bound, *offset, EXTENT, tiles)?;
                    }
                    Ok(())
                })
                .unwrap();
        }
        self.read(Use::ComputeWrite)
    }

    /// The same by slices: all bricks of a tile in a rendering of its own, or runs of so many slices over all.
    fn by_slices(&mut self, tiles: &[Tile], run: Option<u32>) -> Vec<[u32; 4]> {
        let (drawn, order) = (Drawn::Picture(Mode::Composite), Order::BackToFront);
        let of = Technique::Slices3d;
        let format = ACCUMULATION_FORMAT;
        let slicer = Slicer::new(&self.gpu, of, drawn, order, &self.words, format).unwrap();
        let bound = self.bind(|inputs| slicer.bind(inputs));
        let (gpu, picture) = (&self.gpu, &self.picture);
        let recorded = || self.recorded.iter().zip(&bound);
        let mut before = Use::Nothing;
        let clear = (picture.view(), Load::Clear([0.0; 4]));
        let mut target = clear;
        for &tile in tiles {
            let Some(run) = run else {
                // SAFETY: as above.
                self.device
                    .run(|cmd| unsafe {
                        image_barrier(gpu, cmd, picture, before, Use::ColorTarget);
                        begin_rendering_of(gpu, cmd, &[clear], tile);
                        for ((_, offset, slices), bound) in recorded() {
                            slicer.record_tile(cmd, bound, *offset, EXTENT, 0..*slices, tile);
                        }
                        end_rendering(gpu, cmd);
                        Ok(())
                    })
                    .unwrap();
                before = Use::ColorTarget;
                continue;
            };
            for ((_, offset, slices), bound) in recorded() {
                for first in (0..*slices).step_by(run as usize) {
                    let part = first..(first + run).min(*slices);
                    // SAFETY: as above.
                    self.device
                        .run(|cmd| unsafe {
                            image_barrier(gpu, cmd, picture, before, Use::ColorTarget);
                            begin_rendering(gpu, cmd, &[target], EXTENT);
                            slicer.record(cmd, bound, *offset, EXTENT, part);
                            end_rendering(gpu, cmd);
                            Ok(())
                        })
                        .unwrap();
                    (before, target) = (Use::ColorTarget, (picture.view(), Load::Keep));
                }
            }
        }
        self.read(Use::ColorTarget)
    }
}

#[test]
fn tiles_cut_at_random_in_any_order_and_over_any_submissions_make_the_picture() {
    let mut ready = Ready::new(&Settings::default());
    let whole = ready.by_rays(&[vec![Tile::whole(EXTENT)]]);
    assert!(whole.iter().any(|&pixel| pixel != whole[0]), "one colour");
    let mut numbers = Numbers(7);
    for _ in 0..8 {
        let mut tiles = random_tiles(&mut numbers);
        assert!(tiles.len() > 2);
        let rest = tiles.split_off(1 + numbers.below(tiles.len() - 1));
        let found = ready.by_rays(&[tiles.clone(), rest.clone()]);
        assert!(found == whole, "{tiles:?}, {rest:?}");
    }
}

#[test]
fn so_do_tiles_of_slices_and_runs_of_slices_that_load_what_the_ones_before_have_left() {
    let settings = Settings {
        technique: Technique::Slices3d,
        ..Settings::default()
    };
    let mut ready = Ready::new(&settings);
    let whole = ready.by_slices(&[Tile::whole(EXTENT)], None);
    assert!(whole.iter().any(|&pixel| pixel != whole[0]), "one colour");
    let mut numbers = Numbers(8);
    for _ in 0..4 {
        let tiles = random_tiles(&mut numbers);
        assert!(ready.by_slices(&tiles, None) == whole, "{tiles:?}");
    }
    for run in [1, 3, 1000] {
        let found = ready.by_slices(&[Tile::whole(EXTENT)], Some(run));
        assert!(found == whole, "runs of {run}");
    }
}

#[test]
fn a_tile_that_cuts_a_workgroup_is_refused() {
    let mut ready = Ready::new(&Settings::default());
    let pass = Raycast::new(&ready.gpu, &ready.words).unwrap();
    let list = RayTiles::new(&ready.gpu, EXTENT).unwrap();
    let bound = ready.bind(|inputs| pass.bind(inputs, &ready.picture, &ready.layers, &list));
    let offset = ready.recorded[0].1;
    for (origin, extent) in [
        ([4, 0], [23, 21]),
        ([0, 0], [12, 21]),
        ([0, 8], [27, 4]),
        ([8, 8], [27, 13]),
        ([16, 0], [u32::MAX, 8]),
    ] {
        let tile = Tile { origin, extent };
        // SAFETY: recorded outside rendering; nothing is dispatched, and so nothing is submitted.
        let refused = ready
            .device
            .run(|cmd| unsafe { pass.record_tiles(cmd, &bound[0], offset, EXTENT, [tile]) });
        assert!(
            matches!(refused, Err(gpu::Error::Argument { .. })),
            "{tile:?}: {refused:?}"
        );
    }
}
