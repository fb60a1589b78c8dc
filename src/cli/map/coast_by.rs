//! `--coast-by projection|arrays`: what places the lines of `--map` on the volume.

use super::arrays::Arrays;
use super::project::Projection;
use crate::cli::{Error, flow::Variables, progress::Progress};
use crate::volume::Header;
use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What places the lines of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CoastBy {
    /// The degrees of the grid, or its map
    Projection,
    /// The latitude and longitude that the file has of each column, as far as the grid reaches
    Arrays,
}

/// What places lines on the volume of this header.
pub(super) fn placed(
    header: &Header,
    by: Option<CoastBy>,
    variables: &Variables<'_>,
    progress: &Progress,
) -> Result<Projection, Error> {
    let known = Projection::of(header);
    if by == Some(CoastBy::Arrays) || by.is_none() && known.is_none() {
        if let Some(arrays) = Arrays::read(header, variables)? {
            if let (None, Some([latitude, longitude])) = (by, &header.earth_arrays) {
                progress.note(&format!(
                    "the map is placed by {latitude} and {longitude} of each column, and ends with the grid"
                ));
            }
            return Ok(Projection::Arrays(Arc::new(arrays)));
        }
        if by == Some(CoastBy::Arrays) {
            let found = match &header.earth_arrays {
                Some(names) => format!("{}, which span no part of it", names.join(" and ")),
                None => "none".to_owned(),
            };
            return Err(Error::usage(
                format!(
                    "--coast-by arrays: wanted variables of two dimensions with the latitude and the longitude of each column, \
                     XLAT and XLONG, or those that the attribute `coordinates` names; found {found}"
                ),
                "leave out --coast-by",
            ));
        }
    }
    let projection = known.ok_or_else(|| {
        Error::usage(
            "--map: the volume has no place on the Earth: wanted latitudes and longitudes, those of a moved pole with its grid_mapping, or a WRF \
             file with MAP_PROJ, TRUELAT1 and XLAT",
            match &header.earth_arrays {
                Some(_) if by.is_some() => "leave out --coast-by",
                _ => "leave out --map",
            },
        )
    })?;
    let off = header.map.and_then(|map| projection.disagreement(&map));
    match off {
        None => Ok(projection),
        Some(off) => Err(Error::usage(
            format!(
                "--map: latitudes in the file and its projection differ by {off:.2} km at a corner"
            ),
            match &header.earth_arrays {
                Some(_) => "--coast-by arrays places the map by these latitudes",
                None => "leave out --map",
            },
        )),
    }
}
