//! GRIB edition 2: fields of the weather and the sea, one after the other.
//!
//! WMO Manual on Codes, No. 306, volume I.2, FM 92: a message is section 0 (the letters `GRIB`, its length), then
//! 1 (when and whose), 3 (the grid), 4 (what and at which level), 5 (how numbers are packed), 6 (where there are
//! none), 7 (the numbers) and 8 (`7777`); 2 to 7, 3 to 7 or 4 to 7 repeat for further fields.
//!
//! ```text
//! sections scanned by us -> fields -> grouped into variables [member, time, level, y, x] -> cf
//! value = (R + X 2^E) / 10^D,  X decoded by the crate `grib` behind a fence, for counts that were checked
//! ```
//!
//! Edition 1, and edition 2 in a build without the feature `grib`, are refused with what makes a file that is read.

#[cfg(feature = "grib")]
mod arrays;
#[cfg(feature = "grib")]
mod decode;
#[cfg(feature = "grib")]
mod group;
#[cfg(feature = "grib")]
mod guard;
#[cfg(feature = "grib")]
mod lat_lon;
#[cfg(feature = "grib")]
mod level;
#[cfg(feature = "grib")]
mod noted;
#[cfg(feature = "grib")]
mod parameter;
#[cfg(feature = "grib")]
mod product;
#[cfg(feature = "grib")]
mod scan;
#[cfg(feature = "grib")]
mod section;

use super::place::{first_bytes, open_regular};
use super::problem::{at, invalid, unsupported};
use crate::volume::{Limits, Problem, ReadError, Source, VolumeSelection};
use std::path::Path;

/// The word of errors.
const GRIB: &str = "grib";

/// The letters that a message begins with.
const MAGIC: &[u8] = b"GRIB";

/// True where a file begins with a message.
pub(super) fn recognizes(first: &[u8]) -> bool {
    first.starts_with(MAGIC)
}

/// Opens a variable of a file of edition 2; says of others what makes a file of them that is read.
pub(super) fn open(
    path: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let edition = edition(path).map_err(at(path))?;
    if edition == 2 {
        return open_second(path, wanted, limits);
    }
    Err(at(path)(refusal(edition)))
}

fn edition(path: &Path) -> Result<u8, Problem> {
    let (mut file, _) = open_regular(path)?;
    let first = first_bytes(&mut file, 8)?;
    match (first.starts_with(MAGIC), first.get(7)) {
        (true, Some(edition)) => Ok(*edition),
        _ => {
            let found = String::from_utf8_lossy(&first);
            let wanted = "the letters GRIB and an edition";
            Err(invalid(GRIB, "section 0", wanted, &found))
        }
    }
}

/// Why a message of an edition is not read.
fn refusal(edition: u8) -> Problem {
    match edition {
        1 => unsupported(
            GRIB,
            "edition 1 (a NetCDF file is read: `grib_to_netcdf` or `cdo -f nc copy` makes one)",
        ),
        2 => unsupported(
            GRIB,
            "edition 2 in a build without `--features grib` (a NetCDF file is read: `grib_to_netcdf` or `wgrib2 -netcdf` makes one)",
        ),
        _ => invalid(GRIB, "edition", "1 or 2", &edition.to_string()),
    }
}

#[cfg(not(feature = "grib"))]
fn open_second(path: &Path, _: &VolumeSelection, _: &Limits) -> Result<Box<dyn Source>, ReadError> {
    Err(at(path)(refusal(2)))
}

#[cfg(feature = "grib")]
fn open_second(
    path: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    use crate::format::cf;
    use crate::volume::Format;
    use std::sync::Arc;

    let messages = arrays::Messages::open(path, limits).map_err(at(path))?;
    let messages = Arc::new(messages);
    // How many numbers a section 7 holds was compared with its length: a field of one value has no octets at all.
    let any_length = u64::MAX;
    let source = cf::open(
        Arc::clone(&messages) as _,
        any_length,
        Format::Grib2,
        wanted,
        limits,
    )?;
    Ok(noted::with_notes(source, |name| messages.notes(name)))
}
