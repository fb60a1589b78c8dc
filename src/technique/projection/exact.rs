//! The exact extreme of the trilinear field along a ray: CPU reference of `shaders/projection_cells.wgsl`.
//!
//! ```text
//! f(s) = A0 + A1 s + A2 s^2 + A3 s^3        along the ray in a cell between eight voxel centres
//! ```
//!
//! has its extremes where the ray enters or leaves the cell or where A1 + 2 A2 s + 3 A3 s^2 = 0 (Sakas, Grimm and
//! Savopoulos, "Optimized Maximum Intensity Projection", Eurographics Workshop on Rendering 1995). A MIP of samples a
//! step h apart is never above, and at most h / 2 times the steepest slope below.

use super::reference::Projected;
use crate::lattice::Segment;
use crate::ray::{Ray, domain_interval, pixel_ray, voxel_ray};
use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::Mode;
use crate::technique::cell_cubic::{Cubic, mixed};

/// What one ray projects, and how many cells it looked at. `voxel_at` gives the value of a voxel, `None` for no data.
pub fn project_exactly<R: Real>(
    frame: &Frame,
    mode: Mode,
    pixel: [R; 2],
    voxel_at: impl Fn([i32; 3]) -> Option<R>,
) -> (Projected<R>, u32) {
    let mut so_far = Projected::default();
    let mut cells = 0;
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let [t0, t1] = domain_interval(frame, &world, &voxel);
    if t0 >= t1 {
        return (so_far, 0);
    }
    let (zero, half, one) = (R::from_f64(0.0), R::from_f64(0.5), R::from_f64(1.0));
    let tiny = R::from_f32(1e-20);
    let direction = voxel
        .direction
        .map(|d| if d.abs() < tiny { tiny } else { d });
    let mut cell = voxel.at(t0).map(|x| (x - half).floor().to_i32());
    // A ray crosses no more planes between voxel centres than there are.
    let most = frame.dims.iter().sum::<f32>() as u32 + 8;
    for _ in 0..most {
        let face = |k: usize, is_upper: bool| {
            let at = R::from_f64(f64::from(cell[k])) + if is_upper { one + half } else { half };
            (at - voxel.origin[k]) / direction[k]
        };
        let enter: [R; 3] = std::array::from_fn(|k| face(k, direction[k] < zero));
        let leave: [R; 3] = std::array::from_fn(|k| face(k, direction[k] > zero));
        let first = enter[0].max(enter[1]).max(enter[2].max(t0));
        let next = leave[0].min(leave[1]).min(leave[2]);
        let last = next.min(t1);
        if first <= last
            && with_cell(
                frame,
                mode,
                &voxel,
                cell,
                [first, last],
                &voxel_at,
                &mut so_far,
            )
        {
            cells += 1;
        }
        if next >= t1 {
            break;
        }
        let axis = (0..2).find(|&k| leave[k] == next).unwrap_or(2);
        cell[axis] += if direction[axis] > zero { 1 } else { -1 };
    }
    (so_far, cells)
}

/// Takes in the extremes of one cell; false where it has no data.
fn with_cell<R: Real>(
    frame: &Frame,
    mode: Mode,
    voxel: &Ray<R>,
    cell: [i32; 3],
    [first, last]: [R; 2],
    voxel_at: impl Fn([i32; 3]) -> Option<R>,
    so_far: &mut Projected<R>,
) -> bool {
    let (zero, half, one) = (R::from_f64(0.0), R::from_f64(0.5), R::from_f64(1.0));
    let in_cell = |t: R| -> [R; 3] {
        let p = voxel.at(t);
        std::array::from_fn(|k| p[k] - half - R::from_f64(f64::from(cell[k])))
    };
    let start = in_cell(first);
    let last_index = frame.dims.map(|n| n as i32 - 1);
    // Along an axis on which the ray stays at voxel centres the upper corner has no weight.
    let stays: [bool; 3] = std::array::from_fn(|k| voxel.direction[k] == zero && start[k] == zero);
    let mut corners = [zero; 8];
    for (i, corner) in corners.iter_mut().enumerate() {
        let index = std::array::from_fn(|k| {
            let up = (i >> k & 1) as i32 * i32::from(!stays[k]);
            (cell[k] + up).clamp(0, last_index[k])
        });
        match voxel_at(index) {
            Some(value) => *corner = value,
            None => return false,
        }
    }
    let [a, b] = Cubic::along(&corners, start, voxel.direction).extremes();
    for t in [first, first + a.min(b), first + a.max(b), last] {
        if t >= first && t <= last {
            let value = mixed(&corners, in_cell(t).map(|p| p.max(zero).min(one)));
            // Of extremes there is no last one.
            let _goes_on = so_far.add(frame, mode, value, Segment { t, length: zero });
        }
    }
    true
}
