//! What the decoder is not trusted with: packings it does not know, and counts that the bytes cannot hold.
//!
//! Data representation templates 5.0, 5.2, 5.3, 5.4, 5.40, 5.41 and 5.42 of the Manual on Codes.

use super::GRIB;
use super::section::{Place, Section};
use crate::format::convert::to_u64;
use crate::format::problem::invalid;
use crate::volume::Problem;

pub(super) const SIMPLE: u16 = 0;
pub(super) const COMPLEX: u16 = 2;
pub(super) const DIFFERENCES: u16 = 3;
pub(super) const IEEE: u16 = 4;
pub(super) const JPEG2000: u16 = 40;
pub(super) const PNG: u16 = 41;
pub(super) const CCSDS: u16 = 42;

/// The name of a packing that we do not read.
pub(super) fn refused(packing: &Section) -> Result<Option<String>, Problem> {
    let template = packing.u16(10)?;
    Ok(match template {
        SIMPLE | JPEG2000 | PNG | CCSDS => {
            let is_wide = packing.u8(20)? > 32;
            is_wide.then(|| "numbers of more than 32 bits".to_owned())
        }
        COMPLEX | DIFFERENCES => {
            let is_other = packing.u8(22)? != 1;
            is_other.then(|| "complex packing in rows (code table 5.4)".to_owned())
        }
        IEEE => {
            let is_other = !matches!(packing.u8(12)?, 1 | 2);
            is_other.then(|| "floats of 128 bits".to_owned())
        }
        200 => Some("packing of template 5.200 (run lengths)".to_owned()),
        50 | 51 => Some(format!(
            "packing of template 5.{template} (spherical harmonics)"
        )),
        _ => Some(format!("packing of template 5.{template}")),
    })
}

/// An error where a field's counts and lengths do not agree.
pub(super) fn check(
    packing: &Section,
    points: u64,
    bitmap: Option<Place>,
    data: Place,
) -> Result<(), Problem> {
    let packed = u64::from(packing.u32(6)?);
    let is_possible = match bitmap {
        None => packed == points,
        Some(_) => packed <= points,
    };
    if !is_possible {
        let wanted = format!("a number for each of {points} points");
        return Err(invalid(GRIB, "packed numbers", wanted, &packed.to_string()));
    }
    if let Some(bitmap) = bitmap {
        let wanted = points.div_ceil(8).saturating_add(6);
        if u64::from(bitmap.length) < wanted {
            let wanted = format!("{wanted} octets");
            return Err(invalid(
                GRIB,
                "section 6",
                wanted,
                &bitmap.length.to_string(),
            ));
        }
    }
    let bits = match packing.u16(10)? {
        SIMPLE => packing.u8(20)?.into(),
        IEEE if packing.u8(12)? == 1 => 32,
        IEEE => 64,
        // What is compressed is checked when it is read.
        _ => 0,
    };
    let wanted = packed.saturating_mul(bits).div_ceil(8);
    let found = u64::from(data.length).saturating_sub(5);
    if found < wanted {
        return Err(Problem::Size {
            format: GRIB,
            wanted_bytes: wanted,
            found_bytes: found,
        });
    }
    Ok(())
}

fn damaged(what: &str, wanted: impl Into<String>, found: impl ToString) -> Problem {
    invalid(GRIB, what, wanted, &found.to_string())
}

/// Adds up the lengths of the groups of complex packing, each of which the decoder makes room for.
pub(super) fn check_groups(packing: &Section, data: &[u8]) -> Result<(), Problem> {
    const GROUPS: &str = "groups of complex packing";
    let packed = u64::from(packing.u32(6)?);
    let groups = packing.u32(32)?;
    if groups == 0 || u64::from(groups) > packed {
        return Err(damaged(GROUPS, format!("1 to {packed}"), groups));
    }
    let bits = [packing.u8(20)?, packing.u8(37)?, packing.u8(47)?].map(u64::from);
    if bits.iter().any(|&bits| bits > 31) {
        return Err(damaged(
            GROUPS,
            "numbers of at most 31 bits",
            format!("{bits:?}"),
        ));
    }
    let descriptors = if packing.u16(10)? == DIFFERENCES {
        let octets = u64::from(packing.u8(49)?);
        u64::from(packing.u8(48)?)
            .saturating_add(1)
            .saturating_mul(octets)
    } else {
        0
    };
    let octets = |bits: u64| u64::from(groups).saturating_mul(bits).div_ceil(8);
    let start = descriptors
        .saturating_add(octets(bits[0]))
        .saturating_add(octets(bits[1]));
    let end = start.saturating_add(octets(bits[2]));
    let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
    let lengths = range.and_then(|(start, end)| data.get(start..end));
    let lengths =
        lengths.ok_or_else(|| damaged(GROUPS, format!("{end} octets of lengths"), data.len()))?;
    let (reference, step) = (u64::from(packing.u32(38)?), u64::from(packing.u8(42)?));
    let mut total = u64::from(packing.u32(43)?);
    let mut reader = Bits {
        octets: lengths,
        at: 0,
    };
    for _ in 1..groups {
        let length = reader
            .next(bits[2])
            .saturating_mul(step)
            .saturating_add(reference);
        total = total.saturating_add(length);
        if total > packed {
            break;
        }
    }
    if total != packed {
        return Err(damaged(GROUPS, format!("{packed} numbers in all"), total));
    }
    Ok(())
}

/// Numbers of some bits, side by side.
struct Bits<'a> {
    octets: &'a [u8],
    at: usize,
}

impl Bits<'_> {
    fn next(&mut self, bits: u64) -> u64 {
        let mut number = 0_u64;
        for _ in 0..bits {
            let octet = self.octets.get(self.at.div_euclid(8)).copied().unwrap_or(0);
            let shift = 7_usize.saturating_sub(self.at.rem_euclid(8));
            number = number << 1 | u64::from(octet >> shift & 1);
            self.at = self.at.saturating_add(1);
        }
        number
    }
}

/// The bits of a pixel of a PNG picture (section 11.2.1 of its specification), which must have `packed` of them.
pub(super) fn check_png(packed: u64, data: &[u8]) -> Result<u8, Problem> {
    const WHAT: &str = "PNG picture";
    let header = Section {
        number: 7,
        octets: data.get(..33).unwrap_or(data).to_vec(),
    };
    let (width, height) = (u64::from(header.u32(17)?), u64::from(header.u32(21)?));
    if width.saturating_mul(height) != packed {
        let wanted = format!("{packed} pixels");
        return Err(damaged(WHAT, wanted, format!("{width} x {height}")));
    }
    let (depth, colour) = (header.u8(25)?, header.u8(26)?);
    let bits = match (colour, depth) {
        (0, 1 | 2 | 4 | 8 | 16) => depth,
        (2, 8) => 24,
        (6, 8) => 32,
        _ => {
            let found = format!("depth {depth}, colour type {colour}");
            return Err(damaged(
                WHAT,
                "1 to 16 bits of grey, or 8 of RGB or RGBA",
                found,
            ));
        }
    };
    // The decoder takes rows for one string of bits; those of a picture begin at octets.
    if width.saturating_mul(bits.into()).rem_euclid(8) != 0 && height > 1 {
        return Err(damaged(
            WHAT,
            "rows of whole octets",
            format!("{width} x {depth} bits"),
        ));
    }
    Ok(bits)
}

/// An error where a JPEG 2000 code stream (ISO/IEC 15444-1, A.5.1) has not `packed` samples of one component.
pub(super) fn check_jpeg2000(packed: u64, data: &[u8]) -> Result<(), Problem> {
    const WHAT: &str = "JPEG 2000 code stream";
    /// A tile begins with a SOT and a SOD marker.
    const LEAST_TILE_BYTES: u64 = 14;
    let size = Section {
        number: 7,
        octets: data.get(..64).unwrap_or(data).to_vec(),
    };
    if size.u32(1)? != 0xff4f_ff51 {
        return Err(damaged(
            WHAT,
            "a SIZ segment first",
            format!("{:08x}", size.u32(1)?),
        ));
    }
    let side = |end: usize, start: usize| -> Result<u64, Problem> {
        Ok(u64::from(size.u32(end)?).saturating_sub(size.u32(start)?.into()))
    };
    let (width, height) = (side(9, 17)?, side(13, 21)?);
    let tiles = |end: usize, start: usize, tile: usize| -> Result<u64, Problem> {
        Ok(side(end, start)?.div_ceil(u64::from(size.u32(tile)?).max(1)))
    };
    let tiles = tiles(9, 33, 25)?.saturating_mul(tiles(13, 37, 29)?);
    let (components, precision, steps) = (size.u16(41)?, size.u8(43)?, size.u16(44)?);
    if width.saturating_mul(height) != packed || components != 1 || steps != 0x0101 {
        let found = format!("{width} x {height}, {components} components");
        return Err(damaged(
            WHAT,
            format!("{packed} samples of one component"),
            found,
        ));
    }
    if tiles.saturating_mul(LEAST_TILE_BYTES) > to_u64(data.len()) {
        return Err(damaged(WHAT, "tiles that its bytes can hold", tiles));
    }
    // 0 is one bit; the highest bit tells of signs.
    if precision > 23 {
        return Err(damaged(WHAT, "at most 24 bits without sign", precision));
    }
    Ok(())
}
