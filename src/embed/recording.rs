//! Levels A and B: what a renderer records.

use super::frame::{Frame, Part, Recorded};
use super::{Error, Renderer, Shot};
use crate::camera::{Camera, HostDepth, Nearer};
use crate::gpu::{
    Bindings, Load, Target, TargetClass, Tile, Use, begin_rendering, end_rendering, image_barrier,
};
use crate::technique::blend::clear_color;
use crate::technique::slices_3d::half_angle::HalfAngleSlices;
use crate::technique::{self, InPixel, Recording, View};
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
        let mut made = std::mem::take(&mut self.spare);
        // SAFETY: the caller's promises; barriers stand between what is written and what is read.
        let recorded = self
            .describe(frame, shot, depth, &mut made)
            .and_then(|()| unsafe {
                self.function.record_upload(cmd)?;
                self.gather(cmd, frame, &made)
            });
        if recorded.is_ok() {
            let there = &mut self.frames[frame];
            std::mem::swap(&mut there.recorded, &mut made);
            there.picked = None;
        }
        self.spare = made;
        recorded
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
        let (there, _, copy) = self.recorded(frame, "draw")?;
        let (extent, parts) = (self.extent, &there.recorded.picture);
        // SAFETY: the caller's promises; what is bound lives as long as the frame, and then until it is retired.
        unsafe {
            match (&self.pass.resolve, &there.sets.resolve) {
                (Some(resolve), Some(bound)) => {
                    resolve.record(cmd, bound, parts[0].offset, extent);
                }
                _ => self.draw_slices(cmd, &there.sets.slices[copy], parts),
            }
        }
        Ok(())
    }

    /// Writes the depth of a picture into the depth attachment, where it is nearer than what is there: what the host draws
    /// later, blended or not, is hidden by the volume. Of composites it is where they become half opaque, along rays or
    /// from slice to slice.
    ///
    /// # Errors
    /// [`Error::NoDepth`] without [`Class::gives_depth`](super::Class::gives_depth) and a depth attachment; where nothing
    /// was recorded.
    ///
    /// # Safety
    /// As [`Renderer::draw`]; depth may be written.
    pub unsafe fn draw_depth(&self, cmd: vk::CommandBuffer, frame: u32) -> Result<(), Error> {
        let (there, ..) = self.recorded(frame, "draw_depth")?;
        let (Some(pass), Some(bound)) = (&self.pass.depth, &there.sets.depth) else {
            return Err(Error::NoDepth {
                what: format!("a renderer without `gives_depth` ({})", self.class.what()),
            });
        };
        let offset = there.recorded.picture[0].offset;
        // SAFETY: the caller's promises.
        unsafe { pass.record(cmd, bound, offset, self.extent) };
        Ok(())
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
    /// A frame for which something was recorded, with its camera and copy of the volume.
    pub(super) fn recorded(
        &self,
        frame: u32,
        what: &'static str,
    ) -> Result<(&Frame, Camera, usize), Error> {
        let there = &self.frames[self.frame_number(frame)?];
        match there.recorded.shot {
            Some((camera, copy)) => Ok((there, camera, copy)),
            None => Err(Error::NotRecorded { frame, what }),
        }
    }

    fn depth_of(&self, shot: &Shot) -> Result<Option<HostDepth>, Error> {
        let is_wanted = self.class.host_depth || self.class.draws_depth();
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

    /// Parameters into the ring, and what they are of into `made`.
    fn describe(
        &self,
        frame: usize,
        shot: &Shot,
        depth: Option<HostDepth>,
        made: &mut Recorded,
    ) -> Result<(), Error> {
        let grid = self.volume.grid();
        let view = View {
            grid,
            camera: shot.camera,
            extent_pixels: self.extent,
            in_pixel: InPixel::CENTER,
            settings: &self.class.settings,
        };
        let layout = view.texture_layout();
        let mut copies = self.volume.copies().iter();
        let copy = copies.position(|copy| copy.layout() == layout);
        let copy = copy.ok_or(technique::Error::WrongLayout {
            wanted: layout,
            found: self.volume.copies()[0].layout(),
        })?;
        let (words, functions) = (&self.words, self.function.turns);
        let limit = self.gpu.limits().max_loop_turns;
        view.check_turns(words, 1, functions, limit)?;
        let mut slot = (frame * self.ring.slots() as usize / self.frames.len()) as u32;
        let skip = self.function.skip(&self.volume);
        let (class, center) = (&self.class, grid.center());
        let is_tested = self.pass.slicer.is_some() && !class.gathers();
        let mut write = |mut recording: Recording, is_tested: bool| -> Result<Part, Error> {
            recording.skip(skip);
            match depth {
                Some(depth) if class.host_depth && is_tested => recording.tested_in(&depth, center),
                Some(depth) if class.host_depth => recording.behind(&depth, center),
                Some(depth) => recording.in_depths_of(&depth, center),
                None => {}
            }
            slot += 1;
            Ok(Part {
                brick: recording.brick,
                offset: recording.write(&self.ring, slot - 1)?,
                slices: recording.slices,
                order: recording.order,
            })
        };
        let Recorded {
            shot: of,
            picture,
            depth: of_slices,
            order,
        } = made;
        let (volume, transfer) = (&self.volume.copies()[copy], self.function.transfer());
        picture.clear();
        of_slices.clear();
        view.each_recording(volume, transfer, order, |recording| {
            picture.push(write(recording, is_tested)?);
            Ok::<_, Error>(())
        })?;
        if self.pass.slicer.is_some() && self.pass.rays.is_some() {
            view.check_depth_turns(words, functions, limit)?;
            view.each_depth_recording(volume, transfer, order, |recording| {
                of_slices.push(write(recording, false)?);
                Ok::<_, Error>(())
            })?;
        }
        *of = Some((*shot.camera, copy));
        Ok(())
    }

    /// # Safety
    /// As [`Slicer::record`](technique::Slicer::record), for all bricks.
    unsafe fn draw_slices(&self, cmd: vk::CommandBuffer, bound: &[Bindings], parts: &[Part]) {
        let Some(slicer) = &self.pass.slicer else {
            unreachable!("a picture without slices is resolved");
        };
        for part in parts {
            let slices = 0..part.slices;
            // SAFETY: the caller's promises.
            unsafe { slicer.record(cmd, &bound[part.brick], part.offset, self.extent, slices) };
        }
    }

    /// # Safety
    /// As [`Renderer::record`].
    unsafe fn gather(
        &self,
        cmd: vk::CommandBuffer,
        frame: usize,
        made: &Recorded,
    ) -> Result<(), Error> {
        let (gpu, extent) = (&self.gpu, self.extent);
        let there = &self.frames[frame];
        let (_, copy) = made.shot.expect("described just now");
        if let (Some(image), Some(slicer)) = (&there.gathered, &self.pass.half_angle) {
            let (Some(bound), Some(light), [eye, of_light]) =
                (&there.sets.half_angle, &there.light, &made.picture[..])
            else {
                unreachable!("the eye's recording and the light's");
            };
            let slices = HalfAngleSlices {
                offsets: [eye.offset, of_light.offset],
                count: eye.slices,
                order: eye.order,
            };
            // SAFETY: the caller's promises.
            unsafe {
                image_barrier(gpu, cmd, image, Use::Nothing, Use::ColorTarget);
                image_barrier(gpu, cmd, light, Use::Nothing, Use::ColorTarget);
                slicer.record(cmd, bound, slices, (image, extent), light);
                image_barrier(gpu, cmd, image, Use::ColorTarget, Use::FragmentSampled);
            }
        } else if let Some(image) = &there.gathered {
            let target = [(
                image.view(),
                Load::Clear(clear_color(self.class.settings.mode)),
            )];
            // SAFETY: the caller's promises.
            unsafe {
                image_barrier(gpu, cmd, image, Use::Nothing, Use::ColorTarget);
                begin_rendering(gpu, cmd, &target, extent);
                self.draw_slices(cmd, &there.sets.slices[copy], &made.picture);
                end_rendering(gpu, cmd);
                image_barrier(gpu, cmd, image, Use::ColorTarget, Use::FragmentSampled);
            }
        }
        let Some(rays) = &self.pass.rays else {
            return Ok(());
        };
        let barriers = |before, after| {
            for image in &there.left {
                // SAFETY: the caller's promises.
                unsafe { image_barrier(gpu, cmd, image, before, after) };
            }
        };
        let parts = match self.pass.slicer {
            Some(_) => &made.depth,
            None => &made.picture,
        };
        let mut before = Use::Nothing;
        for part in parts {
            barriers(before, Use::ComputeWrite);
            before = Use::ComputeWrite;
            let whole = [Tile::whole(extent)];
            let bound = &there.sets.rays[copy][part.brick];
            // SAFETY: the caller's promises.
            unsafe { rays.record_tiles(cmd, bound, part.offset, extent, whole)? };
        }
        barriers(before, Use::FragmentSampled);
        Ok(())
    }
}
