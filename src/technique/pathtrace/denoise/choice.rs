//! Which of two filtered pictures a pixel is taken from: the one that is nearer to paths that it was not made of.
//!
//! ```text
//! E(p) = mean over 5 x 5 of sum over halves and colours of (a' - b)^2        its variance of b is the same in both
//! s(p) = mean over 5 x 5 of (E of the second < E of the first)        picture = first + s (second - first)
//! ```
//!
//! Rousselle, Manzi & Zwicker, "Robust Denoising using Feature and Color Buffers", 2013, choose so among three.

use super::COLORS;

/// Patches reach so far.
const REACH: usize = 2;

type Picture = Vec<[f32; COLORS]>;

/// Of two filtered pictures of both halves the mean over the halves.
pub(super) fn chosen(
    halves: [&[[f32; COLORS]]; 2],
    first: &[Picture; 2],
    second: &[Picture; 2],
    size: [usize; 2],
) -> Picture {
    let [of_first, of_second] = [first, second].map(|filtered| errors(halves, filtered, size));
    let is_nearer = of_first.iter().zip(&of_second);
    let is_nearer: Vec<f32> =
        (is_nearer.map(|(first, second)| f32::from(second < first))).collect();
    let share = mean_of_patches(&is_nearer, size);
    let pixel = |i: usize| {
        std::array::from_fn(|c| {
            let [first, second] = [first, second].map(|of| 0.5 * of[0][i][c] + 0.5 * of[1][i][c]);
            first + share[i] * (second - first)
        })
    };
    (0..share.len()).map(pixel).collect()
}

/// E of each pixel.
fn errors(halves: [&[[f32; COLORS]]; 2], filtered: &[Picture; 2], size: [usize; 2]) -> Vec<f32> {
    let square = |i: usize| {
        let of_half = |half: usize| {
            let (found, other) = (filtered[half][i], halves[1 - half][i]);
            (0..3).map(|c| (found[c] - other[c]).powi(2)).sum::<f32>()
        };
        of_half(0) + of_half(1)
    };
    mean_of_patches(&(0..halves[0].len()).map(square).collect::<Vec<_>>(), size)
}

/// Of 5 x 5 numbers around each, fewer at edges.
fn mean_of_patches(numbers: &[f32], [width, height]: [usize; 2]) -> Vec<f32> {
    let mean = |at: usize| {
        let (x, y) = (at % width, at / width);
        let xs = x.saturating_sub(REACH)..(x + REACH + 1).min(width);
        let ys = y.saturating_sub(REACH)..(y + REACH + 1).min(height);
        let count = (xs.len() * ys.len()) as f32;
        let rows = ys.map(|y| numbers[y * width..][xs.clone()].iter().sum::<f32>());
        rows.sum::<f32>() / count
    };
    (0..numbers.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_nearer_to_the_other_half_is_taken() {
        let size = [40, 9];
        let of = |left: f32, right: f32| -> Picture {
            let pixel = |i: usize| [if i % 40 < 20 { left } else { right }; COLORS];
            (0..360).map(pixel).collect()
        };
        let (truth, left, right) = (of(1.0, 2.0), of(1.1, 9.0), of(5.0, 2.1));
        let halves = [&truth[..], &truth[..]];
        let found = chosen(halves, &[left.clone(), left], &[right.clone(), right], size);
        // Away from the border between them, which is mixed.
        assert_eq!(found[4 * 40 + 5], [1.1; COLORS]);
        assert_eq!(found[4 * 40 + 35], [2.1; COLORS]);
        let mixed = found[4 * 40 + 19][0];
        assert!(mixed > 1.1 && mixed < 5.0, "{mixed}");
    }
}
