//! A [`Source`] over one array: which axis is which, and reading a box of one time and component.

use super::ZARR;
use super::array::Array;
use super::canvas::{Canvas, Move, MoveAxis};
use super::chunk::{Range, Unit, check_files, visit};
use super::store::Store;
use crate::format::convert::{bytes_in_memory, to_u64};
use crate::format::problem::at;
use crate::volume::{Header, Limits, Piece, Problem, ReadError, Source, TimeComponent, VoxelBox};
use std::path::Path;

/// What an axis of the array means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// 0, 1, 2 for x, y, z.
    Space(usize),
    Time,
    /// Of several, the last runs fastest.
    Component,
}

/// A volume in an array.
#[derive(Debug)]
pub(super) struct ArraySource {
    pub store: Store,
    pub array: Array,
    /// One an axis of the array.
    pub roles: Vec<Role>,
    pub header: Header,
    pub limits: Limits,
}

/// Decoded chunks beside the volume that need no permission.
const BESIDE_BYTES: u64 = 64 << 20;

/// The numbers of a box of an array. `strides` says how far apart they come to lie along each axis.
pub(super) fn read_box(
    store: &Store,
    array: &Array,
    range: &Range,
    strides: &[usize],
    limits: &Limits,
) -> Result<Piece, ReadError> {
    let here = |problem| at(&store.shown(&array.path))(problem);
    let wanted_bytes = range
        .count()
        .saturating_mul(to_u64(bytes_in_memory(array.stored)));
    let too_large = |what: &str, wanted_bytes, limit_bytes| {
        Err(here(Problem::Limit {
            what: what.to_owned(),
            wanted_bytes,
            limit_bytes,
        }))
    };
    if wanted_bytes > limits.max_bytes {
        return too_large("the volume", wanted_bytes, limits.max_bytes);
    }
    let with_chunk = wanted_bytes.saturating_add(array.unit_bytes());
    let limit_bytes = limits.max_bytes.saturating_add(BESIDE_BYTES);
    if with_chunk > limit_bytes {
        return too_large("the volume with one chunk", with_chunk, limit_bytes);
    }
    let Ok(count) = usize::try_from(range.count()) else {
        return too_large("the volume", wanted_bytes, limits.max_bytes);
    };
    check_files(store, array, range, limits)?;
    let fill = array.fill_piece().map_err(here)?;
    let endian = array.codecs.endian;
    let mut canvas = Canvas::new(array.stored, endian, &fill, count).map_err(here)?;
    let from_strides = unit_strides(array);
    visit(store, array, range, limits, &mut |unit: &Unit| {
        let Some(meet) = range.meet(unit.origin, array.unit()) else {
            return Ok(());
        };
        let mut wanted = Move::default();
        let ends = meet.low.iter().zip(&meet.high);
        let begins = unit.origin.iter().zip(&range.low);
        let all = ends.zip(begins).zip(from_strides.iter().zip(strides));
        for (((low, high), (origin, first)), (&from_stride, &to_stride)) in all {
            let of = |a: u64, b: u64| usize::try_from(a.saturating_sub(b)).unwrap_or(usize::MAX);
            wanted.axes.push(MoveAxis {
                count: of(*high, *low),
                from_stride,
                to_stride,
            });
            let from = of(*low, *origin).saturating_mul(from_stride);
            let to = of(*low, *first).saturating_mul(to_stride);
            wanted.from = wanted.from.saturating_add(from);
            wanted.to = wanted.to.saturating_add(to);
        }
        canvas.put(unit.bytes, &wanted)
    })?;
    Ok(canvas.finish())
}

/// How far apart the numbers of a decoded chunk lie along each axis of the array.
pub(super) fn unit_strides(array: &Array) -> Vec<usize> {
    let mut strides = vec![0; array.rank()];
    let mut stride = 1_usize;
    for &axis in array.codecs.order.iter().rev() {
        if let Some(place) = strides.get_mut(axis) {
            *place = stride;
        }
        let side = array.unit().get(axis).copied().unwrap_or(1);
        stride = stride.saturating_mul(usize::try_from(side).unwrap_or(usize::MAX));
    }
    strides
}

impl ArraySource {
    /// Adds what every array may give a person to know.
    pub(super) fn with_notes(mut self) -> Self {
        let array = &self.array;
        if !array.stored.is_kept_exactly() {
            self.header.notes.push(format!(
                "voxels are stored as {} and kept as f32",
                array.stored.name()
            ));
        }
        let (absent, all) = absent_chunks(&self.store, array);
        if absent > 0 {
            let number = array.fill.number;
            let word = match array.fill.is_given {
                true => format!("the fill value {number}"),
                false => "0, the file names no fill value".to_owned(),
            };
            let note =
                format!("{absent} of {all} chunk files are not there: they are read as {word}");
            self.header.notes.push(note);
        }
        self
    }

    fn range(&self, pick: TimeComponent, region: VoxelBox) -> Range {
        let mut range = Range::whole(&self.array);
        let mut component = u64::from(pick.component);
        let sides = self.roles.iter().zip(&self.array.shape);
        let ends = range.low.iter_mut().zip(&mut range.high);
        for ((role, &side), (low, high)) in sides.zip(ends).rev() {
            match role {
                Role::Space(k) => {
                    *low = region.min.get(*k).copied().unwrap_or(0).into();
                    *high = region.max.get(*k).copied().unwrap_or(1).into();
                }
                Role::Time => {
                    *low = pick.time.into();
                    *high = low.saturating_add(1);
                }
                Role::Component => {
                    *low = component.checked_rem(side).unwrap_or(0);
                    *high = low.saturating_add(1);
                    component = component.checked_div(side).unwrap_or(0);
                }
            }
        }
        range
    }

    /// x fastest, wherever it lies in the array.
    fn strides(&self, region: VoxelBox) -> Vec<usize> {
        let side = |k: usize| {
            let ends = (region.max.get(k), region.min.get(k));
            let (Some(max), Some(min)) = ends else {
                return 1;
            };
            usize::try_from(max.saturating_sub(*min)).unwrap_or(usize::MAX)
        };
        let stride = |role: &Role| match role {
            Role::Space(0) => 1,
            Role::Space(1) => side(0),
            Role::Space(_) => side(0).saturating_mul(side(1)),
            Role::Time | Role::Component => 0,
        };
        self.roles.iter().map(stride).collect()
    }
}

/// How many of the array's files are not there, and how many there would be; none where they are too many to look.
fn absent_chunks(store: &Store, array: &Array) -> (u64, u64) {
    const MOST_LOOKS: u64 = 4096;
    let chunks = Range::whole(array).in_grid(&array.chunk);
    let all = chunks.count();
    if all > MOST_LOOKS {
        return (0, all);
    }
    let is_absent = |index: &Vec<u64>| {
        let path = store.path().join(array.key(index));
        path.symlink_metadata().is_err()
    };
    (to_u64(chunks.indices().filter(is_absent).count()), all)
}

impl Source for ArraySource {
    fn path(&self) -> &Path {
        self.store.path()
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let header = &self.header;
        let is_inside = pick.time < header.times
            && pick.component < header.components
            && region
                .min
                .iter()
                .zip(&region.max)
                .zip(&header.dims)
                .all(|((min, max), size)| min < max && max <= size);
        if !is_inside {
            return Err(at(self.path())(Problem::Invalid {
                format: ZARR,
                field: "box".to_owned(),
                wanted: format!(
                    "a box inside {:?} of {} times and {} components",
                    header.dims, header.times, header.components
                ),
                found: format!("{:?} to {:?} of {pick:?}", region.min, region.max),
            }));
        }
        let range = self.range(pick, region);
        read_box(
            &self.store,
            &self.array,
            &range,
            &self.strides(region),
            &self.limits,
        )
    }
}
