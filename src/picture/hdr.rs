//! Radiance HDR (Ward, "Real Pixels", Graphics Gems II, 1991): red, green and blue with one exponent.

use super::compare::{Image, Numbers};
use super::read::PictureProblem;
use image::codecs::hdr::HdrDecoder;
use image::{ImageDecoder, ImageError};
use std::io::Cursor;

/// What such a file begins with.
pub(super) const MAGIC: &[u8] = b"#?";

/// The pixels of a file, linear light.
pub(super) fn decode(bytes: &[u8]) -> Result<Image, PictureProblem> {
    let broken = |cause: ImageError| PictureProblem::broken("HDR", cause);
    let decoder = HdrDecoder::new(Cursor::new(bytes)).map_err(broken)?;
    let (width, height) = decoder.dimensions();
    PictureProblem::check_size("HDR", width.into(), height.into())?;
    // Of each channel and row a run of 127 pixels takes two bytes.
    let raw_bytes = 4 * u64::from(width) * u64::from(height);
    PictureProblem::check_expansion("HDR", raw_bytes, bytes.len())?;
    let mut numbers = vec![0.0_f32; 3 * width as usize * height as usize];
    decoder
        .read_image(bytemuck::cast_slice_mut(&mut numbers))
        .map_err(broken)?;
    let pixels = numbers.as_chunks::<3>().0.iter();
    Ok(Image {
        width,
        height,
        pixels: pixels.map(|&[r, g, b]| [r, g, b, 1.0]).collect(),
        numbers: Numbers::Premultiplied,
    })
}
