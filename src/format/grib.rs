//! GRIB, recognized and refused by its edition: no reader of it is here yet.
//!
//! WMO Manual on Codes, No. 306, volume I.2: section 0 begins with the letters `GRIB`; its eighth octet is the
//! number of the edition, in both of them.

use super::place::{first_bytes, open_regular};
use super::problem::{at, invalid, unsupported};
use crate::volume::{Limits, Problem, ReadError, Source, Wanted};
use std::path::Path;

/// The word of errors.
const GRIB: &str = "grib";

/// The letters that a message begins with.
const MAGIC: &[u8] = b"GRIB";

/// True where a file begins with a message.
pub(super) fn recognizes(first: &[u8]) -> bool {
    first.starts_with(MAGIC)
}

/// Says which edition it is and what makes a file of it that is read.
pub(super) fn open(
    path: &Path,
    _wanted: &Wanted,
    _limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    Err(at(path)(refusal(path)))
}

fn refusal(path: &Path) -> Problem {
    let first = open_regular(path).and_then(|(mut file, _)| first_bytes(&mut file, 8));
    let first = match first {
        Ok(first) => first,
        Err(problem) => return problem,
    };
    match (first.starts_with(MAGIC), first.get(7)) {
        (true, Some(edition @ (1 | 2))) => {
            let convert = match edition {
                1 => "`grib_to_netcdf` or `cdo -f nc copy`",
                _ => "`grib_to_netcdf` or `wgrib2 -netcdf`",
            };
            unsupported(
                GRIB,
                format!("edition {edition} (a NetCDF file is read: {convert} makes one)"),
            )
        }
        (true, Some(edition)) => invalid(GRIB, "edition", "1 or 2", &edition.to_string()),
        _ => {
            let found = String::from_utf8_lossy(&first);
            invalid(GRIB, "section 0", "the letters GRIB and an edition", &found)
        }
    }
}
