//! Y4M (YUV4MPEG2, as mjpegtools and ffmpeg write it): a line of words, then each frame's planes as they are.
//!
//! 4:4:4, 8 bits, limited range, by ITU-R BT.709-6 (2015), 3.2 to 3.5, of the sRGB numbers:
//!
//! ```text
//! Y  = 0.2126 R + 0.7152 G + 0.0722 B        code = 16 + 219 Y
//! Cb = (B - Y) / 1.8556                      code = 128 + 224 Cb
//! Cr = (R - Y) / 1.5748                      code = 128 + 224 Cr
//! ```
//!
//! The header says the range in `XCOLORRANGE`, which ffmpeg reads, and the matrix in `XCOLORMATRIX`, a comment.

use super::Reel;
use crate::cli::{Error, animate::rate::Rate};
use std::io::Write;

/// The whole film.
pub fn write(reel: &Reel, out: &mut impl Write) -> Result<(), Error> {
    let wrote = |cause| reel.wrote(cause);
    out.write_all(head(reel.extent_pixels, reel.rate).as_bytes())
        .map_err(wrote)?;
    reel.in_order(
        |number| Ok(frame(&reel.codes(number)?)),
        |frame| out.write_all(&frame).map_err(wrote),
    )
}

/// The line that a stream begins with.
pub fn head([width, height]: [u32; 2], rate: Rate) -> String {
    let Rate { frames, seconds } = rate;
    format!(
        "YUV4MPEG2 W{width} H{height} F{frames}:{seconds} Ip A1:1 C444 XCOLORRANGE=LIMITED XCOLORMATRIX=BT709\n"
    )
}

/// One frame of red, green, blue and alpha a pixel; alpha is left out.
pub fn frame(codes: &[u8]) -> Vec<u8> {
    let pixels = codes.as_chunks::<4>().0;
    let planes = pixels
        .iter()
        .map(|&[r, g, b, _]| [r, g, b].map(|code| f64::from(code) / 255.0));
    let luma = |[r, g, b]: [f64; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let code = |x: f64| x.round() as u8;
    let mut bytes = b"FRAME\n".to_vec();
    bytes.extend(planes.clone().map(|rgb| code(16.0 + 219.0 * luma(rgb))));
    bytes.extend(
        planes
            .clone()
            .map(|rgb| code(128.0 + 224.0 * (rgb[2] - luma(rgb)) / 1.8556)),
    );
    bytes.extend(planes.map(|rgb| code(128.0 + 224.0 * (rgb[0] - luma(rgb)) / 1.5748)));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_colours_of_the_recommendation_have_its_codes() {
        // BT.709 colour bars at full level, 8 bits: white, black, red, green, blue.
        let pixels = [
            [255, 255, 255, 255],
            [0, 0, 0, 0],
            [255, 0, 0, 255],
            [0, 255, 0, 255],
            [0, 0, 255, 255],
        ];
        let bytes = frame(pixels.as_flattened());
        let (head, planes) = bytes.split_at(6);
        assert_eq!(head, b"FRAME\n");
        assert_eq!(planes[..5], [235, 16, 63, 173, 32]);
        assert_eq!(planes[5..10], [128, 128, 102, 42, 240]);
        assert_eq!(planes[10..], [128, 128, 240, 26, 118]);
    }

    #[test]
    fn the_head_says_size_rate_and_range() {
        let rate = "29.97".parse().expect("a rate");
        assert_eq!(
            head([7, 5], rate),
            "YUV4MPEG2 W7 H5 F2997:100 Ip A1:1 C444 XCOLORRANGE=LIMITED XCOLORMATRIX=BT709\n"
        );
    }
}
