//! Ways to take samples of their own, and what does not go together with them.

use super::{
    CutFaces, Error, GradientStorage, Lattice, Mode, Operator, Settings, SkipBy, Technique,
};
use crate::named::Named;
use std::fmt;

impl Settings {
    /// Whether technique and mode have the ways to sample that are asked for.
    ///
    /// # Errors
    /// [`Error::NotFor`], [`Error::SeveralShadowLights`], and [`Error::OutOfRange`] for a window that is none.
    pub fn check_ways(&self) -> Result<(), Error> {
        self.check_field()?;
        self.check_splats()?;
        self.check_paths()?;
        self.check_scattering()?;
        let (mode, technique) = (self.mode, self.technique);
        let desc = technique.desc();
        let of_mode = |is_on: bool, wanted| {
            let is_refused = is_on && mode != Mode::Composite;
            refuse(is_refused, wanted, "composite", format_args!("mode {mode}"))
        };
        let of_technique =
            |is_on: bool, wanted, has: bool, of| refuse(is_on && !has, wanted, of, technique);
        let of_rays = |is_on, wanted| of_technique(is_on, wanted, desc.casts_rays, "ray casting");
        if technique.is_warped() {
            (desc.supports)(self)?;
        }
        let is_jittered = self.lattice == Lattice::Jitter;
        of_mode(self.preintegrated, PREINTEGRATED)?;
        of_technique(self.smooth, SMOOTH, desc.draws_stacks, "2D stacks")?;
        of_mode(self.smooth, SMOOTH)?;
        of_rays(is_jittered, JITTER)?;
        of_rays(self.lattice == Lattice::Bresenham, BRESENHAM)?;
        self.check_main_axis()?;
        of_rays(self.adaptive_steps.is_some(), ADAPTIVE)?;
        of_mode(self.adaptive_steps.is_some(), ADAPTIVE)?;
        if let Some(error) = self.adaptive_steps {
            self.check_adaptive(error)?;
        }
        self.check_empty_space()?;
        of_rays(self.cut_faces.is_some(), CUT_FACES)?;
        of_mode(self.cut_faces.is_some(), CUT_FACES)?;
        if let Some(CutFaces::Grey([low, high])) = self.cut_faces {
            let name = "the upper end of the window of cut faces";
            let wanted = "a higher number than the lower, both finite";
            Error::unless(low < high && (high - low).is_finite(), name, wanted, high)?;
        }
        let surfaces = "surfaces, whose places do not depend on where steps begin";
        let is_moved = is_jittered && mode == Mode::Iso;
        refuse(is_moved, JITTER, "modes of samples", surfaces)?;
        let is_half = self.is_half_angle();
        let lights = self.shading.as_ref().map_or(0, |s| s.lights.len());
        if is_half && lights > 1 {
            return Err(Error::SeveralShadowLights { wanted: lights });
        }
        of_technique(is_half, HALF_ANGLE, desc.has_half_angle, "3D slices")?;
        of_mode(is_half, HALF_ANGLE)?;
        let (has_kernel, of_filter) =
            (self.filter.kernel().is_some(), "nearest and linear filters");
        let filter = format_args!("the filter {}", self.filter);
        refuse(is_half && has_kernel, HALF_ANGLE, of_filter, filter)?;
        let (is_occluded, around) = (
            self.ambient_occlusion.is_some(),
            "light from all around that is occluded",
        );
        refuse(
            is_half && is_occluded,
            HALF_ANGLE,
            "the light of one lamp",
            around,
        )?;
        self.check_lit_ways()?;
        match has_kernel {
            true => self.refuse_way(of_filter, filter),
            false => Ok(()),
        }
    }

    /// Ways of their own to take samples that light does not fall on.
    fn check_lit_ways(&self) -> Result<(), Error> {
        if self.shading.is_none() && self.ambient_occlusion.is_none() {
            return Ok(());
        }
        let refuse = |is_there, wanted| refuse(is_there, wanted, UNLIT, SHADED);
        refuse(self.adaptive_steps.is_some(), ADAPTIVE)?;
        if self.is_half_angle() {
            return self.refuse_way(UNLIT, SHADED);
        }
        let is_between = self.technique.draws_stacks() && (self.smooth || self.preintegrated);
        let is_central = self.gradient_operator() == Operator::Central
            && self.gradient_storage == GradientStorage::OnTheFly;
        refuse_filter(self.shading.is_some() && is_between && !is_central)
    }

    fn check_adaptive(&self, error: f64) -> Result<(), Error> {
        let wanted = "a number over 0 and at most 1";
        Error::unless(
            error > 0.0 && error <= 1.0,
            "the error of adaptive steps",
            wanted,
            error,
        )?;
        let refuse = |is_there, of, found| refuse(is_there, ADAPTIVE, of, found);
        refuse(self.conformance, "pictures within an error", "conformance")?;
        let is_fixed = matches!(self.lattice, Lattice::Planes | Lattice::Bresenham);
        refuse(is_fixed, "the lattice of rays", self.lattice.name())?;
        refuse(self.preintegrated, "samples that are points", PREINTEGRATED)
    }

    /// What rays that go by single voxels do not go with.
    fn check_empty_space(&self) -> Result<(), Error> {
        let (mode, technique) = (self.mode, self.technique);
        let refuse = |is_there, of, found: &dyn fmt::Display| {
            refuse(is_there && self.goes_by_voxels(), VOXELS, of, found)
        };
        let is_other = technique != Technique::Raycast;
        refuse(is_other, "ray casting", &technique)?;
        let is_other = mode != Mode::Composite;
        refuse(is_other, "composite", &format_args!("mode {mode}"))?;
        let of = "samples that are points";
        refuse(self.preintegrated, of, &PREINTEGRATED)?;
        refuse(self.adaptive_steps.is_some(), of, &ADAPTIVE)
    }

    fn goes_by_voxels(&self) -> bool {
        self.empty_space != SkipBy::Cells
    }

    /// Whether a picture has volumes that lie in so many bricks of the device.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub fn check_bricks(&self, bricks: usize) -> Result<(), Error> {
        let of = "a volume that lies in one texture of the device";
        let found = format_args!("one in {bricks} bricks");
        let is_cut = bricks > 1;
        refuse(is_cut && self.technique.splats(), "splatting", of, found)?;
        refuse(is_cut && self.goes_by_voxels(), VOXELS, of, found)
    }

    /// What samples at heights of the main axis do not go with.
    fn check_main_axis(&self) -> Result<(), Error> {
        if self.lattice != Lattice::Bresenham {
            return Ok(());
        }
        let mode = self.mode;
        let found = format_args!("mode {mode}");
        refuse(mode.needs_rays(), BRESENHAM, MODES_OF_LATTICES, found)?;
        let others = "the lattices ray, planes and jitter";
        refuse(self.preintegrated, PREINTEGRATED, others, BRESENHAM)?;
        refuse(self.cut_faces.is_some(), CUT_FACES, others, BRESENHAM)
    }

    /// Whether steps may adapt to a volume.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(crate) fn check_holes(&self, has_holes: bool) -> Result<(), Error> {
        let is_refused = self.adaptive_steps.is_some() && has_holes;
        let of = "volumes that have data everywhere";
        refuse(is_refused, ADAPTIVE, of, "one with voxels without")
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
        let (of, found) = ("one volume of numbers", "several that are mixed");
        refuse(self.goes_by_voxels(), VOXELS, of, found)?;
        self.refuse_way(of, found)
    }

    /// The same for functions of gradients.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(crate) fn check_graded(&self) -> Result<(), Error> {
        self.check_field_function()?;
        self.check_splatted_function()?;
        self.refuse_way(
            "functions of the value alone",
            "one of the value and its gradient",
        )
    }

    fn refuse_way(&self, of: &'static str, found: impl fmt::Display) -> Result<(), Error> {
        let way = self.way();
        refuse(way.is_some(), way.unwrap_or_default(), of, found)
    }
}

pub(super) fn refuse(
    is_refused: bool,
    wanted: &'static str,
    of: &'static str,
    found: impl fmt::Display,
) -> Result<(), Error> {
    match is_refused {
        true => Err(Error::NotFor {
            wanted,
            of,
            found: found.to_string(),
        }),
        false => Ok(()),
    }
}

fn refuse_filter(is_refused: bool) -> Result<(), Error> {
    let of = "values on slices";
    refuse(is_refused, "a gradient filter", of, "values between them")
}

const UNLIT: &str = "samples without light";
const SHADED: &str = "shaded ones";
const PREINTEGRATED: &str = "pre-integrated classification";
const VOXELS: &str = "empty space by an octree or by runs";
const ADAPTIVE: &str = "sampling by adaptive steps";
const SMOOTH: &str = "interpolation between slices";
const CUT_FACES: &str = "an opaque cut face";
const JITTER: &str = "jitter";
const BRESENHAM: &str = "the lattice bresenham";
const MODES_OF_LATTICES: &str = "composite, mip, minip, average and xray";
const HALF_ANGLE: &str = "half-angle slicing";
