//! The bytes of a file to the attributes that we look at, by DICOM PS3.5 section 7 and PS3.10 section 7.
//!
//! ```text
//! element = tag [type] length value,   sequence = items of elements,   pixels = where they begin
//! ```
//! Lengths are compared with the bytes that are left before anything is read; pixels are never read here.

use super::DICOM;
use super::fields::DataSet;
use super::syntax::Syntax;
use super::tags::{self, is_sequence};
use crate::format::problem::{invalid, io};
use crate::volume::Problem;
use std::io::{Read, Seek, SeekFrom};

/// A file or what was inflated from one.
pub(super) trait Stream: Read + Seek {}
impl<T: Read + Seek> Stream for T {}

/// Where pixels are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PixelPlace {
    /// Which of the three kinds of pixel data.
    pub tag: u32,
    pub offset: u64,
    /// `None` for a list of fragments.
    pub bytes: Option<u64>,
    /// The file calls them words: in big-endian files pairs of bytes are swapped.
    pub are_words: bool,
}

/// Reads elements one after the other.
pub(super) struct Elements<'a> {
    stream: &'a mut dyn Stream,
    position: u64,
    length: u64,
    syntax: Syntax,
    /// What kept values may still take, so that many small elements do not fill the memory.
    budget_bytes: u64,
    max_value_bytes: u64,
    pixels: Option<PixelPlace>,
}

/// How deep sequences may lie in each other; real files have some five.
const DEEPEST: u32 = 24;
/// What an element takes in memory beside its value.
const ELEMENT_BYTES: u64 = 96;
/// Kept attributes may take this many times what one of them may.
const BUDGET: u64 = 64;
const UNDEFINED: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
struct Element {
    tag: u32,
    kind: [u8; 2],
    length: u32,
}

#[derive(Clone, Copy)]
enum End {
    At(u64),
    Marked,
}

impl<'a> Elements<'a> {
    /// `position` is where the stream stands and `length` where it ends.
    pub(super) fn new(
        stream: &'a mut dyn Stream,
        position: u64,
        length: u64,
        syntax: Syntax,
        max_header_bytes: usize,
    ) -> Self {
        let max_value_bytes = u64::try_from(max_header_bytes).unwrap_or(u64::MAX);
        Self {
            stream,
            position,
            length,
            syntax,
            budget_bytes: max_value_bytes.saturating_mul(BUDGET),
            max_value_bytes,
            pixels: None,
        }
    }

    /// All attributes that we look at, up to the pixels.
    pub(super) fn read(mut self) -> Result<(DataSet, Option<PixelPlace>), Problem> {
        let end = End::At(self.length);
        let set = self.data_set(end, true, 0)?;
        Ok((set, self.pixels))
    }

    /// The elements of one group at the begin of a file; the stream then stands behind them.
    pub(super) fn read_group(mut self, group: u16) -> Result<(DataSet, u64), Problem> {
        let mut set = DataSet::new(self.syntax.is_big_endian);
        while self.left() >= 8 {
            // What follows the group may be written in another way: only its number is looked at.
            let before = self.position;
            let next = self.u16()?;
            self.seek(before)?;
            if next != group {
                break;
            }
            let element = self.header()?;
            self.keep_or_skip(element, &mut set, true, 0)?;
        }
        Ok((set, self.position))
    }

    fn data_set(&mut self, end: End, keep: bool, depth: u32) -> Result<DataSet, Problem> {
        let mut set = DataSet::new(self.syntax.is_big_endian);
        loop {
            match end {
                End::At(end) if self.position == end => break,
                End::At(end) if self.position > end => {
                    let wanted = format!("elements that end with their item at byte {end}");
                    let found = format!("one that ends at byte {}", self.position);
                    return Err(invalid(DICOM, "data set", wanted, &found));
                }
                _ => {}
            }
            let element = self.header()?;
            match (element.tag, end) {
                (tags::ITEM_END, End::Marked) => break,
                (tags::PIXEL_DATA | tags::FLOAT_PIXEL_DATA | tags::DOUBLE_FLOAT_PIXEL_DATA, _)
                    if depth == 0 =>
                {
                    self.pixels = Some(self.pixel_place(element)?);
                    break;
                }
                _ => self.keep_or_skip(element, &mut set, keep, depth)?,
            }
        }
        Ok(set)
    }

    fn pixel_place(&self, element: Element) -> Result<PixelPlace, Problem> {
        let bytes = (element.length != UNDEFINED).then_some(u64::from(element.length));
        if let Some(bytes) = bytes
            && bytes > self.left()
        {
            return Err(Problem::Size {
                format: DICOM,
                wanted_bytes: bytes,
                found_bytes: self.left(),
            });
        }
        Ok(PixelPlace {
            tag: element.tag,
            offset: self.position,
            bytes,
            are_words: element.kind == *b"OW" || !self.syntax.is_explicit,
        })
    }

    fn keep_or_skip(
        &mut self,
        element: Element,
        set: &mut DataSet,
        keep: bool,
        depth: u32,
    ) -> Result<(), Problem> {
        let keep = keep && tags::keyword(element.tag).is_some();
        let is_undefined = element.length == UNDEFINED;
        if is_undefined || (keep && is_sequence(element.tag)) {
            // Undefined length with the type "unknown" hides an implicit data set, PS3.5 section 6.2.2.
            let before = self.syntax;
            if element.kind == *b"UN" {
                self.syntax = Syntax::IMPLICIT;
            }
            let items = self.items(element, keep && is_sequence(element.tag), depth)?;
            self.syntax = before;
            if keep && is_sequence(element.tag) {
                set.put_items(element.tag, items);
            }
            return Ok(());
        }
        let length = u64::from(element.length);
        if length > self.left() {
            return Err(self.too_long(element));
        }
        if !keep {
            return self.seek(self.position.saturating_add(length));
        }
        self.spend(length, element.tag)?;
        if length > self.max_value_bytes {
            return Err(Problem::Limit {
                what: format!("the value of {}", tags::name(element.tag)),
                wanted_bytes: length,
                limit_bytes: self.max_value_bytes,
            });
        }
        let mut value = Vec::new();
        self.stream
            .take(length)
            .read_to_end(&mut value)
            .map_err(io("reading an attribute"))?;
        self.position = self.position.saturating_add(length);
        set.put(element.tag, value);
        Ok(())
    }

    fn items(
        &mut self,
        sequence: Element,
        keep: bool,
        depth: u32,
    ) -> Result<Vec<DataSet>, Problem> {
        let depth = depth.saturating_add(1);
        if depth > DEEPEST {
            let wanted = format!("sequences at most {DEEPEST} deep");
            return Err(invalid(DICOM, &tags::name(sequence.tag), wanted, "deeper"));
        }
        let end = match sequence.length {
            UNDEFINED => None,
            length if u64::from(length) > self.left() => return Err(self.too_long(sequence)),
            length => Some(self.position.saturating_add(length.into())),
        };
        // Fragments of pixels in a picture inside a sequence: their items hold bytes, not elements.
        let are_fragments = end.is_none() && matches!(&sequence.kind, b"OB" | b"OW")
            || sequence.tag == tags::PIXEL_DATA;
        let mut items = Vec::new();
        while end.is_none_or(|end| self.position < end) {
            let item = self.header()?;
            match item.tag {
                tags::SEQUENCE_END if end.is_none() => break,
                tags::ITEM => {}
                other => {
                    let wanted = "an item";
                    let found = tags::name(other);
                    return Err(invalid(DICOM, &tags::name(sequence.tag), wanted, &found));
                }
            }
            let item_end = match item.length {
                UNDEFINED => End::Marked,
                length if u64::from(length) > self.left() => return Err(self.too_long(item)),
                length => End::At(self.position.saturating_add(length.into())),
            };
            match item_end {
                End::At(end) if !keep || are_fragments => self.seek(end)?,
                _ => {
                    let set = self.data_set(item_end, keep, depth)?;
                    if keep {
                        self.spend(0, sequence.tag)?;
                        items.push(set);
                    }
                }
            }
        }
        Ok(items)
    }

    fn header(&mut self) -> Result<Element, Problem> {
        let group = self.u16()?;
        let number = self.u16()?;
        let tag = u32::from(group) << 16 | u32::from(number);
        // Items and their ends have no type.
        if !self.syntax.is_explicit || group == 0xfffe {
            let length = self.u32()?;
            let kind = *b"  ";
            return Ok(Element { tag, kind, length });
        }
        let kind = self.take::<2>()?;
        let length = match &kind {
            b"OB" | b"OD" | b"OF" | b"OL" | b"OV" | b"OW" | b"SQ" | b"SV" | b"UC" | b"UN"
            | b"UR" | b"UT" | b"UV" => {
                self.u16()?;
                self.u32()?
            }
            [first, second] if first.is_ascii_uppercase() && second.is_ascii_uppercase() => {
                self.u16()?.into()
            }
            other => {
                let found = String::from_utf8_lossy(other);
                let field = tags::name(tag);
                let wanted = format!(
                    "two capital letters for the type of its value, at byte {}",
                    self.position.saturating_sub(2)
                );
                return Err(invalid(DICOM, &field, wanted, &found));
            }
        };
        Ok(Element { tag, kind, length })
    }

    fn too_long(&self, element: Element) -> Problem {
        let wanted = format!(
            "a length of at most the {} bytes that follow byte {}",
            self.left(),
            self.position
        );
        let found = element.length.to_string();
        invalid(DICOM, &tags::name(element.tag), wanted, &found)
    }

    /// Counts what a kept element takes.
    fn spend(&mut self, bytes: u64, tag: u32) -> Result<(), Problem> {
        let wanted_bytes = bytes.saturating_add(ELEMENT_BYTES);
        match self.budget_bytes.checked_sub(wanted_bytes) {
            Some(left) => {
                self.budget_bytes = left;
                Ok(())
            }
            None => Err(Problem::Limit {
                what: format!("the header up to {}", tags::name(tag)),
                wanted_bytes: self
                    .max_value_bytes
                    .saturating_mul(BUDGET)
                    .saturating_add(1),
                limit_bytes: self.max_value_bytes.saturating_mul(BUDGET),
            }),
        }
    }

    fn left(&self) -> u64 {
        self.length.saturating_sub(self.position)
    }

    fn seek(&mut self, position: u64) -> Result<(), Problem> {
        let distance = i64::try_from(position)
            .ok()
            .zip(i64::try_from(self.position).ok())
            .map(|(to, from)| to.saturating_sub(from))
            .unwrap_or(i64::MAX);
        self.stream
            .seek_relative(distance)
            .map_err(io("passing over an attribute"))?;
        self.position = position;
        Ok(())
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Problem> {
        let mut bytes = [0; N];
        let wanted = u64::try_from(N).unwrap_or(u64::MAX);
        if self.left() < wanted {
            let wanted = format!("an element at byte {}", self.position);
            let found = format!("the end of the file at byte {}", self.length);
            return Err(invalid(DICOM, "data set", wanted, &found));
        }
        self.stream
            .read_exact(&mut bytes)
            .map_err(io("reading an attribute"))?;
        self.position = self.position.saturating_add(wanted);
        Ok(bytes)
    }

    fn u16(&mut self) -> Result<u16, Problem> {
        let bytes = self.take()?;
        Ok(match self.syntax.is_big_endian {
            true => u16::from_be_bytes(bytes),
            false => u16::from_le_bytes(bytes),
        })
    }

    fn u32(&mut self) -> Result<u32, Problem> {
        let bytes = self.take()?;
        Ok(match self.syntax.is_big_endian {
            true => u32::from_be_bytes(bytes),
            false => u32::from_le_bytes(bytes),
        })
    }
}

/// A place in a stream, before it is read on.
pub(super) fn seek_to(stream: &mut dyn Stream, position: u64) -> Result<(), Problem> {
    stream
        .seek(SeekFrom::Start(position))
        .map_err(io("looking for the pixels"))?;
    Ok(())
}
