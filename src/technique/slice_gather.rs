//! Slices blended with each other in floats, in an image of ours (`sampling.md` 5).
//!
//! ```text
//! 32-bit blending    all slices into the accumulation
//! 16-bit blending    batches of 64 slices into a 16-bit image, each merged into the accumulation in f32
//! ```
//!
//! The accumulation is resolved once into whatever format a picture has: a target of 8 bits a channel that slices were
//! blended into one by one would round each of them to half a code, and slices fainter than that would vanish.

use super::blend::{Drawn, clear_color};
use super::host_depth_copy::{FARTHEST, HostDepthCopy};
use super::merge::{BATCH_FORMAT, MAX_BATCH_SLICES, Merge, is_merged};
use super::{ACCUMULATION_FORMAT, Inputs, Settings, Sight, Slicer, Words};
use crate::gpu::{
    Bindings, Error, Gpu, Image, ImageDesc, ImageKind, Load, ParameterRing, Resource, Tile, Use,
    barriers, begin_rendering_behind, clear_image, end_rendering, image_barrier,
};
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// The format that slices are blended in, and whether batches of them have to be merged.
pub fn blend_format(gpu: &Gpu, drawn: Drawn) -> (vk::Format, bool) {
    match is_merged(gpu, drawn) {
        true => (BATCH_FORMAT, true),
        false => (ACCUMULATION_FORMAT, false),
    }
}

/// What slices are cleared to before the first.
pub fn clear_of(drawn: Drawn) -> [f32; 4] {
    match drawn {
        Drawn::Picture(mode) => clear_color(mode),
        Drawn::Count => [0.0; 4],
    }
}

/// The image of one batch.
///
/// # Errors
/// An extent over a limit of the device, no memory.
pub fn batch_image(gpu: &Arc<Gpu>, [width, height]: [u32; 2]) -> Result<Image, Error> {
    let desc = ImageDesc {
        kind: ImageKind::D2,
        extent: [width, height, 1],
        format: BATCH_FORMAT,
        usage: vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED,
        name: "batch of slices",
    };
    Image::new(gpu, &desc)
}

/// The pipelines.
#[derive(Debug)]
pub struct SliceGather {
    gpu: Arc<Gpu>,
    slicer: Slicer,
    /// Where 32-bit floats cannot be blended.
    merge: Option<Merge>,
    /// Where the slices are tested against what a host has drawn.
    host_depth: Option<HostDepthCopy>,
    clear: [f32; 4],
}

/// Images of one frame in flight beside the accumulation, and what is bound to them.
#[derive(Debug)]
pub struct GatherImages {
    batch: Option<(Image, Bindings)>,
    depth: Option<Image>,
}

/// One brick's slices.
#[derive(Clone, Copy, Debug)]
pub struct BrickSlices<'a> {
    /// From [`SliceGather::bind`].
    pub bindings: &'a Bindings,
    /// Of the parameters in the ring.
    pub offset: u32,
    /// How many.
    pub slices: u32,
}

/// A part of a picture: some of its pixels, with all that they show.
#[derive(Clone, Copy, Debug)]
pub struct PicturePart<'a> {
    /// The pixels.
    pub tiles: &'a [Tile],
    /// No other part is recorded before it.
    pub is_first: bool,
    /// None comes after it.
    pub is_last: bool,
}

/// What one recording draws into.
#[derive(Clone, Copy, Debug)]
pub struct GatherInto<'a> {
    /// Four f32 a pixel, of `extent`.
    pub accumulation: &'a Image,
    /// From [`SliceGather::images`], for that accumulation.
    pub images: &'a GatherImages,
    /// From [`SliceGather::bind_host_depth`], where the host's depth is tested.
    pub host_depth: Option<&'a Bindings>,
    /// Pixels across and down.
    pub extent: [u32; 2],
}

impl SliceGather {
    /// Compiles. With [`Sight::Tested`] slices are tested against a copy of the host's depth
    /// ([`super::Recording::tested_in_copy`]).
    ///
    /// # Errors
    /// Where the mode needs 32-bit blending and the device has none.
    pub fn new(
        gpu: &Arc<Gpu>,
        settings: &Settings,
        drawn: Drawn,
        words: &Words,
        sight: Sight,
    ) -> Result<Self, Error> {
        let (technique, order) = (settings.technique, settings.order);
        let (format, is_merged) = blend_format(gpu, drawn);
        let is_tested = sight == Sight::Tested;
        let target = match is_tested {
            true => HostDepthCopy::target(format),
            false => format.into(),
        };
        let merge = || Merge::new(gpu, drawn, order);
        let host_depth = || HostDepthCopy::new(gpu, format);
        Ok(Self {
            gpu: Arc::clone(gpu),
            slicer: Slicer::seen(gpu, technique, drawn, order, words, target, sight)?,
            merge: is_merged.then(merge).transpose()?,
            host_depth: is_tested.then(host_depth).transpose()?,
            clear: clear_of(drawn),
        })
    }

    /// What is drawn into beside an accumulation.
    ///
    /// # Errors
    /// An extent over a limit of the device, no memory.
    pub fn images(&self, accumulation: &Image) -> Result<GatherImages, Error> {
        let [width, height, _] = accumulation.extent();
        let extent = [width, height];
        let batch = self.merge.as_ref().map(|merge| {
            let image = batch_image(&self.gpu, extent)?;
            let bound = merge.bind(&image, accumulation)?;
            Ok::<_, Error>((image, bound))
        });
        let depth = self.host_depth.as_ref();
        let depth = depth.map(|_| HostDepthCopy::image(&self.gpu, extent));
        Ok(GatherImages {
            batch: batch.transpose()?,
            depth: depth.transpose()?,
        })
    }

    /// Binds a brick's inputs; `host_depth` is that of [`Sight::Read`].
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind(&self, inputs: &Inputs, host_depth: Option<Resource>) -> Result<Bindings, Error> {
        match host_depth {
            Some(depth) if self.host_depth.is_none() => self.slicer.bind_behind(inputs, depth),
            _ => self.slicer.bind(inputs),
        }
    }

    /// Binds the host's depth buffer where slices are tested against it; `None` where they are not.
    ///
    /// # Errors
    /// Where the device gives no descriptors.
    pub fn bind_host_depth(
        &self,
        ring: &ParameterRing,
        host_depth: Resource,
    ) -> Result<Option<Bindings>, Error> {
        let copy = self.host_depth.as_ref();
        copy.map(|copy| copy.bind(ring, host_depth)).transpose()
    }

    /// Records all slices of some tiles, and leaves the accumulation in `Use::FragmentSampled` with the last part.
    ///
    /// # Errors
    /// A picture larger than the device can dispatch.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; parts are recorded and submitted in their order;
    /// - nothing unfinished uses the accumulation and its images when the first part begins, and all of it and what is
    ///   bound lives until the last has run;
    /// - the inputs are in `Use::Sampled`, and a host's depth is visible to fragment shaders.
    pub unsafe fn record<'a>(
        &self,
        cmd: vk::CommandBuffer,
        bricks: impl Iterator<Item = BrickSlices<'a>> + Clone,
        into: GatherInto<'_>,
        part: PicturePart<'_>,
    ) -> Result<(), Error> {
        let batch = into.images.batch.as_ref();
        // SAFETY: the caller's promises.
        unsafe {
            match (&self.merge, batch) {
                (Some(merge), Some((batch, merged))) => {
                    self.record_batches(cmd, bricks, into, part, merge, (batch, merged))
                }
                _ => {
                    self.record_at_once(cmd, bricks, into, part);
                    Ok(())
                }
            }
        }
    }

    /// # Safety
    /// As [`Self::record`].
    unsafe fn record_at_once<'a>(
        &self,
        cmd: vk::CommandBuffer,
        bricks: impl Iterator<Item = BrickSlices<'a>> + Clone,
        into: GatherInto<'_>,
        part: PicturePart<'_>,
    ) {
        let (gpu, image) = (&self.gpu, into.accumulation);
        // What earlier parts have drawn stays.
        let before = match part.is_first {
            true => Use::Nothing,
            false => Use::ColorTarget,
        };
        // SAFETY: the caller's promises; barriers stand between what is written and what is read.
        unsafe {
            image_barrier(gpu, cmd, image, before, Use::ColorTarget);
            for &tile in part.tiles {
                let slices = bricks.clone().map(|brick| (brick, 0..brick.slices));
                self.draw(cmd, slices, into, image, tile);
            }
            if part.is_last {
                image_barrier(gpu, cmd, image, Use::ColorTarget, Use::FragmentSampled);
            }
        }
    }

    /// # Safety
    /// As [`Self::record`].
    unsafe fn record_batches<'a>(
        &self,
        cmd: vk::CommandBuffer,
        bricks: impl Iterator<Item = BrickSlices<'a>> + Clone,
        into: GatherInto<'_>,
        part: PicturePart<'_>,
        merge: &Merge,
        (batch, merged): (&Image, &Bindings),
    ) -> Result<(), Error> {
        let (gpu, image) = (&self.gpu, into.accumulation);
        // SAFETY: as above.
        unsafe {
            let mut before = Use::ComputeWrite;
            if part.is_first {
                image_barrier(gpu, cmd, image, Use::Nothing, Use::TransferWrite);
                clear_image(gpu, cmd, image, [0.0; 4]);
                before = Use::TransferWrite;
            }
            // What the merge before has read is overwritten only after it.
            let mut last = match part.is_first {
                true => Use::Nothing,
                false => Use::ComputeSampled,
            };
            for brick in bricks {
                for slices in batches(brick.slices) {
                    image_barrier(gpu, cmd, batch, last, Use::ColorTarget);
                    last = Use::ComputeSampled;
                    for &tile in part.tiles {
                        let slices = [(brick, slices.clone())].into_iter();
                        self.draw(cmd, slices, into, batch, tile);
                    }
                    let drawn = (batch, Use::ColorTarget, Use::ComputeSampled);
                    barriers(
                        gpu,
                        cmd,
                        [],
                        [],
                        [drawn, (image, before, Use::ComputeWrite)],
                    );
                    for &tile in part.tiles {
                        merge.record_tile(cmd, merged, into.extent, tile)?;
                    }
                    before = Use::ComputeWrite;
                }
            }
            if part.is_last {
                image_barrier(gpu, cmd, image, before, Use::FragmentSampled);
            }
        }
        Ok(())
    }

    /// One rendering: the host's depth, if any, then the slices.
    ///
    /// # Safety
    /// As [`Self::record`]; `image` is in `Use::ColorTarget`.
    unsafe fn draw<'a>(
        &self,
        cmd: vk::CommandBuffer,
        slices: impl Iterator<Item = (BrickSlices<'a>, Range<u32>)>,
        into: GatherInto<'_>,
        image: &Image,
        tile: Tile,
    ) {
        let (gpu, extent) = (&self.gpu, into.extent);
        let depth = into.images.depth.as_ref();
        let target = [(image.view(), Load::Clear(self.clear))];
        let mut slices = slices.peekable();
        // SAFETY: the caller's promises.
        unsafe {
            if let Some(depth) = depth {
                image_barrier(gpu, cmd, depth, Use::DepthDone, Use::DepthTarget);
            }
            let attached = depth.map(|depth| (depth.view(), FARTHEST));
            begin_rendering_behind(gpu, cmd, &target, attached, tile);
            if let (Some(copy), Some(bound), Some((brick, _))) =
                (&self.host_depth, into.host_depth, slices.peek())
            {
                copy.record_tile(cmd, bound, brick.offset, extent, tile);
            }
            for (brick, slices) in slices {
                let (bindings, offset) = (brick.bindings, brick.offset);
                self.slicer
                    .record_tile(cmd, bindings, offset, extent, slices, tile);
            }
            end_rendering(gpu, cmd);
        }
    }
}

/// Slices in batches.
fn batches(slices: u32) -> impl Iterator<Item = Range<u32>> {
    let firsts = (0..slices).step_by(MAX_BATCH_SLICES as usize);
    firsts.map(move |first| first..(first + MAX_BATCH_SLICES).min(slices))
}
