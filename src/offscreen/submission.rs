//! One timed submission of a picture's bricks.

use super::targets::Targets;
use crate::gpu::{Bindings, Error, Gpu, Headless, Image, Timer, Use, image_barrier};
use crate::technique::{Inputs, Order};
use ash::vk;
use std::sync::Arc;

/// The device, where it writes, what is drawn, and its clock.
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
    /// The images hold what bricks before these have left, in [`Use::FragmentSampled`].
    pub resumes: bool,
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
    /// How they are blended.
    pub order: Order,
}

impl Submission<'_> {
    /// One descriptor set for each brick.
    pub fn bind(
        &self,
        bind: impl Fn(&Inputs) -> Result<Bindings, Error>,
    ) -> Result<Vec<Bindings>, Error> {
        self.bricks
            .iter()
            .map(|brick| bind(&brick.inputs))
            .collect()
    }

    /// Records with `record` between two timestamps, submits and waits. Milliseconds on the device.
    pub fn run(
        self,
        record: impl FnOnce(vk::CommandBuffer, &Gpu) -> Result<(), Error>,
    ) -> Result<Option<f64>, Error> {
        let Self { device, timer, .. } = self;
        let gpu = Arc::clone(device.gpu());
        device.run(|cmd| {
            // SAFETY: recorded outside rendering, in this order, into one command buffer that `run` waits for.
            let start = || unsafe { timer.inspect(|timer| timer.start(cmd)) };
            // SAFETY: as above.
            let stop = || unsafe { timer.inspect(|timer| timer.stop(cmd)) };
            start();
            record(cmd, &gpu)?;
            stop();
            Ok(())
        })?;
        timer.map_or(Ok(None), Timer::elapsed_ms)
    }

    /// Runs a compute pass over each brick, one after the other, that writes `images`; leaves them in
    /// [`Use::FragmentSampled`].
    pub fn compute(
        self,
        images: &[&Image],
        bound: &[Bindings],
        record: impl Fn(vk::CommandBuffer, &Bindings, u32) -> Result<(), Error>,
    ) -> Result<Option<f64>, Error> {
        let (bricks, resumes) = (self.bricks, self.resumes);
        self.run(|cmd, gpu| {
            let barriers = |before, after| {
                for image in images {
                    // SAFETY: outside rendering; the images live until `run` has waited.
                    unsafe { image_barrier(gpu, cmd, image, before, after) };
                }
            };
            let mut before = match resumes {
                true => Use::FragmentSampled,
                false => Use::Nothing,
            };
            for (brick, bindings) in bricks.iter().zip(bound) {
                barriers(before, Use::ComputeWrite);
                record(cmd, bindings, brick.offset)?;
                before = Use::ComputeWrite;
            }
            barriers(before, Use::FragmentSampled);
            Ok(())
        })
    }
}
