//! The value of each vertex: its true speed, or a variable between its voxels and times.
//!
//! ```text
//! value = lerp(a(p), b(p), (t - t_a) / (t_b - t_a)),  a, b trilinear at the two times around t
//! ```

use super::super::Error;
use super::variable::Variables;
use super::wind::Wind;
use crate::flow::Line;
use crate::flow::write::LineValues;
use crate::volume::{Volume, sample::linear};
use glam::DVec3;

/// The variable `name` along the lines; `at` is the time of a vertex in seconds.
pub fn along(
    lines: &[Line],
    name: &str,
    wind: &Wind,
    at: impl Fn(f64) -> f64,
    variables: &Variables<'_>,
) -> Result<LineValues, Error> {
    let source = variables.open(name)?;
    let times = source.header().times;
    let mut numbers: Vec<Vec<f64>> = lines
        .iter()
        .map(|line| vec![f64::NAN; line.vertices.len()])
        .collect();
    // Two times are in memory at once.
    let mut before: Option<(f64, Volume)> = None;
    for (k, &(time, seconds)) in wind.times.iter().enumerate() {
        let volume = variables.read(source.as_ref(), time.min(times.saturating_sub(1)), 0)?;
        let is_last = k + 1 == wind.times.len();
        for (line, numbers) in lines.iter().zip(&mut numbers) {
            for (vertex, number) in line.vertices.iter().zip(numbers) {
                let t = at(vertex.time);
                match &before {
                    Some((start, first)) if *start <= t && (t < seconds || is_last) => {
                        let part = ((t - start) / (seconds - start)).min(1.0);
                        let [a, b] = [first, &volume].map(|volume| value(volume, vertex.place));
                        *number = a + part * (b - a);
                    }
                    None if wind.times.len() == 1 || t < seconds => {
                        *number = value(&volume, vertex.place);
                    }
                    _ => {}
                }
            }
        }
        before = Some((seconds, volume));
    }
    Ok(LineValues {
        name: name.to_owned(),
        numbers,
    })
}

/// NaN outside of the volume and where it has no data.
fn value(volume: &Volume, place: DVec3) -> f64 {
    let p = volume.world_from_voxel.inverse().transform_point3(place);
    let is_inside = p.cmpge(DVec3::ZERO).all() && p.cmple(volume.grid().far_corner()).all();
    let found = is_inside
        .then(|| linear::<f64>(volume, p.to_array()))
        .flatten();
    found.unwrap_or(f64::NAN)
}
