//! A scene to a picture on a device of our own.
//!
//! ```text
//! for each ray position in the pixel:
//!     gather:   technique -> accumulation (and layers)
//!     resolve:  colour    -> picture, read back
//! picture = mean over the positions
//! ```

mod behind;
mod classified;
mod copied;
mod field;
mod filtered;
mod gather;
mod kept;
mod labelled;
mod pacing;
mod path_layers;
mod path_sky;
mod path_sums;
mod paths;
mod preclassified;
mod readback;
mod runs;
mod skipping;
mod streaming;

use super::Error;
use super::fade::{render_faded, stacks_of};
use super::gradients::decided;
use super::keyed::Keyed;
use super::layer_rules::{Clock, Mean, check_layers};
use super::light::Matter;
use super::passes::{Passes, key_of};
use super::stream::{Cache, Stream};
use super::submission::Submission;
use super::sum::sum_of;
use super::targets::Targets;
use super::time_slices::TimeSlices;
use super::upload::{keep, upload, upload_with_gradient_source};
use crate::gpu::{Headless, ParameterRing, Timer};
use crate::picture::{ColorSpace, LayerKind, Picture};
use crate::points::{FieldKernel, Points};
use crate::resident::{GpuTransfer, GpuVolume};
use crate::scene::{Beside, Scene, positions_in_pixel};
use crate::technique::cost::ms_of_fetches;
use crate::technique::gather::{CanvasDesc, PICTURE};
use crate::technique::{
    self, DepthAccess, Functions, GpuChannel, InPixel, LightPlan, LightVolume, Mode, Role,
    SampleInputs, ShaderVariant, parameter_ring,
};
use crate::transfer::{GradientTransfer, TransferFunction};
use crate::volume::Volume;
use behind::Behind;
use copied::Copied;
use field::Field;
pub use filtered::Filtered;
use gather::points_at_once;
pub use kept::Kept;
use pacing::{Known, passes_of};
use path_sky::PathSky;
pub use path_sums::PathSums;
use paths::Ends;
pub use paths::Traced;
use preclassified::Preclassified;
use skipping::Skipped;
use std::collections::HashMap;
use std::sync::Arc;
use streaming::{BRICKS_AT_ONCE, Streaming};

/// A resolve reads one texel and classifies at most once, beside which a sample of a volume is expensive.
const LOOKS_OF_A_RESOLVE: f64 = 0.5;

/// A picture and what it took.
#[derive(Debug)]
pub struct Rendered {
    /// Linear premultiplied colour and the layers that were asked for.
    pub picture: Picture,
    /// Milliseconds on the device; `None` where it has no clock.
    pub gpu_ms: Option<f64>,
}

/// Renders pictures of one volume, or of several on one grid. What does not change from picture to picture stays on the
/// device.
#[derive(Debug)]
pub struct Renderer<'v> {
    volumes: Vec<&'v Volume>,
    /// Which of them is drawn, where they are drawn one by one; else the first.
    shown: usize,
    /// What comes brick by brick; the volumes are its outline then.
    streaming: Option<Streaming<'v>>,
    /// What a function made of its voxels, where they are classified before they are interpolated.
    preclassified: Preclassified,
    /// What has been needed so far.
    resident: HashMap<Copied, Vec<GpuVolume>>,
    transfer: Keyed<Classifying, GpuTransfer>,
    light: Keyed<(Matter, LightPlan), LightVolume>,
    skipped: Skipped,
    targets: Option<Targets>,
    passes: Option<Passes>,
    ring: ParameterRing,
    timer: Option<Timer>,
    pub(super) slices: TimeSlices<'v>,
    /// What a picture took.
    known: Option<Known>,
    /// How often transfer functions were changed.
    changes: u64,
    /// Passes over all samples of the picture that is being drawn: how many are done, and how many there are.
    passes_done: [usize; 2],
    /// Geometry in the pictures.
    behind: Option<Behind>,
    field: Keyed<(Points, FieldKernel), Field>,
    path_ends: Ends<'v>,
    path_sky: PathSky,
    device: Headless,
}

/// What transfer functions on the device are made of.
#[derive(Debug, PartialEq)]
struct Classifying {
    functions: Vec<TransferFunction>,
    space: ColorSpace,
    is_preintegrated: bool,
    density: f64,
    scatters: bool,
}

impl<'v> Renderer<'v> {
    /// A renderer of `volume` on `device`. Nothing is uploaded yet.
    ///
    /// # Errors
    /// Where the device gives no memory.
    pub fn new(device: Headless, volume: &'v Volume) -> Result<Self, Error> {
        Self::several(device, vec![volume])
    }

    /// A renderer of the [`Scene::volumes`] of scenes.
    ///
    /// # Errors
    /// Where the device gives no memory.
    pub fn several(device: Headless, volumes: Vec<&'v Volume>) -> Result<Self, Error> {
        Self::with_kept(device.into(), volumes)
    }

    /// A renderer of scenes of [`Stream::outline`].
    ///
    /// # Errors
    /// Where the device gives no memory.
    pub fn streamed(device: Headless, stream: &'v Stream) -> Result<Self, Error> {
        let mut made = Self::several(device, vec![stream.outline()])?;
        made.streaming = Some(Streaming {
            stream,
            cache: Cache::default(),
        });
        Ok(made)
    }

    /// The device.
    pub fn device(&self) -> &Headless {
        &self.device
    }

    /// The device, free for another volume.
    pub fn into_device(self) -> Headless {
        self.device
    }

    /// Uploads what pictures of `scene` read, as far as it is not there yet.
    ///
    /// # Errors
    /// Where something is over a limit of the device.
    pub fn upload(&mut self, scene: &Scene) -> Result<(), Error> {
        scene.check()?;
        let scene = &scene.under_labels();
        let settings = &decided(self.device.gpu(), scene);
        let scene = &Scene { settings, ..*scene };
        self.check_stream(scene)?;
        if self.streaming.is_some() {
            return self.prepare_stream(scene);
        }
        for (settings, _) in &stacks_of(scene) {
            self.upload(&Scene { settings, ..*scene })?;
        }
        self.check_volumes(scene)?;
        self.heed_law(scene)?;
        let mut copied = Copied::of(scene);
        // The same picture comes out the same whatever was drawn before: texels that are there already are as good as corners,
        // not as runs.
        if copied.is_by_corners || copied.runs.is_some() {
            let with_texels = copied.with_texels();
            let is_there = |copied| self.resident.contains_key(copied);
            let is_lean = is_there(&copied)
                || match copied.runs {
                    Some(floats) => self.upload_runs(copied, floats)?,
                    None => !is_there(&with_texels) && self.upload_corners(copied)?,
                };
            if is_lean {
                return Ok(());
            }
            copied = with_texels;
        }
        if !self.resident.contains_key(&copied) {
            let Copied {
                layout,
                spline,
                gradient_source,
                kept,
                is_by_corners: _,
                is_preclassified: _,
                runs: _,
            } = copied;
            self.make_volumes(copied)?;
            let volumes = self.preclassified.read(copied, &self.volumes);
            let device = &mut self.device;
            let mut made = match gradient_source {
                None => upload(device, &volumes, layout, spline)?,
                Some(source) => vec![upload_with_gradient_source(
                    device, volumes[0], layout, spline, source,
                )?],
            };
            if let Some(operator) = kept {
                keep(device, &mut self.slices, &mut made[0], operator)?;
            }
            self.resident.insert(copied, made);
        }
        self.keep_corners(scene, copied)
    }

    /// Each volume of a scene is one of the renderer's.
    fn check_volumes(&self, scene: &Scene) -> Result<(), Error> {
        let wanted = self.shown + scene.volumes().len();
        let found = self.volumes.len();
        match wanted > found {
            true => Err(Error::FewerVolumes { wanted, found }),
            false => Ok(()),
        }
    }

    /// Makes the pipelines that pictures of `scene` take and the images that they are drawn in, as far as they are
    /// not there yet: no picture waits for them then. Pictures that are made of several keep theirs for later.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn prepare_pipelines(&mut self, scene: &Scene) -> Result<(), Error> {
        self.prepare_with(scene, |renderer, scene| {
            let has_layers = renderer.leaves_path_images(scene.settings, &[]);
            renderer.prepare(scene, has_layers)
        })
    }

    /// Finds out what pictures of `scene` need not look at, as [`Renderer::prepare_pipelines`] makes pipelines.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn prepare_empty_space(&mut self, scene: &Scene) -> Result<(), Error> {
        self.prepare_with(scene, Self::prepare_skip)
    }

    fn prepare_with(
        &mut self,
        scene: &Scene,
        prepare: impl FnOnce(&mut Self, &Scene) -> Result<(), Error>,
    ) -> Result<(), Error> {
        scene.check()?;
        let scene = &scene.under_labels();
        let settings = &decided(self.device.gpu(), scene);
        let scene = &Scene { settings, ..*scene };
        let is_sum = scene.mix() == SampleInputs::Channels && scene.settings.mode.is_projection();
        self.upload(scene)?;
        match is_sum || !stacks_of(scene).is_empty() {
            true => Ok(()),
            false => prepare(self, scene),
        }
    }

    /// The picture of `scene`, whose volume is the renderer's, with `layers`.
    ///
    /// # Errors
    /// Parameters out of range, a limit of the device, a layer that the technique does not have.
    pub fn render(&mut self, scene: &Scene, layers: &[LayerKind]) -> Result<Rendered, Error> {
        let of_volume = layers.iter().copied();
        let of_volume: Vec<_> = of_volume.filter(|kind| *kind != LayerKind::Line).collect();
        let lines = match of_volume.len() < layers.len() {
            true => Some(self.lines(scene)?),
            false => None,
        };
        let mut rendered = self.render_volume(scene, &of_volume)?;
        self.bring_nearer(scene, &mut rendered.picture.layers);
        if let Some(lines) = lines {
            let kept = &mut rendered.picture.layers;
            let at = layers.iter().position(|kind| *kind == LayerKind::Line);
            kept.insert(at.unwrap_or(kept.len()), lines);
        }
        Ok(rendered)
    }

    /// The same without labels over it.
    fn render_unlabeled(&mut self, scene: &Scene, layers: &[LayerKind]) -> Result<Rendered, Error> {
        check_layers(scene, layers)?;
        let settings = &decided(self.device.gpu(), scene);
        let scene = &Scene { settings, ..*scene };
        let stacks = stacks_of(scene);
        if !stacks.is_empty() {
            return render_faded(self, scene, layers, &stacks);
        }
        self.upload(scene)?;
        let mut clock = Clock(self.timer.is_some().then_some(0.0));
        if scene.mix() == SampleInputs::Channels && scene.settings.mode.is_projection() {
            let all = scene.projected();
            let of = all.len();
            let one_by_one = all.into_iter().enumerate();
            let picture = sum_of(one_by_one.map(|(shown, one)| {
                self.shown = shown;
                let span = self.slices.enter(shown, of);
                let picture = self.picture(&one, layers, &mut clock);
                self.slices.leave(span);
                picture
            }));
            self.shown = 0;
            let (mut picture, gpu_ms) = (picture?, clock.0);
            self.put_geometry_over(scene, &mut picture)?;
            return Ok(Rendered { picture, gpu_ms });
        }
        let mut picture = self.picture(scene, layers, &mut clock)?;
        self.put_geometry_over(scene, &mut picture)?;
        Ok(Rendered {
            picture,
            gpu_ms: clock.0,
        })
    }

    /// One picture of what has been uploaded.
    fn picture(
        &mut self,
        scene: &Scene,
        layers: &[LayerKind],
        clock: &mut Clock,
    ) -> Result<Picture, Error> {
        let most_turns = self.device.gpu().limits().max_loop_turns;
        let has_layers = match scene.settings.technique.traces_paths() {
            true => self.leaves_path_images(scene.settings, layers),
            false => !layers.is_empty(),
        };
        self.passes_done = [0, passes_of(scene, has_layers, most_turns)];
        self.prepare(scene, has_layers)?;
        self.prepare_skip(scene)?;
        let functions = scene.transfers().into_iter();
        match functions.collect::<Option<Vec<_>>>() {
            _ if scene.settings.mode == Mode::Iso => {
                self.prepare_light(scene)?;
                // What colours the surfaces.
                if let Some(&Some(function)) = scene.transfers().get(1) {
                    self.set_transfers(scene, &[function])?;
                }
            }
            Some(_) if !scene.settings.mode.is_projection() => self.prepare_light(scene)?,
            Some(functions) => self.set_transfers(scene, &functions)?,
            None if scene.settings.mode.is_projection() => {
                clock.add(self.gather(scene, InPixel::CENTER)?);
                let function = self.grey_of_picture(scene)?;
                self.set_transfers(scene, &[&function])?;
            }
            None => return Err(technique::Error::NoTransferFunction.into()),
        }
        let [width, height] = scene.extent_pixels;
        let color_space = scene.settings.color_space;
        if scene.settings.technique.traces_paths() {
            let (pixels, layers) = self.picture_of_paths(scene, layers, clock)?;
            return Ok(Picture {
                width,
                height,
                pixels,
                color_space,
                layers,
            });
        }
        let pixels = self.mean_of_rays(scene, clock)?;
        let per_side = scene.settings.rays_per_side;
        if per_side > 1 && !layers.is_empty() {
            self.look_behind(scene, InPixel::CENTER)?;
            clock.add(self.gather(scene, InPixel::CENTER)?);
        }
        let layers = self.read_layers(scene, layers)?;
        Ok(Picture {
            width,
            height,
            pixels,
            color_space,
            layers,
        })
    }

    /// The mean of the rays of each pixel, before what lies behind them.
    fn mean_of_rays(&mut self, scene: &Scene, clock: &mut Clock) -> Result<Vec<[f32; 4]>, Error> {
        let mut mean = Mean::new(scene.settings.rays_per_side);
        for in_pixel in positions_in_pixel(scene.settings) {
            self.look_behind(scene, in_pixel)?;
            let (mut colors, gpu_ms) = self.colors(scene, in_pixel)?;
            clock.add(gpu_ms);
            if let Some(behind) = &self.behind {
                behind.put(&mut colors, scene.settings);
            }
            mean.add(colors);
        }
        Ok(mean.pixels)
    }

    /// Pipelines and targets for the picture.
    fn prepare(&mut self, scene: &Scene, has_layers: bool) -> Result<(), Error> {
        let gpu = Arc::clone(self.device.gpu());
        let of_field = match scene.settings.field {
            Some(_) => self.prepare_field(scene)?,
            None => 0,
        };
        let parts = match &self.streaming {
            Some(streaming) => vec![streaming.part()],
            None => parts_of(&self.resident, self.shown, scene),
        };
        // Half-angle slices have parameters of the eye and of the light.
        let is_half = scene.settings.is_half_angle();
        let at_once = if is_half { 2 } else { BRICKS_AT_ONCE };
        let bricks = parts[0].volume.bricks().len();
        let of_ray = match scene.beside {
            Beside::Points(_) if scene.settings.field.is_some() => of_field,
            Beside::Points(points) => points.len() / points_at_once(&gpu, scene) as usize + 1,
            _ => {
                let grid = scene.volume.grid();
                let view = scene.view(&grid, [0.0; 2]);
                view.splat_parts(view.splat_sheets_at_once(gpu.limits().max_loop_turns)?)
            }
        };
        let slots = bricks.max(at_once).max(of_ray) as u32;
        let are_several = bricks > 1 || self.streaming.is_some() || of_ray > 1;
        let keeps_layers = has_layers || are_several;
        let variant = ShaderVariant {
            writes_layers: keeps_layers,
            ..ShaderVariant::mixed(scene.settings, scene.mix(), &parts).of_whole(scene.settings)
        };
        let functions = scene.transfers().into_iter().flatten();
        let points = functions.map(|f| f.color.len().max(f.opacity.len())).max();
        let gradient_transfer = scene
            .transfer
            .and_then(|function| function.gradient_transfer.as_ref());
        let functions = Functions {
            points: points.unwrap_or(0),
            second: gradient_transfer.is_some_and(GradientTransfer::needs_second),
            labels: parts
                .iter()
                .filter(|part| part.role == Role::Labels)
                .count(),
        };
        scene.view(&scene.volume.grid(), [0.0; 2]).check_turns(
            &variant,
            parts.len(),
            functions,
            gpu.limits().max_loop_turns,
        )?;
        if self.ring.slots() < slots {
            self.ring = parameter_ring(&gpu, slots)?;
        }
        let depth_access = self.depth_access(scene.settings);
        let patches = match depth_access {
            DepthAccess::None => self.patches_for(scene)?,
            // Lists know nothing of what hides them.
            DepthAccess::Tested | DepthAccess::Sampled => None,
        };
        let is_patched = patches.is_some();
        let key = key_of(scene.settings, &variant, is_patched, depth_access);
        let grid = scene.volume.grid();
        let view = scene.view(&grid, [0.0; 2]);
        let desc = CanvasDesc {
            extent: scene.extent_pixels,
            dims: scene.volume.dims,
            intermediate_room: view.intermediate_room()?,
            keeps_layers,
            beside: None,
        };
        let passes = match self.passes.take() {
            Some(passes) if *passes.key() == key => passes,
            _ => {
                self.targets = None;
                Passes::new(&gpu, scene.settings, key)?
            }
        };
        let targets = match self.targets.take() {
            Some(targets) if targets.serve(&desc) => targets,
            _ => Targets::new(&gpu, &passes, &desc)?,
        };
        self.passes = Some(passes);
        self.targets.insert(targets).canvas.patches = patches;
        Ok(())
    }

    /// What making colours of what was gathered takes.
    fn resolve_ms(&self) -> f64 {
        let targets = self.targets.as_ref().expect("prepared");
        let pixels = targets.extent().map(f64::from).iter().product::<f64>();
        ms_of_fetches(self.device.gpu(), LOOKS_OF_A_RESOLVE * pixels)
    }

    /// The colours of what was gathered; the parameters are still in the ring.
    fn resolve(&mut self) -> Result<Vec<[f32; 4]>, Error> {
        let expected_ms = self.resolve_ms();
        let passes = self.passes.as_ref().expect("prepared");
        let targets = self.targets.as_ref().expect("prepared");
        let transfer = self.transfer.get();
        let gathered = targets.canvas.image(PICTURE);
        let ring = (&self.ring, self.ring.offset(0)?);
        let finish = passes.finish(gathered, &targets.output, ring, transfer)?;
        finish.resolve(Submission {
            expected_ms,
            device: &mut self.device,
            timer: None,
            slices: &mut self.slices,
            is_drawing: false,
            finish: None,
        })?;
        let (image, used) = finish.image(gathered);
        Ok(targets.read(&mut self.device, image, used)?)
    }
}

/// The volumes of the scene as they lie on the device, from the first that is shown on.
fn parts_of<'a>(
    resident: &'a HashMap<Copied, Vec<GpuVolume>>,
    shown: usize,
    scene: &Scene,
) -> Vec<GpuChannel<'a>> {
    let copied = Copied::of(scene);
    let there = resident.get(&copied);
    let there = there.unwrap_or_else(|| &resident[&copied.with_texels()]);
    let there = &there[shown..];
    let parts = there.iter().zip(scene.roles());
    parts
        .map(|(volume, role)| GpuChannel { volume, role })
        .collect()
}
