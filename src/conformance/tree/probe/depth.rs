//! Depth: what is kept, what is compared, and planes across polygons. Opaque things and slices meet by it.
//!
//! ```text
//! UNORM of b bits   one of the two codes around z (2^b - 1)        SFLOAT   z        z = near + (far - near) z of the viewport
//! ```

use super::depth_draw::{Drawn, FORMATS, Kept, Picture, Source, WIDTH, draw};
use super::plane::{self, DEMANDED, OPERATIONS, SINGLE};
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::Item;
use ash::vk;

const KEPT: &str = "Vulkan specification, fixed-point data conversions: a depth of b bits is one of the two codes around \
z (2^b - 1), an integer itself where that is one; that it is not the nearer one is a warning. A depth of 32-bit floats is the number.";
const COMPARED: &str = "Vulkan specification, depth test: the fragment's depth, brought to the format, is compared with what is there. \
Both candidates of its conversion are tried: where they answer differently the pixel is left out. Where the test passes, colour and \
depth are the fragment's, elsewhere all stays, exactly.";
const ORDER: &str = "Rectangles of one depth each, farther apart than four codes of the format and than 12 x 10^-5 (what the \
interpolation of equal depths may be off by): the nearest is seen, and its colour is exact.";
const PLANES: &str = "Vulkan specification, depth: it is linear on the screen, and the viewport's. Displaced corners (a step of \
2^-subPixelPrecisionBits) give the depth of a place as near; 14 operations of 1 part in 10^5 (32-bit floats: 2^-24, farther is a warning) \
of the sum of all sizes, two more for the viewport, and a code of the format. Pixels near an edge are left out.";
const CUT: &str = "Vulkan specification, primitive clipping: what lies nearer than 0 or farther than 1 in clip space is not drawn. Pixels \
whose depth is nearer to either than the bound of planes are left out.";
const COARSE: &str = "depth is coarser than 32-bit floats or is not the nearest code";

/// What f64 rounds where a code at the end of a range is compared: far less than a code of 24 bits.
const ROUNDED: f64 = 1e-12;

const OPERATORS: [(&str, vk::CompareOp); 8] = [
    ("never", vk::CompareOp::NEVER),
    ("less", vk::CompareOp::LESS),
    ("equal", vk::CompareOp::EQUAL),
    ("less_or_equal", vk::CompareOp::LESS_OR_EQUAL),
    ("greater", vk::CompareOp::GREATER),
    ("not_equal", vk::CompareOp::NOT_EQUAL),
    ("greater_or_equal", vk::CompareOp::GREATER_OR_EQUAL),
    ("always", vk::CompareOp::ALWAYS),
];

/// Formats, operators, viewports.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for kept in FORMATS {
        let word = kept.word;
        let mut add = |name: String, run: Box<Run>| {
            let depth = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT;
            let color = vk::FormatFeatureFlags::COLOR_ATTACHMENT;
            let target = Item::Format(vk::Format::R32G32B32A32_SFLOAT, color);
            let case = Case::new(name, run).needing(Item::Format(kept.format, depth));
            cases.push(case.needing(target));
        };
        add(
            format!("probe.depth.clear.{word}"),
            Box::new(move |bed| cleared(bed, kept)),
        );
        add(
            format!("probe.depth.write.{word}"),
            Box::new(move |bed| written(bed, kept)),
        );
        for (operator, compare) in OPERATORS {
            for writes in [true, false] {
                let end = if writes { "" } else { ".unwritten" };
                add(
                    format!("probe.depth.compare.{operator}.{word}{end}"),
                    Box::new(move |bed| compared(bed, kept, compare, writes)),
                );
            }
        }
        for (order, is_reversed) in [("nearest_is_0", false), ("nearest_is_1", true)] {
            add(
                format!("probe.depth.order.{order}.{word}"),
                Box::new(move |bed| ordered(bed, kept, is_reversed)),
            );
        }
        for (viewport, range) in [
            ("whole", [0.0, 1.0]),
            ("part", [0.25, 0.625]),
            ("reversed", [1.0, 0.0]),
        ] {
            add(
                format!("probe.depth.plane.{viewport}.{word}"),
                Box::new(move |bed| planes(bed, kept, range)),
            );
        }
        add(
            format!("probe.depth.cut.{word}"),
            Box::new(move |bed| cut(bed, kept)),
        );
    }
    cases
}

type Run = dyn Fn(&mut TestBed) -> Result<Measurement, Stop> + Send + Sync;

/// A triangle that covers everything.
const COVER: [[f32; 4]; 3] = [
    [-1.0, -1.0, 0.5, 1.0],
    [3.0, -1.0, 0.5, 1.0],
    [-1.0, 3.0, 0.5, 1.0],
];

fn picture(kept: Kept, height: u32, corners: &[[f32; 4]]) -> Picture<'_> {
    Picture {
        kept,
        height,
        before: Source::Clear(0.0),
        corners,
        colors: &[[1.0; 4]],
        depths: None,
        compare: vk::CompareOp::ALWAYS,
        writes: true,
        range: [0.0, 1.0],
    }
}

/// One depth of a host's against what is kept of it.
fn keep(measurement: &mut Measurement, kept: Kept, at: impl Fn() -> String, z: f64, found: f64) {
    let [low, high] = kept.candidates(z);
    measurement.take_in(&at, [low, high], found, ROUNDED);
    if let Some(most) = kept.most {
        // A product in 32-bit floats may come out at either side of the middle of two codes.
        let nearest = 0.5 / most + 2.0 * SINGLE * z;
        measurement.prefer(COARSE, at, z, found, nearest);
    }
}

fn cleared(bed: &mut TestBed, kept: Kept) -> Result<Measurement, Stop> {
    let mut random = bed.random("depth.clear");
    let mut measurement = Measurement::new(Bound::new("depth-kept", KEPT), 500);
    for z in [
        0.0,
        1.0,
        0.5,
        0.75,
        random.unit(),
        random.unit(),
        1e-3,
        0.999,
    ] {
        let z = z as f32;
        let before = Source::Clear(z);
        // What is drawn lies outside of the picture.
        let corners = COVER.map(|[x, y, z, w]| [x + 8.0, y, z, w]);
        let asked = Picture {
            before,
            ..picture(kept, 4, &corners)
        };
        for (i, found) in draw(bed, &asked)?.depths.into_iter().enumerate() {
            let at = || format!("{z} at pixel {i}");
            keep(&mut measurement, kept, at, z.into(), found);
        }
    }
    Ok(measurement)
}

fn written(bed: &mut TestBed, kept: Kept) -> Result<Measurement, Stop> {
    let mut random = bed.random("depth.write");
    let mut depths: Vec<f32> = (0..WIDTH * 16).map(|_| random.unit() as f32).collect();
    depths[..4].copy_from_slice(&[0.0, 1.0, 0.5, 0.25]);
    let asked = Picture {
        depths: Some(&depths),
        ..picture(kept, 16, &COVER)
    };
    let mut measurement = Measurement::new(Bound::new("depth-kept", KEPT), depths.len());
    let found = draw(bed, &asked)?.depths;
    for (&z, found) in depths.iter().zip(found) {
        keep(&mut measurement, kept, || format!("{z}"), z.into(), found);
    }
    Ok(measurement)
}

fn compared(
    bed: &mut TestBed,
    kept: Kept,
    compare: vk::CompareOp,
    writes: bool,
) -> Result<Measurement, Stop> {
    let mut random = bed.random("depth.compare");
    let mut before = Vec::new();
    let mut depths = Vec::new();
    for i in 0..WIDTH * 16 {
        // Depths that every format has exactly, and equal ones; then any.
        let is_end = i % 4 == 0;
        let there = match is_end && kept.most.is_some() {
            true => (i / 4 % 2) as f64,
            false => kept.stored(random.unit()),
        };
        let there = there as f32;
        before.push(there);
        depths.push(match i % 4 {
            0 => there,
            1 if there > 0.5 => there - 0.25,
            2 => (there + 0.25 * random.unit() as f32).min(1.0),
            _ => (there - 0.25 * random.unit() as f32).max(0.0),
        });
    }
    let asked = Picture {
        before: Source::Copied(&before),
        depths: Some(&depths),
        compare,
        writes,
        ..picture(kept, 16, &COVER)
    };
    let Drawn {
        colors,
        depths: found,
    } = draw(bed, &asked)?;
    let mut measurement = Measurement::new(Bound::new("depth-compared", COMPARED), 1000);
    for (i, (&there, &new)) in before.iter().zip(&depths).enumerate() {
        let there = kept.stored(there.into());
        let candidates = kept.candidates(new.into());
        let answers = candidates.map(|new| passes(compare, new, there));
        if answers[0] != answers[1] {
            measurement.leave_out(1);
            continue;
        }
        let at = || format!("{new} against {there} at pixel {i}");
        let is_drawn = f64::from(u8::from(answers[0]));
        measurement.take(at, is_drawn, colors[i].into(), 0.0);
        match answers[0] && writes {
            true => measurement.take_in(at, candidates, found[i], ROUNDED),
            false => measurement.take(at, there, found[i], 0.0),
        }
    }
    Ok(measurement)
}

fn passes(compare: vk::CompareOp, new: f64, there: f64) -> bool {
    match compare {
        vk::CompareOp::LESS => new < there,
        vk::CompareOp::EQUAL => new == there,
        vk::CompareOp::LESS_OR_EQUAL => new <= there,
        vk::CompareOp::GREATER => new > there,
        vk::CompareOp::NOT_EQUAL => new != there,
        vk::CompareOp::GREATER_OR_EQUAL => new >= there,
        vk::CompareOp::ALWAYS => true,
        _ => false,
    }
}

fn ordered(bed: &mut TestBed, kept: Kept, is_reversed: bool) -> Result<Measurement, Stop> {
    const LAYERS: usize = 64;
    let mut random = bed.random("depth.order");
    let mut order: Vec<usize> = (0..LAYERS).collect();
    for i in (1..LAYERS).rev() {
        order.swap(i, random.below(i as u32 + 1) as usize);
    }
    let mut rectangles = Vec::new();
    let mut corners = Vec::new();
    let mut colors = Vec::new();
    for &layer in &order {
        let z = (layer as f64 + 0.5) / LAYERS as f64;
        let [x0, y0] = [random.below(WIDTH as u32 - 8), random.below(12)];
        let [x1, y1] = [x0 + 4 + random.below(WIDTH as u32 - x0 - 4), y0 + 4];
        rectangles.push([x0, y0, x1, y1]);
        let at = |x: u32, y: u32| {
            let [x, y] = [f64::from(x) / WIDTH as f64, f64::from(y) / 16.0];
            [2.0 * x - 1.0, 2.0 * y - 1.0, z, 1.0].map(|n| n as f32)
        };
        let [a, b, c, d] = [at(x0, y0), at(x1, y0), at(x1, y1), at(x0, y1)];
        corners.extend([a, b, c, a, c, d]);
        let color = [1.0 + layer as f32, 0.0, 0.0, 1.0];
        colors.extend([color; 2]);
    }
    let asked = Picture {
        before: Source::Clear(if is_reversed { 0.0 } else { 1.0 }),
        colors: &colors,
        compare: match is_reversed {
            true => vk::CompareOp::GREATER,
            false => vk::CompareOp::LESS,
        },
        ..picture(kept, 16, &corners)
    };
    let found = draw(bed, &asked)?.colors;
    let mut measurement = Measurement::new(Bound::new("depth-order", ORDER), 1000);
    for (i, found) in found.into_iter().enumerate() {
        let [x, y] = [(i % WIDTH) as u32, (i / WIDTH) as u32];
        let is_over =
            |[x0, y0, x1, y1]: &[u32; 4]| (*x0..*x1).contains(&x) && (*y0..*y1).contains(&y);
        let over = rectangles.iter().zip(&order).filter(|(r, _)| is_over(r));
        let layers = over.map(|(_, &layer)| layer);
        let seen = if is_reversed {
            layers.max()
        } else {
            layers.min()
        };
        let wanted = seen.map_or(0.0, |layer| 1.0 + layer as f64);
        measurement.take(|| format!("pixel [{x}, {y}]"), wanted, found.into(), 0.0);
    }
    Ok(measurement)
}

/// Triangles with depths at their corners, and the corners in clip space.
type Sloped = (Vec<(plane::Triangle, [f64; 3])>, Vec<[f32; 4]>);

/// A mesh with depths at its corners.
fn sloped(bed: &mut TestBed, name: &str, height: u32, [low, high]: [f64; 2]) -> Sloped {
    let mut random = bed.random(name);
    let size = [WIDTH as f64, f64::from(height)];
    let mut corners = Vec::new();
    let mut all = Vec::new();
    for triangle in plane::mesh(&mut random, size) {
        let z = [0; 3].map(|_| f64::from((low + (high - low) * random.unit()) as f32));
        for (corner, z) in triangle.0.iter().zip(z) {
            let [x, y] = [0, 1].map(|k| 2.0 * corner[k] / size[k] - 1.0);
            corners.push([x, y, z, 1.0].map(|n| n as f32));
        }
        all.push((triangle, z));
    }
    (all, corners)
}

fn planes(bed: &mut TestBed, kept: Kept, range: [f32; 2]) -> Result<Measurement, Stop> {
    const HEIGHT: u32 = 48;
    let (all, corners) = sloped(bed, "depth.plane", HEIGHT, [0.0, 1.0]);
    let asked = Picture {
        range,
        ..picture(kept, HEIGHT, &corners)
    };
    let found = draw(bed, &asked)?.depths;
    let gpu = bed.device()?.gpu();
    let size = [WIDTH as f64, f64::from(HEIGHT)];
    let displaced = plane::displacement(gpu, size[0]);
    let bits = plane::sub_pixel_bits(gpu);
    let bound = Bound::new("depth-planes", PLANES).with("subPixelPrecisionBits", bits.into());
    let mut measurement = Measurement::new(bound, 2500);
    let [near, far] = range.map(f64::from);
    for (i, found) in found.into_iter().enumerate() {
        let [x, y] = [i % WIDTH, i / WIDTH];
        let centre = [x, y].map(|n| n as f64 + 0.5);
        let is_over = |t: &&(plane::Triangle, _)| t.0.depth_inside(centre) > 2.0 * displaced;
        let Some((triangle, z)) = all.iter().find(is_over) else {
            measurement.leave_out(1);
            continue;
        };
        let values =
            plane::around(centre, displaced).map(|p| near + (far - near) * triangle.at(*z, p));
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let off = OPERATIONS * triangle.size(*z, size) + 2.0;
        let code = kept.most.map_or(0.0, |most| 1.0 / most);
        let at = || format!("pixel [{x}, {y}]");
        measurement.take_in(at, [low, high], found, DEMANDED * off + code);
        let half = 0.5 * (high - low) + SINGLE * off + code;
        measurement.prefer(COARSE, at, 0.5 * (low + high), found, half);
    }
    Ok(measurement)
}

fn cut(bed: &mut TestBed, kept: Kept) -> Result<Measurement, Stop> {
    const HEIGHT: u32 = 48;
    let (all, corners) = sloped(bed, "depth.cut", HEIGHT, [-1.0, 2.0]);
    let found = draw(bed, &picture(kept, HEIGHT, &corners))?.colors;
    let size = [WIDTH as f64, f64::from(HEIGHT)];
    let displaced = plane::displacement(bed.device()?.gpu(), size[0]);
    let mut measurement = Measurement::new(Bound::new("depth-cut", CUT), 2500);
    for (i, found) in found.into_iter().enumerate() {
        let [x, y] = [i % WIDTH, i / WIDTH];
        let centre = [x, y].map(|n| n as f64 + 0.5);
        let is_over = |t: &&(plane::Triangle, _)| t.0.depth_inside(centre) > 2.0 * displaced;
        let Some((triangle, z)) = all.iter().find(is_over) else {
            measurement.leave_out(1);
            continue;
        };
        let off = DEMANDED * (OPERATIONS * triangle.size(*z, size) + 2.0);
        // Where a polygon is cut, it has new corners, which are displaced as well.
        let is_inside = plane::around(centre, 2.0 * displaced).map(|p| {
            let z = triangle.at(*z, p);
            match z {
                z if z > off && z < 1.0 - off => Some(true),
                z if z < -off || z > 1.0 + off => Some(false),
                _ => None,
            }
        });
        match is_inside[0] {
            Some(inside) if is_inside.iter().all(|other| *other == Some(inside)) => {
                let wanted = f64::from(u8::from(inside));
                measurement.take(|| format!("pixel [{x}, {y}]"), wanted, found.into(), 0.0);
            }
            _ => measurement.leave_out(1),
        }
    }
    Ok(measurement)
}
