//! What `info` says of the Earth: the map of a weather model, and variables that are computed on demand.

use super::text::Lines;
use crate::figure::short;
use crate::volume::{DerivedVariable, MapProjection};

/// `Mercator, true at latitude 0, standard longitude -89`.
fn words(map: &MapProjection) -> String {
    let mut words = map.kind.name().to_owned();
    let all = map.true_latitudes.iter().flatten().map(|&n| short(n));
    let latitudes = all.collect::<Vec<_>>().join(" and ");
    if !latitudes.is_empty() {
        words.push_str(&format!(", true at latitude {latitudes}"));
    }
    if let Some(longitude) = map.standard_longitude {
        words.push_str(&format!(", standard longitude {}", short(longitude)));
    }
    if let Some(pole) = map.pole {
        words.push_str(&format!(
            ", north pole at latitude {}, longitude {}",
            short(pole.latitude),
            short(pole.longitude)
        ));
    }
    words
}

/// The map and the middle of the grid.
pub fn map(map: &MapProjection, lines: &mut Lines) {
    lines.say("map", words(map));
    if let Some([latitude, longitude]) = map.center {
        lines.say(
            "centre",
            format!("latitude {latitude:.4}, longitude {longitude:.4}"),
        );
    }
}

/// Variables that are computed where they are asked for.
pub fn derived(variables: &[DerivedVariable], lines: &mut Lines) {
    for (i, variable) in variables.iter().enumerate() {
        let title = if i == 0 { "derived" } else { "" };
        let DerivedVariable { name, unit, from } = variable;
        let from = from.join(", ");
        lines.say(title, format!("{name:<18} {unit}, from {from}"));
    }
    lines.say("", "--variable NAME computes one");
}
