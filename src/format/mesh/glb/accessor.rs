//! Rows of numbers in the bytes of a glTF file.
//!
//! ```text
//! row i of count    at  byteOffset of the accessor + i * stride,  in the bytes of its view
//! normalized        whole numbers as parts of the largest of their type
//! ```

use super::GLB;
use super::document::Document;
use crate::format::convert::{Endian, decoded};
use crate::format::problem::{invalid, unsupported};
use crate::volume::{Problem, VoxelType};

/// Rows that are all there.
#[derive(Debug)]
pub(super) struct Accessor<'a> {
    /// From the first byte of the first row to the last of the last.
    bytes: &'a [u8],
    stride: usize,
    row_bytes: usize,
    stored: VoxelType,
    largest: f64,
    /// Rows.
    pub count: usize,
}

impl<'a> Accessor<'a> {
    /// One of the document's by its number, whose rows must have so many components; `field` is the word of errors.
    pub(super) fn new(
        document: &Document,
        binary: &'a [u8],
        number: usize,
        field: &str,
        components: &[usize],
    ) -> Result<Self, Problem> {
        let wrong = |part: &str, wanted: &str, found: &str| {
            invalid(GLB, &format!("{field}{part}"), wanted, found)
        };
        let words = document.accessors.get(number);
        let words = words.ok_or_else(|| wrong("", "one of the accessors", &number.to_string()))?;
        let shape = match words.shape.as_str() {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 0,
        };
        if !components.contains(&shape) {
            let wanted = format!("{components:?} numbers a row");
            return Err(wrong(".type", &wanted, &words.shape));
        }
        let (stored, largest) = match words.component_type {
            5120 => (VoxelType::I8, i8::MAX.into()),
            5121 => (VoxelType::U8, u8::MAX.into()),
            5122 => (VoxelType::I16, i16::MAX.into()),
            5123 => (VoxelType::U16, u16::MAX.into()),
            5125 => (VoxelType::U32, u32::MAX.into()),
            5126 => (VoxelType::F32, 1.0),
            other => {
                let wanted = "5120 to 5123, 5125 or 5126";
                return Err(wrong(".componentType", wanted, &other.to_string()));
            }
        };
        if words.sparse.is_some() || words.buffer_view.is_none() {
            return Err(unsupported(
                GLB,
                "accessors that are sparse or have no bytes",
            ));
        }
        let view = words
            .buffer_view
            .and_then(|view| document.buffer_views.get(view));
        let view = view.ok_or_else(|| wrong(".bufferView", "one of the views", "none"))?;
        // The first buffer is the one inside of the file.
        let is_inside = document
            .buffers
            .first()
            .is_some_and(|buffer| buffer.uri.is_none());
        if view.buffer != 0 || !is_inside {
            return Err(unsupported(
                GLB,
                "a buffer in a file of its own or in the text",
            ));
        }
        let row_bytes = stored.bytes().saturating_mul(shape);
        let stride = view.byte_stride.unwrap_or(row_bytes);
        let end = view.byte_offset.checked_add(view.byte_length);
        let bytes = end.and_then(|end| binary.get(view.byte_offset..end));
        let length = match words.count {
            0 => Some(0),
            count => stride
                .checked_mul(count.saturating_sub(1))
                .and_then(|n| n.checked_add(row_bytes)),
        };
        let end = length.and_then(|length| words.byte_offset.checked_add(length));
        let bytes = bytes
            .zip(end)
            .and_then(|(all, end)| all.get(words.byte_offset..end));
        match bytes.filter(|_| stride >= row_bytes) {
            Some(bytes) => Ok(Self {
                bytes,
                stride,
                row_bytes,
                stored,
                largest: if words.normalized { largest } else { 1.0 },
                count: words.count,
            }),
            None => {
                let wanted =
                    format!("rows of {row_bytes} bytes inside of its view and of the file");
                let found = format!("{} rows, {stride} bytes apart", words.count);
                Err(wrong("", &wanted, &found))
            }
        }
    }

    /// The rows, with 0 for components that are not there.
    pub(super) fn rows(&self) -> impl Iterator<Item = [f64; 4]> {
        let bytes = self.stored.bytes();
        self.bytes.chunks(self.stride.max(1)).map(move |row| {
            let row = row.get(..self.row_bytes).unwrap_or_default();
            let mut numbers = row
                .chunks_exact(bytes.max(1))
                .map(|number| decoded(number, self.stored, Endian::Little) / self.largest);
            let mut next = || numbers.next().unwrap_or(0.0);
            [next(), next(), next(), next()]
        })
    }
}
