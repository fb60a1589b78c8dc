//! A source with further notes in its header.

use crate::volume::{Header, Piece, ReadError, Source, TimeComponent, VoxelBox};
use std::path::Path;

/// `source` with the notes that `notes` has of the variable it reads.
pub(super) fn with_notes(
    source: Box<dyn Source>,
    notes: impl FnOnce(&str) -> Vec<String>,
) -> Box<dyn Source> {
    let asked = source.header().variables.first();
    let name = asked
        .and_then(|asked| asked.split('[').next())
        .unwrap_or("");
    let notes = notes(name.trim());
    if notes.is_empty() {
        return source;
    }
    let mut header = source.header().clone();
    header.notes.extend(notes);
    Box::new(Noted { source, header })
}

struct Noted {
    source: Box<dyn Source>,
    header: Header,
}

impl Source for Noted {
    fn path(&self) -> &Path {
        self.source.path()
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        self.source.read(pick, region)
    }

    fn read_bytes(
        &self,
        pick: TimeComponent,
        region: VoxelBox,
    ) -> Result<Option<Vec<u8>>, ReadError> {
        self.source.read_bytes(pick, region)
    }
}
