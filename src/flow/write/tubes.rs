//! Lines as tubes of eight sides, with a colour at each corner.
//!
//! ```text
//! ring j of vertex i    p_i + r (cos(j pi/4) a_i + sin(j pi/4) b_i)
//! a_(i+1)               a_i without its part along the next tangent: the frame turns no more than the line does
//! ```

use crate::flow::line::Line;
use crate::mesh::Mesh;
use glam::{DVec3, Vec3};
use std::f64::consts::FRAC_PI_4;

/// Sides of a tube.
const SIDES: u32 = 8;

/// The tubes around the pieces of all lines; `color` is the linear colour of a vertex, by its line and its number. `None` where
/// there are more than 2^32 corners.
pub fn tubes(lines: &[Line], radius: f64, color: impl Fn(usize, usize) -> Vec3) -> Option<Mesh> {
    let mut mesh = Mesh::default();
    for (number, line) in lines.iter().enumerate() {
        for range in line.piece_ranges() {
            let kept = apart(line, range);
            if kept.len() > 1 {
                let places: Vec<DVec3> = kept.iter().map(|&i| line.vertices[i].place).collect();
                let colors = kept.iter().map(|&i| color(number, i));
                tube(&mut mesh, &places, colors, radius)?;
            }
        }
    }
    Some(mesh)
}

/// The vertices that are somewhere else than the one before.
fn apart(line: &Line, range: std::ops::Range<usize>) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    for i in range {
        let place = line.vertices[i].place;
        if kept
            .last()
            .is_none_or(|&last| line.vertices[last].place != place)
        {
            kept.push(i);
        }
    }
    kept
}

fn tube(
    mesh: &mut Mesh,
    places: &[DVec3],
    colors: impl Iterator<Item = Vec3>,
    radius: f64,
) -> Option<()> {
    let first = u32::try_from(mesh.positions.len()).ok()?;
    let count = u32::try_from(places.len()).ok()?;
    // The corners of both caps stand behind the rings.
    let corners = count.checked_mul(SIDES)?.checked_add(2)?;
    first.checked_add(corners)?;
    let way = |i: usize, j: usize| (places[j] - places[i]).normalize_or_zero();
    let last = places.len() - 1;
    let mut across = way(0, 1).any_orthonormal_vector();
    let mut tints = Vec::with_capacity(places.len());
    for ((i, &place), tint) in places.iter().enumerate().zip(colors) {
        let along = way(i.saturating_sub(1), i) + way(i, (i + 1).min(last));
        let along = along.try_normalize().unwrap_or(way(i.saturating_sub(1), i));
        let turned = across - across.dot(along) * along;
        across = turned
            .try_normalize()
            .unwrap_or(along.any_orthonormal_vector());
        let other = along.cross(across);
        for side in 0..SIDES {
            let (sin, cos) = (f64::from(side) * FRAC_PI_4).sin_cos();
            mesh.positions
                .push(place + radius * (cos * across + sin * other));
            mesh.colors.push(tint);
        }
        tints.push(tint);
    }
    for end in [0, last] {
        mesh.positions.push(places[end]);
        mesh.colors.push(tints[end]);
    }
    let corner = |ring: u32, side: u32| first + ring * SIDES + side % SIDES;
    let [low, high] = [first + count * SIDES, first + count * SIDES + 1];
    for side in 0..SIDES {
        for ring in 0..count - 1 {
            let [a, b] = [corner(ring, side), corner(ring, side + 1)];
            let [c, d] = [corner(ring + 1, side), corner(ring + 1, side + 1)];
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
        mesh.triangles
            .push([low, corner(0, side + 1), corner(0, side)]);
        mesh.triangles
            .push([high, corner(count - 1, side), corner(count - 1, side + 1)]);
    }
    Some(())
}
