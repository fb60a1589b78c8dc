//! Levels A and B: what a renderer records.

use super::frame::{Frame, Part, Recorded};
use super::pass::Pass;
use super::{Error, Renderer, Shot};
use crate::camera::{HostDepth, Nearer};
use crate::gpu::{
    Image, Load, Target, TargetClass, Tile, Use, begin_rendering, begin_rendering_of,
    end_rendering, image_barrier,
};
use crate::technique::blend::clear_color;
use crate::technique::{self, InPixel, View};
use ash::vk;

impl Renderer {
    /// Records all of a frame that lies outside of the host's rendering: parameters, the upload of a new transfer
    /// function, the compute pass of rays. Of slices in composite mode it is the parameters alone.
    ///
    /// # Errors
    /// A shot that the class is not for, a picture that cannot be made.
    ///
    /// # Safety
    /// - `cmd` is recording on the device, outside rendering, for a queue of [`Gpu::queue_family`](crate::gpu::Gpu::queue_family), and is submitted in
    ///   the order in which it was recorded, after the upload of the volume;
    /// - nothing unfinished was recorded with the shot's number of a frame in flight;
    /// - the image of the host's depth is in the layout that was said, visible to sampled reads of compute shaders.
    pub unsafe fn record(&mut self, cmd: vk::CommandBuffer, shot: &Shot) -> Result<(), Error> {
        let (frame, recorded) = self.prepare(shot)?;
        let whole = [Tile::whole(self.extent)];
        // SAFETY: the caller's promises; barriers stand between what is written and what is read.
        unsafe {
            self.function.record_upload(cmd, &self.volume)?;
            self.gather(cmd, frame, &recorded, &whole, Share::ALL)?;
        }
        self.frames[frame].recorded = Some(recorded);
        Ok(())
    }

    /// Level A: draws what [`Renderer::record`] recorded for this frame in flight over what the host has drawn. Bound
    /// pipeline, descriptor set 0, viewport and scissor are ours afterwards.
    ///
    /// # Errors
    /// Where nothing was recorded.
    ///
    /// # Safety
    /// - `cmd` is recording inside rendering to a target of [`Class::target`](super::Class::target) and of the renderer's extent;
    /// - it runs after what [`Renderer::record`] recorded, on the same queue.
    pub unsafe fn draw(&self, cmd: vk::CommandBuffer, frame: u32) -> Result<(), Error> {
        self.gpu.check_alive("draw a frame")?;
        let (there, recorded) = self.recorded(frame, "draw")?;
        // SAFETY: the caller's promises.
        unsafe { self.draw_tiles(cmd, there, recorded, &[Tile::whole(self.extent)]) };
        Ok(())
    }

    /// Writes the depth of a picture by rays into the depth attachment, where it is nearer than what is there: what the
    /// host draws later, blended or not, is hidden by the volume. Of composites it is where they become half opaque.
    ///
    /// # Errors
    /// [`Error::NoDepth`] without [`Class::gives_depth`](super::Class::gives_depth); where nothing was recorded.
    ///
    /// # Safety
    /// As [`Renderer::draw`]; depth may be written.
    pub unsafe fn draw_depth(&self, cmd: vk::CommandBuffer, frame: u32) -> Result<(), Error> {
        let (there, recorded) = self.recorded(frame, "draw_depth")?;
        match (&self.pass, &there.sets.depth) {
            (
                Pass::Rays {
                    depth: Some(pass), ..
                },
                Some(bound),
            ) => {
                // SAFETY: the caller's promises.
                unsafe { pass.record(cmd, bound, recorded.parts[0].offset, self.extent) };
                Ok(())
            }
            _ => Err(Error::NoDepth {
                what: format!("a renderer without `gives_depth` ({})", self.class.what()),
            }),
        }
    }

    /// Level B: [`Renderer::record`] and [`Renderer::draw`] into an image of the host's that arrives and leaves as
    /// `target` says, with what it holds kept (or cleared, where `load` says so).
    ///
    /// # Errors
    /// As those, and [`Error::OtherClass`] for a target of another format or size, and for a class with a depth
    /// attachment or several samples, which only a host's own rendering has.
    ///
    /// # Safety
    /// As [`Renderer::record`]; the target is in its state `before`, and lives until `cmd` has run.
    pub unsafe fn record_into(
        &mut self,
        cmd: vk::CommandBuffer,
        shot: &Shot,
        target: &Target,
        load: Load,
    ) -> Result<(), Error> {
        self.check_target(target, load)?;
        // SAFETY: the caller's promises.
        unsafe {
            self.record(cmd, shot)?;
            target.enter(&self.gpu, cmd, Use::ColorTarget);
            begin_rendering(&self.gpu, cmd, &[(target.view, load)], self.extent);
            let drawn = self.draw(cmd, shot.frame);
            end_rendering(&self.gpu, cmd);
            target.leave(&self.gpu, cmd, Use::ColorTarget);
            drawn
        }
    }
}

/// Which part of a frame is recorded: the first has what comes before all tiles, the last what comes after.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    pub is_first: bool,
    pub is_last: bool,
}

impl Share {
    const ALL: Self = Self {
        is_first: true,
        is_last: true,
    };
}

impl Renderer {
    /// The frame of a shot and its parameters, written. Nothing that was recorded for it before is drawn or picked now.
    pub(super) fn prepare(&mut self, shot: &Shot) -> Result<(usize, Recorded), Error> {
        self.gpu.check_alive("record a frame")?;
        let frame = self.frame_number(shot.frame)?;
        shot.camera.check()?;
        if !self.volume.is_uploaded() {
            return Err(Error::NotUploaded);
        }
        let depth = self.depth_of(shot)?;
        let recorded = self.describe(frame, shot, depth)?;
        let there = &mut self.frames[frame];
        (there.recorded, there.begun, there.picked) = (None, None, None);
        Ok((frame, recorded))
    }

    /// Refuses a target that the renderer was not made for, and states that lose what is to be kept.
    pub(super) fn check_target(&self, target: &Target, load: Load) -> Result<(), Error> {
        let wanted = TargetClass::from(target.format);
        if self.class.target != wanted || self.extent != target.extent {
            return Err(Error::OtherClass {
                made: format!("{:?} of {:?} pixels", self.class.target, self.extent),
                wanted: format!("{wanted:?} of {:?} pixels", target.extent),
            });
        }
        let gives_up = |layout: vk::ImageLayout| {
            let layouts = [vk::ImageLayout::UNDEFINED, vk::ImageLayout::PREINITIALIZED];
            layouts.contains(&layout)
        };
        if load == Load::Keep && target.before.layout == vk::ImageLayout::UNDEFINED {
            return Err(Error::TargetState {
                wanted: "`Load::Clear`, or the layout that what is kept is in, in `before`",
                found: target.before.layout,
            });
        }
        match gives_up(target.after.layout) {
            true => Err(Error::TargetState {
                wanted: "a layout in `after` that keeps what was drawn",
                found: target.after.layout,
            }),
            false => Ok(()),
        }
    }

    /// Draws some tiles of a picture.
    ///
    /// # Safety
    /// As [`Renderer::draw`]; resolved pictures have been gathered whole.
    pub(super) unsafe fn draw_tiles(
        &self,
        cmd: vk::CommandBuffer,
        there: &Frame,
        recorded: &Recorded,
        tiles: &[Tile],
    ) {
        let (extent, parts) = (self.extent, &recorded.parts);
        // SAFETY: the caller's promises; what is bound lives as long as the frame, and then until it is retired.
        unsafe {
            match (&self.pass, &there.sets.resolve) {
                (Pass::Slices(slicer), _) => {
                    for (&tile, part) in
                        tiles.iter().flat_map(|t| parts.iter().map(move |p| (t, p)))
                    {
                        let bound = &there.sets.bricks[recorded.copy][part.brick];
                        let slices = 0..part.slices;
                        slicer.record_tile(cmd, bound, part.offset, extent, slices, tile);
                    }
                }
                (Pass::Rays { resolve, .. } | Pass::Projected { resolve, .. }, Some(bound)) => {
                    for &tile in tiles {
                        resolve.record_tile(cmd, bound, parts[0].offset, extent, tile);
                    }
                }
                (Pass::Rays { .. } | Pass::Projected { .. }, None) => {
                    unreachable!("bound with the frame")
                }
            }
        }
    }

    /// The images that the pass leaves, in their order.
    pub(super) fn left<'a>(&self, [gathered, layers]: &'a [Image; 2]) -> Vec<&'a Image> {
        match &self.pass {
            Pass::Rays { pass, .. } => pass.images(gathered, layers),
            Pass::Slices(_) | Pass::Projected { .. } => vec![gathered],
        }
    }

    pub(super) fn recorded(
        &self,
        frame: u32,
        what: &'static str,
    ) -> Result<(&Frame, &Recorded), Error> {
        let there = &self.frames[self.frame_number(frame)?];
        match &there.recorded {
            Some(recorded) => Ok((there, recorded)),
            None => Err(Error::NotRecorded { frame, what }),
        }
    }

    fn depth_of(&self, shot: &Shot) -> Result<Option<HostDepth>, Error> {
        let is_wanted = self.class.host_depth || self.class.gives_depth;
        match (is_wanted, shot.depth) {
            (true, None) => Err(Error::HostDepth {
                wanted: "`Shot::depth`, from `Camera::from_matrices`".into(),
                found: "none".into(),
            }),
            (false, _) => Ok(None),
            (true, Some(depth)) => {
                let is_reversed = self.class.target.depth.map(|depth| depth.is_reversed);
                let found = depth.nearer == Nearer::Larger;
                match is_reversed.is_some_and(|wanted| wanted != found) {
                    true => Err(Error::HostDepth {
                        wanted: "`Shot::depth` and `Class::target` with the same depth nearer"
                            .into(),
                        found: format!("{:?}", depth.nearer),
                    }),
                    false => Ok(Some(depth)),
                }
            }
        }
    }

    /// Parameters into the ring.
    fn describe(
        &self,
        frame: usize,
        shot: &Shot,
        depth: Option<HostDepth>,
    ) -> Result<Recorded, Error> {
        let grid = self.volume.grid();
        let settings = &self.class.settings;
        let view = View {
            grid,
            camera: shot.camera,
            extent_pixels: self.extent,
            in_pixel: InPixel::CENTER,
            settings,
        };
        let layout = view.texture_layout();
        let mut copies = self.volume.copies().iter();
        let copy = copies.position(|copy| copy.layout() == layout);
        let copy = copy.ok_or(technique::Error::WrongLayout {
            wanted: layout,
            found: self.volume.copies()[0].layout(),
        })?;
        view.check_turns(
            &self.words,
            1,
            self.function.turns,
            self.gpu.limits().max_loop_turns,
        )?;
        let transfer = self.function.transfer();
        let recordings = view.recordings(&self.volume.copies()[copy], transfer)?;
        let first = (frame * self.ring.slots() as usize / self.frames.len()) as u32;
        let skip = self.function.skip(&self.volume);
        let parts = (first..).zip(recordings).map(|(slot, mut recording)| {
            recording.skip(skip);
            match depth {
                Some(depth) if self.class.host_depth => recording.behind(&depth, grid.center()),
                Some(depth) => recording.in_depths_of(&depth, grid.center()),
                None => {}
            }
            Ok(Part {
                brick: recording.brick,
                offset: recording.write(&self.ring, slot)?,
                slices: recording.slices,
            })
        });
        Ok(Recorded {
            camera: *shot.camera,
            copy,
            parts: parts.collect::<Result<_, Error>>()?,
        })
    }

    /// # Safety
    /// As [`Renderer::record`].
    pub(super) unsafe fn gather(
        &self,
        cmd: vk::CommandBuffer,
        frame: usize,
        recorded: &Recorded,
        tiles: &[Tile],
        share: Share,
    ) -> Result<(), Error> {
        let (gpu, extent) = (&self.gpu, self.extent);
        let there = &self.frames[frame];
        let Some(images) = &there.images else {
            return Ok(());
        };
        let left = self.left(images);
        let barriers = |before, after| {
            for image in &left {
                // SAFETY: the caller's promises.
                unsafe { image_barrier(gpu, cmd, image, before, after) };
            }
        };
        let bound = &there.sets.bricks[recorded.copy];
        let written = match &self.pass {
            Pass::Rays { .. } => Use::ComputeWrite,
            Pass::Projected { .. } | Pass::Slices(_) => Use::ColorTarget,
        };
        let mut before = match share.is_first {
            true => Use::Nothing,
            false => written,
        };
        match &self.pass {
            Pass::Rays { pass, .. } => {
                for part in &recorded.parts {
                    barriers(before, written);
                    before = written;
                    let (bound, tiles) = (&bound[part.brick], tiles.iter().copied());
                    // SAFETY: the caller's promises.
                    unsafe { pass.record_tiles(cmd, bound, part.offset, extent, tiles)? };
                }
            }
            Pass::Projected { slicer, .. } => {
                barriers(before, written);
                let clear = Load::Clear(clear_color(self.class.settings.mode));
                for &tile in tiles {
                    // SAFETY: the caller's promises.
                    unsafe {
                        begin_rendering_of(gpu, cmd, &[(left[0].view(), clear)], tile);
                        for part in &recorded.parts {
                            let (bound, slices) = (&bound[part.brick], 0..part.slices);
                            slicer.record_tile(cmd, bound, part.offset, extent, slices, tile);
                        }
                        end_rendering(gpu, cmd);
                    }
                }
            }
            Pass::Slices(_) => {}
        }
        if share.is_last {
            barriers(written, Use::FragmentSampled);
        }
        Ok(())
    }
}
