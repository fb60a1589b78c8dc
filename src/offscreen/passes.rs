//! The pipelines of one kind of picture.

use super::submission::Submission;
use super::targets::Targets;
use crate::gpu::{
    Blend, Error, Gpu, Image, Load, ParameterRing, Use, begin_rendering_of, end_rendering,
    image_barrier,
};
use crate::resident::GpuTransfer;
use crate::resolve::Resolve;
use crate::technique::blend::Drawn;
use crate::technique::gather::{Gather, GatherDesc, PICTURE};
use crate::technique::{ACCUMULATION_FORMAT, Mode, Order, Settings, Sight, Technique, Words};
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
    picture: Box<dyn Gather>,
    /// Counts the samples of a slicer, once that is wanted; the ray caster counts its own.
    count: OnceCell<Box<dyn Gather>>,
    settings: Settings,
    /// Of modes that leave a value; others leave the picture itself.
    resolve: Option<Resolve>,
}

impl Passes {
    /// Compiles for such pictures; `is_patched`: slicers draw patches of their slices.
    pub fn new(
        gpu: &Arc<Gpu>,
        settings: &Settings,
        words: &Words,
        is_patched: bool,
    ) -> Result<Self, Error> {
        let mode = settings.mode;
        let key = key_of(settings, words, is_patched);
        Ok(Self {
            picture: gather(gpu, settings, &key, Drawn::Picture(mode))?,
            count: OnceCell::new(),
            key,
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

    /// What makes the picture.
    pub fn picture(&self) -> &dyn Gather {
        &*self.picture
    }

    /// What counts the samples of a slicer.
    pub fn count(&self, gpu: &Arc<Gpu>) -> Result<&dyn Gather, Error> {
        if self.count.get().is_none() {
            let made = gather(gpu, &self.settings, &self.key, Drawn::Count)?;
            let _ = self.count.set(made);
        }
        Ok(&**self.count.get().expect("set above"))
    }

    /// Whether a resolve makes the colours of what was gathered.
    pub fn has_resolve(&self) -> bool {
        self.resolve.is_some()
    }

    /// The colours of what was gathered, in the use that the image is left in.
    pub fn resolve<'t>(
        &self,
        submission: Submission,
        targets: &'t Targets,
        ring: &ParameterRing,
        offset: u32,
        transfer: Option<&GpuTransfer>,
    ) -> Result<(&'t Image, Use), Error> {
        let gathered = targets.canvas.image(PICTURE);
        let (Some(resolve), Some(picture)) = (&self.resolve, &targets.resolved) else {
            return Ok((gathered, Use::FragmentSampled));
        };
        let extent = targets.extent();
        let bindings = resolve.bind(ring, gathered, transfer)?;
        let target = [(picture.view(), Load::Clear([0.0; 4]))];
        // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
        submission.in_tiles(extent, |cmd, gpu, part| unsafe {
            if part.is_first {
                image_barrier(gpu, cmd, picture, Use::Nothing, Use::ColorTarget);
            }
            for &tile in part.tiles {
                begin_rendering_of(gpu, cmd, &target, tile);
                resolve.record_tile(cmd, &bindings, offset, extent, tile);
                end_rendering(gpu, cmd);
            }
            Ok(())
        })?;
        Ok((picture, Use::ColorTarget))
    }
}

fn gather(
    gpu: &Arc<Gpu>,
    settings: &Settings,
    key: &Key,
    drawn: Drawn,
) -> Result<Box<dyn Gather>, Error> {
    let (.., [.., is_patched], words) = key;
    (settings.technique.desc().gather)(&GatherDesc {
        gpu,
        settings,
        words,
        drawn,
        sight: Sight::Open,
        is_patched: *is_patched,
    })
}
