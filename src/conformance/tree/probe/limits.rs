//! The largest images that a device claims, thin in the other directions so that they fit.

use super::kit;
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::{ImageKind, Use};
use ash::vk;

const EXACT: &str =
    "Texels come back as they were brought: the limit is one that the device claims.";

/// Along each axis of each kind.
pub fn cases() -> Vec<Case> {
    let all = [
        ("2d.width", ImageKind::D2, 0),
        ("2d.height", ImageKind::D2, 1),
        ("2d_array.layers", ImageKind::D2Array, 2),
        ("3d.width", ImageKind::D3, 0),
        ("3d.height", ImageKind::D3, 1),
        ("3d.depth", ImageKind::D3, 2),
    ];
    let case = |(word, kind, axis): (&str, ImageKind, usize)| {
        Case::new(format!("probe.limits.image_{word}"), move |bed| {
            measure(bed, kind, axis)
        })
    };
    all.map(case).into()
}

fn measure(bed: &mut TestBed, kind: ImageKind, axis: usize) -> Result<Measurement, Stop> {
    let mut random = bed.random("limits");
    let device = bed.device()?;
    let limits = *device.gpu().limits();
    let most = match (kind, axis) {
        (ImageKind::D3, _) => limits.max_image_dimension_3d,
        (_, 2) => limits.max_image_array_layers,
        _ => limits.max_image_dimension_2d,
    };
    let mut extent = [1; 3];
    extent[axis] = most;
    if kind != ImageKind::D2 {
        // Two texels across the others, so that they are told apart.
        extent[(axis + 1) % 3] = 2;
    }
    let count = extent.iter().product::<u32>() as usize;
    let texels: Vec<u8> = (0..4 * count).map(|_| random.below(128) as u8).collect();
    let made = kit::image(device, kind, extent, vk::Format::R32_SFLOAT, &texels)?;
    let found = kit::texels(device, &made, Use::Sampled)?;
    let bound = Bound::new("exact", EXACT).with("texels", most.into());
    let mut measurement = Measurement::new(bound, texels.len());
    for (i, (&wanted, found)) in texels.iter().zip(found).enumerate() {
        measurement.take(|| format!("byte {i}"), wanted.into(), found.into(), 0.0);
    }
    Ok(measurement)
}
