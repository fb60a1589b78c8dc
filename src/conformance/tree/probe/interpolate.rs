//! Numbers of corners across polygons, as the proxies of slices have them: with perspective, without, and not at all.
//!
//! ```text
//! perspective   sum w (q / W) / sum w / W        linear   sum w q        flat   q of the first corner        1 / W   sum w / W
//! w the weights on the screen, W the fourth coordinate of a corner
//! ```

use super::kit;
use super::plane::{self, DEMANDED, OPERATIONS, SINGLE, Triangle};
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::Item;
use ash::vk;

const DERIVATION: &str = "Vulkan specification, basic polygon rasterization: the formulas are given. Corners lie on a grid of \
subPixelPrecisionBits b, so each may be a step of 2^-b (and three operations of the viewport) from where it was asked for; displaced \
corners give the number of the true triangle at a place as near, so the result lies between the extremes around the pixel's centre. \
Computation outside of shaders is right to 1 part in 10^5 an operation, some 14 for each number that is interpolated, of the sum of all \
sizes that are added up: outside of that fails. 32-bit floats round 2^-24 an operation: outside of that is a warning. What is flat is \
the first corner's number, exactly. Pixels whose centre is displaced beyond the triangle are left out.";

const COARSE: &str = "interpolation is coarser than 32-bit floats are";

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const EXTENT: [u32; 2] = [64, 48];

/// One a way of interpolating and a mesh.
pub fn cases() -> Vec<Case> {
    let color = vk::FormatFeatureFlags::COLOR_ATTACHMENT;
    let mut cases = Vec::new();
    for (channel, word) in ["perspective", "linear", "flat", "inverse_w"]
        .into_iter()
        .enumerate()
    {
        for nth in 0..4u32 {
            let name = format!("probe.interpolate.{word}.{nth}");
            let case = Case::new(name, move |bed| measure(bed, channel, nth));
            cases.push(case.needing(Item::Format(FORMAT, color)));
        }
    }
    cases
}

/// A triangle on the screen with W and numbers at its corners.
struct Drawn {
    on_screen: Triangle,
    w: [f64; 3],
    q: [f64; 3],
}

fn measure(bed: &mut TestBed, channel: usize, nth: u32) -> Result<Measurement, Stop> {
    let size = EXTENT.map(f64::from);
    let mut random = bed.random(&format!("interpolate.{nth}"));
    let mut single = |low: f64, high: f64| f64::from((low + (high - low) * random.unit()) as f32);
    let mut all = Vec::new();
    let mut seeded = bed.random(&format!("interpolate.mesh.{nth}"));
    for on_screen in plane::mesh(&mut seeded, size) {
        all.push(Drawn {
            on_screen,
            w: [0; 3].map(|_| single(0.5, 4.0)),
            q: [0; 3].map(|_| single(-1.0, 1.0)),
        });
    }
    let mut corners = Vec::new();
    let mut numbers = Vec::new();
    for drawn in &all {
        for i in 0..3 {
            let w = drawn.w[i];
            let [x, y] = [0, 1].map(|k| 2.0 * drawn.on_screen.0[i][k] / size[k] - 1.0);
            corners.push([x * w, y * w, 0.5 * w, w].map(|n| n as f32));
            numbers.push([drawn.q[i] as f32, 0.0, 0.0, 0.0]);
        }
    }
    let shaders = ["probe/varyings", "probe/varied"];
    let given = [("corners", &corners[..]), ("numbers", &numbers[..])];
    let texels = kit::draw_with(bed, shaders, FORMAT, EXTENT, &given)?;
    let gpu = bed.device()?.gpu();
    let displaced = plane::displacement(gpu, size[0]);
    let bits = plane::sub_pixel_bits(gpu);
    let bound = Bound::new("interpolation", DERIVATION).with("subPixelPrecisionBits", bits.into());
    let mut measurement = Measurement::new(bound, 2500);
    for pixel in 0..(EXTENT[0] * EXTENT[1]) as usize {
        let [x, y] = [pixel % EXTENT[0] as usize, pixel / EXTENT[0] as usize];
        let centre = [x, y].map(|n| n as f64 + 0.5);
        let is_over = |drawn: &&Drawn| drawn.on_screen.depth_inside(centre) > 2.0 * displaced;
        let Some(drawn) = all.iter().find(is_over) else {
            measurement.leave_out(1);
            continue;
        };
        let found = kit::number(FORMAT, &texels, 4 * pixel + channel);
        let at = || format!("pixel [{x}, {y}]");
        if channel == 2 {
            measurement.take(at, drawn.q[0], found, 0.0);
            continue;
        }
        let places = plane::around(centre, displaced);
        let values = places.map(|p| drawn.at(channel, p));
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let off = drawn.roundings(channel, centre, values[0]);
        measurement.take_in(at, [low, high], found, DEMANDED * off);
        let half = 0.5 * (high - low) + SINGLE * off;
        measurement.prefer(COARSE, at, 0.5 * (low + high), found, half);
    }
    Ok(measurement)
}

impl Drawn {
    fn inverse(&self) -> [f64; 3] {
        self.w.map(|w| 1.0 / w)
    }

    fn over_w(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| self.q[i] / self.w[i])
    }

    fn at(&self, channel: usize, p: [f64; 2]) -> f64 {
        match channel {
            0 => self.on_screen.at(self.over_w(), p) / self.on_screen.at(self.inverse(), p),
            1 => self.on_screen.at(self.q, p),
            _ => self.on_screen.at(self.inverse(), p),
        }
    }

    /// What a number may be off by, in units of what one operation is off by. The division adds four.
    fn roundings(&self, channel: usize, p: [f64; 2], value: f64) -> f64 {
        let size = EXTENT.map(f64::from);
        let of = |q: [f64; 3]| OPERATIONS * self.on_screen.size(q, size);
        match channel {
            0 => {
                let below = self.on_screen.at(self.inverse(), p);
                let both = of(self.over_w()) + value.abs() * of(self.inverse());
                1.01 * both / below + 4.0 * value.abs()
            }
            1 => of(self.q),
            _ => of(self.inverse()) + 4.0 * value.abs(),
        }
    }
}
