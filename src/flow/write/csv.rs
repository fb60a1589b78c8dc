//! Lines as text: a row a vertex.
//!
//! ```text
//! line,time,x,y,z,lon,lat,height,value        s, world, degrees, m
//! ```
//!
//! Numbers have all the digits that bring back the same f64. A piece of a line has a number of its own, so that no reader joins
//! two of them; what is not known is empty.

use super::LineValues;
use crate::flow::line::Line;
use std::io::{self, Write};

/// What places of the world are on the Earth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Geography {
    /// World length of a degree of longitude along x and of latitude along y, where axes are degrees.
    pub degrees: Option<[f64; 2]>,
    /// Metres of a world length along z, where z is a height.
    pub height: Option<f64>,
}

/// Writes the pieces of all lines.
///
/// # Errors
/// What `out` says.
pub fn write_csv(
    lines: &[Line],
    values: &LineValues,
    geography: Geography,
    out: &mut impl Write,
) -> io::Result<()> {
    writeln!(out, "line,time,x,y,z,lon,lat,height,value")?;
    let mut piece = 0;
    for (line, values) in lines.iter().zip(&values.numbers) {
        for range in line.piece_ranges() {
            for (vertex, value) in line.vertices[range.clone()].iter().zip(&values[range]) {
                let p = vertex.place;
                write!(out, "{piece},{},{},{},{},", vertex.time, p.x, p.y, p.z)?;
                match geography.degrees {
                    Some([x, y]) => {
                        // From -180 to 180.
                        let longitude = (p.x / x + 180.0).rem_euclid(360.0) - 180.0;
                        write!(out, "{longitude},{},", p.y / y)?;
                    }
                    None => write!(out, ",,")?,
                }
                if let Some(metres) = geography.height {
                    write!(out, "{}", p.z * metres)?;
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
