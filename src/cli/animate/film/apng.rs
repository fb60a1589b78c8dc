//! APNG (PNG, third edition, 2025: `acTL`, `fcTL`, `fdAT`): every frame in full, played for ever.

use super::Reel;
use crate::cli::Error;
use std::io::{self, Write};

/// The whole film. Frames of 8 and of 16 bits are told apart by their size.
pub fn write(reel: &Reel, out: &mut impl Write) -> Result<(), Error> {
    let refused = |cause: png::EncodingError| reel.wrote(io::Error::from(cause));
    let [width, height] = reel.extent_pixels;
    let first = reel.codes(0)?;
    let is_deep = first.len() as u64 > 4 * u64::from(width) * u64::from(height);
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(if is_deep {
        png::BitDepth::Sixteen
    } else {
        png::BitDepth::Eight
    });
    // As of frames in files of their own.
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_animated(reel.count, 0).map_err(refused)?;
    encoder
        .set_frame_delay(reel.rate.seconds, reel.rate.frames)
        .map_err(refused)?;
    // Else a half-transparent frame would be laid over the one before.
    encoder
        .set_blend_op(png::BlendOp::Source)
        .map_err(refused)?;
    let mut writer = encoder.write_header().map_err(refused)?;
    drop(first);
    reel.in_order(
        |number| reel.codes(number),
        |codes| writer.write_image_data(&codes).map_err(refused),
    )?;
    writer.finish().map_err(refused)
}
