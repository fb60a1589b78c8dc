//! Random numbers as a pure function of pixel, path, draw and seed: CPU reference of `shaders/lib/random.wgsl`. pcg4d
//! (Jarzynski & Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020).

use crate::real::Real;

pub(super) fn pcg4d(key: [u32; 4]) -> [u32; 4] {
    let mix = |[mut x, mut y, mut z, mut w]: [u32; 4]| {
        x = x.wrapping_add(y.wrapping_mul(w));
        y = y.wrapping_add(z.wrapping_mul(x));
        z = z.wrapping_add(x.wrapping_mul(y));
        w = w.wrapping_add(y.wrapping_mul(z));
        [x, y, z, w]
    };
    let started = key.map(|v| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    mix(mix(started).map(|v| v ^ v >> 16))
}

/// Four numbers from 0 (included) to 1 (excluded), multiples of 2^-24.
pub fn random_numbers<R: Real>(key: [u32; 4]) -> [R; 4] {
    pcg4d(key).map(|v| R::from_f64(f64::from(v >> 8) / 16_777_216.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The answers of an independent program after the paper.
    #[test]
    fn known_keys_have_their_answers() {
        let zero = [0x0f02_f829, 0x2d56_8769, 0x32b0_c43b, 0xd325_48ea];
        assert_eq!(pcg4d([0; 4]), zero);
        let other = [0x3622_cd16, 0xf114_71d8, 0xe110_9b3f, 0x02b9_4c2f];
        assert_eq!(pcg4d([1, 2, 3, 4]), other);
    }

    /// Of the four numbers of a draw, and the next draw: chi^2 of all pairs in 16 x 16 bins is 255 +- 22.6 of numbers that
    /// know nothing of each other.
    #[test]
    fn numbers_of_a_draw_know_nothing_of_each_other() {
        let count = 40_000;
        for [a, b] in [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3], [3, 4]] {
            let pairs =
                |k: u32| [a, b].map(|n| random_numbers::<f64>([k % 200, k / 200, 8 + n, 0]));
            for (i, j) in (0..16).map(|n| (n / 4, n % 4)) {
                let mut bins = [0.0; 256];
                for [x, y] in (0..count).map(pairs) {
                    bins[(16.0 * x[i]) as usize * 16 + (16.0 * y[j]) as usize] += 1.0;
                }
                let even = f64::from(count) / 256.0;
                let chi: f64 = bins.iter().map(|n: &f64| (n - even).powi(2) / even).sum();
                assert!(chi < 255.0 + 6.0 * 22.6, "{a} {b} {i} {j}: {chi}");
            }
        }
    }
}
