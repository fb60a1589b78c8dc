//! JPEG: baseline, extended of 8 bits, and lossless, by DICOM PS3.5 sections 8.2.1 and 10.4 to 10.7.

use super::DICOM;
use super::fence::fenced;
use super::layout::{Color, Layout};
use super::pixels::{damaged, same_size};
use crate::format::convert::to_u64;
use crate::format::problem::unsupported;
use crate::volume::Problem;
use jpeg_decoder::{ColorTransform, Decoder, Error, PixelFormat};

/// True for a process that gives the samples back as they were, chroma included.
pub(super) fn is_lossless(name: &str) -> bool {
    name.starts_with("JPEG Lossless")
}

/// Samples of the layout, little-endian, side by side.
pub(super) fn decode(
    encoded: &[u8],
    layout: &Layout,
    name: &'static str,
) -> Result<Vec<u8>, Problem> {
    fenced(name, || decode_unfenced(encoded, layout, name))
}

fn decode_unfenced(
    encoded: &[u8],
    layout: &Layout,
    name: &'static str,
) -> Result<Vec<u8>, Problem> {
    let wrong = |error: Error| match error {
        Error::Unsupported(feature) => {
            unsupported(DICOM, format!("{name} with the feature {feature:?}"))
        }
        other => damaged(name, other),
    };
    let mut decoder = Decoder::new(encoded);
    decoder.read_info().map_err(wrong)?;
    let info = decoder
        .info()
        .ok_or_else(|| damaged(name, "no frame header"))?;
    let samples = match info.pixel_format {
        PixelFormat::L8 | PixelFormat::L16 => 1,
        PixelFormat::RGB24 => 3,
        PixelFormat::CMYK32 => 4,
    };
    same_size(
        name,
        layout,
        [info.width.into(), info.height.into()],
        samples,
    )?;
    let wanted_bytes = usize::try_from(layout.frame_bytes()).unwrap_or(usize::MAX);
    decoder.set_max_decoding_buffer_size(wanted_bytes);
    if samples == 3 {
        decoder.set_color_transform(match (adobe_transform(encoded), layout.color) {
            (Some(0), _) | (None, Color::Rgb) => ColorTransform::RGB,
            _ => ColorTransform::YCbCr,
        });
    }
    let decoded = decoder.decode().map_err(wrong)?;
    match (info.pixel_format, layout.bits_allocated) {
        (PixelFormat::L8 | PixelFormat::RGB24, 8) => Ok(decoded),
        (PixelFormat::L8, 16) => Ok(decoded.iter().flat_map(|byte| [*byte, 0]).collect()),
        (PixelFormat::L16, 16) => {
            let numbers = decoded.as_chunks::<2>().0.iter();
            Ok(numbers
                .flat_map(|bytes| u16::from_ne_bytes(*bytes).to_le_bytes())
                .collect())
        }
        (format, bits) => {
            let cause = format!(
                "{format:?} where the file says {bits} bits, {} bytes",
                to_u64(decoded.len())
            );
            Err(damaged(name, cause))
        }
    }
}

/// What the segment of Adobe says: 0 for red, green and blue as they are, 1 for luma and chroma.
fn adobe_transform(encoded: &[u8]) -> Option<u8> {
    let mut rest = encoded.get(2..)?;
    loop {
        let [0xff, marker, high, low] = *rest.first_chunk::<4>()? else {
            return None;
        };
        let length = usize::from(u16::from_be_bytes([high, low]));
        let body = rest.get(4..length.checked_add(2)?)?;
        match marker {
            0xee if body.starts_with(b"Adobe") => return body.get(11).copied(),
            // The begin of the scan: no more segments.
            0xda => return None,
            _ => rest = rest.get(length.checked_add(2)?..)?,
        }
    }
}
