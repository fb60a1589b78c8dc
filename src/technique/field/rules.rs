//! What does not go together with rays through scattered points.

use crate::technique::{Error, Filter, Lattice, Settings, SkipBy, Technique};
use std::fmt;

/// Whether a picture of points that are cast by rays has what these settings ask for.
fn refusals(settings: &Settings, radius: f64) -> Result<(), Error> {
    let Settings {
        technique,
        mode,
        filter,
        lattice,
        ..
    } = *settings;
    let refuse = |is_refused: bool, of: &'static str, found: &dyn fmt::Display| match is_refused {
        true => Err(Error::NotFor {
            wanted: "casting scattered points by rays",
            of,
            found: found.to_string(),
        }),
        false => Ok(()),
    };
    refuse(
        technique != Technique::Raycast,
        "the technique raycast, and points on a grid for all",
        &format_args!("technique {technique}"),
    )?;
    refuse(
        mode.needs_rays(),
        "the modes composite, mip, minip, average and xray",
        &format_args!("mode {mode}"),
    )?;
    refuse(
        filter != Filter::default(),
        "the kernel of points, and no filter of voxels",
        &format_args!("the filter {filter}"),
    )?;
    refuse(
        !matches!(lattice, Lattice::Ray | Lattice::Jitter),
        "the lattices ray and jitter",
        &format_args!("the lattice {lattice}"),
    )?;
    let of_voxels: [(bool, &'static str, &'static str); 8] = [
        (
            settings.preintegrated,
            "samples that are points",
            "pre-integrated classification",
        ),
        (
            settings.adaptive_steps.is_some(),
            "steps of one length",
            "adaptive steps",
        ),
        (
            settings.cut_faces.is_some(),
            "what lies behind cuts",
            "opaque cut faces",
        ),
        (
            settings.empty_space != SkipBy::Cells,
            "empty cells of points",
            "empty space by an octree or by runs of voxels",
        ),
        (
            settings.shading.is_some(),
            "matter that is not lit",
            "lights",
        ),
        (
            settings.ambient_occlusion.is_some(),
            "matter that is not lit",
            "ambient occlusion",
        ),
        (
            settings.single_scattering.is_some(),
            "matter that is not lit",
            "single scattering",
        ),
        (
            settings.per_mode.exact_maximum,
            "the extremes of samples",
            "exact extremes",
        ),
    ];
    for (is_refused, of, found) in of_voxels {
        refuse(is_refused, of, &found)?;
    }
    Error::unless(
        radius > 0.0 && radius.is_finite(),
        "the radius of points",
        "a length over 0",
        radius,
    )
}

impl Settings {
    /// Whether points that are cast by rays have what these settings ask for; nothing where none are.
    ///
    /// # Errors
    /// [`Error::NotFor`], and [`Error::OutOfRange`] for a radius that is none.
    pub(in crate::technique) fn check_field(&self) -> Result<(), Error> {
        match &self.field {
            Some(kernel) => refusals(self, kernel.radius),
            None => Ok(()),
        }
    }

    /// The same for functions of gradients.
    pub(in crate::technique) fn check_field_function(&self) -> Result<(), Error> {
        match self.field.is_some() {
            true => Err(Error::NotFor {
                wanted: "casting scattered points by rays",
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
    use crate::points::{FieldKernel, Quantity};
    use crate::technique::{AmbientOcclusion, CutFaces, Mode, Shading, SingleScattering};

    #[test]
    fn what_rays_through_points_have_not_is_refused_by_name() {
        let kernel = FieldKernel {
            radius: 2.0,
            quantity: Quantity::Mean,
        };
        let field = Settings {
            field: Some(kernel),
            ..Settings::default()
        };
        for mode in [
            Mode::Composite,
            Mode::Mip,
            Mode::Minip,
            Mode::Average,
            Mode::Xray,
        ] {
            let settings = Settings {
                mode,
                lattice: Lattice::Jitter,
                ..field.clone()
            };
            assert_eq!(settings.check(), Ok(()), "{mode}");
        }
        type Change = (&'static str, fn(&mut Settings));
        let changes: [Change; 17] = [
            ("slices-3d", |s| s.technique = Technique::Slices3d),
            ("slices-2d", |s| s.technique = Technique::Slices2d),
            ("shear-warp", |s| s.technique = Technique::ShearWarp),
            ("technique splat", |s| s.technique = Technique::Splat),
            ("pathtrace", |s| s.technique = Technique::Pathtrace),
            ("mode lmip", |s| s.mode = Mode::Lmip),
            ("mode mida", |s| s.mode = Mode::Mida),
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
            ("single scattering", |s| {
                s.single_scattering = Some(SingleScattering::Open);
            }),
        ];
        for (name, change) in changes {
            let mut settings = field.clone();
            change(&mut settings);
            let text = settings.check().expect_err(name).to_string();
            assert!(
                text.contains(name) && text.contains("points"),
                "{name}: {text}"
            );
        }
        for radius in [0.0, f64::NAN, -1.0, f64::INFINITY] {
            let mut settings = field.clone();
            settings.field = Some(FieldKernel { radius, ..kernel });
            let error = settings.check().expect_err("no radius");
            assert!(matches!(error, Error::OutOfRange { .. }), "{error}");
        }
    }
}
