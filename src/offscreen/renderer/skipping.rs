//! Where rays need not look, made on the device and made anew only where it changes.

use super::{Copied, Renderer, parts_of};
use crate::gpu;
use crate::offscreen::Error;
use crate::resident::{Apron, EmptySpace, MacroCells};
use crate::scene::Scene;
use crate::technique::{Skip, Skippable};
use crate::transfer::Seen;

/// What is known of the volumes that have been drawn.
#[derive(Debug, Default)]
pub struct Skipped {
    cells: Option<(Of, MacroCells)>,
    empty: Option<(Seen, EmptySpace)>,
    wanted: Option<Skippable>,
}

/// What macro cells are of: which of the volumes, in which form, for which filter.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Of {
    copied: Copied,
    shown: usize,
    apron: Apron,
}

impl Skipped {
    /// What recordings are told.
    pub fn skip(&self) -> Skip<'_> {
        match (&self.wanted, &self.cells, &self.empty) {
            (Some(Skippable::Exceeded), Some((_, cells)), _) => Skip::Exceeded(cells),
            (Some(Skippable::Unseen(_)), Some((_, cells)), Some((_, empty))) => {
                Skip::Unseen(cells, empty)
            }
            _ => Skip::Nothing,
        }
    }
}

impl Renderer<'_> {
    /// Finds out what pictures of `scene` need not look at. Nothing to do where that is known.
    ///
    /// # Errors
    /// Where the device is lost.
    pub(super) fn prepare_skip(&mut self, scene: &Scene) -> Result<(), Error> {
        let wanted = scene.settings.skippable(scene.mix(), scene.transfer);
        self.skipped.wanted = None;
        if wanted == Skippable::Nothing {
            return Ok(());
        }
        let of = Of {
            copied: Copied::of(scene),
            shown: self.shown,
            apron: scene.settings.apron(),
        };
        if self
            .skipped
            .cells
            .as_ref()
            .is_none_or(|(there, _)| *there != of)
        {
            self.skipped = Skipped::default();
            let parts = parts_of(&self.resident, self.shown, scene);
            let made = MacroCells::new(self.device.gpu(), parts[0].volume, of.apron);
            let Some(made) = if_it_fits(made)? else {
                return Ok(());
            };
            // SAFETY: recorded outside rendering; the volume has been uploaded; `run` waits.
            self.device.run(|cmd| unsafe { made.record(cmd) })?;
            self.skipped.cells = Some((of, made));
        }
        if let Skippable::Unseen(seen) = &wanted
            && self
                .skipped
                .empty
                .as_ref()
                .is_none_or(|(there, _)| there != seen)
        {
            let (_, cells) = self.skipped.cells.as_ref().expect("made above");
            let Some(made) = if_it_fits(EmptySpace::new(self.device.gpu(), cells, seen))? else {
                return Ok(());
            };
            // SAFETY: as above; the cells have been made.
            self.device.run(|cmd| unsafe { made.record(cmd) })?;
            self.skipped.empty = Some((seen.clone(), made));
        }
        self.skipped.wanted = Some(wanted);
        Ok(())
    }
}

/// Without memory for it the picture is the same, only slower.
fn if_it_fits<T>(made: Result<T, gpu::Error>) -> Result<Option<T>, Error> {
    match made {
        Ok(made) => Ok(Some(made)),
        Err(gpu::Error::Limit { .. } | gpu::Error::OutOfMemory { .. }) => Ok(None),
        Err(other) => Err(other.into()),
    }
}
