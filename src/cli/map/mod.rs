//! `--map coast,borders,graticule,terrain`: where the volume lies on the Earth, drawn at sea level or on the terrain.
//!
//! ```text
//! margin      a fifth of the box's larger side around it; along x no more than once around the Earth together
//! graticule   meridians and parallels every 1, 2, 5, 10, 15 or 30 degrees, four of them at least
//! coarser     40 degrees and wider: places of coast and borders nearer to the last than a 2000th of the width are left out
//! ```

mod arrays;
mod coast;
mod coast_by;
mod earth;
mod project;

use super::{Error, flow::Variables, progress::Progress};
use crate::volume::{Grid, Header};
use arrays::Arrays;
use clap::Args;
use coast::CoastFile;
use coast_by::{CoastBy, placed};
use earth::{Lines, earth};
use glam::DVec3;
use project::{FINE, Projection, projected_line, turns};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::{fmt, str::FromStr};

/// What is drawn of the Earth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct MapWords {
    coast: bool,
    borders: bool,
    /// Degrees between lines, 0 where they are chosen.
    graticule: Option<f64>,
    terrain: bool,
}

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MapFlags {
    /// Draw the Earth at sea level around the volume: coast, borders, graticule or graticule=DEG; and terrain, the heights
    /// of the ground below it, with these lines on it [default of the list: coast,borders,graticule]
    #[arg(long, value_name = "LIST", num_args = 0..=1, default_missing_value = MapWords::ALL, help_heading = "Lines")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map: Option<MapWords>,
    /// The coast of --map by the lines and polygons of a file, in degrees: a shapefile, GeoJSON or TopoJSON
    #[arg(long, value_name = "FILE.shp|.geojson|.json", help_heading = "Lines")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coast: Option<CoastFile>,
    /// What places the lines of --map on the volume [default: projection; arrays where the grid has no projection that is
    /// known]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Lines")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coast_by: Option<CoastBy>,
}

impl MapFlags {
    /// The lines around a volume.
    ///
    /// # Errors
    /// Where it has no place on the Earth, or none is known; where the file of the coast cannot be read, or is not asked for.
    pub fn lines(
        &self,
        header: &Header,
        variables: &Variables<'_>,
        progress: &Progress,
    ) -> Result<Vec<GroundLine>, Error> {
        if self.coast.is_some() && !self.map.is_some_and(|words| words.coast) {
            return Err(Error::usage(
                "--coast FILE is the coast of --map",
                "--map coast draws it",
            ));
        }
        if self.coast_by.is_some() && !self.map.is_some_and(|words| words.has_lines()) {
            return Err(Error::usage(
                "--coast-by says what places the lines of --map",
                "--map coast draws them",
            ));
        }
        let words = self.map.filter(MapWords::has_lines);
        let Some(words) = words else {
            return Ok(Vec::new());
        };
        let projection = placed(header, self.coast_by, variables, progress)?;
        words.lines(header, &projection, || match &self.coast {
            Some(file) => file.lines(&variables.limits),
            None => Ok(&earth().coast),
        })
    }

    /// The file of the coast.
    pub fn file(&self) -> Option<&Path> {
        self.coast.as_ref().map(CoastFile::path)
    }

    /// The same words with another path.
    pub fn with_paths(&self, path: impl Fn(&Path) -> PathBuf) -> Self {
        Self {
            coast: self.file().map(|file| path(file).into()),
            ..self.clone()
        }
    }
}

/// Where x and y of the world lie on the Earth, and back.
#[derive(Clone, Debug)]
pub struct OnEarth {
    projection: Projection,
    /// Longitude of the middle of the grid.
    middle: f64,
}

impl OnEarth {
    /// That of a volume; `None` where it has no place on the Earth, or its latitudes and its map differ.
    pub fn of(header: &Header) -> Option<Self> {
        let projection = Projection::of(header)?;
        let off = header.map.and_then(|map| projection.disagreement(&map));
        let half = 0.5 * DVec3::from_array(header.dims.map(f64::from));
        let place = header.world_from_voxel.transform_point3(half);
        let [middle, _] = projection.earth([place.x, place.y]);
        off.is_none().then_some(Self { projection, middle })
    }

    /// Longitude and latitude in degrees.
    pub fn degrees(&self, at: [f64; 2]) -> [f64; 2] {
        self.projection.earth(at)
    }

    /// x and y of a longitude and a latitude, within half of the Earth from the middle of the grid; `None` where the map has
    /// no such place.
    pub fn place(&self, [longitude, latitude]: [f64; 2]) -> Option<[f64; 2]> {
        let near = longitude + 360.0 * turns(self.middle, longitude);
        self.projection.place([near, latitude])
    }
}

/// Whether a place of the world lies in the southern hemisphere; none does where the latitude is not known.
pub fn is_southern(header: &Header) -> impl Fn(DVec3) -> bool {
    let projection = Projection::of(header);
    move |place| {
        let map = projection.as_ref();
        map.is_some_and(|map| map.latitude([place.x, place.y]) < 0.0)
    }
}

/// A line on the ground, world, before heights are exaggerated.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundLine {
    /// Its places.
    pub places: Vec<DVec3>,
    /// Of its grey, sRGB.
    pub grey: f32,
    /// Pixels.
    pub width: f64,
    /// Of a meridian or a parallel, and whether it is a meridian.
    pub degrees: Option<(f64, bool)>,
}

/// Of the larger side of the box.
const MARGIN: f64 = 0.2;
/// Degrees between lines of a graticule.
const STEPS: [f64; 8] = [0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0];
/// Kilometres.
const KM_PER_DEGREE: f64 = 111.2;
/// Degrees from which on coasts are coarser, and how many places lie along a line across the picture.
const WIDE: f64 = 40.0;
const FINEST: f64 = 2000.0;
/// More lines of a graticule are a grey sheet.
const MOST_OF_GRATICULE: usize = 360;
/// Grey and pixels of coast, borders and graticule.
const COAST: (f32, f64) = (0.8, 2.0);
const BORDERS: (f32, f64) = (0.6, 1.5);
const GRATICULE: (f32, f64) = (0.4, 1.3);

impl MapWords {
    /// All of it.
    pub const ALL: &str = "coast,borders,graticule";

    /// True where a volume has a place on the Earth that lines can be placed by.
    pub fn can_show(header: &Header, variables: &Variables<'_>) -> bool {
        let by_arrays = || {
            let is_unknown = Projection::of(header).is_none();
            is_unknown && matches!(Arrays::read(header, variables), Ok(Some(_)))
        };
        OnEarth::of(header).is_some() || by_arrays()
    }

    /// True where lines of the Earth are drawn.
    fn has_lines(&self) -> bool {
        self.coast || self.borders || self.graticule.is_some()
    }

    /// The same and the heights of the ground.
    pub fn with_terrain(self) -> Self {
        Self {
            terrain: true,
            ..self
        }
    }

    /// True where heights of the ground are drawn.
    pub fn has_terrain(&self) -> bool {
        self.terrain
    }

    fn lines<'a>(
        self,
        header: &Header,
        projection: &Projection,
        coast: impl FnOnce() -> Result<&'a Lines, Error>,
    ) -> Result<Vec<GroundLine>, Error> {
        let grid = Grid {
            dims: header.dims,
            world_from_voxel: header.world_from_voxel,
        };
        let area = Area::around(&grid, projection.turn_length());
        let mut lines = Vec::new();
        if let Some(step) = self.graticule {
            let mut count = 0;
            for (line, degrees) in graticule(&area, step) {
                let first = lines.len();
                let places = projected(projection, &area, [line.as_slice()].into_iter());
                area.add(&mut lines, &places, GRATICULE);
                for line in &mut lines[first..] {
                    line.degrees = Some(degrees);
                }
                count += usize::from(lines.len() > first);
                if count > MOST_OF_GRATICULE {
                    return Err(Error::usage(
                        format!(
                            "--map graticule={step}: wanted at most {MOST_OF_GRATICULE} meridians and parallels around the volume, \
                             found more"
                        ),
                        "--map graticule chooses how many degrees lie between them",
                    ));
                }
            }
        }
        let mut add = |all: &Lines, look| {
            let places = all.iter().map(|line| line.as_slice());
            let mut places = projected(projection, &area, places);
            if area.width() >= WIDE * KM_PER_DEGREE {
                places
                    .iter_mut()
                    .for_each(|line| thin(line, area.width() / FINEST));
            }
            area.add(&mut lines, &places, look);
        };
        if self.borders {
            add(&earth().borders, BORDERS);
        }
        if self.coast {
            add(coast()?, COAST);
        }
        Ok(lines)
    }
}

/// Leaves out places nearer than a length to the last one that is left, but for both ends.
fn thin(line: &mut Vec<[f64; 2]>, length: f64) {
    let end = line.last().copied();
    let mut last: Option<[f64; 2]> = None;
    line.retain(|&[x, y]| {
        let is_far = last.is_none_or(|[a, b]| (x - a).hypot(y - b) >= length);
        if is_far {
            last = Some([x, y]);
        }
        is_far
    });
    if let Some(end) = end.filter(|end| last != Some(*end)) {
        line.push(end);
    }
}

/// World height of what lies on the ground: sea level, or the face of the box nearest to it.
pub fn ground_height(grid: &Grid) -> f64 {
    Area::around(grid, None).height
}

/// Places on the map, a line each.
type Flat = Vec<Vec<[f64; 2]>>;

/// What is seen of the ground: a rectangle of the world.
struct Area {
    low: [f64; 2],
    high: [f64; 2],
    height: f64,
}

impl Area {
    /// The box with a margin, at sea level or at the face of the box nearest to it. Where x goes around the Earth in some
    /// world length, it is no wider than that: nothing is there twice.
    fn around(grid: &Grid, turn_length: Option<f64>) -> Self {
        let corners = (0..8).map(|i| {
            let far = grid.far_corner();
            let bit = |k: usize| if i >> k & 1 == 1 { far[k] } else { 0.0 };
            grid.world_from_voxel
                .transform_point3(DVec3::new(bit(0), bit(1), bit(2)))
        });
        let (low, high) = corners.fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(low, high), corner| (low.min(corner), high.max(corner)),
        );
        let margin = MARGIN * (high - low).truncate().max_element();
        let rest = turn_length.map_or(f64::INFINITY, |turn| turn - (high.x - low.x));
        let along_x = margin.min(0.5 * rest.max(0.0));
        Self {
            low: [low.x - along_x, low.y - margin],
            high: [high.x + along_x, high.y + margin],
            height: 0.0_f64.clamp(low.z, high.z),
        }
    }

    fn width(&self) -> f64 {
        self.high[0] - self.low[0]
    }

    /// The parts of lines that lie in it.
    fn add(&self, lines: &mut Vec<GroundLine>, all: &Flat, (grey, width): (f32, f64)) {
        for line in all {
            let mut part: Vec<DVec3> = Vec::new();
            let mut end = |part: &mut Vec<DVec3>| {
                let places = std::mem::take(part);
                if places.len() > 1 {
                    lines.push(GroundLine {
                        places,
                        grey,
                        width,
                        degrees: None,
                    });
                }
            };
            for pair in line.windows(2) {
                match self.clipped(pair[0], pair[1]) {
                    Some([a, b]) => {
                        let [a, b] = [a, b].map(|[x, y]| DVec3::new(x, y, self.height));
                        if part.last() != Some(&a) {
                            end(&mut part);
                            part.push(a);
                        }
                        part.push(b);
                    }
                    None => end(&mut part),
                }
            }
            end(&mut part);
        }
    }

    /// The part of a straight piece in the rectangle (Liang and Barsky 1984).
    fn clipped(&self, a: [f64; 2], b: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for k in [0, 1] {
            let way = b[k] - a[k];
            for (distance, slope) in [(a[k] - self.low[k], -way), (self.high[k] - a[k], way)] {
                if slope == 0.0 && distance < 0.0 {
                    return None;
                }
                if slope < 0.0 {
                    from = from.max(distance / slope);
                } else if slope > 0.0 {
                    to = to.min(distance / slope);
                }
            }
        }
        let at = |part: f64| match part {
            0.0 => a,
            1.0 => b,
            _ => [0, 1].map(|k| a[k] + part * (b[k] - a[k])),
        };
        (from < to).then(|| [at(from), at(to)])
    }
}

/// Lines of the Earth on the map; of degrees once more for each turn around the Earth that the area reaches into.
fn projected<'a>(
    projection: &Projection,
    area: &Area,
    lines: impl Iterator<Item = &'a [[f64; 2]]>,
) -> Flat {
    let turns: &[f64] = match projection {
        Projection::Degrees(_) => &[-360.0, 0.0, 360.0],
        Projection::Map { .. } | Projection::MovedPole { .. } | Projection::Arrays(_) => &[0.0],
    };
    let is_near = |line: &Vec<[f64; 2]>| {
        (0..2).all(|k| {
            let [low, high] = [area.low[k], area.high[k]];
            line.iter().any(|p| p[k] >= low) && line.iter().any(|p| p[k] <= high)
        })
    };
    let mut all = Vec::new();
    for line in lines {
        for &turn in turns {
            projected_line(projection, line, turn, |part| {
                if is_near(&part) {
                    all.push(part);
                }
            });
        }
    }
    all
}

/// Longitudes and latitudes along a line, its own degrees, and whether it is a meridian.
type GraticuleLine = (Vec<[f64; 2]>, (f64, bool));

/// Meridians and parallels.
fn graticule(area: &Area, degrees: f64) -> Vec<GraticuleLine> {
    let kilometres = (area.high[1] - area.low[1]).max(area.width());
    let span = kilometres / KM_PER_DEGREE;
    let step = match degrees > 0.0 {
        true => degrees,
        false => STEPS
            .into_iter()
            .rev()
            .find(|step| span / step >= 4.0)
            .unwrap_or(STEPS[0]),
    };
    let fine = |from: f64, to: f64| {
        let count = ((to - from) / FINE).ceil() as u32;
        (0..=count).map(move |i| from + (to - from) * f64::from(i) / f64::from(count))
    };
    let mut lines = Vec::new();
    let count = (180.0 / step).floor() as i32;
    for i in -count..=count {
        let longitude = f64::from(i) * step;
        let line = fine(-85.0, 85.0).map(|latitude| [longitude, latitude]);
        lines.push((line.collect(), (longitude, true)));
    }
    let count = (85.0 / step).floor() as i32;
    for i in -count..=count {
        let latitude = f64::from(i) * step;
        let line = fine(-180.0, 180.0).map(|longitude| [longitude, latitude]);
        lines.push((line.collect(), (latitude, false)));
    }
    lines
}

impl FromStr for MapWords {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut words = Self::default();
        for word in text.split(',') {
            let (name, number) = match word.split_once('=') {
                Some((name, number)) => (name, Some(number)),
                None => (word, None),
            };
            match (name, number) {
                ("coast", None) => words.coast = true,
                ("borders", None) => words.borders = true,
                ("terrain", None) => words.terrain = true,
                ("graticule", None) => words.graticule = Some(0.0),
                ("graticule", Some(number)) => {
                    let degrees = number.parse().ok();
                    let degrees = degrees.filter(|n: &f64| (0.1..=90.0).contains(n));
                    words.graticule = Some(degrees.ok_or_else(|| {
                        format!("graticule: wanted 0.1 to 90 degrees, found {number}")
                    })?);
                }
                _ => {
                    return Err(format!(
                        "wanted coast, borders, graticule, graticule=DEG or terrain, found {word:?}"
                    ));
                }
            }
        }
        Ok(words)
    }
}

impl fmt::Display for MapWords {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let graticule = self.graticule.map(|degrees| match degrees > 0.0 {
            true => format!("graticule={degrees}"),
            false => "graticule".to_owned(),
        });
        let words = [
            self.coast.then(|| "coast".to_owned()),
            self.borders.then(|| "borders".to_owned()),
            graticule,
            self.terrain.then(|| "terrain".to_owned()),
        ];
        let words: Vec<String> = words.into_iter().flatten().collect();
        f.write_str(&words.join(","))
    }
}

impl TryFrom<String> for MapWords {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<MapWords> for String {
    fn from(words: MapWords) -> Self {
        words.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;

    #[test]
    fn a_thin_line_stays_within_a_length_of_the_whole_one_and_keeps_its_ends() {
        let whole: Vec<[f64; 2]> = (0..=1000)
            .map(|i| f64::from(i) * 0.01)
            .map(|x| [x, (3.0 * x).sin()])
            .collect();
        let mut thinned = whole.clone();
        thin(&mut thinned, 0.25);
        assert!(
            thinned.len() < 120 && thinned.len() > 40,
            "{}",
            thinned.len()
        );
        assert_eq!(thinned.first(), whole.first());
        assert_eq!(thinned.last(), whole.last());
        for [x, y] in &whole {
            let near = |[a, b]: &[f64; 2]| (x - a).hypot(y - b) < 0.25;
            assert!(thinned.iter().any(near), "{x}");
        }
    }

    #[test]
    fn a_margin_goes_no_farther_than_around_the_earth() {
        let area = |columns: u32, turn_length| {
            let grid = Grid {
                dims: [columns, 100, 3],
                world_from_voxel: DAffine3::IDENTITY,
            };
            let Area { low, high, .. } = Area::around(&grid, turn_length);
            [[low[0], high[0]], [low[1], high[1]]]
        };
        // A unit a degree: the whole Earth, nearly all of it, and a part.
        assert_eq!(area(360, Some(360.0)), [[0.0, 360.0], [-72.0, 172.0]]);
        assert_eq!(area(350, Some(360.0))[0], [-5.0, 355.0]);
        assert_eq!(area(100, Some(360.0))[0], [-20.0, 120.0]);
        assert_eq!(area(370, Some(360.0))[0], [0.0, 370.0]);
        assert_eq!(area(360, None)[0], [-72.0, 432.0]);
    }
}
