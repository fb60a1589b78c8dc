//! Lines along a field of the host's: stream lines, path lines, streak lines.

use super::device::sv_device;
use super::handles::{self, Kind};
use super::settings::finite;
use super::status::{Failure, guard, number, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use super::volume::affine;
use super::words::word;
use crate::flow::{
    Direction, End, EvenLines, FieldError, GridField, Limits, Line, Metric, Snapshot,
    even_stream_lines, path_lines, streak_lines, stream_lines,
};
use crate::volume::Grid;
use glam::DVec3;
use std::ffi::c_void;

/// Lines that follow a field: in memory of the host's alone. 0 is none.
pub type sv_lines = u64;

/// A field of velocities, and where its lines begin.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_trace_desc {
    /// `sizeof(sv_trace_desc)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// How many voxels there are along x, y and z: 1 or more of each.
    pub dims: [u32; 3],
    /// sv_direction.
    pub direction: u32,
    /// Three numbers a voxel, x fastest, then y, then z: along the axes of the world, world length per second; a voxel where one
    /// of them is not finite has no data. With several times those of all voxels at the first of them, then at the second, and so
    /// on; between two times velocities are linear. They are read before the call returns.
    pub velocities: *const f32,
    /// How many numbers there are.
    pub velocity_count: u64,
    /// As in sv_volume_desc. All zero: voxel space is the world.
    pub world_from_voxel: [f64; 16],
    /// Three numbers each, world; or NULL: stream lines that are evenly spaced.
    pub seeds: *const f64,
    /// How many seeds there are.
    pub seed_count: u64,
    /// Of lines that are evenly spaced: their distance, world length. 0: a 24th of the diagonal of the box.
    pub spacing: f64,
    /// No more lines that are evenly spaced than these. 0 is 2000.
    pub most_lines: u32,
    /// How many vertices a line has at most, each way. 0 is 4000.
    pub most_vertices: u32,
    /// How long a line is at most, each way, world length. 0: as long as it goes.
    pub length: f64,
    /// For how long a line is followed, each way, in seconds. 0: as long as it goes.
    pub duration: f64,
    /// What a step may be off by, in cells of the grid. 0 is 0.001.
    pub tolerance: f64,
    /// sv_line_kind.
    pub kind: u32,
    /// At how many times the velocities are given. 0 is 1; paths and streaks want 2 or more.
    pub time_count: u32,
    /// These times, seconds that grow; NULL where there is one.
    pub times: *const f64,
    /// Of stream lines the instant; of paths when particles are at the seeds; of streaks since when they leave them.
    pub start: f64,
    /// Of streaks the moment that shows where they are.
    pub end: f64,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_trace_desc {
    const NAME: &'static str = "sv_trace_desc";
}

/// Which way lines are followed from their seeds.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_direction {
    /// Both: the seed lies inside of the line.
    SV_DIRECTION_BOTH = 0,
    /// Along the velocity.
    SV_DIRECTION_FORWARD = 1,
    /// Against it.
    SV_DIRECTION_BACKWARD = 2,
}

/// What a line is.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_line_kind {
    /// Along the velocities of one instant.
    SV_LINE_KIND_STREAM = 0,
    /// The way of one particle.
    SV_LINE_KIND_PATH = 1,
    /// Where the particles are at one moment that left the seed one after another.
    SV_LINE_KIND_STREAK = 2,
}

/// Why a line ends.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_cause {
    /// It was not followed that way.
    SV_CAUSE_NONE = 0,
    /// The box of the grid ends there.
    SV_CAUSE_DOMAIN = 1,
    /// The ground. Not of fields of the host's.
    SV_CAUSE_GROUND = 2,
    /// A voxel that it lies between has no data.
    SV_CAUSE_NO_DATA = 3,
    /// A pole of the Earth. Not of fields of the host's.
    SV_CAUSE_POLE = 4,
    /// It is a million times slower than the fast places of the field, or stays where it is.
    SV_CAUSE_STAGNATION = 5,
    /// It came back to its seed.
    SV_CAUSE_CLOSED = 6,
    /// `length`.
    SV_CAUSE_LENGTH = 7,
    /// `duration`.
    SV_CAUSE_TIME = 8,
    /// `most_vertices`.
    SV_CAUSE_VERTICES = 9,
    /// It came too near to another line that is evenly spaced.
    SV_CAUSE_CROWDED = 10,
}

/// The lines of one call.
struct Held(Vec<Line>);

impl Kind for Held {
    const NUMBER: u64 = 7;
    const NAME: &'static str = "sv_lines";
}

/// What there is of [`sv_line_kind`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lines {
    Stream,
    Path,
    Streak,
}

const KINDS: [Lines; 3] = [Lines::Stream, Lines::Path, Lines::Streak];

const DIRECTIONS: [Direction; 3] = [Direction::Both, Direction::Forward, Direction::Backward];

/// More seeds, or numbers of a field, are not followed at once.
const MOST_SEEDS: u64 = 1 << 24;
const MOST_NUMBERS: u64 = 1 << 36;
const MOST_TIMES: u64 = 1 << 16;

impl From<FieldError> for Failure {
    fn from(error: FieldError) -> Self {
        Self::argument(format!("sv_trace_desc: {error}"))
    }
}

/// Follows lines of a field: by steps no longer than a cell, in 64-bit floats, one line a seed in their order, by all
/// cores of the machine. Nothing is done on the device, which keeps the lines among its handles. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_trace(
    device: sv_device,
    desc: *const sv_trace_desc,
    lines: *mut sv_lines,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the sv_lines", lines)?;
        let device = handles::device(device)?;
        // SAFETY: the caller's promise.
        let made = unsafe { traced(&structure::read(desc)?)? };
        let handle = handles::add(&device, Held(made))?;
        // SAFETY: not NULL; the caller's promise.
        unsafe { lines.write(handle) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// How many lines there are, one a seed; one that begins where there is no velocity has no vertices. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_lines_count(
    lines: sv_lines,
    count: *mut u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the number of lines", count)?;
        let (_, held) = handles::find::<Held>(lines)?;
        // SAFETY: not NULL; the caller's promise.
        unsafe { count.write(held.0.len() as u64) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// The places of the vertices of one line along the velocity, three doubles each. `count` is for how many there is room at
/// `positions`, and becomes how many there are; with NULL that alone is told. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_lines_positions(
    lines: sv_lines,
    line: u64,
    positions: *mut f64,
    count: *mut u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let places = |line: &Line| -> Vec<_> {
        let vertices = line.vertices.iter();
        vertices.map(|vertex| vertex.place.to_array()).collect()
    };
    // SAFETY: the caller's promise.
    unsafe { tell((lines, line), positions.cast(), count, diagnostic, places) }
}

/// The time and the speed at the vertices of one line: two doubles each. Of a stream line the time since the seed, negative
/// before it; of a path that of the particle; of a streak when the particle left. As sv_lines_positions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_lines_values(
    lines: sv_lines,
    line: u64,
    values: *mut f64,
    count: *mut u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let numbers = |line: &Line| -> Vec<_> {
        let vertices = line.vertices.iter();
        vertices.map(|vertex| [vertex.time, vertex.speed]).collect()
    };
    // SAFETY: the caller's promise.
    unsafe { tell((lines, line), values.cast(), count, diagnostic, numbers) }
}

/// The numbers of those vertices of one line, counted from 0, that no piece of the line leads to: of a streak between whose
/// particles others are gone. As sv_lines_positions, one number each.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_lines_breaks(
    lines: sv_lines,
    line: u64,
    breaks: *mut u64,
    count: *mut u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let numbers = |line: &Line| line.breaks.iter().map(|&vertex| vertex as u64).collect();
    // SAFETY: the caller's promise.
    unsafe { tell((lines, line), breaks, count, diagnostic, numbers) }
}

/// Why a line begins where it does, and why it ends: two numbers of sv_cause. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_lines_cause(
    lines: sv_lines,
    line: u64,
    causes: *mut u32,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the two causes", causes)?;
        let (_, held) = handles::find::<Held>(lines)?;
        let ends = held.line(line)?.ends;
        let found = ends.map(|end| end.map_or(0, |end| u32::from(End::number(end))));
        // SAFETY: not NULL; the caller's promise.
        unsafe { causes.cast::<[u32; 2]>().write(found) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Forgets the lines. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_lines_destroy(
    lines: sv_lines,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || handles::remove::<Held>(lines).map(drop);
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

impl Held {
    fn line(&self, number: u64) -> Result<&Line, Failure> {
        let found = usize::try_from(number).ok().and_then(|i| self.0.get(i));
        found.ok_or_else(|| {
            let count = self.0.len();
            Failure::argument(format!("line {number} of {count} lines, counted from 0"))
        })
    }
}

/// Tells what is found of one line.
///
/// # Safety
/// As [`write_all`]; `diagnostic` as [`guard`] wants it.
unsafe fn tell<T>(
    (lines, line): (sv_lines, u64),
    values: *mut T,
    count: *mut u64,
    diagnostic: *mut sv_diagnostic,
    find: impl FnOnce(&Line) -> Vec<T>,
) -> sv_status {
    let body = || {
        let (_, held) = handles::find::<Held>(lines)?;
        let found = find(held.line(line)?);
        // SAFETY: the caller's promise.
        unsafe { write_all(found, values, count) }
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Writes all values where there is room, and how many there are.
///
/// # Safety
/// `values` is NULL or has room for `count` of them, which is NULL or a number.
unsafe fn write_all<T>(all: Vec<T>, values: *mut T, count: *mut u64) -> Result<(), Failure> {
    structure::out("the place of the number of vertices", count)?;
    let there = all.len() as u64;
    if !values.is_null() {
        structure::out("the place of the vertices", values)?;
        // SAFETY: not NULL; the caller's promise.
        let room = unsafe { count.read() };
        if room < there {
            return Err(Failure::limit("write the vertices of a line", there, room));
        }
        for (i, value) in all.into_iter().enumerate() {
            // SAFETY: there is room for all of them.
            unsafe { values.add(i).write(value) };
        }
    }
    // SAFETY: not NULL; the caller's promise.
    unsafe { count.write(there) };
    Ok(())
}

/// # Safety
/// As [`structure::read`] of all that the description points to.
unsafe fn traced(c: &sv_trace_desc) -> Result<Vec<Line>, Failure> {
    if c.dims.contains(&0) {
        let text = format!("sv_trace_desc.dims: {:?}, wanted 1 or more", c.dims);
        return Err(Failure::argument(text));
    }
    let product = |so_far: u64, n: &u32| so_far.checked_mul((*n).into());
    let times = c.time_count.max(1);
    let sizes = c.dims.iter().chain([&times]);
    let wanted = sizes.copied().try_fold(3, |n, m| product(n, &m));
    let wanted = wanted.unwrap_or(u64::MAX);
    if wanted != c.velocity_count {
        return Err(Failure::argument(format!(
            "sv_trace_desc.velocity_count: {:?} voxels at {times} times have {wanted} numbers, found {}",
            c.dims, c.velocity_count
        )));
    }
    let kind = word("sv_trace_desc.kind", &KINDS, c.kind)?;
    if kind != Lines::Stream && times < 2 {
        return Err(Failure::argument(format!(
            "sv_trace_desc.time_count: {times}, wanted 2 or more for paths and streaks"
        )));
    }
    if kind != Lines::Stream && c.seeds.is_null() {
        return Err(Failure::argument(
            "sv_trace_desc.seeds: NULL, wanted seeds: stream lines alone are evenly spaced",
        ));
    }
    let direction = word("sv_trace_desc.direction", &DIRECTIONS, c.direction)?;
    let or = |name: &str, found: f64, default: f64| {
        let is_right = found >= 0.0 && found.is_finite();
        number(
            &format!("sv_trace_desc.{name}"),
            "0 or more",
            found,
            is_right,
        )?;
        Ok::<_, Failure>(if found == 0.0 { default } else { found })
    };
    let known = Limits::default();
    let limits = Limits {
        length: or("length", c.length, known.length)?,
        duration: or("duration", c.duration, known.duration)?,
        vertices: match c.most_vertices {
            0 => known.vertices,
            most => most as usize,
        },
        tolerance: or("tolerance", c.tolerance, known.tolerance)?,
    };
    let grid = Grid {
        dims: c.dims,
        world_from_voxel: affine("sv_trace_desc.world_from_voxel", &c.world_from_voxel)?,
    };
    let determinant = grid.world_from_voxel.matrix3.determinant();
    let is_box = determinant != 0.0 && determinant.is_finite();
    let name = "sv_trace_desc.world_from_voxel: its determinant";
    number(name, "not 0", determinant, is_box)?;
    // SAFETY: the caller's promise.
    let (velocities, times, seeds) = unsafe {
        let name = "sv_trace_desc.velocities";
        let velocities = structure::array(name, c.velocities, wanted, MOST_NUMBERS)?;
        let numbers = c.seed_count.saturating_mul(3);
        let seeds = structure::array("sv_trace_desc.seeds", c.seeds, numbers, 3 * MOST_SEEDS)?;
        let times = match c.time_count {
            0 | 1 if c.times.is_null() => &[0.0],
            _ => {
                let name = "sv_trace_desc.times";
                structure::array(name, c.times, times.into(), MOST_TIMES)?
            }
        };
        (
            velocities.as_chunks::<3>().0,
            times,
            seeds.as_chunks::<3>().0,
        )
    };
    let [nx, ny, _] = c.dims.map(|n| n as usize);
    let at = |[x, y, z]: [u32; 3]| (z as usize * ny + y as usize) * nx + x as usize;
    let snapshot =
        |numbers: &[[f32; 3]]| Snapshot::from_fn(&grid, |voxel| Some(numbers[at(voxel)]));
    let snapshots = velocities.chunks_exact(velocities.len() / times.len());
    let snapshots = times.iter().copied().zip(snapshots.map(snapshot));
    let field = GridField::new(grid, snapshots.collect(), Metric::plain(1.0))?;
    let [first, last] = [times[0], times[times.len() - 1]];
    let moment = |name: &str, found: f64, [first, last]: [f64; 2]| {
        let is_within = (first..=last).contains(&found) || times.len() == 1 && found.is_finite();
        let wanted = format!("{first} to {last}");
        let name = format!("sv_trace_desc.{name}");
        number(&name, &wanted, found, is_within).map(|()| found)
    };
    let start = moment("start", c.start, [first, last])?;
    if c.seeds.is_null() {
        let known = EvenLines::of(&grid, 1.0);
        let spacing = EvenLines {
            distance: or("spacing", c.spacing, known.distance)?,
            most: match c.most_lines {
                0 => known.most,
                most => most as usize,
            },
            most_vertices: usize::MAX,
            ..known
        };
        let mut told = |_: &Line, _| {};
        return Ok(even_stream_lines(
            &field, start, &grid, spacing, direction, &limits, &mut told,
        ));
    }
    let seeds = seeds
        .iter()
        .map(|&seed| finite("sv_trace_desc.seeds", seed));
    let seeds: Vec<DVec3> = seeds.collect::<Result<_, _>>()?;
    Ok(match kind {
        Lines::Stream => stream_lines(&field, start, &seeds, direction, &limits),
        Lines::Path => path_lines(&field, start, &seeds, direction, &limits),
        Lines::Streak => {
            let end = moment("end", c.end, [start, last])?;
            streak_lines(&field, [start, end], &seeds, &limits)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cause_of_c_is_the_end_of_the_same_name() {
        let source = include_str!("lines.rs");
        let rows = source.matches("\n    SV_CAUSE_").count();
        assert_eq!(rows, End::ALL.len() + 1);
        for end in End::ALL {
            let name = end.name().replace('-', "_").to_uppercase();
            let row = format!("    SV_CAUSE_{name} = {},\n", end.number());
            assert!(source.contains(&row), "{row}");
        }
    }
}
