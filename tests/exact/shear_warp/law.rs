//! The law of shear-warp written down a second time, slice by slice in f64, and laws that are wrong by one thing each, which the
//! same check must not take for it.
//!
//! ```text
//! base pixel (U, V)       b = ((U + 1/2) / q, (V + 1/2) / q, z_b), z_b the middle of the domain
//! slice m, z = m + 1/2    parallel rays   b + s (z - z_b)      s = d / d_k
//!                         an eye at e     e + c (b - e)        c = (z - e_k) / (z_b - e_k)
//! each sample             stands for 1 / |d_k|, d of that ray, and lies before the eye
//! pixel                   the bilinear mean of what four rays gather, as it is blended
//! ```

use super::{cubes, drawn, place_error, plane, settings, shots, through_all};
use crate::shared::{PictureCase, Worst, ramps, volume_of, waves};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::picture::{ColorSpace, Picture};
use stratavox::technique::{Intermediate, Mode, Settings};
use stratavox::transfer::{Absorption, Points, classify_by_points};
use stratavox::volume::{Grid, Volume, sample};

/// What is wrong of a law.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Wrong {
    /// Slices are moved to the other side.
    SignOfS,
    /// c is how much farther the base plane lies than a slice.
    InvertedC,
    /// The base plane lies half a slice further.
    BaseHalfOff,
    /// Samples stand for as much as on the ray of the picture's middle.
    LengthOfMiddle,
    /// Samples are as short as base pixels.
    LengthByBasePixels,
    /// Parallel rays begin where they enter the box, behind the eye too.
    RaysFromTheBox,
    /// Colours are divided by alpha before they are mixed.
    StraightColors,
    /// Colours are mixed as light, and not as they are blended.
    DecodedColors,
    /// All of the pixel is that of the nearest base ray.
    Nearest,
}

/// What a ray gathers: premultiplied colour and alpha, or an X-ray.
type Gathered = [f64; 4];

struct Law<'a> {
    shot: &'a PictureCase,
    volume: &'a Volume,
    axis: usize,
    height: f64,
    per_voxel: f64,
    table: Points,
    wrong: Option<Wrong>,
}

impl<'a> Law<'a> {
    fn new(shot: &'a PictureCase, volume: &'a Volume, wrong: Option<Wrong>) -> Self {
        let Intermediate::PerVoxel(per_voxel) = shot.settings.intermediate else {
            panic!("a number of base pixels");
        };
        let axis = plane(shot).unwrap().axis;
        let beside = if wrong == Some(Wrong::BaseHalfOff) {
            0.5
        } else {
            0.0
        };
        let transfer = ramps();
        let absorption = Absorption::Extinction {
            reference_length: shot.scene(volume, Some(&transfer)).length_of(&transfer),
        };
        Self {
            shot,
            volume,
            axis,
            height: 0.5 * f64::from(shot.grid.dims[axis]) + beside,
            per_voxel,
            table: Points::new(&transfer, absorption, ColorSpace::Display),
            wrong,
        }
    }

    fn is(&self, wrong: Wrong) -> bool {
        self.wrong == Some(wrong)
    }

    fn across(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// Value and length of each sample of a base ray, front to back; `None` where rounding says which slices it meets.
    fn samples(&self, at: [i64; 2]) -> Option<Vec<[f64; 2]>> {
        let (k, grid) = (self.axis, &self.shot.grid);
        let camera = &self.shot.camera;
        let is_perspective = camera.projection.is_perspective();
        let mut b = DVec3::ZERO;
        for (axis, at) in self.across().into_iter().zip(at) {
            b[axis] = (at as f64 + 0.5) / self.per_voxel;
        }
        b[k] = self.height;
        let world = grid.world_from_voxel;
        let voxel = world.inverse();
        let e = voxel.transform_point3(camera.eye);
        let forward = (camera.target - camera.eye).normalize();
        let direction = match is_perspective {
            true => (world.transform_point3(b) - camera.eye).normalize(),
            false => forward,
        };
        let d = voxel.transform_vector3(direction);
        let of_length = match self.is(Wrong::LengthOfMiddle) {
            true => voxel.transform_vector3(forward),
            false => d,
        };
        let mut length = 1.0 / of_length[k].abs();
        if self.is(Wrong::LengthByBasePixels) {
            length /= self.per_voxel;
        }
        let count = grid.dims[k];
        let slice = |n: u32| if d[k] > 0.0 { n } else { count - 1 - n };
        let mut samples = Vec::new();
        for m in (0..count).map(slice) {
            let z = f64::from(m) + 0.5;
            let mut place = if is_perspective {
                let c = (z - e[k]) / (self.height - e[k]);
                let c = if self.is(Wrong::InvertedC) {
                    1.0 / c
                } else {
                    c
                };
                e + c * (b - e)
            } else {
                let way = if self.is(Wrong::SignOfS) { -1.0 } else { 1.0 };
                b + way * (z - self.height) * d / d[k]
            };
            place[k] = z;
            let t = (world.transform_point3(place) - camera.eye).dot(forward);
            let inside = self.across().map(|axis| {
                let far = f64::from(grid.dims[axis]);
                (place[axis]).min(far - place[axis])
            });
            if inside.into_iter().chain([t]).any(|way| way.abs() < 1e-4) {
                return None;
            }
            let is_before = t > 0.0 || self.is(Wrong::RaysFromTheBox);
            if is_before && inside.iter().all(|&way| way > 0.0) {
                let value = sample::linear_in_slice(self.volume, k, m, place.to_array());
                samples.push([value.expect("data"), length]);
            }
        }
        Some(samples)
    }

    fn gathered(&self, samples: &[[f64; 2]]) -> Gathered {
        if self.shot.settings.mode == Mode::Xray {
            return [
                samples.iter().map(|[value, length]| value * length).sum(),
                0.0,
                0.0,
                0.0,
            ];
        }
        let (mut color, mut through) = ([0.0; 3], 1.0);
        for &[value, length] in samples {
            let [r, g, b, extinction] = classify_by_points::<f64>(&self.table, value);
            let opacity = -(-extinction * length).exp_m1();
            for (sum, c) in color.iter_mut().zip([r, g, b]) {
                *sum += through * opacity * c;
            }
            through *= 1.0 - opacity;
        }
        let [r, g, b] = color;
        [r, g, b, 1.0 - through]
    }

    /// A pixel, and by how much its four rays differ at most.
    fn pixel(&self, [x, y]: [u32; 2]) -> Option<(Gathered, f64)> {
        let rays = self.shot.camera.rays(self.shot.extent);
        let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let voxel = self.shot.grid.world_from_voxel.inverse();
        let origin = voxel.transform_point3(origin);
        let direction = voxel.transform_vector3(direction);
        let t = (self.height - origin[self.axis]) / direction[self.axis];
        let point = origin + t * direction;
        let place = self.across().map(|axis| self.per_voxel * point[axis] - 0.5);
        let low = place.map(f64::floor);
        let mut sum = [0.0; 4];
        let mut range = [[f64::INFINITY; 4], [f64::NEG_INFINITY; 4]];
        for at in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            let of_axis = |k: usize| {
                let near = 1.0 - (place[k] - low[k] - at[k] as f64).abs();
                if self.is(Wrong::Nearest) {
                    near.round()
                } else {
                    near
                }
            };
            let weight = of_axis(0) * of_axis(1);
            let base = [0, 1].map(|k| low[k] as i64 + at[k]);
            let found = self.gathered(&self.samples(base)?);
            let [r, g, b, a] = found;
            let mixed = match self.wrong {
                Some(Wrong::StraightColors) if a > 0.0 => [r / a, g / a, b / a, a],
                Some(Wrong::DecodedColors) => [r.powf(2.2), g.powf(2.2), b.powf(2.2), a],
                _ => found,
            };
            for c in 0..4 {
                sum[c] += weight * mixed[c];
                range[0][c] = range[0][c].min(found[c]);
                range[1][c] = range[1][c].max(found[c]);
            }
        }
        let [r, g, b, a] = sum;
        let sum = match self.wrong {
            Some(Wrong::StraightColors) => [r * a, g * a, b * a, a],
            Some(Wrong::DecodedColors) => {
                let [r, g, b] = [r, g, b].map(|c| c.powf(1.0 / 2.2));
                [r, g, b, a]
            }
            _ => sum,
        };
        let apart = (0..4).map(|c| range[1][c] - range[0][c]);
        Some((sum, apart.fold(0.0, f64::max)))
    }
}

/// A picture against a law. What is asked of rays through all slices in f32 is 5e-6 of what they gather ([`super::four_rays`]),
/// here by a ray that runs beside the axis by less than half of its way along it.
fn check(shot: &PictureCase, volume: &Volume, found: &Picture, wrong: Option<Wrong>) -> Worst {
    let law = Law::new(shot, volume, wrong);
    let base = plane(shot).unwrap();
    let mut worst = Worst::new(format!("{wrong:?}: {}", shot.what()));
    for (i, pixel) in shot.pixels().enumerate() {
        let Some((wanted, apart)) = law.pixel(pixel) else {
            worst.leave_out();
            continue;
        };
        let of_place = place_error(&base, pixel) * apart;
        let mut take = |wanted: f64, found: f32| {
            let allowed = 5e-6 * wanted.abs().max(1.0) + of_place;
            worst.take(pixel, f64::from(found) - wanted, allowed);
        };
        if shot.settings.mode == Mode::Xray {
            let value = found.layers[1].values[i];
            take(wanted[0], if value.is_nan() { 0.0 } else { value });
            continue;
        }
        for (wanted, &found) in wanted.into_iter().zip(&found.pixels[i]) {
            take(wanted, found);
        }
    }
    worst
}

/// Cubes, and boxes that are as long as no two sides alike.
fn grids() -> [Grid; 2] {
    let long = Grid {
        dims: [13, 24, 22],
        world_from_voxel: DAffine3::from_translation(dvec3(5.0, -3.0, 40.0))
            * DAffine3::from_scale(dvec3(1.5, 0.8, 1.1)),
    };
    [cubes([16, 18, 20]), long]
}

/// Parallel rays, and those of an eye near by, both through the middle of all slices.
fn both(grid: Grid, mode: Mode, per_voxel: f64) -> [PictureCase; 2] {
    let settings = Settings {
        color_space: ColorSpace::Display,
        ..settings(mode, per_voxel)
    };
    let parallel = through_all(grid, settings.clone());
    let [_, mut near] = shots(grid, &settings);
    near.camera.eye = near.camera.target + 24.0 * dvec3(0.3, -1.0, 0.2);
    near.camera.zoom = 3.0;
    [parallel, near]
}

/// Fails where the law itself is off, or one of the wrong ones is not.
fn holds(shot: &PictureCase, wrong: &[Wrong]) {
    let volume = volume_of(shot.grid.dims, shot.grid.world_from_voxel, waves);
    let found = drawn(shot, &volume);
    check(shot, &volume, &found, None).assert_holds();
    for &wrong in wrong {
        check(shot, &volume, &found, Some(wrong)).assert_caught();
    }
}

#[test]
fn slices_are_met_where_the_law_says_and_wrong_laws_are_seen() {
    for grid in grids() {
        for (mode, per_voxel) in [
            (Mode::Composite, 1.0),
            (Mode::Composite, 2.0),
            (Mode::Xray, 2.0),
        ] {
            let [parallel, near] = both(grid, mode, per_voxel);
            let mut wrong = vec![Wrong::BaseHalfOff, Wrong::Nearest];
            if per_voxel != 1.0 {
                wrong.push(Wrong::LengthByBasePixels);
            }
            if mode == Mode::Composite {
                wrong.extend([Wrong::StraightColors, Wrong::DecodedColors]);
            }
            // Light is hidden by what is before it; sums over slices to both sides of the base plane are the same, mirrored in it,
            // of waves along the slices.
            let mirrored = (mode == Mode::Composite).then_some(Wrong::SignOfS);
            let of_parallel = wrong.iter().copied().chain(mirrored);
            holds(&parallel, &of_parallel.collect::<Vec<_>>());
            let of_an_eye = [Wrong::InvertedC, Wrong::LengthOfMiddle];
            holds(&near, &[wrong.as_slice(), &of_an_eye].concat());
        }
    }
}

#[test]
fn parallel_rays_begin_on_the_plane_through_the_eye() {
    for grid in grids() {
        for mode in [Mode::Composite, Mode::Xray] {
            let [mut parallel, _] = both(grid, mode, 1.0);
            // Among the slices: the half of them behind it is not seen.
            let forward = (parallel.camera.target - parallel.camera.eye).normalize();
            parallel.camera.eye = parallel.camera.target + 1.3 * forward;
            parallel.camera.target = parallel.camera.eye + forward;
            parallel.settings.stack = Some(1);
            holds(&parallel, &[Wrong::RaysFromTheBox]);
        }
    }
}
