//! What is asked of a source, compared with its header before anything is allocated.

use super::convert::{bytes_in_memory, to_u64};
use crate::volume::{Header, Problem, TimeComponent, VoxelBox};

/// How many voxels `region` has, if `pick` and `region` lie inside the header and `max_bytes` hold them in memory.
pub(crate) fn wanted_count(
    format: &'static str,
    header: &Header,
    pick: TimeComponent,
    region: VoxelBox,
    max_bytes: u64,
) -> Result<usize, Problem> {
    check(format, header, pick, region)?;
    let count = (0..3).try_fold(1_u64, |product, k| {
        let side = region.max.get(k)?.checked_sub(*region.min.get(k)?)?;
        product.checked_mul(side.into())
    });
    let wanted_bytes = count
        .and_then(|count| count.checked_mul(to_u64(bytes_in_memory(header.stored))))
        .unwrap_or(u64::MAX);
    count
        .filter(|_| wanted_bytes <= max_bytes)
        .and_then(|count| usize::try_from(count).ok())
        .ok_or(Problem::Limit {
            what: "the volume".to_owned(),
            wanted_bytes,
            limit_bytes: max_bytes,
        })
}

fn check(
    format: &'static str,
    header: &Header,
    pick: TimeComponent,
    region: VoxelBox,
) -> Result<(), Problem> {
    let wrong = |field: &str, wanted: String, found: String| {
        Err(Problem::Invalid {
            format,
            field: field.to_owned(),
            wanted,
            found,
        })
    };
    if pick.time >= header.times {
        let wanted = format!("a time below {}", header.times);
        return wrong("time", wanted, pick.time.to_string());
    }
    if pick.component >= header.components {
        let wanted = format!("a component below {}", header.components);
        return wrong("component", wanted, pick.component.to_string());
    }
    let inside = region
        .min
        .iter()
        .zip(&region.max)
        .zip(&header.dims)
        .all(|((min, max), size)| min < max && max <= size);
    if !inside {
        let wanted = format!("a box inside {:?} that is not empty", header.dims);
        let found = format!("{:?} to {:?}", region.min, region.max);
        return wrong("box", wanted, found);
    }
    Ok(())
}
