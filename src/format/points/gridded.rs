//! The volume of points by interpolation, in place of that of their means.

use super::PointFile;
use crate::points::interpolate::{GridSize, Interpolation, Method, NoField, Options};
use crate::volume::Grid;
use std::sync::{Arc, OnceLock};

impl PointFile {
    /// The same file as the volume of an interpolation on a grid that takes at most `max_bytes`. Voxels without data are
    /// NaN; what was chosen is among [`crate::volume::Header::notes`]. They are made by
    /// [`prepare`](crate::volume::Source::prepare), or when they are first read.
    ///
    /// # Errors
    /// [`NoField`] where there are too few points for the method, they lie on one line, the grid is too large, or a length
    /// is none.
    pub fn interpolated(
        mut self,
        options: &Options,
        size: GridSize,
        max_bytes: u64,
    ) -> Result<Self, NoField> {
        let points = Arc::clone(&self.points);
        let field = Interpolation::new(&points, options)?;
        let grid = field.grid(size, max_bytes)?;
        self.header.dims = grid.dims;
        self.header.world_from_voxel = grid.world_from_voxel;
        if options.method == Method::Density {
            self.header.long_name = Some("density of points".to_owned());
            self.header.unit = None;
        }
        // The columns that are not read are no other volumes of this one.
        self.header.variables.truncate(1);
        self.notes.extend(notes(&field, &grid, options));
        self.header.notes.clone_from(&self.notes);
        self.voxels = OnceLock::new();
        self.on_grid = Some((field, grid));
        Ok(self)
    }
}

fn notes(field: &Interpolation, grid: &Grid, options: &Options) -> Vec<String> {
    let [nx, ny, nz] = grid.dims;
    let [dx, dy, dz] = grid.spacing().map(short);
    let mut notes = vec![format!(
        "the volume is the points interpolated by {} on {nx} x {ny} x {nz} voxels of {dx} x {dy} x {dz}, with {}",
        options.method,
        match options.method {
            Method::Density => format!("a kernel of radius {}", short(field.reach())),
            _ => format!(
                "no data farther than {} from all points",
                short(field.reach())
            ),
        }
    )];
    if options.anisotropy != 1.0 {
        let times = short(options.anisotropy);
        notes.push(format!("heights count {times} times in distances"));
    }
    if field.is_plane() {
        notes.push("all points lie in one plane: the volume is one layer thick".to_owned());
    }
    match field.merged_places() {
        0 => {}
        1 => {
            notes.push("at 1 place there are several points: their mean is taken there".to_owned())
        }
        n => notes.push(format!(
            "at {n} places there are several points: their mean is taken there"
        )),
    }
    notes
}

/// To four digits.
fn short(number: f64) -> f64 {
    format!("{number:.3e}").parse().unwrap_or(number)
}
