//! A transfer function on a host's device, and what is empty under it.

use super::{Error, Volume};
use crate::gpu::{ComputePipeline, Gpu};
use crate::resident::{EmptySpace, GpuTransfer};
use crate::technique::{self, Mix, Mode, Settings, Skip, Skippable};
use crate::transfer::{Graded, TransferFunction};
use ash::vk;
use std::sync::Arc;

/// A transfer function, or none where surfaces need none.
#[derive(Debug)]
pub(super) struct Function {
    made: Option<GpuTransfer>,
    skippable: Skippable,
    empty: Option<EmptySpace>,
    pub mix: Mix,
    /// Points and second gradients, which loops of the driver are counted by.
    pub turns: crate::technique::Functions,
    uploaded: Uploaded,
}

/// What was recorded of a function, and so is there for what is recorded later.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Uploaded {
    is_done: bool,
    /// After how many updates of the volume its empty space was found.
    found_after: u64,
}

impl Function {
    /// Objects for `function`. `emptying` finds empty space; without it nothing is left out that is not seen.
    pub fn new(
        gpu: &Arc<Gpu>,
        volume: &Volume,
        settings: &Settings,
        function: Option<&TransferFunction>,
        emptying: Option<&Arc<ComputePipeline>>,
    ) -> Result<Self, Error> {
        let needs_one = settings.mode != Mode::Iso;
        if needs_one && function.is_none() {
            return Err(technique::Error::NoTransferFunction.into());
        }
        let mix = match function.is_some_and(TransferFunction::is_graded) {
            true => Mix::Graded,
            false => Mix::Alone,
        };
        check(mix, settings)?;
        volume.check(gpu, settings)?;
        let spacing = volume.grid().smallest_spacing();
        let made = function.map(|function| {
            let length = function.reference_length.unwrap_or(spacing);
            match settings.preintegrated {
                true => GpuTransfer::preintegrated(gpu, function, length, settings.color_space),
                false => GpuTransfer::new(gpu, function, length, settings.color_space),
            }
        });
        let mut skippable = settings.skippable(mix, function, volume.value_range());
        let mut empty = None;
        match (volume.cells(), &skippable, emptying) {
            (Some(cells), Skippable::Unseen(seen), Some(pipeline)) => {
                empty = Some(EmptySpace::by(gpu, pipeline, cells, seen)?);
            }
            (Some(_), Skippable::Exceeded, _) => {}
            _ => skippable = Skippable::Nothing,
        }
        let graded = function.and_then(|function| function.graded.as_ref());
        Ok(Self {
            made: made.transpose()?,
            skippable,
            empty,
            mix,
            turns: crate::technique::Functions {
                points: function.map_or(0, |f| f.color.len().max(f.opacity.len())),
                second: graded.is_some_and(Graded::needs_second),
            },
            uploaded: Uploaded::default(),
        })
    }

    /// What is there, for [`Function::forget_later`].
    pub fn uploaded(&self) -> Uploaded {
        self.uploaded
    }

    /// What was recorded since then was not submitted: it is recorded again.
    pub fn forget_later(&mut self, then: Uploaded) {
        self.uploaded = then;
    }

    /// Records what fills the objects, once, and what is empty once more after an update of the volume.
    ///
    /// # Safety
    /// `cmd` is recording, outside rendering, after the upload of the volume and its updates.
    pub unsafe fn record_upload(
        &mut self,
        cmd: vk::CommandBuffer,
        volume: &Volume,
    ) -> Result<(), Error> {
        let updates = volume.updates();
        // SAFETY: the caller's promises.
        unsafe {
            if let (Some(made), false) = (&self.made, self.uploaded.is_done) {
                made.record_upload(cmd)?;
            }
            let is_old = !self.uploaded.is_done || self.uploaded.found_after != updates;
            if let Some(empty) = self.empty.as_ref().filter(|_| is_old) {
                empty.record(cmd)?;
            }
        }
        self.uploaded = Uploaded {
            is_done: true,
            found_after: updates,
        };
        Ok(())
    }

    /// What techniques read.
    pub fn transfer(&self) -> Option<&GpuTransfer> {
        self.made.as_ref()
    }

    /// Where they need not look.
    pub fn skip<'a>(&'a self, volume: &'a Volume) -> Skip<'a> {
        match (&self.skippable, volume.cells(), &self.empty) {
            (Skippable::Exceeded, Some(cells), _) => Skip::Exceeded(cells),
            (Skippable::Unseen(_), Some(cells), Some(empty)) => Skip::Unseen(cells, empty),
            _ => Skip::Nothing,
        }
    }
}

/// Whether such settings draw such functions.
pub(super) fn check(mix: Mix, settings: &Settings) -> Result<(), Error> {
    if mix != Mix::Graded {
        return Ok(());
    }
    settings.check_graded()?;
    // The picture of a maximum has no gradient.
    let mode = settings.mode;
    let has_maximum = mode == Mode::Mida && settings.per_mode.mida_gamma > 0.0;
    match mode.is_projection() || has_maximum {
        true => Err(technique::Error::NotGraded { mode }.into()),
        false => Ok(()),
    }
}
