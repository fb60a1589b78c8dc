//! A file of bricks (`src/format/bricked`), level by level: each level is made of the one before it, which is read
//! back.

use super::layout::Layout;
use super::numbers::{Bytes, Tally};
use super::rows::{DoneBricks, Row};
use super::{Selection, WriteVolumeError, Written};
use crate::format::bricked::{Bricks, Coding, Entry, Index, Level, MAGIC, checksum, stored_box};
use crate::format::convert::{Builder, Endian, to_u64};
use crate::volume::{
    Difference, Format, Header, Rescale, Source, TimeComponent, VoxelBox, Voxels, difference,
    halved, held, part_of,
};
use std::io::{Read, Seek, Write};

/// Voxels of its own along each side of a brick, and of its neighbours' on each side: what bricks on a device store.
pub(super) const SIDE: u32 = 120;
const HALO: u32 = 3;

/// Bytes of voxels that are read at once, where a brick is not more.
const PIECE_BYTES: u64 = 128 << 20;

/// What is written of a source.
struct Part<'a> {
    source: &'a dyn Source,
    selection: &'a Selection,
    layout: &'a Layout,
    tally: Tally,
}

impl Part<'_> {
    /// The numbers of a box of the file.
    fn read(&mut self, pick: TimeComponent, region: VoxelBox) -> Result<Voxels, WriteVolumeError> {
        let corner = self.selection.region.min;
        let moved = |at: [u32; 3]| {
            let mut at = at;
            for (n, first) in at.iter_mut().zip(corner) {
                *n = n.saturating_add(first);
            }
            at
        };
        let of_source = VoxelBox {
            min: moved(region.min),
            max: moved(region.max),
        };
        let pick = TimeComponent {
            time: pick.time.saturating_add(self.selection.times.start),
            component: pick
                .component
                .saturating_add(self.selection.components.start),
        };
        let piece = self.source.read(pick, of_source)?;
        self.tally.rounded = self.tally.rounded.saturating_add(piece.loss.changed);
        let voxels = Bytes::of(&piece.voxels);
        let bytes = self.layout.map.apply(voxels, &mut self.tally);
        let number = self.layout.number;
        let count = bytes.len().checked_div(number.bytes()).unwrap_or(0);
        let mut builder = Builder::new(number, Endian::Little, count);
        let no_memory = |_| WriteVolumeError::NoRoom("there is no memory for a piece".to_owned());
        builder.push(&bytes, 1).map_err(no_memory)?;
        Ok(builder.finish().voxels)
    }
}

/// How the work goes on.
pub(super) struct Course<'a> {
    /// Bricks that are in the file already.
    pub done: DoneBricks,
    /// Hears of each row that is.
    pub note: &'a mut dyn FnMut(&str) -> std::io::Result<()>,
    /// Hears how many bricks are done of how many.
    pub progress: &'a mut dyn FnMut(usize, usize),
}

/// Writes all levels.
pub(super) fn write(
    source: &dyn Source,
    selection: &Selection,
    layout: &Layout,
    out: impl Read + Write + Seek,
    course: Course,
) -> Result<Written, WriteVolumeError> {
    let from = source.header();
    let mut header = Header::new(
        Format::Bricks,
        layout.dims,
        layout.number,
        layout.world_from_voxel,
    );
    header.components = layout.components;
    header.times = layout.times;
    header.rescale = layout.rescale;
    // Floats say it themselves, and other numbers than those that are stored have none.
    let is_kept = layout.map.rescale == Rescale::default() && layout.map.window.is_none();
    let is_said = is_kept && !layout.number.is_float();
    header.fill = from.fill.filter(|_| is_said);
    header.unit = layout.unit.clone();
    header.hounsfield = layout.is_hounsfield;
    header.is_labels = layout.is_labels;
    header.is_earth = from.is_earth;
    // Bricks keep no pole, and degrees from another one are none of the Earth.
    header.degree_lengths = from.earth_degree_lengths();
    header.long_name = from.long_name.clone();
    header.is_patient = from.is_patient;
    header.length_metres = from.length_metres;
    let index = Index {
        header,
        side: SIDE,
        halo: HALO,
        has_holes: false,
        levels: Vec::new(),
    };
    let dims = level_dims(layout.dims);
    let volumes = u64::from(layout.times).saturating_mul(layout.components.into());
    let bricks = |dims: &[u32; 3]| Level::new(*dims).brick_count(SIDE).saturating_mul(volumes);
    let of = dims.iter().map(bricks).fold(0, u64::saturating_add);
    let mut writer = Writer {
        bricks: Bricks::new(out, index),
        done: 0,
        of: usize::try_from(of).unwrap_or(usize::MAX),
        course,
    };
    writer.bricks.begin(MAGIC)?;
    let mut part = Part {
        source,
        selection,
        layout,
        tally: Tally::default(),
    };
    for (level, dims) in (0_u32..).zip(dims) {
        writer.add_level(level, dims, &mut part)?;
    }
    writer.bricks.end()?;
    let mut notes = layout.notes.clone();
    notes.extend(part.tally.notes(layout.number));
    Ok(Written {
        notes,
        voxel_bytes: layout.voxel_bytes().unwrap_or(u64::MAX),
    })
}

/// Whether a file of bricks of such a volume has coarser levels.
#[cfg(feature = "cli")]
pub(crate) fn has_coarser_levels(dims: [u32; 3]) -> bool {
    level_dims(dims).len() > 1
}

/// From the volume to what fits into one brick.
fn level_dims(dims: [u32; 3]) -> Vec<[u32; 3]> {
    let mut all = vec![dims];
    let mut dims = dims;
    while dims.iter().any(|&n| n > SIDE) {
        dims = dims.map(|n| n.div_ceil(2));
        all.push(dims);
    }
    all
}

struct Writer<'a, W> {
    bricks: Bricks<W>,
    done: usize,
    of: usize,
    course: Course<'a>,
}

impl<W: Read + Write + Seek> Writer<'_, W> {
    fn add_level(
        &mut self,
        level: u32,
        dims: [u32; 3],
        part: &mut Part,
    ) -> Result<(), WriteVolumeError> {
        let (times, components) = (part.layout.times, part.layout.components);
        let mut made = Level::new(dims);
        let mut apart = Difference::default();
        for time in 0..times {
            for component in 0..components {
                let pick = TimeComponent { time, component };
                for row in rows(dims, part.layout.number.bytes()) {
                    let more = match self.course.done.rows.pop_front() {
                        Some(done) => self.take_row(done, row.len(), part, &mut made)?,
                        None => self.add_row(level, pick, &row, part, &mut made)?,
                    };
                    apart = apart.and(more);
                }
            }
        }
        let before = level.checked_sub(1).and_then(|before| {
            let before = self.bricks.index().levels.get(before as usize)?;
            Some(before.error)
        });
        let [largest, rms] = before.unwrap_or([0.0; 2]);
        #[allow(clippy::arithmetic_side_effects, reason = "f64: nothing wraps")]
        let error = [largest + apart.largest, rms + apart.root_mean_square()];
        made.error = error;
        self.bricks.add_level(made);
        Ok(())
    }

    /// Those that are in the file.
    fn take_row(
        &mut self,
        done: Row,
        count: usize,
        part: &mut Part,
        made: &mut Level,
    ) -> Result<Difference, WriteVolumeError> {
        if done.entries.len() != count {
            let found = done.entries.len();
            let problem = format!("a row of {count} bricks was noted with {found}");
            return Err(std::io::Error::new(std::io::ErrorKind::InvalidData, problem).into());
        }
        part.tally = done.tally;
        if done.has_holes {
            self.bricks.has_holes();
        }
        made.entries.extend(done.entries);
        self.done = self.done.saturating_add(count);
        (self.course.progress)(self.done, self.of);
        Ok(done.apart)
    }

    /// Neighbours along x.
    fn add_row(
        &mut self,
        level: u32,
        pick: TimeComponent,
        row: &[VoxelBox],
        part: &mut Part,
        made: &mut Level,
    ) -> Result<Difference, WriteVolumeError> {
        let dims = made.dims;
        let stored = |own: &VoxelBox| stored_box(*own, HALO, dims);
        let ends = row.first().map(stored).zip(row.last().map(stored));
        let Some((first, last)) = ends else {
            return Ok(Difference::default());
        };
        let region = VoxelBox {
            min: first.min,
            max: last.max,
        };
        let fill = self.bricks.index().header.fill;
        let is_labels = self.bricks.index().header.is_labels;
        let mut apart = Difference::default();
        let voxels = match level.checked_sub(1) {
            None => part.read(pick, region)?,
            Some(finer) => {
                let fine_dims = self.bricks.index().levels.get(finer as usize);
                let fine_dims = fine_dims.map_or(dims, |finer| finer.dims);
                let mut fine = VoxelBox {
                    min: region.min.map(|n| n.saturating_mul(2)),
                    max: region.max.map(|n| n.saturating_mul(2)),
                };
                for (end, dim) in fine.max.iter_mut().zip(fine_dims) {
                    *end = dim.min(*end);
                }
                let no_reading = |problem: crate::volume::Problem| {
                    WriteVolumeError::Write(std::io::Error::other(problem.to_string()))
                };
                let numbers = self.bricks.read(finer, pick, fine).map_err(no_reading)?;
                let coarse = halved(&numbers, fine.dims(), fill, is_labels);
                for own in row {
                    let own = within(*own, region);
                    let both = [&numbers, &coarse];
                    apart = apart.and(difference(both, fine.dims(), own, fill));
                }
                coarse
            }
        };
        for own in row {
            let of_row = within(stored(own), region);
            let brick = part_of(&voxels, region.dims(), of_row);
            let entry = self.append(&brick, fill)?;
            made.entries.push(entry);
            self.done = self.done.saturating_add(1);
            (self.course.progress)(self.done, self.of);
        }
        let first = made.entries.len().saturating_sub(row.len());
        let noted = Row {
            entries: made.entries.get(first..).unwrap_or_default().to_vec(),
            apart,
            tally: part.tally,
            has_holes: self.bricks.index().has_holes,
        };
        (self.course.note)(&noted.line())?;
        Ok(apart)
    }

    fn append(&mut self, brick: &Voxels, fill: Option<f64>) -> Result<Entry, WriteVolumeError> {
        let found = held(brick, fill);
        let Bytes { bytes, stored } = Bytes::of(brick);
        let (coding, bytes) = if found.is_same {
            let one = bytes.get(..stored.bytes()).unwrap_or_default();
            (Coding::Same, one.to_vec())
        } else {
            let packed = lz4_flex::block::compress(&bytes);
            match packed.len() < bytes.len() {
                true => (Coding::Lz4, packed),
                false => (Coding::Plain, bytes),
            }
        };
        let begins = self.bricks.append(&bytes)?;
        let [low, high] = found.range;
        if found.has_holes {
            self.bricks.has_holes();
        }
        let length = u32::try_from(bytes.len());
        Ok(Entry {
            begins,
            bytes: length
                .map_err(|_| WriteVolumeError::NoRoom("a brick is too large".to_owned()))?,
            coding,
            low,
            high,
            checksum: checksum(&bytes),
        })
    }
}

/// Own boxes of bricks, neighbours along x together as long as a piece of them fits.
fn rows(dims: [u32; 3], number_bytes: usize) -> Vec<Vec<VoxelBox>> {
    let [nx, ny, nz] = dims;
    let step = SIDE as usize;
    let around = u64::from(HALO.saturating_mul(2).saturating_add(SIDE));
    let brick_bytes = around
        .saturating_pow(3)
        .saturating_mul(to_u64(number_bytes));
    let most = PIECE_BYTES.checked_div(brick_bytes).unwrap_or(1).max(1);
    let most = usize::try_from(most).unwrap_or(usize::MAX);
    let own = |min: [u32; 3]| {
        let mut max = min.map(|n| n.saturating_add(SIDE));
        for (end, dim) in max.iter_mut().zip(dims) {
            *end = dim.min(*end);
        }
        VoxelBox { min, max }
    };
    let mut all = Vec::new();
    for z in (0..nz).step_by(step) {
        for y in (0..ny).step_by(step) {
            let row: Vec<_> = (0..nx).step_by(step).map(|x| own([x, y, z])).collect();
            all.extend(row.chunks(most).map(<[_]>::to_vec));
        }
    }
    all
}

/// `part` as it lies in `region`.
fn within(part: VoxelBox, region: VoxelBox) -> VoxelBox {
    let moved = |at: [u32; 3]| {
        let mut at = at;
        for (n, first) in at.iter_mut().zip(region.min) {
            *n = n.saturating_sub(first);
        }
        at
    };
    VoxelBox {
        min: moved(part.min),
        max: moved(part.max),
    }
}
