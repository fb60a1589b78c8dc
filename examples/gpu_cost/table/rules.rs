//! What each row is held to.
//!
//! ```text
//! scratch = 0,  spilled = 0,  waves >= least,  throughput <= 1.03 page,  throughput <= 1.03 straight
//! ```

use super::Table;

/// How much more expensive than in the page, and than in its straight form, a pair may be.
pub const MOST_RATIO: f64 = 1.03;

/// Waves that hide the latency of memory.
pub const LEAST_WAVES: u64 = 8;

/// GCN 4 has so few registers that only 32 of an invocation leave 8 waves: its rows keep the waves of the page.
const FEW_REGISTERS: &str = "polaris10";

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
            if cost.spilled > 0 {
                say(format!("{} spilled registers, wanted none", cost.spilled));
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
