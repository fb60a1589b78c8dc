//! What a pixel's ray meets, from camera and grid alone, in f64 and in world space.
//!
//! It calls neither `src/ray.rs` nor `src/lattice.rs`, which the exact answers judge. The oracle of conformance has a
//! `Chord` too, in voxel space and with wider blurs: those are proven for any device, and these, which tests allow
//! CPU references and the drivers at hand, are narrower. It shares `places` with that oracle, so it is no independent judge of
//! it.

use glam::DVec3;
use stratavox::conformance::oracle::PictureCase;
use stratavox::conformance::oracle::places::{main_axis, planes, segments};
use stratavox::technique::slices_2d::stack_axis;
use stratavox::technique::{Lattice, Technique};

/// The samples of one ray, front to back.
#[derive(Clone, Debug)]
pub struct Chord {
    pub origin: DVec3,
    pub direction: DVec3,
    /// Where the ray is in the domain.
    pub enter: f64,
    pub leave: f64,
    /// Where the samples lie and the length that each stands for.
    pub samples: Vec<(f64, f64)>,
    /// How many there are depends on rounding: a plane lies within `blur` of an end.
    pub hangs: bool,
    /// How far rounding to f32 may move each end, in world length.
    pub blur: f64,
}

impl Chord {
    /// What the ray of a pixel meets; `None` where it misses the domain.
    pub fn of(shot: &PictureCase, [x, y]: [u32; 2]) -> Option<Self> {
        let rays = shot.camera.rays(shot.extent);
        let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let voxel = shot.grid.world_from_voxel.inverse();
        let [o, d] = [
            voxel.transform_point3(origin),
            voxel.transform_vector3(direction),
        ];
        let far = shot.grid.far_corner();
        let [low, high] = shot.settings.crop.unwrap_or([DVec3::ZERO, far]);
        let (mut enter, mut leave) = ((0.0f64, 0.0), (f64::INFINITY, 0.0));
        for k in 0..3 {
            let (low, high) = (low[k].max(0.0), high[k].min(far[k]));
            if d[k] == 0.0 {
                if !(low..high).contains(&o[k]) {
                    return None;
                }
                continue;
            }
            let mut ends = [low, high].map(|face| {
                let t = (face - o[k]) / d[k];
                (t, rounding(t, (face.abs() + o[k].abs()) / d[k].abs()))
            });
            ends.sort_by(|a, b| a.0.total_cmp(&b.0));
            enter = if ends[0].0 > enter.0 { ends[0] } else { enter };
            leave = if ends[1].0 < leave.0 { ends[1] } else { leave };
        }
        for plane in &shot.settings.clip_planes {
            let (height, slope) = (
                plane.normal.dot(origin) - plane.offset,
                plane.normal.dot(direction),
            );
            let t = -height / slope;
            let end = (
                t,
                rounding(t, origin.distance(shot.grid.center()) / slope.abs()),
            );
            if slope > 0.0 && t > enter.0 {
                enter = end;
            } else if slope < 0.0 && t < leave.0 {
                leave = end;
            }
        }
        let blur = enter.1.max(leave.1);
        let (enter, leave) = (enter.0, leave.0);
        if enter >= leave {
            return None;
        }
        let h = shot.view().step_world();
        let (samples, hangs) = match (shot.settings.technique, shot.settings.lattice) {
            (Technique::Raycast, Lattice::Ray) => (segments(enter, leave, h), false),
            (Technique::Raycast, Lattice::Bresenham) => {
                let (k, has_two) = main_axis(d);
                let spacing = 1.0 / shot.settings.samples_per_voxel;
                let (samples, hangs) = planes([enter, leave], blur, o[k], d[k], spacing);
                (samples, hangs || has_two)
            }
            (Technique::Slices2d, _) => {
                // Slice s lies where coordinate k is s + 1/2.
                let k = stack_axis(&shot.view());
                planes([enter, leave], blur, o[k], d[k], 1.0)
            }
            _ => {
                let n = rays.forward;
                let height = n.dot(origin - shot.grid.center());
                planes([enter, leave], blur, height, n.dot(direction), h)
            }
        };
        Some(Self {
            origin,
            direction,
            enter,
            leave,
            samples,
            hangs,
            blur,
        })
    }
    /// The interval of t that the samples stand for: on the ray lattice all of the chord, on planes half a
    /// spacing to both sides of them. `None` without a sample.
    pub fn covered(&self) -> Option<[f64; 2]> {
        let (first, last) = (self.samples.first()?, self.samples.last()?);
        Some([first.0 - 0.5 * first.1, last.0 + 0.5 * last.1])
    }

    /// How long the samples are together.
    pub fn length(&self) -> f64 {
        self.samples.iter().map(|s| s.1).sum()
    }

    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// No place on the chord is farther than this from a sample.
    pub fn widest_gap(&self) -> f64 {
        let Some((first, last)) = self.samples.first().zip(self.samples.last()) else {
            return self.leave - self.enter;
        };
        let inner = self.samples.windows(2).map(|w| 0.5 * (w[1].0 - w[0].0));
        inner.fold((first.0 - self.enter).max(self.leave - last.0), f64::max)
    }
}

/// What f32 makes of t = (face - o) / d: o is a sum of four products, d of three, of a vector that was made
/// a unit vector, each of them rounded. `apart` is (|face| + |o|) / |d|.
fn rounding(t: f64, apart: f64) -> f64 {
    4.0 * (apart + t.abs()) * f64::from(f32::EPSILON) / 2.0
}
