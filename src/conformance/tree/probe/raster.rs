//! The rasterizer: which pixels a triangle covers. Slices are drawn by it, and may neither miss a pixel nor have it
//! twice.

use super::kit::{self, Drawing};
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::{Blend, Item};
use ash::vk;

const EDGES: &str = "Triangles that share an edge cover each pixel centre once (Vulkan specification, basic polygon rasterization: \
a sample on an edge of two polygons belongs to just one of them): ones that are added up are 1 everywhere, exactly.";
const COVER: &str = "Corners lie at whole pixels, which every device has exactly (sub-pixel bits are 4 or more): the centres inside are \
covered and no others, however the corners go round.";

/// Shared edges, and rectangles of both windings.
pub fn cases() -> Vec<Case> {
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let color = vk::FormatFeatureFlags::COLOR_ATTACHMENT;
    let blend = color | vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
    let mut cases = Vec::new();
    for nth in 0..4u32 {
        let name = format!("probe.raster.shared_edges.{nth}");
        let seeded = name.clone();
        let case = Case::new(name, move |bed| shared_edges(bed, &seeded));
        cases.push(case.needing(Item::Format(format, blend)));
    }
    for (word, is_clockwise) in [("clockwise", true), ("counter_clockwise", false)] {
        let case = Case::new(format!("probe.raster.cover.{word}"), move |bed| {
            cover(bed, is_clockwise)
        });
        cases.push(case.needing(Item::Format(format, color)));
    }
    cases
}

const EXTENT: [u32; 2] = [64, 48];

fn ndc([x, y]: [f64; 2]) -> [f32; 4] {
    let [w, h] = EXTENT.map(f64::from);
    [
        (2.0 * x / w - 1.0) as f32,
        (2.0 * y / h - 1.0) as f32,
        0.5,
        1.0,
    ]
}

/// A grid whose inner corners are moved, each cell cut along either diagonal, either way round.
fn shared_edges(bed: &mut TestBed, name: &str) -> Result<Measurement, Stop> {
    const CELLS: [usize; 2] = [9, 7];
    let mut random = bed.random(name);
    let [w, h] = EXTENT.map(f64::from);
    let mut corner = Vec::new();
    for j in 0..=CELLS[1] {
        for i in 0..=CELLS[0] {
            let mut at = [
                w * i as f64 / CELLS[0] as f64,
                h * j as f64 / CELLS[1] as f64,
            ];
            if (1..CELLS[0]).contains(&i) && (1..CELLS[1]).contains(&j) {
                at[0] += 4.0 * random.unit() - 2.0;
                at[1] += 4.0 * random.unit() - 2.0;
            }
            corner.push(ndc(at));
        }
    }
    let mut corners = Vec::new();
    for j in 0..CELLS[1] {
        for i in 0..CELLS[0] {
            let at = |di: usize, dj: usize| corner[(j + dj) * (CELLS[0] + 1) + i + di];
            let [a, b, c, d] = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
            let mut both = match random.below(2) {
                0 => [[a, b, c], [a, c, d]],
                _ => [[b, c, d], [b, d, a]],
            };
            for triangle in &mut both {
                if random.below(2) == 0 {
                    triangle.swap(0, 1);
                }
                corners.extend(*triangle);
            }
        }
    }
    let texels = kit::draw(bed, &drawing(&corners, Blend::Add))?;
    let mut measurement = Measurement::new(Bound::new("shared-edges", EDGES), 1000);
    for i in 0..texels.len() / 4 {
        let found = kit::number(vk::Format::R32G32B32A32_SFLOAT, &texels, i);
        measurement.take(|| at(i), 1.0, found, 0.0);
    }
    Ok(measurement)
}

fn cover(bed: &mut TestBed, is_clockwise: bool) -> Result<Measurement, Stop> {
    const INSIDE: [[f64; 2]; 2] = [[5.0, 9.0], [51.0, 40.0]];
    let [[x0, y0], [x1, y1]] = INSIDE;
    let [a, b, c, d] = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(ndc);
    let corners = match is_clockwise {
        true => [a, b, c, a, c, d],
        false => [a, c, b, a, d, c],
    };
    let texels = kit::draw(bed, &drawing(&corners, Blend::Replace))?;
    let mut measurement = Measurement::new(Bound::new("cover", COVER), 1000);
    for i in 0..texels.len() / 4 {
        let pixel = i / 4;
        let [x, y] =
            [pixel % EXTENT[0] as usize, pixel / EXTENT[0] as usize].map(|n| n as f64 + 0.5);
        let is_inside = (x0..x1).contains(&x) && (y0..y1).contains(&y);
        let found = kit::number(vk::Format::R32G32B32A32_SFLOAT, &texels, i);
        let wanted = f64::from(u8::from(is_inside));
        measurement.take(|| at(i), wanted, found, 0.0);
    }
    Ok(measurement)
}

fn drawing(corners: &[[f32; 4]], blend: Blend) -> Drawing<'_> {
    Drawing {
        format: vk::Format::R32G32B32A32_SFLOAT,
        extent: EXTENT,
        clear: [0.0; 4],
        blend,
        corners,
        colors: &[[1.0; 4]],
        instances: 1,
    }
}

fn at(i: usize) -> String {
    let pixel = i / 4;
    let width = EXTENT[0] as usize;
    format!(
        "channel {} of pixel [{}, {}]",
        i % 4,
        pixel % width,
        pixel / width
    )
}
