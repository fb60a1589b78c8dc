//! 3D Slicer's volume properties as text: `.vp`, and the attributes of `VolumeProperty` in MRML.
//!
//! ```text
//! interpolation · shade · diffuse · ambient · specular · power          one number a line
//! n v a v a ...        opacity of value, n numbers in all
//! n g a g a ...        opacity of gradient magnitude
//! n v r g b ...        colour of value
//! ```
//!
//! "Format of Volume Property (.vp) file", Slicer developer guide, Volume rendering. Opacities are for VTK's
//! default unit distance, 1 mm.

use super::super::FileProblem;
use super::draft::{Curve, Draft};
use super::xml::{Element, numbers};
use super::{Imported, choose};

const VP: &str = "a 3D Slicer volume property (.vp)";
const MRML: &str = "a 3D Slicer scene (MRML)";
/// Of `vtkVolumeProperty`, in world length.
const UNIT_DISTANCE: f64 = 1.0;

/// True for text that begins as `.vp` files do.
pub(super) fn is_vp(text: &str) -> bool {
    let lines = lines(text);
    let is_number = |line: &&str| line.parse::<f64>().is_ok();
    lines.len() >= 9 && lines[..6].iter().all(is_number)
}

/// The lines that are no comment.
fn lines(text: &str) -> Vec<&str> {
    let lines = text.lines().map(str::trim);
    lines
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .collect()
}

pub(super) fn vp(text: &str) -> Result<Imported, FileProblem> {
    let lines = lines(text);
    let mut draft = Draft::new(VP);
    let shade = lines[1].parse::<f64>().is_ok_and(|shade| shade != 0.0);
    take(&mut draft, shade, [lines[6], lines[7], lines[8]])?;
    if lines.len() > 10 {
        let said = "what stands behind the colours (further components)";
        draft.left_out.push(said.to_owned());
    }
    draft.finish()
}

pub(super) fn mrml(root: &Element, wanted: Option<&str>) -> Result<Imported, FileProblem> {
    let all = root.all();
    let all: Vec<_> = all
        .into_iter()
        .filter(|e| e.name == "VolumeProperty")
        .collect();
    let name = |property: &&Element| property.attribute("name").map(str::to_owned);
    let property = choose(MRML, &all, name, wanted)?;
    let mut draft = Draft::new(MRML);
    draft.name = name(property);
    let shade = property
        .attribute("shade")
        .is_some_and(|shade| shade != "0");
    let lists = ["scalarOpacity", "gradientOpacity", "colorTransfer"];
    take(
        &mut draft,
        shade,
        lists.map(|key| property.attribute(key).unwrap_or_default()),
    )?;
    draft.finish()
}

fn take(draft: &mut Draft, shade: bool, lists: [&str; 3]) -> Result<(), FileProblem> {
    let opacity = list(draft, "scalar opacity", lists[0], 2)?;
    let points: Vec<_> = opacity
        .chunks(2)
        .map(|p| ([p[0], p[1]], Curve::LINE))
        .collect();
    draft.add_opacities(&points);
    let gradient = list(draft, "gradient opacity", lists[1], 2)?;
    if gradient.chunks(2).any(|p| p[1] != 1.0) {
        draft
            .left_out
            .push("the opacity by gradient magnitude".to_owned());
    }
    let color = list(draft, "colour transfer", lists[2], 4)?;
    let points: Vec<_> = color
        .chunks(4)
        .map(|p| (p[0], [p[1], p[2], p[3]], Curve::LINE))
        .collect();
    draft.add_colors(&points);
    if shade {
        draft
            .left_out
            .push("the light: ambient, diffuse and specular".to_owned());
    }
    draft.reference_length = Some(UNIT_DISTANCE);
    Ok(())
}

/// The numbers behind their count.
fn list(draft: &Draft, field: &str, text: &str, each: usize) -> Result<Vec<f64>, FileProblem> {
    let mut numbers = numbers(text, field)?;
    if numbers.is_empty() {
        return Ok(numbers);
    }
    let promised = numbers.remove(0);
    if promised != numbers.len() as f64 || numbers.len() % each != 0 {
        let found = numbers.len();
        return Err(draft.refuse(format!(
            "the {field} promises {promised} numbers in groups of {each}, and {found} follow"
        )));
    }
    Ok(numbers)
}
