//! Functions of shaders against f64, within what Vulkan demands of them.

use super::kit;
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::Resource;
use std::sync::Arc;

/// A unit in the last place of an f32 at 1.
const ULP: f64 = 1.0 / (1u32 << 23) as f64;

const DERIVATION: &str = "Vulkan specification, \"Precision and Operation of SPIR-V Instructions\", in units of the last place of the \
right result: exp and exp2 3 + 2|x|, log and log2 3, and 2^-21 absolute for x in [0.5, 2], sqrt as 1 / inverseSqrt (2, then 2.5), \
inverseSqrt 2, division 2.5, pow as exp2(y log2 x); floor, ceil and round exact, fract as x - floor(x).";

const NAMES: [&str; 12] = [
    "exp",
    "log",
    "sqrt",
    "inverse_sqrt",
    "reciprocal",
    "pow",
    "exp2",
    "log2",
    "floor",
    "ceil",
    "fract",
    "round",
];

/// One a function.
pub fn cases() -> Vec<Case> {
    let one = |(function, name): (usize, &&'static str)| {
        Case::new(format!("probe.math.{name}"), move |bed| {
            measure(bed, function)
        })
    };
    NAMES.iter().enumerate().map(one).collect()
}

fn measure(bed: &mut TestBed, function: usize) -> Result<Measurement, Stop> {
    const COUNT: u32 = 8192;
    let mut random = bed.random("math");
    let numbers: Vec<f32> = (0..COUNT)
        .map(|i| match i % 3 {
            0 => (20.0 * random.unit()) as f32 + 1e-4,
            1 => (2.0 * random.unit()) as f32 + 1e-4,
            _ => 2f64.powf(24.0 * random.unit() - 20.0) as f32,
        })
        .collect();
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let given = kit::buffer(&gpu, &numbers, "numbers")?;
    let found = kit::zeros::<[f32; 4]>(&gpu, 3 * numbers.len(), "found")?;
    let resources = [
        ("numbers", Resource::Storage(&given)),
        ("found", Resource::Storage(&found)),
    ];
    kit::compute(device, "probe/math", &resources, [COUNT / 64, 1, 1])?;
    let found: Vec<[f32; 4]> = kit::read(&found)?;
    let mut measurement = Measurement::new(Bound::new("spirv-precision", DERIVATION), 1000);
    for (i, &x) in numbers.iter().enumerate() {
        let found = found[3 * i + function / 4][function % 4];
        let x = f64::from(x);
        let is_half_way = NAMES[function] == "round" && (x.fract() - 0.5).abs() < 1e-6;
        if is_half_way {
            measurement.leave_out(1);
            continue;
        }
        let (wanted, allowed) = exact(NAMES[function], x);
        measurement.take(|| format!("x = {x:e}"), wanted, found.into(), allowed);
    }
    Ok(measurement)
}

/// The result, and what it may be off by.
fn exact(name: &str, x: f64) -> (f64, f64) {
    // A unit in the last place of the result is at most ULP of it.
    let ulps = |wanted: f64, count: f64| {
        (
            wanted,
            count * ULP * wanted.abs() + f64::from(f32::MIN_POSITIVE),
        )
    };
    let log = |wanted: f64, factor: f64| match (0.5..=2.0).contains(&x) {
        true => (wanted, factor / f64::from(1u32 << 21)),
        false => ulps(wanted, 3.0),
    };
    match name {
        "exp" => ulps((-x).exp(), 3.0 + 2.0 * x),
        "log" => log(x.ln(), 1.0),
        "sqrt" => ulps(x.sqrt(), 4.5),
        "inverse_sqrt" => ulps(1.0 / x.sqrt(), 2.0),
        "reciprocal" => ulps(1.0 / x, 2.5),
        "pow" => {
            let wanted = x.powf(2.4);
            // What log2 is off by goes into the power.
            let of_log = log(x.log2(), 1.0).1 * 2.4 + 2.4 * x.log2().abs() * ULP;
            let exponent = (2.4 * x.log2()).abs();
            (
                wanted,
                wanted * (of_log * 2f64.ln() * 1.01 + (3.0 + 2.0 * exponent) * ULP)
                    + f64::from(f32::MIN_POSITIVE),
            )
        }
        "exp2" => ulps(x.exp2(), 3.0 + 2.0 * x),
        "log2" => log(x.log2(), 1.0),
        "floor" => (x.floor(), 0.0),
        "ceil" => (x.ceil(), 0.0),
        "fract" => (x - x.floor(), 0.5 * ULP),
        _ => (x.round(), 0.0),
    }
}
