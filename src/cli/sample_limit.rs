//! What to do where rays would take more samples, or slabs reach further, than there is room for.

use crate::technique::Error;
use std::borrow::Cow;

/// The hint for such an error.
pub fn hint(error: &Error) -> Cow<'static, str> {
    match error {
        Error::LoopsEnd {
            samples_per_voxel: Some(most),
            follows_light: true,
            ..
        } if *most > 0.0 => format!(
            "--shadows volume follows light once; --samples-per-voxel {} stays below it",
            rounded_down(*most)
        )
        .into(),
        Error::LoopsEnd {
            samples_per_voxel: Some(most),
            ..
        } if *most > 0.0 => format!(
            "--samples-per-voxel {} stays below it; --technique slices-3d has no such loops, without layers of depth",
            rounded_down(*most)
        )
        .into(),
        Error::SplatLoopsEnd { .. } => {
            "a larger --size, a smaller --splat-std and --splat-low-pass 0 have fewer; --device reference has no such limit"
                .into()
        }
        Error::LoopsEnd { .. } => "--device reference has no such limit".into(),
        Error::SlabsTooLong { .. } => "more --samples-per-voxel stay below it".into(),
        _ => "fewer --samples-per-voxel stay below it".into(),
    }
}

/// To two digits, never up: what is said has to do.
pub(super) fn rounded_down(number: f64) -> f64 {
    let digits = 1.0 - number.log10().floor();
    // A power of ten that is whole divides without an error that would show.
    let scale = 10_f64.powf(digits.max(0.0));
    (number * scale).floor() / scale
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_samples_of_a_hint_stay_below_the_limit() {
        let of_light = |samples_per_voxel, follows_light| {
            hint(&Error::LoopsEnd {
                wanted: 13310.0,
                limit: 4535.0,
                samples_per_voxel,
                follows_light,
            })
        };
        let hint = |samples_per_voxel| of_light(samples_per_voxel, false);
        for (most, said) in [
            (0.3407, "--samples-per-voxel 0.34 stays"),
            (0.0299, "--samples-per-voxel 0.029 stays"),
            (1.99, "--samples-per-voxel 1.9 stays"),
            (12.9, "--samples-per-voxel 12 stays"),
        ] {
            assert!(
                hint(Some(most)).contains(said),
                "{most}: {}",
                hint(Some(most))
            );
        }
        assert!(!hint(None).contains("--samples-per-voxel"));
        assert!(of_light(Some(0.3), true).contains("--shadows volume"));
    }
}
