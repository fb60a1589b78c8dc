//! BloscLZ, undone: runs of new bytes, and matches with what came out before.
//!
//! The format is that of FastLZ level 2 (github.com/Blosc/c-blosc, blosc/blosclz.c), here in our words:
//!
//! ```text
//! control c below 32: c + 1 bytes follow as they are        (of the first control only the low five bits count)
//! else: length (c >> 5) + 2; if c >> 5 is 7, bytes that add to it follow, up to and with the first below 255
//!       then a byte b: distance ((c & 31) << 8) + b + 1
//!       but where both parts are full: two more bytes, the high one first, distance 8192 + those
//! ```

use super::codec::Damage;

/// The distance that stands for "two more bytes say".
const FAR: usize = 8191;

/// Exactly `wanted` bytes out of `encoded`.
pub(super) fn decode(encoded: &[u8], wanted: usize) -> Result<Vec<u8>, Damage> {
    let mut input = encoded;
    let mut out: Vec<u8> = Vec::new();
    let mut is_first = true;
    while !input.is_empty() {
        let mut control = next(&mut input)?;
        if is_first {
            control &= 31;
            is_first = false;
        }
        if control < 32 {
            let new = take(&mut input, usize::from(control).saturating_add(1))?;
            make_room(&mut out, new.len(), wanted)?;
            out.extend_from_slice(new);
            continue;
        }
        let mut length = usize::from(control >> 5).saturating_add(2);
        if control >> 5 == 7 {
            loop {
                let more = next(&mut input)?;
                length = length.saturating_add(more.into());
                if more != 255 {
                    break;
                }
            }
        }
        let low = next(&mut input)?;
        let mut distance = (usize::from(control & 31) << 8) | usize::from(low);
        if distance == FAR {
            let far = u16::from_be_bytes([next(&mut input)?, next(&mut input)?]);
            distance = FAR.saturating_add(far.into());
        }
        repeat(&mut out, distance.saturating_add(1), length, wanted)?;
    }
    match out.len() == wanted {
        true => Ok(out),
        false => Err(format!(
            "{wanted} bytes were wanted, {} came out",
            out.len()
        )),
    }
}

/// Appends `length` bytes that begin `distance` before the end; they may overlap what they make.
fn repeat(out: &mut Vec<u8>, distance: usize, length: usize, wanted: usize) -> Result<(), Damage> {
    let start = out.len().checked_sub(distance);
    let start = start.ok_or_else(|| "a match begins before the first byte".to_owned())?;
    make_room(out, length, wanted)?;
    let mut left = length;
    while left > 0 {
        // What is there repeats: each turn copies all of it, so that runs double.
        let end = start.saturating_add(left).min(out.len());
        out.extend_from_within(start..end);
        left = left.saturating_sub(end.saturating_sub(start));
    }
    Ok(())
}

fn make_room(out: &mut Vec<u8>, count: usize, wanted: usize) -> Result<(), Damage> {
    if count > wanted.saturating_sub(out.len()) {
        return Err(format!("more than {wanted} bytes come out"));
    }
    out.try_reserve(count)
        .map_err(|_| format!("no memory for {wanted} bytes"))
}

/// The next `count` bytes.
fn take<'a>(input: &mut &'a [u8], count: usize) -> Result<&'a [u8], Damage> {
    let (taken, rest) = input
        .split_at_checked(count)
        .ok_or_else(|| "it ends inside a run or a match".to_owned())?;
    *input = rest;
    Ok(taken)
}

/// The next byte.
fn next(input: &mut &[u8]) -> Result<u8, Damage> {
    take(input, 1).map(|taken| taken.first().copied().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_and_matches_are_undone() {
        // Three new bytes; a match of 3 + 2 from distance 3, which overlaps itself; a long one of 9 + 4 from 1.
        let encoded = [2, 1, 2, 3, (3 << 5), 2, (7 << 5), 4, 0];
        let wanted = [1, 2, 3, 1, 2, 3, 1, 2]
            .into_iter()
            .chain([2; 13])
            .collect::<Vec<u8>>();
        assert_eq!(decode(&encoded, wanted.len()).unwrap(), wanted);
        for cut in 0..encoded.len() {
            assert!(decode(&encoded[..cut], wanted.len()).is_err(), "{cut}");
        }
        assert!(decode(&encoded, 20).is_err());
        assert!(
            decode(&[2, 1, 2, 3, 1 << 5, 3], 6).is_err(),
            "before the first"
        );
    }
}
