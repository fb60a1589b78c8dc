//! ParaView's colour maps: JSON with flat lists (`RGBPoints`: x r g b, `Points`: x opacity midpoint sharpness),
//! and the older XML (`Point x o r g b`).
//!
//! Colours of another space than RGB are mixed there and written down in steps; straight lines between the
//! steps differ from the curve by less than half of one part in 255.

use super::super::FileProblem;
use super::color::{Space, mixed, places};
use super::draft::{Curve, Draft};
use super::xml::Element;
use super::{Imported, Scale, choose};
use serde_json::Value;

const ORIGIN: &str = "a ParaView colour map";
/// Of a segment, where there are few; even, so that the middle of a diverging map is one of them.
const PARTS: usize = 64;

pub(super) fn json(value: &Value, wanted: Option<&str>) -> Result<Imported, FileProblem> {
    let all = match value.as_array() {
        Some(all) => all.as_slice(),
        None => std::slice::from_ref(value),
    };
    let name = |map: &Value| map.get("Name").and_then(Value::as_str).map(str::to_owned);
    let map = choose(ORIGIN, all, name, wanted)?;
    let mut draft = Draft::new(ORIGIN);
    draft.name = name(map);
    let colors = flat(&draft, map, "RGBPoints")?;
    if colors.is_empty() {
        let has_indexed = map.get("IndexedColors").is_some();
        return Err(draft.refuse(match has_indexed {
            true => "its colours are for categories (`IndexedColors`), which are not taken",
            false => "it has no `RGBPoints`",
        }));
    }
    let colors: Vec<_> = colors.iter().map(|&[x, r, g, b]| (x, [r, g, b])).collect();
    let space = map
        .get("ColorSpace")
        .and_then(Value::as_str)
        .unwrap_or("RGB");
    let wraps = map
        .get("HSVWrap")
        .is_some_and(|wrap| *wrap == true || wrap.as_f64() == Some(1.0));
    add_colors(&mut draft, colors, space, wraps)?;
    let opacities = flat(&draft, map, "Points")?
        .into_iter()
        .map(|[x, y, midpoint, sharpness]| {
            let curve = Curve {
                midpoint,
                sharpness,
            };
            ([x, y], curve)
        });
    draft.add_opacities(&opacities.collect::<Vec<_>>());
    if map.get("NanColor").is_some() {
        draft
            .left_out
            .push("the colour of NaN: no data is transparent here".to_owned());
    }
    for (key, what) in [
        ("UseLogScale", "the logarithmic scale"),
        ("UseBelowRangeColor", "the colour below the range"),
        ("UseAboveRangeColor", "the colour above the range"),
    ] {
        if map
            .get(key)
            .is_some_and(|on| *on == true || on.as_f64() == Some(1.0))
        {
            draft.left_out.push(what.to_owned());
        }
    }
    finish(draft)
}

pub(super) fn xml(root: &Element, wanted: Option<&str>) -> Result<Imported, FileProblem> {
    let all = root.all();
    let all: Vec<_> = all.into_iter().filter(|e| e.name == "ColorMap").collect();
    let name = |map: &&Element| map.attribute("name").map(str::to_owned);
    let map = choose(ORIGIN, &all, name, wanted)?;
    let mut draft = Draft::new(ORIGIN);
    draft.name = name(map);
    let (mut colors, mut opacities) = (Vec::new(), Vec::new());
    for point in map.children.iter().filter(|child| child.name == "Point") {
        let x = point.needed("x")?;
        colors.push((
            x,
            [point.needed("r")?, point.needed("g")?, point.needed("b")?],
        ));
        if let Some(opacity) = point.number("o")? {
            opacities.push(([x, opacity], Curve::LINE));
        }
    }
    add_colors(
        &mut draft,
        colors,
        map.attribute("space").unwrap_or("RGB"),
        false,
    )?;
    // Opaque from end to end is what these maps say where nobody thought of opacity.
    if opacities.iter().any(|([_, opacity], _)| *opacity != 1.0) {
        draft.add_opacities(&opacities);
    }
    if map.child("NaN").is_some() {
        draft
            .left_out
            .push("the colour of NaN: no data is transparent here".to_owned());
    }
    finish(draft)
}

/// A map from 0 to 1 is one for any range.
fn finish(mut draft: Draft) -> Result<Imported, FileProblem> {
    let ends = |values: &mut dyn Iterator<Item = f64>| {
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        })
    };
    if ends(&mut draft.color.iter().map(|p| p.0)) == [0.0, 1.0] {
        draft.scale = Scale::Fractions;
    }
    draft.finish()
}

fn add_colors(
    draft: &mut Draft,
    mut points: Vec<(f64, [f64; 3])>,
    space: &str,
    wraps: bool,
) -> Result<(), FileProblem> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let space = match space {
        "RGB" => {
            draft.color = points;
            return Ok(());
        }
        "Step" => {
            // The colour of a step is that of its right end, and below all steps that of the first point.
            draft.color.extend(points.first());
            for pair in points.windows(2) {
                draft
                    .color
                    .extend([(pair[0].0, pair[1].1), (pair[1].0, pair[1].1)]);
            }
            return Ok(());
        }
        "HSV" => Space::Hsv { wraps },
        "Lab" | "CIELAB" => Space::Lab,
        "Diverging" => Space::Diverging,
        other => {
            return Err(draft.refuse(format!("colours mixed in {other:?} are not taken")));
        }
    };
    let room = super::super::MAX_POINTS / points.len().max(1);
    // Some are added where hues have corners.
    let parts = PARTS.min(room / 4 * 2).max(1);
    for pair in points.windows(2) {
        let [(from, left), (to, right)] = [pair[0], pair[1]];
        for t in places(space, left, right, parts) {
            let at = from + t * (to - from);
            draft.color.push((at, mixed(space, left, right, t)));
        }
    }
    draft.color.extend(points.last());
    Ok(())
}

/// Groups of four numbers.
fn flat(draft: &Draft, map: &Value, key: &str) -> Result<Vec<[f64; 4]>, FileProblem> {
    let Some(list) = map.get(key) else {
        return Ok(Vec::new());
    };
    let numbers: Option<Vec<f64>> = list
        .as_array()
        .and_then(|list| list.iter().map(Value::as_f64).collect());
    let groups = numbers.as_deref().map(|numbers| numbers.as_chunks::<4>());
    match groups {
        Some((groups, [])) => Ok(groups.to_vec()),
        _ => Err(draft.refuse(format!("`{key}` is no list of numbers in groups of four"))),
    }
}
