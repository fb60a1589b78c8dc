//! Encapsulated pixels: which fragments make up which frame, by DICOM PS3.5 annex A.4.
//!
//! ```text
//! pixels = item with a table of offsets, item per fragment, end;   offsets count from the first fragment's item
//! ```

use super::DICOM;
use super::dataset::{Stream, seek_to};
use super::file::PictureFile;
use super::tags::{self, ITEM, PIXEL_DATA, SEQUENCE_END};
use crate::format::convert::to_u64;
use crate::format::problem::{invalid, io, unsupported};
use crate::volume::{Limits, Problem};
use std::io::Read;

/// Where the bytes of each frame of one file are.
#[derive(Clone, Debug)]
pub(super) struct Fragments {
    all: Vec<Fragment>,
    /// For each frame the index of its first fragment.
    first: Vec<usize>,
}

#[derive(Clone, Copy, Debug)]
struct Fragment {
    offset: u64,
    bytes: u32,
}

/// Tag and length before a fragment.
const ITEM_BYTES: u64 = 8;

impl Fragments {
    /// Walks over the fragments of `file` without reading them.
    pub(super) fn find(file: &PictureFile, limits: &Limits) -> Result<Self, Problem> {
        let mut stream = file.open(limits).map_err(|error| error.problem)?;
        let mut position = file.place.offset;
        seek_to(&mut stream, position)?;
        let mut all: Vec<Fragment> = Vec::new();
        let mut table = None;
        loop {
            let (tag, bytes) = item(&mut stream, position, file.length)?;
            position = position.saturating_add(ITEM_BYTES);
            match tag {
                SEQUENCE_END => break,
                ITEM => {}
                other => {
                    let found = tags::name(other);
                    return Err(invalid(
                        DICOM,
                        &tags::name(PIXEL_DATA),
                        "a fragment",
                        &found,
                    ));
                }
            }
            let left = file.length.saturating_sub(position);
            if u64::from(bytes) > left {
                return Err(Problem::Size {
                    format: DICOM,
                    wanted_bytes: bytes.into(),
                    found_bytes: left,
                });
            }
            let next = position.saturating_add(bytes.into());
            if table.is_none() {
                table = Some(offsets(&mut stream, bytes, limits)?);
                seek_to(&mut stream, next)?;
            } else {
                if all.len() >= limits.max_header_bytes {
                    let wanted = format!("at most {} fragments", limits.max_header_bytes);
                    return Err(invalid(DICOM, &tags::name(PIXEL_DATA), wanted, "more"));
                }
                all.push(Fragment {
                    offset: position,
                    bytes,
                });
                stream
                    .seek_relative(i64::from(bytes))
                    .map_err(io("passing over a fragment"))?;
            }
            position = next;
        }
        let table = file.frame_offsets.clone().or(table).unwrap_or_default();
        let first = first_of_frames(&all, &table, file.layout.frames)?;
        Ok(Self { all, first })
    }

    /// The encoded bytes of one frame.
    pub(super) fn read(
        &self,
        stream: &mut dyn Stream,
        frame: u32,
        limits: &Limits,
    ) -> Result<Vec<u8>, Problem> {
        let frame = usize::try_from(frame).unwrap_or(usize::MAX);
        let start = self.first.get(frame).copied().unwrap_or(self.all.len());
        let end = self
            .first
            .get(frame.saturating_add(1))
            .copied()
            .unwrap_or(self.all.len());
        let parts = self.all.get(start..end).unwrap_or(&[]);
        let wanted_bytes: u64 = parts
            .iter()
            .map(|part| u64::from(part.bytes))
            .fold(0, u64::saturating_add);
        if wanted_bytes > limits.max_bytes {
            let what = "an encoded frame".to_owned();
            return Err(Problem::Limit {
                what,
                wanted_bytes,
                limit_bytes: limits.max_bytes,
            });
        }
        let mut encoded = Vec::new();
        for part in parts {
            seek_to(stream, part.offset)?;
            (&mut *stream)
                .take(part.bytes.into())
                .read_to_end(&mut encoded)
                .map_err(io("reading pixels"))?;
        }
        match to_u64(encoded.len()) {
            found if found == wanted_bytes => Ok(encoded),
            found_bytes => Err(Problem::Size {
                format: DICOM,
                wanted_bytes,
                found_bytes,
            }),
        }
    }
}

/// Tag and length of an item; always little-endian.
fn item(stream: &mut dyn Stream, position: u64, length: u64) -> Result<(u32, u32), Problem> {
    if length.saturating_sub(position) < ITEM_BYTES {
        let wanted = format!("a fragment or the end of the pixels at byte {position}");
        let found = format!("the end of the file at byte {length}");
        return Err(invalid(DICOM, &tags::name(PIXEL_DATA), wanted, &found));
    }
    let mut bytes = [0; 8];
    stream
        .read_exact(&mut bytes)
        .map_err(io("looking for fragments"))?;
    let [a, b, c, d, e, f, g, h] = bytes;
    Ok((
        u32::from_be_bytes([b, a, d, c]),
        u32::from_le_bytes([e, f, g, h]),
    ))
}

/// The first item: 32-bit offsets of the frames, or nothing.
fn offsets(stream: &mut dyn Stream, bytes: u32, limits: &Limits) -> Result<Vec<u64>, Problem> {
    if usize::try_from(bytes).unwrap_or(usize::MAX) > limits.max_header_bytes
        || !bytes.is_multiple_of(4)
    {
        let wanted = format!(
            "a table of offsets of at most {} bytes, four for each",
            limits.max_header_bytes
        );
        return Err(invalid(
            DICOM,
            &tags::name(PIXEL_DATA),
            wanted,
            &bytes.to_string(),
        ));
    }
    let mut table = Vec::new();
    stream
        .take(bytes.into())
        .read_to_end(&mut table)
        .map_err(io("reading the table of offsets"))?;
    let numbers = table.as_chunks::<4>().0.iter();
    Ok(numbers
        .map(|bytes| u32::from_le_bytes(*bytes).into())
        .collect())
}

fn first_of_frames(all: &[Fragment], table: &[u64], frames: u32) -> Result<Vec<usize>, Problem> {
    let count = usize::try_from(frames).unwrap_or(usize::MAX);
    if count == 1 && !all.is_empty() {
        return Ok(vec![0]);
    }
    if all.len() == count {
        return Ok((0..count).collect());
    }
    let damaged = |wanted: String| {
        let found = format!("{} fragments, {} offsets", all.len(), table.len());
        Err(invalid(DICOM, &tags::name(PIXEL_DATA), wanted, &found))
    };
    if all.len() < count {
        return damaged(format!("a fragment at least for each of {frames} frames"));
    }
    if table.is_empty() {
        let what = format!(
            "{} fragments for {frames} frames without a table of offsets",
            all.len()
        );
        return Err(unsupported(DICOM, what));
    }
    let base = all.first().map_or(0, |fragment| fragment.offset);
    let found: Option<Vec<usize>> = table
        .iter()
        .map(|offset| {
            let offset = base.checked_add(*offset)?;
            all.binary_search_by_key(&offset, |fragment| fragment.offset)
                .ok()
        })
        .collect();
    match found {
        Some(first) if first.len() == count && first.is_sorted() && first.first() == Some(&0) => {
            Ok(first)
        }
        _ => damaged(format!(
            "offsets of {frames} fragments, each after the last"
        )),
    }
}
