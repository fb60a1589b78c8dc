//! Lines as coloured tubes.
//!
//! ```text
//! colour = map((value - low) / (high - low)),   low 0 of speeds, else the lowest value;   high: 99.9 % of vertices are under it
//! ```

use crate::flow::Line;
use crate::flow::write::{LineValues, tubes};
use crate::mesh::MeshFormat;
use crate::transfer::Colormap;
use glam::Vec3;
use std::io::{self, Write};

/// A tube's radius as a part of the box's diagonal.
const RADIUS: f64 = 1e-3;
/// Colours span up to the value that this part of the vertices does not exceed.
const MOST: f64 = 0.999;

/// Writes tubes around the lines, in one colour or in those of their values.
pub(super) fn write_tubes(
    lines: &[Line],
    values: &LineValues,
    diagonal: f64,
    one: Option<[f32; 3]>,
    out: &mut impl Write,
) -> io::Result<()> {
    let [low, high] = range(values);
    let map = Colormap::from_name("wind");
    let color = |line: usize, vertex: usize| {
        if let Some(color) = one {
            return Vec3::from_array(color.map(linear_of_srgb));
        }
        let value = values.numbers[line][vertex];
        let part = ((value - low) / (high - low)).clamp(0.0, 1.0);
        match map.filter(|_| part.is_finite()) {
            Some(map) => Vec3::from_array(map.srgb(part).map(|n| linear_of_srgb(n as f32))),
            None => Vec3::splat(0.5),
        }
    };
    let mesh = tubes(lines, RADIUS * diagonal, color).ok_or_else(|| {
        io::Error::new(
            io::ErrorKind::InvalidData,
            "more than 2^32 corners of tubes",
        )
    })?;
    mesh.write(MeshFormat::Glb, out)
}

/// From 0, or the lowest value where it is under that, to what few vertices exceed.
fn range(values: &LineValues) -> [f64; 2] {
    let all = values.numbers.iter().flatten().copied();
    let mut all: Vec<f64> = all.filter(|n| n.is_finite()).collect();
    if all.is_empty() {
        return [0.0, 1.0];
    }
    all.sort_by(f64::total_cmp);
    let low = if values.name == "speed" { 0.0 } else { all[0] };
    let high = all[(MOST * (all.len() - 1) as f64) as usize];
    [low, if high > low { high } else { low + 1.0 }]
}

fn linear_of_srgb(n: f32) -> f32 {
    match n <= 0.040_45 {
        true => n / 12.92,
        false => ((n + 0.055) / 1.055).powf(2.4),
    }
}
