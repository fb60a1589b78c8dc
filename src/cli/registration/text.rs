//! ITK's text files of transforms: a line a key.

use super::parts::Part;

/// How they begin.
pub const FIRST_LINE: &str = "#Insight Transform File V1.0";

/// The transforms in their order.
pub fn parts(bytes: &[u8]) -> Result<Vec<Part>, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "wanted text of ITK, found other bytes")?;
    let first = text.lines().next().unwrap_or_default();
    if first.trim_end() != FIRST_LINE {
        return Err(format!(
            "wanted {FIRST_LINE:?} as the first line, found {first:?}"
        ));
    }
    let mut parts: Vec<Part> = Vec::new();
    for line in text
        .lines()
        .filter(|line| !line.starts_with('#') && !line.trim().is_empty())
    {
        let wanted =
            || format!("wanted `Transform:`, `Parameters:` or `FixedParameters:`, found {line:?}");
        let (key, value) = line.split_once(':').ok_or_else(wanted)?;
        if key == "Transform" {
            parts.push(Part::new(value.trim()));
            continue;
        }
        let part = parts.last_mut();
        let part = part.ok_or_else(|| format!("wanted `Transform:` first, found {line:?}"))?;
        match key {
            "Parameters" => part.parameters = numbers(key, value)?,
            "FixedParameters" => part.fixed = numbers(key, value)?,
            _ => return Err(wanted()),
        }
    }
    Ok(parts)
}

fn numbers(key: &str, value: &str) -> Result<Vec<f64>, String> {
    let number = |word: &str| {
        word.parse()
            .map_err(|_| format!("{key}: wanted numbers, found {word:?}"))
    };
    value.split_whitespace().map(number).collect()
}
