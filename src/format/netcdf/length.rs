//! How long a classic file has to be: as its header says of all variables, not only of the one that is read.
//!
//! A variable without the record dimension ends at `begin + size`. Records lie one after another, in each a slab
//! of every variable; the last slab of the last record ends at `begin + (records - 1) x record bytes + slab bytes`.
//! The zeros that round a slab up to four bytes may be missing at the end of a file.
//! By the NetCDF file format specification, docs.unidata.ucar.edu/netcdf-c, appendix B.

use super::NETCDF;
use crate::volume::Problem;
use netcdf_reader::{NcFormat, NcVariable};

/// Refuses a file that ends before its variables do.
pub(super) fn check(
    format: NcFormat,
    variables: &[NcVariable],
    file_bytes: u64,
) -> Result<(), Problem> {
    if !matches!(
        format,
        NcFormat::Classic | NcFormat::Offset64 | NcFormat::Cdf5
    ) {
        return Ok(());
    }
    let record_bytes = record_bytes(variables);
    let ends = variables.iter().map(|variable| end(variable, record_bytes));
    let wanted_bytes = ends.max().unwrap_or(0);
    if wanted_bytes > file_bytes {
        return Err(Problem::Size {
            format: NETCDF,
            wanted_bytes,
            found_bytes: file_bytes,
        });
    }
    Ok(())
}

/// Bytes of one record of all variables: slabs are rounded up to four bytes, but not where there is one only.
fn record_bytes(variables: &[NcVariable]) -> u64 {
    let mut slabs = variables
        .iter()
        .filter(|variable| variable.is_record_var)
        .map(|variable| variable.record_size);
    match (slabs.next(), slabs.next()) {
        (Some(only), None) => only,
        (first, second) => first
            .into_iter()
            .chain(second)
            .chain(slabs)
            .map(|bytes| bytes.checked_next_multiple_of(4).unwrap_or(u64::MAX))
            .fold(0, u64::saturating_add),
    }
}

/// The byte behind the last number of a variable; 0 where it has none. What does not fit into 64 bits is in no file.
fn end(variable: &NcVariable, record_bytes: u64) -> u64 {
    let count = variable
        .dimensions
        .iter()
        .map(|dimension| dimension.size)
        .fold(1, u64::saturating_mul);
    if variable
        .dimensions
        .iter()
        .any(|dimension| dimension.size == 0)
    {
        return 0;
    }
    let size = if variable.is_record_var {
        let records = variable.dimensions.first().map_or(0, |first| first.size);
        record_bytes
            .saturating_mul(records.saturating_sub(1))
            .saturating_add(variable.record_size)
    } else {
        let number_bytes = variable.dtype.size().unwrap_or(0);
        count.saturating_mul(u64::try_from(number_bytes).unwrap_or(u64::MAX))
    };
    variable.data_offset.saturating_add(size)
}
