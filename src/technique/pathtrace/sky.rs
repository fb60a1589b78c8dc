//! Light from all around by a picture of it: what is computed once, and the CPU reference of `shaders/lib/sky.wgsl`.
//!
//! ```text
//! light of a texel    = luminance of the mean of its bilinear radiance, times its solid angle
//! density of a texel  = its part of all light / its solid angle
//! ```
//!
//! By a texel's own radiance the neighbours of a sun, into which its light reaches, would be drawn too seldom.

use super::elementary::{turn_of, turned};
use crate::gpu::{self, Buffer, Gpu, Memory};
use crate::real::Real;
use crate::shaders::Frame;
use ash::vk;
use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;

/// A picture of all directions: equal steps of longitude and latitude, the first row above, the middle column along x, the
/// picture turning to the right where longitude falls.
#[derive(Clone)]
pub struct SkyPicture(Arc<Sky>);

struct Sky {
    size: [u32; 2],
    texels: Vec<SkyTexel>,
}

/// The struct of `shaders/lib/sky.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct SkyTexel {
    radiance: [f32; 3],
    /// Of directions in the texel, per steradian.
    density: f32,
    /// That the texel is taken where it is drawn.
    chance: f32,
    /// Which one is taken else.
    other: u32,
}

/// Why a picture is no sky.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SkyError {
    /// It does not show all directions, or has fewer pixels or more than can be held.
    #[error("wanted twice as many pixels across as down, 2 to {MOST_ROWS} rows, found {0} x {1}")]
    Size(u32, u32),
    /// Of a pixel, from 0 on.
    #[error("pixel {x}, {y}: wanted radiance of 0 or more, found {found}")]
    Radiance {
        /// From the left.
        x: u32,
        /// From the top.
        y: u32,
        /// What is there.
        found: f32,
    },
    /// No direction to be drawn.
    #[error("it is black: wanted light from somewhere")]
    Black,
}

/// Of a picture that comes in.
const MOST_ROWS: u32 = 8192;
/// Of one that is kept: 48 MiB.
const KEPT_ROWS: u32 = 1024;

impl SkyPicture {
    /// Of linear radiance, rows from above. More than 1024 rows are averaged in squares to as many or fewer.
    ///
    /// # Errors
    /// [`SkyError`].
    pub fn new([width, height]: [u32; 2], pixels: &[[f32; 3]]) -> Result<Self, SkyError> {
        let is_right = (2..=MOST_ROWS).contains(&height) && width == 2 * height;
        if !is_right || pixels.len() != width as usize * height as usize {
            return Err(SkyError::Size(width, height));
        }
        let is_light = |&c: &f32| c >= 0.0 && c.is_finite();
        if let Some(i) = pixels.iter().position(|p| !p.iter().all(is_light)) {
            let found = pixels[i].into_iter().find(|c| !is_light(c)).unwrap_or(0.0);
            let (x, y) = (i as u32 % width, i as u32 / width);
            return Err(SkyError::Radiance { x, y, found });
        }
        let side = height.div_ceil(KEPT_ROWS);
        // What does not fill a last square is left to the one before.
        let rows = height / side;
        let size = [2 * rows, rows];
        let averaged = match side {
            1 => pixels.to_vec(),
            _ => averaged(pixels, width, side, size),
        };
        let light = light_of_texels(&averaged, size);
        let all: f64 = light.iter().sum();
        if all <= 0.0 {
            return Err(SkyError::Black);
        }
        let chances = alias_table(&light, all);
        let texel = |i: usize| SkyTexel {
            radiance: averaged[i],
            density: (light[i] / all / solid_angle(i as u32 / size[0], size)) as f32,
            chance: chances[i].0,
            other: chances[i].1,
        };
        let texels = (0..averaged.len()).map(texel).collect();
        Ok(Self(Arc::new(Sky { size, texels })))
    }

    /// Texels across and down.
    pub fn size(&self) -> [u32; 2] {
        self.0.size
    }

    /// As the shader reads them.
    pub(crate) fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.0.texels)
    }

    /// In a buffer for shaders.
    pub(crate) fn on_device(&self, gpu: &Arc<Gpu>) -> Result<Buffer, gpu::Error> {
        let bytes = self.bytes();
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let buffer = Buffer::new(gpu, bytes.len() as u64, usage, Memory::Upload, "sky")?;
        buffer.write(0, bytes)?;
        Ok(buffer)
    }

    fn texel(&self, x: i32, y: i32) -> &SkyTexel {
        let [width, height] = self.0.size.map(|n| n as i32);
        let row = y.clamp(0, height - 1);
        &self.0.texels[(row * width + x.rem_euclid(width)) as usize]
    }

    /// Radiance from a direction, before it is multiplied, and how often that is drawn, per steradian.
    pub(super) fn at<R: Real>(&self, frame: &Frame, way: [R; 3]) -> ([R; 3], R) {
        let n = |x: f64| R::from_f64(x);
        let [x, y, z] = way;
        let u = n(0.5) - turn_of([x, y]) + R::from_f32(frame.path_sky_turn);
        let v = n(0.5) - n(2.0) * turn_of([(x * x + y * y).sqrt(), z]);
        let [width, height] = self.0.size.map(|n| R::from_f64(n.into()));
        let place = [(u - u.floor()) * width, v * height];
        let corner = place.map(|c| (c - n(0.5)).floor());
        let weight = [0, 1].map(|k| place[k] - n(0.5) - corner[k]);
        let [i, j] = corner.map(R::to_i32);
        let row = |j: i32| {
            let [a, b] = [self.texel(i, j), self.texel(i + 1, j)];
            let mixed = |c: usize| {
                let [a, b] = [a, b].map(|texel| R::from_f32(texel.radiance[c]));
                a * (n(1.0) - weight[0]) + b * weight[0]
            };
            [mixed(0), mixed(1), mixed(2)]
        };
        let [above, below] = [row(j), row(j + 1)];
        let radiance =
            std::array::from_fn(|c| above[c] * (n(1.0) - weight[1]) + below[c] * weight[1]);
        let [own_x, own_y] = place.map(|c| c.floor().to_i32());
        (radiance, R::from_f32(self.texel(own_x, own_y).density))
    }

    /// A direction to where much light comes from.
    pub(super) fn drawn<R: Real>(&self, frame: &Frame, numbers: [R; 4]) -> [R; 3] {
        let n = |x: f64| R::from_f64(x);
        let [width, height] = self.0.size;
        let count = width * height;
        let drawn = (numbers[0] * n(count.into())).to_i32() as u32;
        let mut texel = drawn.min(count - 1);
        let record = self.0.texels[texel as usize];
        if numbers[1] >= R::from_f32(record.chance) {
            texel = record.other;
        }
        let height_of = |row: u32| {
            let [cosine, _] = turned(n(0.5) * n(row.into()) / n(height.into()));
            cosine
        };
        let (above, below) = (height_of(texel / width), height_of(texel / width + 1));
        let z = above + numbers[2] * (below - above);
        let u = (n((texel % width).into()) + numbers[3]) / n(width.into());
        let turn = n(0.5) - u + R::from_f32(frame.path_sky_turn);
        let across = (n(1.0) - z * z).max(n(0.0)).sqrt();
        let [x, y] = turned(turn - turn.floor()).map(|c| across * c);
        [x, y, z]
    }
}

impl PartialEq for SkyPicture {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
            || self.0.size == other.0.size && self.0.texels == other.0.texels
    }
}

impl fmt::Debug for SkyPicture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.0.size;
        write!(f, "SkyPicture({width} x {height})")
    }
}

/// Means of squares; the last ones of a row and of a column are as large as what is left.
fn averaged(pixels: &[[f32; 3]], width: u32, side: u32, size: [u32; 2]) -> Vec<[f32; 3]> {
    let height = pixels.len() as u32 / width;
    let ends = |i: u32, count: u32, all: u32| {
        let end = if i + 1 == count { all } else { (i + 1) * side };
        i * side..end
    };
    let mean = |x: u32, y: u32| {
        let mut sum = [0.0_f64; 3];
        let mut count = 0.0;
        for row in ends(y, size[1], height) {
            for column in ends(x, size[0], width) {
                let pixel = pixels[(row * width + column) as usize];
                sum = std::array::from_fn(|c| sum[c] + f64::from(pixel[c]));
                count += 1.0;
            }
        }
        sum.map(|s| (s / count) as f32)
    };
    let rows = 0..size[1];
    rows.flat_map(|y| (0..size[0]).map(move |x| mean(x, y)))
        .collect()
}

/// Of a texel of a row, steradians.
fn solid_angle(row: u32, [width, height]: [u32; 2]) -> f64 {
    let cosine = |row: u32| (0.5 * TAU * f64::from(row) / f64::from(height)).cos();
    TAU / f64::from(width) * (cosine(row) - cosine(row + 1))
}

/// By weights 1/8, 6/8 and 1/8 of neighbours, which are the integrals of the bilinear ones over a texel.
fn light_of_texels(pixels: &[[f32; 3]], size: [u32; 2]) -> Vec<f64> {
    let [width, height] = size.map(|n| n as usize);
    let y_of =
        |[r, g, b]: [f32; 3]| 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
    let along = |x: usize, y: usize| {
        let of = |x: usize| y_of(pixels[y * width + x % width]);
        0.125 * (of(x + width - 1) + of(x + 1)) + 0.75 * of(x)
    };
    let light = |i: usize| {
        let (x, y) = (i % width, i / width);
        let rows = [y.saturating_sub(1), y, (y + 1).min(height - 1)];
        let [above, own, below] = rows.map(|y| along(x, y));
        (0.125 * (above + below) + 0.75 * own) * solid_angle(y as u32, size)
    };
    (0..width * height).map(light).collect()
}

/// Of each number of a list the chance that it is kept where it is drawn evenly, and which is taken else, so that all are
/// taken as often as they are large (Vose, "A linear algorithm for generating random numbers with a given distribution", 1991).
fn alias_table(light: &[f64], all: f64) -> Vec<(f32, u32)> {
    let mut left: Vec<f64> = light.iter().map(|y| y / all * light.len() as f64).collect();
    let mut table: Vec<(f32, u32)> = (0..light.len()).map(|i| (1.0, i as u32)).collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) =
        (0..light.len()).partition(|&i| left[i] < 1.0);
    while let (Some(&i), Some(&j)) = (small.last(), large.last()) {
        small.pop();
        table[i] = (left[i] as f32, j as u32);
        left[j] -= 1.0 - left[i];
        if left[j] < 1.0 {
            large.pop();
            small.push(j);
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::pathtrace::random::random_numbers;

    fn frame() -> Frame {
        let mut frame: Frame = bytemuck::Zeroable::zeroed();
        frame.path_sky_turn = 0.1;
        frame
    }

    /// A ground, a bright spot at a corner, and a gradient.
    fn picture() -> SkyPicture {
        let pixel = |i: usize| match i {
            37 => [400.0, 300.0, 200.0],
            _ => [0.1 + 0.01 * (i % 7) as f32, 0.2, 0.05 * (i / 32) as f32],
        };
        let pixels: Vec<_> = (0..32 * 16).map(pixel).collect();
        SkyPicture::new([32, 16], &pixels).expect("a sky")
    }

    /// Radiance over density is the light of all directions; evenly drawn ones bring the same.
    #[test]
    fn drawn_directions_bring_all_light() {
        let (sky, frame) = (picture(), frame());
        let count = 400_000;
        let [mut drawn, mut squares, mut even] = [0.0; 3];
        for i in 0..count {
            let numbers = random_numbers::<f64>([i, 1, 2, 3]);
            let way = sky.drawn(&frame, numbers);
            let ([red, ..], density) = sky.at(&frame, way);
            let light = red / density;
            drawn += light;
            squares += light * light;
        }
        // By the midpoint rule.
        let (rows, columns) = (800, 1600);
        for j in 0..rows {
            let z: f64 = -1.0 + 2.0 * (f64::from(j) + 0.5) / f64::from(rows);
            for i in 0..columns {
                let angle = TAU * (f64::from(i) + 0.5) / f64::from(columns);
                let across = (1.0 - z * z).sqrt();
                let way = [across * angle.cos(), across * angle.sin(), z];
                even += sky.at(&frame, way).0[0];
            }
        }
        even *= 2.0 * TAU / f64::from(rows * columns);
        let count = f64::from(count);
        let mean = drawn / count;
        let deviation = (squares / count - mean * mean).sqrt();
        let error = deviation / count.sqrt();
        assert!(
            (mean - even).abs() < 4.0 * error + 2e-3 * even,
            "{mean} {even} {error}"
        );
        // A spot that is drawn by its own texels alone has 17 times this.
        assert!(deviation < 1.5 * mean, "{deviation} of {mean}");
    }

    #[test]
    fn a_direction_is_seen_where_it_was_drawn() {
        let pixels: Vec<_> = (0..8 * 4).map(|i| [i as f32 + 1.0; 3]).collect();
        let sky = SkyPicture::new([8, 4], &pixels).expect("a sky");
        let mut frame: Frame = bytemuck::Zeroable::zeroed();
        // Along x lies the middle column, along y what is a quarter of a turn to its left, above the first row.
        let at = |frame: &Frame, way: [f64; 3]| sky.at(frame, way).0[0];
        let row = |x: f64| 0.5 * (8.0 + 16.0) + 1.0 + x;
        assert!((at(&frame, [1.0, 0.0, 0.0]) - row(3.5)).abs() < 1e-4);
        assert!((at(&frame, [0.0, 1.0, 0.0]) - row(1.5)).abs() < 1e-4);
        frame.path_sky_turn = 0.25;
        assert!((at(&frame, [0.0, 1.0, 0.0]) - row(3.5)).abs() < 1e-4);
        let above = at(&frame, [1e-9, 0.0, 1.0]);
        assert!((1.0..=8.0).contains(&above), "{above}");
    }

    #[test]
    fn what_is_no_sky_is_refused() {
        let wrong = |size, pixels: &[[f32; 3]]| SkyPicture::new(size, pixels).expect_err("refused");
        assert_eq!(wrong([4, 4], &[[1.0; 3]; 16]), SkyError::Size(4, 4));
        assert_eq!(wrong([2, u32::MAX], &[]), SkyError::Size(2, u32::MAX));
        assert_eq!(wrong([8, 4], &[[1.0; 3]; 16]), SkyError::Size(8, 4));
        assert_eq!(wrong([4, 2], &[[0.0; 3]; 8]), SkyError::Black);
        let mut pixels = [[1.0; 3]; 8];
        pixels[6][1] = -2.0;
        let found = wrong([4, 2], &pixels);
        assert_eq!(
            found,
            SkyError::Radiance {
                x: 2,
                y: 1,
                found: -2.0
            }
        );
        pixels[6][1] = f32::NAN;
        assert!(matches!(wrong([4, 2], &pixels), SkyError::Radiance { .. }));
    }

    #[test]
    fn large_pictures_are_averaged_and_keep_their_light() {
        let [width, height] = [4102, 2051];
        let pixel = |i: u32| [(i % width + i / width) as f32; 3];
        let pixels: Vec<_> = (0..width * height).map(pixel).collect();
        let sky = SkyPicture::new([width, height], &pixels).expect("a sky");
        let [w, h] = sky.size();
        assert!(h <= KEPT_ROWS && w == 2 * h, "{w} {h}");
        let mean = |values: &mut dyn Iterator<Item = f32>, n: usize| {
            values.map(f64::from).sum::<f64>() / n as f64
        };
        let before = mean(&mut pixels.iter().map(|p| p[0]), pixels.len());
        let texels = &sky.0.texels;
        let after = mean(&mut texels.iter().map(|t| t.radiance[0]), texels.len());
        assert!((after / before - 1.0).abs() < 2e-3, "{before} {after}");
    }
}
