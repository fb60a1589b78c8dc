//! Cells as a microscope sees them in three dyes: nuclei, the membranes around them, mitochondria between.
//!
//! A cell is what is nearest to its centre (a Voronoi region of points near the nodes of a lattice); with d1 and d2
//! the distances to the nearest and the second nearest centre:
//!
//! ```text
//! nuclei        1 where d1 < r, noise inside          membranes   exp(-((d2 - d1) / w)^2)
//! mitochondria  ridges of noise between nucleus and membrane
//! ```

use super::noise::noise;
use crate::volume::Channel;
use crate::volume::field::Field;
use glam::{DVec3, IVec3};

/// Side of a cell, nucleus, membrane, in millimetres of the phantom.
const SPACING: f64 = 28.0;
const NUCLEUS_RADIUS: f64 = 7.5;
const MEMBRANE_WIDTH: f64 = 1.6;
/// All cells lie in a ball.
const CLUSTER_RADIUS: f64 = 40.0;

/// What the dyes mark.
pub(super) fn channels() -> Vec<Channel> {
    ["nuclei", "membranes", "mitochondria"]
        .map(|name| Channel {
            name: name.to_owned(),
            ..Channel::default()
        })
        .into()
}

/// One of the dyes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cells {
    dye: u32,
}

impl Cells {
    pub fn new(dye: u32) -> Self {
        Self { dye }
    }
}

impl Field for Cells {
    fn value(&self, p: DVec3) -> f64 {
        let inside = soft(CLUSTER_RADIUS + 3.0 * noise(p / 17.0) - p.length(), 1.0);
        if inside == 0.0 {
            return 0.0;
        }
        let [d1, d2] = nearest_two(p);
        let wobble = noise(p / 6.0);
        let nucleus = soft(NUCLEUS_RADIUS + wobble - d1, 0.8);
        let membrane = (-((d2 - d1) / MEMBRANE_WIDTH).powi(2)).exp();
        let value = match self.dye {
            0 => nucleus * (0.75 + 0.25 * noise(p / 1.8)),
            1 => membrane * (0.85 + 0.15 * wobble),
            _ => {
                let between = (1.0 - nucleus) * soft(d2 - d1 - 3.0, 1.0);
                let ridge = 1.0 - 2.0 * (noise(p / 4.0) + 0.4 * noise(p / 1.7)).abs();
                between * ridge.max(0.0).powi(6)
            }
        };
        (inside * value).clamp(0.0, 1.0)
    }
}

/// 0 below -width, 1 above width.
fn soft(x: f64, width: f64) -> f64 {
    (0.5 + 0.5 * x / width).clamp(0.0, 1.0)
}

/// Distances to the nearest and the second nearest centre of a cell.
fn nearest_two(p: DVec3) -> [f64; 2] {
    let cell = (p / SPACING).floor().as_ivec3();
    let mut found = [f64::INFINITY; 2];
    for z in -1..=1 {
        for y in -1..=1 {
            for x in -1..=1 {
                let distance = p.distance(center(cell + IVec3::new(x, y, z)));
                if distance < found[0] {
                    found = [distance, found[0]];
                } else if distance < found[1] {
                    found[1] = distance;
                }
            }
        }
    }
    found
}

fn center(cell: IVec3) -> DVec3 {
    let q = cell.as_dvec3();
    // Noise is random at whole points; far apart points are independent.
    let jitter = DVec3::new(noise(q), noise(q + 1000.0), noise(q + 2000.0));
    SPACING * (q + 0.5 + 0.28 * jitter)
}
