//! What variables of WRF are, where the file's own words say less than CF's.
//!
//! ```text
//! T = theta - 300 K        perturbation potential temperature, no temperature of the air
//! ```
//!
//! By WRF's registry (Registry/Registry.EM_COMMON).

use super::model::Variable;
use crate::volume::Header;

/// Names of WRF and of CF.
const STANDARD_NAMES: [(&str, &str); 4] = [
    ("U", "x_wind"),
    ("V", "y_wind"),
    ("W", "upward_air_velocity"),
    ("QVAPOR", "humidity_mixing_ratio"),
];

/// Says in the header what a variable is.
pub(super) fn describe(variable: &Variable, header: &mut Header) {
    let row = STANDARD_NAMES.iter().find(|row| row.0 == variable.name);
    header.standard_name = row.map(|row| row.1.to_owned());
    if variable.name == "T" {
        header.long_name = Some("perturbation potential temperature".to_owned());
        header.notes.push(
            "T is the perturbation potential temperature, theta - 300 K; --variable temperature is that of the air".to_owned(),
        );
    }
}
