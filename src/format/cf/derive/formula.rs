//! Quantities of the atmosphere from others of the same voxel, in SI units.
//!
//! ```text
//! T   = theta (p / 100000 Pa)^(2/7)                       Poisson's equation, R_d / c_p = 2/7 for dry air
//! V   = sqrt(u^2 + v^2 [+ w^2])
//! e   = p r / (eps + r),   r = q / (1 - q),   eps = 0.622   r mixing ratio, q specific humidity, kg/kg
//! e_s = 611.2 Pa exp(17.67 (T - 273.15 K) / (T - 29.65 K))  over water, D. Bolton, "The computation of equivalent
//!                                                           potential temperature", Mon. Wea. Rev. 108, 1980, eq. 10
//! RH  = 100 e / e_s                                         %
//! ```
//!
//! WMO-No. 8 defines relative humidity over water at all temperatures, as here. Bolton's fit is within 0.3 % of the
//! steam tables from -35 to 35 degrees Celsius; colder air gets numbers from outside of that fit.

/// How a value is made of its arguments, which are in SI units in the order that each line names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Formula {
    /// The argument itself.
    Same,
    /// Potential temperature in K, pressure in Pa: K.
    Temperature,
    /// Components of the wind, m/s.
    Speed,
    /// Temperature in K (potential with `is_potential`), pressure in Pa, water vapour in kg of a kg of dry air (of moist
    /// air with `is_specific`): %.
    Humidity {
        is_potential: bool,
        is_specific: bool,
    },
}

/// Where potential temperature is the temperature, Pa.
const REFERENCE_PRESSURE: f64 = 1e5;
/// R_d / c_p of dry air.
const KAPPA: f64 = 2.0 / 7.0;
/// R_d / R_v, molar mass of water over that of dry air.
const EPSILON: f64 = 0.622;

impl Formula {
    /// NaN where an argument is one, or is missing.
    pub(super) fn value(self, arguments: &[f64]) -> f64 {
        match (self, arguments) {
            (Self::Same, &[value]) => value,
            (Self::Temperature, &[theta, pressure]) => temperature(theta, pressure),
            (Self::Speed, components) => components.iter().map(|v| v * v).sum::<f64>().sqrt(),
            (
                Self::Humidity {
                    is_potential,
                    is_specific,
                },
                &[warmth, pressure, vapour],
            ) => {
                let kelvins = match is_potential {
                    true => temperature(warmth, pressure),
                    false => warmth,
                };
                let ratio = match is_specific {
                    true => vapour / (1.0 - vapour),
                    false => vapour,
                };
                100.0 * vapour_pressure(pressure, ratio) / saturation(kelvins)
            }
            _ => f64::NAN,
        }
    }

    /// How a value is made of `arguments`, as a note has it.
    pub(super) fn words(self, arguments: &[String]) -> String {
        let listed = arguments.join(", ");
        match (self, arguments) {
            (Self::Temperature, [theta, pressure]) => {
                format!("({theta}) (({pressure}) / 100000)^(2/7), in K and Pa")
            }
            (Self::Speed, _) => format!("the length of the vector {listed}"),
            (Self::Humidity { is_potential, .. }, _) => {
                let by = if is_potential { "potential " } else { "" };
                format!(
                    "over water (Bolton 1980), from {by}temperature, pressure and vapour {listed}"
                )
            }
            _ => listed,
        }
    }
}

/// K, of potential temperature in K and pressure in Pa.
fn temperature(theta: f64, pressure: f64) -> f64 {
    theta * (pressure / REFERENCE_PRESSURE).powf(KAPPA)
}

/// Pa, of pressure in Pa and mixing ratio in kg/kg.
fn vapour_pressure(pressure: f64, ratio: f64) -> f64 {
    pressure * ratio / (EPSILON + ratio)
}

/// Pa, over water at a temperature in K.
fn saturation(kelvins: f64) -> f64 {
    611.2 * (17.67 * (kelvins - 273.15) / (kelvins - 29.65)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn saturation_is_that_of_the_tables() {
        // Goff-Gratch over water as WMO-No. 49 has it, hPa: Smithsonian Meteorological Tables, table 94. Bolton promises
        // 0.3 % from -35 to 35.
        for (celsius, hectopascals) in [
            (-20.0, 1.2540),
            (0.0, 6.1078),
            (20.0, 23.373),
            (30.0, 42.430),
        ] {
            let found = saturation(celsius + 273.15) / 100.0;
            assert!(
                (found / hectopascals - 1.0).abs() < 3e-3,
                "{celsius}: {found}"
            );
        }
    }

    #[test]
    fn what_is_missing_is_no_number() {
        let humidity = Formula::Humidity {
            is_potential: true,
            is_specific: false,
        };
        for (formula, arguments) in [
            (Formula::Temperature, vec![300.0, f64::NAN]),
            (Formula::Temperature, vec![300.0, -1.0]),
            (Formula::Temperature, vec![300.0]),
            (Formula::Speed, vec![1.0, f64::NAN]),
            (humidity, vec![300.0, 9e4, f64::NAN]),
        ] {
            assert!(
                formula.value(&arguments).is_nan(),
                "{formula:?} {arguments:?}"
            );
        }
    }

    #[test]
    fn specific_humidity_and_mixing_ratio_say_the_same() {
        let of = |is_specific, vapour| {
            let formula = Formula::Humidity {
                is_potential: false,
                is_specific,
            };
            formula.value(&[290.0, 9e4, vapour])
        };
        let ratio = 0.012;
        assert!((of(false, ratio) - of(true, ratio / (1.0 + ratio))).abs() < 1e-12);
    }
}
