//! Numbers of the first choices of a path, which fill the square evenly: CPU reference of `shaders/lib/sobol.wgsl`, which has the
//! formulas.

use super::random::pcg4d;
use crate::real::Real;

/// The number has its bits turned round.
fn owen_scrambled(reversed: u32, seed: u32) -> u32 {
    let factors = [0x6c50_b47c, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6];
    let turn = |v: u32, factor: u32| v ^ v.wrapping_mul(factor);
    factors.into_iter().fold(reversed.wrapping_add(seed), turn)
}

/// Bit j is the sum of those bits k of which k over j is odd.
fn pascal(i: u32) -> u32 {
    let steps = [
        (16, 0x0000_ffff),
        (8, 0x00ff_00ff),
        (4, 0x0f0f_0f0f),
        (2, 0x3333_3333),
        (1, 0x5555_5555),
    ];
    let step = |y: u32, (by, mask): (u32, u32)| y ^ y >> by & mask;
    steps.into_iter().fold(i, step)
}

/// How many paths in a row are of one half, as a power of two: few of the first ones.
fn paths_of_half(number: u32) -> u32 {
    1 + u32::from(number >= 8) + u32::from(number >= 16)
}

/// Which of two pictures, whose paths know nothing of each other, a path is one of.
pub(crate) fn half_of_path(number: u32) -> usize {
    (number >> paths_of_half(number) & 1) as usize
}

/// How many paths from this one on are of its half, in a row.
pub(crate) fn left_of_half(number: u32) -> u32 {
    let all = 1 << paths_of_half(number);
    all - number % all
}

/// Integers of [`sobol_numbers`].
fn sobol_codes([pixel, path, _, seed]: [u32; 4], pair: u32) -> [u32; 2] {
    let bit = paths_of_half(path);
    let number = path >> (bit + 1) << bit | path & ((1 << bit) - 1);
    let half = half_of_path(path) as u32;
    let seeds = pcg4d([pixel, u32::MAX - (2 * pair + half), 0, seed]);
    let i = owen_scrambled(number.reverse_bits(), seeds[0]).reverse_bits();
    [(i, seeds[1]), (pascal(i), seeds[2])].map(|(v, seed)| owen_scrambled(v, seed).reverse_bits())
}

/// Of pixel, path and seed of a key: two numbers from 0 (included) to 1 (excluded), multiples of 2^-24.
pub fn sobol_numbers<R: Real>(key: [u32; 4], pair: u32) -> [R; 2] {
    sobol_codes(key, pair).map(|v| R::from_f64(f64::from(v >> 8) / 16_777_216.0))
}

#[cfg(test)]
mod tests {
    use super::super::random::random_numbers;
    use super::*;

    /// The paths of one half, in order.
    fn paths_of(half: usize) -> impl Iterator<Item = u32> {
        (0..).filter(move |&n| half_of_path(n) == half)
    }

    /// The second dimension by direction numbers, as Sobol's tables have them: each the one before, exclusive or half of it.
    #[test]
    fn pascals_triangle_is_what_direction_numbers_make() {
        let mut direction = 1_u32 << 31;
        let mut directions = [0; 32];
        for k in &mut directions {
            *k = direction;
            direction ^= direction >> 1;
        }
        for i in (0..2000).map(|n: u32| n.wrapping_mul(0x9e37_79b9) ^ n) {
            let bits = (0..32).filter(|k| i >> k & 1 == 1);
            let wanted = bits.fold(0, |y, k| y ^ directions[k]);
            assert_eq!(pascal(i).reverse_bits(), wanted, "{i}");
        }
    }

    #[test]
    fn halves_have_as_many_paths_and_come_in_whole_blocks() {
        for all in [4, 8, 16, 32, 48, 64, 256] {
            let first = (0..all).filter(|&n| half_of_path(n) == 0).count();
            assert_eq!(2 * first, all as usize);
        }
        // Blocks of 2 up to the eighth, of 4 up to the sixteenth, then of 8.
        let blocks = (0..8).step_by(2).map(|n| (n, 2));
        let blocks = blocks.chain([(8, 4), (12, 4)]);
        for (first, count) in blocks.chain((16..400).step_by(8).map(|n| (n, 8))) {
            let half = half_of_path(first);
            assert!((first..first + count).all(|n| half_of_path(n) == half));
            assert_eq!(
                [left_of_half(first), left_of_half(first + 1)],
                [count, count - 1]
            );
        }
    }

    /// Of the first 2^m paths of a half, of any pixel, pair and seed, one is in each box 2^-a x 2^-b, a + b = m.
    #[test]
    fn each_box_has_its_path() {
        for (pixel, seed) in [(0, 0), (7, 0), (123_456, 9)] {
            for (half, pair) in [(0, 0), (1, 0), (0, 1), (1, 2)] {
                for m in 0..=10_u32 {
                    for a in 0..=m {
                        let mut seen = vec![false; 1 << m];
                        for n in paths_of(half).take(1 << m) {
                            let [x, y] = sobol_codes([pixel, n, 0, seed], pair).map(u64::from);
                            let at = (x << a >> 32) << (m - a) | y << (m - a) >> 32;
                            assert!(!seen[at as usize], "{pixel} {seed} {half} {pair} {m} {a}");
                            seen[at as usize] = true;
                        }
                    }
                }
            }
        }
    }

    /// The part of a quarter disc: root mean square errors over 400 pixels. The errors of random numbers are the binomial ones; the
    /// others were computed by an independent program (200 seeds: of a root mean square of normal errors known to 1 / sqrt(400) and
    /// 1 / sqrt(800); four of both).
    #[test]
    fn a_quarter_disc_is_measured_better_than_by_random_numbers() {
        let part = std::f64::consts::FRAC_PI_4;
        let error = |numbers: &dyn Fn(u32, u32) -> [f64; 2], count: u32| {
            let off = |pixel: u32| {
                let paths = paths_of(0).take(count as usize);
                let inside = paths.filter(|&n| {
                    let [x, y] = numbers(pixel, n);
                    x * x + y * y < 1.0
                });
                (inside.count() as f64 / f64::from(count) - part).powi(2)
            };
            ((0..400).map(off).sum::<f64>() / 400.0).sqrt()
        };
        let sobol = |pixel, n| sobol_numbers::<f64>([pixel, n, 0, 3], 1);
        let random = |pixel, n| {
            let [x, y, ..] = random_numbers::<f64>([pixel, n, 5, 3]);
            [x, y]
        };
        for (count, wanted) in [(16, 0.062), (64, 0.020), (256, 0.0070), (1024, 0.0025)] {
            let [by_sobol, by_random] = [error(&sobol, count), error(&random, count)];
            let binomial = (part * (1.0 - part) / f64::from(count)).sqrt();
            println!("{count}: {by_sobol} {by_random}");
            let apart = 4.0 * (1.0 / 400.0_f64 + 1.0 / 800.0).sqrt();
            assert!(
                (by_sobol / wanted - 1.0).abs() < apart,
                "{count} {by_sobol}"
            );
            assert!((by_random / binomial - 1.0).abs() < 4.0 / 800.0_f64.sqrt());
        }
    }

    /// Of neighbours, of the halves, of the pairs and of the seeds: of one number in each, the correlation over many pixels.
    #[test]
    fn pixels_halves_pairs_and_seeds_know_nothing_of_each_other() {
        let count = 20_000;
        let number = |pixel, path, pair, seed| sobol_numbers::<f64>([pixel, path, 0, seed], pair);
        for path in [0, 1, 5, 40] {
            // The same place in the other half.
            let other_half = path ^ 1 << paths_of_half(path);
            assert_ne!(half_of_path(path), half_of_path(other_half));
            let others: [&dyn Fn(u32) -> [f64; 2]; 5] = [
                &|pixel| number(pixel + 1, path, 0, 0),
                &|pixel| number(pixel + 512, path, 0, 0),
                &|pixel| number(pixel, other_half, 0, 0),
                &|pixel| number(pixel, path, 1, 0),
                &|pixel| number(pixel, path, 0, 1),
            ];
            for (k, other) in others.into_iter().enumerate() {
                for (a, b) in [(0, 0), (1, 1), (0, 1), (1, 0)] {
                    let products = (0..count).map(|pixel| {
                        (number(pixel, path, 0, 0)[a] - 0.5) * (other(pixel)[b] - 0.5)
                    });
                    // Of even numbers, their variance is 1/12.
                    let correlation = 12.0 * products.sum::<f64>() / f64::from(count);
                    let most = 5.0 / f64::from(count).sqrt();
                    assert!(
                        correlation.abs() < most,
                        "{path} {k} {a} {b}: {correlation}"
                    );
                }
            }
        }
    }
}
