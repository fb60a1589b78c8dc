//! Random numbers of a counter: the same on every machine.
//!
//! ```text
//! v = 1664525 v + 1013904223
//! x += y w,  y += z x,  z += x y,  w += y z;   v ^= v >> 16;   the four sums again
//! ```
//!
//! Jarzynski & Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020: pcg4d.

/// Four numbers of 32 bits from four others.
pub(super) fn pcg4d(v: [u32; 4]) -> [u32; 4] {
    let [mut x, mut y, mut z, mut w] =
        v.map(|n| n.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    let mut mix = |shift: u32| {
        [x, y, z, w] = [x, y, z, w].map(|n| n ^ n.checked_shr(shift).unwrap_or(0));
        x = x.wrapping_add(y.wrapping_mul(w));
        y = y.wrapping_add(z.wrapping_mul(x));
        z = z.wrapping_add(x.wrapping_mul(y));
        w = w.wrapping_add(y.wrapping_mul(z));
    };
    // A number over all its bits is none: nothing is mixed before the first sums.
    mix(32);
    mix(16);
    [x, y, z, w]
}

/// Numbers from 0 to 1, of one counter and the number that a person chose.
pub(super) fn unit(counter: u32, seed: u32) -> [f64; 3] {
    let [x, y, z, _] = pcg4d([counter, seed, 0, 0]);
    [x, y, z].map(|n| (f64::from(n) + 0.5) / 4_294_967_296.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_paper() {
        // Computed by its listing in another language.
        assert_eq!(pcg4d([0, 0, 0, 0]), GOLDEN[0]);
        assert_eq!(pcg4d([1, 2, 3, 4]), GOLDEN[1]);
    }

    const GOLDEN: [[u32; 4]; 2] = [
        [251852841, 760645481, 850445371, 3542436074],
        [908250390, 4044648920, 3775961919, 45698095],
    ];

    #[test]
    fn a_thousand_numbers_fill_the_unit_evenly() {
        let mut bins = [[0; 10]; 3];
        for i in 0..1000 {
            for (bins, number) in bins.iter_mut().zip(unit(i, 7)) {
                bins[(10.0 * number) as usize] += 1;
            }
        }
        // 100 +- 9.5 in each.
        assert!(
            bins.iter().flatten().all(|&n| (60..140).contains(&n)),
            "{bins:?}"
        );
    }
}
