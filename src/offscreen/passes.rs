//! The pipelines of one kind of picture.

use super::slicing::Slicing;
use super::submission::Submission;
use super::targets::Targets;
use super::time_slices::Spent;
use crate::gpu::{
    Blend, Error, Gpu, Load, ParameterRing, Use, begin_rendering_of, end_rendering, image_barrier,
};
use crate::resident::GpuTransfer;
use crate::resolve::Resolve;
use crate::technique::blend::Drawn;
use crate::technique::slices_3d::HalfAngleSlicer;
use crate::technique::slices_3d::half_angle::{HalfAngleSlices, Steps};
use crate::technique::{
    ACCUMULATION_FORMAT, Inputs, Mode, Order, RayPass, Settings, Technique, Words,
};
use std::cell::OnceCell;
use std::sync::Arc;

/// What pipelines depend on.
pub type Key = (Technique, Mode, Order, [bool; 4], Words);

/// The key of such pictures.
pub fn key_of(settings: &Settings, words: &Words, is_patched: bool) -> Key {
    let Settings {
        technique,
        mode,
        order,
        ..
    } = *settings;
    let per_mode = &settings.per_mode;
    let is_cued = per_mode.depth_cue != 0.0;
    let is_half = settings.is_half_angle();
    let marks = [is_cued, per_mode.exact_maximum, is_half, is_patched];
    (technique, mode, order, marks, *words)
}

/// The pipelines of one kind of picture.
#[derive(Debug)]
pub struct Passes {
    key: Key,
    gather: Gather,
    /// Counts the samples of a slicer, once that is wanted; the ray caster counts its own.
    count: OnceCell<Slicing>,
    settings: Settings,
    /// Of modes that leave a value; others leave the picture itself.
    resolve: Option<Resolve>,
}

/// Where samples are taken.
#[derive(Debug)]
enum Gather {
    Rays(RayPass),
    Slices(Slicing),
    HalfAngle(HalfAngleSlicer),
}

impl Passes {
    /// Compiles for such pictures; `is_patched`: slicers draw patches of their slices.
    pub fn new(
        gpu: &Arc<Gpu>,
        settings: &Settings,
        words: &Words,
        is_patched: bool,
    ) -> Result<Self, Error> {
        let Settings {
            technique, mode, ..
        } = *settings;
        let gather = match technique.casts_rays() {
            true => Gather::Rays(RayPass::new(gpu, settings, words)?),
            false if settings.is_half_angle() => {
                Gather::HalfAngle(HalfAngleSlicer::new(gpu, words)?)
            }
            false => {
                let drawn = Drawn::Picture(mode);
                Gather::Slices(Slicing::new(gpu, settings, drawn, words, is_patched)?)
            }
        };
        Ok(Self {
            key: key_of(settings, words, is_patched),
            gather,
            count: OnceCell::new(),
            settings: settings.clone(),
            resolve: match mode.is_projection() {
                false => None,
                true if settings.per_mode.depth_cue == 0.0 => Some(Resolve::new(
                    gpu,
                    mode,
                    Blend::Replace,
                    ACCUMULATION_FORMAT,
                )?),
                true => Some(Resolve::cued(gpu, Blend::Replace, ACCUMULATION_FORMAT)?),
            },
        })
    }

    /// What these pipelines were made for.
    pub fn key(&self) -> &Key {
        &self.key
    }

    /// Runs the technique into `accumulation` (and `layers`) and leaves them in [`Use::FragmentSampled`].
    /// Milliseconds on the device.
    pub fn gather(&self, submission: Submission) -> Result<Spent, Error> {
        let Targets {
            accumulation,
            layers,
            tiles,
            extent,
            ..
        } = submission.targets;
        match &self.gather {
            Gather::Rays(pass) => {
                let bind = |inputs: &Inputs| pass.bind(inputs, accumulation, layers, tiles, None);
                let bound = submission.bind(bind)?;
                let images = &[accumulation, layers][..pass.image_count()];
                submission.compute(images, &bound, |cmd, bindings, offset, tiles| {
                    let tiles = tiles.iter().copied();
                    // SAFETY: outside rendering, images as `compute` brings them; all lives until it has run.
                    unsafe { pass.record_tiles(cmd, bindings, offset, *extent, tiles) }
                })
            }
            Gather::Slices(slicing) => slicing.run(submission, accumulation),
            Gather::HalfAngle(slicer) => run_half_angle(slicer, submission),
        }
    }

    /// Counts a slicer's samples into `layers`; the ray caster has counted them already.
    pub fn count(&self, mut submission: Submission) -> Result<Spent, Error> {
        match self.gather {
            Gather::Rays(_) => return Ok(Spent::NOTHING),
            // The light's samples are no pixel's.
            Gather::HalfAngle(_) => submission.bricks = &submission.bricks[..1],
            Gather::Slices(_) => {}
        }
        let gpu = submission.device.gpu();
        let is_patched = self.key.3[3];
        let made = || Slicing::new(gpu, &self.settings, Drawn::Count, &self.key.4, is_patched);
        let count = match self.count.get() {
            Some(count) => count,
            None => {
                let made = made()?;
                self.count.get_or_init(|| made)
            }
        };
        let into = &submission.targets.layers;
        count.run(submission, into)
    }

    /// The colour of the values that `gather` left to `picture`, which it leaves in [`Use::ColorTarget`]; false where it
    /// left the picture itself.
    pub fn resolve(
        &self,
        submission: Submission,
        ring: &ParameterRing,
        offset: u32,
        transfer: Option<&GpuTransfer>,
    ) -> Result<bool, Error> {
        let Some(resolve) = &self.resolve else {
            return Ok(false);
        };
        let targets = submission.targets;
        let bindings = resolve.bind(ring, &targets.accumulation, transfer)?;
        let picture = &targets.picture;
        let target = [(picture.view(), Load::Clear([0.0; 4]))];
        // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
        submission.in_tiles(|cmd, gpu, drawn| unsafe {
            if drawn.is_first {
                image_barrier(gpu, cmd, picture, Use::Nothing, Use::ColorTarget);
            }
            for &tile in &drawn.tiles {
                begin_rendering_of(gpu, cmd, &target, tile);
                resolve.record_tile(cmd, &bindings, offset, targets.extent, tile);
                end_rendering(gpu, cmd);
            }
            Ok(())
        })?;
        Ok(true)
    }
}

/// Eye and light in turn; leaves the picture in [`Use::FragmentSampled`].
fn run_half_angle(slicer: &HalfAngleSlicer, submission: Submission) -> Result<Spent, Error> {
    let [eye, light] = submission.bricks else {
        unreachable!("the eye's recording and the light's");
    };
    let (targets, light_buffer) = (submission.targets, submission.targets.light_buffer());
    let picture = &targets.accumulation;
    let bound = slicer.bind(&eye.inputs, light_buffer)?;
    let slices = HalfAngleSlices {
        offsets: [eye.offset, light.offset],
        count: eye.slices,
        order: eye.order,
    };
    // A slice is drawn twice.
    let bands = submission.pieces(0.5 / f64::from(slices.count.max(1)));
    let [light_width, light_height, _] = light_buffer.extent();
    let extents = [targets.extent, [light_width, light_height]];
    let steps = Steps::new(slices, extents, bands);
    let units = steps.count();
    // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
    submission.run(units, |cmd, gpu, part| unsafe {
        if part.start == 0 {
            for image in [picture, light_buffer] {
                image_barrier(gpu, cmd, image, Use::Nothing, Use::ColorTarget);
            }
        }
        let is_last = part.end == units;
        steps.record(slicer, cmd, &bound, picture, light_buffer, part);
        if is_last {
            image_barrier(gpu, cmd, picture, Use::ColorTarget, Use::FragmentSampled);
        }
        Ok(())
    })
}
