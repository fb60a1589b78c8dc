//! Sections of a message: numbers at their octets, counted from 1 as the Manual on Codes does.

use super::GRIB;
use crate::format::problem::invalid;
use crate::volume::Problem;
use std::ops::Range;

/// Where a section lies in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub start: u64,
    pub length: u32,
}

/// A section, or its first octets.
#[derive(Clone, Debug)]
pub(super) struct Section {
    pub number: u8,
    pub octets: Vec<u8>,
}

impl Section {
    fn octets_of<const N: usize>(&self, octet: usize) -> Result<[u8; N], Problem> {
        let start = octet.saturating_sub(1);
        let found = self.octets.get(start..).and_then(|rest| rest.first_chunk());
        found.copied().ok_or_else(|| {
            let field = format!("section {}", self.number);
            let wanted = format!("{} octets at least", start.saturating_add(N));
            invalid(GRIB, &field, wanted, &self.octets.len().to_string())
        })
    }

    pub(super) fn u8(&self, octet: usize) -> Result<u8, Problem> {
        Ok(u8::from_be_bytes(self.octets_of(octet)?))
    }

    pub(super) fn u16(&self, octet: usize) -> Result<u16, Problem> {
        Ok(u16::from_be_bytes(self.octets_of(octet)?))
    }

    pub(super) fn u32(&self, octet: usize) -> Result<u32, Problem> {
        Ok(u32::from_be_bytes(self.octets_of(octet)?))
    }

    /// A float of IEEE's.
    pub(super) fn f32(&self, octet: usize) -> Result<f32, Problem> {
        Ok(f32::from_be_bytes(self.octets_of(octet)?))
    }

    /// A sign and a magnitude, not a complement (regulation 92.1.5).
    pub(super) fn i8(&self, octet: usize) -> Result<i32, Problem> {
        let bits = self.u8(octet)?;
        Ok(signed((bits & 0x7f).into(), bits & 0x80 != 0))
    }

    pub(super) fn i16(&self, octet: usize) -> Result<i32, Problem> {
        let bits = self.u16(octet)?;
        Ok(signed((bits & 0x7fff).into(), bits & 0x8000 != 0))
    }

    pub(super) fn i32(&self, octet: usize) -> Result<i32, Problem> {
        let bits = self.u32(octet)?;
        let magnitude = i32::try_from(bits & 0x7fff_ffff).unwrap_or(i32::MAX);
        Ok(signed(magnitude, bits & 0x8000_0000 != 0))
    }

    /// Puts other octets at a place.
    pub(super) fn patch(&mut self, range: Range<usize>, octets: &[u8]) {
        let start = range.start.saturating_sub(1);
        let places = self.octets.iter_mut().skip(start).take(range.len());
        places
            .zip(octets)
            .for_each(|(place, octet)| *place = *octet);
    }
}

fn signed(magnitude: i32, is_negative: bool) -> i32 {
    if is_negative {
        magnitude.saturating_neg()
    } else {
        magnitude
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_are_the_first_bit_and_octets_count_from_one() {
        let section = Section {
            number: 3,
            octets: vec![0x80, 0, 0, 5, 0x81, 0x80, 2],
        };
        assert_eq!(section.i32(1).unwrap(), -5);
        assert_eq!(section.i8(5).unwrap(), -1);
        assert_eq!(section.i16(6).unwrap(), -2);
        let error = section.u32(5).unwrap_err().to_string();
        assert!(
            error.contains("section 3") && error.contains("8 octets"),
            "{error}"
        );
    }
}
