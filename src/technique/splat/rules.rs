//! What does not go together with splats.

use super::{Sheets, Splat};
use crate::technique::{Error, Filter, Lattice, Mode, Settings, Technique};
use std::fmt;

/// Whether a picture of splats has what these settings ask for.
fn refusals(settings: &Settings) -> Result<(), Error> {
    let Settings {
        mode,
        filter,
        lattice,
        ..
    } = *settings;
    let refuse = |is_refused: bool, of: &'static str, found: &dyn fmt::Display| match is_refused {
        true => Err(Error::NotFor {
            wanted: "splatting",
            of,
            found: found.to_string(),
        }),
        false => Ok(()),
    };
    refuse(
        mode.needs_rays(),
        "the modes composite, mip, minip, average and xray",
        &format_args!("mode {mode}"),
    )?;
    refuse(
        filter != Filter::default(),
        "its own kernel, whose width is its standard deviation, and no filter",
        &format_args!("the filter {filter}"),
    )?;
    refuse(
        lattice != Lattice::Ray,
        "sheets of its own, and no lattice of rays",
        &format_args!("the lattice {lattice}"),
    )?;
    refuse(
        settings.preintegrated,
        "samples that are sheets",
        &"pre-integrated classification",
    )?;
    refuse(
        settings.adaptive_steps.is_some(),
        "sheets of one thickness",
        &"adaptive steps",
    )?;
    refuse(
        settings.cut_faces.is_some(),
        "what lies behind cuts",
        &"opaque cut faces",
    )?;
    refuse(
        settings.shading.is_some(),
        "matter that is not lit",
        &"lights",
    )?;
    refuse(
        settings.ambient_occlusion.is_some(),
        "matter that is not lit",
        &"ambient occlusion",
    )?;
    refuse(
        settings.per_mode.exact_maximum,
        "the extremes of its sheets",
        &"exact extremes",
    )?;
    let Splat {
        sheets,
        std,
        low_pass,
        cut_bits,
        of_points,
    } = settings.splat;
    refuse(
        of_points && sheets != Sheets::default(),
        "scattered points each by itself",
        &format_args!("sheets {sheets}"),
    )?;
    let is_alone = sheets == Sheets::None && matches!(mode, Mode::Mip | Mode::Minip);
    refuse(
        is_alone,
        "values of sheets in mip and minip",
        &"splats without sheets",
    )?;
    Error::unless(
        std > 0.0 && std.is_finite(),
        "the standard deviation of splats",
        "a number of voxels over 0",
        std,
    )?;
    Error::unless(
        low_pass >= 0.0 && low_pass.is_finite(),
        "the low pass of splats",
        "a number of pixels, 0 or more",
        low_pass,
    )?;
    let bits = f64::from(cut_bits);
    Error::unless(
        (4..=24).contains(&cut_bits),
        "the bits that splats are cut at",
        "4 to 24",
        bits,
    )
}

impl Settings {
    /// Whether a picture of splats has what these settings ask for; nothing for other techniques.
    ///
    /// # Errors
    /// [`Error::NotFor`], and [`Error::OutOfRange`] for what makes no splats.
    pub(in crate::technique) fn check_splats(&self) -> Result<(), Error> {
        match self.technique {
            Technique::Splat => refusals(self),
            _ => Ok(()),
        }
    }

    /// Whether a picture of splats has these volumes: one, of numbers or `is_classified`.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(crate) fn check_splatted(
        &self,
        are_several: bool,
        is_classified: bool,
    ) -> Result<(), Error> {
        if self.technique != Technique::Splat {
            return Ok(());
        }
        if are_several && !is_classified {
            return Err(Error::NotFor {
                wanted: "splatting",
                of: "one volume of numbers, or one that is classified",
                found: "several that are mixed".to_owned(),
            });
        }
        let is_refused =
            self.splat.sheets == Sheets::None && self.mode == Mode::Composite && !is_classified;
        match is_refused {
            true => Err(Error::NotFor {
                wanted: "compositing splats without sheets",
                of: "voxels that are classified before",
                found: "classified sheets".to_owned(),
            }),
            false => Ok(()),
        }
    }

    /// Whether scattered points are drawn as such, and nothing else is.
    ///
    /// # Errors
    /// [`Error::NotFor`].
    pub(crate) fn check_points(&self, are_points: bool) -> Result<(), Error> {
        let splats_points = self.technique == Technique::Splat && self.splat.of_points;
        let (wanted, of, found) = match (are_points, splats_points || self.field.is_some()) {
            (true, false) => (
                "drawing scattered points",
                "splatting, or rays through their field",
                format!("technique {}", self.technique),
            ),
            (false, true) => ("drawing scattered points", "points", "a volume".to_owned()),
            _ => return Ok(()),
        };
        Err(Error::NotFor { wanted, of, found })
    }

    /// The same for functions of gradients.
    pub(crate) fn check_splatted_function(&self) -> Result<(), Error> {
        match self.technique == Technique::Splat {
            true => Err(Error::NotFor {
                wanted: "splatting",
                of: "functions of the value alone",
                found: "one of the value and its gradient".to_owned(),
            }),
            false => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::{AmbientOcclusion, CutFaces, Shading};

    #[test]
    fn what_splats_have_not_is_refused_by_name() {
        let splats = Settings {
            technique: Technique::Splat,
            ..Settings::default()
        };
        assert_eq!(splats.check(), Ok(()));
        type Change = (&'static str, fn(&mut Settings));
        let changes: [Change; 12] = [
            ("mode lmip", |s| s.mode = Mode::Lmip),
            ("mode iso", |s| s.mode = Mode::Iso),
            ("the filter cubic", |s| s.filter = Filter::Cubic),
            ("the lattice planes", |s| s.lattice = Lattice::Planes),
            ("the lattice bresenham", |s| s.lattice = Lattice::Bresenham),
            ("pre-integrated", |s| s.preintegrated = true),
            ("adaptive", |s| s.adaptive_steps = Some(0.01)),
            ("cut faces", |s| s.cut_faces = Some(CutFaces::Own)),
            ("lights", |s| s.shading = Some(Shading::default())),
            ("occlusion", |s| {
                s.ambient_occlusion = Some(AmbientOcclusion {
                    strength: 0.5,
                    radius_world: None,
                });
            }),
            ("without sheets", |s| {
                (s.mode, s.splat.sheets) = (Mode::Mip, Sheets::None);
            }),
            ("smooth", |s| s.smooth = true),
        ];
        for (name, change) in changes {
            let mut settings = splats.clone();
            change(&mut settings);
            let text = settings.check().expect_err(name).to_string();
            let is_named = text.contains(name) || name == "smooth" && text.contains("slices");
            assert!(is_named && text.contains("splat"), "{name}: {text}");
        }
        for (std, low_pass) in [(0.0, 0.6), (f64::NAN, 0.6), (0.6, -1.0)] {
            let mut settings = splats.clone();
            (settings.splat.std, settings.splat.low_pass) = (std, low_pass);
            let error = settings.check().expect_err("no splat");
            assert!(matches!(error, Error::OutOfRange { .. }), "{error}");
        }
        assert!(splats.check_splatted(true, false).is_err());
        assert_eq!(splats.check_splatted(true, true), Ok(()));
        let mut alone = splats.clone();
        alone.splat.sheets = Sheets::None;
        assert!(alone.check_splatted(false, false).is_err());
        assert_eq!(alone.check_splatted(true, true), Ok(()));
        assert!(splats.check_bricks(2).is_err());
        assert!(splats.check_graded().is_err());
    }
}
