//! JPEG 2000, lossless and lossy, by DICOM PS3.5 section 8.2.4 and ISO/IEC 15444-1 annex A.5.1 (SIZ).
//!
//! The decoder adds half the range to every sample, as is right for unsigned ones; where the code stream says
//! that they are signed, it is taken off again.

use super::fence::fenced;
use super::layout::Layout;
use super::pixels::{damaged, same_size};
use crate::format::convert::to_u64;
use crate::volume::Problem;
use hayro_jpeg2000::{DecodeSettings, DecoderContext, Image};

/// The word of errors.
const J2K: &str = "JPEG 2000";
/// Start of the code stream and of its SIZ segment.
const START: [u8; 4] = [0xff, 0x4f, 0xff, 0x51];
/// Each tile begins with a SOT and a SOD marker.
const LEAST_TILE_BYTES: u64 = 14;

/// Samples of the layout, little-endian, side by side.
pub(super) fn decode(encoded: &[u8], layout: &Layout) -> Result<Vec<u8>, Problem> {
    // Boxes around the code stream are to be passed over, PS3.5 section 8.2.4.
    let start = encoded.windows(4).position(|bytes| bytes == START);
    let encoded = encoded.get(start.unwrap_or(0)..).unwrap_or(encoded);
    let size =
        Size::of(encoded).ok_or_else(|| damaged(J2K, "no code stream with a SIZ segment"))?;
    same_size(
        J2K,
        layout,
        [size.width, size.height],
        size.components.len(),
    )?;
    if size.tiles.saturating_mul(LEAST_TILE_BYTES) > to_u64(encoded.len()) {
        let cause = format!("{} tiles in {} bytes", size.tiles, encoded.len());
        return Err(damaged(J2K, cause));
    }
    let precise = size
        .components
        .iter()
        .all(|part| part.bits <= layout.bits_allocated && part.bits <= 24);
    if !precise {
        let cause = format!(
            "more bits a sample than the {} of the file or 24",
            layout.bits_allocated
        );
        return Err(damaged(J2K, cause));
    }
    fenced(J2K, || decode_unfenced(encoded, layout, &size))
}

fn decode_unfenced(encoded: &[u8], layout: &Layout, size: &Size) -> Result<Vec<u8>, Problem> {
    let settings = DecodeSettings {
        resolve_palette_indices: false,
        strict: true,
        target_resolution: None,
    };
    let image = Image::new(encoded, &settings).map_err(|cause| damaged(J2K, cause))?;
    same_size(
        J2K,
        layout,
        [image.width().into(), image.height().into()],
        size.components.len(),
    )?;
    let mut context = DecoderContext::default();
    let decoded = image
        .decode(&mut context)
        .map_err(|cause| damaged(J2K, cause))?;
    let planes = decoded.components();
    let pixels = usize::try_from(layout.pixels()).unwrap_or(usize::MAX);
    if planes.len() != size.components.len()
        || planes.iter().any(|plane| plane.samples().len() != pixels)
    {
        return Err(damaged(
            J2K,
            "the decoder gives other samples than the header says",
        ));
    }
    let sample_bytes = layout.stored().bytes();
    let stride = planes.len().saturating_mul(sample_bytes);
    let mut frame = vec![0; pixels.saturating_mul(stride)];
    for (index, (plane, component)) in planes.iter().zip(&size.components).enumerate() {
        let first = index.saturating_mul(sample_bytes);
        let numbers = frame.chunks_exact_mut(stride.max(1)).zip(plane.samples());
        for (pixel, sample) in numbers {
            let bytes = component.number(*sample).to_le_bytes();
            let place = pixel.iter_mut().skip(first);
            place
                .zip(bytes)
                .take(sample_bytes)
                .for_each(|(place, byte)| *place = byte);
        }
    }
    Ok(frame)
}

/// What the SIZ segment says.
struct Size {
    width: u64,
    height: u64,
    tiles: u64,
    components: Vec<Component>,
}

#[derive(Clone, Copy)]
struct Component {
    bits: u16,
    is_signed: bool,
}

impl Component {
    /// What the encoder was given; lossy samples that left the range go back to its ends.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "clamped to at most 24 bits"
    )]
    fn number(self, sample: f32) -> i32 {
        let range = f64::from(self.bits).exp2();
        let offset = if self.is_signed { range / 2.0 } else { 0.0 };
        (f64::from(sample).round().clamp(0.0, range - 1.0) - offset) as i32
    }
}

impl Size {
    fn of(encoded: &[u8]) -> Option<Self> {
        // Length and capabilities come before the eight numbers.
        let body = encoded.strip_prefix(&START)?.get(4..)?;
        let numbers = body.get(..32)?.as_chunks::<4>().0;
        let numbers: Vec<u64> = numbers
            .iter()
            .map(|bytes| u32::from_be_bytes(*bytes).into())
            .collect();
        let [
            right,
            bottom,
            left,
            top,
            tile_width,
            tile_height,
            tile_left,
            tile_top,
        ] = numbers.try_into().ok()?;
        let tiles = |end: u64, tile_start: u64, tile: u64| {
            (tile > 0).then(|| end.saturating_sub(tile_start).div_ceil(tile.max(1)))
        };
        let across = tiles(right, tile_left, tile_width)?;
        let down = tiles(bottom, tile_top, tile_height)?;
        let count = u16::from_be_bytes(*body.get(32..34)?.first_chunk()?);
        let parts = body
            .get(34..)?
            .as_chunks::<3>()
            .0
            .get(..usize::from(count))?;
        let components = parts.iter().map(|[bits, dx, dy]| {
            (*dx == 1 && *dy == 1).then(|| Component {
                bits: u16::from(bits & 0x7f).saturating_add(1),
                is_signed: bits & 0x80 != 0,
            })
        });
        Some(Self {
            width: right.checked_sub(left)?,
            height: bottom.checked_sub(top)?,
            tiles: across.saturating_mul(down),
            components: components.collect::<Option<_>>()?,
        })
    }
}
