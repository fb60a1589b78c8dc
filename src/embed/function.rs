//! A transfer function on a host's device, and what is empty under it.

use super::paths::OfPaths;
use super::pieces::run_of;
use super::{Error, Volume};
use crate::gpu::{ComputePipeline, Gpu};
use crate::resident::{EmptySpace, GpuTransfer};
use crate::technique::{self, Mode, SampleInputs, Settings, Skip, Skippable};
use crate::transfer::{GradientTransfer, TransferFunction};
use ash::vk;
use std::sync::Arc;

/// A transfer function, or none where surfaces need none.
#[derive(Debug)]
pub(super) struct Function {
    made: Option<GpuTransfer>,
    skippable: Skippable,
    empty: Option<EmptySpace>,
    pub mix: SampleInputs,
    /// Points and second gradients, which loops of the driver are counted by.
    pub turns: crate::technique::Functions,
    /// What paths want to know of it, where they are traced.
    pub paths: Option<Box<OfPaths>>,
    uploaded: Uploaded,
}

/// What was recorded of a function, and so is there for what is recorded later.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Uploaded {
    has_table: bool,
    /// Pieces of its empty space that are found, after so many updates of the volume.
    found: u64,
    found_after: u64,
}

/// Macro cells that one piece goes through: each looks at some ten others.
const PIECE_CELLS: u64 = 1 << 14;

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
        // Functions that weigh by gradients may be followed by others that do more.
        let mix = SampleInputs::of_one(function).general();
        check(mix, settings)?;
        settings.check_scattering_volume(!mix.uses_gradient(), 1)?;
        settings.check_scattering_function(function)?;
        volume.check(gpu, settings)?;
        let spacing = volume.grid().smallest_spacing();
        let made = function.map(|function| {
            let (length, space) = (function.reference_length, settings.color_space);
            let absorbing = [(function, settings.absorption(function, spacing))];
            match settings.preintegrated {
                true => GpuTransfer::preintegrated(gpu, function, length.unwrap_or(spacing), space),
                false => GpuTransfer::absorbing(gpu, &absorbing, space),
            }
        });
        let lit = function.filter(|f| f.emits() && settings.scatters());
        let lit = lit.map(TransferFunction::with_emission_seen);
        let seen = lit.as_ref().or(function);
        let mut skippable = settings.skippable(mix, seen, volume.value_range(), None);
        let mut empty = None;
        match (volume.cells(), &skippable, emptying) {
            (Some(cells), Skippable::Unseen(seen), Some(pipeline)) => {
                empty = Some(EmptySpace::by(gpu, pipeline, cells, seen)?);
            }
            (Some(_), Skippable::Exceeded, _) => {}
            _ => skippable = Skippable::Nothing,
        }
        let gradient_transfer = function.and_then(|function| function.gradient_transfer.as_ref());
        Ok(Self {
            made: made.transpose()?,
            skippable,
            empty,
            mix,
            turns: crate::technique::Functions {
                points: function.map_or(0, |f| f.color.len().max(f.opacity.len())),
                second: gradient_transfer.is_some_and(GradientTransfer::needs_second),
                labels: 0,
            },
            paths: OfPaths::new(function, settings, volume)?,
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

    /// Pieces that are left of what [`Function::record_part`] records, none of them long: the tables, which are small,
    /// come with the first.
    ///
    /// # Errors
    /// A grid larger than the device can dispatch.
    pub fn left(&self, volume: &Volume) -> Result<u64, Error> {
        let (all, _) = self.pieces()?;
        let left = all.saturating_sub(self.found(volume));
        Ok(match self.uploaded.has_table {
            true => left,
            false => left.max(1),
        })
    }

    /// Pieces of all passes, and the workgroups that they are cut of.
    fn pieces(&self) -> Result<(u64, u64), Error> {
        let Some(empty) = &self.empty else {
            return Ok((0, 0));
        };
        let runs = empty.group_runs()?;
        let cells = empty.distance_map().bytes() / 4;
        let all = runs.len() as u64 * cells.div_ceil(PIECE_CELLS);
        Ok((all, runs.last().map_or(0, |last| last.end)))
    }

    fn found(&self, volume: &Volume) -> u64 {
        match self.uploaded.found_after == volume.updates.done() {
            true => self.uploaded.found,
            false => 0,
        }
    }

    /// Records the next pieces of what fills the objects, once, and what is empty once more after an update of the
    /// volume.
    ///
    /// # Errors
    /// As [`Function::left`].
    ///
    /// # Safety
    /// `cmd` is recording, outside rendering, after the upload of the volume and its updates; parts are submitted in
    /// their order.
    pub unsafe fn record_part(
        &mut self,
        cmd: vk::CommandBuffer,
        volume: &Volume,
        count: u64,
    ) -> Result<(), Error> {
        let (all, groups) = self.pieces()?;
        let first = self.found(volume);
        let part = first..first.saturating_add(count).min(all);
        // SAFETY: the caller's promises.
        unsafe {
            if let (Some(made), false) = (&self.made, self.uploaded.has_table) {
                made.record_upload(cmd)?;
            }
            if let (Some(empty), false) = (&self.empty, part.is_empty()) {
                empty.record_part(cmd, run_of(groups, &part, all))?;
            }
        }
        self.uploaded = Uploaded {
            has_table: true,
            found: part.end,
            found_after: volume.updates.done(),
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
pub(super) fn check(mix: SampleInputs, settings: &Settings) -> Result<(), Error> {
    if !mix.uses_gradient() {
        return Ok(());
    }
    settings.check_graded()?;
    // The picture of a maximum has no gradient.
    let mode = settings.mode;
    let has_maximum = mode == Mode::Mida && settings.per_mode.mida_gamma > 0.0;
    match mode.is_projection() || has_maximum {
        true => Err(technique::Error::NoGradientTransfer { mode }.into()),
        false => Ok(()),
    }
}
