//! VAPOR's `.tf3`: XML `MapperFunctionParams`, colours as (hue, saturation, value, place), opacities as
//! (opacity, place), places as fractions of `DataBounds`.
//!
//! `ColorInterpolationType`: 0 mixes hue (the shorter way round), saturation and value, 1 steps half-way, 4 is
//! Moreland's diverging map.

use super::super::FileProblem;
use super::Imported;
use super::color::{Space, corners, mixed, rgb_of_hsv};
use super::draft::Draft;
use super::xml::Element;

const ORIGIN: &str = "a VAPOR transfer function (.tf3)";
/// Of a segment: even, so that the middle of a diverging map is one of them.
const PARTS: usize = 64;

pub(super) fn read(root: &Element) -> Result<Imported, FileProblem> {
    let mut draft = Draft::new(ORIGIN);
    let bounds = bounds(&draft, root, [0.0, 1.0])?;
    if let Some(map) = root.find("ColorMapParams") {
        colors(&mut draft, map, bounds)?;
    }
    opacities(&mut draft, root, bounds)?;
    draft.finish()
}

/// The values that places from 0 to 1 are spread over.
fn bounds(draft: &Draft, element: &Element, otherwise: [f64; 2]) -> Result<[f64; 2], FileProblem> {
    let Some(bounds) = element.child("DataBounds") else {
        return Ok(otherwise);
    };
    match bounds.numbers()?.as_slice() {
        &[low, high] if low < high => Ok([low, high]),
        // What the program writes before it has seen data.
        &[0.0, 0.0] => Ok(otherwise),
        found => Err(draft.refuse(format!(
            "`DataBounds` are {found:?}, wanted a low and a higher value"
        ))),
    }
}

fn number(element: &Element, name: &str) -> Result<Option<f64>, FileProblem> {
    let found = element.child(name).map(Element::numbers).transpose()?;
    Ok(found.and_then(|numbers| numbers.first().copied()))
}

fn colors(draft: &mut Draft, map: &Element, otherwise: [f64; 2]) -> Result<(), FileProblem> {
    let [low, high] = bounds(draft, map, otherwise)?;
    let numbers = map.child("ColorMapControlPoints").map(Element::numbers);
    let numbers = numbers.transpose()?.unwrap_or_default();
    let (points, []) = numbers.as_chunks::<4>() else {
        return Err(draft.refuse("`ColorMapControlPoints` are not groups of four numbers"));
    };
    let mut points: Vec<_> = points
        .iter()
        .map(|&[h, s, v, x]| (low + x * (high - low), [h, s, v]))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let kind = number(map, "ColorInterpolationType")?.unwrap_or(0.0);
    for pair in points.windows(2) {
        let [(from, left), (to, right)] = [pair[0], pair[1]];
        let between = |t: f64| from + t * (to - from);
        if kind == 1.0 {
            let steps = [(0.0, left), (0.5, left), (0.5, right)];
            draft
                .color
                .extend(steps.map(|(t, hsv)| (between(t), rgb_of_hsv(hsv))));
            continue;
        }
        let parts = PARTS
            .min(super::super::MAX_POINTS / points.len() / 2)
            .max(1);
        let (ends, right_hue) = ([left, right].map(rgb_of_hsv), around(left, right, 1.0)[0]);
        let mut places: Vec<f64> = (0..parts).map(|part| part as f64 / parts as f64).collect();
        places.extend(corners(left[0], right_hue));
        places.sort_by(f64::total_cmp);
        for t in places {
            let rgb = match kind {
                4.0 => mixed(Space::Diverging, ends[0], ends[1], t),
                _ => rgb_of_hsv(around(left, right, t)),
            };
            draft.color.push((between(t), rgb));
        }
    }
    draft
        .color
        .extend(points.last().map(|&(x, hsv)| (x, rgb_of_hsv(hsv))));
    Ok(())
}

/// Hue, saturation and value, the hue by the shorter way round.
fn around(left: [f64; 3], mut right: [f64; 3], t: f64) -> [f64; 3] {
    let way = right[0] - left[0];
    right[0] -= way.round();
    std::array::from_fn(|k| left[k] + t * (right[k] - left[k]))
}

fn opacities(draft: &mut Draft, root: &Element, otherwise: [f64; 2]) -> Result<(), FileProblem> {
    let maps = root
        .all()
        .into_iter()
        .filter(|e| e.name == "OpacityMapParams");
    let mut enabled = Vec::new();
    for map in maps {
        if number(map, "Enabled")?.unwrap_or(1.0) != 0.0 {
            enabled.push(map);
        }
    }
    let Some(map) = enabled.first() else {
        return Ok(());
    };
    if enabled.len() > 1 {
        let said = format!("all but the first of {} opacity maps", enabled.len());
        draft.left_out.push(said);
    }
    if number(map, "Type")?.unwrap_or(0.0) != 0.0 {
        return Err(draft
            .refuse("its opacity is a bell or a wave, which is not taken; wanted control points"));
    }
    if number(map, "OpacityInterpolation")?.unwrap_or(0.0) != 0.0 {
        draft
            .left_out
            .push("the interpolation of opacity: it is linear here".to_owned());
    }
    let scale = number(root, "OpacityScale")?.unwrap_or(1.0);
    let [low, high] = bounds(draft, map, otherwise)?;
    let numbers = map.child("OpacityMapControlPoints").map(Element::numbers);
    let numbers = numbers.transpose()?.unwrap_or_default();
    let (points, []) = numbers.as_chunks::<2>() else {
        return Err(draft.refuse("`OpacityMapControlPoints` are not pairs of numbers"));
    };
    let points = points
        .iter()
        .map(|&[opacity, x]| (low + x * (high - low), scale * opacity));
    draft.opacity = points.collect();
    Ok(())
}
