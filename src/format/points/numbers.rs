//! Numbers of arrays as f64.

use crate::format::convert::{Endian, decoded};
use crate::format::file_source::FileSource;
use crate::volume::{ReadError, Source, TimeComponent};

/// All numbers of one component, not rounded as voxels are.
pub(super) fn component(source: &FileSource, component: u32) -> Result<Vec<f64>, ReadError> {
    let header = source.header();
    let pick = TimeComponent { time: 0, component };
    let bytes = source.read_bytes(pick, header.whole())?.unwrap_or_default();
    let each = bytes.chunks_exact(header.stored.bytes());
    Ok(each
        .map(|number| decoded(number, header.stored, Endian::Little))
        .collect())
}
