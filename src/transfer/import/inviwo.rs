//! Inviwo's `.itf`: XML with `Points`, each `<pos content="0.5"/><rgba x y z w/>`, at fractions (`type` 0) or
//! at values (`type` 1), transparent outside `maskMin` to `maskMax`.

use super::super::FileProblem;
use super::draft::{Curve, Draft};
use super::xml::Element;
use super::{Imported, Scale};

const ORIGIN: &str = "an Inviwo transfer function (.itf)";

pub(super) fn read(root: &Element) -> Result<Imported, FileProblem> {
    let mut draft = Draft::new(ORIGIN);
    let content = |name: &str| match root.find(name) {
        Some(element) => element.number("content"),
        None => Ok(None),
    };
    draft.scale = match content("type")? {
        Some(kind) if kind != 0.0 => Scale::Values,
        _ => Scale::Fractions,
    };
    let mut points = Vec::new();
    for point in root.all() {
        let (Some(place), Some(rgba)) = (point.child("pos"), point.child("rgba")) else {
            continue;
        };
        // Older versions kept a place in the plane of their editor.
        let place = match place.number("content")? {
            Some(place) => place,
            None => place.needed("x")?,
        };
        let [r, g, b, a] = [
            rgba.needed("x")?,
            rgba.needed("y")?,
            rgba.needed("z")?,
            rgba.needed("w")?,
        ];
        points.push((place, [r, g, b], a));
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let color: Vec<_> = points
        .iter()
        .map(|&(x, rgb, _)| (x, rgb, Curve::LINE))
        .collect();
    let opacity: Vec<_> = points
        .iter()
        .map(|&(x, _, a)| ([x, a], Curve::LINE))
        .collect();
    draft.add_colors(&color);
    draft.add_opacities(&opacity);
    let whole = match draft.scale {
        Scale::Fractions => [0.0, 1.0],
        Scale::Values => [f64::from(f32::MIN), f64::from(f32::MAX)],
    };
    let mask = [
        content("maskMin")?.unwrap_or(whole[0]),
        content("maskMax")?.unwrap_or(whole[1]),
    ];
    if mask[0] > whole[0] || mask[1] < whole[1] {
        draft.mask(mask);
    }
    draft.finish()
}
