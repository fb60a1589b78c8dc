//! Slices blended with each other in floats, in an image of ours (`sampling.md` 5).
//!
//! ```text
//! 32-bit blending    all slices into the picture
//! 16-bit blending    picture = 0
//!                    for each batch of 64 slices:
//!                        draw     the slices into a 16-bit image
//!                        merge    that image into the picture, in f32
//! ```
//!
//! The picture is resolved once into whatever format a target has: a target of 8 bits a channel that slices were
//! blended into one by one would round each of them to half a code, and slices fainter than that would vanish.

use super::super::blend::{Drawn, clear_color};
use super::super::host_depth_copy::{FARTHEST, HostDepthCopy};
use super::super::merge::{BATCH_FORMAT, MAX_BATCH_SLICES, Merge, is_merged};
use super::super::{ACCUMULATION_FORMAT, DepthAccess, Inputs, Settings, Slicer, accumulation};
use super::patches::patches;
use super::{Bound, BrickPass, Canvas, CanvasDesc, Gather, GatherDesc, PICTURE, Part, Player};
use crate::gpu::{Bindings, Error, Gpu, Image, ImageDesc, ImageKind, Load, Resource, Tile, Use};
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// The passes of a slicer.
///
/// # Errors
/// Where the mode needs 32-bit blending and the device has none.
pub(in crate::technique) fn slices(desc: &GatherDesc) -> Result<Box<dyn Gather>, Error> {
    if desc.is_patched {
        return patches(desc);
    }
    let GatherDesc {
        gpu,
        drawn,
        depth_access,
        ..
    } = *desc;
    let Settings {
        technique, order, ..
    } = *desc.settings;
    let format = blend_format(gpu, drawn);
    let is_tested = depth_access == DepthAccess::Tested;
    let target = match is_tested {
        true => HostDepthCopy::target(format),
        false => format.into(),
    };
    let merge = || Merge::new(gpu, drawn, order).map(Arc::new);
    let host_depth = || HostDepthCopy::new(gpu, format).map(Arc::new);
    let slicer = Slicer::seen(
        gpu,
        technique,
        drawn,
        order,
        desc.variant,
        target,
        depth_access,
    )?;
    Ok(Box::new(Slices {
        gpu: Arc::clone(gpu),
        slicer: Arc::new(slicer),
        merge: is_merged(gpu, drawn).then(merge).transpose()?,
        host_depth: is_tested.then(host_depth).transpose()?,
        clear: clear_of(drawn),
    }))
}

/// The format that slices are blended in.
pub(super) fn blend_format(gpu: &Gpu, drawn: Drawn) -> vk::Format {
    match is_merged(gpu, drawn) {
        true => BATCH_FORMAT,
        false => ACCUMULATION_FORMAT,
    }
}

/// What slices are cleared to before the first.
pub(super) fn clear_of(drawn: Drawn) -> [f32; 4] {
    match drawn {
        Drawn::Picture(mode) => clear_color(mode),
        Drawn::Count => [0.0; 4],
    }
}

/// The image of one batch.
pub(super) fn batch_image(gpu: &Arc<Gpu>, [width, height]: [u32; 2]) -> Result<Image, Error> {
    let desc = ImageDesc {
        kind: ImageKind::D2,
        extent: [width, height, 1],
        format: BATCH_FORMAT,
        usage: vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED,
        name: "batch of slices",
    };
    Image::new(gpu, &desc)
}

#[derive(Debug)]
struct Slices {
    gpu: Arc<Gpu>,
    slicer: Arc<Slicer>,
    /// Where 32-bit floats cannot be blended.
    merge: Option<Arc<Merge>>,
    /// Where the slices are tested against what a host has drawn.
    host_depth: Option<Arc<HostDepthCopy>>,
    clear: [f32; 4],
}

/// The image behind the picture that there is of the two: of a batch, and of the host's depth.
const fn numbers(has_batch: bool) -> [usize; 2] {
    [PICTURE + 1, PICTURE + 1 + has_batch as usize]
}

impl Gather for Slices {
    fn canvas(&self, desc: &CanvasDesc) -> Result<Canvas, Error> {
        let (gpu, extent) = (&self.gpu, desc.extent);
        let picture = accumulation(gpu, extent, "slices")?;
        let batch = self.merge.as_ref().map(|_| batch_image(gpu, extent));
        let depth = self.host_depth.as_ref();
        let depth = depth.map(|_| HostDepthCopy::image(gpu, extent));
        let images = [Some(picture), batch.transpose()?, depth.transpose()?];
        Ok(Canvas::new(extent, images.into_iter().flatten()))
    }

    fn bind(
        &self,
        canvas: &Canvas,
        bricks: &[Inputs],
        host_depth: Option<Resource>,
    ) -> Result<Box<dyn Bound>, Error> {
        let [batch, depth] = numbers(self.merge.is_some());
        let bind = |inputs: &Inputs| match host_depth {
            Some(depth) if self.host_depth.is_none() => self.slicer.bind_behind(inputs, depth),
            _ => self.slicer.bind(inputs),
        };
        let merge = self.merge.as_ref().map(|merge| {
            let bound = merge.bind(canvas.image(batch), canvas.image(PICTURE))?;
            Ok::<_, Error>((Arc::clone(merge), bound))
        });
        let copied = self.host_depth.as_ref().zip(host_depth);
        let copied = copied.map(|(copy, of)| {
            let bound = copy.bind(bricks[0].ring, of)?;
            Ok::<_, Error>((Arc::clone(copy), bound))
        });
        Ok(Box::new(BoundSlices {
            slicer: Arc::clone(&self.slicer),
            bricks: bricks.iter().map(bind).collect::<Result<_, _>>()?,
            merge: merge.transpose()?,
            host_depth: copied.transpose()?,
            depth,
            clear: self.clear,
        }))
    }
}

#[derive(Debug)]
struct BoundSlices {
    slicer: Arc<Slicer>,
    bricks: Vec<Bindings>,
    merge: Option<(Arc<Merge>, Bindings)>,
    host_depth: Option<(Arc<HostDepthCopy>, Bindings)>,
    /// The image of the host's depth.
    depth: usize,
    clear: [f32; 4],
}

impl Bound for BoundSlices {
    unsafe fn record(
        &self,
        player: &mut Player,
        bricks: &[BrickPass],
        part: &Part,
    ) -> Result<(), Error> {
        let cleared = Load::Clear(self.clear);
        // SAFETY: the caller's promises.
        unsafe {
            match &self.merge {
                None => {
                    player.bring([(PICTURE, Use::ColorTarget)]);
                    let all = bricks.iter().map(|brick| (brick, 0..brick.slices));
                    let load = match player.canvas.resumes() {
                        true => Load::Keep,
                        false => cleared,
                    };
                    self.draw(player, all, (PICTURE, load), part.tiles);
                }
                Some((merge, bound)) => {
                    if part.is_first && !player.canvas.resumes() {
                        player.clear(PICTURE);
                    }
                    let [batch, _] = numbers(true);
                    let batches = bricks.iter().flat_map(|brick| {
                        let of = batches(brick.slices, MAX_BATCH_SLICES);
                        of.map(move |slices| (brick, slices))
                    });
                    for slices in batches {
                        player.bring([(batch, Use::ColorTarget)]);
                        self.draw(player, [slices].into_iter(), (batch, cleared), part.tiles);
                        player.bring([(batch, Use::ComputeSampled), (PICTURE, Use::ComputeWrite)]);
                        for &tile in part.tiles {
                            let extent = player.canvas.extent();
                            merge.record_tile(player.cmd, bound, extent, tile)?;
                        }
                    }
                }
            }
            if part.is_last {
                player.bring([(PICTURE, Use::FragmentSampled)]);
            }
        }
        Ok(())
    }
}

impl BoundSlices {
    /// Of each tile one rendering: the host's depth, if any, then the slices.
    ///
    /// # Safety
    /// As [`Bound::record`]; the target is in [`Use::ColorTarget`].
    unsafe fn draw<'a>(
        &self,
        player: &mut Player,
        slices: impl Iterator<Item = (&'a BrickPass, Range<u32>)> + Clone,
        target: (usize, Load),
        tiles: &[Tile],
    ) {
        let extent = player.canvas.extent();
        let tested = self.host_depth.as_ref();
        let depth = tested.map(|_| (self.depth, FARTHEST));
        for &tile in tiles {
            // SAFETY: the caller's promises.
            unsafe {
                if let Some((number, _)) = depth {
                    player.give_up_depth(number);
                    player.bring([(number, Use::DepthTarget)]);
                }
                player.render(target, depth, tile, |cmd| {
                    let mut slices = slices.clone().peekable();
                    if let (Some((copy, bound)), Some((brick, _))) = (tested, slices.peek()) {
                        copy.record_tile(cmd, bound, brick.offset, extent, tile);
                    }
                    for (brick, slices) in slices {
                        let bound = &self.bricks[brick.number];
                        self.slicer
                            .record_tile(cmd, bound, brick.offset, extent, slices, tile);
                    }
                });
            }
        }
    }
}

/// Slices, so many at once.
pub(super) fn batches(slices: u32, at_once: u32) -> impl Iterator<Item = Range<u32>> + Clone {
    let firsts = (0..slices).step_by(at_once as usize);
    firsts.map(move |first| first..first.saturating_add(at_once).min(slices))
}
