//! The pipelines of one kind of picture, and one submission for each.

use super::targets::{FORMAT, Targets};
use crate::gpu::{
    Blend, Error, Gpu, Headless, Load, ParameterRing, Timer, Use, begin_rendering, end_rendering,
    image_barrier,
};
use crate::resident::GpuTransfer;
use crate::resolve::Resolve;
use crate::technique::blend::{Drawn, clear_color};
use crate::technique::projection::Projection;
use crate::technique::raycast::Raycast;
use crate::technique::slices_2d::Slices2d;
use crate::technique::slices_3d::Slices3d;
use crate::technique::{Inputs, Mode, Order, Settings, Technique, Words};
use std::sync::Arc;

/// What pipelines depend on.
pub type Key = (Technique, Mode, Order, Words);

/// The pipelines of one kind of picture.
#[derive(Debug)]
pub struct Passes {
    key: Key,
    gather: Gather,
    count: Option<Gather>,
    resolve: Resolve,
}

/// Where samples are taken.
#[derive(Debug)]
enum Gather {
    Raycast(Raycast),
    Projection(Projection),
    Slices3d(Slices3d),
    Slices2d(Slices2d),
}

/// One submission: the device, what it reads, where it writes, and its clock.
#[derive(Debug)]
pub struct Submission<'a> {
    /// Submits and waits.
    pub device: &'a mut Headless,
    /// What a technique reads.
    pub inputs: &'a Inputs<'a>,
    /// The images.
    pub targets: &'a Targets,
    /// Of the parameters in the ring.
    pub offset: u32,
    /// Slices to draw.
    pub slices: u32,
    /// The device's clock, if it has one.
    pub timer: Option<&'a Timer>,
}

impl Passes {
    /// Compiles for such pictures.
    pub fn new(gpu: &Arc<Gpu>, settings: &Settings, words: &Words) -> Result<Self, Error> {
        let Settings {
            technique,
            mode,
            order,
            ..
        } = *settings;
        let slicer = |drawn| match technique {
            Technique::Slices3d => {
                Slices3d::new(gpu, drawn, order, words, FORMAT).map(Gather::Slices3d)
            }
            _ => Slices2d::new(gpu, drawn, order, words, FORMAT).map(Gather::Slices2d),
        };
        let (gather, count) = match technique {
            Technique::Raycast if mode.is_projection() => {
                (Gather::Projection(Projection::new(gpu, mode, words)?), None)
            }
            Technique::Raycast => (Gather::Raycast(Raycast::new(gpu, words)?), None),
            Technique::Slices3d | Technique::Slices2d => {
                (slicer(Drawn::Picture(mode))?, Some(slicer(Drawn::Count)?))
            }
        };
        let resolve = Resolve::new(gpu, mode, Blend::Add, FORMAT)?;
        Ok(Self {
            key: (technique, mode, order, *words),
            gather,
            count,
            resolve,
        })
    }

    /// What these pipelines were made for.
    pub fn key(&self) -> &Key {
        &self.key
    }

    /// Runs the technique into `accumulation` (and `layers`) and leaves them in [`Use::FragmentSampled`].
    /// Milliseconds on the device.
    pub fn gather(&self, submission: Submission) -> Result<Option<f64>, Error> {
        let (_, mode, ..) = self.key;
        let into = &submission.targets.accumulation;
        submission.run(&self.gather, into, clear_color(mode))
    }

    /// Counts a slicer's samples into `layers`; the ray caster has counted them already.
    pub fn count(&self, submission: Submission) -> Result<Option<f64>, Error> {
        let Some(count) = &self.count else {
            return Ok(None);
        };
        let into = &submission.targets.layers;
        submission.run(count, into, [0.0; 4])
    }

    /// Adds the weighted colour of what `gather` left to `picture`, which the first resolve clears; leaves it in
    /// [`Use::ColorTarget`].
    pub fn resolve(
        &self,
        device: &mut Headless,
        ring: &ParameterRing,
        offset: u32,
        targets: &Targets,
        transfer: Option<&GpuTransfer>,
        is_first: bool,
    ) -> Result<(), Error> {
        let gpu = Arc::clone(device.gpu());
        let bindings = self.resolve.bind(ring, &targets.accumulation, transfer)?;
        let (before, load) = if is_first {
            (Use::Nothing, Load::Clear([0.0; 4]))
        } else {
            (Use::ColorTarget, Load::Keep)
        };
        let picture = &targets.picture;
        // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
        device.run(|cmd| unsafe {
            image_barrier(&gpu, cmd, picture, before, Use::ColorTarget);
            begin_rendering(&gpu, cmd, &[(picture.view(), load)], targets.extent);
            self.resolve.record(cmd, &bindings, offset, targets.extent);
            end_rendering(&gpu, cmd);
            Ok(())
        })
    }
}

impl Submission<'_> {
    fn run(
        self,
        gather: &Gather,
        into: &crate::gpu::Image,
        clear: [f32; 4],
    ) -> Result<Option<f64>, Error> {
        let Self {
            device,
            inputs,
            targets,
            offset,
            slices,
            timer,
        } = self;
        let extent = targets.extent;
        let bindings = match gather {
            Gather::Raycast(pass) => pass.bind(inputs, into, &targets.layers)?,
            Gather::Projection(pass) => pass.bind(inputs, into)?,
            Gather::Slices3d(pass) => pass.bind(inputs)?,
            Gather::Slices2d(pass) => pass.bind(inputs)?,
        };
        let gpu = Arc::clone(device.gpu());
        // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
        device.run(|cmd| unsafe {
            if let Some(timer) = timer {
                timer.start(cmd);
            }
            let draws = |draw: &dyn Fn()| {
                image_barrier(&gpu, cmd, into, Use::Nothing, Use::ColorTarget);
                begin_rendering(&gpu, cmd, &[(into.view(), Load::Clear(clear))], extent);
                draw();
                end_rendering(&gpu, cmd);
                image_barrier(&gpu, cmd, into, Use::ColorTarget, Use::FragmentSampled);
            };
            match gather {
                Gather::Raycast(pass) => {
                    for image in [into, &targets.layers] {
                        image_barrier(&gpu, cmd, image, Use::Nothing, Use::ComputeWrite);
                    }
                    pass.record(cmd, &bindings, offset, extent)?;
                    for image in [into, &targets.layers] {
                        image_barrier(&gpu, cmd, image, Use::ComputeWrite, Use::FragmentSampled);
                    }
                }
                Gather::Projection(pass) => {
                    image_barrier(&gpu, cmd, into, Use::Nothing, Use::ComputeWrite);
                    pass.record(cmd, &bindings, offset, extent)?;
                    image_barrier(&gpu, cmd, into, Use::ComputeWrite, Use::FragmentSampled);
                }
                Gather::Slices3d(pass) => {
                    draws(&|| pass.record(cmd, &bindings, offset, extent, slices));
                }
                Gather::Slices2d(pass) => {
                    draws(&|| pass.record(cmd, &bindings, offset, extent, slices));
                }
            }
            if let Some(timer) = timer {
                timer.stop(cmd);
            }
            Ok(())
        })?;
        timer.map_or(Ok(None), Timer::elapsed_ms)
    }
}
