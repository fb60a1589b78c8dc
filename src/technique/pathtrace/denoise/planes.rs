//! Numbers of pixels by themselves, with edges around the picture: rows of them are computed with at once.

use super::PAD;

/// One number of each pixel; the [`PAD`] beyond each edge repeat it.
#[derive(Clone)]
pub(super) struct Plane {
    numbers: Vec<f32>,
    stride: usize,
}

pub(super) fn planes<const N: usize>(picture: &[[f32; N]], size: [usize; 2]) -> Vec<Plane> {
    (0..N).map(|n| Plane::of(picture, n, size)).collect()
}

impl Plane {
    fn of<const N: usize>(picture: &[[f32; N]], n: usize, [width, height]: [usize; 2]) -> Self {
        let held = |i: usize, side: usize| i.saturating_sub(PAD).min(side - 1);
        let rows = 0..height + 2 * PAD;
        let row = |y: usize| &picture[held(y, height) * width..][..width];
        let stride = width + 2 * PAD;
        let numbers = rows.flat_map(|y| (0..stride).map(move |x| row(y)[held(x, width)][n]));
        Self {
            numbers: numbers.collect(),
            stride,
        }
    }

    /// So many numbers of a row from one on; both count from [`PAD`] before the picture.
    pub fn row(&self, y: usize, before: usize, count: usize) -> &[f32] {
        &self.numbers[y * self.stride + before..][..count]
    }
}

/// Of each half, per number: v.
pub(super) fn variance<const N: usize>(
    [a, b]: [&[[f32; N]]; 2],
    [width, height]: [usize; 2],
) -> Vec<[f32; N]> {
    let of = |x: usize, y: usize| {
        let (a, b) = (a[y * width + x], b[y * width + x]);
        std::array::from_fn(|c| 0.5 * (a[c] - b[c]).powi(2))
    };
    let mean = |at: usize| {
        let (x, y) = (at % width, at / width);
        let (xs, ys) = (
            x.saturating_sub(1)..=(x + 1).min(width - 1),
            y.saturating_sub(1)..=(y + 1).min(height - 1),
        );
        let count = (xs.clone().count() * ys.clone().count()) as f32;
        let all = ys.flat_map(|y| xs.clone().map(move |x| (x, y)));
        let sum = all.fold([0.0; N], |sum: [f32; N], (x, y)| {
            let one: [f32; N] = of(x, y);
            std::array::from_fn(|c| sum[c] + one[c])
        });
        sum.map(|s| s / count)
    };
    (0..width * height).map(mean).collect()
}
