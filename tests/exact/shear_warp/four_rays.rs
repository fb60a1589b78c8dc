//! Each pixel is the bilinear mean of four rays of a 2D stack. The rays are found here from camera and grid alone, each as the
//! only pixel of a camera of its own, and drawn by the CPU reference of slices.

use super::{MODES, drawn, place_error, plane, settings, sheared, shots};
use crate::shared::{PictureCase, Worst, ramps, sweep, volume_of, waves};
use glam::{DVec3, dvec3};
use std::collections::HashMap;
use stratavox::camera::Camera;
use stratavox::offscreen::reference;
use stratavox::picture::LayerKind;
use stratavox::technique::{Intermediate, Mode, Order, Technique};
use stratavox::volume::Volume;

/// The base plane of a picture, and its rays as those of cameras.
struct Oracle<'a> {
    shot: &'a PictureCase,
    volume: &'a Volume,
    axis: usize,
    height: f64,
    per_voxel: f64,
    rays: HashMap<[i64; 2], [f64; 6]>,
}

impl<'a> Oracle<'a> {
    fn new(shot: &'a PictureCase, volume: &'a Volume, axis: usize) -> Self {
        let far = shot.grid.far_corner();
        let [low, high] = shot.settings.crop.unwrap_or([DVec3::ZERO, far]);
        let Intermediate::PerVoxel(per_voxel) = shot.settings.intermediate else {
            panic!("a number of base pixels");
        };
        Self {
            shot,
            volume,
            axis,
            height: 0.5 * (low[axis] + high[axis]),
            per_voxel,
            rays: HashMap::new(),
        }
    }

    fn across(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// Colour, or (value, whether there is one, 0, 0), then samples of a base ray and the length that they stand for.
    fn ray(&mut self, at: [i64; 2]) -> [f64; 6] {
        if let Some(&found) = self.rays.get(&at) {
            return found;
        }
        let mut point = DVec3::ZERO;
        for (axis, at) in self.across().into_iter().zip(at) {
            point[axis] = (at as f64 + 0.5) / self.per_voxel;
        }
        point[self.axis] = self.height;
        let target = self.shot.grid.world_from_voxel.transform_point3(point);
        let camera = self.shot.camera;
        let forward = (camera.target - camera.eye).normalize();
        let eye = match camera.projection.is_perspective() {
            true => camera.eye,
            false => target - forward * forward.dot(target - camera.eye),
        };
        let one = PictureCase {
            camera: Camera {
                eye,
                target,
                ..camera
            },
            extent: [1, 1],
            ..self.shot.with(|settings| {
                settings.technique = Technique::Slices2d;
                settings.stack = Some(self.axis);
                settings.order = Order::FrontToBack;
            })
        };
        let transfer = ramps();
        let scene = one.scene(self.volume, Some(&transfer));
        let picture = reference::render::<f64>(&scene).unwrap();
        let layer = |kind| {
            let mut layers = picture.layers.iter();
            layers
                .find(|layer| layer.kind == kind)
                .map(|layer| f64::from(layer.values[0]))
        };
        let samples = layer(LayerKind::Samples).unwrap();
        let voxel_from_world = self.shot.grid.world_from_voxel.inverse();
        let ray = voxel_from_world.transform_vector3((target - eye).normalize());
        let ray = match camera.projection.is_perspective() {
            true => ray,
            false => voxel_from_world.transform_vector3(forward),
        };
        let length = samples / ray[self.axis].abs();
        let found = match layer(LayerKind::Value) {
            None => {
                let [r, g, b, a] = picture.pixels[0].map(f64::from);
                [r, g, b, a, samples, length]
            }
            Some(value) if value.is_nan() => [0.0, 0.0, 0.0, 0.0, samples, length],
            Some(value) => [value, 1.0, 0.0, 0.0, samples, length],
        };
        self.rays.insert(at, found);
        found
    }

    /// How much farther the pixel's ray runs beside the axis than along it, in voxels, and the four rays around with their
    /// weights.
    fn around(&mut self, [x, y]: [u32; 2]) -> (f64, Vec<(f64, [f64; 6])>) {
        let rays = self.shot.camera.rays(self.shot.extent);
        let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let voxel_from_world = self.shot.grid.world_from_voxel.inverse();
        let origin = voxel_from_world.transform_point3(origin);
        let direction = voxel_from_world.transform_vector3(direction);
        let t = (self.height - origin[self.axis]) / direction[self.axis];
        let point = origin + t * direction;
        let place = self.across().map(|axis| self.per_voxel * point[axis] - 0.5);
        let low = place.map(f64::floor);
        let mut all = Vec::new();
        for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let weight = |k: usize, step: i64| 1.0 - (place[k] - low[k] - step as f64).abs();
            let ray = self.ray([low[0] as i64 + i, low[1] as i64 + j]);
            all.push((weight(0, i) * weight(1, j), ray));
        }
        let steepness = direction.abs().max_element() / direction[self.axis].abs();
        (steepness, all)
    }
}

/// Every channel and layer of a picture against the means of its rays. Returns how many pixels show something.
fn compare(shot: &PictureCase, volume: &Volume, axis: usize) -> usize {
    let found = drawn(shot, volume);
    let mut oracle = Oracle::new(shot, volume, axis);
    let base = plane(shot).unwrap();
    let mode = shot.settings.mode;
    let mut worst = Worst::new(format!("{}, axis {axis}", shot.what()));
    let mut seen = 0;
    for (i, pixel) in shot.pixels().enumerate() {
        let (steepness, around) = oracle.around(pixel);
        let sum =
            |of: &dyn Fn(&[f64; 6]) -> f64| around.iter().map(|(w, ray)| w * of(ray)).sum::<f64>();
        let range = |c: usize| {
            let all = around.iter().map(|(_, ray)| ray[c]);
            all.clone().fold(f64::MIN, f64::max) - all.fold(f64::MAX, f64::min)
        };
        let of_place = place_error(&base, pixel);
        let mut take = |wanted: f64, found: f32, range: f64| {
            // What is asked of a composite in f32 against its formula is 5e-6. On a slice a place lies at o_i + (m + 1/2 - o_k) s,
            // s = d_i / d_k: with each component of d off by e, s is off by e (1 + s) / d_k, which grows as the square of how
            // steep the ray is; the length of a sample, 1 / d_k, is off by e / d_k^2.
            let of_rays = 5e-6 * steepness * steepness;
            let allowed = of_rays * wanted.abs().max(1.0) + of_place * range;
            worst.take(pixel, f64::from(found) - wanted, allowed);
        };
        take(sum(&|ray| ray[4]), found.layers[0].values[i], range(4));
        if !mode.is_projection() {
            for c in 0..4 {
                take(sum(&|ray| ray[c]), found.pixels[i][c], range(c));
            }
            take(
                1.0 - sum(&|ray| ray[3]),
                found.layers[1].values[i],
                range(3),
            );
            seen += usize::from(found.pixels[i][3] > 0.01);
            continue;
        }
        let value = found.layers[1].values[i];
        let share = sum(&|ray| ray[1]);
        if share == 0.0 {
            assert!(
                value.is_nan() && found.pixels[i] == [0.0; 4],
                "{pixel:?}: {value}"
            );
            continue;
        }
        if share < 1e-3 {
            worst.leave_out();
            continue;
        }
        let wanted = match mode {
            Mode::Xray => sum(&|ray| ray[0]),
            // Over all that the four have gone through: not the mean of means.
            Mode::Average => sum(&|ray| ray[0] * ray[5]) / sum(&|ray| ray[5]),
            _ => sum(&|ray| ray[0] * ray[1]) / share,
        };
        take(wanted, value, range(0) + range(1));
        seen += 1;
    }
    worst.assert_holds();
    seen
}

#[test]
fn a_pixel_is_the_mean_of_four_rays_through_the_slices_of_a_stack() {
    let grid = sheared();
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    for (nth, mode) in MODES.into_iter().enumerate() {
        for (view, shot) in shots(grid, &settings(mode, 1.0)).into_iter().enumerate() {
            // One axis by turns.
            for axis in (0..3).filter(|axis| sweep::is_long() || (nth + view) % 3 == *axis) {
                let shot = shot.with(|settings| settings.stack = Some(axis));
                let seen = compare(&shot, &volume, axis);
                assert!(seen > 100, "only {seen} pixels: {}", shot.what());
            }
        }
    }
}

#[test]
fn so_it_is_of_finer_rays_and_of_a_part_of_the_volume() {
    let grid = sheared();
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    for (per_voxel, mode) in [(2.0, Mode::Composite), (3.7, Mode::Mip), (0.6, Mode::Xray)] {
        for shot in shots(grid, &settings(mode, per_voxel)) {
            let shot = shot.with(|settings| {
                settings.stack = Some(1);
                settings.crop = Some([dvec3(2.3, 4.0, 0.0), dvec3(15.0, 17.6, 11.2)]);
            });
            let seen = compare(&shot, &volume, 1);
            assert!(seen > 100, "only {seen} pixels: {}", shot.what());
        }
    }
}
