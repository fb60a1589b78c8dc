//! A plane through weighted pixels, for each pixel of some rows: least squares whose unknowns are what the plane has at the pixel
//! itself, and its slopes.
//!
//! ```text
//! A = sum of w x x^T        B = sum of w x y^T        c = (A + n ridge)^-1 B        n = sum of w        at the pixel itself: c_0
//! ```
//!
//! x_0 = 1 and has no ridge, so that a constant stays one; slopes that the pixels say nothing about are 0. Solved by a Cholesky
//! factorization (Golub and Van Loan, "Matrix Computations", 4.2).

use super::{COLORS, rows};

/// Slopes are held towards 0 as by so many thousandths of the pixels.
const RIDGE: f64 = 1e-3;

/// Sums over pixels; of each number all pixels lie one behind the other.
pub(super) struct Fits {
    unknowns: usize,
    pixels: usize,
    /// The rows of the upper triangle of A, one after another.
    squares: Vec<f32>,
    /// The rows of B.
    products: Vec<f32>,
    /// w x_i of the pixels that are being added.
    weighted: Vec<f32>,
}

impl Fits {
    pub fn new(unknowns: usize, pixels: usize) -> Self {
        Self {
            unknowns,
            pixels,
            squares: vec![0.0; unknowns * (unknowns + 1) / 2 * pixels],
            products: vec![0.0; unknowns * COLORS * pixels],
            weighted: Vec::new(),
        }
    }

    /// Adds to the pixels from `first` on, as many as have weights, one other pixel each: x, of which each number is a slice, and y.
    pub fn add(&mut self, first: usize, weights: &[f32], x: &[Vec<f32>], y: [&[f32]; COLORS]) {
        let count = weights.len();
        self.weighted.resize(count, 0.0);
        let pixels = first..first + count;
        let mut squares = self.squares.chunks_exact_mut(self.pixels);
        let mut products = self.products.chunks_exact_mut(self.pixels);
        for (i, x_i) in x.iter().enumerate() {
            let (weighted, x_i) = (&mut self.weighted[..count], &x_i[..count]);
            rows::set(weighted, |n| weights[n] * x_i[n]);
            for (x_j, sums) in x[i..].iter().zip(&mut squares) {
                add_products(&mut sums[pixels.clone()], &self.weighted, x_j);
            }
            for (y, sums) in y.iter().zip(&mut products) {
                add_products(&mut sums[pixels.clone()], &self.weighted, y);
            }
        }
    }

    /// c_0 of a pixel, which has some weight.
    pub fn at(&self, pixel: usize) -> [f32; COLORS] {
        let n = self.unknowns;
        let weight = f64::from(self.squares[pixel]);
        let mut numbers = self.squares[pixel..].iter().step_by(self.pixels);
        let mut matrix = vec![0.0_f64; n * n];
        for i in 0..n {
            for j in i..n {
                matrix[j * n + i] = numbers.next().copied().map_or(0.0, f64::from);
            }
            if i > 0 {
                matrix[i * n + i] += RIDGE * weight;
            }
        }
        factorize(&mut matrix, n);
        let sums: Vec<f64> = (self.products[pixel..].iter().step_by(self.pixels))
            .map(|&sum| f64::from(sum))
            .collect();
        std::array::from_fn(|c| {
            let column: Vec<f64> = sums.iter().skip(c).step_by(COLORS).copied().collect();
            first_unknown(&matrix, column) as f32
        })
    }
}

fn add_products(sums: &mut [f32], a: &[f32], b: &[f32]) {
    let (a, b) = (&a[..sums.len()], &b[..sums.len()]);
    rows::add(sums, |i| a[i] * b[i]);
}

/// The lower triangle of a matrix that is positive definite, into L of L L^T.
fn factorize(matrix: &mut [f64], n: usize) {
    for j in 0..n {
        for i in j..n {
            let before = (0..j).map(|k| matrix[i * n + k] * matrix[j * n + k]);
            let rest = matrix[i * n + j] - before.sum::<f64>();
            matrix[i * n + j] = match i == j {
                // What rounding leaves of nothing.
                true => rest.max(f64::MIN_POSITIVE).sqrt(),
                false => rest / matrix[j * n + j],
            };
        }
    }
}

/// The first of the unknowns x of L L^T x = b.
fn first_unknown(lower: &[f64], mut b: Vec<f64>) -> f64 {
    let n = b.len();
    for i in 0..n {
        let before: f64 = (0..i).map(|k| lower[i * n + k] * b[k]).sum();
        b[i] = (b[i] - before) / lower[i * n + i];
    }
    for i in (0..n).rev() {
        let behind: f64 = (i + 1..n).map(|k| lower[k * n + i] * b[k]).sum();
        b[i] = (b[i] - behind) / lower[i * n + i];
    }
    b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that are even by their bits (Steele, Lea and Flood 2014), 0 to 1.
    fn number(i: u64) -> f32 {
        let mut z = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        ((z ^ (z >> 27)) >> 40) as f32 / (1 << 24) as f32
    }

    /// Of 200 pixels on a plane with slopes 2 and -1 and a height of 0.5, for two pixels at once, of which one has other weights.
    #[test]
    fn a_plane_is_found_but_for_its_ridge() {
        let mut fits = Fits::new(4, 3);
        for i in 0..200 {
            let [u, v] = [number(2 * i) - 0.5, number(2 * i + 1) - 0.5];
            let x = [1.0, u, v, 0.0].map(|x| vec![x; 2]);
            let y = [[0.5 + 2.0 * u - v; 2], [0.25; 2], [-3.0 * v; 2], [u * v; 2]];
            fits.add(
                1,
                &[1.0, number(1000 + i)],
                &x,
                y.each_ref().map(|y| &y[..]),
            );
        }
        for pixel in [1, 2] {
            let [plane, even, through_0, _] = fits.at(pixel);
            // Slopes of numbers of variance 1/12 are held back by 12 thousandths; means of 200 of them are off by .02 each.
            assert!((plane - 0.5).abs() < 0.012 * 3.0 * 0.06, "{plane}");
            assert!((even - 0.25).abs() < 1e-6, "{even}");
            assert!(through_0.abs() < 0.012 * 3.0 * 0.06, "{through_0}");
        }
    }

    #[test]
    fn one_pixel_is_what_it_is() {
        let mut fits = Fits::new(3, 1);
        let x = [1.0, 0.0, 0.0].map(|x| vec![x]);
        fits.add(0, &[1.0], &x, [&[0.1], &[0.2], &[0.3], &[1.0]]);
        let found = fits.at(0);
        for (found, wanted) in found.into_iter().zip([0.1, 0.2, 0.3, 1.0]) {
            assert!((found - wanted).abs() < 1e-7, "{found:?}");
        }
    }
}
