//! The parts of a driver that pictures stand on, one by one: filters, formats, blending, the rasterizer, depth,
//! compute, memory, order.

mod alias;
mod beyond;
mod blend;
mod compute;
mod convert;
mod depth;
mod depth_draw;
mod filter;
mod fits;
mod interpolate;
mod kit;
mod large;
mod limits;
mod math;
mod plane;
mod raster;
mod raw;
mod relay;
mod robust;
mod sparse;
mod store;
mod timeline;

use crate::conformance::case::Case;

/// All of them.
pub fn cases() -> Vec<Case> {
    let mut cases = filter::cases();
    cases.extend(convert::cases());
    cases.extend(store::cases());
    cases.extend(math::cases());
    cases.extend(blend::cases());
    cases.extend(raster::cases());
    cases.extend(interpolate::cases());
    cases.extend(depth::cases());
    cases.extend(compute::cases());
    cases.extend(relay::cases());
    cases.extend(timeline::cases());
    cases.extend(alias::cases());
    cases.extend(robust::cases());
    cases.extend(limits::cases());
    cases.extend(large::cases());
    cases.extend(sparse::cases());
    cases.extend(beyond::cases());
    cases
}
