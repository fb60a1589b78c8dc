//! Ways to take samples of their own, and what does not go together with them.

use super::{CutFaces, Error, Lattice, Mode, Settings};

impl Settings {
    /// Whether technique and mode have the ways to sample that are asked for.
    ///
    /// # Errors
    /// [`Error::NotFor`], [`Error::SeveralShadowLights`], and [`Error::OutOfRange`] for a window that is none.
    pub fn check_ways(&self) -> Result<(), Error> {
        let (mode, technique) = (self.mode, self.technique);
        let desc = technique.desc();
        let of_mode = |is_on: bool, wanted| match is_on && mode != Mode::Composite {
            true => Err(Error::NotFor {
                wanted,
                of: "composite",
                found: format!("mode {mode}"),
            }),
            false => Ok(()),
        };
        let of_technique = |is_on: bool, wanted, has: bool, of| match is_on && !has {
            true => Err(Error::NotFor {
                wanted,
                of,
                found: technique.to_string(),
            }),
            false => Ok(()),
        };
        let is_jittered = self.lattice == Lattice::Jitter;
        of_mode(self.preintegrated, PREINTEGRATED)?;
        of_technique(self.smooth, SMOOTH, desc.draws_stacks, "2D stacks")?;
        of_mode(self.smooth, SMOOTH)?;
        of_technique(is_jittered, JITTER, desc.casts_rays, "ray casting")?;
        let is_adaptive = self.adaptive_steps.is_some();
        of_technique(is_adaptive, ADAPTIVE, desc.casts_rays, "ray casting")?;
        of_mode(is_adaptive, ADAPTIVE)?;
        if let Some(error) = self.adaptive_steps {
            self.check_adaptive(error)?;
        }
        let is_cut = self.cut_faces.is_some();
        of_technique(is_cut, CUT_FACES, desc.casts_rays, "ray casting")?;
        of_mode(is_cut, CUT_FACES)?;
        if let Some(CutFaces::Grey([low, high])) = self.cut_faces
            && !(low < high && (high - low).is_finite())
        {
            return Err(Error::OutOfRange {
                name: "the upper end of the window of cut faces",
                wanted: "a higher number than the lower, both finite",
                found: high,
            });
        }
        if is_jittered && mode == Mode::Iso {
            return Err(Error::NotFor {
                wanted: JITTER,
                of: "modes of samples",
                found: "surfaces, whose places do not hang on where steps begin".to_owned(),
            });
        }
        let is_half = self.is_half_angle();
        let lights = self.shading.as_ref().map_or(0, |s| s.lights.len());
        if is_half && lights > 1 {
            return Err(Error::SeveralShadowLights { wanted: lights });
        }
        of_technique(is_half, HALF_ANGLE, desc.has_half_angle, "3D slices")?;
        of_mode(is_half, HALF_ANGLE)?;
        if is_half && self.filter.kernel().is_some() {
            return Err(Error::NotFor {
                wanted: HALF_ANGLE,
                of: "nearest and linear filters",
                found: format!("the filter {}", self.filter),
            });
        }
        if is_half && self.ambient_occlusion.is_some() {
            return Err(Error::NotFor {
                wanted: HALF_ANGLE,
                of: "the light of one lamp",
                found: "light from all around that is occluded".to_owned(),
            });
        }
        if self.shading.is_some() || self.ambient_occlusion.is_some() {
            self.refuse_way("samples without light", || "shaded ones".to_owned())?;
        }
        if self.filter.kernel().is_some() {
            let found = || format!("the filter {}", self.filter);
            self.refuse_way("nearest and linear filters", found)?;
        }
        Ok(())
    }

    fn check_adaptive(&self, error: f64) -> Result<(), Error> {
        if !(error > 0.0 && error <= 1.0) {
            return Err(Error::OutOfRange {
                name: "the error of adaptive steps",
                wanted: "a number over 0 and at most 1",
                found: error,
            });
        }
        let refuse = |of, found: &str| {
            Err(Error::NotFor {
                wanted: ADAPTIVE,
                of,
                found: found.to_owned(),
            })
        };
        match () {
            () if self.conformance => refuse("pictures within an error", "conformance"),
            () if self.lattice == Lattice::Planes => refuse("the lattice of rays", "planes"),
            () if self.preintegrated => refuse("samples that are points", PREINTEGRATED),
            () => Ok(()),
        }
    }

    /// Whether steps may adapt to a volume.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(crate) fn check_holes(&self, has_holes: bool) -> Result<(), Error> {
        match self.adaptive_steps.is_some() && has_holes {
            true => Err(Error::NotFor {
                wanted: ADAPTIVE,
                of: "volumes that have data everywhere",
                found: "one with voxels without".to_owned(),
            }),
            false => Ok(()),
        }
    }

    /// A way to sample of its own that is asked for.
    fn way(&self) -> Option<&'static str> {
        let ways = [
            (self.preintegrated, PREINTEGRATED),
            (self.smooth, SMOOTH),
            (self.adaptive_steps.is_some(), ADAPTIVE),
        ];
        ways.into_iter()
            .find_map(|(is_on, name)| is_on.then_some(name))
    }

    /// The same for several volumes.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(crate) fn check_mixed(&self) -> Result<(), Error> {
        self.refuse_way("one volume of numbers", || {
            "several that are mixed".to_owned()
        })
    }

    /// The same for functions of gradients.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(crate) fn check_graded(&self) -> Result<(), Error> {
        self.refuse_way("functions of the value alone", || {
            "one of the value and its gradient".to_owned()
        })
    }

    fn refuse_way(&self, of: &'static str, found: impl FnOnce() -> String) -> Result<(), Error> {
        match self.way() {
            Some(wanted) => Err(Error::NotFor {
                wanted,
                of,
                found: found(),
            }),
            None => Ok(()),
        }
    }
}

const PREINTEGRATED: &str = "pre-integrated classification";
const ADAPTIVE: &str = "sampling by adaptive steps";
const SMOOTH: &str = "interpolation between slices";
const CUT_FACES: &str = "an opaque cut face";
const JITTER: &str = "jitter";
const HALF_ANGLE: &str = "half-angle slicing";
