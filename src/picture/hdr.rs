//! Radiance HDR (Ward, "Real Pixels", Graphics Gems II, 1991): red, green and blue with one exponent.

use super::compare::{Image, Numbers};
use super::read::PictureProblem;
use image::codecs::hdr::HdrDecoder;
use image::{ImageDecoder, ImageError};
use std::io::Cursor;

/// What such a file begins with.
pub(super) const MAGIC: &[u8] = b"#?";

/// The pixels of a file, linear light: its numbers over its exposure.
pub(super) fn decode(bytes: &[u8]) -> Result<Image, PictureProblem> {
    let broken = |cause: ImageError| PictureProblem::broken("HDR", cause);
    let decoder = HdrDecoder::new(Cursor::new(bytes)).map_err(broken)?;
    let (width, height) = decoder.dimensions();
    PictureProblem::check_size("HDR", width.into(), height.into())?;
    // Of each channel and row a run of 127 pixels takes two bytes.
    let raw_bytes = 4 * u64::from(width) * u64::from(height);
    PictureProblem::check_expansion("HDR", raw_bytes, bytes.len())?;
    // What the file's numbers have been multiplied by, all its lines together.
    let exposure = decoder.metadata().exposure.unwrap_or(1.0);
    if !(exposure.is_normal() && exposure > 0.0) {
        let cause = format!("wanted an EXPOSURE over 0, found {exposure}");
        return Err(PictureProblem::broken("HDR", cause));
    }
    let mut numbers = vec![0.0_f32; 3 * width as usize * height as usize];
    decoder
        .read_image(bytemuck::cast_slice_mut(&mut numbers))
        .map_err(broken)?;
    let pixels = numbers.as_chunks::<3>().0.iter();
    Ok(Image {
        width,
        height,
        pixels: pixels
            .map(|rgb| rgb.map(|c| c / exposure))
            .map(|[r, g, b]| [r, g, b, 1.0])
            .collect(),
        numbers: Numbers::Premultiplied,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One grey pixel of 1 behind such lines.
    fn of(lines: &str) -> Result<Image, PictureProblem> {
        let head = format!("#?RADIANCE\n{lines}FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n");
        decode(&[head.as_bytes(), &[128, 128, 128, 129]].concat())
    }

    #[test]
    fn numbers_are_divided_by_all_exposures() {
        for (lines, wanted) in [
            ("", 1.0),
            ("EXPOSURE=2\n", 0.5),
            ("EXPOSURE=2\nEXPOSURE=4\n", 0.125),
        ] {
            let found = of(lines).expect("a picture").pixels[0];
            assert_eq!(found, [wanted, wanted, wanted, 1.0], "{lines}");
        }
        for lines in ["EXPOSURE=0\n", "EXPOSURE=-1\n", "EXPOSURE=nan\n"] {
            assert!(of(lines).is_err(), "{lines}");
        }
    }
}
