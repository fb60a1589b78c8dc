//! Files of lines.
//!
//! ```text
//! .vtp   VTK PolyData: a polyline a piece        .csv   a row a vertex        .glb   tubes with colours
//! ```

mod csv;
mod tubes;
mod vtp;

pub use csv::{Geography, Upright, write_csv};
pub use tubes::tubes;
pub use vtp::write_vtp;

/// A number at each vertex of each line.
#[derive(Clone, Debug, PartialEq)]
pub struct LineValues {
    /// What it is called: `speed`, or the name of a variable.
    pub name: String,
    /// One list a line, as long as its vertices; NaN where there is no number.
    pub numbers: Vec<Vec<f64>>,
}

impl LineValues {
    /// The true speed of each vertex, m/s where that is known.
    pub fn speeds(lines: &[super::Line]) -> Self {
        let speeds = |line: &super::Line| line.vertices.iter().map(|v| v.speed).collect();
        Self {
            name: "speed".to_owned(),
            numbers: lines.iter().map(speeds).collect(),
        }
    }
}

#[cfg(test)]
mod tests;
