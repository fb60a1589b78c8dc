//! One look at all voxels of a source, a piece at a time: what there is in each of many boxes, and every n-th voxel of
//! all.
//!
//! ```text
//! for each piece of boxes that fits into memory:
//!     of each box: smallest and largest stored number, holes        of all: voxel n i + n / 2 along each axis
//! ```
//!
//! Memory is that of two pieces, whatever the source holds: one is looked at while the next is read.

use super::voxels::{Stored, with_numbers};
use super::{
    ComponentKind, Format, Header, Piece, PrecisionLoss, Problem, ReadError, Rescale, Source,
    TimeComponent, VoxelBox, Voxels,
};
use glam::{DAffine3, DVec3};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::mpsc::sync_channel;
use std::thread;

/// What is known of a source without having it in memory.
#[derive(Clone, Debug)]
pub struct Survey {
    /// Smallest and largest valid value of each box; `None` where it has none.
    pub ranges: Vec<Option<[f64; 2]>>,
    /// The same of all boxes.
    pub value_range: Option<[f64; 2]>,
    /// True where some voxel holds no data.
    pub has_holes: bool,
    /// What rounding stored numbers to f32 changed. Boxes that overlap count twice.
    pub loss: PrecisionLoss,
    /// Every n-th voxel.
    pub overview: Overview,
}

/// Every n-th voxel of a source along each axis, in memory: for a look at what values there are.
#[derive(Clone, Debug)]
pub struct Overview {
    path: PathBuf,
    header: Header,
    voxels: Voxels,
    every: u32,
}

/// What a source knows of itself.
#[derive(Clone, Debug)]
pub struct Surveyed {
    /// Voxels of its own along each side of the boxes, which store the neighbours that filters need beside them.
    pub side: u32,
    /// Of these boxes, x fastest.
    pub survey: Survey,
}

impl Overview {
    /// Voxels, all of them, that stand for every n-th of a source along each axis.
    pub fn new(path: &Path, header: Header, voxels: Voxels, every: u32) -> Self {
        let header = Header {
            components: 1,
            times: 1,
            levels: 1,
            stored: voxels.voxel_type(),
            meaning: ComponentKind::Numbers,
            time_names: Vec::new(),
            ..header
        };
        Self {
            path: path.to_owned(),
            header,
            voxels,
            every,
        }
    }

    /// The n of every n-th.
    pub fn every(&self) -> u32 {
        self.every
    }
}

/// A row of boxes that is read at once.
struct Run {
    region: VoxelBox,
    boxes: Vec<usize>,
}

/// What one box holds, in stored numbers.
#[derive(Clone, Copy)]
struct Found {
    low: f32,
    high: f32,
    has_holes: bool,
}

impl Survey {
    /// Looks at `boxes`, each in one piece with its neighbours along x as long as `piece_bytes` hold them. The overview
    /// has at most `most_seen` voxels. `tell` hears how many of the boxes are done, and may end the work.
    ///
    /// # Errors
    /// What the source meets; `None` where `tell` has ended it.
    pub fn of(
        source: &dyn Source,
        pick: TimeComponent,
        boxes: &[VoxelBox],
        [piece_bytes, most_seen]: [u64; 2],
        tell: &mut dyn FnMut(usize, usize) -> ControlFlow<()>,
    ) -> Result<Option<Self>, ReadError> {
        let header = source.header();
        let runs = runs(header, boxes, piece_bytes);
        let mut seen = Seen::new(header, most_seen);
        let mut found: Vec<Option<Found>> = vec![None; boxes.len()];
        let mut loss = PrecisionLoss::default();
        let is_ended = thread::scope(|scope| {
            let (send, pieces) = sync_channel(0);
            let runs = &runs;
            scope.spawn(move || {
                for run in runs {
                    let piece = source.read(pick, run.region);
                    let is_last = piece.is_err();
                    // Nobody takes it where the work was ended.
                    if send.send((run, piece)).is_err() || is_last {
                        break;
                    }
                }
            });
            let mut done = 0;
            for (run, piece) in pieces {
                let Piece { voxels, loss: more } = piece?;
                loss = loss.and(more);
                for &index in &run.boxes {
                    let part = within(boxes[index], run.region);
                    found[index] = Some(Found::of(&voxels, run.region.dims(), part, header.fill));
                }
                seen.take(&voxels, run.region);
                done += run.boxes.len();
                if tell(done, boxes.len()).is_break() {
                    return Ok(true);
                }
            }
            Ok(false)
        })?;
        if is_ended {
            return Ok(None);
        }
        let range = |found: &Option<Found>| found.as_ref().and_then(|f| f.values(header.rescale));
        let ranges: Vec<_> = found.iter().map(range).collect();
        let value_range = ranges.iter().flatten().copied().reduce(both);
        Ok(Some(Self {
            value_range,
            has_holes: found.iter().flatten().any(|found| found.has_holes),
            ranges,
            loss,
            overview: seen.overview(source),
        }))
    }
}

impl Survey {
    /// What was found out before.
    pub fn known(ranges: Vec<Option<[f64; 2]>>, has_holes: bool, overview: Overview) -> Self {
        Self {
            value_range: ranges.iter().flatten().copied().reduce(both),
            ranges,
            has_holes,
            loss: PrecisionLoss::default(),
            overview,
        }
    }
}

fn both(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Neighbours along x together, as far as they fit.
fn runs(header: &Header, boxes: &[VoxelBox], piece_bytes: u64) -> Vec<Run> {
    let bytes_each = match header.stored.is_kept_exactly() {
        true => header.stored.bytes() as u64,
        false => 4,
    };
    let bytes = |region: VoxelBox| {
        let dims = region.dims().map(u64::from);
        dims.iter().product::<u64>() * bytes_each
    };
    let mut runs: Vec<Run> = Vec::new();
    for (index, &next) in boxes.iter().enumerate() {
        let last = runs.last_mut().filter(|run| {
            let is_row = [1, 2]
                .iter()
                .all(|&k| run.region.min[k] == next.min[k] && run.region.max[k] == next.max[k]);
            is_row
                && next.min[0] >= run.region.min[0]
                && bytes(over(run.region, next)) <= piece_bytes
        });
        match last {
            Some(run) => {
                run.region = over(run.region, next);
                run.boxes.push(index);
            }
            None => runs.push(Run {
                region: next,
                boxes: vec![index],
            }),
        }
    }
    runs
}

/// The smallest box over both.
fn over(a: VoxelBox, b: VoxelBox) -> VoxelBox {
    VoxelBox {
        min: std::array::from_fn(|k| a.min[k].min(b.min[k])),
        max: std::array::from_fn(|k| a.max[k].max(b.max[k])),
    }
}

/// `part` as it lies in `region`.
fn within(part: VoxelBox, region: VoxelBox) -> VoxelBox {
    VoxelBox {
        min: std::array::from_fn(|k| part.min[k] - region.min[k]),
        max: std::array::from_fn(|k| part.max[k] - region.min[k]),
    }
}

impl Found {
    fn of(voxels: &Voxels, dims: [u32; 3], part: VoxelBox, fill: Option<f64>) -> Self {
        with_numbers!(voxels, numbers => Self::of_numbers(numbers, dims, part, fill))
    }

    fn of_numbers<T: Stored>(
        numbers: &[T],
        dims: [u32; 3],
        part: VoxelBox,
        fill: Option<f64>,
    ) -> Self {
        let fill = fill.and_then(T::from_fill);
        let is_valid = |x: T| x.is_finite() && Some(x) != fill;
        let [nx, ny, _] = dims.map(|n| n as usize);
        let columns = part.min[0] as usize..part.max[0] as usize;
        // One lane a column: rows are compared side by side, which the compiler makes vectors of.
        let mut lanes: Option<(Vec<T>, Vec<T>, Vec<bool>)> = None;
        let mut has_holes = false;
        for z in part.min[2]..part.max[2] {
            for y in part.min[1]..part.max[1] {
                let start = (z as usize * ny + y as usize) * nx;
                let row = &numbers[start + columns.start..start + columns.end];
                let all_valid = row.iter().fold(true, |all, &x| all & is_valid(x));
                has_holes |= !all_valid;
                let (low, high, any) = lanes
                    .get_or_insert_with(|| (row.to_vec(), row.to_vec(), vec![false; row.len()]));
                if all_valid && !has_holes {
                    for ((low, high), &x) in low.iter_mut().zip(high.iter_mut()).zip(row) {
                        *low = if x < *low { x } else { *low };
                        *high = if x > *high { x } else { *high };
                    }
                    any.fill(true);
                    continue;
                }
                for (column, &x) in row.iter().enumerate() {
                    if !is_valid(x) {
                        continue;
                    }
                    if !any[column] {
                        (low[column], high[column], any[column]) = (x, x, true);
                    }
                    low[column] = if x < low[column] { x } else { low[column] };
                    high[column] = if x > high[column] { x } else { high[column] };
                }
            }
        }
        let mut found = Self {
            low: f32::INFINITY,
            high: f32::NEG_INFINITY,
            has_holes,
        };
        let (low, high, any) = lanes.unwrap_or_default();
        for ((low, high), _) in low.iter().zip(&high).zip(&any).filter(|(_, any)| **any) {
            found.low = found.low.min(low.to_f32());
            found.high = found.high.max(high.to_f32());
        }
        found
    }

    fn values(&self, rescale: Rescale) -> Option<[f64; 2]> {
        let value = |stored: f32| f64::from(stored) * rescale.slope + rescale.intercept;
        let [a, b] = [self.low, self.high].map(value);
        (self.low <= self.high).then(|| [a.min(b), a.max(b)])
    }
}

/// The overview while it is being filled.
struct Seen {
    every: u32,
    first: [u32; 3],
    dims: [u32; 3],
    stored: Vec<f32>,
}

impl Seen {
    fn new(header: &Header, most: u64) -> Self {
        let first_of = |every: u32| header.dims.map(|n| (every / 2).min(n - 1));
        let dims_of = |every: u32| {
            let first = first_of(every);
            std::array::from_fn(|k| (header.dims[k] - first[k]).div_ceil(every))
        };
        let count = |every: u32| {
            let dims: [u32; 3] = dims_of(every);
            dims.iter().map(|&n| u64::from(n)).product::<u64>()
        };
        let every = (1..)
            .find(|&every| count(every) <= most.max(1))
            .unwrap_or(1);
        Self {
            every,
            first: first_of(every),
            dims: dims_of(every),
            stored: vec![0.0; count(every) as usize],
        }
    }

    fn take(&mut self, voxels: &Voxels, region: VoxelBox) {
        let dims = region.dims().map(|n| n as usize);
        let [nx, ny, _] = self.dims.map(|n| n as usize);
        let (every, firsts, seen) = (self.every, self.first, self.dims);
        // Voxels of the overview that lie in the region.
        let inside = |k: usize| {
            let first = firsts[k];
            let from = region.min[k].saturating_sub(first).div_ceil(every);
            (from..seen[k]).take_while(move |i| i * every + first < region.max[k])
        };
        let place = |k: usize, i: u32| (i * every + firsts[k] - region.min[k]) as usize;
        for z in inside(2) {
            for y in inside(1) {
                let row = (place(2, z) * dims[1] + place(1, y)) * dims[0];
                for x in inside(0) {
                    let to = (z as usize * ny + y as usize) * nx + x as usize;
                    self.stored[to] = voxels.stored(row + place(0, x));
                }
            }
        }
    }

    fn overview(self, source: &dyn Source) -> Overview {
        let from = source.header();
        let every = f64::from(self.every);
        // Centre i of the overview is centre every i + every / 2 of the source.
        let shift = self.first.map(|first| f64::from(first) + 0.5 - 0.5 * every);
        let shift = DVec3::from_array(shift);
        let place = DAffine3::from_translation(shift) * DAffine3::from_scale(DVec3::splat(every));
        let header = Header {
            dims: self.dims,
            world_from_voxel: from.world_from_voxel * place,
            notes: Vec::new(),
            ..from.clone()
        };
        Overview::new(source.path(), header, Voxels::F32(self.stored), self.every)
    }
}

impl Source for Overview {
    fn path(&self) -> &Path {
        &self.path
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, _: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        if region == self.header.whole() {
            return Ok(self.voxels.clone().into());
        }
        Err(ReadError {
            path: self.path.clone(),
            problem: Problem::Unsupported {
                format: Format::name(self.header.format),
                what: "a part of an overview".to_owned(),
            },
        })
    }
}
