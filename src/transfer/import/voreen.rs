//! Voreen's `.tfi`: XML `VoreenData` with `Keys`, each an `intensity` of the `domain`, a colour on its left and,
//! where it is `split`, another on its right, 0 to 255; transparent outside `threshold`.

use super::super::FileProblem;
use super::draft::Draft;
use super::xml::Element;
use super::{Imported, Scale};

const ORIGIN: &str = "a Voreen transfer function (.tfi)";

pub(super) fn read(root: &Element) -> Result<Imported, FileProblem> {
    let mut draft = Draft::new(ORIGIN);
    let Some(keys) = root.find("Keys") else {
        return Err(draft.refuse("it has no `Keys`: a function of two dimensions is not taken"));
    };
    let pair = |name: &str| match root.find(name) {
        Some(element) => Ok([element.needed("x")?, element.needed("y")?]),
        None => Ok([0.0, 1.0]),
    };
    let [low, high] = pair("domain")?;
    draft.scale = match [low, high] == [0.0, 1.0] {
        true => Scale::Fractions,
        false => Scale::Values,
    };
    let value = |intensity: f64| low + intensity * (high - low);
    let mut found = Vec::new();
    for key in &keys.children {
        let Some(place) = key.child("intensity") else {
            continue;
        };
        let place = value(place.needed("value")?);
        found.push((place, color(&draft, key, "colorL")?));
        if key
            .child("split")
            .and_then(|split| split.attribute("value"))
            == Some("true")
        {
            found.push((place, color(&draft, key, "colorR")?));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (place, [r, g, b, a]) in found {
        draft.color.push((place, [r, g, b]));
        draft.opacity.push((place, a));
    }
    let [from, to] = pair("threshold")?;
    if [from, to] != [0.0, 1.0] {
        draft.mask([value(from), value(to)]);
    }
    let says = |name: &str| {
        root.find(name)
            .map(|e| e.number("value"))
            .transpose()
            .map(Option::flatten)
    };
    if says("gammaValue")?.is_some_and(|gamma| gamma != 1.0) {
        draft.left_out.push("the gamma value".to_owned());
    }
    if says("alphaMode")?.is_some_and(|mode| mode != 1.0) {
        draft
            .left_out
            .push("the alpha mode: opacities are taken as they stand".to_owned());
    }
    draft.finish()
}

fn color(draft: &Draft, key: &Element, name: &str) -> Result<[f64; 4], FileProblem> {
    let Some(color) = key.child(name) else {
        return Err(draft.refuse(format!("a key has no `{name}`")));
    };
    let mut found = [0.0; 4];
    for (share, name) in found.iter_mut().zip(["r", "g", "b", "a"]) {
        *share = color.needed(name)? / 255.0;
    }
    Ok(found)
}
