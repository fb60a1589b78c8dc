//! Points as rows of numbers, as scripts keep those of VTK's functions: `x r g b`, `x a`, or both as
//! `x r g b a`, separated by blanks, commas or semicolons; `#` begins a comment.

use super::super::FileProblem;
use super::Imported;
use super::draft::Draft;

const ORIGIN: &str = "a table of points";

pub(super) fn read(text: &str) -> Result<Imported, FileProblem> {
    let mut draft = Draft::new(ORIGIN);
    for (i, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        let words = line
            .split([' ', '\t', ',', ';'])
            .filter(|word| !word.is_empty());
        let numbers: Option<Vec<f64>> = words.map(|word| word.parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x, a]) => draft.opacity.push((x, a)),
            Some(&[x, r, g, b]) => draft.color.push((x, [r, g, b])),
            Some(&[x, r, g, b, a]) => {
                draft.color.push((x, [r, g, b]));
                draft.opacity.push((x, a));
            }
            // The names of the columns.
            None if draft.color.is_empty() && draft.opacity.is_empty() && i == 0 => {}
            _ => {
                let found: String = line.chars().take(40).collect();
                return Err(FileProblem::Unknown(format!(
                    "text whose line {} is {found:?}, no row of 2, 4 or 5 numbers",
                    i + 1
                )));
            }
        }
    }
    if draft.color.is_empty() && draft.opacity.is_empty() {
        return Err(FileProblem::Unknown(
            "text without a row of numbers".to_owned(),
        ));
    }
    // Codes of eight bits are no fractions.
    let codes = draft.color.iter().flat_map(|p| p.1).fold(0.0, f64::max);
    if codes > 1.0 && codes <= 255.0 {
        for (_, rgb) in &mut draft.color {
            *rgb = rgb.map(|c| c / 255.0);
        }
        let said = "colours up to 255 are taken for codes of 8 bits";
        draft.left_out.push(said.to_owned());
    }
    draft.finish()
}
