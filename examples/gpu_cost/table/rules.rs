//! What each row is held to.
//!
//! ```text
//! scratch = 0,  spilled <= SPILLS,  waves >= least,  throughput <= 1.03 page,  throughput <= 1.03 straight
//! ```

use super::{Table, null_device::FAMILIES};

/// How much more expensive than in the page, and than in its straight form, a pair may be.
pub const MOST_RATIO: f64 = 1.03;

/// Waves that hide the latency of memory.
pub const LEAST_WAVES: u64 = 8;

/// GCN 4 has so few registers that only 32 of an invocation leave 8 waves: its rows keep the waves of the page.
const FEW_REGISTERS: &str = "polaris10";

/// Registers that a row may spill yet, by family in the order of [`FAMILIES`]. All others spill none.
///
/// These are scalar registers, which the copy of the parameters that `shaders/read_once.rs` makes where an entry point
/// begins keeps busy to its end: without that pass none spills on RDNA, and at most four on GCN 4.
const SPILLS: &[(&str, [u64; FAMILIES.len()])] = &[
    (
        "raycast.composite.graded.ray.linear.none.table.picture",
        [8, 8, 21],
    ),
    ("raycast.composite.graded.ray.linear.none.table", [8, 8, 21]),
    ("raycast.mida.graded.ray.linear.none.table", [7, 7, 19]),
    ("isosurface.linear.none", [2, 2, 7]),
    ("isosurface.nearest.none", [4, 4, 8]),
    ("isosurface.kernel.none", [16, 16, 33]),
    ("isosurface.by.linear.none", [11, 11, 34]),
];

/// The most registers that a row of a family may spill.
pub fn most_spilled(family: &str, name: &str) -> u64 {
    let of_row = SPILLS.iter().find(|(one, _)| *one == name);
    let place = FAMILIES.iter().position(|one| *one == family);
    match (of_row, place) {
        (Some((_, most)), Some(place)) => most[place],
        _ => 0,
    }
}

/// A line for each rule that a row breaks, beside the table of the page.
pub fn broken(measured: &Table, page: &Table) -> Vec<String> {
    let mut broken = Vec::new();
    for (family, rows) in &measured.families {
        for row in rows {
            let mut say = |what: String| broken.push(format!("{family}, {}: {what}", row.name));
            let cost = &row.pair;
            if cost.scratch_bytes > 0 {
                say(format!(
                    "{} bytes of scratch, wanted none",
                    cost.scratch_bytes
                ));
            }
            let most = most_spilled(family, &row.name);
            if cost.spilled > most {
                say(format!(
                    "{} spilled registers, wanted at most {most}",
                    cost.spilled
                ));
            }
            let Some(known) = page.row(family, &row.name) else {
                say("not in the page".into());
                continue;
            };
            let least = match family == FEW_REGISTERS {
                true => known.pair.waves,
                false => LEAST_WAVES,
            };
            if cost.waves < least {
                say(format!("{} waves, wanted at least {least}", cost.waves));
            }
            let ratio = cost.throughput as f64 / known.pair.throughput as f64;
            if ratio > MOST_RATIO {
                say(format!(
                    "{ratio:.3} of the inverse throughput in the page, wanted at most {MOST_RATIO}"
                ));
            }
            if let Some(ratio) = row.over_straight().filter(|ratio| *ratio > MOST_RATIO) {
                say(format!(
                    "{ratio:.3} of the inverse throughput of its straight form, wanted at most {MOST_RATIO}"
                ));
            }
        }
    }
    broken
}
