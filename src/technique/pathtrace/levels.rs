//! Surfaces of values on the way of a path: CPU reference of `shaders/lib/crossing_levels.wgsl`, which says how they are found.

use crate::ray::Ray;
use crate::real::{Real, dot};
use crate::shaders::Frame;
use crate::technique::Filter;
use crate::technique::cell_cubic::Cubic;
use crate::technique::reference::Samples;

/// Where a walk is among the values of surfaces.
#[derive(Clone, Copy, Debug)]
pub(super) struct AmongLevels<R> {
    cell: Option<[i32; 3]>,
    leave: [R; 3],
    /// How many levels lie at or under the value, here and before the last step; `None`: it is to be looked up.
    pub rank: Option<usize>,
    pub before: Option<usize>,
    /// At a surface, how steep the field is along each axis.
    slope: [R; 3],
    /// Across the face that the walk has come into the cell by.
    face: [R; 3],
}

impl<R: Real> AmongLevels<R> {
    pub fn from_rank(rank: Option<usize>) -> Self {
        let zero = [R::from_f64(0.0); 3];
        Self {
            cell: None,
            leave: zero,
            rank,
            before: rank,
            slope: zero,
            face: zero,
        }
    }

    pub fn has_crossed(&self) -> bool {
        self.rank != self.before
    }

    /// Colour and opacity of the surface that the last step ends at.
    pub fn surface(&self, frame: &Frame) -> Option<[R; 4]> {
        let index = self.rank?.min(self.before?);
        self.has_crossed()
            .then(|| frame.level_colors[index].map(R::from_f32))
    }

    /// The normal of that surface, on the side that the path comes from.
    pub fn normal(&self, frame: &Frame, incoming: [R; 3]) -> [R; 3] {
        let rows = frame
            .voxel_from_world
            .map(|row| [row[0], row[1], row[2]].map(R::from_f32));
        let slope = self.slope;
        let gradient: [R; 3] = std::array::from_fn(|k| {
            rows[0][k] * slope[0] + rows[1][k] * slope[1] + rows[2][k] * slope[2]
        });
        let steepness = dot(gradient, gradient).sqrt();
        let normal = gradient.map(|g| g / steepness);
        match dot(normal, incoming) > R::from_f64(0.0) {
            true => normal.map(|n| -n),
            false => normal,
        }
    }

    /// Takes a walk at t into its cell: how far that goes.
    pub fn enter(&mut self, of: &impl Samples<R>, voxel: &Ray<R>, t: R) -> R {
        let begin = begin_of_cells(of);
        let tiny = R::from_f32(1e-20);
        let cell = match self.cell {
            Some(cell) => cell,
            None => {
                self.face = face_across(axis_of(voxel.direction.map(R::abs)));
                voxel.at(t).map(|x| (x - begin).floor().to_i32())
            }
        };
        self.cell = Some(cell);
        self.leave = std::array::from_fn(|k| {
            let d = voxel.direction[k];
            let along = if d.abs() < tiny { tiny } else { d };
            let upper = i32::from(along > R::from_f64(0.0));
            let plane = R::from_f64((cell[k] + upper).into()) + begin;
            (plane - voxel.origin[k]) / along
        });
        self.end().max(t)
    }

    fn end(&self) -> R {
        let [x, y, z] = self.leave;
        x.min(y.min(z))
    }

    /// From start to end, or to the first surface between: where it ends.
    pub fn step(&mut self, of: &impl Samples<R>, voxel: &Ray<R>, [start, end]: [R; 2]) -> R {
        let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
        let is_at_surface = self.has_crossed();
        self.before = self.rank;
        let Some(cell) = self.cell else {
            return end;
        };
        let begin = begin_of_cells(of);
        let at = voxel.at(start);
        let place = std::array::from_fn(|k| at[k] - begin - R::from_f64(cell[k].into()));
        if let Some(corners) = corners(of, cell, place, voxel.direction) {
            let cubic = Cubic::along(&corners, place, voxel.direction);
            let rank = match self.rank {
                Some(rank) => rank,
                None => rank_of(of.frame(), cubic.0[0]),
            };
            (self.rank, self.before) = (Some(rank), Some(rank));
            if let Some((s, is_up)) = met(of.frame(), rank, is_at_surface, cubic, end - start) {
                self.rank = Some(if is_up { rank + 1 } else { rank - 1 });
                let part =
                    std::array::from_fn(|k| (place[k] + s * voxel.direction[k]).max(zero).min(one));
                let slope = slope(&corners, part);
                self.slope = match slope.iter().all(|&s| s == zero) {
                    true => self.face,
                    false => slope,
                };
                return start + s;
            }
        } else {
            (self.rank, self.before) = (None, None);
        }
        if end >= self.end() {
            let axis = axis_of(self.leave.map(|t| -t));
            self.face = face_across(axis);
            let mut next = cell;
            next[axis] += if voxel.direction[axis] > zero { 1 } else { -1 };
            self.cell = Some(next);
        }
        end
    }
}

/// Where filters are linear cells lie between eight voxel centres, else they are those of voxels.
fn begin_of_cells<R: Real>(of: &impl Samples<R>) -> R {
    R::from_f64(match of.settings().filter {
        Filter::Nearest => 0.0,
        _ => 0.5,
    })
}

/// The values at the corners of a cell; `None` where one has no data.
fn corners<R: Real>(
    of: &impl Samples<R>,
    cell: [i32; 3],
    place: [R; 3],
    direction: [R; 3],
) -> Option<[R; 8]> {
    let zero = R::from_f64(0.0);
    let is_nearest = of.settings().filter == Filter::Nearest;
    // Along an axis on which a ray stays at voxel centres the upper corner has no weight.
    let stays: [bool; 3] =
        std::array::from_fn(|k| is_nearest || (place[k] == zero && direction[k] == zero));
    let mut corners = [zero; 8];
    for (i, corner) in corners.iter_mut().enumerate() {
        let voxel = std::array::from_fn(|k| {
            let up = (i >> k & 1) as i32 * i32::from(!stays[k]);
            (cell[k] + up).clamp(0, of.dim(k) as i32 - 1)
        });
        *corner = of.voxel(voxel)?;
    }
    Some(corners)
}

fn rank_of<R: Real>(frame: &Frame, value: R) -> usize {
    let levels = &frame.level_values[..frame.level_count as usize];
    let at_or_under = levels.iter().filter(|level| R::from_f32(level[0]) <= value);
    at_or_under.count()
}

/// How far away the first surface is within a length, and whether values rise through it.
fn met<R: Real>(
    frame: &Frame,
    rank: usize,
    is_at_surface: bool,
    cubic: Cubic<R>,
    length: R,
) -> Option<(R, bool)> {
    let zero = R::from_f64(0.0);
    let levels = &frame.level_values[..frame.level_count as usize];
    let level = |i: usize| levels.get(i).map(|level| R::from_f32(level[0]));
    let (low, high) = (rank.checked_sub(1).and_then(level), level(rank));
    let [a, b] = cubic.extremes().map(|s| s.max(zero).min(length));
    let ends = [zero, a.min(b), a.max(b), length];
    let beyond = |value: R| match (low, high) {
        (Some(low), _) if value < low => Some((low, false)),
        (_, Some(high)) if value >= high => Some((high, true)),
        _ => None,
    };
    let mut ends = ends.into_iter().enumerate();
    let (i, (end, (level, is_up))) = ends.find_map(|(i, s)| {
        // Where the last surface was, rounding says on which side the value is.
        let is_behind = !is_at_surface || s > zero;
        Some((i, (s, beyond(cubic.at(s)).filter(|_| is_behind)?)))
    })?;
    let near = [zero, zero, a.min(b), a.max(b)][i];
    Some((crossing(cubic, level, [near, end]), is_up))
}

/// Where a cubic that only rises or only falls between two ends has a value.
fn crossing<R: Real>(cubic: Cubic<R>, level: R, [mut near, mut far]: [R; 2]) -> R {
    let (zero, half, one, two) = (
        R::from_f64(0.0),
        R::from_f64(0.5),
        R::from_f64(1.0),
        R::from_f64(2.0),
    );
    let [_, a1, a2, a3] = cubic.0;
    let [from, to] = [near, far].map(|s| cubic.at(s));
    // Without a way between the ends, or a value, the first end is it.
    let part = match to == from {
        true => zero,
        false => (level - from) / (to - from),
    };
    let mut s = near + part.max(zero).min(one) * (far - near);
    for _ in 0..6 {
        let over = cubic.at(s) - level;
        if (over >= zero) == (to >= level) {
            far = s;
        } else {
            near = s;
        }
        let newton = s - over / (a1 + s * (two * a2 + s * a3));
        s = match newton >= near && newton <= far {
            true => newton,
            false => half * (near + far),
        };
    }
    s
}

/// How steep the field is along each axis.
fn slope<R: Real>(c: &[R; 8], [x, y, z]: [R; 3]) -> [R; 3] {
    let along = |step: usize, from: [usize; 4], [u, v]: [R; 2]| {
        let rise = from.map(|i| c[i + step] - c[i]);
        rise[0].lerp(rise[1], u).lerp(rise[2].lerp(rise[3], u), v)
    };
    [
        along(1, [0, 2, 4, 6], [y, z]),
        along(2, [0, 1, 4, 5], [x, z]),
        along(4, [0, 1, 2, 3], [x, y]),
    ]
}

fn axis_of<R: Real>([x, y, z]: [R; 3]) -> usize {
    if x >= y.max(z) {
        0
    } else if y >= z {
        1
    } else {
        2
    }
}

fn face_across<R: Real>(axis: usize) -> [R; 3] {
    std::array::from_fn(|k| R::from_f64(f64::from(u8::from(k == axis))))
}
