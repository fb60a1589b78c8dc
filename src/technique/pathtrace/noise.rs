//! How noisy a picture of paths is: the one rule of offscreen pictures and of hosts' frames.
//!
//! ```text
//! noise     = sqrt(sum over pixels of the variance of their means) / sqrt(sum of their squares)      of luminance
//! variance  = D / (N (B - 1))
//! D         = sum over blocks of n (y - mean)^2 = S2 - S1^2 / N
//! ```
//!
//! B blocks have N paths a pixel together; y is the mean luminance of the n paths of one block, S1 the sum of n y and S2 that of
//! n y^2. Blocks are taken for independent. Where they come one after the other, D grows with each (Welford 1962), which
//! `shaders/path_noise.wgsl` does:
//!
//! ```text
//! D += b (b + n) / n (y - y0)^2            y0, y: the mean of b paths before the block, and with it
//! ```

/// What a picture is the mean of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PathBlocks {
    /// Paths of each pixel.
    pub paths: u32,
    /// In so many blocks.
    pub blocks: u32,
}

impl PathBlocks {
    /// Of the mean luminance of a pixel whose blocks deviate so much; NaN where one block is all.
    pub fn variance(self, deviation: f64) -> f64 {
        match self.blocks > 1 {
            true => deviation.max(0.0) / self.degrees(),
            false => f64::NAN,
        }
    }

    /// The standard error of luminance, as a part of what the picture shows, by the sums of deviations and of squares of
    /// means over its pixels; `None`: one block does not tell, nor does a black picture.
    pub fn noise(self, deviations: f64, squares: f64) -> Option<f64> {
        let is_told = self.blocks > 1 && squares > 0.0;
        is_told.then(|| (self.variance(deviations) / squares).sqrt())
    }

    /// N (B - 1).
    fn degrees(self) -> f64 {
        f64::from(self.paths) * (f64::from(self.blocks) - 1.0)
    }
}

/// Of linear light (ITU-R BT.709).
pub(crate) fn luminance([r, g, b, _]: [f64; 4]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of blocks of 2, 6 and 4 paths.
    #[test]
    fn deviations_grow_block_by_block_to_those_of_sums() {
        let found = [(2.0, 0.5), (6.0, 1.25), (4.0, 0.75)];
        let [mut before, mut mean, mut deviation] = [0.0; 3];
        let [mut first, mut second] = [0.0; 2];
        for (n, y) in found {
            let then = mean;
            mean += n * (y - mean) / (before + n);
            deviation += before * (before + n) / n * (mean - then) * (mean - then);
            before += n;
            (first, second) = (first + n * y, second + n * y * y);
        }
        let wanted: f64 = second - first * first / before;
        assert!((deviation - wanted).abs() < 1e-12, "{deviation} {wanted}");
        let of = PathBlocks {
            paths: 12,
            blocks: 3,
        };
        assert!((of.variance(wanted) - wanted / 24.0).abs() < 1e-15);
        let noise = of.noise(wanted, mean * mean).expect("three blocks tell");
        assert!((noise - (wanted / 24.0).sqrt() / mean).abs() < 1e-12);
        assert_eq!(of.noise(wanted, 0.0), None);
        let one = PathBlocks {
            paths: 12,
            blocks: 1,
        };
        assert_eq!(one.noise(0.0, 1.0), None);
    }
}
