//! Levels A and B: what a renderer records.

use super::frame::{Frame, Recorded};
use super::paths::Traced;
use super::{Error, FrameInfo, Renderer};
use crate::camera::{Camera, DepthConvention, HostDepth};
use crate::gpu::{Load, Target, TargetClass, Tile, Use, begin_rendering, end_rendering};
use crate::technique::gather::{BrickPass, Part, Player};
use crate::technique::shear_warp::intermediate_room;
use crate::technique::{self, DepthAccess, InPixel, Recording, Skip, View};
use ash::vk;

impl Renderer {
    /// Records all of a frame that lies outside of the host's rendering: parameters, the upload of a new transfer
    /// function, the compute pass of rays, or the slices in an image of the renderer's. Of slices that are blended in the
    /// target ([`SliceBlending::InTarget`](super::SliceBlending::InTarget)) it is the parameters alone.
    ///
    /// # Errors
    /// A shot that the class is not for, a picture that cannot be made.
    ///
    /// # Safety
    /// - `cmd` is recording on the device, outside rendering, for a queue of
    ///   [`Gpu::queue_family`](crate::gpu::Gpu::queue_family), and is submitted in the order in which it was recorded,
    ///   after the upload of the volume;
    /// - nothing unfinished was recorded with the shot's number of a frame in flight;
    /// - the image of the host's depth is in the layout that was said, visible to sampled reads of compute shaders, and
    ///   of fragment shaders where there are slices.
    pub unsafe fn record(&mut self, cmd: vk::CommandBuffer, shot: &FrameInfo) -> Result<(), Error> {
        let (frame, made) = self.prepare(shot)?;
        let part = Part {
            tiles: &[Tile::whole(self.extent)],
            steps: 0..self.steps(frame, &made, 1).unwrap_or(0),
            bands: 1,
            is_first: true,
            is_last: true,
        };
        // SAFETY: the caller's promises.
        let gathered = unsafe {
            let uploaded = self.function.record_part(cmd, &self.volume, u64::MAX);
            uploaded.and_then(|()| self.gather(cmd, frame, &made, &part))
        };
        match gathered {
            Ok(()) => self.keep(frame, made),
            Err(_) => self.spare = made,
        }
        gathered
    }

    /// Level A: draws what [`Renderer::record`] recorded for this frame in flight over what the host has drawn. Bound
    /// pipeline, descriptor set 0, viewport and scissor are ours afterwards.
    ///
    /// # Errors
    /// Where nothing was recorded.
    ///
    /// # Safety
    /// - `cmd` is recording inside rendering to a target of [`RendererDesc::target`](super::RendererDesc::target) and of the
    ///   renderer's extent;
    /// - it runs after what [`Renderer::record`] recorded, on the same queue.
    pub unsafe fn draw(&self, cmd: vk::CommandBuffer, frame: u32) -> Result<(), Error> {
        self.gpu.check_alive("draw a frame")?;
        let (there, ..) = self.recorded(frame, "draw")?;
        // SAFETY: the caller's promises.
        unsafe { self.draw_picture(cmd, there, &there.recorded) };
        Ok(())
    }

    /// Writes the depth of a picture into the depth attachment, where it is nearer than what is there: what the host
    /// draws later, blended or not, is hidden by the volume. Of composites it is where they become half opaque, along
    /// rays or from slice to slice.
    ///
    /// # Errors
    /// [`Error::NoDepth`] without [`RendererDesc::gives_depth`](super::RendererDesc::gives_depth) and a depth attachment; where
    /// nothing was recorded.
    ///
    /// # Safety
    /// As [`Renderer::draw`]; depth may be written.
    pub unsafe fn draw_depth(&self, cmd: vk::CommandBuffer, frame: u32) -> Result<(), Error> {
        self.gpu.check_alive("draw the depth of a volume")?;
        let (there, ..) = self.recorded(frame, "draw_depth")?;
        let (Some(pass), Some(bound)) = (&self.pass.depth, &there.sets.depth) else {
            return Err(Error::NoDepth {
                what: format!("a renderer without `gives_depth` ({})", self.class.what()),
            });
        };
        // That of slices is of the rays that have looked for it.
        let Recorded { picture, depth, .. } = &there.recorded;
        let offset = depth.first().unwrap_or(&picture[0]).offset;
        // SAFETY: the caller's promises.
        unsafe { pass.record(cmd, bound, offset, self.extent) };
        Ok(())
    }

    /// Level B: [`Renderer::record`] and [`Renderer::draw`] into an image of the host's that arrives and leaves as
    /// `target` says, with what it holds kept (or cleared, where `load` says so).
    ///
    /// # Errors
    /// As those, and [`Error::OtherDescription`] for a target of another format or size, and for a class with a depth
    /// attachment or several samples, which only a host's own rendering has.
    ///
    /// # Safety
    /// As [`Renderer::record`]; the target is in its state `before`, and lives until `cmd` has run.
    pub unsafe fn record_into(
        &mut self,
        cmd: vk::CommandBuffer,
        shot: &FrameInfo,
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

impl Renderer {
    /// The frame of a shot and its parameters, written. Nothing that was recorded for it before is drawn or picked now.
    pub(super) fn prepare(&mut self, shot: &FrameInfo) -> Result<(usize, Recorded), Error> {
        self.gpu.check_alive("record a frame")?;
        let frame = self.frame_number(shot.frame)?;
        shot.camera.check()?;
        if !self.volume.is_uploaded() {
            return Err(Error::NotUploaded);
        }
        self.volume.updates.check_whole()?;
        if let Some(noise) = &mut self.path_noise {
            noise.read(frame)?;
        }
        let depth = self.depth_of(shot)?;
        let mut made = std::mem::take(&mut self.spare);
        if let Err(refused) = self.describe(frame, shot, depth, &mut made) {
            self.spare = made;
            return Err(refused);
        }
        if made.traced.is_some() {
            // They would go on in the picture that this one goes on in.
            self.frames.iter_mut().for_each(|other| other.begun = None);
        }
        let there = &mut self.frames[frame];
        (there.recorded.shot, there.begun, there.picked) = (None, None, None);
        Ok((frame, made))
    }

    /// What was recorded of a frame, to be drawn. The room of what was recorded before is kept for the next one.
    pub(super) fn keep(&mut self, frame: usize, made: Recorded) {
        self.traced = made.traced;
        self.spare = std::mem::replace(&mut self.frames[frame].recorded, made);
    }

    /// Refuses a target that the renderer was not made for, and states that lose what is to be kept.
    pub(super) fn check_target(&self, target: &Target, load: Load) -> Result<(), Error> {
        let wanted = TargetClass::from(target.format);
        if self.class.target != wanted || self.extent != target.extent {
            return Err(Error::OtherDescription {
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

    /// Draws a picture inside a rendering.
    ///
    /// # Safety
    /// As [`Renderer::draw`].
    pub(super) unsafe fn draw_picture(
        &self,
        cmd: vk::CommandBuffer,
        there: &Frame,
        recorded: &Recorded,
    ) {
        // SAFETY: the caller's promises; what is bound lives as long as the frame, and then until it is retired.
        unsafe {
            match (&self.pass.resolve, &there.sets.resolve) {
                (Some(resolve), Some(bound)) => {
                    resolve.record(cmd, bound, recorded.picture[0].offset, self.extent);
                }
                _ => self.draw_slices(cmd, there, recorded),
            }
        }
    }

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

    fn depth_of(&self, shot: &FrameInfo) -> Result<Option<HostDepth>, Error> {
        let is_wanted = self.class.host_depth || self.class.draws_depth();
        match (is_wanted, shot.depth) {
            (true, None) => Err(Error::HostDepth {
                wanted: "`FrameInfo::depth`, from `Camera::from_matrices`".into(),
                found: "none".into(),
            }),
            (false, _) => Ok(None),
            (true, Some(depth)) => {
                let is_reversed = self.class.target.depth.map(|depth| depth.is_reversed);
                let found = depth.nearer == DepthConvention::Reversed;
                match is_reversed.is_some_and(|wanted| wanted != found) {
                    true => Err(Error::HostDepth {
                        wanted: "`FrameInfo::depth` and `RendererDesc::target` with the same depth nearer"
                            .into(),
                        found: format!("{:?}", depth.nearer),
                    }),
                    false => Ok(Some(depth)),
                }
            }
        }
    }

    pub(super) fn view<'a>(&'a self, shot: &FrameInfo<'a>) -> View<'a> {
        View {
            grid: self.volume.grid(),
            camera: shot.camera,
            extent_pixels: self.extent,
            in_pixel: InPixel::CENTER,
            settings: &self.class.settings,
        }
    }

    /// Parameters into the ring, and what they are of into `made`.
    fn describe(
        &self,
        frame: usize,
        shot: &FrameInfo,
        depth: Option<HostDepth>,
        made: &mut Recorded,
    ) -> Result<(), Error> {
        let view = self.view(shot);
        let grid = view.grid;
        if let Some(base) = view.base_plane()? {
            base.check_room(intermediate_room(grid, view.settings, self.extent))?;
        }
        let layout = view.texture_layout();
        let mut copies = self.volume.copies().iter();
        let copy = copies.position(|copy| copy.layout() == layout);
        let copy = copy.ok_or(technique::Error::WrongLayout {
            wanted: layout,
            found: self.volume.copies()[0].layout(),
        })?;
        let (variant, functions) = (&self.variant, self.function.turns);
        let limit = self.gpu.limits().max_loop_turns;
        let finds_depth = self.pass.slice_depth.is_some();
        view.check_turns(variant, 1, functions, limit)?;
        view.check_splats_in_one(limit)?;
        if finds_depth {
            view.check_depth_turns(variant, functions, limit)?;
        }
        let mut slot = (frame * self.ring.slots() as usize / self.frames.len()) as u32;
        let skip = match self.volume.knows_enough_for(&view) {
            true => self.function.skip(&self.volume),
            false => Skip::Nothing,
        };
        let (class, center) = (&self.class, grid.center());
        let depth_access = match class.settings.technique.casts_rays() {
            false => class.depth_access(),
            true => DepthAccess::Sampled,
        };
        let traced = self.paths_of(shot);
        let mut write =
            |mut recording: Recording, depth_access: DepthAccess| -> Result<BrickPass, Error> {
                recording.skip(skip);
                if let (Some(of_paths), Some(traced)) = (&self.function.paths, &traced) {
                    of_paths.fields.tell(&mut recording.frame, limit)?;
                    traced.tell(&mut recording.frame);
                }
                match (depth, depth_access) {
                    (Some(depth), _) if !class.host_depth => recording.in_depths_of(&depth, center),
                    (Some(depth), DepthAccess::Tested) if class.gathers() => {
                        recording.tested_in_copy(&depth, center);
                    }
                    (Some(depth), DepthAccess::Tested) => recording.tested_in(&depth, center),
                    (Some(depth), DepthAccess::None | DepthAccess::Sampled) => {
                        recording.behind(&depth, center)
                    }
                    (None, _) => {}
                }
                slot += 1;
                Ok(BrickPass {
                    number: recording.brick,
                    offset: recording.write(&self.ring, slot - 1)?,
                    slices: recording.slices,
                    order: recording.order,
                    seen: None,
                })
            };
        let Recorded {
            shot: of,
            traced: made_traced,
            picture,
            depth: of_slices,
            order,
        } = made;
        let (volume, transfer) = (&self.volume.copies()[copy], self.function.transfer());
        picture.clear();
        of_slices.clear();
        view.each_recording(volume, transfer, order, |recording| {
            picture.push(write(recording, depth_access)?);
            Ok::<_, Error>(())
        })?;
        if finds_depth {
            view.each_depth_recording(volume, transfer, order, |recording| {
                of_slices.push(write(recording, DepthAccess::Sampled)?);
                Ok::<_, Error>(())
            })?;
        }
        *of = Some((*shot.camera, copy));
        *made_traced = traced;
        Ok(())
    }

    /// # Safety
    /// As [`Slicer::record`](technique::Slicer::record), for all bricks.
    unsafe fn draw_slices(&self, cmd: vk::CommandBuffer, there: &Frame, recorded: &Recorded) {
        let (Some(slicer), Some((_, copy))) = (&self.pass.in_target, recorded.shot) else {
            unreachable!("what is not drawn in the target is resolved, and this was described");
        };
        for brick in &recorded.picture {
            let bound = &there.sets.in_target[copy][brick.number];
            let (extent, slices) = (self.extent, 0..brick.slices);
            // SAFETY: the caller's promises.
            unsafe { slicer.record(cmd, bound, brick.offset, extent, slices) };
        }
    }

    /// How many steps make a picture that is no sum of blocks, each in so many bands.
    pub(super) fn steps(&self, frame: usize, made: &Recorded, bands: u32) -> Option<u64> {
        let (there, (_, copy)) = (&self.frames[frame], made.shot?);
        let bound = there.sets.picture.get(copy)?;
        bound.steps(there.picture.as_ref()?, &made.picture, bands)
    }

    /// Records a part of all that lies outside of the host's rendering.
    ///
    /// # Safety
    /// As [`Renderer::record`]; parts follow each other.
    pub(super) unsafe fn gather(
        &mut self,
        cmd: vk::CommandBuffer,
        frame: usize,
        made: &Recorded,
        part: &Part,
    ) -> Result<(), Error> {
        let Some((_, copy)) = made.shot else {
            unreachable!("described before");
        };
        // Until the last part is there.
        self.traced = None;
        let Frame {
            picture,
            slice_depth,
            sets,
            ..
        } = &mut self.frames[frame];
        for (canvas, sets, bricks) in [
            (
                self.mean.as_mut().or(picture.as_mut()),
                &sets.picture,
                &made.picture,
            ),
            (slice_depth.as_mut(), &sets.slice_depth, &made.depth),
        ] {
            let (Some(canvas), Some(bound)) = (canvas, sets.get(copy)) else {
                continue;
            };
            match made.traced {
                None if part.is_first => canvas.begin(),
                // Frames that are not done show what they had.
                Some(traced) if part.is_first && traced.is_new() => canvas.begin_anew(),
                _ => {}
            }
            let gpu = &self.gpu;
            let mut player = Player { gpu, cmd, canvas };
            // SAFETY: the caller's promises.
            unsafe { bound.record(&mut player, bricks, part)? };
        }
        if let Some(traced) = made.traced {
            // SAFETY: as above, behind the paths.
            unsafe { self.record_noise(cmd, frame, (made, traced), part)? };
        }
        Ok(())
    }

    /// Records how noisy the picture of paths is with those of a frame.
    ///
    /// # Safety
    /// As [`Renderer::gather`], after the paths of the part.
    unsafe fn record_noise(
        &mut self,
        cmd: vk::CommandBuffer,
        frame: usize,
        (made, traced): (&Recorded, Traced),
        part: &Part,
    ) -> Result<(), Error> {
        let (Some(noise), Some(canvas)) = (&mut self.path_noise, &mut self.mean) else {
            return Ok(());
        };
        if part.is_first && traced.is_new() {
            noise.forget();
        }
        let Some(pass) = self
            .pass
            .noise
            .as_ref()
            .filter(|_| part.is_last && traced.adds())
        else {
            return Ok(());
        };
        let gpu = &self.gpu;
        let mut player = Player { gpu, cmd, canvas };
        let offset = made.picture[0].offset;
        // SAFETY: the caller's promises; `prepare` has read what the frame with that number had told.
        unsafe { noise.record(&mut player, pass, (frame, offset), traced.path_blocks()) }
    }
}
