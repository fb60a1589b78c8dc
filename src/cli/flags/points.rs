//! Scattered points as an input.

use super::{Error, InputFlags, PHANTOM, SceneFlags};
use crate::cli::stdin::{self, STANDARD};
use crate::format::points::{self, PointColumns, PointFile};
use crate::technique::Technique;
use crate::volume::Limits;
use std::path::Path;

impl InputFlags {
    /// True where the input is scattered points.
    pub fn holds_points(&self) -> bool {
        self.points_are_named() || self.file().is_some_and(points::holds_points)
    }

    /// True where a flag is for points alone.
    pub fn points_are_named(&self) -> bool {
        self.points || self.point_columns.is_some()
    }

    /// True where they are splatted.
    pub fn splats_points(&self) -> bool {
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
}

impl SceneFlags {
    /// Splatting, where the input is scattered points and no word takes another technique.
    pub fn splat_points(&mut self) {
        if self.input.splats_points() {
            self.sampling.of_points = true;
            self.sampling.technique.get_or_insert(Technique::Splat);
        }
    }
}
