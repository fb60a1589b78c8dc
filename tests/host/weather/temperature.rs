//! Temperature of WRF's parts, in the parts of a file.
//!
//! ```text
//! T' + 300 K, times ((p' + p_base) / 1000 hPa)^(2/7)
//! ```

use super::{Found, sees, within};
use crate::fixtures::{open, values};
use stratavox::volume::TimeComponent;

#[derive(Clone, Copy, Debug)]
enum Fault {
    /// The perturbation alone.
    NoBaseTemperature,
    /// Pressures in hPa.
    Hectopascals,
    /// The perturbation of the pressure alone.
    NoBasePressure,
    /// 0.286 for 2/7.
    Kappa,
}

fn is_the_formula(fault: Option<Fault>) -> Found {
    let of = |name: &str| -> Vec<f64> {
        let source = open("netcdf/wrf_derived.nc", Some(name)).expect("a variable");
        let numbers = values(source.as_ref(), TimeComponent::default());
        numbers.into_iter().map(|n| n.expect("no hole")).collect()
    };
    let [found, theta, p, base] = ["temperature", "T", "P", "PB"].map(of);
    let mut worst: f64 = 0.0;
    for (i, found) in found.iter().enumerate() {
        let warmth = match fault {
            Some(Fault::NoBaseTemperature) => theta[i],
            _ => theta[i] + 300.0,
        };
        let pascals = match fault {
            Some(Fault::NoBasePressure) => p[i].abs(),
            Some(Fault::Hectopascals) => (p[i] + base[i]) / 100.0,
            _ => p[i] + base[i],
        };
        let power = match fault {
            Some(Fault::Kappa) => 0.286,
            _ => 2.0 / 7.0,
        };
        let wanted = warmth * (pascals / 1e5).powf(power);
        worst = worst.max((found - wanted).abs());
    }
    // Values are rounded to f32 at 300 K.
    within("a temperature (K)", worst, 300.0 * f64::from(f32::EPSILON))
}

#[test]
fn temperatures_are_those_of_the_formula() {
    use Fault::*;
    sees(
        &[NoBaseTemperature, Hectopascals, NoBasePressure, Kappa],
        is_the_formula,
    );
}
