//! Zarr, versions 2 and 3, and OME-NGFF: a folder of JSON and of chunks, each in a file of its own or in a shard.
//!
//! By zarr-specs.readthedocs.io, and ngff.openmicroscopy.org 0.4 and 0.5. Only chunks that meet the wanted box
//! are read. A chunk is decoded to exactly the bytes that its shape asks for, or not at all; one that is not
//! there holds the fill value.
//!
//! ```text
//! folder -> nodes (consolidated metadata, or the folders) -> arrays -> which is wanted, which axis is which
//!        -> chunks that meet the box -> codecs undone -> numbers put where they belong
//! ```

mod array;
mod blosc;
mod blosclz;
mod canvas;
mod chunk;
mod codec;
mod json;
mod multiscale;
#[cfg(feature = "netcdf")]
mod named;
mod ngff;
mod omero;
mod plain;
mod source;
mod store;
mod tree;
mod v2;
mod v3;

use super::problem::at;
use crate::volume::{Limits, ReadError, Source, VolumeSelection};
use ngff::Level;
use source::ArraySource;
use std::path::Path;
use store::Store;
use tree::Tree;

/// The word of errors.
const ZARR: &str = "zarr";

/// True for a folder that is a Zarr group or array.
pub(super) fn recognizes(folder: &Path) -> bool {
    tree::is_zarr(folder)
}

/// Opens an array of the folder: of a multiscale image the finest level that the limits allow.
pub(super) fn open(
    folder: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let store = Store::open(folder)?;
    let tree = Tree::read(&store, limits)?;
    let images = ngff::images(&tree);
    let level = ngff::choose(&tree, &images, wanted, limits).map_err(at(folder))?;
    #[cfg(feature = "netcdf")]
    if level.is_none() && named::has_names(&tree, limits) {
        return named::open(store, &tree, wanted, limits);
    }
    let Level {
        array,
        roles,
        header,
    } = match level {
        Some(level) => level,
        None => plain::choose(&tree, wanted, limits).map_err(at(folder))?,
    };
    let source = ArraySource {
        store,
        array,
        roles,
        header,
        limits: *limits,
    };
    Ok(Box::new(source.with_notes()))
}
