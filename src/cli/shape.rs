//! What a file of `--with` holds that is no volume: a surface or scattered points, read once.
//!
//! ```text
//! .csv .tsv .vtp   points;   .stl .glb  a surface;   .ply  a surface where it has faces, else points
//! ```

use super::{Error, flags::WithWord};
use crate::format::mesh::{MeshFile, is_mesh, read_mesh};
use crate::format::points::{PointColumns, PointFile, open_points};
use crate::volume::Limits;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// What stands in such a file.
#[derive(Debug)]
pub enum Shape {
    /// Triangles.
    Surface(MeshFile),
    /// Places with values.
    Points(Box<PointFile>),
}

/// The same, read by whoever asks first. All are alike to those who compare words.
#[derive(Clone, Debug, Default)]
pub struct ShapeOnce(Arc<OnceLock<Shape>>);

impl PartialEq for ShapeOnce {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl WithWord {
    /// What the file holds.
    ///
    /// # Errors
    /// It cannot be read, or a key of the word is not of what it holds.
    pub fn shape(&self, limits: &Limits) -> Result<&Shape, Error> {
        if let Some(shape) = self.shape.0.get() {
            return Ok(shape);
        }
        let path = self.file().unwrap_or(Path::new(""));
        let shape = if is_mesh(path, limits)? {
            self.check_surface()?;
            Shape::Surface(read_mesh(path, limits)?)
        } else {
            let columns = PointColumns {
                value: self.variable.clone(),
                ..PointColumns::default()
            };
            Shape::Points(Box::new(open_points(path, &columns, limits)?))
        };
        Ok(self.shape.0.get_or_init(|| shape))
    }

    fn check_surface(&self) -> Result<(), Error> {
        let of_points = [
            ("variable", self.variable.is_some()),
            ("window", self.window.is_some()),
            ("colormap", self.colormap.is_some()),
        ];
        match of_points.into_iter().find(|(_, is_given)| *is_given) {
            Some((key, _)) => Err(Error::usage(
                format!(
                    "--with {}: {key} is of values, and a surface has none",
                    self.name()
                ),
                "--with FILE,color=orange colours a surface",
            )),
            None => Ok(()),
        }
    }
}
