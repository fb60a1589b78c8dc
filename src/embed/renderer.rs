//! Pictures of one volume in a host's frames.

use super::frame::{Frame, FrameSize, Given, Recorded};
use super::function::{self, Function};
use super::noise::Noise;
use super::pass::Pass;
use super::paths::{self, Traced};
use super::renderer_desc::{READ_DEPTH, what};
use super::{Error, HostDepthImage, RendererDesc, Volume};
use crate::gpu::{Buffer, ComputePipeline, Gpu, ParameterRing};
use crate::resident::EmptySpace;
use crate::technique::gather::Canvas;
use crate::technique::{self, Mode, Settings, ShaderVariant, parameter_ring};
use crate::transfer::TransferFunction;
use std::sync::Arc;

/// Pictures of one volume in a host's frames. All pipelines are there when it is made: [`Gpu::pipelines_made`] stays
/// from then on.
#[derive(Debug)]
pub struct Renderer {
    pub(super) gpu: Arc<Gpu>,
    pub(super) class: RendererDesc,
    pub(super) variant: ShaderVariant,
    pub(super) volume: Arc<Volume>,
    pub(super) function: Function,
    /// Finds what is empty under a function.
    emptying: Option<Arc<ComputePipeline>>,
    /// That the ring has slots for.
    most_bricks: usize,
    pub(super) pass: Pass,
    pub(super) ring: ParameterRing,
    pub(super) extent: [u32; 2],
    /// Of a picture of the sky.
    sky: Option<Buffer>,
    /// What frames of paths add up in, and what they have added up to.
    pub(super) mean: Option<Canvas>,
    pub(super) traced: Option<Traced>,
    /// How noisy that is, where the device has room for it.
    pub(super) path_noise: Option<Noise>,
    host_depths: Vec<HostDepthImage>,
    pub(super) frames: Vec<Frame>,
    /// What the next recording is told in.
    pub(super) spare: Recorded,
}

impl Renderer {
    /// Everything that frames of `extent` pixels will need. `function` may be missing in mode [`Mode::Iso`] alone;
    /// `host_depths` are wanted where [`RendererDesc::reads_host_depth`]: one for all frames in flight, or one for each.
    ///
    /// # Errors
    /// What is not drawn so, by name, what the device cannot do, and no memory.
    pub fn new(
        gpu: &Arc<Gpu>,
        volume: &Arc<Volume>,
        function: Option<&TransferFunction>,
        class: RendererDesc,
        extent: [u32; 2],
        host_depths: &[HostDepthImage],
    ) -> Result<Self, Error> {
        class.check()?;
        let emptying = match volume.cells() {
            Some(_) => Some(EmptySpace::pipeline(gpu)?),
            None => None,
        };
        let settings = &class.settings;
        let function = Function::new(gpu, volume, settings, function, emptying.as_ref())?;
        let variant = variant_of(&class.settings, volume, &function)?;
        let bricks = volume.copies().iter().map(|copy| copy.bricks().len()).max();
        let most_bricks = bricks.unwrap_or(1);
        let writes_layers = class.finds_depth() || most_bricks > 1;
        let of_pass = ShaderVariant {
            writes_layers,
            ..variant
        };
        let pass = Pass::new(gpu, &class, &of_pass, function.mix)?;
        // The depth of slices is looked for with parameters of its own, and the light has its own.
        let is_twofold = class.settings.is_half_angle() || pass.slice_depth.is_some();
        let walks = if is_twofold { 2 } else { 1 };
        let slots = (most_bricks as u32).saturating_mul(walks * class.frames_in_flight);
        let mut made = Self {
            gpu: Arc::clone(gpu),
            variant,
            volume: Arc::clone(volume),
            function,
            emptying,
            most_bricks,
            pass,
            ring: parameter_ring(gpu, slots)?,
            extent,
            sky: paths::sky(gpu, &class.settings)?,
            mean: None,
            traced: None,
            path_noise: None,
            host_depths: Vec::new(),
            frames: Vec::new(),
            spare: Recorded::with_room(2 * most_bricks),
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
        let is_picked = self.class.finds_depth();
        let size = FrameSize {
            extent,
            recordings: 2 * self.most_bricks,
            keeps_layers: is_picked || self.most_bricks > 1,
            is_picked,
        };
        let adds_up = self.class.settings.technique.traces_paths();
        let gather = self.pass.picture.as_ref().filter(|_| adds_up);
        let desc = self.given(None).canvas(size, None);
        let mean = gather.map(|gather| gather.canvas(&desc)).transpose()?;
        let path_noise = match (&self.pass.noise, &mean) {
            (Some(pass), Some(mean)) => {
                let frames = self.class.frames_in_flight;
                Noise::new(&self.gpu, pass, &self.ring, mean, frames)?
            }
            _ => None,
        };
        let mut frames = Vec::new();
        for frame in 0..self.class.frames_in_flight as usize {
            let depth = host_depths.get(frame).or(host_depths.first());
            let given = Given {
                mean: mean.as_ref(),
                ..self.given(depth.copied())
            };
            frames.push(Frame::new(&given, size, frames.first())?);
        }
        (self.frames, self.mean, self.traced) = (frames, mean, None);
        self.path_noise = path_noise;
        self.extent = extent;
        self.host_depths = host_depths.to_vec();
        Ok(())
    }

    /// Another transfer function from the next [`Renderer::record`] on. It may be called each frame: nothing is
    /// compiled, nothing waits, and what frames in flight read of the one before stays until they are done.
    ///
    /// # Errors
    /// [`Error::OtherDescription`] where it asks for gradients and the one before did not, or the other way round; no memory.
    pub fn set_function(&mut self, function: Option<&TransferFunction>) -> Result<(), Error> {
        let settings = &self.class.settings;
        let emptying = self.emptying.as_ref();
        let made = Function::new(&self.gpu, &self.volume, settings, function, emptying)?;
        let variant = variant_of(settings, &self.volume, &made)?;
        if variant != self.variant {
            return Err(Error::OtherDescription {
                made: format!("functions that are {:?}", self.function.mix),
                wanted: format!("one that is {:?}", made.mix),
            });
        }
        self.show(Arc::clone(&self.volume), made)
    }

    /// Other numbers in the settings from the next [`Renderer::record`] on: steps, crops, clip planes, levels, lights, tone.
    ///
    /// # Errors
    /// [`Error::OtherDescription`] where other pipelines or textures would be needed; nothing has changed then.
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), Error> {
        let class = RendererDesc {
            settings,
            ..self.class.clone()
        };
        class.check()?;
        function::check(self.function.mix, &class.settings)?;
        let variant = variant_of(&class.settings, &self.volume, &self.function)?;
        let kind = |settings: &Settings| {
            (
                (
                    settings.technique,
                    settings.intermediate,
                    settings.splat.sheets,
                ),
                settings.mode,
                settings.order,
                settings.color_space,
                settings.skip,
                settings.filter,
                settings.per_mode.exact_maximum,
                settings.per_mode.depth_cue == 0.0,
                settings.is_half_angle(),
            )
        };
        let is_same =
            kind(&class.settings) == kind(&self.class.settings) && variant == self.variant;
        let levels = |settings: &Settings| settings.per_mode.levels.clone();
        let sky = |settings: &Settings| {
            let traces = settings.technique.traces_paths();
            settings.path.sky_picture.clone().filter(|_| traces)
        };
        let skies = [&self.class, &class].map(|class| sky(&class.settings));
        if skies[0] != skies[1] {
            let [made, wanted] = skies.map(|sky| format!("the picture of the sky {sky:?}"));
            return Err(Error::OtherDescription { made, wanted });
        }
        let empties_other = class.settings.mode == Mode::Iso
            && levels(&class.settings) != levels(&self.class.settings);
        if !is_same {
            return Err(Error::OtherDescription {
                made: self.class.what(),
                wanted: what(&class.settings),
            });
        }
        if empties_other {
            // Which cells have no surface depends on the levels.
            let emptying = self.emptying.as_ref();
            let settings = &class.settings;
            let made = Function::new(&self.gpu, &self.volume, settings, None, emptying)?;
            self.show(Arc::clone(&self.volume), made)?;
        }
        let toned = Settings {
            tone: class.settings.tone,
            ..self.class.settings.clone()
        };
        // A tone is of the mean of paths, and of none of them.
        if let Some(there) = &self.function.paths
            && toned != class.settings
        {
            self.function.paths = there.under(&class.settings, &self.volume)?;
            self.traced = None;
        }
        self.class = class;
        Ok(())
    }

    /// Another volume from the next [`Renderer::record`] on, on a grid of the same size and of the same kind of voxels:
    /// the next time of a series. It has been uploaded by then, which may be recorded in the same command buffer.
    ///
    /// # Errors
    /// [`Error::OtherDescription`] where it lies in other textures; no memory.
    pub fn set_volume(
        &mut self,
        volume: &Arc<Volume>,
        function: Option<&TransferFunction>,
    ) -> Result<(), Error> {
        let settings = &self.class.settings;
        let emptying = self.emptying.as_ref();
        let made = Function::new(&self.gpu, volume, settings, function, emptying)?;
        let variant = variant_of(settings, volume, &made)?;
        let bricks = |volume: &Volume| {
            let counts = volume.copies().iter().map(|copy| copy.bricks().len());
            counts.max().unwrap_or(1)
        };
        let layouts = |volume: &Volume| {
            let copies = volume.copies().iter();
            copies.map(|copy| copy.layout()).collect::<Vec<_>>()
        };
        // Half-angle slices have an image of the light's view of the grid.
        let is_as_large =
            !settings.is_half_angle() || volume.grid().dims == self.volume.grid().dims;
        let lies_alike = layouts(volume) == layouts(&self.volume) && is_as_large;
        if !lies_alike || variant != self.variant || bricks(volume) > self.most_bricks {
            return Err(Error::OtherDescription {
                made: format!("{:?} in {} bricks", self.variant, self.most_bricks),
                wanted: format!("{variant:?} in {} bricks", bricks(volume)),
            });
        }
        self.show(Arc::clone(volume), made)
    }

    /// What it was made for.
    pub fn class(&self) -> &RendererDesc {
        &self.class
    }

    /// Pixels across and down.
    pub fn extent(&self) -> [u32; 2] {
        self.extent
    }

    fn given(&self, host_depth: Option<HostDepthImage>) -> Given<'_> {
        Given {
            gpu: &self.gpu,
            settings: &self.class.settings,
            pass: &self.pass,
            ring: &self.ring,
            volume: &self.volume,
            function: &self.function,
            host_depth,
            sky: self.sky.as_ref(),
            mean: self.mean.as_ref(),
        }
    }

    /// All frames bound to another volume and function before anything is changed. What was recorded with those before
    /// is drawn no more.
    fn show(&mut self, volume: Arc<Volume>, function: Function) -> Result<(), Error> {
        let sets = self.frames.iter().enumerate().map(|(k, frame)| {
            let depth = self.host_depths.get(k).or(self.host_depths.first());
            frame.bind(&Given {
                volume: &volume,
                function: &function,
                ..self.given(depth.copied())
            })
        });
        let sets = sets.collect::<Result<Vec<_>, _>>()?;
        for (frame, sets) in self.frames.iter_mut().zip(sets) {
            frame.sets = sets;
            (frame.recorded.shot, frame.begun) = (None, None);
        }
        (self.volume, self.function) = (volume, function);
        self.traced = None;
        Ok(())
    }

    pub(super) fn frame_number(&self, frame: u32) -> Result<usize, Error> {
        let of = self.class.frames_in_flight;
        match frame < of {
            true => Ok(frame as usize),
            false => Err(Error::NoFrame { found: frame, of }),
        }
    }

    fn check_depths(&self, extent: [u32; 2], images: &[HostDepthImage]) -> Result<(), Error> {
        let reads = self.class.reads_host_depth();
        let of = self.class.frames_in_flight as usize;
        let wrong = |wanted: String, found: String| Err(Error::HostDepth { wanted, found });
        match (reads, images.len()) {
            (false, 0) => Ok(()),
            (true, count) if count == 1 || count == of => {
                let unread = |image: &&HostDepthImage| !READ_DEPTH.contains(&image.layout);
                if let Some(image) = images.iter().find(unread) {
                    let found = format!("{:?}", image.layout);
                    return wrong("a layout from which shaders read depth".into(), found);
                }
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
fn variant_of(
    settings: &Settings,
    volume: &Volume,
    function: &Function,
) -> Result<ShaderVariant, Error> {
    let copy = &volume.copies()[0];
    let uses_gradient = function.mix.uses_gradient();
    let lacks_source = settings.gradient_source_beside(copy.layout()).is_some()
        && copy.gradient_source().is_none();
    if uses_gradient && lacks_source {
        return Err(Error::NotEmbedded {
            what: "a function of gradients that are made of other numbers than the filter reads",
            hint: "take a filter that reads voxels, or light with it",
        });
    }
    Ok(ShaderVariant::mixed(
        settings,
        function.mix,
        &[technique::GpuChannel::numbers(copy)],
    ))
}
