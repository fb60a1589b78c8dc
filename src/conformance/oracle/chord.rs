//! One picture to be taken, and what a pixel's ray meets in it (`sampling.md` 3), in f64.
//!
//! ```text
//! lattice ray      t0 + (k + 1/2) h, a shorter last segment sampled at its own middle
//! lattice planes   n . (x - c) = (k + 1/2) h, a sample stands for h / (n . r)
//! bresenham        heights (j + 1/2) / D of the ray's own main axis k, a sample stands for 1 / (D |(voxel_from_world r)_k|)
//! stack of axis k  planes through voxel centres, a sample stands for 1 / |(voxel_from_world r)_k|
//! ```

use super::places::{main_axis, planes, segments};
use crate::camera::Camera;
use crate::scene::Scene;
use crate::shaders::Frame;
use crate::technique::slices_2d::stack_axis;
use crate::technique::{Lattice, Recording, Settings, View};
use crate::transfer::TransferFunction;
use crate::volume::{Grid, Volume};
use glam::{DAffine3, DVec3};

/// Half a unit in the last place of an f32 at 1: what one rounding may change, in parts.
const U: f64 = 1.0 / (1u32 << 24) as f64;

/// A picture without its matter.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the names say it")]
pub struct PictureCase {
    pub grid: Grid,
    pub camera: Camera,
    pub extent: [u32; 2],
    pub settings: Settings,
}

/// The samples of one ray, front to back.
#[derive(Clone, Debug)]
pub struct Chord {
    /// In voxel space.
    pub origin: DVec3,
    /// In voxel space, for one unit of world length.
    pub direction: DVec3,
    /// Where it enters and leaves the domain, in world length.
    pub ends: [f64; 2],
    /// Where the samples lie and the world length that each stands for.
    pub samples: Vec<(f64, f64)>,
    /// How many there are depends on rounding: a plane lies at an end of the domain.
    pub hangs: bool,
    /// How far rounding to f32 may move a sample along the ray, in world length.
    pub blur: f64,
    /// How far rounding to f32 may move a sample across the axes, in voxels.
    pub blur_voxels: DVec3,
}

impl PictureCase {
    /// The library's own words for it.
    pub fn view(&self) -> View<'_> {
        View {
            grid: &self.grid,
            camera: &self.camera,
            extent_pixels: self.extent,
            in_pixel: [0.0; 2].into(),
            settings: &self.settings,
        }
    }

    /// The picture of a volume on this grid.
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

    /// The parameters that the CPU references read, and how many slices there are.
    pub fn parameters(&self) -> (Frame, u32) {
        let Recording { frame, slices, .. } =
            self.view().on_cpu().expect("settings that can be drawn");
        (frame, slices)
    }

    /// What tells it from others, for messages.
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

    /// Row by row.
    pub fn pixels(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let [width, height] = self.extent;
        (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
    }

    /// What the ray of a pixel meets; `None` where it misses the domain, by more than rounding may move it.
    pub fn chord(&self, [x, y]: [u32; 2]) -> Option<Chord> {
        let rays = self.camera.rays(self.extent);
        let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let center = self.grid.center();
        let voxel: DAffine3 = self.grid.world_from_voxel.inverse();
        let o = voxel.transform_point3(origin);
        let d = voxel.transform_vector3(direction);
        // The world is moved so that the centre of the grid is its origin, and each coordinate is a sum of four
        // products: no intermediate number is larger than the sum of their sizes.
        let m = voxel.matrix3.transpose();
        let size = |k: usize, v: DVec3| m.col(k).abs().dot(v.abs());
        let moved = voxel.transform_point3(center);
        let of_origin = DVec3::from_array(
            [0, 1, 2].map(|k| 8.0 * U * (size(k, origin - center) + moved[k].abs())),
        );
        let of_direction = DVec3::from_array([0, 1, 2].map(|k| 8.0 * U * size(k, direction)));
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
                let blur =
                    (of_origin[k] + of_direction[k] * t.abs()) / d[k].abs() + 2.0 * U * t.abs();
                (t, blur)
            });
            ends.sort_by(|a, b| a.0.total_cmp(&b.0));
            enter = if ends[0].0 > enter.0 { ends[0] } else { enter };
            leave = if ends[1].0 < leave.0 { ends[1] } else { leave };
        }
        for plane in &self.settings.clip_planes {
            let height = plane.normal.dot(origin) - plane.offset;
            let slope = plane.normal.dot(direction);
            let t = -height / slope;
            let away = plane.normal.abs().dot((origin - center).abs());
            let blur = (8.0 * U * (away + height.abs()) + 8.0 * U * t.abs()) / slope.abs();
            if slope > 0.0 && t > enter.0 {
                enter = (t, blur);
            } else if slope < 0.0 && t < leave.0 {
                leave = (t, blur);
            }
        }
        let h = self.view().step_world();
        let is_stack = self.settings.technique.draws_stacks();
        let is_ray = self.settings.technique.casts_rays() && self.settings.lattice == Lattice::Ray;
        let n = rays.forward;
        let is_along_axis = !is_stack && self.settings.lattice == Lattice::Bresenham;
        let (axis, has_two) = main_axis(d);
        let (height, slope, spacing, of_plane) = if is_stack {
            let k = stack_axis(&self.view());
            (o[k], d[k], 1.0, (of_origin[k], of_direction[k]))
        } else if is_along_axis {
            let spacing = 1.0 / self.settings.samples_per_voxel;
            (
                o[axis],
                d[axis],
                spacing,
                (of_origin[axis], of_direction[axis]),
            )
        } else {
            let height = n.dot(origin - center);
            let sizes = n.abs().dot((origin - center).abs());
            let slopes = n.abs().dot(direction.abs());
            (
                height,
                n.dot(direction),
                h,
                (8.0 * U * sizes, 8.0 * U * slopes),
            )
        };
        let (mut t0, mut t1) = (enter.0, leave.0);
        let mut blur = enter.1.max(leave.1);
        if !is_ray {
            // A plane's own t is rounded as the ends are.
            let farthest = t0.abs().max(t1.abs()).min(1e30);
            let of_t = (of_plane.0 + of_plane.1 * farthest) / slope.abs() + 2.0 * U * farthest;
            blur = blur.max(of_t);
        }
        let is_edge = (t1 - t0).abs() <= 4.0 * blur;
        if t0 >= t1 {
            if !is_edge {
                return None;
            }
            (t0, t1) = (t1, t0);
        }
        let farthest = t0.abs().max(t1.abs());
        let (samples, hangs) = match is_ray {
            true => (segments(t0, t1, h), is_edge),
            false => planes([t0, t1], 2.0 * blur, height, slope, spacing),
        };
        Some(Chord {
            origin: o,
            direction: d,
            ends: [t0, t1],
            samples,
            hangs: hangs || is_edge || (is_along_axis && has_two),
            blur: 2.0 * blur,
            blur_voxels: of_origin + of_direction * farthest + d.abs() * (2.0 * blur),
        })
    }
}

impl Chord {
    /// In voxel space.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// How long the samples are together.
    pub fn length(&self) -> f64 {
        self.samples.iter().map(|s| s.1).sum()
    }
}
