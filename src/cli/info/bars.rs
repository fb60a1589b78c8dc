//! A histogram on one line of text.
//!
//! ```text
//! height = 8 ln(1 + count) / ln(1 + largest count), rounded up        in eighths of a line
//! ```

/// Of the line of bars.
const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
/// Bars in the line.
const BAR_COUNT: usize = 48;
/// A histogram on one line, its counts on a logarithmic scale; a blank where there is no voxel.
pub fn bars(counts: &[u64]) -> String {
    let count = counts.len().min(BAR_COUNT);
    let mut sums = vec![0_u64; count];
    for (i, &voxels) in counts.iter().enumerate() {
        sums[i * count / counts.len()] += voxels;
    }
    let most = sums.iter().copied().max().unwrap_or(0).max(1) as f64;
    let bar = |voxels: u64| match voxels {
        0 => ' ',
        voxels => {
            let t = (voxels as f64).ln_1p() / most.ln_1p();
            BARS[((t * BARS.len() as f64).ceil() as usize).clamp(1, BARS.len()) - 1]
        }
    };
    let line: String = sums.into_iter().map(bar).collect();
    format!("|{line}|")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_higher_where_voxels_are_more_and_blank_where_none_are() {
        assert_eq!(bars(&[0, 1, 100]), "| ▂█|");
        assert_eq!(bars(&[5]), "|█|");
        // Twice as many bins as bars: each bar is two of them.
        let counts: Vec<u64> = (0..2 * BAR_COUNT as u64)
            .map(|i| u64::from(i < 2))
            .collect();
        let line = bars(&counts);
        assert_eq!(line.chars().filter(|&c| c == '█').count(), 1, "{line}");
        assert_eq!(line.chars().count(), BAR_COUNT + 2, "{line}");
    }
}
