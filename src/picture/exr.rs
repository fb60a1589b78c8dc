//! OpenEXR: linear premultiplied R, G, B, A in f32, and a channel by the name of each layer.
//!
//! The reader is the `exr` crate's. It trusts sizes in the header, so these are checked first: layout of the
//! header as in "OpenEXR File Layout" (openexr.com).

use super::compare::{Image, Numbers};
use super::read::PictureProblem;
use super::write::OutputProblem;
use super::{LayerKind, Picture};
use ::exr::prelude::*;
use std::io::Cursor;

const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
/// Version 2; long names are allowed, tiles, parts and deep data are not.
const VERSION: u32 = 2;
const LONG_NAMES: u32 = 0x400;

/// The bytes of an EXR file of `picture` and its layers.
pub(super) fn encode(picture: &Picture) -> std::result::Result<Vec<u8>, OutputProblem> {
    let pixels = picture.linear_pixels();
    let channel = |name: &str, numbers: Vec<f32>| AnyChannel::new(name, FlatSamples::F32(numbers));
    let colors = ["R", "G", "B", "A"].into_iter().enumerate();
    let mut channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = colors
        .map(|(c, name)| channel(name, pixels.iter().map(|pixel| pixel[c]).collect()))
        .collect();
    for layer in &picture.layers {
        let (name, numbers) = (layer.kind.name(), layer.kind.numbers());
        if numbers == 1 {
            channels.push(channel(name, layer.values.clone()));
            continue;
        }
        let parts = match layer.kind {
            LayerKind::Annotation => ["R", "G", "B", "A"],
            kind if kind.is_color() => ["R", "G", "B", "A"],
            _ => ["X", "Y", "Z", "W"],
        };
        for (k, axis) in parts.into_iter().enumerate().take(numbers) {
            let along = layer.values.iter().skip(k).step_by(numbers);
            channels.push(channel(&format!("{name}.{axis}"), along.copied().collect()));
        }
    }
    let size = (picture.width as usize, picture.height as usize);
    let layer = ::exr::image::Layer::new(
        size,
        LayerAttributes::default(),
        // Lossless, and read by everything.
        Encoding {
            compression: Compression::ZIP16,
            blocks: Blocks::ScanLines,
            line_order: LineOrder::Increasing,
        },
        AnyChannels::sort(channels),
    );
    let mut bytes = Cursor::new(Vec::new());
    ::exr::image::Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|cause| OutputProblem::Encode(cause.to_string()))?;
    Ok(bytes.into_inner())
}

type Pixels = (Vec2<usize>, Vec<[f32; 4]>);

/// R, G, B and A (1 where there is none) of an EXR file of one part in scan lines.
pub(super) fn decode(bytes: &[u8]) -> std::result::Result<Image, PictureProblem> {
    let (width, height) = checked_size(bytes)?;
    // A channel has two bytes a pixel at least.
    let raw_bytes = 2 * u64::from(width) * u64::from(height);
    PictureProblem::check_expansion("EXR", raw_bytes, bytes.len())?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            // Memory for the size that was checked, whatever the reader makes of the header.
            |size, _| (size, vec![[0.0; 4]; width as usize * height as usize]),
            |(size, pixels): &mut Pixels, at, (r, g, b, a): (f32, f32, f32, f32)| {
                if let Some(pixel) = pixels.get_mut(at.flat_index_for_size(*size)) {
                    *pixel = [r, g, b, a];
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|cause| PictureProblem::broken("EXR", cause))?;
    let (size, pixels) = image.layer_data.channel_data.pixels;
    if size != Vec2(width as usize, height as usize) {
        return Err(PictureProblem::broken("EXR", "the header has two sizes"));
    }
    Ok(Image {
        width,
        height,
        pixels,
        numbers: Numbers::Premultiplied,
    })
}

/// Pixels across and down, once every length in the header lies inside the file.
fn checked_size(bytes: &[u8]) -> std::result::Result<(u32, u32), PictureProblem> {
    let cut = || PictureProblem::broken("EXR", "the header ends early");
    let word = |bytes: &[u8]| bytes.first_chunk().map(|&word| u32::from_le_bytes(word));
    let rest = bytes.strip_prefix(&MAGIC).ok_or_else(cut)?;
    let version = word(rest).ok_or_else(cut)?;
    if version & !LONG_NAMES != VERSION {
        return Err(PictureProblem::Invalid {
            format: "EXR",
            field: "version",
            wanted: "2, one part, scan lines",
            found: format!("{version:#x}"),
        });
    }
    let mut rest = &rest[4..];
    let mut window = None;
    loop {
        let (name, after) = text(rest).ok_or_else(cut)?;
        if name.is_empty() {
            break;
        }
        let (_, after) = text(after).ok_or_else(cut)?;
        let length = word(after).ok_or_else(cut)? as usize;
        let (value, after) = after[4..].split_at_checked(length).ok_or_else(cut)?;
        if name == b"dataWindow" {
            window = value.first_chunk::<16>().copied();
        }
        rest = after;
    }
    let window = window.ok_or_else(|| PictureProblem::broken("EXR", "it has no dataWindow"))?;
    let corner = |k: usize| {
        let number: [u8; 4] = std::array::from_fn(|i| window[4 * k + i]);
        i64::from(i32::from_le_bytes(number))
    };
    let side = |min: i64, max: i64| u64::try_from(max - min + 1).unwrap_or(0);
    PictureProblem::check_size(
        "EXR",
        side(corner(0), corner(2)),
        side(corner(1), corner(3)),
    )
}

/// The bytes before the first zero, and those behind it.
fn text(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let end = bytes.iter().take(256).position(|&byte| byte == 0)?;
    Some((&bytes[..end], &bytes[end + 1..]))
}
