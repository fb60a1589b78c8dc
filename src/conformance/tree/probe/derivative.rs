//! Differences between neighbouring pixels, along an edge too: pixels of a quad that no triangle covers are run for
//! them.

use super::kit;
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::stand::Stand;
use crate::gpu::Item;
use ash::vk;

const DERIVATION: &str = "Vulkan specification, shader execution and helper invocations: a derivative is the difference of two of the four \
invocations of a quad, and invocations that cover no pixel of a triangle run the same shader; what they store has no effect, what they \
load is as for others. Pixel centres times powers of two, their sums and differences are numbers of f32: exact.";

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const EXTENT: [u32; 2] = [64, 48];
/// What a pixel to the right and one down add; the shader has the same.
const STEPS: [f32; 4] = [0.25, 2.0, 0.0, 0.0];

/// Two triangles over the whole target, and the edge between them from corner to corner.
pub const SQUARE: [[f32; 4]; 6] = [
    [-1.0, -1.0, 0.0, 1.0],
    [1.0, -1.0, 0.0, 1.0],
    [1.0, 1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0, 1.0],
    [1.0, 1.0, 0.0, 1.0],
    [-1.0, 1.0, 0.0, 1.0],
];

/// Of numbers of the shader, and of numbers that it loads.
pub fn cases() -> Vec<Case> {
    let target = Item::Format(FORMAT, vk::FormatFeatureFlags::COLOR_ATTACHMENT);
    let case = |(word, first)| {
        let name = format!("probe.derivative.{word}");
        Case::new(name, move |stand| measure(stand, first)).needing(target)
    };
    [("computed", 0), ("loaded", 2)].map(case).into()
}

fn measure(stand: &mut Stand, first: usize) -> Result<Measurement, Stop> {
    let shaders = ["probe/shapes", "probe/derivatives"];
    let given = [
        ("corners", &SQUARE[..]),
        ("colors", &[[0.0; 4]][..]),
        ("steps", &[STEPS][..]),
    ];
    let texels = kit::draw_with(stand, shaders, FORMAT, EXTENT, &given)?;
    let mut measurement = Measurement::new(Bound::new("derivatives", DERIVATION), 6000);
    for pixel in 0..(EXTENT[0] * EXTENT[1]) as usize {
        let [x, y] = [pixel as u32 % EXTENT[0], pixel as u32 / EXTENT[0]];
        for (k, word) in ["to the right", "down"].into_iter().enumerate() {
            let found = kit::number(FORMAT, &texels, 4 * pixel + first + k);
            let at = || format!("{word} at pixel [{x}, {y}]");
            measurement.take(at, STEPS[k].into(), found, 0.0);
        }
    }
    Ok(measurement)
}
