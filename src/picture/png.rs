//! PNG (ISO/IEC 15948): straight sRGB numbers of 8 or 16 bits, said so by an sRGB chunk.

use super::Picture;
use super::compare::{Image, Numbers};
use super::read::{MAX_PICTURE_BYTES, PictureProblem};
use super::write::{BitDepth, OutputProblem};
use png::{ColorType, Transformations};

/// The bytes of a PNG file of `picture`, layers left out.
pub(super) fn encode(picture: &Picture, depth: BitDepth) -> Result<Vec<u8>, OutputProblem> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let data: Vec<u8> = match depth {
        BitDepth::Eight => {
            encoder.set_depth(png::BitDepth::Eight);
            let codes = picture.codes(u8::MAX.into());
            codes
                .as_flattened()
                .iter()
                .map(|&code| code as u8)
                .collect()
        }
        BitDepth::Sixteen => {
            encoder.set_depth(png::BitDepth::Sixteen);
            let codes = picture.codes(u16::MAX);
            let codes = codes.as_flattened().iter();
            codes.flat_map(|code| code.to_be_bytes()).collect()
        }
    };
    let refused = |cause: png::EncodingError| OutputProblem::Encode(cause.to_string());
    let mut writer = encoder.write_header().map_err(refused)?;
    writer.write_image_data(&data).map_err(refused)?;
    writer.finish().map_err(refused)?;
    Ok(bytes)
}

/// The pixels of a PNG file of any kind.
pub(super) fn decode(bytes: &[u8]) -> Result<Image, PictureProblem> {
    let broken = |cause: png::DecodingError| PictureProblem::broken("PNG", cause);
    let limits = png::Limits {
        bytes: MAX_PICTURE_BYTES as usize,
    };
    let mut decoder = png::Decoder::new_with_limits(std::io::Cursor::new(bytes), limits);
    // Palettes and fewer than 8 bits become 8 bits.
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(broken)?;
    let size = reader.output_buffer_size();
    let (width, height) = reader.info().size();
    PictureProblem::check_size("PNG", width.into(), height.into())?;
    let raw_bytes = reader.info().raw_bytes() as u64;
    PictureProblem::check_expansion("PNG", raw_bytes, bytes.len())?;
    let Some(size) = size.filter(|&size| size as u64 <= MAX_PICTURE_BYTES) else {
        return Err(PictureProblem::too_large(
            "PNG",
            width.into(),
            height.into(),
        ));
    };
    let mut data = vec![0; size];
    let frame = reader.next_frame(&mut data).map_err(broken)?;
    let numbers: Vec<f32> = match frame.bit_depth {
        png::BitDepth::Sixteen => {
            let codes = data.as_chunks::<2>().0.iter();
            codes
                .map(|&code| f32::from(u16::from_be_bytes(code)) / 65_535.0)
                .collect()
        }
        _ => data.iter().map(|&code| f32::from(code) / 255.0).collect(),
    };
    let pixel = |p: &[f32]| match *p {
        [grey] => [grey, grey, grey, 1.0],
        [grey, alpha] => [grey, grey, grey, alpha],
        [r, g, b] => [r, g, b, 1.0],
        _ => [p[0], p[1], p[2], p[3]],
    };
    let pixels = numbers.chunks_exact(frame.color_type.samples()).map(pixel);
    Ok(Image {
        width,
        height,
        pixels: pixels.collect(),
        numbers: Numbers::StraightSrgb,
    })
}
