//! Lines on the Earth from files: shapefiles, GeoJSON and TopoJSON, told apart by content.
//!
//! ```text
//! file -> lines of [longitude, latitude], degrees
//! ```
//!
//! Of polygons these are their rings; points have no line, and heights and measures are passed over. What is not in degrees
//! is refused: longitudes are -360 to 360, latitudes -90 to 90. A file is read whole, and what it holds never takes much
//! more memory than its bytes.

mod geojson;
mod shapefile;
mod topojson;

use super::place::whole;
use super::problem::at;
use crate::volume::{Limits, Problem, ReadError};
use std::path::Path;

/// Longitudes and latitudes along a line, degrees.
pub type GeographicLine = Vec<[f64; 2]>;

/// Coasts of the whole Earth at 1 : 10 million have a tenth of this, text or not.
const MOST_BYTES: u64 = 256 << 20;
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// Degrees that the last digits of a latitude may be off.
const ROUNDING: f64 = 1e-6;

/// The lines of a file.
///
/// # Errors
/// The file is of neither kind, is cut, holds no lines, or says something that cannot be. The error names the file, the
/// field, what was wanted and what was found.
pub fn read_lines(path: &Path, limits: &Limits) -> Result<Vec<GeographicLine>, ReadError> {
    let most = MOST_BYTES.min(limits.max_bytes);
    let bytes = whole(path, most, "a file of lines on the Earth").map_err(at(path))?;
    let lines = match &bytes {
        bytes if shapefile::recognizes(bytes) => shapefile::lines(bytes),
        bytes => match text_of(bytes) {
            Some(text) if topojson::recognizes(text) => topojson::lines(text),
            Some(text) => geojson::lines(text),
            None => Err(Problem::UnknownFormat(
                ": wanted a shapefile (.shp), GeoJSON or TopoJSON".to_owned(),
            )),
        },
    };
    lines.map_err(at(path))
}

/// An object of JSON without a mark of the order of bytes; `None` where a file begins otherwise.
fn text_of(bytes: &[u8]) -> Option<&[u8]> {
    let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
    text.trim_ascii_start().starts_with(b"{").then_some(text)
}

/// A place in degrees, or what is wrong with it: its number, what would do.
fn checked([longitude, latitude]: [f64; 2]) -> Result<[f64; 2], (f64, &'static str)> {
    if !(-360.0..=360.0).contains(&longitude) {
        return Err((longitude, "a longitude from -360 to 360 degrees"));
    }
    if !(-90.0 - ROUNDING..=90.0 + ROUNDING).contains(&latitude) {
        return Err((latitude, "a latitude from -90 to 90 degrees"));
    }
    Ok([longitude, latitude.clamp(-90.0, 90.0)])
}

/// A place in degrees, on the edge of the map where a sum of steps has left it a billionth of a degree beside.
pub(crate) fn on_edges([longitude, latitude]: [f64; 2]) -> [f64; 2] {
    let snapped = |degrees: f64, edge: f64| match (degrees.abs() - edge).abs() < 1e-9 {
        true => edge.copysign(degrees),
        false => degrees,
    };
    [snapped(longitude, 180.0), snapped(latitude, 90.0)]
}
