//! What does not go together with paths.

use super::{Lens, PATHS_OF_PASS, PathTracing};
use crate::camera::{Camera, Projection};
use crate::picture::ColorSpace;
use crate::technique::compatibility::refuse;
use crate::technique::{Error, Filter, GradientStorage, Lattice, Mode, Operator, Settings};
use crate::transfer::TransferFunction;

const PATHS: &str = "path tracing";

impl Settings {
    /// Whether a picture of paths has what these settings ask for; nothing for other techniques.
    ///
    /// # Errors
    /// [`Error::NotFor`], and [`Error::OutOfRange`] for what makes no paths.
    pub(in crate::technique) fn check_paths(&self) -> Result<(), Error> {
        if !self.technique.traces_paths() {
            return Ok(());
        }
        let mode = self.mode;
        let of = "composite";
        refuse(
            mode != Mode::Composite,
            PATHS,
            of,
            format_args!("mode {mode}"),
        )?;
        let of = "the filters nearest and linear";
        let is_wide = !matches!(self.filter, Filter::Nearest | Filter::Linear);
        refuse(
            is_wide,
            PATHS,
            of,
            format_args!("the filter {}", self.filter),
        )?;
        let of = "collisions at random places, and no lattice";
        let lattice = format_args!("the lattice {}", self.lattice);
        refuse(self.lattice != Lattice::Ray, PATHS, of, lattice)?;
        refuse(
            self.preintegrated,
            PATHS,
            of,
            "pre-integrated classification",
        )?;
        refuse(self.adaptive_steps.is_some(), PATHS, of, "adaptive steps")?;
        let of = "rays at random places of the pixel";
        let found = "several rays a pixel: take more paths";
        refuse(self.rays_per_side > 1, PATHS, of, found)?;
        let of = "what lies behind cuts";
        refuse(self.cut_faces.is_some(), PATHS, of, "opaque cut faces")?;
        let of = "light that scatters";
        refuse(self.shading.is_some(), PATHS, of, "shading")?;
        let found = "ambient occlusion, which is there already";
        refuse(self.ambient_occlusion.is_some(), PATHS, of, found)?;
        let is_other = self.gradient_operator() != Operator::Central
            || self.gradient_storage == GradientStorage::Precomputed;
        let of = "central differences";
        refuse(is_other, PATHS, of, "another gradient filter")?;
        let of = "linear light";
        let is_display = self.color_space == ColorSpace::Display;
        refuse(is_display, PATHS, of, "display numbers")?;
        for lamp in &self.path.lamps {
            let radius = lamp.shape.radius().unwrap_or(1.0);
            let name = "the radius of a light in path tracing";
            let wanted = "a length over 0: of a point's light the noise never ends";
            Error::unless(radius > 0.0, name, wanted, radius)?;
        }
        self.path.check()
    }

    /// Whether paths meet surfaces of values ([`PerMode::levels`](crate::technique::PerMode)).
    pub(in crate::technique) fn has_solid_levels(&self) -> bool {
        self.technique.traces_paths()
            && self.mode == Mode::Composite
            && !self.per_mode.levels.is_empty()
    }

    /// Whether a camera has what a lens needs.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(in crate::technique) fn check_lens(&self, camera: &Camera) -> Result<(), Error> {
        let has_lens = self.technique.traces_paths() && self.path.lens.is_some();
        let is_parallel = matches!(camera.projection, Projection::Orthographic { .. });
        let of = "a perspective camera";
        refuse(has_lens && is_parallel, "a lens", of, "an orthographic one")
    }

    /// Whether paths go through such volumes: of numbers and labels, on one grid, in one texture each.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(crate) fn check_path_volume(&self, are_numbers: bool, bricks: usize) -> Result<(), Error> {
        let is_traced = self.technique.traces_paths();
        let of = "volumes of numbers and labels on one grid";
        refuse(
            is_traced && !are_numbers,
            PATHS,
            of,
            "other grids, or colours, or points",
        )?;
        let of =
            "a volume that lies in one texture of the device: light goes through all of it at once";
        refuse(
            is_traced && bricks > 1,
            PATHS,
            of,
            format_args!("one in {bricks} bricks"),
        )
    }

    /// Whether paths go through matter of these functions, each that of a volume: extinctions of their own have those of one volume,
    /// and whatever the gradient is; and solid surfaces are those of one volume.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(crate) fn check_path_functions(
        &self,
        functions: &[Option<&TransferFunction>],
    ) -> Result<(), Error> {
        let is_traced = self.technique.traces_paths();
        let are_several = functions.len() > 1;
        let is_medium =
            |f: &&TransferFunction| f.medium.is_some() && (are_several || f.uses_gradient());
        let has_medium = functions.iter().flatten().any(is_medium);
        let found = "several, or where opacity depends on the gradient";
        let what = "a function with extinction, albedo, emission or phase";
        refuse(is_traced && has_medium, what, ONE, found)?;
        let has_levels = self.has_solid_levels() && are_several;
        refuse(
            has_levels,
            "a path-traced surface of values",
            ONE,
            "several",
        )
    }
}

const ONE: &str = "one volume under a function of the value";

impl PathTracing {
    pub(in crate::technique) fn check(&self) -> Result<(), Error> {
        let count = f64::from(self.samples);
        let wanted = "1 or more";
        Error::unless(self.samples > 0, "paths a pixel", wanted, count)?;
        let of_frame = self.samples_per_frame;
        let is_right = (1..=PATHS_OF_PASS).contains(&of_frame);
        Error::unless(
            is_right,
            "paths a pixel and frame",
            "1 to 8",
            of_frame.into(),
        )?;
        let wanted = "4 or more, which tell what is noise";
        let is_right = !self.denoise || self.samples >= 4;
        Error::unless(is_right, "paths a pixel", wanted, count)?;
        for (name, limit) in [("the noise", self.noise), ("seconds", self.seconds)] {
            let limit = limit.unwrap_or(1.0);
            let is_right = limit > 0.0 && limit <= 1e9;
            Error::unless(is_right, name, "a number over 0, at most 1e9", limit)?;
        }
        let density = self.density;
        let is_right = density > 0.0 && density.is_finite();
        Error::unless(is_right, "the density scale", "a number over 0", density)?;
        let name = "the scale of albedos";
        let wanted = "0 to 1: light would grow";
        let is_part = |x: f64| (0.0..=1.0).contains(&x);
        Error::unless(is_part(self.albedo), name, wanted, self.albedo)?;
        let (part, cosines) = self.phase.parts();
        let name = "the part of the first lobe";
        Error::unless(is_part(part), name, "0 to 1", part)?;
        for g in cosines {
            let name = "the mean cosine of a phase function";
            Error::unless(g.abs() <= 0.99, name, "-0.99 to 0.99", g)?;
        }
        for lamp in &self.lamps {
            let radius = lamp.shape.radius().unwrap_or(0.0);
            let is_right = radius >= 0.0 && radius.is_finite();
            let name = "the radius of a light";
            Error::unless(is_right, name, "a length of 0 or more", radius)?;
            let far = lamp.place.length_squared();
            let name = "the place of a light";
            Error::unless(far.is_finite(), name, "three lengths", far.sqrt())?;
        }
        let size = self.light_size_degrees;
        let is_right = (0.0..=90.0).contains(&size);
        Error::unless(is_right, "the size of lights", "0 to 90 degrees", size)?;
        let turn = self.sky_turn_degrees;
        let is_right = turn.abs() <= 3600.0;
        Error::unless(
            is_right,
            "the turn of the sky",
            "-3600 to 3600 degrees",
            turn,
        )?;
        for c in self.sky {
            let is_right = c >= 0.0 && c.is_finite();
            Error::unless(is_right, "light of the sky", "0 or more", c)?;
        }
        Error::unless(is_part(self.f0), "the reflectance", "0 to 1", self.f0)?;
        let is_right = (0.05..=1.0).contains(&self.roughness);
        Error::unless(is_right, "the roughness", "0.05 to 1", self.roughness)?;
        if let Some(Lens { radius, focus }) = self.lens {
            let is_length = |x: f64| x > 0.0 && x.is_finite();
            let wanted = "a length over 0";
            Error::unless(is_length(radius), "the radius of the lens", wanted, radius)?;
            let focus = focus.unwrap_or(1.0);
            Error::unless(is_length(focus), "the distance of focus", wanted, focus)?;
        }
        let is_right = self.surface >= 0.0 && self.surface.is_finite();
        let name = "the scattering of surfaces";
        Error::unless(is_right, name, "0 or more", self.surface)
    }
}
