//! `--barbs`: winds of a regular grid of places as the symbols of station models.
//!
//! ```text
//! wind -> columns of the grid, STEP apart -> the height of the level, or of the ground where that is higher -> symbols
//! staff = 0.8 of the distance to the next barb, in the plane x y of the drawn world
//! ```
//!
//! Angles are those of the wind: what blows to the north-east points so, also where the map stretches degrees.

mod flags;
mod symbol;

pub use flags::{BarbFlags, BarbWords};

use super::film::FilmTime;
use super::flags::{FlowWord, WindWords};
use super::variable::Variables;
use super::wind::{self, Wind};
use crate::cli::{
    Error,
    flags::{InputFlags, LevelOrHeight},
    map::is_southern,
    progress::Progress,
};
use crate::flow::Absence;
use crate::geometry::{Corner, Geometry, Vertex};
use crate::volume::Heights;
use glam::DVec3;
use symbol::{Feathers, KNOT, axes};

/// How many there are, where nobody says how far apart.
const WANTED: f64 = 12.0 * 9.0;
/// Of the distance to the next one.
const STAFF: f64 = 0.8;
/// On the ground lines lie before broader ones of another brightness: so many radii, and nearer to the eye by this part of a
/// staff, so that none lies before the next feather.
const CASING_RADII: f64 = 1.9;
const BEFORE_CASING: f64 = 0.4;
/// Radius of lines: of the staff, and at least in pixels.
const RADIUS: f64 = 0.02;
const LEAST_RADIUS_PIXELS: f64 = 0.6;

/// Symbols in the drawn world, heights stretched.
#[derive(Clone, Debug, Default)]
pub(super) struct Barbs {
    all: Vec<Barb>,
    /// World length of a staff of length 1.
    staff: f64,
    /// Linear.
    color: [f32; 3],
    /// Of what lies below lines, where the ground has colours.
    casing: Option<[f32; 3]>,
    /// What they mean, and where they stand.
    pub words: String,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Barb {
    place: DVec3,
    feathers: Feathers,
    /// Along the staff, and to the side of feathers, in the plane.
    axes: [[f64; 2]; 2],
}

/// What barbs are made of.
pub(super) struct Request<'a> {
    pub words: BarbWords,
    pub input: &'a InputFlags,
    /// The variables of the wind, where they are said.
    pub wind: Option<WindWords>,
    pub stretch: DVec3,
    pub color: [f32; 3],
    pub casing: Option<[f32; 3]>,
    pub of_film: Option<FilmTime<'a>>,
    /// What was said of the file.
    pub said: &'a [String],
}

/// What is said of lines, said of barbs.
fn of_barbs(error: Error) -> Error {
    match error {
        Error::Usage { message, hint } => Error::Usage {
            message: message.replace("--flow: ", "--barbs: "),
            hint,
        },
        other => other,
    }
}

impl Barbs {
    /// Reads the wind, of which `of_wind` hears what was not said of it.
    pub fn read(
        request: &Request<'_>,
        of_wind: &Progress,
        progress: &Progress,
    ) -> Result<Self, Error> {
        let variables = Variables {
            input: request.input,
            limits: request.input.limits(),
        };
        let at = request.of_film.map(|film| film.time);
        let names = request.wind.as_ref();
        let said = Some(request.said);
        let wind = wind::read(&variables, names, FlowWord::Stream, at, said, of_wind);
        let wind = wind.map_err(of_barbs)?;
        let time = at.map_or(0.0, f64::fract);
        let place = request.words.place;
        let height = place.unwrap_or(LevelOrHeight::Level(0));
        let height = height.world_height(&wind.header, "--barbs")?;
        let columns = Columns::of(&wind, request.words.step);
        let is_southern = is_southern(&wind.header);
        let mut all = Vec::new();
        let mut missing = 0;
        for column in columns.all() {
            let found = match place {
                Some(_) => on_ground(&wind, time, at_height(&wind, column, height)),
                None => lowest(&wind, time, column),
            };
            let Some((place, [east, north])) = found else {
                missing += 1;
                continue;
            };
            all.push(Barb {
                place: request.stretch * place,
                feathers: Feathers::of_knots(east.hypot(north) / KNOT),
                axes: axes([east, north], is_southern(place)),
            });
        }
        if all.is_empty() {
            return Err(Error::usage(
                format!("--barbs {}: the wind has no data there", request.words),
                "--barbs stands at the lowest level with a wind",
            ));
        }
        let words = format!(
            "barbs: half 5, full 10, flag 50 kt, at {}",
            at_words(place, height, &wind, request.wind.as_ref())
        );
        let without = match missing {
            0 => String::new(),
            n => format!(", {n} places without data"),
        };
        progress.note(&format!(
            "{words}, every {} columns: {} barbs{without}",
            columns.step,
            all.len()
        ));
        Ok(Self {
            staff: STAFF * columns.distance(&wind),
            color: request.color,
            casing: request.casing,
            all,
            words,
        })
    }

    /// Adds them as they are drawn where a pixel has this world length and `to_eye` is the way from a place to the eye.
    pub fn add(&self, geometry: &mut Geometry, pixel: f64, to_eye: impl Fn(DVec3) -> DVec3) {
        let radius = (RADIUS * self.staff).max(LEAST_RADIUS_PIXELS * pixel);
        // Above what they stand on.
        let mut above = radius * DVec3::Z;
        let mut before = 0.0;
        if let Some(casing) = self.casing {
            let broad = CASING_RADII * radius;
            above = broad * DVec3::Z;
            before = BEFORE_CASING * self.staff;
            for barb in &self.all {
                self.add_lines(geometry, barb, |place| place + above, broad, casing);
            }
        }
        let moved = |place: DVec3| place + above + before * to_eye(place);
        for barb in &self.all {
            self.add_lines(geometry, barb, moved, radius, self.color);
            for flag in barb.feathers.symbol().flags {
                let corners = flag.map(|place| Corner {
                    place: moved(self.place(barb, place)),
                    color: self.color,
                });
                geometry.triangles.add(&corners, [[0, 1, 2]]);
            }
        }
    }

    /// Its lines and the edges of its flags, which are seen from the side too.
    fn add_lines(
        &self,
        geometry: &mut Geometry,
        barb: &Barb,
        moved: impl Fn(DVec3) -> DVec3,
        radius: f64,
        color: [f32; 3],
    ) {
        let vertex = |place| Vertex {
            place: moved(self.place(barb, place)),
            radius,
            color,
        };
        let symbol = barb.feathers.symbol();
        for line in symbol.lines {
            geometry.cones.add_line(line.into_iter().map(vertex));
        }
        for flag in symbol.flags {
            geometry.cones.add_line(flag.map(vertex));
        }
    }

    /// A place of a symbol.
    fn place(&self, barb: &Barb, [a, b]: [f64; 2]) -> DVec3 {
        let [along, side] = barb.axes;
        let [x, y] = [0, 1].map(|k| self.staff * (a * along[k] + b * side[k]));
        barb.place + DVec3::new(x, y, 0.0)
    }
}

/// Columns of the grid with a barb, as many left out before the first as behind the last.
struct Columns {
    dims: [u32; 2],
    step: u32,
}

impl Columns {
    fn of(wind: &Wind, step: Option<u32>) -> Self {
        let [nx, ny, _] = wind.grid.dims;
        let all = f64::from(nx) * f64::from(ny);
        let own = (all / WANTED).sqrt().round().max(1.0) as u32;
        Self {
            dims: [nx, ny],
            step: step.unwrap_or(own).max(1),
        }
    }

    fn all(&self) -> impl Iterator<Item = [u32; 2]> {
        let step = self.step;
        let along = self.dims.map(move |n| {
            let first = (n.saturating_sub(1) % step) / 2;
            (first..n).step_by(step as usize)
        });
        let [x, y] = along;
        y.flat_map(move |y| x.clone().map(move |x| [x, y]))
    }

    /// World length from barb to barb, the shorter way.
    fn distance(&self, wind: &Wind) -> f64 {
        let m = wind.grid.world_from_voxel.matrix3;
        f64::from(self.step) * m.x_axis.length().min(m.y_axis.length())
    }
}

/// The middle of a column at a height of the world.
fn at_height(wind: &Wind, [x, y]: [u32; 2], height: f64) -> DVec3 {
    let voxel = DVec3::new(f64::from(x) + 0.5, f64::from(y) + 0.5, 0.5);
    let mut place = wind.grid.world_from_voxel.transform_point3(voxel);
    place.z = height;
    place
}

/// A place of a barb, and the wind to the east and to the north there, m/s.
type Found = (DVec3, [f64; 2]);

/// The wind at a place, or on the ground above it.
fn on_ground(wind: &Wind, time: f64, place: DVec3) -> Option<Found> {
    let mut place = place;
    if let Some(ground) = wind.field.ground_height(place) {
        place.z = place.z.max(ground);
    }
    match wind.field.components(time, place) {
        Ok([east, north, _]) => Some((place, [east, north])),
        Err(Absence::Domain | Absence::Ground | Absence::NoData | Absence::Pole) => None,
    }
}

/// At the lowest level of a column that has a wind.
fn lowest(wind: &Wind, time: f64, column: [u32; 2]) -> Option<Found> {
    let m = wind.grid.world_from_voxel;
    let count = wind.grid.dims[2];
    let is_rising = m.matrix3.z_axis.z > 0.0;
    (0..count).find_map(|level| {
        let voxel = if is_rising { level } else { count - 1 - level };
        let middle = m.transform_point3(DVec3::new(0.5, 0.5, f64::from(voxel) + 0.5));
        on_ground(wind, time, at_height(wind, column, middle.z))
    })
}

/// Where they stand, in words: `level 0, 150 m`.
fn at_words(
    place: Option<LevelOrHeight>,
    height: f64,
    wind: &Wind,
    names: Option<&WindWords>,
) -> String {
    let header = &wind.header;
    // One layer may lie at any height: its name says which.
    if let (Some(names), 1) = (names, header.dims[2]) {
        return format!("the places of {} and {}", names.east, names.north);
    }
    let metres = header
        .height_metres()
        .filter(|_| header.heights != Heights::Pressures);
    let level = match place {
        None => "the lowest level".to_owned(),
        Some(LevelOrHeight::Level(level)) => LevelOrHeight::Level(level).words(),
        Some(height) => return height.words(),
    };
    match metres.filter(|_| header.is_earth) {
        Some(metres) => format!("{level}, {:.0} m", height * metres),
        None => level,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn some_twelve_by_nine_places_lie_in_the_middle() {
        for (dims, step, wanted) in [
            ([48, 48], None, [10, 10]),
            ([120, 90], None, [12, 9]),
            ([4, 3], None, [4, 3]),
            ([10, 10], Some(4), [3, 3]),
            ([10, 10], Some(40), [1, 1]),
        ] {
            let all = f64::from(dims[0]) * f64::from(dims[1]);
            let own = (all / WANTED).sqrt().round().max(1.0) as u32;
            let columns = Columns {
                dims,
                step: step.unwrap_or(own),
            };
            let found: Vec<_> = columns.all().collect();
            assert_eq!(found.len(), (wanted[0] * wanted[1]) as usize, "{dims:?}");
            for k in [0, 1] {
                let least = found.iter().map(|at| at[k]).min().expect("one");
                let most = found.iter().map(|at| at[k]).max().expect("one");
                let behind = dims[k] - 1 - most;
                assert!(
                    behind == least || behind == least + 1,
                    "{dims:?}: {least} {behind}"
                );
            }
        }
    }
}
