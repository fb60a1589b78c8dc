//! A scene to a picture on a device of our own.
//!
//! ```text
//! for each ray position in the pixel:
//!     gather:   technique -> accumulation (and layers)
//!     resolve:  colour    -> picture, read back
//! picture = mean over the positions
//! ```

use super::Error;
use super::passes::Passes;
use super::submission::{Part, Submission};
use super::targets::Targets;
use super::upload::upload;
use crate::gpu::{Headless, ParameterRing, Timer, Use};
use crate::picture::{ColorSpace, Layer, LayerKind, Picture};
use crate::resident::{GpuTransfer, GpuVolume, TextureLayout};
use crate::resolve::reference::projected_value;
use crate::scene::{Scene, positions_in_pixel};
use crate::technique::{self, Inputs, Recording, Settings, Technique, Words, parameter_ring};
use crate::transfer::{Classified, TransferFunction, Window};
use crate::volume::Volume;
use std::sync::Arc;

/// A picture and what it took.
#[derive(Debug)]
pub struct Rendered {
    /// Linear premultiplied colour and the layers that were asked for.
    pub picture: Picture,
    /// Milliseconds on the device; `None` where it has no clock.
    pub gpu_ms: Option<f64>,
}

/// Renders pictures of one volume. What does not change from picture to picture stays on the device.
#[derive(Debug)]
pub struct Renderer<'v> {
    volume: &'v Volume,
    /// As 3D textures, then as the stacks along x, y, z: what has been needed so far.
    resident: [Option<GpuVolume>; 4],
    transfer: Option<Uploaded>,
    targets: Option<Targets>,
    passes: Option<Passes>,
    ring: ParameterRing,
    timer: Option<Timer>,
    device: Headless,
}

/// A transfer function on the device, and what it was made of.
#[derive(Debug)]
struct Uploaded {
    function: TransferFunction,
    space: ColorSpace,
    made: GpuTransfer,
}

impl<'v> Renderer<'v> {
    /// A renderer of `volume` on `device`. Nothing is uploaded yet.
    ///
    /// # Errors
    /// Where the device gives no memory.
    pub fn new(device: Headless, volume: &'v Volume) -> Result<Self, Error> {
        let gpu = device.gpu();
        Ok(Self {
            volume,
            resident: [const { None }; 4],
            transfer: None,
            targets: None,
            passes: None,
            ring: parameter_ring(gpu, 1)?,
            timer: Timer::new(gpu)?,
            device,
        })
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
        let layout = scene.view(&self.volume.grid(), [0.0; 2]).texture_layout();
        let resident = &mut self.resident[place(layout)];
        if resident.is_none() {
            *resident = Some(upload(&mut self.device, self.volume, layout)?);
        }
        Ok(())
    }

    /// The picture of `scene`, whose volume is the renderer's, with `layers`.
    ///
    /// # Errors
    /// Parameters out of range, a limit of the device, a layer that the technique does not have.
    pub fn render(&mut self, scene: &Scene, layers: &[LayerKind]) -> Result<Rendered, Error> {
        check_layers(scene.settings, layers)?;
        self.upload(scene)?;
        self.prepare(scene)?;
        let mut clock = Clock(self.timer.is_some().then_some(0.0));
        match scene.transfer {
            Some(function) => self.set_transfer(scene, function)?,
            None if scene.settings.mode.is_projection() => {
                clock.add(self.gather(scene, [0.0; 2])?);
                let function = self.grey_of_picture(scene)?;
                self.set_transfer(scene, &function)?;
            }
            None => return Err(technique::Error::NoTransferFunction.into()),
        }
        let per_side = scene.settings.rays_per_side;
        let mut mean = Mean::new(scene.extent_pixels, per_side);
        for in_pixel in positions_in_pixel(per_side) {
            clock.add(self.gather(scene, in_pixel)?);
            mean.add(&self.resolve()?);
        }
        let pixels = mean.pixels;
        if per_side > 1 && !layers.is_empty() {
            clock.add(self.gather(scene, [0.0; 2])?);
        }
        let layers = self.read_layers(scene, layers)?;
        let [width, height] = scene.extent_pixels;
        let color_space = scene.settings.color_space;
        let picture = Picture {
            width,
            height,
            pixels,
            color_space,
            layers,
        };
        Ok(Rendered {
            picture,
            gpu_ms: clock.0,
        })
    }

    /// Targets and pipelines for the picture.
    fn prepare(&mut self, scene: &Scene) -> Result<(), Error> {
        let gpu = Arc::clone(self.device.gpu());
        if self
            .targets
            .as_ref()
            .is_none_or(|targets| targets.extent != scene.extent_pixels)
        {
            self.targets = Some(Targets::new(&gpu, scene.extent_pixels)?);
        }
        let layout = scene.view(&self.volume.grid(), [0.0; 2]).texture_layout();
        let resident = self.resident[place(layout)].as_ref().expect("uploaded");
        let slots = resident.bricks().len() as u32;
        if self.ring.slots() < slots {
            self.ring = parameter_ring(&gpu, slots)?;
        }
        let words = Words::of(scene.settings, resident);
        let Settings {
            technique,
            mode,
            order,
            ..
        } = *scene.settings;
        let key = (technique, mode, order, words);
        if self
            .passes
            .as_ref()
            .is_none_or(|passes| *passes.key() != key)
        {
            self.passes = Some(Passes::new(&gpu, scene.settings, &words)?);
        }
        Ok(())
    }

    fn set_transfer(&mut self, scene: &Scene, function: &TransferFunction) -> Result<(), Error> {
        let space = scene.settings.color_space;
        let is_there = |there: &Uploaded| there.function == *function && there.space == space;
        if self.transfer.as_ref().is_some_and(is_there) {
            return Ok(());
        }
        let length = function.reference_length;
        let length = length.unwrap_or_else(|| self.volume.grid().smallest_spacing());
        let made = GpuTransfer::new(self.device.gpu(), function, length, space)?;
        // SAFETY: recorded outside rendering; `run` waits, and `made` lives meanwhile.
        self.device.run(|cmd| unsafe { made.record_upload(cmd) })?;
        self.transfer = Some(Uploaded {
            function: function.clone(),
            space,
            made,
        });
        Ok(())
    }

    /// One pass of the technique, rays at one position in each pixel.
    fn gather(&mut self, scene: &Scene, in_pixel: [f64; 2]) -> Result<Option<f64>, Error> {
        self.submit(scene, in_pixel, Passes::gather)
    }

    /// Parameters into the ring, then one submission.
    fn submit(
        &mut self,
        scene: &Scene,
        in_pixel: [f64; 2],
        pass: impl FnOnce(&Passes, Submission) -> Result<Option<f64>, crate::gpu::Error>,
    ) -> Result<Option<f64>, Error> {
        let grid = self.volume.grid();
        let view = scene.view(&grid, in_pixel);
        let transfer = self.transfer.as_ref().map(|uploaded| &uploaded.made);
        let volume = self.resident[place(view.texture_layout())]
            .as_ref()
            .expect("uploaded");
        let part = |(slot, recording): (u32, Recording)| {
            let inputs = Inputs {
                ring: &self.ring,
                volume,
                brick: &volume.bricks()[recording.brick],
                transfer,
            };
            Ok(Part {
                inputs,
                offset: recording.write(&self.ring, slot)?,
                slices: recording.slices,
            })
        };
        let recordings = view.recordings(volume, transfer)?;
        let parts = (0..).zip(recordings).map(part);
        let bricks = parts.collect::<Result<Vec<_>, Error>>()?;
        let submission = Submission {
            device: &mut self.device,
            targets: self.targets.as_ref().expect("prepared"),
            bricks: &bricks,
            timer: self.timer.as_ref(),
        };
        Ok(pass(self.passes.as_ref().expect("prepared"), submission)?)
    }

    /// The colours of what was gathered; the parameters are still in the ring.
    fn resolve(&mut self) -> Result<Vec<[f32; 4]>, Error> {
        let passes = self.passes.as_ref().expect("prepared");
        let targets = self.targets.as_ref().expect("prepared");
        let transfer = self.transfer.as_ref().map(|uploaded| &uploaded.made);
        let offset = self.ring.offset(0)?;
        passes.resolve(&mut self.device, &self.ring, offset, targets, transfer)?;
        Ok(targets.read(&mut self.device, &targets.picture, Use::ColorTarget)?)
    }

    /// The default window of a projecting mode without a transfer function: the range of this picture.
    fn grey_of_picture(&mut self, scene: &Scene) -> Result<TransferFunction, Error> {
        let targets = self.targets.as_ref().expect("prepared");
        let found = targets.read(
            &mut self.device,
            &targets.accumulation,
            Use::FragmentSampled,
        )?;
        let values = found
            .iter()
            .filter_map(|&left| projected_value(scene.settings.mode, left));
        let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
            [low.min(v.into()), high.max(v.into())]
        });
        Ok(Window::of_range([low, high]).grey(Classified::Projection))
    }

    /// The layers of the rays through pixel centres, which were gathered last.
    fn read_layers(&mut self, scene: &Scene, wanted: &[LayerKind]) -> Result<Vec<Layer>, Error> {
        let Settings {
            technique, mode, ..
        } = *scene.settings;
        if wanted.is_empty() {
            return Ok(Vec::new());
        }
        let is_slicer = technique != Technique::Raycast;
        let targets = self.targets.as_ref().expect("prepared");
        let left = targets.read(
            &mut self.device,
            &targets.accumulation,
            Use::FragmentSampled,
        )?;
        // (value, depth, transmittance, samples) of each pixel, as far as the technique has them.
        let beside = if is_slicer {
            self.submit(scene, [0.0; 2], Passes::count)?;
            let targets = self.targets.as_ref().expect("prepared");
            let counts = targets.read(&mut self.device, &targets.layers, Use::FragmentSampled)?;
            counts
                .into_iter()
                .map(|[n, ..]| [0.0, -1.0, 0.0, n])
                .collect()
        } else if mode.is_projection() {
            left.iter()
                .map(|&[_, _, depth, samples]| [0.0, depth, 0.0, samples])
                .collect()
        } else {
            targets.read(&mut self.device, &targets.layers, Use::FragmentSampled)?
        };
        let layer = |kind| {
            let number = |(left, beside): (&[f32; 4], &[f32; 4])| match kind {
                LayerKind::Value => projected_value(mode, *left).unwrap_or(f32::NAN),
                LayerKind::Depth if beside[1] < 0.0 => f32::NAN,
                LayerKind::Depth => beside[1],
                LayerKind::Transmittance => 1.0 - left[3],
                LayerKind::Samples => beside[3],
            };
            Layer {
                kind,
                values: left.iter().zip(&beside).map(number).collect(),
            }
        };
        Ok(wanted.iter().map(|&kind| layer(kind)).collect())
    }
}

/// Blending keeps no depth, a projection no transmittance, and a composite has no one value.
fn check_layers(settings: &Settings, wanted: &[LayerKind]) -> Result<(), Error> {
    let Settings {
        technique, mode, ..
    } = *settings;
    for &layer in wanted {
        let is_there = match layer {
            LayerKind::Value => mode.is_projection(),
            LayerKind::Depth => technique == Technique::Raycast,
            LayerKind::Transmittance => !mode.is_projection(),
            LayerKind::Samples => true,
        };
        if !is_there {
            return Err(Error::NoLayer {
                technique,
                mode,
                layer,
            });
        }
    }
    Ok(())
}

/// Where a layout is kept among those that are resident.
fn place(layout: TextureLayout) -> usize {
    match layout {
        TextureLayout::Texture3d => 0,
        TextureLayout::Stack(axis) => 1 + axis,
    }
}

/// The mean of pictures, added up in f32 in the order of their rays: no device needs to blend for it.
struct Mean {
    weight: f32,
    pixels: Vec<[f32; 4]>,
}

impl Mean {
    fn new([width, height]: [u32; 2], per_side: u32) -> Self {
        Self {
            weight: 1.0 / (per_side * per_side) as f32,
            pixels: vec![[0.0; 4]; width as usize * height as usize],
        }
    }

    fn add(&mut self, picture: &[[f32; 4]]) {
        for (sum, color) in self.pixels.iter_mut().zip(picture) {
            *sum = std::array::from_fn(|c| sum[c] + self.weight * color[c]);
        }
    }
}

/// Milliseconds on the device so far.
struct Clock(Option<f64>);

impl Clock {
    fn add(&mut self, more: Option<f64>) {
        self.0 = self.0.zip(more).map(|(sum, more)| sum + more);
    }
}
