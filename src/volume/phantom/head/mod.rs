//! A head as a CT scanner sees it, in Hounsfield units, made of ellipsoids, capsules and a little noise.
//!
//! World is RAS+ in millimetres: the face looks to +y, the top is +z, the middle of the box lies between
//! the ears. The two sides are mirror images but for sinuses, the wall of the nose and the brain's
//! folds. The numbers are those of anatomy to a few millimetres; it is a picture, not a patient.
//!
//! Each body is painted over the ones before, with an edge that is soft over a voxel to each side:
//!
//! ```text
//! value = value + (3 f^2 - 2 f^3) (new - value),  f = clamp(1/2 - distance / 2 voxels, 0, 1)
//! ```

mod air;
mod bone;
mod brain;
mod coarse;
mod shape;
mod skin;
mod soft;
mod spine;
mod teeth;

use super::noise::{noise, turbulence};
use crate::volume::field::Field;
use coarse::Coarse;
use glam::DVec3;
use shape::smoothstep;

/// The box reaches from minus this to this.
pub(super) const HALF_SIDE: f64 = 120.0;

const AIR: f64 = -1000.0;

/// A head as scanned with voxels of one size.
pub(super) struct Head {
    /// How far from a surface its edge reaches.
    reach: f64,
    skin: Coarse,
    face: Coarse,
    jaw: Coarse,
    muscles: Coarse,
    air: [Coarse; 2],
}

impl Head {
    pub fn new(spacing: f64) -> Self {
        // Bodies are painted some millimetres under the skin and into the bone.
        let near = spacing + 4.0;
        Self {
            reach: spacing,
            skin: Coarse::new(near, skin::distance),
            face: Coarse::new(near, bone::face),
            jaw: Coarse::new(near, bone::jaw),
            muscles: Coarse::new(near, soft::muscles),
            air: [-1.0, 1.0].map(|side| Coarse::new(near, |p| air::distance(p, side))),
        }
    }
}

impl Field for Head {
    fn value(&self, world: DVec3) -> f64 {
        let p = DVec3::new(world.x.abs(), world.y, world.z);
        let side = world.x.signum();
        let skin = self.skin.at(p, skin::distance);
        if skin > self.reach {
            return AIR;
        }
        let room = bone::brain_room(p);
        let deep = room < -3.0 - self.reach;
        let mut painting = Painting {
            value: AIR,
            reach: self.reach,
        };
        if !deep {
            let muscles = self.muscles.at(p, soft::muscles);
            soft::paint(&mut painting, p, skin, room, muscles);
            self.paint_bone(&mut painting, p, skin, room);
            let air = &self.air[usize::from(side > 0.0)];
            painting.over(air.at(p, |p| air::distance(p, side)), AIR);
        }
        if room < self.reach {
            brain::paint(&mut painting, p, room, side);
        }
        // The air outside comes last: nothing inside reaches through the skin.
        painting.over(-skin, AIR);
        painting.value
    }
}

impl Head {
    /// Hard outside, spongy inside.
    fn paint_bone(&self, painting: &mut Painting, p: DVec3, skin: f64, room: f64) {
        const COMPACT: f64 = 1350.0;
        let reach = painting.reach;
        // No bone lies bare.
        let under_skin = skin + 1.5 + reach;
        let skull = bone::skull(p, room, self.face.at(p, bone::face)).max(under_skin);
        if skull < reach {
            let thinner = 200.0 * smoothstep(0.0, 20.0, p.z);
            painting.over(skull, COMPACT - thinner + 260.0 * noise(p * 0.055));
            if skull < -1.2 {
                painting.over(skull + 2.2, 520.0 + 260.0 * turbulence(p * 0.45));
            }
        }
        if p.z > -6.0 {
            return;
        }
        if p.y > -20.0 {
            let jaw = self.jaw.at(p, bone::jaw).max(under_skin);
            if jaw < reach {
                painting.over(jaw, COMPACT + 100.0);
                painting.over(jaw + 2.2, 420.0 + 200.0 * turbulence(p * 0.4));
            }
            if let Some(tooth) = teeth::nearest(p) {
                painting.over(tooth.distance, if tooth.crown { 2500.0 } else { 1700.0 });
                painting.over(tooth.distance + 1.6, 1600.0);
            }
        }
        if p.y < 25.0 && p.x < 48.0 {
            let spine = spine::at_point(p);
            painting.over(spine.disc, 90.0);
            if spine.bone < reach {
                painting.over(spine.bone, 1000.0);
                painting.over(spine.bone + 1.6, 330.0 + 120.0 * noise(p * 0.5));
            }
            painting.over(spine.canal, 10.0);
            painting.over(spine.cord, 35.0);
        }
    }
}

/// A value that bodies are painted over.
struct Painting {
    value: f64,
    reach: f64,
}

impl Painting {
    fn over(&mut self, distance: f64, value: f64) {
        if distance < self.reach {
            let f = (0.5 - 0.5 * distance / self.reach).min(1.0);
            self.value += f * f * (3.0 - 2.0 * f) * (value - self.value);
        }
    }
}
