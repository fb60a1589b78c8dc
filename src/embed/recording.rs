//! Levels A and B: what a renderer records.

use super::frame::{Frame, Part, Recorded};
use super::pass::Pass;
use super::{Error, Renderer, Shot};
use crate::camera::{HostDepth, Nearer};
use crate::gpu::{
    Image, Load, Target, TargetClass, Tile, Use, begin_rendering, end_rendering, image_barrier,
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
        self.gpu.check_alive("record a frame")?;
        let frame = self.frame_number(shot.frame)?;
        shot.camera.check()?;
        if !self.volume.is_uploaded() {
            return Err(Error::NotUploaded);
        }
        let depth = self.depth_of(shot)?;
        let recorded = self.describe(frame, shot, depth)?;
        // SAFETY: the caller's promises; barriers stand between what is written and what is read.
        unsafe {
            self.function.record_upload(cmd, &self.volume)?;
            self.gather(cmd, frame, &recorded)?;
        }
        self.frames[frame].recorded = Some(recorded);
        self.frames[frame].picked = None;
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
        let (extent, parts) = (self.extent, &recorded.parts);
        // SAFETY: the caller's promises; what is bound lives as long as the frame, and then until it is retired.
        unsafe {
            match (&self.pass, &there.sets.resolve) {
                (Pass::Slices(slicer), _) => {
                    for part in parts {
                        let bound = &there.sets.bricks[recorded.copy][part.brick];
                        slicer.record(cmd, bound, part.offset, extent, 0..part.slices);
                    }
                }
                (Pass::Rays { resolve, .. } | Pass::Projected { resolve, .. }, Some(bound)) => {
                    resolve.record(cmd, bound, parts[0].offset, extent);
                }
                (Pass::Rays { .. } | Pass::Projected { .. }, None) => {
                    unreachable!("bound with the frame")
                }
            }
        }
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
        let wanted = TargetClass::from(target.format);
        if self.class.target != wanted || self.extent != target.extent {
            return Err(Error::OtherClass {
                made: format!("{:?} of {:?} pixels", self.class.target, self.extent),
                wanted: format!("{wanted:?} of {:?} pixels", target.extent),
            });
        }
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

impl Renderer {
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
    unsafe fn gather(
        &self,
        cmd: vk::CommandBuffer,
        frame: usize,
        recorded: &Recorded,
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
        let mut before = Use::Nothing;
        match &self.pass {
            Pass::Rays { pass, .. } => {
                for part in &recorded.parts {
                    barriers(before, Use::ComputeWrite);
                    before = Use::ComputeWrite;
                    let whole = [Tile::whole(extent)];
                    let bound = &bound[part.brick];
                    // SAFETY: the caller's promises.
                    unsafe { pass.record_tiles(cmd, bound, part.offset, extent, whole)? };
                }
            }
            Pass::Projected { slicer, .. } => {
                barriers(before, Use::ColorTarget);
                before = Use::ColorTarget;
                let clear = Load::Clear(clear_color(self.class.settings.mode));
                // SAFETY: the caller's promises.
                unsafe {
                    begin_rendering(gpu, cmd, &[(left[0].view(), clear)], extent);
                    for part in &recorded.parts {
                        let bound = &bound[part.brick];
                        slicer.record(cmd, bound, part.offset, extent, 0..part.slices);
                    }
                    end_rendering(gpu, cmd);
                }
            }
            Pass::Slices(_) => {}
        }
        barriers(before, Use::FragmentSampled);
        Ok(())
    }
}
