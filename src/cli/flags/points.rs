//! Scattered points as an input.

use super::field::FieldWord;
use super::numbers::positive;
use super::{Error, InputFlags, PHANTOM, PointGrid, SceneFlags};
use crate::cli::stdin::{self, STANDARD};
use crate::format::points::{self, PointColumns, PointFile};
use crate::points::FieldKernel;
use crate::technique::Technique;
use crate::volume::Limits;
use clap::{Args, ValueEnum};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What stands for a scattered point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PointsWord {
    /// A Gaussian, as wide as its standard deviation
    #[default]
    Splats,
    /// A sphere, larger where its value is
    Spheres,
    /// A volume between them, by --interpolate
    Grid,
    /// The field around them, by --field: rays are cast through the points themselves
    Field,
}

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PointLookFlags {
    /// What stands for a scattered point [default: splats]
    #[arg(
        long,
        value_enum,
        value_name = "LOOK",
        help_heading = "Scattered points"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points_as: Option<PointsWord>,
    /// The field of --points-as field, which this stands for: kernel, means of values by a kernel, or kernel,density, how many points,
    /// or how much of their weight, there is on a volume; :R is the radius of the kernel, in world length, as heights are
    /// drawn [default: kernel, R 2 mean distances of neighbours]
    #[arg(
        long,
        value_name = "kernel[:R][,density]",
        help_heading = "Scattered points"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<FieldWord>,
    /// How wide the largest sphere is, in pixels where the camera is turned to [default: 14]
    #[arg(long, value_parser = positive, value_name = "PX", help_heading = "Scattered points")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sphere_size: Option<f64>,
}

impl InputFlags {
    /// True where the input is scattered points.
    pub fn holds_points(&self) -> bool {
        // A stranger's file is opened by a reader of its own.
        let samples = |file: &Path| !self.untrusted && points::holds_samples(file, &self.limits());
        let of_file = |file: &Path| points::holds_points(file) || samples(file);
        self.points_are_named() || self.file().is_some_and(of_file)
    }

    /// True where a flag is for points alone.
    pub fn points_are_named(&self) -> bool {
        self.points || self.point_columns.is_some()
    }

    /// True where they are scattered points in a file, and no built-in volume.
    pub fn are_points(&self) -> bool {
        let is_phantom = self
            .path
            .as_deref()
            .is_some_and(|path| path.starts_with(PHANTOM));
        !is_phantom && self.holds_points()
    }

    /// The points that the words name.
    pub fn open_points(&self, limits: &Limits) -> Result<PointFile, Error> {
        if self.untrusted {
            return Err(Error::usage(
                "--untrusted is for volumes, and the input is scattered points",
                "leave out --untrusted",
            ));
        }
        let spooled = match self.path.as_deref() {
            Some(STANDARD) => Some(stdin::file(limits.max_bytes)?),
            _ => None,
        };
        let path = spooled.as_deref().or(self.file());
        let path = path.unwrap_or(Path::new(STANDARD));
        let text = self.point_columns.as_deref().unwrap_or_default();
        let columns = match text {
            "" => PointColumns::default(),
            _ => text.parse().map_err(|problem| {
                Error::usage(
                    format!("--point-columns {text}: {problem}"),
                    "--point-columns x=lon,y=lat,z=depth_km,value=magnitude",
                )
            })?,
        };
        let columns = PointColumns {
            value: columns.value.or_else(|| self.variable.clone()),
            ..columns
        };
        Ok(points::open_points(path, &columns, limits)?)
    }

    /// `word` beside an input that was not found to be points.
    fn not_of_points(&self, word: &str) -> Error {
        let is_array = self
            .file()
            .is_some_and(|file| file.extension().is_some_and(|ending| ending == "npy"));
        Error::usage(
            format!("{word} is for scattered points, and the input is a volume"),
            match is_array {
                true => "--points takes the rows of an array as x, y, z, value[, std[, weight]]",
                false => "leave it out",
            },
        )
    }
}

impl PointLookFlags {
    /// What stands for a point, where the input is points.
    fn word(&self) -> PointsWord {
        let of_field = || self.field.map(|_| PointsWord::Field);
        self.points_as.or_else(of_field).unwrap_or_default()
    }
}

/// Samples per radius of a field: what the midpoint rule is off by is 5e-4 of the integral through a point.
const FIELD_SAMPLES: f64 = 5.0;

impl SceneFlags {
    /// Whether the words say how points look where there are some.
    pub fn check_point_look(&self) -> Result<(), Error> {
        let look = &self.point_look;
        let has_spheres =
            look.points_as == Some(PointsWord::Spheres) || self.with.shapes().next().is_some();
        if look.sphere_size.is_some() && !has_spheres {
            return Err(Error::usage(
                "--sphere-size needs --points-as spheres, or points by --with",
                "leave it out",
            ));
        }
        let [_, height] = self.picture.extent_pixels()?;
        if let Some(size) = look.sphere_size.filter(|&size| size > f64::from(height)) {
            return Err(Error::usage(
                format!(
                    "--sphere-size {size}: wanted at most {height} pixels of a picture of {height} rows"
                ),
                "--sphere-size 14",
            ));
        }
        if self.point_grid.are_given() && look.points_as != Some(PointsWord::Grid) {
            return Err(Error::usage(
                "--grid, --interpolate, --reach and --anisotropy need --points-as grid",
                "add it",
            ));
        }
        if look.field.is_some() && look.word() != PointsWord::Field {
            return Err(Error::usage(
                "--field needs --points-as field",
                "leave one of them out",
            ));
        }
        // Of thumbnails the input is not known yet.
        let is_known = self.input.path.is_some();
        if look.field.is_some() && is_known && !self.input.are_points() {
            return Err(self.input.not_of_points("--field"));
        }
        if look.points_as.is_some() && is_known && !self.input.are_points() {
            return Err(self.input.not_of_points("--points-as"));
        }
        Ok(())
    }

    /// True where scattered points are spheres.
    pub fn points_are_spheres(&self) -> bool {
        self.point_look.points_as == Some(PointsWord::Spheres) && self.input.are_points()
    }

    /// What scattered points are drawn by: splatting where no word takes another technique, or a grid.
    pub fn choose_for_points(&mut self) {
        if !self.input.are_points() {
            return;
        }
        match self.point_look.word() {
            PointsWord::Splats => {
                self.sampling.of_points = true;
                self.sampling.technique.get_or_insert(Technique::Splat);
            }
            PointsWord::Spheres => {}
            PointsWord::Field => {
                let FieldWord { radius, quantity } = self.point_look.field.unwrap_or_default();
                self.sampling.field = Some(FieldKernel {
                    // Until the points are read.
                    radius: radius.unwrap_or(1.0),
                    quantity,
                });
                self.sampling.samples_per_voxel.get_or_insert(FIELD_SAMPLES);
            }
            PointsWord::Grid => {
                self.input.on_grid = Some(Box::new(PointGrid {
                    flags: self.point_grid.clone(),
                    exaggerate: self.camera.exaggerate,
                }));
            }
        }
    }
}
