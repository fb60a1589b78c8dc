//! Pictures of channels, put together where each was projected by itself: colours and opacities are added, and
//! end at 1.

use crate::picture::{LayerKind, Picture};

/// The sum of pictures of one extent; of their layers the counts of samples, which are those of each.
///
/// # Errors
/// The first of the pictures' own.
pub fn sum_of<E>(mut pictures: impl Iterator<Item = Result<Picture, E>>) -> Result<Picture, E> {
    let mut sum = pictures.next().expect("a scene has a volume")?;
    for picture in pictures {
        for (sum, pixel) in sum.pixels.iter_mut().zip(&picture?.pixels) {
            *sum = std::array::from_fn(|c| sum[c] + pixel[c]);
        }
    }
    for pixel in &mut sum.pixels {
        *pixel = pixel.map(|number| number.min(1.0));
    }
    sum.layers.retain(|layer| layer.kind == LayerKind::Samples);
    Ok(sum)
}
