//! What does not go together with single scattering.

use super::pathtrace::{Lamp, LampShape};
use super::{Error, Filter, Lattice, Mode, Settings, SingleScattering, SkipBy, Technique};
use crate::picture::ColorSpace;
use crate::technique::compatibility::refuse;
use crate::transfer::TransferFunction;

const SINGLE: &str = "single scattering";

impl Settings {
    /// Whether a picture of light that is scattered once has what these settings ask for; nothing without it.
    ///
    /// # Errors
    /// [`Error::NotFor`], and [`Error::OutOfRange`] for what is no medium.
    pub(in crate::technique) fn check_scattering(&self) -> Result<(), Error> {
        let Some(scattering) = self.single_scattering else {
            return Ok(());
        };
        let refuse =
            |is_there, of, found: &dyn std::fmt::Display| refuse(is_there, SINGLE, of, found);
        let (mode, technique) = (self.mode, self.technique);
        refuse(technique != Technique::Raycast, "ray casting", &technique)?;
        let of = "composite: other modes find one number a ray, in which nothing scatters";
        refuse(mode != Mode::Composite, of, &format_args!("mode {mode}"))?;
        let of = "the filters nearest and linear";
        let is_wide = !matches!(self.filter, Filter::Nearest | Filter::Linear);
        refuse(is_wide, of, &format_args!("the filter {}", self.filter))?;
        let of = "the lattices ray, planes and jitter";
        let is_other = self.lattice == Lattice::Bresenham;
        refuse(is_other, of, &format_args!("the lattice {}", self.lattice))?;
        let of = "samples that are points";
        refuse(self.preintegrated, of, &"pre-integrated classification")?;
        refuse(self.adaptive_steps.is_some(), of, &"adaptive steps")?;
        let of = "empty space by macro cells";
        refuse(self.empty_space != SkipBy::Cells, of, &"other empty space")?;
        let of = "what lies behind cuts";
        refuse(self.cut_faces.is_some(), of, &"opaque cut faces")?;
        let of = "light that scatters";
        refuse(self.shading.is_some(), of, &"shading")?;
        let of = "light that comes through matter";
        refuse(self.ambient_occlusion.is_some(), of, &"ambient occlusion")?;
        let of = "linear light";
        refuse(
            self.color_space == ColorSpace::Display,
            of,
            &"display numbers",
        )?;
        let path = &self.path;
        let of = "an even sky";
        refuse(
            path.sky_picture.is_some(),
            of,
            &"a picture of the sky, for which there is path tracing",
        )?;
        refuse(path.shows_sky, of, &"a sky that is seen")?;
        let has_sky = path.sky.iter().any(|&c| c > 0.0);
        let of = "a sky under an isotropic phase function";
        refuse(
            has_sky && !path.phase.is_even(),
            of,
            &"another phase function, for which there is path tracing",
        )?;
        let of = "lights that are followed from each sample, or that nothing hinders";
        let is_grid = scattering == SingleScattering::Volume;
        let found = "the light volume with a light that has a place";
        refuse(is_grid && !path.lamps.is_empty(), of, &found)?;
        let is_disc = |lamp: &Lamp| matches!(lamp.shape, LampShape::Disc { .. });
        let of = "points and lights of one direction";
        let found = "a disc that shines, for which there is path tracing";
        refuse(path.lamps.iter().any(is_disc), of, &found)?;
        let is_wide = path.light_size_degrees > 0.0;
        let of = "lights of one direction, or ones that are followed through a grid";
        let is_volume = scattering == SingleScattering::Volume;
        refuse(is_wide && !is_volume, of, &"lights that look wide")?;
        path.check()
    }

    /// Whether rays find light that is scattered once by matter of such a function: by one extinction for all colours.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(crate) fn check_scattering_function(
        &self,
        function: Option<&TransferFunction>,
    ) -> Result<(), Error> {
        let medium = function.and_then(|function| function.medium.as_ref());
        let is_colored = medium.is_some_and(|medium| medium.has_colored_extinction());
        let is_there = is_colored && self.single_scattering.is_some();
        let of = "an extinction that all colours share";
        let found = "one of three colours, for which there is --technique pathtrace";
        refuse(is_there, SINGLE, of, found)
    }

    /// Whether rays through such a volume scatter light once: one of numbers, under a function of the value alone, and for
    /// light that is followed from samples in one texture.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(crate) fn check_scattering_volume(&self, is_one: bool, bricks: usize) -> Result<(), Error> {
        let is_there = self.single_scattering.is_some();
        let of = "one volume of numbers";
        let found = "several, or colours, or gradients";
        refuse(is_there && !is_one, SINGLE, of, found)?;
        let is_marched = self.single_scattering == Some(SingleScattering::March);
        let of = "a volume in one texture where light is followed from each sample";
        let found = format_args!("one in {bricks} bricks");
        refuse(is_marched && bricks > 1, SINGLE, of, found)
    }
}
