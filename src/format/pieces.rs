//! A volume that lies in pieces: boxes that cover it, each a source of its own.

use super::convert::{bytes_in_memory, to_u64};
use super::problem::{at, invalid};
use super::request::wanted_count;
use crate::volume::{
    Header, Limits, Piece, PrecisionLoss, Problem, ReadError, Source, TimeComponent, VoxelBox,
    Voxels,
};
use std::path::{Path, PathBuf};

/// A [`Source`] over pieces. Where two overlap, the later one counts.
pub(crate) struct Pieces {
    path: PathBuf,
    header: Header,
    pieces: Vec<(VoxelBox, Box<dyn Source>)>,
    max_bytes: u64,
}

/// More boxes than any partition leaves open.
const MOST_OPEN_BOXES: usize = 10_000;

impl Pieces {
    /// Each piece comes with the voxels of the whole that it holds. An error where some are in none.
    pub(crate) fn new(
        path: &Path,
        header: Header,
        pieces: Vec<(VoxelBox, Box<dyn Source>)>,
        limits: &Limits,
    ) -> Result<Self, Problem> {
        let mut open = vec![header.whole()];
        for (piece, _) in &pieces {
            open = open
                .iter()
                .flat_map(|rest| without(*rest, *piece))
                .collect();
            if open.len() > MOST_OPEN_BOXES {
                break;
            }
        }
        if let Some(open) = open.first() {
            let name = header.format.name();
            let wanted = format!("pieces that cover all {:?} voxels", header.dims);
            let found = format!("none from {:?} to {:?}", open.min, open.max);
            return Err(invalid(name, "Piece", wanted, &found));
        }
        Ok(Self {
            path: path.to_owned(),
            header,
            pieces,
            max_bytes: limits.max_bytes,
        })
    }
}

/// The parts of `rest` outside `piece`, at most six.
fn without(mut rest: VoxelBox, piece: VoxelBox) -> Vec<VoxelBox> {
    if common(rest, piece).is_none() {
        return vec![rest];
    }
    let mut parts = Vec::new();
    for k in 0..3 {
        let ends = |of: &VoxelBox| Some((*of.min.get(k)?, *of.max.get(k)?));
        let (Some((low, high)), Some((from, to))) = (ends(&rest), ends(&piece)) else {
            continue;
        };
        let cut = |low: u32, high: u32| {
            let mut part = rest;
            if let (Some(min), Some(max)) = (part.min.get_mut(k), part.max.get_mut(k)) {
                (*min, *max) = (low, high);
            }
            part
        };
        if low < from {
            parts.push(cut(low, from));
        }
        if to < high {
            parts.push(cut(to, high));
        }
        rest = cut(low.max(from), high.min(to));
    }
    parts
}

/// What two boxes share, if it is anything.
fn common(a: VoxelBox, b: VoxelBox) -> Option<VoxelBox> {
    let each = |f: fn(u32, u32) -> u32, a: [u32; 3], b: [u32; 3]| {
        let [x, y, z] = a;
        let [u, v, w] = b;
        [f(x, u), f(y, v), f(z, w)]
    };
    let shared = VoxelBox {
        min: each(u32::max, a.min, b.min),
        max: each(u32::min, a.max, b.max),
    };
    let some = shared.min.iter().zip(&shared.max).all(|(a, b)| a < b);
    some.then_some(shared)
}

impl Source for Pieces {
    fn path(&self) -> &Path {
        &self.path
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let header = &self.header;
        let format = header.format.name();
        let length =
            wanted_count(format, header, pick, region, self.max_bytes).map_err(at(&self.path))?;
        let bytes_each = to_u64(bytes_in_memory(header.stored));
        let wanted_bytes = to_u64(length).saturating_mul(bytes_each);
        let too_large = || Problem::Limit {
            what: "the volume".to_owned(),
            wanted_bytes,
            limit_bytes: self.max_bytes,
        };
        let mut whole: Option<Voxels> = None;
        let mut loss = PrecisionLoss::default();
        for (place, source) in &self.pieces {
            let Some(shared) = common(region, *place) else {
                continue;
            };
            let piece = source.read(pick, moved(shared, place.min))?;
            loss = loss.and(piece.loss);
            let to = moved(shared, region.min);
            match &mut whole {
                Some(whole) => put(&piece.voxels, to, whole, region),
                None => {
                    let mut begun =
                        like(&piece.voxels, length).ok_or_else(|| at(&self.path)(too_large()))?;
                    put(&piece.voxels, to, &mut begun, region);
                    whole = Some(begun);
                }
            }
        }
        match whole {
            Some(voxels) => Ok(Piece { voxels, loss }),
            None => Err(at(&self.path)(Problem::Size {
                format,
                wanted_bytes,
                found_bytes: 0,
            })),
        }
    }
}

/// A box as it is seen from a corner that lies before it.
fn moved(of: VoxelBox, corner: [u32; 3]) -> VoxelBox {
    let seen = |ends: [u32; 3]| {
        let [x, y, z] = ends;
        let [a, b, c] = corner;
        [
            x.saturating_sub(a),
            y.saturating_sub(b),
            z.saturating_sub(c),
        ]
    };
    VoxelBox {
        min: seen(of.min),
        max: seen(of.max),
    }
}

/// `count` zeros of the same type, if there is room.
fn like(voxels: &Voxels, count: usize) -> Option<Voxels> {
    fn zeros<T: Clone + Default>(count: usize) -> Option<Vec<T>> {
        let mut numbers = Vec::new();
        numbers.try_reserve_exact(count).ok()?;
        numbers.resize(count, T::default());
        Some(numbers)
    }
    Some(match voxels {
        Voxels::U8(_) => Voxels::U8(zeros(count)?),
        Voxels::I8(_) => Voxels::I8(zeros(count)?),
        Voxels::U16(_) => Voxels::U16(zeros(count)?),
        Voxels::I16(_) => Voxels::I16(zeros(count)?),
        Voxels::F16(_) => Voxels::F16(zeros(count)?),
        Voxels::F32(_) => Voxels::F32(zeros(count)?),
    })
}

/// Puts the voxels of a piece to the box `to` of `region`.
fn put(piece: &Voxels, to: VoxelBox, whole: &mut Voxels, region: VoxelBox) {
    match (piece, whole) {
        (Voxels::U8(from), Voxels::U8(out)) => put_rows(from, to, out, region),
        (Voxels::I8(from), Voxels::I8(out)) => put_rows(from, to, out, region),
        (Voxels::U16(from), Voxels::U16(out)) => put_rows(from, to, out, region),
        (Voxels::I16(from), Voxels::I16(out)) => put_rows(from, to, out, region),
        (Voxels::F16(from), Voxels::F16(out)) => put_rows(from, to, out, region),
        (Voxels::F32(from), Voxels::F32(out)) => put_rows(from, to, out, region),
        // All pieces are opened with one type.
        _ => {}
    }
}

fn put_rows<T: Copy>(from: &[T], to: VoxelBox, out: &mut [T], region: VoxelBox) {
    let size = |n: u32| usize::try_from(n).unwrap_or(usize::MAX);
    let [width, height, _] = region.dims().map(size);
    let [x, y, z] = to.min.map(size);
    let [across, down, _] = to.dims().map(size);
    for (index, row) in from.chunks_exact(across.max(1)).enumerate() {
        let line = y.saturating_add(index.checked_rem(down).unwrap_or(0));
        let slice = z.saturating_add(index.checked_div(down).unwrap_or(0));
        let start = slice
            .saturating_mul(height)
            .saturating_add(line)
            .saturating_mul(width)
            .saturating_add(x);
        if let Some(place) = out.get_mut(start..start.saturating_add(across)) {
            place.copy_from_slice(row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_piece_leaves_open_is_everything_else_and_nothing_twice() {
        let rest = VoxelBox {
            min: [1, 1, 1],
            max: [5, 6, 7],
        };
        for piece in [
            ([2, 3, 4], [4, 5, 6]),
            ([0, 0, 0], [3, 9, 9]),
            ([0, 0, 0], [9, 9, 9]),
            ([7, 7, 7], [8, 8, 8]),
        ] {
            let piece = VoxelBox {
                min: piece.0,
                max: piece.1,
            };
            let parts = without(rest, piece);
            let inside =
                |of: VoxelBox, p: [u32; 3]| (0..3).all(|k| (of.min[k]..of.max[k]).contains(&p[k]));
            for x in 0..8 {
                for y in 0..8 {
                    for z in 0..8 {
                        let p = [x, y, z];
                        let wanted = usize::from(inside(rest, p) && !inside(piece, p));
                        let found = parts.iter().filter(|part| inside(**part, p)).count();
                        assert_eq!(found, wanted, "{p:?} {piece:?}");
                    }
                }
            }
        }
    }
}
