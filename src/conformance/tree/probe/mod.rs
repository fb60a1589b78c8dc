//! The parts of a driver that pictures stand on, one by one: filters, formats, blending, the rasterizer, compute, memory.

mod blend;
mod compute;
mod convert;
mod filter;
mod kit;
mod limits;
mod math;
mod memory;
mod raster;

use crate::conformance::case::Case;

/// All of them.
pub fn cases() -> Vec<Case> {
    let mut cases = filter::cases();
    cases.extend(convert::cases());
    cases.extend(math::cases());
    cases.extend(blend::cases());
    cases.extend(raster::cases());
    cases.extend(compute::cases());
    cases.extend(memory::cases());
    cases.extend(limits::cases());
    cases
}
