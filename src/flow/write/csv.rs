//! Lines as text: a row a vertex.
//!
//! ```text
//! line,time,x,y,z,lon,lat,height,value        s, world, degrees, m
//! line,time,x,y,z,lon,lat,level,value         where heights are not known: levels from 0 at the lowest
//! ```
//!
//! Numbers have all the digits that bring back the same f64. A piece of a line has a number of its own, so that no reader joins
//! two of them; what is not known is empty.

use super::LineValues;
use crate::flow::line::Line;
use std::fmt;
use std::io::{self, Write};

/// What places of the world are on the Earth.
#[derive(Clone, Copy, Default)]
pub struct Geography<'a> {
    /// Longitude and latitude in degrees of x and y of the world, where they are known.
    pub degrees: Option<&'a dyn Fn([f64; 2]) -> [f64; 2]>,
    /// What z is, where it is known.
    pub upright: Option<Upright>,
}

impl fmt::Debug for Geography<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known = self.degrees.map(|_| "known");
        let mut debug = f.debug_struct("Geography");
        debug.field("degrees", &known);
        debug.field("upright", &self.upright).finish()
    }
}

/// What z of the world is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Upright {
    /// A height; metres of a world length.
    Height(f64),
    /// The number of a level whose height is not known, 0 the lowest; world length from level to level.
    Level(f64),
}

impl Upright {
    /// The name of its column.
    fn name(self) -> &'static str {
        match self {
            Self::Height(_) => "height",
            Self::Level(_) => "level",
        }
    }

    /// The number of a world height, in metres or levels.
    fn of(self, z: f64) -> f64 {
        match self {
            Self::Height(metres) => z * metres,
            Self::Level(length) => z / length,
        }
    }
}

/// Writes the pieces of all lines.
///
/// # Errors
/// What `out` says.
pub fn write_csv(
    lines: &[Line],
    values: &LineValues,
    geography: Geography<'_>,
    out: &mut impl Write,
) -> io::Result<()> {
    let upright = geography.upright.map_or("height", Upright::name);
    writeln!(out, "line,time,x,y,z,lon,lat,{upright},value")?;
    let mut piece = 0;
    for (line, values) in lines.iter().zip(&values.numbers) {
        for range in line.piece_ranges() {
            for (vertex, value) in line.vertices[range.clone()].iter().zip(&values[range]) {
                let p = vertex.place;
                write!(out, "{piece},{},{},{},{},", vertex.time, p.x, p.y, p.z)?;
                match geography.degrees {
                    Some(degrees) => {
                        let [longitude, latitude] = degrees([p.x, p.y]);
                        // From -180 to 180.
                        let longitude = (longitude + 180.0).rem_euclid(360.0) - 180.0;
                        write!(out, "{longitude},{latitude},")?;
                    }
                    None => write!(out, ",,")?,
                }
                if let Some(upright) = geography.upright {
                    write!(out, "{}", upright.of(p.z))?;
                }
                match value.is_finite() {
                    true => writeln!(out, ",{value}")?,
                    false => writeln!(out, ",")?,
                }
            }
            piece += 1;
        }
    }
    Ok(())
}
