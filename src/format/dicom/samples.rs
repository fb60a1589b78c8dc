//! Samples as files have them to samples as we want them: whole bytes, little-endian, colours side by side.

use super::layout::Layout;

/// One byte for each bit, the lowest bit first, by DICOM PS3.5 section 8.1.1.
pub(super) fn bytes_of_bits(bytes: &[u8], shift: u64, pixels: u64) -> Vec<u8> {
    let shift = usize::try_from(shift).unwrap_or(0);
    let pixels = usize::try_from(pixels).unwrap_or(usize::MAX);
    let bits = bytes
        .iter()
        .flat_map(|byte| (0..8).map(move |bit| byte >> bit & 1));
    bits.skip(shift).take(pixels).collect()
}

/// Turns the bytes of each number of `N` bytes round.
pub(super) fn swap<const N: usize>(bytes: &mut [u8]) {
    for number in bytes.as_chunks_mut::<N>().0 {
        number.reverse();
    }
}

/// Three planes to pixels of three samples.
pub(super) fn interleaved(planes: &[u8], sample_bytes: usize) -> Vec<u8> {
    let plane = (planes.len() / 3).max(1);
    let mut colors = planes.chunks_exact(plane);
    let (Some(reds), Some(greens), Some(blues)) = (colors.next(), colors.next(), colors.next())
    else {
        return Vec::new();
    };
    let size = sample_bytes.max(1);
    let (reds, greens) = (reds.chunks_exact(size), greens.chunks_exact(size));
    let pixels = reds.zip(greens).zip(blues.chunks_exact(size));
    let samples = pixels.flat_map(|((r, g), b)| [r, g, b]);
    samples.flatten().copied().collect()
}

/// Luma of two pixels and the chroma they share to two colours, by DICOM PS3.3 section C.7.6.3.1.2.
pub(super) fn rgb_from_422(bytes: &[u8]) -> Vec<u8> {
    let pairs = bytes.as_chunks::<4>().0.iter();
    pairs
        .flat_map(|&[y1, y2, cb, cr]| [rgb([y1, cb, cr]), rgb([y2, cb, cr])])
        .flatten()
        .collect()
}

/// Luma and chroma of each pixel to its colour.
pub(super) fn rgb_from_ybr(bytes: &mut [u8]) {
    for pixel in bytes.as_chunks_mut::<3>().0 {
        *pixel = rgb(*pixel);
    }
}

/// The inverse of Y = 0.299 R + 0.587 G + 0.114 B, Cb = (B - Y) / 1.772 + 128, Cr = (R - Y) / 1.402 + 128.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 0 to 255"
)]
fn rgb([y, cb, cr]: [u8; 3]) -> [u8; 3] {
    let (y, cb, cr) = (f64::from(y), f64::from(cb) - 128.0, f64::from(cr) - 128.0);
    let red = y + 1.402 * cr;
    let blue = y + 1.772 * cb;
    let green = (y - 0.299 * red - 0.114 * blue) / 0.587;
    [red, green, blue].map(|x| x.round().clamp(0.0, 255.0) as u8)
}

/// Moves the stored bits to the bottom and lets them fill the number; what else lay in it is lost.
pub(super) fn clear_unused_bits(bytes: &mut [u8], layout: &Layout) {
    let allocated = u32::from(layout.bits_allocated);
    let stored = u32::from(layout.bits_stored);
    if stored == allocated || layout.is_float || allocated == 1 {
        return;
    }
    let above = allocated.saturating_sub(u32::from(layout.high_bit).saturating_add(1));
    let empty = allocated.saturating_sub(stored);
    // Shifting a signed number to the right repeats its sign.
    macro_rules! clear {
        ($unsigned:ty) => {
            for number in bytes.as_chunks_mut::<{ size_of::<$unsigned>() }>().0 {
                let lifted = <$unsigned>::from_le_bytes(*number)
                    .checked_shl(above)
                    .unwrap_or(0);
                *number = if layout.is_signed {
                    lifted
                        .cast_signed()
                        .checked_shr(empty)
                        .unwrap_or(0)
                        .to_le_bytes()
                } else {
                    lifted.checked_shr(empty).unwrap_or(0).to_le_bytes()
                };
            }
        };
    }
    match allocated {
        8 => clear!(u8),
        16 => clear!(u16),
        _ => clear!(u32),
    }
}
