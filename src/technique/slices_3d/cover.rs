//! Where a plane cuts the enlarged domain: CPU reference of `shaders/slices_3d_cover.wgsl`.
//!
//! Corners are numbered from the one nearest the eye along three paths to the farthest; a plane meets each
//! path once, and the three edges between two paths at most once. Rezk-Salama and Kolb, "A Vertex Program
//! for Efficient Box-Plane Intersection", VMV 2005.

use crate::ray::vector;
use crate::real::{Real, add, dot, scale, sub};
use crate::shaders::Frame;

/// Corner j of the box as steps along x, y, z from the nearest corner.
const CORNERS: [[bool; 3]; 8] = [
    [false, false, false],
    [true, false, false],
    [false, true, false],
    [false, false, true],
    [true, false, true],
    [true, true, false],
    [false, true, true],
    [true, true, true],
];

/// Vertex i: a path of three edges from corner 0 to corner 7; odd vertices try an edge of their own before it.
const EDGES: [[[usize; 2]; 4]; 6] = [
    [[0, 1], [1, 4], [4, 7], [4, 7]],
    [[1, 5], [0, 1], [1, 4], [4, 7]],
    [[0, 2], [2, 5], [5, 7], [5, 7]],
    [[2, 6], [0, 2], [2, 5], [5, 7]],
    [[0, 3], [3, 6], [6, 7], [6, 7]],
    [[3, 4], [0, 3], [3, 6], [6, 7]],
];

/// The six corners, in order, of the polygon in which plane `plane` cuts the cover, in the centred world.
/// Neighbours may be equal; a plane that misses the cover has all six in one point.
pub fn polygon<R: Real>(frame: &Frame, plane: i32) -> [[R; 3]; 6] {
    let height = (R::from_f64(f64::from(plane)) + R::from_f64(0.5)) * R::from_f32(frame.step_world);
    std::array::from_fn(|i| vertex(frame, i, height))
}

/// Heights rise along a path, so its first edge that ends above the plane is the one, however the division
/// rounds.
fn vertex<R: Real>(frame: &Frame, i: usize, height: R) -> [R; 3] {
    let forward = vector(frame.forward);
    let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
    for (e, [from, to]) in EDGES[i].into_iter().enumerate() {
        let (a, b) = (corner(frame, from), corner(frame, to));
        let rise = dot(forward, sub(b, a));
        let part = (height - dot(forward, a)) / rise.max(R::from_f32(1e-20));
        let is_own_edge = e == 0 && i % 2 == 1;
        if part <= one && (part >= zero || !is_own_edge) {
            return add(a, scale(sub(b, a), part.max(zero)));
        }
    }
    corner(frame, 7)
}

/// Corner j, counted from the one with the smallest forward . x.
fn corner<R: Real>(frame: &Frame, j: usize) -> [R; 3] {
    let voxel: [R; 3] = std::array::from_fn(|k| {
        let rises = frame.forward_voxel[k] >= 0.0;
        let is_high = CORNERS[j][k] == rises;
        R::from_f32(if is_high {
            frame.cover_max[k]
        } else {
            frame.cover_min[k]
        })
    });
    frame
        .world_from_voxel
        .map(|[x, y, z, w]| dot(voxel, vector([x, y, z])) + R::from_f32(w))
}
