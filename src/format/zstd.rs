//! Zstandard, RFC 8878, in memory: what comes out is bounded, and memory follows what came out.

use super::convert::to_u64;
use crate::fence::fenced;
use ruzstd::decoding::StreamingDecoder;
use std::io::Read;

/// One frame, at most `most` bytes decoded; its checksum is compared where it has one. An error says what is wrong.
pub(crate) fn decode(bytes: &[u8], most: usize) -> Result<Vec<u8>, String> {
    // A window is reserved as a frame's header asks for it: no more than the chunk may have, and no more than so
    // many bytes can stand for (a block of 128 kB that repeats one byte takes four).
    const LEAST_WINDOW_BYTES: u64 = 8 << 20;
    let window = to_u64(most)
        .saturating_mul(2)
        .min(most_bytes(to_u64(bytes.len())))
        .max(LEAST_WINDOW_BYTES);
    let decoded = fenced(|| {
        let mut source = bytes;
        let stream = StreamingDecoder::new_with_max_window_size(&mut source, window);
        let mut stream = stream.map_err(|error| error.to_string())?;
        let out = collect(&mut stream, most)?;
        let frame = stream.into_frame_decoder();
        let (promised, found) = (
            frame.get_checksum_from_data(),
            frame.get_calculated_checksum(),
        );
        if promised.is_some() && promised != found {
            return Err("the checksum is not that of the bytes".to_owned());
        }
        match source.is_empty() {
            true => Ok(out),
            false => Err(format!("{} bytes follow its end", source.len())),
        }
    });
    decoded.unwrap_or_else(Err)
}

/// The most bytes that `encoded_bytes` can hold.
pub(crate) fn most_bytes(encoded_bytes: u64) -> u64 {
    encoded_bytes.saturating_mul(1 << 15)
}

/// All that `input` gives, growing with what comes; a byte more than `most` is an error.
pub(crate) fn collect(mut input: impl Read, most: usize) -> Result<Vec<u8>, String> {
    const FIRST_BYTES: usize = 1 << 16;
    let mut out = Vec::new();
    while out.len() < most {
        let room = most
            .saturating_sub(out.len())
            .min(out.len().max(FIRST_BYTES));
        out.try_reserve_exact(room)
            .map_err(|_| format!("no memory for {most} bytes"))?;
        let took = input.by_ref().take(to_u64(room)).read_to_end(&mut out);
        if took.map_err(|error| error.to_string())? == 0 {
            break;
        }
    }
    // Asked for even where all came: what ends a stream, its checksum, is looked at only then.
    let mut one_more = [0];
    match input
        .read(&mut one_more)
        .map_err(|error| error.to_string())?
    {
        0 => Ok(out),
        _ => Err(format!("more than {most} bytes come out")),
    }
}
