//! PNG (ISO/IEC 15948): straight sRGB numbers of 8 or 16 bits.

use super::Picture;
use super::compare::{Image, Numbers};
use super::read::{MAX_PICTURE_BYTES, PictureProblem};
use super::write::{BitDepth, OutputProblem};
use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageDecoder, ImageError, Limits};
use png::EncodingError;
use std::io::Cursor;

/// The bytes of a PNG file of `picture`, layers left out. The compression is the fast one: one that tries harder makes
/// files a tenth smaller and takes longer than drawing does.
pub(super) fn encode(picture: &Picture, depth: BitDepth) -> Result<Vec<u8>, OutputProblem> {
    let (data, depth): (Vec<u8>, _) = match depth {
        BitDepth::Eight => {
            let codes = picture.codes_as(u8::MAX.into(), |code| code as u8);
            (codes.into_flattened(), png::BitDepth::Eight)
        }
        BitDepth::Sixteen => {
            let codes = picture.codes_as(u16::MAX, u16::to_be_bytes);
            let bytes = codes.into_flattened().into_flattened();
            (bytes, png::BitDepth::Sixteen)
        }
    };
    let mut bytes = Vec::new();
    let refused = |cause: EncodingError| OutputProblem::Encode(cause.to_string());
    let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    let mut writer = encoder.write_header().map_err(refused)?;
    writer.write_image_data(&data).map_err(refused)?;
    writer.finish().map_err(refused)?;
    Ok(bytes)
}

/// The pixels of a PNG file of any kind.
pub(super) fn decode(bytes: &[u8]) -> Result<Image, PictureProblem> {
    let broken = |cause: ImageError| PictureProblem::broken("PNG", cause);
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_PICTURE_BYTES);
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(broken)?;
    let (width, height) = decoder.dimensions();
    PictureProblem::check_size("PNG", width.into(), height.into())?;
    PictureProblem::check_expansion("PNG", decoder.total_bytes(), bytes.len())?;
    let is_deep = decoder.color_type().bytes_per_pixel() > decoder.color_type().channel_count();
    let found = DynamicImage::from_decoder(decoder).map_err(broken)?;
    // Grey, palettes and fewer than 8 bits become red, green, blue and alpha here.
    let numbers: Vec<f32> = if is_deep {
        let codes = found.into_rgba16().into_raw();
        codes
            .iter()
            .map(|&code| f32::from(code) / 65_535.0)
            .collect()
    } else {
        let codes = found.into_rgba8().into_raw();
        codes.iter().map(|&code| f32::from(code) / 255.0).collect()
    };
    Ok(Image {
        width,
        height,
        pixels: numbers.as_chunks::<4>().0.to_vec(),
        numbers: Numbers::StraightSrgb,
    })
}
