//! Lines, barbs and the ground as they are drawn for a camera.
//!
//! ```text
//! radius = width / 2 pixels where the camera is turned to; of kilometres at least 0.6 pixels there
//! map    at sea level; on a level section of the Earth at the face of the slab that is seen
//! head   a round cone from 2.8 radii to none, 10 radii long, every 60 pixels; of a comet its end (`moving`)
//! ```

use super::drawn::{DrawnLines, Width};
use super::ribbon::strip;
use super::style::THINNEST_PIXELS;
use crate::camera::Camera;
use crate::geometry::{Geometry, RoundCones, Triangles, Vertex};
use glam::DVec3;

/// Of arrow heads: how far apart in pixels, how wide and how long in radii.
const APART_PIXELS: f64 = 60.0;
const HEAD_RADII: f64 = 2.8;
const HEAD_LENGTH_RADII: f64 = 10.0;
/// A direction that differs by less from straight down looks straight down.
const LEVEL: f64 = 1e-9;

impl DrawnLines {
    /// As they are drawn for this camera in a picture of so many pixels.
    pub fn geometry(&self, camera: &Camera, extent_pixels: [u32; 2]) -> Geometry {
        let pixel = pixel_at_target(camera, extent_pixels);
        let forward = camera.frame().forward;
        let is_level = forward.z.abs() > 1.0 - LEVEL;
        let mut cones = RoundCones::default();
        let mut triangles = match &self.ground {
            Some(ground) => ground.triangles.clone(),
            None => Triangles::default(),
        };
        let to_eye = |place: DVec3| match camera.projection.is_perspective() {
            true => (camera.eye - place).normalize_or_zero(),
            false => -forward,
        };
        for set in &self.sets {
            let widest = match set.width {
                Width::Pixels(width) => 0.5 * width * pixel,
                Width::World(width) => 0.5 * width.max(THINNEST_PIXELS * pixel),
            };
            if let Some(turns) = &set.turns {
                for (line, turns) in set.lines.iter().zip(turns) {
                    strip(line, turns, widest).add(&mut triangles, to_eye);
                }
                continue;
            }
            let height = set.on_section.filter(|_| is_level);
            let height = height.map(|half| camera.target.z - half * forward.z);
            for (i, line) in set.lines.iter().enumerate() {
                let radius = widest * set.shares.as_ref().map_or(1.0, |shares| shares[i]);
                let lift = match set.is_lifted {
                    true => radius * DVec3::Z,
                    false => DVec3::ZERO,
                };
                let vertex = |&(place, color): &(DVec3, [f32; 3])| Vertex {
                    place: lift
                        + DVec3 {
                            z: height.unwrap_or(place.z),
                            ..place
                        },
                    radius,
                    color,
                };
                let number = set.numbers.as_ref().map_or(0, |numbers| numbers[i]);
                let taper = set.tapers.as_ref().map(|tapers| &tapers[i]);
                match (&line[..], set.shares.is_some(), taper) {
                    ([symbol], true, _) => cones.add_symbol(vertex(symbol)),
                    (_, _, None) => cones.add_line_of(number, line.iter().map(vertex)),
                    (_, _, Some(taper)) => {
                        let tapered = line.iter().zip(taper).map(|(place, share)| Vertex {
                            radius: share * radius,
                            ..vertex(place)
                        });
                        cones.add_line_of(number, tapered);
                    }
                }
                if set.has_heads {
                    add_heads(&mut cones, (line, number), radius, APART_PIXELS * pixel);
                }
            }
        }
        for surface in &self.surfaces {
            surface.add(&mut triangles, to_eye);
        }
        let mut geometry = Geometry { cones, triangles };
        if let Some(barbs) = &self.barbs {
            barbs.add(&mut geometry, pixel, to_eye);
        }
        geometry
    }
}

/// World length of a pixel at the distance of the target.
pub(super) fn pixel_at_target(camera: &Camera, extent_pixels: [u32; 2]) -> f64 {
    let rays = camera.rays(extent_pixels);
    match camera.projection.is_perspective() {
        true => rays.direction_dx.length() * (camera.target - camera.eye).dot(rays.forward),
        false => rays.origin_dx.length(),
    }
}

/// Heads along a line; one in its middle where it is short.
fn add_heads(
    cones: &mut RoundCones,
    (line, number): (&[(DVec3, [f32; 3])], u32),
    radius: f64,
    apart: f64,
) {
    let chords = || line.windows(2).map(|pair| (pair[1].0 - pair[0].0).length());
    let length: f64 = chords().sum();
    if length < HEAD_LENGTH_RADII * radius {
        return;
    }
    let count = (length / apart).floor().max(1.0);
    let mut next = 0.5 * length / count;
    let mut done = 0.0;
    for pair in line.windows(2) {
        let [(a, color), (b, _)] = [pair[0], pair[1]];
        let chord = (b - a).length();
        while next <= done + chord && next < length {
            let along = (b - a) / chord;
            let place = a + (next - done) * along;
            let end = |place, radius| Vertex {
                place,
                radius,
                color,
            };
            let tip = place + HEAD_LENGTH_RADII * radius * along;
            let ends = [end(place, HEAD_RADII * radius), end(tip, 0.05 * radius)];
            cones.add_line_of(number, ends);
            next += length / count;
        }
        done += chord;
    }
}
