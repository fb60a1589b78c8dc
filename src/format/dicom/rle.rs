//! RLE Lossless, by DICOM PS3.5 annex G: planes of bytes, the most significant first, each packed as runs.

use super::layout::Layout;
use super::pixels::damaged;
use crate::format::convert::to_u64;
use crate::volume::Problem;

/// The word of errors.
const RLE: &str = "RLE Lossless";
/// The number of planes and where each begins.
const HEADER_BYTES: usize = 64;
/// Two bytes make at most 128.
const MOST_EXPANSION: u64 = 64;

/// Samples of the layout, little-endian, side by side.
pub(super) fn decode(encoded: &[u8], layout: &Layout) -> Result<Vec<u8>, Problem> {
    let wanted_bytes = layout.frame_bytes();
    let encoded_bytes = to_u64(encoded.len());
    if wanted_bytes > encoded_bytes.saturating_mul(MOST_EXPANSION) {
        return Err(Problem::TooFewEncoded {
            format: super::DICOM,
            encoding: RLE,
            wanted_bytes,
            encoded_bytes,
        });
    }
    let too_short = || damaged(RLE, "the frame is shorter than its header");
    let header = encoded.get(..HEADER_BYTES).ok_or_else(too_short)?;
    let numbers = header
        .as_chunks::<4>()
        .0
        .iter()
        .map(|bytes| u32::from_le_bytes(*bytes));
    let numbers: Vec<usize> = numbers
        .map(|n| usize::try_from(n).unwrap_or(usize::MAX))
        .collect();
    let (count, starts) = numbers.split_first().ok_or_else(too_short)?;
    let sample_bytes = layout.stored().bytes();
    let samples = usize::try_from(layout.color.samples()).unwrap_or(usize::MAX);
    let planes = samples.saturating_mul(sample_bytes);
    if *count != planes || layout.bits_allocated == 1 {
        let cause = format!("{count} segments, wanted {planes}");
        return Err(damaged(RLE, cause));
    }
    let pixels = usize::try_from(layout.pixels()).unwrap_or(usize::MAX);
    let mut frame = vec![0; pixels.saturating_mul(planes)];
    for (plane, start) in starts.iter().take(planes).enumerate() {
        let end = starts
            .get(plane.saturating_add(1))
            .filter(|_| plane.saturating_add(1) < planes);
        let segment = encoded.get(*start..end.copied().unwrap_or(encoded.len()));
        let segment = segment
            .ok_or_else(|| damaged(RLE, format!("segment {plane} lies outside the frame")))?;
        // The most significant byte comes first in the file and last in a little-endian number.
        let sample = plane.checked_div(sample_bytes).unwrap_or(0);
        let byte = sample_bytes
            .saturating_sub(1)
            .saturating_sub(plane.checked_rem(sample_bytes).unwrap_or(0));
        let first = sample.saturating_mul(sample_bytes).saturating_add(byte);
        let places = frame.iter_mut().skip(first).step_by(planes.max(1));
        unpack(segment, places).map_err(|missing| {
            damaged(RLE, format!("segment {plane} ends {missing} bytes early"))
        })?;
    }
    Ok(frame)
}

/// A byte `n` below 128 is followed by `n + 1` bytes as they are, above 128 by one byte that comes `257 - n` times.
/// Gives the number of places that stayed empty as an error.
fn unpack<'a>(
    packed: &[u8],
    mut places: impl ExactSizeIterator<Item = &'a mut u8>,
) -> Result<(), usize> {
    let mut packed = packed.iter();
    while places.len() > 0 {
        let Some(&control) = packed.next() else {
            return Err(places.len());
        };
        let n = usize::from(control);
        match control {
            0..=127 => {
                for _ in 0..=n.min(places.len().saturating_sub(1)) {
                    let Some(byte) = packed.next() else {
                        return Err(places.len());
                    };
                    if let Some(place) = places.next() {
                        *place = *byte;
                    }
                }
            }
            128 => {}
            129..=255 => {
                let Some(byte) = packed.next() else {
                    return Err(places.len());
                };
                let run = 257_usize.saturating_sub(n);
                places.by_ref().take(run).for_each(|place| *place = *byte);
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_and_bytes_as_they_are_come_out_in_their_places() {
        // The example of Apple's technical note 1023, from which the scheme comes.
        let packed = [
            0xfe, 0xaa, 0x02, 0x80, 0x00, 0x2a, 0xfd, 0xaa, 0x03, 0x80, 0x00, 0x2a, 0x22, 0xf7,
            0xaa,
        ];
        let wanted = [
            0xaa, 0xaa, 0xaa, 0x80, 0x00, 0x2a, 0xaa, 0xaa, 0xaa, 0xaa, 0x80, 0x00, 0x2a, 0x22,
            0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa,
        ];
        let mut out = [0; 24];
        assert_eq!(unpack(&packed, out.iter_mut()), Ok(()));
        assert_eq!(out, wanted);
        for cut in 0..packed.len() {
            assert!(unpack(&packed[..cut], out.iter_mut()).is_err(), "{cut}");
        }
        assert_eq!(
            unpack(&[0x80, 0x80, 0x00, 0x07], out[..1].iter_mut()),
            Ok(())
        );
        assert_eq!(out[0], 7);
    }
}
