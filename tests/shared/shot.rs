//! One picture to be taken, and what a pixel's ray meets in it, from camera and grid alone, in f64.
//!
//! It calls neither `src/ray.rs` nor `src/lattice.rs`, which the exact answers judge. It shares `places.rs` with the
//! oracle of conformance, so it is no independent judge of that oracle.

#[path = "../../src/conformance/oracle/places.rs"]
mod places;

use glam::{DAffine3, DVec3};
use places::{planes, segments};
use stratavox::camera::Camera;
use stratavox::scene::Scene;
use stratavox::shaders::Frame;
use stratavox::technique::slices_2d::stack_axis;
use stratavox::technique::{Lattice, Recording, Settings, Technique, View};
use stratavox::transfer::TransferFunction;
use stratavox::volume::{Grid, Volume};

/// A picture without its matter.
#[derive(Clone, Debug)]
pub struct Shot {
    pub grid: Grid,
    pub camera: Camera,
    pub extent: [u32; 2],
    pub settings: Settings,
}

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

impl Shot {
    pub fn view(&self) -> View<'_> {
        View {
            grid: &self.grid,
            camera: &self.camera,
            extent_pixels: self.extent,
            in_pixel: [0.0; 2].into(),
            settings: &self.settings,
        }
    }

    /// The same picture of a volume on the same grid.
    pub fn scene<'a>(
        &'a self,
        volume: &'a Volume,
        transfer: Option<&'a TransferFunction>,
    ) -> Scene<'a> {
        assert_eq!(volume.grid(), self.grid, "another grid");
        Scene {
            beside: Default::default(),
            volume,
            transfer,
            camera: &self.camera,
            extent_pixels: self.extent,
            settings: &self.settings,
        }
    }

    /// The same with other settings.
    pub fn with(&self, change: impl FnOnce(&mut Settings)) -> Self {
        let mut shot = self.clone();
        change(&mut shot.settings);
        shot
    }

    /// The parameters that the twins read, and how many slices there are.
    pub fn parameters(&self) -> (Frame, u32) {
        let Recording { frame, slices, .. } = self.view().on_cpu().unwrap();
        (frame, slices)
    }

    pub fn pixels(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let [width, height] = self.extent;
        (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
    }

    pub fn what(&self) -> String {
        let Settings {
            technique,
            lattice,
            order,
            mode,
            ..
        } = self.settings;
        format!(
            "{technique:?} {lattice:?} {order:?} {mode:?} {:?}",
            self.camera.projection
        )
    }

    pub fn voxel_from_world(&self) -> DAffine3 {
        self.grid.world_from_voxel.inverse()
    }

    /// What the ray of a pixel meets; `None` where it misses the domain.
    pub fn chord(&self, [x, y]: [u32; 2]) -> Option<Chord> {
        let rays = self.camera.rays(self.extent);
        let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let voxel = self.voxel_from_world();
        let [o, d] = [
            voxel.transform_point3(origin),
            voxel.transform_vector3(direction),
        ];
        let far = self.grid.far_corner();
        let [low, high] = self.settings.crop.unwrap_or([DVec3::ZERO, far]);
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
        for plane in &self.settings.clip_planes {
            let (height, slope) = (
                plane.normal.dot(origin) - plane.offset,
                plane.normal.dot(direction),
            );
            let t = -height / slope;
            let end = (
                t,
                rounding(t, origin.distance(self.grid.center()) / slope.abs()),
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
        let h = self.view().step_world();
        let (samples, hangs) = match (self.settings.technique, self.settings.lattice) {
            (Technique::Raycast, Lattice::Ray) => (segments(enter, leave, h), false),
            (Technique::Slices2d, _) => {
                // Slice s lies where coordinate k is s + 1/2.
                let k = stack_axis(&self.view());
                planes([enter, leave], blur, o[k], d[k], 1.0)
            }
            _ => {
                let n = rays.forward;
                let height = n.dot(origin - self.grid.center());
                planes([enter, leave], blur, height, n.dot(direction), h)
            }
        };
        Some(Chord {
            origin,
            direction,
            enter,
            leave,
            samples,
            hangs,
            blur,
        })
    }
}

/// What f32 makes of t = (face - o) / d: o is a sum of four products, d of three, of a vector that was made
/// a unit vector, each of them rounded. `apart` is (|face| + |o|) / |d|.
fn rounding(t: f64, apart: f64) -> f64 {
    4.0 * (apart + t.abs()) * f64::from(f32::EPSILON) / 2.0
}

impl Chord {
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
