//! The pipelines of one kind of picture, and one submission for each.

use super::targets::Targets;
use crate::gpu::{
    Bindings, Blend, Error, Gpu, Headless, Image, Load, ParameterRing, Timer, Use, begin_rendering,
    end_rendering, image_barrier,
};
use crate::resident::GpuTransfer;
use crate::resolve::Resolve;
use crate::technique::blend::{Drawn, clear_color};
use crate::technique::projection::Projection;
use crate::technique::raycast::Raycast;
use crate::technique::slices_2d::Slices2d;
use crate::technique::slices_3d::Slices3d;
use crate::technique::{
    ACCUMULATION_FORMAT as FORMAT, Inputs, Mode, Order, Settings, Technique, Words,
};
use ash::vk;
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

/// One submission: the device, where it writes, what is drawn, and its clock.
#[derive(Debug)]
pub struct Submission<'a> {
    /// Submits and waits.
    pub device: &'a mut Headless,
    /// The images.
    pub targets: &'a Targets,
    /// In the order in which they are recorded.
    pub bricks: &'a [Part<'a>],
    /// The device's clock, if it has one.
    pub timer: Option<&'a Timer>,
}

/// What one brick adds to a picture.
#[derive(Debug)]
pub struct Part<'a> {
    /// What a technique reads.
    pub inputs: Inputs<'a>,
    /// Of the parameters in the ring.
    pub offset: u32,
    /// Slices to draw.
    pub slices: u32,
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
    fn run(self, gather: &Gather, into: &Image, clear: [f32; 4]) -> Result<Option<f64>, Error> {
        let Self {
            device,
            targets,
            bricks,
            timer,
        } = self;
        let bound = bricks
            .iter()
            .map(|brick| gather.bind(&brick.inputs, into, &targets.layers));
        let bound = bound.collect::<Result<Vec<_>, Error>>()?;
        let gpu = Arc::clone(device.gpu());
        let is_drawn = matches!(gather, Gather::Slices3d(_) | Gather::Slices2d(_));
        let images = if matches!(gather, Gather::Raycast(_)) {
            &[into, &targets.layers][..]
        } else {
            &[into]
        };
        let used = if is_drawn {
            Use::ColorTarget
        } else {
            Use::ComputeWrite
        };
        // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
        device.run(|cmd| unsafe {
            let barriers = |before, after| {
                images
                    .iter()
                    .for_each(|image| image_barrier(&gpu, cmd, image, before, after));
            };
            if let Some(timer) = timer {
                timer.start(cmd);
            }
            barriers(Use::Nothing, used);
            if is_drawn {
                begin_rendering(
                    &gpu,
                    cmd,
                    &[(into.view(), Load::Clear(clear))],
                    targets.extent,
                );
            }
            for (i, (brick, bindings)) in bricks.iter().zip(&bound).enumerate() {
                if i > 0 && !is_drawn {
                    barriers(used, used);
                }
                gather.record(cmd, bindings, brick, targets.extent)?;
            }
            if is_drawn {
                end_rendering(&gpu, cmd);
            }
            barriers(used, Use::FragmentSampled);
            if let Some(timer) = timer {
                timer.stop(cmd);
            }
            Ok(())
        })?;
        timer.map_or(Ok(None), Timer::elapsed_ms)
    }
}

impl Gather {
    fn bind(&self, inputs: &Inputs, into: &Image, layers: &Image) -> Result<Bindings, Error> {
        match self {
            Self::Raycast(pass) => pass.bind(inputs, into, layers),
            Self::Projection(pass) => pass.bind(inputs, into),
            Self::Slices3d(pass) => pass.bind(inputs),
            Self::Slices2d(pass) => pass.bind(inputs),
        }
    }

    /// # Safety
    /// As `record` of each technique.
    unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        bindings: &Bindings,
        brick: &Part,
        extent: [u32; 2],
    ) -> Result<(), Error> {
        let Part { offset, slices, .. } = *brick;
        // SAFETY: the caller's promises.
        unsafe {
            match self {
                Self::Raycast(pass) => pass.record(cmd, bindings, offset, extent)?,
                Self::Projection(pass) => pass.record(cmd, bindings, offset, extent)?,
                Self::Slices3d(pass) => pass.record(cmd, bindings, offset, extent, slices),
                Self::Slices2d(pass) => pass.record(cmd, bindings, offset, extent, slices),
            }
        }
        Ok(())
    }
}
