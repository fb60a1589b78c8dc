//! What changed goes to stratavox, in the cheapest way there is:
//!
//! ```text
//! eye                          the next shot
//! function                     set_function
//! numbers of the look          set_settings
//! size                         resize
//! time                         set_volume
//! technique, mode, filter ..   another renderer
//! ```

use super::{Drawn, REST, SLOW_MS, Window};
use crate::drawing::Drawing;
use crate::error::Error;
use crate::fit::{Small, fit};
use crate::frames::Begun;
use crate::look::Change;
use crate::marks::{self, Marker};
use ash::vk;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use stratavox::technique::Settings;

impl Window {
    /// Brings the picture of the volume up to date, where it is not.
    ///
    /// # Safety
    /// As [`Drawing::record`].
    pub(super) unsafe fn draw_volume(
        &mut self,
        begun: Begun,
        place: [u32; 2],
    ) -> Result<(), Error> {
        let (cmd, frame) = (begun.cmd, begun.frame);
        self.view.status.extent = place;
        self.fit_eye(place);
        let parts = self.parts();
        self.view.look.is_moving = parts > 1;
        let extent = place.map(|side| side.div_ceil(parts));
        // SAFETY: the caller's promise.
        unsafe {
            self.follow_look(cmd, extent)?;
            self.follow_arrived(cmd)?;
        }
        let Some(drawing) = &mut self.drawing else {
            return Ok(());
        };
        let painter = self.painter.as_ref().expect("made with the swapchain");
        if drawing.canvas.extent != extent {
            // What was asked of the images before is gone with them.
            self.asked = None;
            drawing.resize(painter, extent)?;
        }
        let now = Drawn {
            look: self.view.look.clone(),
            eye: self.view.eye.clone(),
            time: self.view.subject.time,
            has_marks: self.view.has_marks,
            extent,
        };
        let rests = self.drawn.as_ref() == Some(&now) && self.view.to_pick.is_none();
        if rests && !drawing.resting.goes_on(&now.look) {
            return Ok(());
        }
        if !rests {
            let is_other = |drawn: &Drawn| {
                Drawn {
                    eye: now.eye.clone(),
                    ..drawn.clone()
                } != now
            };
            drawing
                .resting
                .disturb(self.drawn.as_ref().is_none_or(is_other));
        }
        let camera = self.view.eye.camera(extent);
        let camera = camera.map_err(|error| Error::Drawing(error.into()))?;
        let format = drawing.canvas.image.format();
        let timer = self.timers[frame as usize].as_ref();
        // SAFETY: the caller's promise.
        unsafe {
            let marks = match self.view.has_marks {
                true => {
                    let marker = match &mut self.marker {
                        Some(marker) => marker,
                        none => none.insert(Marker::new(self.host.gpu(), format)?),
                    };
                    let drawn = marks::drawn(&self.view, &camera, extent, parts)?;
                    Some((&*marker, marker.lay(cmd, &drawn, extent)?))
                }
                false => None,
            };
            let marks = marks.as_ref().map(|(marker, layers)| (*marker, layers));
            let look = (&now.look, rests);
            if !drawing.record(cmd, frame, &camera, look, marks, timer)? {
                return Ok(());
            }
        }
        self.view.status.paths = drawing.resting.paths(&now.look);
        self.view.status.noise = drawing.resting.noise();
        if rests {
            return Ok(());
        }
        self.timed[frame as usize] = Some(parts);
        self.drawn = Some(now);
        if let Some(at) = self.view.to_pick.take() {
            let per_point = self.context.pixels_per_point();
            let at = (at - self.view.picture.min) * per_point / parts as f32;
            let pixel = [at.x, at.y].map(|x| x.max(0.0) as u32);
            let pixel = [0, 1].map(|k| pixel[k].min(extent[k] - 1));
            // SAFETY: as above, after the picture.
            match unsafe { drawing.renderer.record_pick(cmd, frame, pixel) } {
                Ok(()) => self.asked = Some((frame, pixel)),
                Err(error @ stratavox::embed::Error::NoDepth { .. }) => {
                    self.view.picked = None;
                    self.view.message = Some(error.to_string());
                }
                Err(error) => return Err(error.into()),
            }
        }
        Ok(())
    }

    /// Fits the eye at first and after a reset: to what is visible, under `--look auto`, else to the box.
    fn fit_eye(&mut self, place: [u32; 2]) {
        let view = &mut self.view;
        if view.subject.context.is_some() && view.eye.is_to_be_fitted() {
            let small = Small {
                device: view.status.device.clone(),
                layer: self.words.validation,
            };
            match fit(view, place, &small) {
                Ok(messages) => {
                    self.host.messages().fetch_add(messages, Ordering::Relaxed);
                }
                // The box is what is left.
                Err(error) => view.message = Some(error.to_string()),
            }
        }
        view.eye.fit(place);
    }

    /// In how many parts the sides of the picture are shrunk while a hand moves it. A script sees all pixels.
    fn parts(&self) -> u32 {
        let moves = self.last_move.is_some_and(|moved| moved.elapsed() < REST);
        match self.view.status.picture_ms {
            Some(ms) if moves && self.steps.is_none() && ms > SLOW_MS => {
                ((ms / SLOW_MS).sqrt().ceil() as u32).min(4)
            }
            _ => 1,
        }
    }

    /// What changed of the look goes to the renderer, in the cheapest way there is.
    ///
    /// # Safety
    /// As [`Drawing::new`].
    unsafe fn follow_look(
        &mut self,
        cmd: vk::CommandBuffer,
        extent: [u32; 2],
    ) -> Result<(), Error> {
        use stratavox::embed::Error as Refused;
        let look = &self.view.look;
        let mut is_other = true;
        if let (Some(drawing), Some(drawn)) = (&mut self.drawing, &self.drawn) {
            let changed = match look.change_from(&drawn.look) {
                Change::Kind => Err(None),
                Change::Numbers => drawing.renderer.set_settings(look.settings()).map_err(Some),
                Change::Nothing => Ok(()),
            };
            let is_same = look.function() == drawn.look.function();
            let changed = changed.and_then(|()| match is_same {
                true => Ok(()),
                false => drawing.renderer.set_function(look.function()).map_err(Some),
            });
            is_other = match changed {
                Ok(()) => false,
                Err(None | Some(Refused::OtherDescription { .. })) => true,
                Err(Some(error)) => return Err(error.into()),
            };
        }
        if !is_other {
            return Ok(());
        }
        let painter = self.painter.as_ref().expect("made with the swapchain");
        let (gpu, count) = (self.host.gpu(), self.frames.count());
        let voxels = &self.view.subject.voxels;
        // SAFETY: the caller's promise.
        let made = unsafe { Drawing::new(gpu, cmd, painter, voxels, look, extent, count) };
        match (made, &self.drawn) {
            (Ok(made), _) => {
                self.asked = None;
                self.drawing = Some(made);
            }
            // What cannot be drawn so is said, and the picture stays.
            (
                Err(error @ Error::Drawing(Refused::NotEmbedded { .. } | Refused::Technique(_))),
                Some(drawn),
            ) => {
                let before = drawn.look.clone();
                self.view.refuse(&error, before);
            }
            (Err(error), _) => return Err(error),
        }
        Ok(())
    }

    /// The time that was read takes the place of the one before, without a stall: its textures are made, its upload is
    /// recorded here.
    ///
    /// # Safety
    /// As [`stratavox::embed::Volume::record_upload`].
    unsafe fn follow_arrived(&mut self, cmd: vk::CommandBuffer) -> Result<(), Error> {
        let Some(mut read) = self.arrived.take() else {
            return Ok(());
        };
        let (look, Some(drawing)) = (&self.view.look, &mut self.drawing) else {
            return Ok(());
        };
        let textures = |settings: &Settings| {
            (
                settings.technique,
                settings.filter,
                settings.shading.is_some(),
            )
        };
        if textures(&read.settings) != textures(&look.settings()) {
            // A hand was faster: the time is asked for once more, in other textures.
            return Ok(());
        }
        // SAFETY: the caller's promise.
        unsafe { read.textures.record_upload(self.host.gpu(), cmd)? };
        drawing.set_volume(&Arc::new(read.textures), look.function())?;
        // What was asked of the volume before is gone with it.
        self.asked = None;
        self.view.subject.voxels = Arc::new(read.voxels);
        self.view.subject.time = read.time;
        Ok(())
    }
}
