//! The head of a PLY file: its encoding, and its elements with their properties.

use super::problem::{escape, invalid, missing, unsupported};
use super::text::Lines;
use crate::volume::{Problem, VoxelType};
use std::io::BufRead;

/// The word of errors.
pub(super) const PLY: &str = "ply";

/// Properties of one element.
const MOST_PROPERTIES: usize = 4096;
const MOST_ELEMENTS: usize = 64;

/// True where a file begins as every PLY file does.
pub(super) fn recognizes(first: &[u8]) -> bool {
    first.starts_with(b"ply\n") || first.starts_with(b"ply\r\n")
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Words,
    LittleEndian,
    BigEndian,
}

#[derive(Debug)]
pub(super) struct Property {
    pub name: String,
    /// Of a number, or of each in a list.
    pub stored: VoxelType,
    /// Of a list: how its length is written, which stands before it.
    pub length: Option<VoxelType>,
}

#[derive(Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

#[derive(Debug)]
pub(super) struct Head {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// Where the first element begins.
    pub data_begins: u64,
    /// Lines of the head.
    pub lines: u64,
}

impl Element {
    /// Bytes of one, if all have as many.
    pub(super) fn bytes(&self) -> Option<u64> {
        self.properties.iter().try_fold(0_u64, |sum, property| {
            let bytes = u64::try_from(property.stored.bytes()).ok()?;
            sum.checked_add(bytes).filter(|_| property.length.is_none())
        })
    }
}

/// Elements that make a surface of vertices.
const OF_SURFACES: [&str; 2] = ["face", "tristrips"];

impl Head {
    /// True where the vertices are those of a surface.
    pub(super) fn has_faces(&self) -> bool {
        let mut all = self.elements.iter();
        all.any(|e| OF_SURFACES.contains(&e.name.as_str()) && e.count > 0)
    }

    pub(super) fn read(input: impl BufRead, limit_bytes: usize) -> Result<Self, Problem> {
        let mut lines = Lines::new(input, limit_bytes);
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut count = 0_u64;
        loop {
            let line = lines.next()?.filter(|line| line.ended);
            let text = line.ok_or_else(|| missing(PLY, "end_header"))?.text;
            count = count.saturating_add(1);
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            let wrong = |wanted: &str| invalid(PLY, &format!("line {count}"), wanted, &text);
            match words.as_slice() {
                ["ply"] if count == 1 => {}
                _ if count == 1 => return Err(wrong("ply")),
                ["format", word, "1.0"] => {
                    let found = match *word {
                        "ascii" => Encoding::Words,
                        "binary_little_endian" => Encoding::LittleEndian,
                        "binary_big_endian" => Encoding::BigEndian,
                        _ => {
                            let wanted = "ascii, binary_little_endian or binary_big_endian";
                            return Err(wrong(wanted));
                        }
                    };
                    if encoding.replace(found).is_some() {
                        return Err(wrong("one format"));
                    }
                }
                ["format", _, version] => {
                    let what = format!("version {}", escape(version));
                    return Err(unsupported(PLY, what));
                }
                ["comment" | "obj_info", ..] | [] => {}
                ["element", name, number] => {
                    let count = number.parse().ok();
                    let count = count.ok_or_else(|| wrong("a whole number of elements"))?;
                    if elements.len() >= MOST_ELEMENTS {
                        return Err(wrong("at most 64 elements"));
                    }
                    elements.push(Element {
                        name: (*name).to_owned(),
                        count,
                        properties: Vec::new(),
                    });
                }
                ["property", rest @ ..] => {
                    let property =
                        property(rest).ok_or_else(|| wrong("the type and name of a property"))?;
                    let element = elements.last_mut();
                    let element = element.ok_or_else(|| wrong("an element before it"))?;
                    if element.properties.len() >= MOST_PROPERTIES {
                        return Err(wrong("at most 4096 properties"));
                    }
                    element.properties.push(property);
                }
                ["end_header"] => break,
                _ => return Err(wrong("a line of a PLY header")),
            }
        }
        Ok(Self {
            encoding: encoding.ok_or_else(|| missing(PLY, "format"))?,
            elements,
            data_begins: lines.position(),
            lines: count,
        })
    }
}

fn property(words: &[&str]) -> Option<Property> {
    let (name, stored, length) = match words {
        ["list", length, stored, name] => (name, stored, Some(stored_type(length)?)),
        [stored, name] => (name, stored, None),
        _ => return None,
    };
    Some(Property {
        name: (*name).to_owned(),
        stored: stored_type(stored)?,
        length,
    })
}

fn stored_type(word: &str) -> Option<VoxelType> {
    Some(match word {
        "char" | "int8" => VoxelType::I8,
        "uchar" | "uint8" => VoxelType::U8,
        "short" | "int16" => VoxelType::I16,
        "ushort" | "uint16" => VoxelType::U16,
        "int" | "int32" => VoxelType::I32,
        "uint" | "uint32" => VoxelType::U32,
        "float" | "float32" => VoxelType::F32,
        "double" | "float64" => VoxelType::F64,
        _ => return None,
    })
}
