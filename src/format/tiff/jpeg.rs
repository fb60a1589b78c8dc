//! The frame header of a JPEG, read before a decoder sees it: a strip of a few bytes may claim 65 535 x 65 535.
//!
//! ITU-T T.81, annex B: segments `FF marker length(u16, big-endian)`; the frame headers C0 to CF, without C4, C8
//! and CC, hold precision(u8) height(u16) width(u16) components(u8).

use super::TIFF;
use super::page::Page;
use crate::format::problem::{invalid, unsupported};
use crate::volume::Problem;

/// The one frame of a JPEG is as large as its chunk.
pub(super) fn check(bytes: &[u8], page: &Page, rows: u32) -> Result<(), Problem> {
    let wrong = |wanted: &str, found: &str| invalid(TIFF, "JPEG chunk", wanted, found);
    let mut rest = bytes
        .strip_prefix(&[0xff, 0xd8])
        .ok_or_else(|| wrong("a JPEG", "other bytes"))?;
    let mut found = false;
    // Up to the first scan; what comes later may not bring another frame either.
    while let Some((&[0xff, marker], behind)) = rest.split_first_chunk() {
        if marker == 0xff {
            rest = rest.get(1..).unwrap_or_default();
            continue;
        }
        let length = behind.first_chunk().map_or(0, |b| u16::from_be_bytes(*b));
        let Some((segment, behind)) = behind.split_at_checked(length.max(2).into()) else {
            return Err(wrong("whole segments", "a segment that is cut"));
        };
        let is_frame = matches!(marker, 0xc0..=0xcf) && !matches!(marker, 0xc4 | 0xc8 | 0xcc);
        if is_frame {
            if found {
                return Err(wrong("one frame", "several"));
            }
            found = true;
            frame(segment, page, rows)?;
        }
        if marker == 0xda {
            break;
        }
        rest = behind;
    }
    if !found {
        return Err(wrong("a frame", "none"));
    }
    let another = rest.windows(2).any(|pair| {
        matches!(
            pair,
            [0xff, 0xc0..=0xc3 | 0xc5..=0xc7 | 0xc9..=0xcb | 0xcd..=0xcf]
        )
    });
    if another {
        return Err(wrong("one frame", "several"));
    }
    Ok(())
}

fn frame(segment: &[u8], page: &Page, rows: u32) -> Result<(), Problem> {
    let &[_, _, precision, h1, h0, w1, w0, components, ..] = segment else {
        return Err(invalid(
            TIFF,
            "JPEG chunk",
            "a whole frame header",
            "a part",
        ));
    };
    if precision != 8 || page.look.bits != 8 {
        let what = format!("JPEG of {precision} bits for samples of {}", page.look.bits);
        return Err(unsupported(TIFF, what));
    }
    let width = u32::from(u16::from_be_bytes([w1, w0]));
    let height = u32::from(u16::from_be_bytes([h1, h0]));
    let fits = width == page.chunk_width
        && (rows..=page.chunk_height).contains(&height)
        && u32::from(components) == page.samples_in_chunk();
    if !fits {
        let wanted = format!(
            "{} x {rows} pixels of {} samples",
            page.chunk_width,
            page.samples_in_chunk()
        );
        let found = format!("{width} x {height} of {components}");
        return Err(invalid(TIFF, "JPEG chunk", wanted, &found));
    }
    Ok(())
}
