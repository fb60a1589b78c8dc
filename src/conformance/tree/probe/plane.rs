//! A triangle on the screen in f64, and what the rasterizer may make of numbers at its corners.
//!
//! ```text
//! q(p) = w0 q0 + w1 q1 + w2 q2,   w the barycentric weights of p        with corners moved by up to D:  q(p - sum w D)
//! ```
//!
//! So moved corners give numbers of the true triangle at places within D of p, exactly.

use crate::conformance::test_bed::Random;
use crate::gpu::Gpu;

/// What Vulkan demands of floating-point computation outside of shaders: one part in 10^5 an operation.
pub const DEMANDED: f64 = 1e-5;
/// What 32-bit floats round.
pub const SINGLE: f64 = 1.0 / (1u32 << 24) as f64;

/// Corners, in pixels.
#[derive(Clone, Copy, Debug)]
pub struct Triangle(pub [[f64; 2]; 3]);

impl Triangle {
    /// Twice the area, signed.
    fn area(&self) -> f64 {
        let [a, b, c] = self.0;
        (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
    }

    /// The barycentric weights of a place.
    pub fn weights(&self, p: [f64; 2]) -> [f64; 3] {
        let area = self.area();
        let part = |i: usize| {
            let (b, c) = (self.0[(i + 1) % 3], self.0[(i + 2) % 3]);
            Self([p, b, c]).area() / area
        };
        [part(0), part(1), part(2)]
    }

    /// How far inside of the nearest edge a place lies, in pixels; less than 0 outside.
    pub fn depth_inside(&self, p: [f64; 2]) -> f64 {
        let weights = self.weights(p);
        let inside = |i: usize| {
            let (b, c) = (self.0[(i + 1) % 3], self.0[(i + 2) % 3]);
            let length = (c[0] - b[0]).hypot(c[1] - b[1]);
            weights[i] * self.area().abs() / length
        };
        inside(0).min(inside(1)).min(inside(2))
    }

    /// The number at a place.
    pub fn at(&self, q: [f64; 3], p: [f64; 2]) -> f64 {
        let weights = self.weights(p);
        (0..3).map(|i| weights[i] * q[i]).sum()
    }

    /// The sum of the sizes of all that is added up for the number at a place of a picture of so many pixels: each of
    /// some fourteen operations may be off by a part of it.
    pub fn size(&self, q: [f64; 3], [width, height]: [f64; 2]) -> f64 {
        let area = self.area().abs();
        let most = q.iter().fold(0.0f64, |most, q| most.max(q.abs()));
        let part = |i: usize| {
            let (b, c) = (self.0[(i + 1) % 3], self.0[(i + 2) % 3]);
            let reach = width * (c[1] - b[1]).abs() + height * (c[0] - b[0]).abs();
            q[i].abs() * reach / area
        };
        most + part(0) + part(1) + part(2)
    }
}

/// Operations that make a number at a pixel of those at the corners: two differences, products and a sum for each of
/// two slopes, a division by the area, and two products and sums for the place.
pub const OPERATIONS: f64 = 14.0;

/// How far corners may be from where they were asked for, along each axis, in pixels of a picture so wide: a step of
/// the device's sub-pixel grid, and three operations of the viewport's transformation.
pub fn displacement(gpu: &Gpu, width: f64) -> f64 {
    2f64.powi(-(sub_pixel_bits(gpu) as i32)) + 3.0 * DEMANDED * width
}

/// `subPixelPrecisionBits`.
pub fn sub_pixel_bits(gpu: &Gpu) -> u32 {
    let instance = gpu.instance();
    // SAFETY: the physical device belongs to the instance; both live as long as `gpu`.
    let limits = unsafe { instance.get_physical_device_properties(gpu.physical_device()) }.limits;
    limits.sub_pixel_precision_bits
}

/// A place and those around it that displaced corners may bring there.
pub fn around([x, y]: [f64; 2], displaced: f64) -> [[f64; 2]; 5] {
    let d = displaced;
    [
        [x, y],
        [x - d, y - d],
        [x + d, y - d],
        [x - d, y + d],
        [x + d, y + d],
    ]
}

/// Triangles that fill a picture without overlapping, however they go round.
pub fn mesh(random: &mut Random, [width, height]: [f64; 2]) -> Vec<Triangle> {
    const CELLS: [usize; 2] = [3, 2];
    let mut corner = Vec::new();
    for j in 0..=CELLS[1] {
        for i in 0..=CELLS[0] {
            let mut at = [
                width * i as f64 / CELLS[0] as f64,
                height * j as f64 / CELLS[1] as f64,
            ];
            for (k, n) in [i, j].into_iter().enumerate() {
                if n > 0 && n < CELLS[k] {
                    at[k] += 4.0 * random.unit() - 2.0;
                }
            }
            corner.push(at);
        }
    }
    let mut triangles = Vec::new();
    for j in 0..CELLS[1] {
        for i in 0..CELLS[0] {
            let at = |di: usize, dj: usize| corner[(j + dj) * (CELLS[0] + 1) + i + di];
            let [a, b, c, d] = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
            for mut triangle in [[a, b, c], [a, c, d]] {
                triangle.rotate_left(random.below(3) as usize);
                if random.below(2) == 0 {
                    triangle.swap(0, 1);
                }
                triangles.push(Triangle(triangle));
            }
        }
    }
    triangles
}
