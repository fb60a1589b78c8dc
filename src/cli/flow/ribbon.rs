//! Ribbons: strips along lines that turn as the air around them does.
//!
//! ```text
//! angle   d theta / dt = 1/2 curl v . v / |v|        the turn of a particle about its way (Batchelor 1967, 2.3)
//! side    of a place: that of the one before without its part along the line, turned about it by the change of theta;
//!         level at the begin
//! ```
//!
//! The curl is by central differences of half a cell, one-sided where the wind ends; angles are those of the world before
//! heights are exaggerated.

use super::surface::{Corner, Surface};
use crate::flow::{VectorField, Vertex};
use glam::{DMat3, DQuat, DVec3};

/// How far a ribbon is turned at each vertex, radians, by the wind at a time of its own or at those of the vertices.
pub(super) fn turns(field: &impl VectorField, vertices: &[Vertex], at: Option<f64>) -> Vec<f64> {
    let rates = vertices.iter().map(|vertex| {
        let time = at.unwrap_or(vertex.time);
        let along = field.velocity(time, vertex.place).unwrap_or_default();
        0.5 * curl(field, time, vertex.place).dot(along.normalize_or_zero())
    });
    let rates: Vec<f64> = rates.collect();
    let mut angle = 0.0;
    let mut turns = vec![0.0; vertices.len().min(1)];
    for (pair, rates) in vertices.windows(2).zip(rates.windows(2)) {
        angle += 0.5 * (rates[0] + rates[1]) * (pair[1].time - pair[0].time);
        turns.push(angle);
    }
    turns
}

/// Of the velocity, by differences along the axes of the grid.
fn curl(field: &impl VectorField, time: f64, place: DVec3) -> DVec3 {
    let cells = field.cells_from_world();
    let world_from_cells = cells.inverse();
    let middle = field.velocity(time, place).ok();
    let along = |cell: DVec3| {
        let ends = [0.5, -0.5].map(|half| field.velocity(time, place + half * cell).ok());
        match (ends, middle) {
            ([Some(a), Some(b)], _) => a - b,
            ([Some(a), None], Some(middle)) => 2.0 * (a - middle),
            ([None, Some(b)], Some(middle)) => 2.0 * (middle - b),
            _ => DVec3::ZERO,
        }
    };
    let [x, y, z] = [0, 1, 2].map(|k| along(world_from_cells.col(k)));
    // Columns: what velocities change by along x, y and z of the world.
    let change = DMat3::from_cols(x, y, z) * cells;
    let [x, y, z] = [change.x_axis, change.y_axis, change.z_axis];
    DVec3::new(y.z - z.y, z.x - x.z, x.y - y.x)
}

/// The strip along a line, so wide to each side, turned by an angle at each place.
pub(super) fn strip(line: &[(DVec3, [f32; 3])], turns: &[f64], half_width: f64) -> Surface {
    let mut surface = Surface::default();
    let last = line.len().saturating_sub(1);
    let mut side: Option<DVec3> = None;
    let mut before = 0.0;
    for (i, (&(place, color), &turn)) in line.iter().zip(turns).enumerate() {
        let ends = [i.saturating_sub(1), (i + 1).min(last)];
        let along = (line[ends[1]].0 - line[ends[0]].0).normalize_or_zero();
        let level = || DVec3::Z.cross(along);
        let turned = side.map(|side| DQuat::from_axis_angle(along, turn - before) * side);
        let across = turned.unwrap_or_else(level);
        let across = (across - across.dot(along) * along).try_normalize();
        let across = across.unwrap_or_else(|| match along.try_normalize() {
            Some(along) => along.any_orthonormal_vector(),
            None => DVec3::X,
        });
        side = Some(across);
        before = turn;
        let normal = along.cross(across).normalize_or(DVec3::Z);
        for sign in [-1.0, 1.0] {
            surface.corners.push(Corner {
                place: place + sign * half_width * across,
                normal,
                color,
            });
        }
    }
    for i in 0..last as u32 {
        let [a, b, c, d] = [2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3];
        surface.triangles.extend([[a, b, d], [a, d, c]]);
    }
    surface
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::Absence;

    /// A turn about the axis (1, 2, 2) / 3 by so many radians a second, and a wind along it.
    struct Screw(f64);

    const AXIS: DVec3 = DVec3::new(1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0);

    impl VectorField for Screw {
        fn velocity(&self, _: f64, place: DVec3) -> Result<DVec3, Absence> {
            Ok(self.0 * AXIS.cross(place) + 3.0 * AXIS)
        }

        fn cells_from_world(&self) -> DMat3 {
            // Cells that are no cubes and do not stand along the axes.
            DMat3::from_cols(
                DVec3::new(2.0, 0.3, 0.0),
                DVec3::Y,
                DVec3::new(0.1, 0.0, 5.0),
            )
        }
    }

    #[test]
    fn on_the_axis_of_a_turn_a_ribbon_turns_as_fast() {
        for rate in [0.7, -1.9] {
            let vertices = (0..9).map(f64::from).map(|n| Vertex {
                place: 1.5 * n * AXIS,
                time: 0.5 * n - 1.0,
                speed: 3.0,
            });
            let vertices: Vec<Vertex> = vertices.collect();
            let found = turns(&Screw(rate), &vertices, None);
            for (n, found) in found.iter().enumerate() {
                let wanted = rate * 0.5 * n as f64;
                assert!((found - wanted).abs() < 1e-12, "{n}: {found} {wanted}");
            }
            // A corner of the strip goes around the axis with the air.
            let line = vertices.iter().map(|vertex| (vertex.place, [0.5; 3]));
            let strip = strip(&line.collect::<Vec<_>>(), &found, 2.0);
            let out = |n: usize| strip.corners[2 * n + 1].place - vertices[n].place;
            for (n, turn) in found.iter().enumerate() {
                let wanted = DQuat::from_axis_angle(AXIS, *turn) * out(0);
                assert!((out(n) - wanted).length() < 1e-12, "{n}");
                assert!((out(n).length() - 2.0).abs() < 1e-12);
            }
            assert_eq!(strip.triangles.len(), 16);
        }
    }

    #[test]
    fn a_ribbon_begins_level_and_stays_so_in_air_that_does_not_turn() {
        let line = (0..20).map(|n| {
            let t = f64::from(n) * 0.3;
            (DVec3::new(t.cos(), t.sin(), 0.0), [0.5; 3])
        });
        let line: Vec<_> = line.collect();
        let strip = strip(&line, &[0.0; 20], 0.1);
        assert!(strip.corners.iter().all(|c| c.place.z == 0.0));
        assert!(
            strip
                .corners
                .iter()
                .all(|c| (c.normal.z.abs() - 1.0).abs() < 1e-12)
        );
    }
}
