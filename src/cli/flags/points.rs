//! Scattered points as an input: whether it is such, and as what it is drawn.

use super::{Error, InputFlags};
use crate::cli::stdin::STANDARD;
use crate::format::points::{self, PointColumns, PointFile};
use crate::volume::Limits;
use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What is drawn of scattered points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PointsAs {
    /// A Gaussian each
    Splats,
    /// The volume of their means
    Grid,
}

impl InputFlags {
    /// True where the input is scattered points.
    pub fn holds_points(&self) -> bool {
        let is_named = self.points_as.is_some() || self.point_columns.is_some();
        self.file()
            .is_some_and(|path| is_named || points::holds_points(path))
    }

    /// True where they are splatted.
    pub fn splats_points(&self) -> bool {
        self.holds_points() && self.points_as != Some(PointsAs::Grid)
    }

    /// The points that the words name.
    pub fn open_points(&self, limits: &Limits) -> Result<PointFile, Error> {
        let path = self.file().unwrap_or(Path::new(STANDARD));
        if self.untrusted {
            return Err(Error::usage(
                "--untrusted is for volumes, and the input is scattered points",
                "leave out --untrusted",
            ));
        }
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
}
