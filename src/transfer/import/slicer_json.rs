//! 3D Slicer's volume property as JSON, schema `volume-property-schema-v1.0.0`: the first component of the
//! first property.

use super::super::FileProblem;
use super::Imported;
use super::draft::{Curve, Draft};
use serde_json::Value;

const ORIGIN: &str = "a 3D Slicer volume property (JSON)";

pub(super) fn read(value: &Value) -> Result<Imported, FileProblem> {
    let mut draft = Draft::new(ORIGIN);
    let properties = list(value, "volumeProperties");
    let Some(property) = properties.first() else {
        return Err(draft.refuse("`volumeProperties` is empty"));
    };
    let components = list(property, "components");
    let Some(component) = components.first() else {
        return Err(draft.refuse("the property has no `components`"));
    };
    for (more, what) in [
        (properties.len(), "properties"),
        (components.len(), "components"),
    ] {
        if more > 1 {
            draft
                .left_out
                .push(format!("all but the first of {more} {what}"));
        }
    }
    let opacity = points(&draft, component, "scalarOpacity", |point| {
        Some([number(point, "x")?, number(point, "y")?])
    })?;
    draft.add_opacities(&opacity);
    let color = points(&draft, component, "rgbTransferFunction", |point| {
        let [r, g, b] = <[f64; 3]>::try_from(numbers(point.get("color")?)?).ok()?;
        Some([number(point, "x")?, r, g, b])
    })?;
    let color = color
        .into_iter()
        .map(|([x, r, g, b], curve)| (x, [r, g, b], curve));
    draft.add_colors(&color.collect::<Vec<_>>());
    draft.reference_length = number(component, "scalarOpacityUnitDistance").or(Some(1.0));
    if draft
        .reference_length
        .is_some_and(|length| !(length > 0.0 && length.is_finite()))
    {
        return Err(draft.refuse("`scalarOpacityUnitDistance` is not over 0"));
    }
    name_the_rest(&mut draft, property, component)?;
    draft.finish()
}

/// Says what of the property has no place in a function of ours.
fn name_the_rest(
    draft: &mut Draft,
    property: &Value,
    component: &Value,
) -> Result<(), FileProblem> {
    let gradient = points(draft, component, "gradientOpacity", |point| {
        Some([number(point, "x")?, number(point, "y")?])
    })?;
    let is_off = component["disableGradientOpacity"] == true;
    if !is_off && gradient.iter().any(|([_, opacity], _)| *opacity != 1.0) {
        draft
            .left_out
            .push("the opacity by gradient magnitude".to_owned());
    }
    if component["shade"] == true {
        draft
            .left_out
            .push("the light: ambient, diffuse and specular".to_owned());
    }
    if number(component, "componentWeight").is_some_and(|weight| weight != 1.0) {
        draft
            .left_out
            .push("the weight of the component".to_owned());
    }
    if !list(property, "isoSurfaceValues").is_empty() {
        draft.left_out.push("the values of its surfaces".to_owned());
    }
    if number(property, "scatteringAnisotropy").is_some_and(|share| share != 0.0) {
        draft.left_out.push("the scattering".to_owned());
    }
    match property["interpolationType"].as_str() {
        None | Some("linear") => {}
        Some(other) => draft.left_out.push(format!(
            "the interpolation ({other}), which is --filter here"
        )),
    }
    Ok(())
}

/// The points of a function of the component; none where it has no such function.
fn points<const N: usize>(
    draft: &Draft,
    component: &Value,
    key: &str,
    point: impl Fn(&Value) -> Option<[f64; N]>,
) -> Result<Vec<([f64; N], Curve)>, FileProblem> {
    let points = component.get(key).map(|function| list(function, "points"));
    let points = points
        .unwrap_or_default()
        .iter()
        .enumerate()
        .map(|(i, found)| {
            let curve = Curve {
                midpoint: number(found, "midpoint").unwrap_or(0.5),
                sharpness: number(found, "sharpness").unwrap_or(0.0),
            };
            let point = point(found).map(|point| (point, curve));
            point
                .ok_or_else(|| draft.refuse(format!("`{key}` point {i} is no point of its schema")))
        });
    points.collect()
}

fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value
        .get(key)
        .and_then(Value::as_array)
        .map_or(&[], Vec::as_slice)
}

fn number(value: &Value, key: &str) -> Option<f64> {
    value.get(key)?.as_f64()
}

fn numbers(value: &Value) -> Option<Vec<f64>> {
    value.as_array()?.iter().map(Value::as_f64).collect()
}
