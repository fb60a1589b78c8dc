//! Blending: order of what one draw holds, precision against the number of layers, maxima and minima.
//!
//! ```text
//! over   d' = s + (1 - s.a) d      under   d' = (1 - d.a) s + d      add   s + d      max, min   channel by channel
//! E' = g E + e,   E the error so far, g what the operator leaves of it, e what one blend rounds
//! ```

use super::kit::{self, Drawing};
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::{Blend, Item};
use ash::vk;

const DERIVATION: &str = "One blend rounds its source, its product and its sum: 3 roundings of the format (each of numbers no larger \
than those that are blended; of codes one of the two that are closest, of 16-bit floats a unit of the last place, because they may \
be cut off: more than half of that is a warning). What was off before it is kept in the part that the operator leaves: \
1 - a for over (a itself off by a unit of its codes), all of it for under and add, and under multiplies its source by \
1 - A, whose error comes as well. The recursion E' = g E + e is run beside the exact blend. Maxima and minima round the source alone.";

/// A format and the most that one rounding of a number of size 1 may change. Halves may be cut off as well as rounded, and a
/// code is one of the two that are closest (Vulkan specification, conversion to 16-bit floats and to normalized fixed point).
const FORMATS: [(&str, vk::Format, f64); 3] = [
    ("rgba8_unorm", vk::Format::R8G8B8A8_UNORM, 1.0 / 255.0),
    (
        "rgba16_sfloat",
        vk::Format::R16G16B16A16_SFLOAT,
        1.0 / 1024.0,
    ),
    (
        "rgba32_sfloat",
        vk::Format::R32G32B32A32_SFLOAT,
        0.5 / (1u32 << 23) as f64,
    ),
];

/// Formats of fewer channels or other codes, blended where the device says that it can; and their channels.
const CLAIMED: [(&str, vk::Format, f64, usize); 6] = [
    ("r8_unorm", vk::Format::R8_UNORM, 1.0 / 255.0, 1),
    ("r16_unorm", vk::Format::R16_UNORM, 1.0 / 65_535.0, 1),
    (
        "rgba16_unorm",
        vk::Format::R16G16B16A16_UNORM,
        1.0 / 65_535.0,
        4,
    ),
    ("r16_sfloat", vk::Format::R16_SFLOAT, 1.0 / 1024.0, 1),
    ("rg16_sfloat", vk::Format::R16G16_SFLOAT, 1.0 / 1024.0, 2),
    (
        "r32_sfloat",
        vk::Format::R32_SFLOAT,
        0.5 / (1u32 << 23) as f64,
        1,
    ),
];

const BLENDS: [(&str, Blend); 6] = [
    ("replace", Blend::Replace),
    ("over", Blend::Over),
    ("under", Blend::Under),
    ("add", Blend::Add),
    ("max", Blend::Max),
    ("min", Blend::Min),
];

/// Operators, formats, numbers of layers, layers as instances or as triangles of one.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (blend_word, blend) in BLENDS {
        for (format_word, format, unit) in FORMATS {
            for layers in [1u32, 8, 64, 512] {
                for (of_what, as_instances) in [("instances", true), ("triangles", false)] {
                    let name = format!("probe.blend.{blend_word}.{format_word}.{of_what}.{layers}");
                    let of = Of {
                        blend,
                        format,
                        unit,
                        channels: 4,
                        layers,
                        as_instances,
                    };
                    cases.push(of.case(name));
                }
            }
        }
        for (format_word, format, unit, channels) in CLAIMED {
            let name = format!("probe.blend.{blend_word}.{format_word}.instances.8");
            let of = Of {
                blend,
                format,
                unit,
                channels,
                layers: 8,
                as_instances: true,
            };
            cases.push(of.case(name));
        }
    }
    for (word, blend) in [("max", Blend::Max), ("min", Blend::Min)] {
        let format = vk::Format::R32G32B32A32_SFLOAT;
        let blendable = vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
        let case = Case::new(
            format!("probe.blend.{word}.rgba32_sfloat.infinities"),
            move |bed| infinities(bed, blend),
        );
        cases.push(case.needing(Item::Format(format, blendable)));
    }
    cases
}

#[derive(Clone, Copy)]
struct Of {
    blend: Blend,
    format: vk::Format,
    unit: f64,
    /// That the format has; the fourth is alpha, which is one where there is none.
    channels: usize,
    layers: u32,
    as_instances: bool,
}

/// A triangle that covers everything.
const COVER: [[f32; 4]; 3] = [
    [-1.0, -1.0, 0.0, 1.0],
    [3.0, -1.0, 0.0, 1.0],
    [-1.0, 3.0, 0.0, 1.0],
];

const EXTENT: [u32; 2] = [16, 16];

fn drawn(
    bed: &mut TestBed,
    format: vk::Format,
    blend: Blend,
    clear: [f32; 4],
    colors: &[[f32; 4]],
    as_instances: bool,
) -> Result<Vec<u8>, Stop> {
    let count = colors.len();
    let (corners, instances) = match as_instances {
        true => (COVER.to_vec(), count as u32),
        false => (COVER.repeat(count), 1),
    };
    let drawing = Drawing {
        format,
        extent: EXTENT,
        clear,
        blend,
        corners: &corners,
        colors,
        instances,
    };
    kit::draw(bed, &drawing)
}

impl Of {
    fn case(self, name: String) -> Case {
        let mut features = vk::FormatFeatureFlags::COLOR_ATTACHMENT;
        if self.blend != Blend::Replace {
            features |= vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
        }
        let seeded = name.clone();
        let case = Case::new(name, move |bed| self.measure(bed, &seeded));
        case.needing(Item::Format(self.format, features))
    }

    fn is_codes(self) -> bool {
        !self.is_halves()
            && !matches!(
                self.format,
                vk::Format::R32_SFLOAT | vk::Format::R32G32B32A32_SFLOAT
            )
    }

    fn is_halves(self) -> bool {
        matches!(
            self.format,
            vk::Format::R16_SFLOAT | vk::Format::R16G16_SFLOAT | vk::Format::R16G16B16A16_SFLOAT
        )
    }

    #[allow(
        clippy::needless_range_loop,
        reason = "a channel is looked up in three arrays"
    )]
    fn measure(self, bed: &mut TestBed, name: &str) -> Result<Measurement, Stop> {
        let is_codes = self.is_codes();
        let mut random = bed.random(name);
        // Premultiplied, so that sums of over and under stay under 1; what is added up stays there too.
        let share = if self.blend == Blend::Add {
            1.0 / f64::from(self.layers)
        } else {
            1.0
        };
        let most = if self.layers > 64 { 0.05 } else { 0.4 };
        let mut color = || {
            let alpha = share * (0.01 + most * random.unit());
            let sign = match (self.blend, is_codes) {
                (Blend::Max | Blend::Min, false) if random.unit() < 0.5 => -1.0,
                _ => 1.0,
            };
            let [r, g, b] = [0; 3].map(|_| sign * alpha * random.unit());
            [r, g, b, alpha].map(|n| n as f32)
        };
        let colors: Vec<[f32; 4]> = (0..self.layers).map(|_| color()).collect();
        let clear = match self.blend {
            Blend::Min => [1.0; 4],
            Blend::Max if !is_codes => [-1.0; 4],
            _ => [0.0; 4],
        };
        let texels = drawn(
            bed,
            self.format,
            self.blend,
            clear,
            &colors,
            self.as_instances,
        )?;
        let (wanted, allowed) = self.exact(clear, &colors);
        let half = Self {
            unit: 0.5 * self.unit,
            ..self
        };
        let (_, better) = half.exact(clear, &colors);
        let bound = Bound::new("blends", DERIVATION)
            .with("unit", self.unit)
            .with("layers", self.layers.into());
        let mut measurement = Measurement::new(bound, 250);
        for pixel in 0..(EXTENT[0] * EXTENT[1]) as usize {
            for c in 0..self.channels {
                let found = kit::number(self.format, &texels, self.channels * pixel + c);
                let at = || format!("channel {c} of pixel {pixel}");
                measurement.take(at, wanted[c], found, allowed[c]);
                if self.is_codes() {
                    let meaning = "codes are not always the nearest";
                    measurement.prefer(meaning, at, wanted[c], found, better[c]);
                } else if self.is_halves() {
                    let meaning = "16-bit floats are cut off and not rounded";
                    measurement.prefer(meaning, at, wanted[c], found, better[c]);
                }
            }
        }
        Ok(measurement)
    }

    /// The exact blend and what each channel may be off by.
    #[allow(
        clippy::needless_range_loop,
        reason = "a channel is looked up in three arrays"
    )]
    fn exact(self, clear: [f32; 4], colors: &[[f32; 4]]) -> ([f64; 4], [f64; 4]) {
        let is_codes = self.is_codes();
        let size = |n: f64| {
            if is_codes {
                self.unit
            } else {
                self.unit * n.abs()
            }
        };
        let mut d = clear.map(f64::from);
        let mut e = [0.0; 4];
        for s in colors {
            if self.channels < 4 {
                (d[3], e[3]) = (1.0, 0.0);
            }
            let s = s.map(f64::from);
            let (alpha, alpha_e) = (d[3], e[3]);
            for c in 0..4 {
                let (new, rounding) = match self.blend {
                    Blend::Replace => {
                        e[c] = 0.0;
                        (s[c], size(s[c]))
                    }
                    Blend::Over => {
                        let kept = (1.0 - s[3] + size(s[3])) * e[c];
                        e[c] = kept.min(1.0);
                        let product = (1.0 - s[3]) * d[c];
                        let of_alpha = size(s[3]) * d[c].abs() + size(1.0) * d[c].abs();
                        (
                            s[c] + product,
                            size(s[c]) + of_alpha + size(product) + size(s[c] + product),
                        )
                    }
                    Blend::Under => {
                        e[c] += alpha_e * s[c].abs();
                        let product = (1.0 - alpha) * s[c];
                        let of_alpha = size(1.0) * s[c].abs();
                        (
                            product + d[c],
                            size(s[c]) + of_alpha + size(product) + size(product + d[c]),
                        )
                    }
                    Blend::Add => (s[c] + d[c], size(s[c]) + size(s[c] + d[c])),
                    Blend::Max => {
                        e[c] = 0.0;
                        (s[c].max(d[c]), 2.0 * size(s[c].max(d[c])))
                    }
                    Blend::Min => {
                        e[c] = 0.0;
                        (s[c].min(d[c]), 2.0 * size(s[c].min(d[c])))
                    }
                };
                d[c] = new;
                e[c] += rounding;
            }
        }
        (d, e)
    }
}

fn infinities(bed: &mut TestBed, blend: Blend) -> Result<Measurement, Stop> {
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let (low, high) = (f32::NEG_INFINITY, f32::INFINITY);
    let colors = [
        [low, high, -3.0, 3e38],
        [low, high, 5.0, -3e38],
        [low, 1.0, high, 0.0],
    ];
    let (clear, wanted) = match blend {
        Blend::Max => ([low; 4], [low, high, high, 3e38]),
        _ => ([high; 4], [low, 1.0, -3.0, -3e38]),
    };
    let texels = drawn(bed, format, blend, clear, &colors, true)?;
    let text = "Infinities are numbers like others to maxima and minima of 32-bit floats: nothing is rounded. Vulkan does not \
demand them: the largest numbers in their place are a warning.";
    let mut measurement = Measurement::new(Bound::new("infinities", text), 1000);
    for i in 0..4 * (EXTENT[0] * EXTENT[1]) as usize {
        let found = kit::number(format, &texels, i);
        let (at, wanted) = (|| format!("number {i}"), f64::from(wanted[i % 4]));
        let is_largest = wanted.is_infinite() && found == wanted.signum() * f64::from(f32::MAX);
        let accepted = if is_largest { found } else { wanted };
        measurement.take(at, accepted, found, 0.0);
        measurement.prefer(
            "infinities become the largest numbers",
            at,
            wanted,
            found,
            0.0,
        );
    }
    Ok(measurement)
}
