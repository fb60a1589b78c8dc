//! Pictures of one volume in a host's frames.

use super::class::what;
use super::frame::{Bound, Frame};
use super::function::Function;
use super::pass::Pass;
use super::{Class, Error, HostDepthImage, Volume};
use crate::gpu::{Gpu, ParameterRing};
use crate::technique::{self, Mode, Settings, Words, parameter_ring};
use crate::transfer::TransferFunction;
use std::sync::Arc;

/// Pictures of one volume in a host's frames. All pipelines are there when it is made: [`Gpu::pipelines_made`] stays
/// from then on.
#[derive(Debug)]
pub struct Renderer {
    pub(super) gpu: Arc<Gpu>,
    pub(super) class: Class,
    pub(super) words: Words,
    pub(super) volume: Arc<Volume>,
    pub(super) function: Function,
    pub(super) pass: Pass,
    pub(super) ring: ParameterRing,
    pub(super) extent: [u32; 2],
    host_depths: Vec<HostDepthImage>,
    pub(super) frames: Vec<Frame>,
}

impl Renderer {
    /// Everything that frames of `extent` pixels will need. `function` may be missing in mode [`Mode::Iso`] alone;
    /// `host_depths` are wanted of rays with [`Class::host_depth`]: one for all frames in flight, or one for each.
    ///
    /// # Errors
    /// What is not drawn so, by name, what the device cannot do, and no memory.
    pub fn new(
        gpu: &Arc<Gpu>,
        volume: &Arc<Volume>,
        function: Option<&TransferFunction>,
        class: Class,
        extent: [u32; 2],
        host_depths: &[HostDepthImage],
    ) -> Result<Self, Error> {
        class.check()?;
        let function = Function::new(gpu, volume, &class.settings, function, None)?;
        let words = words_of(&class.settings, volume, &function)?;
        let pass = Pass::new(gpu, &class, &words)?;
        let bricks = volume.copies().iter().map(|copy| copy.bricks().len()).max();
        let slots = bricks.unwrap_or(1) as u32 * class.frames_in_flight;
        let mut made = Self {
            gpu: Arc::clone(gpu),
            words,
            volume: Arc::clone(volume),
            function,
            pass,
            ring: parameter_ring(gpu, slots)?,
            extent,
            host_depths: Vec::new(),
            frames: Vec::new(),
            class,
        };
        made.resize(extent, host_depths)?;
        Ok(made)
    }

    /// Frames of another size, or with other depth buffers, from now on. What frames in flight use is destroyed when
    /// they are done; nothing waits.
    ///
    /// # Errors
    /// As [`Renderer::new`]; nothing has changed then.
    pub fn resize(
        &mut self,
        extent: [u32; 2],
        host_depths: &[HostDepthImage],
    ) -> Result<(), Error> {
        self.check_depths(extent, host_depths)?;
        let frames = (0..self.class.frames_in_flight as usize).map(|frame| {
            let depth = host_depths.get(frame).or(host_depths.first());
            Frame::new(&self.bound(depth.copied()), extent)
        });
        let frames = frames.collect::<Result<_, _>>()?;
        self.frames = frames;
        self.extent = extent;
        self.host_depths = host_depths.to_vec();
        Ok(())
    }

    /// Another transfer function from the next [`Renderer::record`] on. It may be called each frame: nothing is
    /// compiled, nothing waits, and what frames in flight read of the one before stays until they are done.
    ///
    /// # Errors
    /// [`Error::OtherClass`] where it asks for gradients and the one before did not, or the other way round; no memory.
    pub fn set_function(&mut self, function: Option<&TransferFunction>) -> Result<(), Error> {
        let settings = &self.class.settings;
        let before = Some(&self.function);
        let made = Function::new(&self.gpu, &self.volume, settings, function, before)?;
        let words = words_of(settings, &self.volume, &made)?;
        if words != self.words {
            return Err(Error::OtherClass {
                made: format!("functions that are {:?}", self.function.mix),
                wanted: format!("one that is {:?}", made.mix),
            });
        }
        self.function = made;
        self.rebind()
    }

    /// Other numbers in the settings from the next [`Renderer::record`] on: steps, crops, clip planes, levels, lights.
    ///
    /// # Errors
    /// [`Error::OtherClass`] where other pipelines or textures would be needed; nothing has changed then.
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), Error> {
        let class = Class {
            settings,
            ..self.class.clone()
        };
        class.check()?;
        let words = words_of(&class.settings, &self.volume, &self.function)?;
        let kind = |settings: &Settings| {
            (
                settings.technique,
                settings.mode,
                settings.order,
                settings.color_space,
                settings.skip,
                settings.filter,
                settings.per_mode.exact_maximum,
                settings.per_mode.depth_cue == 0.0,
            )
        };
        let is_same = kind(&class.settings) == kind(&self.class.settings) && words == self.words;
        let levels = |settings: &Settings| settings.per_mode.levels.clone();
        let empties_other = class.settings.mode == Mode::Iso
            && levels(&class.settings) != levels(&self.class.settings);
        if !is_same {
            return Err(Error::OtherClass {
                made: self.class.what(),
                wanted: what(&class.settings),
            });
        }
        if empties_other {
            // Which cells have no surface hangs on the levels.
            let before = Some(&self.function);
            let settings = &class.settings;
            let made = Function::new(&self.gpu, &self.volume, settings, None, before)?;
            self.function = made;
            self.class = class;
            return self.rebind();
        }
        self.class = class;
        Ok(())
    }

    /// Another volume from the next [`Renderer::record`] on, on a grid of the same size and of the same kind of voxels:
    /// the next time of a series. It has been uploaded by then, which may be recorded in the same command buffer.
    ///
    /// # Errors
    /// [`Error::OtherClass`] where it lies in other textures; no memory.
    pub fn set_volume(
        &mut self,
        volume: &Arc<Volume>,
        function: Option<&TransferFunction>,
    ) -> Result<(), Error> {
        let settings = &self.class.settings;
        let before = Some(&self.function);
        let made = Function::new(&self.gpu, volume, settings, function, before)?;
        let words = words_of(settings, volume, &made)?;
        let bricks = |volume: &Volume| {
            let counts = volume.copies().iter().map(|copy| copy.bricks().len());
            counts.max().unwrap_or(1)
        };
        if words != self.words || bricks(volume) > bricks(&self.volume) {
            return Err(Error::OtherClass {
                made: format!("{:?} in {} bricks", self.words, bricks(&self.volume)),
                wanted: format!("{words:?} in {} bricks", bricks(volume)),
            });
        }
        self.volume = Arc::clone(volume);
        self.function = made;
        self.rebind()
    }

    /// What it was made for.
    pub fn class(&self) -> &Class {
        &self.class
    }

    /// Pixels across and down.
    pub fn extent(&self) -> [u32; 2] {
        self.extent
    }

    fn bound(&self, host_depth: Option<HostDepthImage>) -> Bound<'_> {
        Bound {
            gpu: &self.gpu,
            pass: &self.pass,
            ring: &self.ring,
            volume: &self.volume,
            function: &self.function,
            host_depth,
        }
    }

    fn rebind(&mut self) -> Result<(), Error> {
        let mut frames = std::mem::take(&mut self.frames);
        let bound = frames.iter_mut().enumerate().try_for_each(|(k, frame)| {
            let depth = self.host_depths.get(k).or(self.host_depths.first());
            frame.bind(&self.bound(depth.copied()))
        });
        self.frames = frames;
        bound
    }

    pub(super) fn frame_number(&self, frame: u32) -> Result<usize, Error> {
        let of = self.class.frames_in_flight;
        match frame < of {
            true => Ok(frame as usize),
            false => Err(Error::NoFrame { found: frame, of }),
        }
    }

    fn check_depths(&self, extent: [u32; 2], images: &[HostDepthImage]) -> Result<(), Error> {
        let reads = self.class.host_depth && matches!(self.pass, Pass::Rays { .. });
        let of = self.class.frames_in_flight as usize;
        let wrong = |wanted: String, found: String| Err(Error::HostDepth { wanted, found });
        match (reads, images.len()) {
            (false, 0) => Ok(()),
            (true, count) if count == 1 || count == of => {
                match images.iter().find(|image| image.extent != extent) {
                    None => Ok(()),
                    Some(image) => wrong(
                        format!("images of {} x {} pixels", extent[0], extent[1]),
                        format!("{} x {}", image.extent[0], image.extent[1]),
                    ),
                }
            }
            (true, count) => wrong(format!("1 or {of} images to read"), count.to_string()),
            (false, count) => wrong(
                "no image: nothing reads it".into(),
                format!("{count} images"),
            ),
        }
    }
}

/// The variant of the shaders for these settings: the same for all copies of the volume.
fn words_of(settings: &Settings, volume: &Volume, function: &Function) -> Result<Words, Error> {
    let copy = &volume.copies()[0];
    let is_graded = function.mix == technique::Mix::Graded;
    let lacks_source = settings.gradient_source_beside(copy.layout()).is_some()
        && copy.gradient_source().is_none();
    if is_graded && lacks_source {
        return Err(Error::NotEmbedded {
            what: "a function of gradients that are made of other numbers than the filter reads",
            hint: "take a filter that reads voxels, or light with it",
        });
    }
    Ok(Words::mixed(
        settings,
        function.mix,
        &[technique::Part::numbers(copy)],
    ))
}
