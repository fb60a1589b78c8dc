//! The numbers of a field.
//!
//! ```text
//! value = (R + X 2^E) / 10^D                                                            (regulation 92.9.4)
//! ```
//!
//! The decoder gives the packed integers X, exact up to 24 bits: section 5 is handed to it with R, E and D zero.
//! Values are reckoned from them in f64 and rounded once.

use super::GRIB;
use super::guard;
use super::scan::Field;
use super::section::{Place, Section};
use crate::format::convert::to_u64;
use crate::format::fence::fenced;
use crate::format::problem::{invalid, io, unsupported};
use crate::volume::Problem;
use grib::{Grib2SubmessageDecoder, GribError};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

/// All points of a field in rows, NaN where there is no number.
pub(super) fn values(file: &mut File, field: &Field) -> Result<Vec<f32>, Problem> {
    let packing = section(file, 5, field.packing)?;
    let data = section(file, 7, field.data)?;
    let packed = packing.u32(6)?;
    let numbers = match packing.u16(10)? {
        guard::IEEE => floats(&packing, &data),
        template => scaled(template, &packing, data, packed)?,
    };
    if to_u64(numbers.len()) != u64::from(packed) {
        return Err(Problem::Size {
            format: GRIB,
            wanted_bytes: u64::from(packed).saturating_mul(4),
            found_bytes: to_u64(numbers.len()).saturating_mul(4),
        });
    }
    let all = match field.bitmap {
        None => numbers,
        Some(place) => spread(&section(file, 6, place)?, numbers, field.grid.points())?,
    };
    Ok(field.grid.in_rows(all))
}

fn section(file: &mut File, number: u8, place: Place) -> Result<Section, Problem> {
    const READING: &str = "reading a field";
    file.seek(SeekFrom::Start(place.start))
        .map_err(io(READING))?;
    let mut octets = Vec::new();
    let length = u64::from(place.length);
    file.take(length)
        .read_to_end(&mut octets)
        .map_err(io(READING))?;
    if to_u64(octets.len()) != length {
        return Err(Problem::Size {
            format: GRIB,
            wanted_bytes: length,
            found_bytes: to_u64(octets.len()),
        });
    }
    Ok(Section { number, octets })
}

/// Numbers at the points whose bit is set.
fn spread(bitmap: &Section, numbers: Vec<f32>, points: u64) -> Result<Vec<f32>, Problem> {
    let bits = bitmap.octets.get(6..).unwrap_or(&[]).iter();
    let bits = bits.flat_map(|octet| (0..8).map(move |k| octet << k & 0x80 != 0));
    let points = usize::try_from(points).unwrap_or(usize::MAX);
    let count = bits.clone().take(points).filter(|is_set| *is_set).count();
    if count != numbers.len() {
        let wanted = format!("{} points that have a number", numbers.len());
        return Err(invalid(GRIB, "section 6", wanted, &count.to_string()));
    }
    let mut numbers = numbers.into_iter();
    let at = |is_set| if is_set { numbers.next() } else { None };
    Ok(bits
        .take(points)
        .map(at)
        .map(|n| n.unwrap_or(f32::NAN))
        .collect())
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "rounding to f32 is what is wanted"
)]
fn rounded(number: f64) -> f32 {
    number as f32
}

/// Floats as they are (template 5.4).
fn floats(packing: &Section, data: &Section) -> Vec<f32> {
    let octets = data.octets.get(5..).unwrap_or(&[]);
    if packing.u8(12).is_ok_and(|precision| precision == 1) {
        let numbers = octets.as_chunks::<4>().0.iter();
        numbers.map(|&number| f32::from_be_bytes(number)).collect()
    } else {
        let numbers = octets.as_chunks::<8>().0.iter();
        numbers
            .map(|&number| rounded(f64::from_be_bytes(number)))
            .collect()
    }
}

fn scaled(
    template: u16,
    packing: &Section,
    data: Section,
    packed: u32,
) -> Result<Vec<f32>, Problem> {
    let reference = f64::from(packing.f32(12)?);
    let factor = f64::from(packing.i16(16)?).exp2();
    let power = 10_f64.powi(packing.i16(18)?.saturating_abs());
    // A power of ten with a minus is no f64: dividing by the one without is exact to the last bit.
    let is_division = packing.i16(18)? >= 0;
    let value = |x: f64| {
        let sum = reference + x * factor;
        rounded(if is_division {
            sum / power
        } else {
            sum * power
        })
    };
    let count = usize::try_from(packed).unwrap_or(usize::MAX);
    let is_complex = matches!(template, guard::COMPLEX | guard::DIFFERENCES);
    if packed == 0 || packing.u8(20)? == 0 && !is_complex {
        return Ok(vec![value(0.0); count]);
    }
    let mut packing = packing.clone();
    let payload = data.octets.get(5..).unwrap_or(&[]);
    match template {
        guard::COMPLEX | guard::DIFFERENCES => guard::check_groups(&packing, payload)?,
        guard::JPEG2000 => guard::check_jpeg2000(packed.into(), payload)?,
        guard::PNG => {
            // A picture has whole octets a pixel, also where section 5 counts fewer bits.
            let bits = guard::check_png(packed.into(), payload)?;
            packing.patch(20..21, &[bits]);
        }
        guard::CCSDS => {
            /// Options of CCSDS 121.0-B, as libaec numbers them.
            const SIGNED: u8 = 1;
            const THREE_BYTES: u8 = 2;
            const BIG_ENDIAN: u8 = 4;
            let options = packing.u8(22)?;
            if options & SIGNED != 0 {
                return Err(unsupported(GRIB, "CCSDS packing of signed numbers"));
            }
            // How decoded numbers lie in memory: as the decoder looks for them.
            packing.patch(22..23, &[options | THREE_BYTES | BIG_ENDIAN]);
        }
        _ => {}
    }
    // R, E and D, and the type of the original numbers, which changes nothing.
    packing.patch(12..20, &[0; 8]);
    packing.patch(21..22, &[0]);
    let integers = fenced(GRIB, "section 7", || {
        integers(packing.octets, data.octets, count)
    })?;
    Ok(integers.into_iter().map(|x| value(x.into())).collect())
}

/// The packed integers as the decoder gives them.
fn integers(packing: Vec<u8>, data: Vec<u8>, count: usize) -> Result<Vec<f32>, Problem> {
    let no_bitmap = vec![0, 0, 0, 6, 6, 255];
    let decoder = Grib2SubmessageDecoder::new(count, packing, no_bitmap, data);
    let decoder = decoder.map_err(|error| problem_of(&error))?;
    let numbers = decoder.dispatch().map_err(|error| problem_of(&error))?;
    let mut integers = Vec::new();
    integers
        .try_reserve_exact(count)
        .map_err(|_| Problem::Limit {
            what: "a field".to_owned(),
            wanted_bytes: to_u64(count).saturating_mul(4),
            limit_bytes: 0,
        })?;
    integers.extend(numbers.take(count));
    Ok(integers)
}

fn problem_of(error: &GribError) -> Problem {
    let wanted = "numbers that their packing allows";
    invalid(GRIB, "section 7", wanted, &error.to_string())
}
