//! What is left of light in matter that is the same all over a box, written a second time in f64: a path is one
//! straight line, and its depth the length of it that lies in the box.
//!
//! ```text
//! open = mean over paths w of exp(-s l)      l = length of { p + t w, start <= t <= end } in the box
//! ```
//!
//! `open` is known at the corners of voxels and trilinear between. It is read a cell nearer to where light comes from,
//! a cell being as long as the shortest spacing of voxels.

use super::PictureCase;
use crate::technique::Shadows;
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::PI;

/// Half of the paths all around.
const AROUND: u32 = 16;
/// Paths to a light that has a size.
const TO_LIGHT: u32 = 8;

/// What comes through to each place of a shot.
#[derive(Clone, Debug)]
pub struct Open {
    dims: [usize; 3],
    voxel_from_world: DMat3,
    reach: f64,
    strength: f64,
    all_around: Option<Vec<f64>>,
    lamps: Vec<Vec<f64>>,
}

impl Open {
    /// Where matter of one extinction fills what no crop cuts away.
    pub fn new(shot: &PictureCase, extinction: f64) -> Self {
        let voxel_from_world = shot.grid.world_from_voxel.matrix3.inverse();
        let crop = shot.settings.crop;
        let walls = crop.unwrap_or([DVec3::ZERO, shot.grid.far_corner()]);
        let reach = shot.grid.smallest_spacing();
        let dims = shot.grid.dims.map(|n| n as usize + 1);
        let nodes = || {
            let all = (0..dims[2]).flat_map(|z| (0..dims[1]).map(move |y| (y, z)));
            let all = all.flat_map(|(y, z)| (0..dims[0]).map(move |x| [x, y, z]));
            all.map(|node| DVec3::from_array(node.map(|n| n as f64)))
        };
        let through = |paths: Vec<DVec3>, part: [f64; 2]| -> Vec<f64> {
            let open = |node: DVec3| {
                let depth = |&way: &DVec3| {
                    extinction * length_in(walls, node, voxel_from_world * way, part)
                };
                let sum: f64 = paths.iter().map(|way| (-depth(way)).exp()).sum();
                sum / paths.len() as f64
            };
            nodes().map(open).collect()
        };
        let occlusion = shot.settings.ambient_occlusion;
        let all_around = occlusion.map(|occlusion| {
            let radius = occlusion.radius_world.expect("said by whoever asks");
            through(around(), [reach.min(0.5 * radius), radius])
        });
        let lamps = match &shot.settings.shading {
            Some(shading) => match shading.shadows {
                Shadows::Volume { light_size_degrees } => {
                    let paths = shading.lights.iter();
                    let paths = paths.map(|light| disc(light.towards, light_size_degrees));
                    paths
                        .map(|paths| through(paths, [0.0, f64::INFINITY]))
                        .collect()
                }
                _ => Vec::new(),
            },
            None => Vec::new(),
        };
        Self {
            dims,
            voxel_from_world,
            reach,
            strength: occlusion.map_or(0.0, |o| o.strength),
            all_around,
            lamps,
        }
    }

    /// Of light from all around, seen along a direction of the world.
    pub fn ambient(&self, place: DVec3, along: DVec3) -> f64 {
        let open = self.all_around.as_ref();
        let open = open.map_or(1.0, |open| self.at(open, place, -along));
        1.0 - self.strength * (1.0 - open)
    }

    /// Of a lamp.
    pub fn lamp(&self, lamp: usize, place: DVec3, towards: DVec3) -> f64 {
        let open = self.lamps.get(lamp);
        open.map_or(1.0, |open| self.at(open, place, towards))
    }

    fn at(&self, open: &[f64], place: DVec3, towards: DVec3) -> f64 {
        let nearer = place + self.voxel_from_world * (self.reach * towards);
        let far = DVec3::from_array(self.dims.map(|n| n as f64 - 1.0));
        let at = nearer.clamp(DVec3::ZERO, far);
        let [nx, ny, nz] = self.dims;
        let mut sum = 0.0;
        for z in 0..nz {
            let of_z = 1.0 - (at.z - z as f64).abs();
            for y in (0..ny).filter(|_| of_z > 0.0) {
                let of_y = 1.0 - (at.y - y as f64).abs();
                for x in (0..nx).filter(|_| of_y > 0.0) {
                    let of_x = (1.0 - (at.x - x as f64).abs()).max(0.0);
                    sum += of_x * of_y * of_z * open[x + nx * (y + ny * z)];
                }
            }
        }
        sum
    }
}

/// How much of a path lies in a box, between two lengths from where it begins.
fn length_in([low, high]: [DVec3; 2], from: DVec3, way: DVec3, [start, end]: [f64; 2]) -> f64 {
    let [a, b] = [low, high].map(|wall| (wall - from) / way);
    let enter = a.min(b).max_element().max(start);
    let leave = a.max(b).min_element().min(end);
    (leave - enter).max(0.0)
}

/// Turns of a spiral whose neighbours leave no gaps.
fn turned(i: f64) -> DVec2 {
    DVec2::from_angle(i * PI * (3.0 - 5f64.sqrt()))
}

/// A spiral over half of the sphere, and the opposite of each.
fn around() -> Vec<DVec3> {
    let one = |i: u32| {
        let i = f64::from(i) + 0.5;
        let height = i / f64::from(AROUND);
        let way = (turned(i) * (1.0 - height * height).sqrt()).extend(height);
        [way, -way]
    };
    (0..AROUND).flat_map(one).collect()
}

/// A spiral over the disc of a light that looks so many degrees wide.
fn disc(towards: DVec3, degrees: f64) -> Vec<DVec3> {
    let way = towards.normalize();
    if degrees == 0.0 {
        return vec![way];
    }
    let (across, down) = way.any_orthonormal_pair();
    let edge = (0.5 * degrees).to_radians().sin();
    let one = |i: u32| {
        let part = (f64::from(i) + 0.5) / f64::from(TO_LIGHT);
        let aside = edge * part.sqrt() * turned(i.into());
        let along = (1.0 - edge * edge * part).sqrt();
        aside.x * across + aside.y * down + along * way
    };
    (0..TO_LIGHT).map(one).collect()
}
