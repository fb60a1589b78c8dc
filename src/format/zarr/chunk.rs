//! The chunks of an array that meet a box, decoded one at a time.

use super::ZARR;
use super::array::{Array, Shards};
use super::codec::{decode, most_encoded, without_checksum};
use super::store::{Store, Value};
use crate::format::convert::{Endian, to_u64};
use crate::format::problem::at;
use crate::volume::{Limits, Problem, ReadError};

/// A box of an array: from `low` (included) to `high` (excluded) along each axis.
#[derive(Clone, Debug)]
pub(super) struct Range {
    pub low: Vec<u64>,
    pub high: Vec<u64>,
}

/// One decoded chunk.
pub(super) struct Unit<'a> {
    /// Where its first number lies in the array.
    pub origin: &'a [u64],
    /// The numbers as they are stored, those beyond the end of the array too.
    pub bytes: &'a [u8],
}

impl Range {
    /// All of an array.
    pub(super) fn whole(array: &Array) -> Self {
        Self {
            low: vec![0; array.rank()],
            high: array.shape.clone(),
        }
    }

    /// What it has in common with the box of `sides` at `origin`; empty where there is nothing.
    pub(super) fn meet(&self, origin: &[u64], sides: &[u64]) -> Option<Self> {
        let ends = origin.iter().zip(sides).map(|(o, s)| o.saturating_add(*s));
        let meet = Self {
            low: self
                .low
                .iter()
                .zip(origin)
                .map(|(a, b)| *a.max(b))
                .collect(),
            high: self
                .high
                .iter()
                .zip(ends)
                .map(|(a, b)| (*a).min(b))
                .collect(),
        };
        let is_empty = meet.low.iter().zip(&meet.high).any(|(a, b)| a >= b);
        (!is_empty).then_some(meet)
    }

    /// The boxes of a grid of `sides` that it meets, as a range of their indices.
    pub(super) fn in_grid(&self, sides: &[u64]) -> Self {
        let first = |(low, side): (&u64, &u64)| low.checked_div(*side).unwrap_or(0);
        Self {
            low: self.low.iter().zip(sides).map(first).collect(),
            high: self
                .high
                .iter()
                .zip(sides)
                .map(|(high, side)| high.div_ceil(*side))
                .collect(),
        }
    }

    /// How many indices there are.
    pub(super) fn count(&self) -> u64 {
        let sides = self.low.iter().zip(&self.high);
        sides.fold(1, |count: u64, (low, high)| {
            count.saturating_mul(high.saturating_sub(*low))
        })
    }

    /// Every index, the last axis running fastest.
    pub(super) fn indices(&self) -> impl Iterator<Item = Vec<u64>> + '_ {
        let mut next = (self.count() > 0).then(|| self.low.clone());
        std::iter::from_fn(move || {
            let current = next.take()?;
            let mut following = current.clone();
            for ((here, low), high) in following.iter_mut().zip(&self.low).zip(&self.high).rev() {
                *here = here.saturating_add(1);
                if *here < *high {
                    next = Some(following);
                    break;
                }
                *here = *low;
            }
            Some(current)
        })
    }
}

/// Where the box of a grid of `sides` with the index `index` begins.
fn origin_of(index: &[u64], sides: &[u64]) -> Vec<u64> {
    index
        .iter()
        .zip(sides)
        .map(|(i, side)| i.saturating_mul(*side))
        .collect()
}

/// An error where more files would have to be looked for than the limits allow.
pub(super) fn check_files(
    store: &Store,
    array: &Array,
    range: &Range,
    limits: &Limits,
) -> Result<(), ReadError> {
    let count = range.in_grid(&array.chunk).count();
    if count <= to_u64(limits.max_files) {
        return Ok(());
    }
    Err(at(&store.shown(&array.path))(Problem::Invalid {
        format: ZARR,
        field: "chunk shape".to_owned(),
        wanted: format!("at most {} files for the wanted box", limits.max_files),
        found: count.to_string(),
    }))
}

/// Hands every chunk that meets `range` to `each`, decoded. What is not there is left out.
pub(super) fn visit(
    store: &Store,
    array: &Array,
    range: &Range,
    limits: &Limits,
    each: &mut dyn FnMut(&Unit) -> Result<(), Problem>,
) -> Result<(), ReadError> {
    check_files(store, array, range, limits)?;
    let chunks = range.in_grid(&array.chunk);
    for index in chunks.indices() {
        let Some(mut file) = store.find(&array.key(&index))? else {
            continue;
        };
        let origin = origin_of(&index, &array.chunk);
        match &array.shards {
            None => {
                let bytes = file.bytes;
                let decoded = decoded(&mut file, 0, bytes, array)?;
                let unit = Unit {
                    origin: &origin,
                    bytes: &decoded,
                };
                each(&unit).map_err(at(&file.path))?;
            }
            Some(shards) => visit_shard(&mut file, array, shards, (&origin, range), each)?,
        }
    }
    Ok(())
}

/// The same for the chunks in one shard, which lies at `origin`.
fn visit_shard(
    file: &mut Value,
    array: &Array,
    shards: &Shards,
    (origin, range): (&[u64], &Range),
    each: &mut dyn FnMut(&Unit) -> Result<(), Problem>,
) -> Result<(), ReadError> {
    let Some(inside) = range.meet(origin, &array.chunk) else {
        return Ok(());
    };
    let relative = |ends: &[u64]| -> Vec<u64> {
        ends.iter()
            .zip(origin)
            .map(|(end, origin)| end.saturating_sub(*origin))
            .collect()
    };
    let wanted = Range {
        low: relative(&inside.low),
        high: relative(&inside.high),
    };
    let grid = Range {
        low: vec![0; array.rank()],
        high: array.chunk.clone(),
    };
    let grid = grid.in_grid(&shards.chunk);
    let index = shard_index(file, shards, grid.count())?;
    for cell in wanted.in_grid(&shards.chunk).indices() {
        let sides = cell.iter().zip(&grid.high);
        let entry = sides.fold(0_u64, |entry, (here, side)| {
            entry.saturating_mul(*side).saturating_add(*here)
        });
        let entry = usize::try_from(entry)
            .ok()
            .and_then(|entry| index.get(entry));
        let [start, count] = entry.copied().unwrap_or([u64::MAX; 2]);
        // Two numbers full of ones: not there.
        if [start, count] == [u64::MAX; 2] {
            continue;
        }
        let decoded = decoded(file, start, count, array)?;
        let begin = origin_of(&cell, &shards.chunk);
        let begin: Vec<u64> = begin
            .iter()
            .zip(origin)
            .map(|(a, b)| a.saturating_add(*b))
            .collect();
        let unit = Unit {
            origin: &begin,
            bytes: &decoded,
        };
        each(&unit).map_err(at(&file.path))?;
    }
    Ok(())
}

/// Start and length of each of the `count` chunks in a shard.
fn shard_index(file: &mut Value, shards: &Shards, count: u64) -> Result<Vec<[u64; 2]>, ReadError> {
    const ENTRY_BYTES: u64 = 16;
    const CHECKSUM_BYTES: u64 = 4;
    let checksum = if shards.index_has_checksum {
        CHECKSUM_BYTES
    } else {
        0
    };
    let length = count.saturating_mul(ENTRY_BYTES).saturating_add(checksum);
    if length > file.bytes {
        return Err(at(&file.path)(Problem::Size {
            format: ZARR,
            wanted_bytes: length,
            found_bytes: file.bytes,
        }));
    }
    let start = if shards.index_at_end {
        file.bytes.saturating_sub(length)
    } else {
        0
    };
    let mut bytes = file.read(start, length)?;
    if shards.index_has_checksum {
        bytes = without_checksum(bytes)
            .map_err(|cause| at(&file.path)(damaged("crc32c of the shard's index", cause)))?;
    }
    let number = |bytes: &[u8; 8]| match shards.index_endian {
        Endian::Little => u64::from_le_bytes(*bytes),
        Endian::Big => u64::from_be_bytes(*bytes),
    };
    let (pairs, _) = bytes.as_chunks::<8>().0.as_chunks::<2>();
    Ok(pairs
        .iter()
        .map(|pair| pair.each_ref().map(number))
        .collect())
}

/// The numbers in `count` bytes of a file.
fn decoded(file: &mut Value, start: u64, count: u64, array: &Array) -> Result<Vec<u8>, ReadError> {
    let wanted_bytes = array.unit_bytes();
    let most = most_encoded(wanted_bytes, &array.codecs.bytes);
    let is_inside = start
        .checked_add(count)
        .is_some_and(|end| end <= file.bytes);
    if count > most || !is_inside {
        let (wanted, found) = match is_inside {
            true => (
                format!("at most {most} bytes for a chunk of {wanted_bytes}"),
                count.to_string(),
            ),
            false => (
                format!("a chunk within the {} bytes of the file", file.bytes),
                format!("{count} bytes at {start}"),
            ),
        };
        return Err(at(&file.path)(Problem::Invalid {
            format: ZARR,
            field: "chunk".to_owned(),
            wanted,
            found,
        }));
    }
    let encoded = file.read(start, count)?;
    let wanted = usize::try_from(wanted_bytes).unwrap_or(usize::MAX);
    decode(&array.codecs.bytes, encoded, wanted).map_err(|(encoding, cause)| {
        at(&file.path)(match encoding {
            "raw" => Problem::Size {
                format: ZARR,
                wanted_bytes,
                found_bytes: count,
            },
            _ => damaged(encoding, cause),
        })
    })
}

fn damaged(encoding: &'static str, cause: String) -> Problem {
    Problem::Damaged {
        format: ZARR,
        encoding,
        decoded_bytes: 0,
        cause,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_run_over_the_last_axis_first() {
        let range = Range {
            low: vec![1, 0],
            high: vec![3, 2],
        };
        let all: Vec<Vec<u64>> = range.indices().collect();
        assert_eq!(all, [[1, 0], [1, 1], [2, 0], [2, 1]]);
        let point = Range {
            low: vec![],
            high: vec![],
        };
        assert_eq!(point.indices().count(), 1);
        let nothing = Range {
            low: vec![1, 2],
            high: vec![3, 2],
        };
        assert_eq!(nothing.indices().count(), 0);
    }

    #[test]
    fn a_box_meets_the_boxes_of_a_grid_that_it_touches() {
        let range = Range {
            low: vec![3, 4],
            high: vec![5, 8],
        };
        let met = range.in_grid(&[4, 4]);
        assert_eq!((met.low, met.high), (vec![0, 1], vec![2, 2]));
        assert!(range.meet(&[0, 0], &[4, 4]).is_none());
        let met = range.meet(&[4, 4], &[4, 4]).unwrap();
        assert_eq!((met.low, met.high), (vec![4, 4], vec![5, 8]));
    }
}
