//! Values of attributes as numbers and words, by DICOM PS3.5 section 6.2.

use super::DICOM;
use super::tags;
use crate::format::problem::{invalid, missing};
use crate::volume::Problem;
use std::collections::BTreeMap;

/// The kept attributes of a data set or of an item of a sequence.
#[derive(Clone, Debug, Default)]
pub(super) struct DataSet {
    values: BTreeMap<u32, Vec<u8>>,
    sequences: BTreeMap<u32, Vec<DataSet>>,
    is_big_endian: bool,
}

impl DataSet {
    pub(super) fn new(is_big_endian: bool) -> Self {
        Self {
            is_big_endian,
            ..Self::default()
        }
    }

    pub(super) fn put(&mut self, tag: u32, value: Vec<u8>) {
        self.values.insert(tag, value);
    }

    pub(super) fn put_items(&mut self, tag: u32, items: Vec<DataSet>) {
        self.sequences.insert(tag, items);
    }

    /// True where the attribute is there, with or without a value.
    pub(super) fn has(&self, tag: u32) -> bool {
        self.values.contains_key(&tag) || self.sequences.contains_key(&tag)
    }

    /// The items of a sequence; none where it is not there.
    pub(super) fn items(&self, tag: u32) -> &[DataSet] {
        self.sequences.get(&tag).map_or(&[], Vec::as_slice)
    }

    /// The first item of a sequence.
    pub(super) fn item(&self, tag: u32) -> Option<&DataSet> {
        self.items(tag).first()
    }

    /// Text without the blanks and zeros that pad it; `None` where there is none.
    pub(super) fn text(&self, tag: u32) -> Option<String> {
        let text = String::from_utf8_lossy(self.values.get(&tag)?);
        let text = text.trim_matches([' ', '\0', '\t', '\r', '\n']);
        (!text.is_empty()).then(|| text.to_owned())
    }

    /// Numbers in words, separated by backslashes.
    pub(super) fn numbers(&self, tag: u32) -> Result<Option<Vec<f64>>, Problem> {
        let Some(text) = self.text(tag) else {
            return Ok(None);
        };
        let numbers: Option<Vec<f64>> = text
            .split('\\')
            .map(|word| word.trim_matches([' ', '\0']).parse::<f64>().ok())
            .map(|number| number.filter(|number| number.is_finite()))
            .collect();
        match numbers {
            Some(numbers) => Ok(Some(numbers)),
            None => Err(invalid(DICOM, &tags::name(tag), "finite numbers", &text)),
        }
    }

    /// Exactly `N` numbers in words.
    pub(super) fn vector<const N: usize>(&self, tag: u32) -> Result<Option<[f64; N]>, Problem> {
        let Some(numbers) = self.numbers(tag)? else {
            return Ok(None);
        };
        let count = numbers.len();
        match <[f64; N]>::try_from(numbers) {
            Ok(numbers) => Ok(Some(numbers)),
            Err(_) => {
                let wanted = format!("{N} numbers");
                let found = format!("{count} numbers");
                Err(invalid(DICOM, &tags::name(tag), wanted, &found))
            }
        }
    }

    /// One number in words.
    pub(super) fn number(&self, tag: u32) -> Result<Option<f64>, Problem> {
        Ok(self.vector::<1>(tag)?.map(|[number]| number))
    }

    /// A 16-bit number.
    pub(super) fn u16(&self, tag: u32) -> Result<Option<u16>, Problem> {
        Ok(self.binary(tag)?.map(|bytes| match self.is_big_endian {
            true => u16::from_be_bytes(bytes),
            false => u16::from_le_bytes(bytes),
        }))
    }

    /// A 16-bit number that must be there.
    pub(super) fn required_u16(&self, tag: u32) -> Result<u16, Problem> {
        self.u16(tag)?
            .ok_or_else(|| missing(DICOM, &tags::name(tag)))
    }

    /// A 32-bit number.
    pub(super) fn u32(&self, tag: u32) -> Result<Option<u32>, Problem> {
        Ok(self.binary(tag)?.map(|bytes| match self.is_big_endian {
            true => u32::from_be_bytes(bytes),
            false => u32::from_le_bytes(bytes),
        }))
    }

    /// An f64, `None` where it is not finite.
    pub(super) fn f64(&self, tag: u32) -> Result<Option<f64>, Problem> {
        let number = self.binary(tag)?.map(|bytes| match self.is_big_endian {
            true => f64::from_be_bytes(bytes),
            false => f64::from_le_bytes(bytes),
        });
        Ok(number.filter(|number| number.is_finite()))
    }

    /// The tag that the value names.
    pub(super) fn tag(&self, tag: u32) -> Option<u32> {
        let bytes: [u8; 4] = self.values.get(&tag)?.first_chunk().copied()?;
        let [a, b, c, d] = bytes.map(u32::from);
        Some(match self.is_big_endian {
            true => a << 24 | b << 16 | c << 8 | d,
            false => b << 24 | a << 16 | d << 8 | c,
        })
    }

    /// 64-bit numbers, one after the other; always little-endian where there are any.
    pub(super) fn u64s(&self, tag: u32) -> Option<Vec<u64>> {
        let bytes = self.values.get(&tag)?;
        let (numbers, rest) = bytes.as_chunks::<8>();
        let numbers = numbers.iter().map(|bytes| u64::from_le_bytes(*bytes));
        rest.is_empty().then(|| numbers.collect())
    }

    fn binary<const N: usize>(&self, tag: u32) -> Result<Option<[u8; N]>, Problem> {
        let Some(bytes) = self.values.get(&tag).filter(|bytes| !bytes.is_empty()) else {
            return Ok(None);
        };
        match <[u8; N]>::try_from(bytes.as_slice()) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(_) => {
                let wanted = format!("{N} bytes");
                let found = format!("{} bytes", bytes.len());
                Err(invalid(DICOM, &tags::name(tag), wanted, &found))
            }
        }
    }
}
