//! A box of voxels from the bricks that it lies in.

use super::index::FRONT_BYTES;
use super::{BRICKS, Coding, Entry, Index, Level, checksum};
use crate::fence::fenced;
use crate::format::convert::{Builder, Endian, to_u64};
use crate::format::problem;
use crate::volume::{Problem, TimeComponent, VoxelBox, Voxels};
use std::io::{Read, Seek, SeekFrom, Write};
use std::sync::{Mutex, PoisonError};

/// Bricks in a file, one read at a time.
#[derive(Debug)]
pub(crate) struct Bricks<F> {
    file: Mutex<F>,
    index: Index,
}

/// LZ4's longest runs.
const MOST_EXPANSION: u64 = 255;

impl<F: Read + Seek> Bricks<F> {
    pub(crate) fn new(file: F, index: Index) -> Self {
        Self {
            file: Mutex::new(file),
            index,
        }
    }

    pub(crate) fn index(&self) -> &Index {
        &self.index
    }

    /// The stored numbers of a region of a level, which it lies in.
    pub(crate) fn read(
        &self,
        level: u32,
        pick: TimeComponent,
        region: VoxelBox,
    ) -> Result<Voxels, Problem> {
        let index = &self.index;
        let missing = || problem::missing(BRICKS, "level");
        let dims = index.levels.get(level as usize).ok_or_else(missing)?.dims;
        let entries = index.entries_of(level, pick).ok_or_else(missing)?;
        let number_bytes = index.header.stored.bytes();
        let count = sides(region)
            .iter()
            .fold(number_bytes, |n, &side| n.saturating_mul(side));
        let mut canvas = Vec::new();
        canvas
            .try_reserve_exact(count)
            .map_err(|_| Problem::Limit {
                what: "the voxels".to_owned(),
                wanted_bytes: to_u64(count),
                limit_bytes: 0,
            })?;
        canvas.resize(count, 0);
        for (own, entry) in bricks_in(dims, index.side, region).zip_entries(entries) {
            let stored = stored_box(own, index.halo, dims);
            // A brick that stores all of the region needs no other.
            let is_all = (0..3).all(|k| {
                let ends = |b: VoxelBox| (b.min.get(k).copied(), b.max.get(k).copied());
                let ((a, b), (c, d)) = (ends(stored), ends(region));
                a <= c && d <= b
            });
            let part = if is_all { region } else { meet(own, region) };
            // One number is not made more than are wanted.
            let from = match entry.coding {
                Coding::Same => part,
                Coding::Plain | Coding::Lz4 => stored,
            };
            let numbers = self.decoded(&entry, from, number_bytes)?;
            copy(&numbers, from, &mut canvas, region, part, number_bytes);
            if is_all {
                break;
            }
        }
        let mut builder = Builder::new(
            index.header.stored,
            Endian::Little,
            count.checked_div(number_bytes).unwrap_or(0),
        );
        builder.push(&canvas, 1)?;
        Ok(builder.finish().voxels)
    }

    /// The bytes of the numbers of a brick, or of so many that are the same.
    fn decoded(
        &self,
        entry: &Entry,
        stored: VoxelBox,
        number_bytes: usize,
    ) -> Result<Vec<u8>, Problem> {
        let count = sides(stored)
            .iter()
            .fold(number_bytes, |n, &side| n.saturating_mul(side));
        let wanted = match entry.coding {
            Coding::Same => to_u64(number_bytes),
            Coding::Plain => to_u64(count),
            Coding::Lz4 => u64::from(entry.bytes),
        };
        let most = u64::from(entry.bytes).saturating_mul(MOST_EXPANSION);
        if wanted != u64::from(entry.bytes) || entry.coding == Coding::Lz4 && most < to_u64(count) {
            return Err(Problem::TooFewEncoded {
                format: BRICKS,
                encoding: match entry.coding {
                    Coding::Lz4 => "lz4",
                    Coding::Plain | Coding::Same => "raw",
                },
                wanted_bytes: to_u64(count),
                encoded_bytes: entry.bytes.into(),
            });
        }
        let mut bytes = Vec::new();
        {
            let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            file.seek(SeekFrom::Start(entry.begins))
                .and_then(|_| {
                    let mut part = (&mut *file).take(entry.bytes.into());
                    part.read_to_end(&mut bytes)
                })
                .map_err(problem::io("reading a brick"))?;
        }
        if to_u64(bytes.len()) != u64::from(entry.bytes) {
            return Err(Problem::Size {
                format: BRICKS,
                wanted_bytes: entry.bytes.into(),
                found_bytes: to_u64(bytes.len()),
            });
        }
        if checksum(&bytes) != entry.checksum {
            let found = checksum(&bytes);
            let wanted = entry.checksum;
            return Err(damaged(format!(
                "a brick has the checksum {found:08x}, not {wanted:08x}"
            )));
        }
        match entry.coding {
            Coding::Plain => Ok(bytes),
            Coding::Same => {
                let times = count.checked_div(number_bytes).unwrap_or(0);
                Ok(bytes.repeat(times))
            }
            Coding::Lz4 => {
                let mut numbers = vec![0; count];
                // The decoder is not ours.
                let outcome = fenced(|| {
                    lz4_flex::block::decompress_into(&bytes, &mut numbers)
                        .map_err(|error| error.to_string())
                });
                let found = match outcome {
                    Ok(Ok(found)) => found,
                    Ok(Err(cause)) | Err(cause) => return Err(damaged(cause)),
                };
                match found == count {
                    true => Ok(numbers),
                    false => Err(damaged(format!("a brick holds {found} bytes, not {count}"))),
                }
            }
        }
    }
}

fn damaged(cause: String) -> Problem {
    Problem::Damaged {
        format: BRICKS,
        encoding: "lz4",
        decoded_bytes: 0,
        cause,
    }
}

impl<W: Read + Write + Seek> Bricks<W> {
    /// The front, which says nothing yet.
    pub(crate) fn begin(&mut self, magic: &[u8]) -> std::io::Result<()> {
        let mut front = magic.to_vec();
        front.resize(usize::try_from(FRONT_BYTES).unwrap_or(0), 0);
        let file = self.file.get_mut().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(0))?;
        file.write_all(&front)
    }

    /// Bytes behind all others; gives where they begin.
    pub(crate) fn append(&mut self, bytes: &[u8]) -> std::io::Result<u64> {
        let file = self.file.get_mut().unwrap_or_else(PoisonError::into_inner);
        let begins = file.seek(SeekFrom::End(0))?;
        file.write_all(bytes)?;
        Ok(begins)
    }

    pub(crate) fn add_level(&mut self, level: Level) {
        self.index.levels.push(level);
    }

    /// Some voxel holds no data.
    pub(crate) fn has_holes(&mut self) {
        self.index.has_holes = true;
    }

    /// The index, and the front that says where it is.
    pub(crate) fn end(&mut self) -> std::io::Result<()> {
        let index = self.index.bytes();
        let begins = self.append(&index)?;
        let file = self.file.get_mut().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(16))?;
        file.write_all(&begins.to_le_bytes())?;
        file.write_all(&to_u64(index.len()).to_le_bytes())?;
        file.flush()
    }
}

/// Own boxes of bricks, and which they are.
struct InRegion(Vec<(usize, VoxelBox)>);

impl InRegion {
    fn zip_entries(self, entries: &[Entry]) -> impl Iterator<Item = (VoxelBox, Entry)> {
        let known = self.0.into_iter();
        known.filter_map(|(number, own)| Some((own, *entries.get(number)?)))
    }
}

/// The bricks whose own voxels meet a region, that of its middle first.
fn bricks_in(dims: [u32; 3], side: u32, region: VoxelBox) -> InRegion {
    let side = side.max(1);
    let [nx, ny, _] = dims.map(|n| u64::from(n.div_ceil(side)));
    let range = |k: usize| {
        let of = |corner: [u32; 3]| corner.get(k).copied().unwrap_or(0);
        let first = of(region.min).checked_div(side).unwrap_or(0);
        first..of(region.max).div_ceil(side)
    };
    let mut found = Vec::new();
    for z in range(2) {
        for y in range(1) {
            for x in range(0) {
                let row = u64::from(z).saturating_mul(ny).saturating_add(y.into());
                let number = row.saturating_mul(nx).saturating_add(x.into());
                let min = [x, y, z].map(|n| n.saturating_mul(side));
                let end = |k: usize| {
                    let of = |corner: [u32; 3]| corner.get(k).copied().unwrap_or(0);
                    of(min).saturating_add(side).min(of(dims))
                };
                let own = VoxelBox {
                    min,
                    max: [end(0), end(1), end(2)],
                };
                found.push((usize::try_from(number).unwrap_or(usize::MAX), own));
            }
        }
    }
    let middle = found.len().checked_div(2).unwrap_or(0);
    if middle > 0 {
        found.swap(0, middle);
    }
    InRegion(found)
}

/// A brick's own voxels and those around.
pub(crate) fn stored_box(own: VoxelBox, halo: u32, dims: [u32; 3]) -> VoxelBox {
    let mut stored = VoxelBox {
        min: own.min.map(|n| n.saturating_sub(halo)),
        max: own.max.map(|n| n.saturating_add(halo)),
    };
    for (end, dim) in stored.max.iter_mut().zip(dims) {
        *end = dim.min(*end);
    }
    stored
}

fn meet(a: VoxelBox, b: VoxelBox) -> VoxelBox {
    let mut part = a;
    for ((low, high), (min, max)) in part
        .min
        .iter_mut()
        .zip(&mut part.max)
        .zip(b.min.into_iter().zip(b.max))
    {
        *low = min.max(*low);
        *high = max.min(*high).max(*low);
    }
    part
}

fn sides(region: VoxelBox) -> [usize; 3] {
    let [x, y, z] = region.min;
    let [to_x, to_y, to_z] = region.max;
    [(x, to_x), (y, to_y), (z, to_z)].map(|(from, to)| to.saturating_sub(from) as usize)
}

/// Copies the rows of `part`, which lies in both boxes.
fn copy(
    numbers: &[u8],
    from: VoxelBox,
    canvas: &mut [u8],
    to: VoxelBox,
    part: VoxelBox,
    number_bytes: usize,
) {
    let place = |whole: VoxelBox, [x, y, z]: [u32; 3]| {
        let [nx, ny, _] = sides(whole);
        let [x0, y0, z0] = whole.min;
        let at = |n: u32, first: u32| n.saturating_sub(first) as usize;
        let row = at(z, z0).saturating_mul(ny).saturating_add(at(y, y0));
        let number = row.saturating_mul(nx).saturating_add(at(x, x0));
        number.saturating_mul(number_bytes)
    };
    let [x, first_y, first_z] = part.min;
    let [_, end_y, end_z] = part.max;
    let [length, ..] = sides(part);
    let bytes = length.saturating_mul(number_bytes);
    for z in first_z..end_z {
        for y in first_y..end_y {
            let (source, target) = (place(from, [x, y, z]), place(to, [x, y, z]));
            let row = numbers.get(source..source.saturating_add(bytes));
            let out = canvas.get_mut(target..target.saturating_add(bytes));
            if let (Some(row), Some(out)) = (row, out) {
                out.copy_from_slice(row);
            }
        }
    }
}
