//! What a transfer function file says of matter that scatters light: `extinction`, `albedo`, `emission`, `phase`.

use super::field::{Expected, Fields, VALUE, list, number, numbers, wrong};
use super::{FileProblem, MAX_POINTS, MediumPoint, MediumTransfer, Phase};
use serde_json::{Value, json};

const AMOUNT: Expected = Expected {
    fits: |x| (0.0..=f32::MAX as f64).contains(&x),
    text: "a number of 0 or more",
};
const COSINE: Expected = Expected {
    fits: |x| x.abs() <= 0.99,
    text: "a mean cosine from -0.99 to 0.99",
};
const PART: Expected = Expected {
    fits: |x| (0.0..=1.0).contains(&x),
    text: "a part from 0 to 1",
};
const PHASE: &str = "{\"g\": G}, {\"f\": F, \"g1\": G, \"g2\": G}, \"isotropic\" or \"rayleigh\"";

/// The keys as they stand in a file.
pub(super) struct MediumKeys<'a> {
    pub extinction: &'a Option<Value>,
    pub albedo: &'a Option<Value>,
    pub emission: &'a Option<Value>,
    pub phase: &'a Option<Value>,
}

impl MediumKeys<'_> {
    /// What they say; `None` where they say nothing.
    pub fn medium(&self) -> Result<Option<MediumTransfer>, FileProblem> {
        let row = "[value, sigma] or [value, r, g, b]";
        let colors = "[value, r, g, b]";
        let medium = MediumTransfer {
            extinction: points("extinction", row, self.extinction, true)?,
            albedo: points("albedo", colors, self.albedo, false)?,
            emission: points("emission", colors, self.emission, false)?,
            phase: self.phase.as_ref().map(phase).transpose()?,
        };
        for (i, point) in medium.albedo.iter().enumerate() {
            if let Some(c) = point.linear.iter().position(|&c| c > 1.0) {
                return Err(FileProblem::Grows {
                    field: format!("albedo[{i}][{}]", c + 1),
                    value: point.value,
                    found: point.linear[c],
                });
            }
        }
        Ok((!medium.is_empty()).then_some(medium))
    }
}

/// Rows of a value and amounts, by ascending value. A row of one amount has it in all colours.
fn points(
    field: &str,
    row_wanted: &'static str,
    found: &Option<Value>,
    may_be_grey: bool,
) -> Result<Vec<MediumPoint>, FileProblem> {
    let Some(found) = found else {
        return Ok(Vec::new());
    };
    let limit = (MAX_POINTS, "at most 4096 points");
    let rows = list(field, found, "a list of at least one point", limit)?;
    let mut points: Vec<MediumPoint> = Vec::with_capacity(rows.len());
    let wanted = |c| if c == 0 { VALUE } else { AMOUNT };
    for (i, row) in rows.iter().enumerate() {
        let name = format!("{field}[{i}]");
        let is_grey = may_be_grey && row.as_array().is_some_and(|row| row.len() == 2);
        let [value, r, g, b] = match is_grey {
            true => {
                let [value, amount] = numbers(&name, row, row_wanted, wanted)?;
                [value, amount, amount, amount]
            }
            false => numbers(&name, row, row_wanted, wanted)?,
        };
        if points.last().is_some_and(|last| last.value > value) {
            let found = Value::from(value);
            let field = format!("{name}[0]");
            return Err(wrong(&field, "a value not below the one before", &found));
        }
        let linear = [r, g, b];
        points.push(MediumPoint { value, linear });
    }
    Ok(points)
}

fn phase(found: &Value) -> Result<Phase, FileProblem> {
    match found.as_str() {
        Some("rayleigh") => return Ok(Phase::Rayleigh),
        Some("isotropic") => return Ok(Phase::Isotropic),
        _ => {}
    }
    let mut fields = Fields::of("phase".to_owned(), found, PHASE)?;
    let phase = match fields.optional("g") {
        Some(g) => Phase::HenyeyGreenstein(number("phase.g", &g, COSINE)?),
        None => {
            let part = fields.number("f", PART)?;
            let g = [fields.number("g1", COSINE)?, fields.number("g2", COSINE)?];
            Phase::TwoLobes { part, g }
        }
    };
    fields.end()?;
    Ok(phase)
}

/// The lines of a file that state `medium`, each with a comma behind it.
pub(super) fn medium_to_json(medium: &MediumTransfer) -> String {
    let lists = [
        ("extinction", &medium.extinction),
        ("albedo", &medium.albedo),
        ("emission", &medium.emission),
    ];
    let mut lines = String::new();
    for (key, points) in lists {
        let row = |p: &MediumPoint| match p.linear {
            [r, g, b] if key == "extinction" && r == g && r == b => json!([p.value, r]),
            [r, g, b] => json!([p.value, r, g, b]),
        };
        if !points.is_empty() {
            let rows: Value = points.iter().map(row).collect();
            lines += &format!("  \"{key}\": {rows},\n");
        }
    }
    let phase = medium.phase.map(|phase| match phase {
        Phase::Isotropic => json!("isotropic"),
        Phase::Rayleigh => json!("rayleigh"),
        Phase::HenyeyGreenstein(g) => json!({ "g": g }),
        Phase::TwoLobes { part, g: [g1, g2] } => json!({ "f": part, "g1": g1, "g2": g2 }),
    });
    if let Some(phase) = phase {
        lines += &format!("  \"phase\": {phase},\n");
    }
    lines
}
