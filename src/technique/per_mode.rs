//! What single modes want to know beside the words that all of them share.

use super::{Error, Filter, Lattice, Mode, Settings};
use crate::real::Real;
use crate::shaders::{Frame, MAX_LEVELS};

/// Parameters of single modes; the others do not look at them.
#[derive(Clone, Debug, PartialEq)]
pub struct PerMode {
    /// The values that count as 0 and as 1 where a mode wants values without a unit ([`Mode::Mida`],
    /// [`Mode::AttenuatedMip`]): a window, or the range of the volume. The first is the lower one.
    pub unit_values: [f64; 2],
    /// [`Mode::Lmip`]: the first local maximum over this is shown. Infinity makes it a MIP.
    pub lmip_threshold: f64,
    /// [`Mode::Mida`]: from -1, compositing, to 0, where a new maximum clears what lies before it, and on to 1, the
    /// picture of the maximum alone.
    pub mida_gamma: f64,
    /// [`Mode::AttenuatedMip`]: a value has faded to 1/e behind matter of value 1 whose length is the diagonal of
    /// the grid box over this; not negative. 0 makes it a MIP of the values between those of `unit_values`.
    pub attenuation: f64,
    /// Modes that show one place of a ray: how much darker a picture is at its far end, 0 to 1.
    pub depth_cue: f64,
    /// [`Mode::Mip`] and [`Mode::Minip`]: the extreme of the trilinear field itself, not of samples of it.
    pub exact_maximum: bool,
    /// [`Mode::Iso`]: 1 to [`MAX_LEVELS`] surfaces, in any order. In composites of paths
    /// ([`Technique::Pathtrace`](super::Technique::Pathtrace)) up to so many solid ones, that light meets.
    pub levels: Vec<Level>,
}

/// A surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// The value that the volume has there.
    pub value: f64,
    /// Its colour before light, in sRGB numbers.
    pub srgb: [f64; 3],
    /// What it takes of the light from behind, 0 to 1.
    pub opacity: f64,
}

/// Fades a value to a fifth behind a tenth of the diagonal full of matter.
pub const DEFAULT_ATTENUATION: f64 = 16.0;

impl Default for PerMode {
    fn default() -> Self {
        Self {
            unit_values: [0.0, 1.0],
            lmip_threshold: f64::INFINITY,
            mida_gamma: 0.0,
            attenuation: DEFAULT_ATTENUATION,
            depth_cue: 0.0,
            exact_maximum: false,
            levels: Vec::new(),
        }
    }
}

impl PerMode {
    /// Whether these numbers mean something for `mode`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by the name of the number, [`Error::LevelCount`].
    pub fn check(&self, mode: Mode) -> Result<(), Error> {
        let [low, high] = self.unit_values;
        let (gamma, attenuation, cue) = (self.mida_gamma, self.attenuation, self.depth_cue);
        let has_width = low < high && (high - low).is_finite();
        let is_share = (0.0..=1.0).contains(&cue);
        Error::unless(is_share, "the depth cue", "0 to 1", cue)?;
        if matches!(mode, Mode::Mida | Mode::AttenuatedMip) {
            let wanted = "a higher number than the first, both finite";
            Error::unless(has_width, "the second of the unit values", wanted, high)?;
        }
        match mode {
            Mode::Lmip => {
                let found = self.lmip_threshold;
                Error::unless(!found.is_nan(), "the threshold of LMIP", "a number", found)
            }
            Mode::Mida => {
                let is_right = (-1.0..=1.0).contains(&gamma);
                Error::unless(is_right, "the gamma of MIDA", "-1 to 1", gamma)
            }
            Mode::AttenuatedMip => {
                let is_right = attenuation >= 0.0 && attenuation.is_finite();
                Error::unless(is_right, "the attenuation", "0 or more", attenuation)
            }
            Mode::Iso => self.check_levels(),
            _ => Ok(()),
        }
    }

    fn check_levels(&self) -> Result<(), Error> {
        let (found, limit) = (self.levels.len(), MAX_LEVELS as usize);
        if !(1..=limit).contains(&found) {
            return Err(Error::LevelCount { found, limit });
        }
        self.levels.iter().try_for_each(|level| {
            let Level { value, opacity, .. } = *level;
            let (is_value, is_share) = (value.is_finite(), (0.0..=1.0).contains(&opacity));
            Error::unless(is_value, "the value of a surface", "a number", value)?;
            Error::unless(is_share, "the opacity of a surface", "0 to 1", opacity)
        })
    }
}

impl Settings {
    /// Whether technique, mode and the numbers of the mode go together.
    ///
    /// # Errors
    /// [`Error::NeedsRays`], [`Error::NeedsRayLattice`], [`Error::NoDepth`], [`Error::NotExact`],
    /// [`Error::NoDerivative`], [`Error::LevelCount`], [`Error::NotFor`] and [`Error::OutOfRange`].
    pub fn check(&self) -> Result<(), Error> {
        self.check_ways()?;
        self.check_gradient_filter()?;
        self.check_light()?;
        self.check_mode()?;
        self.check_tone()?;
        let is_share = (0.0..=1.0).contains(&self.dim);
        Error::unless(
            is_share,
            "what is left of dimmed labels",
            "0 to 1",
            self.dim,
        )?;
        if self.has_solid_levels() {
            self.per_mode.check_levels()?;
        }
        self.per_mode.check(self.mode)
    }

    /// Whether the technique and its lattice have the mode, its depth cue and its exact extremes.
    ///
    /// # Errors
    /// [`Error::NeedsRays`], [`Error::NeedsRayLattice`], [`Error::NoDepth`] and [`Error::NotExact`].
    pub(crate) fn check_mode(&self) -> Result<(), Error> {
        let (technique, mode) = (self.technique, self.mode);
        (technique.desc().supports)(self)?;
        if self.lattice == Lattice::Planes && mode.needs_rays() {
            return Err(Error::NeedsRayLattice { mode });
        }
        let has_depth = technique.has_depth() && mode.projects_one_place();
        if self.per_mode.depth_cue != 0.0 && !has_depth {
            return Err(Error::NoDepth { technique, mode });
        }
        let is_trilinear = self.filter == Filter::Linear;
        let has_extreme = matches!(mode, Mode::Mip | Mode::Minip);
        let is_along_rays = technique.has_depth() && self.lattice == Lattice::Ray;
        if self.per_mode.exact_maximum && !(is_trilinear && has_extreme && is_along_rays) {
            return Err(Error::NotExact { technique, mode });
        }
        Ok(())
    }
}

/// A value from 0 to 1: CPU reference of `shaders/lib/unit.wgsl`.
pub fn unit_from_value<R: Real>(frame: &Frame, value: R) -> R {
    let unit = (value - R::from_f32(frame.value_low)) * R::from_f32(frame.value_scale);
    unit.max(R::from_f64(0.0)).min(R::from_f64(1.0))
}

/// The value of such a number: CPU reference of `shaders/lib/unit.wgsl`.
pub fn value_from_unit<R: Real>(frame: &Frame, unit: R) -> R {
    R::from_f32(frame.value_low) + unit / R::from_f32(frame.value_scale)
}
