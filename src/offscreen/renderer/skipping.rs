//! Where rays need not look, made on the device and made anew only where it changes.

use super::preclassified::DEPTH;
use super::{Copied, Renderer, parts_of};
use crate::gpu::{self, Headless};
use crate::offscreen::Error;
use crate::offscreen::keyed::Keyed;
use crate::offscreen::stream::if_it_fits;
use crate::offscreen::time_slices::Work;
use crate::offscreen::upload::fill;
use crate::resident::{EmptySpace, FootprintTexels, FullVoxels, GpuVolume, Halo, MacroCells};
use crate::scene::{Beside, Scene};
use crate::technique::cost::ms_of_fetches;
use crate::technique::full_voxels::full_of_seen;
use crate::technique::{
    GpuChannel, Mode, PatchRoom, Patches, Role, SampleInputs, Skip, SkipBy, Skippable,
};
use crate::transfer::{HomogeneousRanges, TransferFunction, VisibleRanges};
use crate::volume::{Coefficients, Volume};
use std::sync::Arc;

/// What is known of the volumes that have been drawn.
#[derive(Debug, Default)]
pub struct Skipped {
    /// Of each volume of a mixture.
    cells: Keyed<Of, Option<Vec<MacroCells>>>,
    empty: Keyed<(Of, Shown), Option<EmptySpace>>,
    wanted: Option<Skippable>,
}

/// What functions show, by the numbers of their volumes, between which values that looks alike, and what says where it is.
type Shown = (
    Vec<(usize, VisibleRanges)>,
    Option<HomogeneousRanges>,
    SkipBy,
);

/// What macro cells are of: which of the volumes, in which form, for which filter.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Of {
    copied: Copied,
    shown: usize,
    /// From this volume of the picture on, before that one.
    numbers: [usize; 2],
    halo: Halo,
}

impl Skipped {
    /// What recordings are told.
    pub fn skip(&self) -> Skip<'_> {
        let cells = self.cells.get().and_then(Option::as_ref);
        let empty = self.empty.get().and_then(Option::as_ref);
        match (&self.wanted, cells, empty) {
            (Some(Skippable::Exceeded), Some(cells), _) => Skip::Exceeded(&cells[0]),
            (
                Some(
                    Skippable::Unseen(_) | Skippable::UnseenInAll(_) | Skippable::UnseenOrAlike(..),
                ),
                Some(cells),
                Some(empty),
            ) => Skip::Unseen(&cells[0], empty),
            _ => Skip::Nothing,
        }
    }
}

impl Renderer<'_> {
    /// Puts corners beside the volumes where pictures of `scene` read them.
    ///
    /// # Errors
    /// Where the device is lost.
    pub(super) fn keep_corners(&mut self, scene: &Scene, copied: Copied) -> Result<(), Error> {
        // Modes that project draw channels one by one.
        let mix = match scene.settings.mode.is_projection() {
            true => SampleInputs::Scalar,
            false => scene.mix(),
        };
        if !scene.settings.reads_footprint_texels(mix) {
            return Ok(());
        }
        let volumes = self.preclassified.read(copied, &self.volumes);
        let there = self.resident.get_mut(&copied).into_iter().flatten();
        for (made, volume) in there.zip(volumes) {
            let is_one = made.bricks().len() == 1 && made.spline().is_none();
            if made.corners().is_none()
                && is_one
                && let Some(corners) = corners_of(&mut self.device, volume)?
            {
                made.keep_corners(corners);
            }
        }
        Ok(())
    }

    /// Brings the corners of the one volume, and no texels: whether it can have any.
    ///
    /// # Errors
    /// Where the device is lost.
    pub(super) fn upload_corners(&mut self, copied: Copied) -> Result<bool, Error> {
        let &[volume] = &self.volumes[..] else {
            return Ok(false);
        };
        let Some(corners) = corners_of(&mut self.device, volume)? else {
            return Ok(false);
        };
        let made = GpuVolume::of_corners(self.device.gpu(), volume, corners);
        let Some(made) = if_it_fits(made)? else {
            return Ok(false);
        };
        fill(&mut self.device, &made, volume)?;
        self.resident.insert(copied, vec![made]);
        Ok(true)
    }

    /// Lists of the patches of slices for pictures of `scene`, if there are any, and how large they get.
    ///
    /// # Errors
    /// Where the device is lost.
    pub(super) fn patches_for(
        &mut self,
        scene: &Scene,
    ) -> Result<Option<(Arc<Patches>, PatchRoom)>, Error> {
        let room = scene.view(&scene.volume.grid(), [0.0; 2]).patch_room();
        let Some((room, _)) = room.zip(wanted(scene)) else {
            return Ok(None);
        };
        let there = self.targets.as_mut();
        let there = there.and_then(|targets| targets.canvas.patches.take());
        let made = match there {
            Some((made, _)) if made.holds(room) => Some(made),
            _ => if_it_fits(Patches::new(self.device.gpu(), room))?.map(Arc::new),
        };
        Ok(made.map(|made| (made, room)))
    }

    /// Finds out what pictures of `scene` need not look at. Nothing to do where that is known.
    ///
    /// # Errors
    /// Where the device is lost.
    pub(super) fn prepare_skip(&mut self, scene: &Scene) -> Result<(), Error> {
        self.skipped.wanted = None;
        // Bricks of a stream know their own.
        let is_streamed = self.streaming.is_some();
        let Some((wanted, halo)) = wanted(scene).filter(|_| !is_streamed) else {
            return Ok(());
        };
        // One volume says nothing of the others.
        let numbers = match &wanted {
            // Depth alone says where classified voxels are.
            Skippable::UnseenInAll(_) if scene.is_classified() => [DEPTH, DEPTH + 1],
            Skippable::UnseenInAll(_) => [0, scene.roles().len()],
            _ => [0, 1],
        };
        let of = Of {
            copied: Copied::of(scene),
            shown: self.shown,
            numbers,
            halo,
        };
        let mut cells = std::mem::take(&mut self.skipped.cells);
        let found = cells.of(of, |_| self.make_cells(scene, numbers, halo));
        let is_there = found.map(|found| found.is_some());
        self.skipped.cells = cells;
        if !is_there? {
            return Ok(());
        }
        let seen = match &wanted {
            Skippable::Unseen(seen) | Skippable::UnseenOrAlike(seen, _) => vec![(0, seen.clone())],
            Skippable::UnseenInAll(seen) => seen.clone(),
            Skippable::Nothing | Skippable::Exceeded => Vec::new(),
        };
        let alike = match &wanted {
            Skippable::UnseenOrAlike(_, alike) => Some(alike.clone()),
            _ => None,
        };
        if !seen.is_empty() {
            let mut empty = std::mem::take(&mut self.skipped.empty);
            let key = (of, (seen, alike, scene.settings.empty_space));
            let found = empty.of(key, |(of, shown)| self.make_empty_space(scene, of, shown));
            let is_there = found.map(|found| found.is_some());
            self.skipped.empty = empty;
            if !is_there? {
                return Ok(());
            }
        }
        self.skipped.wanted = Some(wanted);
        Ok(())
    }

    /// The cells of all these volumes; `None` where there is no room for them.
    fn make_cells(
        &mut self,
        scene: &Scene,
        [first, end]: [usize; 2],
        halo: Halo,
    ) -> Result<Option<Vec<MacroCells>>, Error> {
        let mut all = Vec::new();
        for number in first..end {
            let Some(made) = if_it_fits(self.cells_of(scene, number, halo))? else {
                return Ok(None);
            };
            // A cell of 8^3 voxels with a halo around them, which are not filtered.
            let fetches = 100.0 * made.cell_count() as f64;
            let expected_ms = ms_of_fetches(self.device.gpu(), fetches);
            let work = Work::beside(0..made.group_count()?, expected_ms);
            self.slices
                .run(&mut self.device, None, work, |cmd, _, part| {
                    // SAFETY: recorded outside rendering; the volume has been uploaded; `run` waits.
                    unsafe { made.record_part(cmd, part) }
                })?;
            all.push(made);
        }
        Ok(Some(all))
    }

    /// What is empty of the cells that have been made; `None` where there is no room for it.
    fn make_empty_space(
        &mut self,
        scene: &Scene,
        of: &Of,
        (seen, alike, skip_by): &Shown,
    ) -> Result<Option<EmptySpace>, Error> {
        let cells = self.skipped.cells.get().and_then(Option::as_ref);
        let cells = cells.expect("made before");
        let [first, _] = of.numbers;
        let several = seen.iter().map(|(n, seen)| (&cells[n - first], seen));
        let several: Vec<_> = several.collect();
        let gpu = self.device.gpu();
        let made = match alike {
            Some(alike) => EmptySpace::with_alike(gpu, &cells[0], &seen[0].1, alike),
            None => EmptySpace::of_several(gpu, &several),
        };
        // Most cells look at some ten others.
        let expected_ms = ms_of_fetches(gpu, cells[0].cell_count() as f64);
        let Some(made) = if_it_fits(made)? else {
            return Ok(None);
        };
        let made = match self.full_voxels(scene, &seen[0].1, *skip_by, of.halo) {
            None => made,
            Some(full) => match if_it_fits(full)? {
                Some(full) => made.with_full_voxels(full),
                None => return Ok(None),
            },
        };
        for pass in made.group_runs()? {
            let work = Work::beside(pass, expected_ms);
            self.slices
                .run(&mut self.device, None, work, |cmd, _, part| {
                    // SAFETY: as above, parts in order; the cells have been made.
                    unsafe { made.record_part(cmd, part) }
                })?;
        }
        Ok(Some(made))
    }

    /// The voxels of the one volume in which something may be seen; `None` where cells are enough.
    fn full_voxels(
        &mut self,
        scene: &Scene,
        seen: &VisibleRanges,
        skip_by: SkipBy,
        halo: Halo,
    ) -> Option<Result<FullVoxels, gpu::Error>> {
        let made = match skip_by {
            SkipBy::Cells => return None,
            SkipBy::Octree => FullVoxels::octree,
            SkipBy::Runs => FullVoxels::runs,
        };
        let halo = of_role(halo, parts_of(&self.resident, self.shown, scene)[0].role);
        // What filters mix.
        let volume = self.volumes[self.shown];
        let spline = scene.settings.filter.spline();
        let read = spline.map(|spline| Coefficients::new(volume, spline, [true; 3]));
        let read = read.as_ref().map_or(volume, Coefficients::volume);
        let full = full_of_seen(read, seen, halo);
        Some(made(&mut self.device, &full))
    }

    /// Objects for the cells of volume number `number` of the picture.
    fn cells_of(&self, scene: &Scene, number: usize, halo: Halo) -> Result<MacroCells, gpu::Error> {
        let parts = parts_of(&self.resident, self.shown, scene);
        let GpuChannel { volume, role } = parts[number];
        let gpu = self.device.gpu();
        let halo = of_role(halo, role);
        let voxels = || {
            self.preclassified
                .voxels(scene, &self.volumes, self.shown + number)
        };
        if volume.grid() != parts[0].volume.grid() {
            return MacroCells::of_channel(gpu, parts[0].volume, volume, halo, &voxels());
        }
        let is_by_host = gpu.is_cpu() || !volume.has_texels();
        match is_by_host && volume.spline().is_none() {
            true => MacroCells::of_voxels(gpu, volume, halo, &voxels()),
            false => MacroCells::new(gpu, volume, halo),
        }
    }
}

/// Nothing lies between two labels.
fn of_role(halo: Halo, role: Role) -> Halo {
    Halo {
        is_mixed: halo.is_mixed && role != Role::Labels,
        ..halo
    }
}

/// Complete ones, where the volume can have any.
fn corners_of(device: &mut Headless, volume: &Volume) -> Result<Option<FootprintTexels>, Error> {
    let gpu = &Arc::clone(device.gpu());
    if !FootprintTexels::are_for(gpu, volume) {
        return Ok(None);
    }
    let made = if_it_fits(FootprintTexels::new(gpu, volume))?.flatten();
    if let Some(corners) = &made {
        // SAFETY: they live until they are dropped with their volume, long after the wait.
        device.run(|cmd| unsafe {
            corners.record_upload(gpu, cmd);
            Ok::<(), gpu::Error>(())
        })?;
    }
    Ok(made)
}

/// What pictures of `scene` need not look at, and what cells must know for it.
pub(super) fn wanted(scene: &Scene) -> Option<(Skippable, Halo)> {
    let range = scene.volume.value_range;
    let wanted = match (scene.mix(), scene.beside) {
        (SampleInputs::Channels, _) | (_, Beside::Colors([_, _, _]))
            if scene.settings.mode != Mode::Iso =>
        {
            let functions = opacities_of(scene).unwrap_or_default();
            let seen = functions.iter().map(|&(n, f)| (n, VisibleRanges::new(f)));
            scene.settings.skippable_in_all(seen.collect())
        }
        (_, Beside::Classified(_) | Beside::Preclassified) => {
            let seen = (DEPTH, VisibleRanges::positive());
            scene.settings.skippable_in_all(vec![seen])
        }
        (mix, _) => {
            let slope = scene.settings.slope(&scene.volume.grid());
            let lit = scene
                .transfer
                .filter(|f| f.emits() && scene.settings.scatters());
            let lit = lit.map(TransferFunction::with_emission_seen);
            let function = lit.as_ref().or(scene.transfer);
            scene.settings.skippable(mix, function, range, slope)
        }
    };
    let alike = scene.alike().filter(|_| scene.settings.skip);
    let wanted = match (wanted, alike, scene.transfer) {
        (_, Some(alike), Some(function)) => {
            Skippable::UnseenOrAlike(VisibleRanges::new(function), alike)
        }
        (wanted, ..) => wanted,
    };
    let halo = scene.view(&scene.volume.grid(), [0.0; 2]).halo()?;
    let halo = match &wanted {
        Skippable::Unseen(seen) if seen.contours.iter().any(|c| c.reach > 0.0) => {
            halo.of_gradients()
        }
        _ => halo,
    };
    (wanted != Skippable::Nothing).then_some((wanted, halo))
}

/// Which volumes of a mixture say how opaque it is, and by which function; `None` where one is missing.
fn opacities_of<'a>(scene: &Scene<'a>) -> Option<Vec<(usize, &'a TransferFunction)>> {
    if let Beside::Colors(beside) = scene.beside {
        // Alpha, the last one.
        return Some(vec![(beside.len(), scene.transfer?)]);
    }
    let roles = scene.roles();
    let is_opaque_by_next = |n: usize| roles.get(n + 1) == Some(&Role::Opacity);
    let all = scene.transfers().into_iter().enumerate();
    let own = all.filter(|&(n, _)| !is_opaque_by_next(n));
    own.map(|(n, function)| Some((n, function?))).collect()
}
