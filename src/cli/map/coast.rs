//! `--coast FILE`: lines of a file for the coast of `--map`.
//!
//! ```text
//! between two places   straight in longitude and latitude (RFC 7946, 3.1.1), over the 180th meridian where that is shorter
//! ```
//!
//! Polygons are cut along the 180th meridian and closed at the south pole: these edges are no coast.

use super::Error;
use super::earth::Lines;
use super::project::{FINE, pieces, turns};
use crate::format::geographic::read_lines;
use crate::volume::Limits;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// A file that is read once, by whoever asks first.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(from = "PathBuf", into = "PathBuf")]
pub struct CoastFile {
    path: PathBuf,
    read: Arc<OnceLock<Lines>>,
}

/// Of all lines, where they are bent on a map: of places a million degrees apart.
const MOST_PIECES: u64 = 4_000_000;

impl CoastFile {
    /// Where it lies.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its lines, longitudes without jumps.
    pub(super) fn lines(&self, limits: &Limits) -> Result<&Lines, Error> {
        if let Some(lines) = self.read.get() {
            return Ok(lines);
        }
        let lines = read_lines(&self.path, limits)?.into_iter();
        let lines: Lines = lines.flat_map(without_edges).collect();
        let long = lines.iter().flat_map(|line| line.windows(2));
        let count: u64 = long
            .map(|pair| u64::from(pieces(pair[0], pair[1], FINE) - 1))
            .sum();
        if count > MOST_PIECES {
            return Err(Error::Input {
                path: self.path.clone(),
                problem: format!(
                    "its lines go {} times around the Earth without a place between: wanted at most {}",
                    count / 1440,
                    MOST_PIECES / 1440
                ),
            });
        }
        Ok(self.read.get_or_init(|| lines))
    }
}

impl PartialEq for CoastFile {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

impl From<PathBuf> for CoastFile {
    fn from(path: PathBuf) -> Self {
        Self {
            path,
            read: Arc::default(),
        }
    }
}

impl From<&str> for CoastFile {
    fn from(path: &str) -> Self {
        Self::from(PathBuf::from(path))
    }
}

impl From<CoastFile> for PathBuf {
    fn from(file: CoastFile) -> Self {
        file.path
    }
}

/// The parts of a line between edges of the map, each the shorter way around the Earth.
pub(super) fn without_edges(line: Vec<[f64; 2]>) -> Lines {
    let mut parts = Vec::new();
    let mut part: Vec<[f64; 2]> = Vec::new();
    let mut before: Option<[f64; 2]> = None;
    for place in line {
        match (before, part.last()) {
            (Some(before), _) if is_edge(before, place) => {
                parts.push(std::mem::replace(&mut part, vec![place]));
            }
            (Some(_), Some(&[last, _])) => {
                part.push([place[0] + 360.0 * turns(last, place[0]), place[1]]);
            }
            _ => part.push(place),
        }
        before = Some(place);
    }
    parts.push(part);
    parts.retain(|part| part.len() > 1);
    parts
}

/// Farther south there is no coast: files close Antarctica along this latitude, or nearer to the pole.
const POLE: f64 = -89.99;

fn is_edge(a: [f64; 2], b: [f64; 2]) -> bool {
    let is_cut = |place: [f64; 2]| place[0].abs() == 180.0;
    is_cut(a) && is_cut(b) || a[1] < POLE && b[1] < POLE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_go_the_shorter_way_and_keep_no_edges() {
        let bering = vec![[178.0, 65.0], [-179.0, 66.0], [-170.0, 66.0], [175.0, 60.0]];
        let unwrapped = vec![[178.0, 65.0], [181.0, 66.0], [190.0, 66.0], [175.0, 60.0]];
        assert_eq!(without_edges(bering), [unwrapped]);
        // Antarctica as polygons have it.
        let ring = vec![
            [-180.0, -84.0],
            [0.0, -70.0],
            [180.0, -84.0],
            [180.0, -90.0],
            [0.0, -89.999],
            [-180.0, -90.0],
            [-180.0, -84.0],
        ];
        let coast = vec![[-180.0, -84.0], [0.0, -70.0], [180.0, -84.0]];
        assert_eq!(without_edges(ring), [coast]);
        // A coast may touch the meridian.
        let touching = vec![[179.0, 1.0], [180.0, 2.0], [179.0, 3.0]];
        assert_eq!(without_edges(touching.clone()), [touching]);
    }
}
