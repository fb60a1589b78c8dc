//! Numbers that are drawn as a stream.

#![allow(dead_code, reason = "each test program uses some of it")]

use crate::shared::{sheared_affine, volume_of};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use stratavox::offscreen::{Stream, StreamOptions};
use stratavox::volume::{
    Format, Header, Piece, ReadError, Source, TimeComponent, Volume, VoxelBox, VoxelType, Voxels,
};

/// Numbers in memory that are handed out in parts, and counted.
pub struct Numbers {
    pub header: Header,
    numbers: Vec<f32>,
    pub reads: AtomicUsize,
    has_rows: bool,
}

impl Numbers {
    pub fn of(dims: [u32; 3], fill: Option<f64>, field: impl Fn(glam::DVec3) -> f64) -> Self {
        Self::from(volume_of(dims, sheared_affine(), field), fill)
    }

    /// Of a volume of floats.
    pub fn from(volume: Volume, fill: Option<f64>) -> Self {
        let Voxels::F32(numbers) = volume.voxels else {
            unreachable!("fields are floats");
        };
        let header = Header {
            fill,
            ..Header::new(
                Format::Raw,
                volume.dims,
                VoxelType::F32,
                volume.world_from_voxel,
            )
        };
        Self {
            header,
            numbers,
            reads: AtomicUsize::new(0),
            has_rows: false,
        }
    }

    /// The same, read row by row.
    pub fn by_rows(self) -> Self {
        Self {
            has_rows: true,
            ..self
        }
    }

    pub fn in_memory(&self) -> Volume {
        let whole = self.header.whole();
        Volume::read(self, TimeComponent::default(), whole, &Default::default()).expect("a volume")
    }
}

impl Source for Numbers {
    fn path(&self) -> &Path {
        Path::new("numbers")
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn reads_whole_rows(&self) -> bool {
        self.has_rows
    }

    fn read(&self, _: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        self.reads.fetch_add(1, Ordering::Relaxed);
        let [nx, ny, _] = self.header.dims.map(|n| n as usize);
        let mut found = Vec::new();
        for z in region.min[2]..region.max[2] {
            for y in region.min[1]..region.max[1] {
                let row = (z as usize * ny + y as usize) * nx;
                let row = row + region.min[0] as usize..row + region.max[0] as usize;
                found.extend_from_slice(&self.numbers[row]);
            }
        }
        Ok(Voxels::F32(found).into())
    }
}

pub fn go_on(_: usize, _: usize) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

pub fn open(source: &Arc<Numbers>, options: StreamOptions) -> Stream {
    let source: Arc<dyn Source> = Arc::clone(source) as _;
    let stream = Stream::open(source, TimeComponent::default(), options, &mut go_on);
    stream.expect("readable").expect("not ended")
}
