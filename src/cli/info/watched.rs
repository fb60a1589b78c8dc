//! A source that tells how much of it was read.

use crate::{
    cli::progress::Progress,
    volume::{Header, Piece, ReadError, Source, TimeComponent, VoxelBox},
};
use std::{
    ops::ControlFlow,
    path::Path,
    sync::atomic::{AtomicU64, Ordering},
};

/// The source, and who is told.
pub struct Watched<'a> {
    source: Box<dyn Source>,
    progress: &'a Progress,
    /// Voxels that will be read, those that are read twice counted twice.
    all: u64,
    done: AtomicU64,
}

impl<'a> Watched<'a> {
    /// Tells of `all` voxels, those that are read twice counted twice.
    pub fn new(source: Box<dyn Source>, progress: &'a Progress, all: u64) -> Self {
        progress.stage("read", 0, 1);
        Self {
            source,
            progress,
            all,
            done: AtomicU64::new(0),
        }
    }

    fn tell(&self, piece: &Piece) {
        let more = piece.voxels.len() as u64;
        let done = self.done.fetch_add(more, Ordering::Relaxed) + more;
        self.progress
            .part((done as f64 / self.all.max(1) as f64).min(1.0));
    }
}

impl Source for Watched<'_> {
    fn path(&self) -> &Path {
        self.source.path()
    }

    fn header(&self) -> &Header {
        self.source.header()
    }

    fn reads_parts(&self) -> bool {
        self.source.reads_parts()
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let piece = self.source.read(pick, region)?;
        self.tell(&piece);
        Ok(piece)
    }

    fn read_slabs(
        &self,
        pick: TimeComponent,
        region: VoxelBox,
        slices: u32,
        take: &mut dyn FnMut(VoxelBox, Piece) -> ControlFlow<()>,
    ) -> Result<(), ReadError> {
        self.source
            .read_slabs(pick, region, slices, &mut |slab, piece| {
                self.tell(&piece);
                take(slab, piece)
            })
    }
}
