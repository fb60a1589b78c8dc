//! What need not be looked at: which pictures have something of that kind, and how a host hands it over.
//!
//! ```text
//! settings.skippable(mix, function, ..)          what can be left out of such a picture
//!     MacroCells::new(gpu, volume, settings.halo())     once a volume
//!     EmptySpace::new(gpu, &cells, &seen)                once a transfer function
//! settings.skippable_in_all(seen)                the same of a mixture
//!     EmptySpace::of_several(gpu, &[(&cells, &seen), ..])
//! recording.skip(&skip), Inputs { skip, .. }     for each recording
//! ```

use super::{Filter, GradientStorage, Mode, Operator, Order, Recording, SampleInputs, Settings};
use crate::resident::{EmptySpace, Halo, MacroCells};
use crate::transfer::{HomogeneousRanges, TransferFunction, VisibleRanges};
use crate::volume::Grid;

/// What is known of where a recording need not look. The picture is the same to the bit.
#[derive(Clone, Copy, Debug, Default)]
pub enum Skip<'a> {
    /// Nothing.
    #[default]
    Nothing,
    /// What the transfer function does not show.
    Unseen(&'a MacroCells, &'a EmptySpace),
    /// What is no larger, or no smaller, than a value that a ray has met, and what modes of maxima pass over beside
    /// that.
    Exceeded(&'a MacroCells),
}

/// What says where rays need not look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SkipBy {
    /// Macro cells, and how far away from each the next one with matter is.
    #[default]
    Cells,
    /// The octree of the voxels that matter ([`EmptySpace::with_full_voxels`]), of composites of one volume by ray casting.
    Octree,
    /// The runs of these, for the same pictures.
    Runs,
}

/// What can be left out of a picture.
#[derive(Clone, Debug, PartialEq)]
pub enum Skippable {
    /// Every sample matters, or it is not known which do.
    Nothing,
    /// Samples outside of the seen values: [`Skip::Unseen`].
    Unseen(VisibleRanges),
    /// The same, and samples beside others that look like them, for [`Settings::adaptive_steps`]:
    /// [`EmptySpace::with_alike`], and [`Skip::Unseen`].
    UnseenOrAlike(VisibleRanges, HomogeneousRanges),
    /// The same of a mixture, of each of its volumes that has opacity: [`EmptySpace::of_several`].
    UnseenInAll(Vec<(usize, VisibleRanges)>),
    /// Samples that are no new extreme: [`Skip::Exceeded`].
    Exceeded,
}

impl Settings {
    /// How far around a macro cell the filter looks.
    pub fn halo(&self) -> Halo {
        let voxels = match self.filter {
            Filter::Nearest | Filter::Linear => 1,
            _ => 2,
        };
        let overshoot = match self.filter {
            // The absolute weights of an axis add up to 5/4 at most (half way between two voxels).
            Filter::CatmullRom => 1.25f32.powi(3) - 1.0,
            _ => 0.0,
        };
        Halo {
            voxels,
            overshoot,
            is_mixed: self.filter != Filter::Nearest,
        }
    }

    /// What can be left out of pictures of one volume under `function`, whose values are in `value_range`. What colours
    /// surfaces has no say. With [`Self::slope`] contours are left out where no value comes near them, if cells know of
    /// all voxels that gradients are made of ([`Halo::of_gradients`]); `None`: they are seen everywhere.
    pub fn skippable(
        &self,
        mix: SampleInputs,
        function: Option<&TransferFunction>,
        value_range: [f64; 2],
        slope: Option<f64>,
    ) -> Skippable {
        let seen_in = |function: &TransferFunction| match slope {
            Some(slope) => VisibleRanges::of_slope(function, slope),
            None => VisibleRanges::new(function),
        };
        let is_one = mix.is_of_one() || self.mode == Mode::Iso;
        // Sheets of values: a projection of splats goes through all.
        let is_refused = self.technique.splats() && self.mode != Mode::Composite;
        if !self.skip || !is_one || is_refused || self.field.is_some() {
            return Skippable::Nothing;
        }
        if !self.technique.casts_rays() {
            return self.skippable_by_slices(function, seen_in);
        }
        match (self.mode, function) {
            (Mode::Composite, Some(function)) if self.preintegrated => {
                unseen(VisibleRanges::between(function))
            }
            _ if self.preintegrated => Skippable::Nothing,
            (Mode::Iso, _) => {
                let levels = self.per_mode.levels.iter().map(|level| level.value as f32);
                Skippable::Unseen(VisibleRanges::of_values(
                    &levels.collect::<Vec<_>>(),
                    value_range,
                ))
            }
            // By how much of it is over what has been met.
            (mode, _) if mode.projects_one_place() && !self.per_mode.exact_maximum => {
                Skippable::Exceeded
            }
            (Mode::Composite, Some(function)) if self.has_solid_levels() => {
                let levels = self.per_mode.levels.iter().map(|level| level.value as f32);
                unseen(seen_in(function).with_values(levels))
            }
            (Mode::Composite | Mode::Mida, Some(function)) => unseen(seen_in(function)),
            _ => Skippable::Nothing,
        }
    }
}

impl Settings {
    /// The largest gradient that these pictures may have, times the smallest spacing, as a multiple of how far the
    /// values that it is made of lie apart: of central differences
    ///
    /// ```text
    /// |gradient| <= sum over axes of |row of voxel_from_world| (high - low) / 2
    /// ```
    ///
    /// `None` where gradients are made in another way, of which nothing is said.
    pub fn slope(&self, grid: &Grid) -> Option<f64> {
        let is_central = self.gradient_operator() == Operator::Central
            && self.gradient_storage != GradientStorage::Precomputed;
        let rows: f64 = grid.voxel_rows().iter().map(|row| row.length()).sum();
        is_central.then(|| 0.5 * rows * grid.smallest_spacing())
    }

    /// What rays leave out of pictures of several volumes, given what is seen of those that have opacity, by their numbers.
    pub fn skippable_in_all(&self, seen: Vec<(usize, VisibleRanges)>) -> Skippable {
        // Patches of mixed slices cost more than they have been seen to leave out.
        let is_mixed = self.technique.casts_rays() && self.mode == Mode::Composite;
        if !self.skip
            || !is_mixed
            || self.preintegrated
            || seen.is_empty()
            || self.technique.splats()
        {
            return Skippable::Nothing;
        }
        match seen.iter().any(|(_, seen)| seen.is_all()) {
            true => Skippable::Nothing,
            false => Skippable::UnseenInAll(seen),
        }
    }
}

/// Where all is seen, looking for what is not would only cost; slices from front to back go on to look for what is
/// hidden.
fn unseen(seen: VisibleRanges) -> Skippable {
    match seen.is_all() {
        true => Skippable::Nothing,
        false => Skippable::Unseen(seen),
    }
}

impl Settings {
    /// A blending unit goes on blending: only fragments that leave every colour as it is can be left out, and they are
    /// those of no opacity, 0 + (1 - 0) C and C + (1 - A) 0. Maxima have no such value: any may be the largest.
    fn skippable_by_slices(
        &self,
        function: Option<&TransferFunction>,
        seen_in: impl Fn(&TransferFunction) -> VisibleRanges,
    ) -> Skippable {
        let Some(function) = function else {
            return Skippable::Nothing;
        };
        if self.mode != Mode::Composite || self.is_half_angle() {
            return Skippable::Nothing;
        }
        let seen = match self.preintegrated {
            true => VisibleRanges::between(function),
            false => seen_in(function),
        };
        match self.order {
            Order::BackToFront => unseen(seen),
            Order::FrontToBack => Skippable::Unseen(seen),
        }
    }
}

impl<'a> Skip<'a> {
    /// The cells that it knows of.
    pub fn cells(self) -> Option<&'a MacroCells> {
        match self {
            Self::Nothing => None,
            Self::Unseen(cells, _) | Self::Exceeded(cells) => Some(cells),
        }
    }
}

impl Recording {
    /// Tells the parameters what the inputs of this recording know of where not to look. Without, nothing is left out.
    pub fn skip(&mut self, skip: Skip) {
        if let Some(cells) = skip.cells() {
            cells.tell(self.brick, &mut self.frame);
        }
    }
}
