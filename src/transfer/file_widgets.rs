//! Materials and widgets in a transfer function file: `docs/transfer-functions.md` has every key.

use super::field::{FRACTION, Fields, POSITIVE, VALUE, list, number, numbers, points, wrong};
use super::file_images::{cells, rows_to_json};
use super::{
    Cells, FileProblem, GradientTransfer, Material, OpacityPoint, SecondDerivative, Shape,
    TransferFunction, Widget,
};
use serde_json::{Map, Value, json};
use std::path::Path;

/// A shader asks each of them at every sample.
const MAX_WIDGETS: (usize, &str) = (64, "at most 64 of them");
const COLOR: &str = "[r, g, b]";

/// The function of `"materials"`.
pub(super) fn materials(
    found: &Value,
    reference_length: Option<f64>,
) -> Result<TransferFunction, FileProblem> {
    let rows = list(
        "materials",
        found,
        "a list of at least one material",
        MAX_WIDGETS,
    )?;
    let mut materials = Vec::with_capacity(rows.len());
    for (i, row) in rows.iter().enumerate() {
        materials.push(material(format!("materials[{i}]"), row)?);
    }
    let function = TransferFunction::of_materials(&materials, reference_length);
    let function = function.map_err(|too_much| FileProblem::Field {
        field: "materials".to_owned(),
        wanted: "memberships that sum to at most 1 at every value",
        found: format!(
            "{} at {} ({})",
            (too_much.sum * 1e6).round() / 1e6,
            too_much.value,
            too_much.names.join(", ")
        ),
    })?;
    let count = function.color.len().max(function.opacity.len());
    if count > super::MAX_POINTS {
        return Err(FileProblem::Field {
            field: "materials".to_owned(),
            wanted: "opacities less far apart: at most 4096 points",
            found: count.to_string(),
        });
    }
    Ok(function)
}

fn material(place: String, found: &Value) -> Result<Material, FileProblem> {
    let mut fields = Fields::of(place, found, "a material: name, color, opacity, trapezoid")?;
    let name = fields.take("name", "a text")?;
    let Some(text) = name.as_str() else {
        return Err(wrong(&fields.name("name"), "a text", &name));
    };
    let srgb = fields.numbers("color", COLOR, FRACTION)?;
    let opacity = fields.number("opacity", FRACTION)?;
    let corners = "[begins, is full, is full no longer, ends]";
    let trapezoid: [f64; 4] = fields.numbers("trapezoid", corners, VALUE)?;
    if !trapezoid.is_sorted() || trapezoid[0] == trapezoid[3] {
        let found = Value::from(trapezoid.to_vec());
        let wanted = "four ascending values, the last above the first";
        return Err(wrong(&fields.name("trapezoid"), wanted, &found));
    }
    fields.end()?;
    Ok(Material {
        name: text.to_owned(),
        srgb,
        opacity,
        trapezoid,
    })
}

/// The keys that speak of gradients.
pub(super) struct GradientKeys {
    pub gradient_opacity: Option<Value>,
    pub steepest: Option<Value>,
    pub widgets: Option<Value>,
}

/// What they say; `None` where none is there. `folder` is where they look for images.
pub(super) fn gradient_transfer(
    keys: GradientKeys,
    folder: Option<&Path>,
) -> Result<Option<GradientTransfer>, FileProblem> {
    let mut gradient_transfer = GradientTransfer::default();
    if let Some(found) = keys.gradient_opacity {
        gradient_transfer.share = opacity_points("gradient_opacity", "[gradient, share]", &found)?;
    }
    if let Some(found) = keys.widgets {
        let rows = list(
            "widgets",
            &found,
            "a list of at least one widget",
            MAX_WIDGETS,
        )?;
        for (i, row) in rows.iter().enumerate() {
            let widget = widget(format!("widgets[{i}]"), row, folder)?;
            gradient_transfer.widgets.push(widget);
        }
    }
    let says_nothing = gradient_transfer.share.is_empty() && gradient_transfer.widgets.is_empty();
    match keys.steepest {
        Some(found) if says_nothing => Err(wrong(
            "steepest",
            "no such key without `widgets` or `gradient_opacity`",
            &found,
        )),
        Some(found) => {
            gradient_transfer.steepest = Some(number("steepest", &found, POSITIVE)?);
            Ok(Some(gradient_transfer))
        }
        None => Ok((!says_nothing).then_some(gradient_transfer)),
    }
}

fn opacity_points(
    field: &str,
    row_wanted: &'static str,
    found: &Value,
) -> Result<Vec<OpacityPoint>, FileProblem> {
    let points = points(field, row_wanted, found)?.into_iter();
    let points = points.map(|[value, opacity]| OpacityPoint { value, opacity });
    Ok(points.collect())
}

const SHAPES: &str =
    "\"contour\", \"region\", \"triangle\", \"rectangle\", \"gaussian\" or \"image\"";

fn widget(place: String, found: &Value, folder: Option<&Path>) -> Result<Widget, FileProblem> {
    let mut fields = Fields::of(place, found, "a widget: an object with a shape")?;
    let kind = fields.take("shape", SHAPES)?;
    let shape = match kind.as_str() {
        Some("contour") => Shape::Contour {
            value: fields.number("value", VALUE)?,
            half_width: fields.number_or("half_width", POSITIVE, 2.0)?,
        },
        Some("region") => region(&mut fields)?,
        Some("triangle") => {
            let top = fields.number_or("top", POSITIVE, 1.0)?;
            Shape::Triangle {
                value: fields.number("value", VALUE)?,
                half_width: fields.number("half_width", POSITIVE)?,
                threshold: fields.number_or("threshold", VALUE, 0.0)?,
                top,
            }
        }
        Some("rectangle") => Shape::Rectangle {
            values: range(&mut fields, "values")?,
            gradients: range(&mut fields, "gradients")?,
        },
        Some("gaussian") => Shape::Gaussian {
            value: fields.number("value", VALUE)?,
            gradient: fields.number("gradient", VALUE)?,
            sigma_value: fields.number("sigma_value", POSITIVE)?,
            sigma_gradient: fields.number("sigma_gradient", POSITIVE)?,
        },
        Some("image") => image(&mut fields, folder)?,
        _ => return Err(wrong(&fields.name("shape"), SHAPES, &kind)),
    };
    let opacity = match shape {
        // Its points say how opaque it is.
        Shape::Region { .. } => fields.number_or("opacity", FRACTION, 1.0)?,
        _ => fields.number("opacity", FRACTION)?,
    };
    let is_painted = matches!(
        &shape,
        Shape::Image {
            cells: Cells::Rgba(_),
            ..
        }
    );
    let srgb = match fields.optional("color") {
        Some(found) if is_painted => {
            let wanted = "no such key: the cells of the image have colours";
            return Err(wrong(&fields.name("color"), wanted, &found));
        }
        Some(found) => Some(numbers(&fields.name("color"), &found, COLOR, |_| FRACTION)?),
        None => None,
    };
    let second = second(&mut fields)?;
    fields.end()?;
    Ok(Widget {
        srgb,
        opacity,
        shape,
        second,
    })
}

fn region(fields: &mut Fields) -> Result<Shape, FileProblem> {
    let wanted = "a list of at least two points";
    let found = fields.take("points", wanted)?;
    let points = opacity_points(&fields.name("points"), "[value, opacity]", &found)?;
    if points.len() < 2 || points.len() > MAX_WIDGETS.0 {
        let wanted = "2 to 64 points";
        return Err(wrong(&fields.name("points"), wanted, &found));
    }
    Ok(Shape::Region { points })
}

/// Two numbers, the second above the first.
fn range(fields: &mut Fields, key: &str) -> Result<[f64; 2], FileProblem> {
    let wanted = "[from, to], the second above the first";
    let range: [f64; 2] = fields.numbers(key, wanted, VALUE)?;
    if range[0] < range[1] {
        return Ok(range);
    }
    let found = Value::from(range.to_vec());
    Err(wrong(&fields.name(key), wanted, &found))
}

fn image(fields: &mut Fields, folder: Option<&Path>) -> Result<Shape, FileProblem> {
    let values = range(fields, "values")?;
    let gradients = range(fields, "gradients")?;
    let (columns, cells) = cells(fields, folder)?;
    Ok(Shape::Image {
        values,
        gradients,
        columns,
        cells,
    })
}

const SECOND: &str =
    "[from, to], [begins, is full, is full no longer, ends], or a number with `sigma_second`";

/// The weight by the second derivative.
fn second(fields: &mut Fields) -> Result<Option<SecondDerivative>, FileProblem> {
    let Some(found) = fields.optional("second") else {
        return Ok(None);
    };
    let field = fields.name("second");
    if found.is_number() {
        let middle = number(&field, &found, VALUE)?;
        let sigma = fields.number("sigma_second", POSITIVE)?;
        return Ok(Some(SecondDerivative::Bell { middle, sigma }));
    }
    let corners = match found.as_array().map(Vec::len) {
        Some(2) => {
            let [from, to] = numbers(&field, &found, SECOND, |_| VALUE)?;
            [from, from, to, to]
        }
        _ => numbers(&field, &found, SECOND, |_| VALUE)?,
    };
    if !corners.is_sorted() || corners[0] == corners[3] {
        let wanted = "ascending numbers, the last above the first";
        return Err(wrong(&field, wanted, &found));
    }
    Ok(Some(SecondDerivative::Trapezoid(corners)))
}

/// The lines of a file that state `gradient_transfer`, each with a comma behind it.
pub(super) fn gradient_transfer_to_json(gradient_transfer: &GradientTransfer) -> String {
    let mut lines = String::new();
    if let Some(steepest) = gradient_transfer.steepest {
        lines += &format!("  \"steepest\": {},\n", Value::from(steepest));
    }
    if !gradient_transfer.share.is_empty() {
        lines += &format!(
            "  \"gradient_opacity\": {},\n",
            rows(&gradient_transfer.share)
        );
    }
    if !gradient_transfer.widgets.is_empty() {
        let widgets = gradient_transfer.widgets.iter();
        let widgets = widgets.map(|widget| format!("    {}", widget_to_json(widget)));
        let widgets: Vec<_> = widgets.collect();
        lines += &format!("  \"widgets\": [\n{}\n  ],\n", widgets.join(",\n"));
    }
    lines
}

fn rows(points: &[OpacityPoint]) -> Value {
    points.iter().map(|p| json!([p.value, p.opacity])).collect()
}

fn widget_to_json(widget: &Widget) -> Value {
    let shape = match &widget.shape {
        Shape::Contour { value, half_width } => {
            json!({"shape": "contour", "value": value, "half_width": half_width})
        }
        Shape::Region { points } => json!({"shape": "region", "points": rows(points)}),
        Shape::Triangle {
            value,
            half_width,
            threshold,
            top,
        } => json!({
            "shape": "triangle", "value": value, "half_width": half_width,
            "threshold": threshold, "top": top,
        }),
        Shape::Rectangle { values, gradients } => {
            json!({"shape": "rectangle", "values": values, "gradients": gradients})
        }
        Shape::Gaussian {
            value,
            gradient,
            sigma_value,
            sigma_gradient,
        } => json!({
            "shape": "gaussian", "value": value, "gradient": gradient,
            "sigma_value": sigma_value, "sigma_gradient": sigma_gradient,
        }),
        Shape::Image {
            values,
            gradients,
            columns,
            cells,
        } => {
            let rows = rows_to_json(*columns, cells);
            json!({"shape": "image", "values": values, "gradients": gradients, "rows": rows})
        }
    };
    let mut keys: Map<String, Value> = match shape {
        Value::Object(keys) => keys,
        _ => Map::new(),
    };
    keys.insert("opacity".to_owned(), widget.opacity.into());
    if let Some(srgb) = widget.srgb {
        keys.insert("color".to_owned(), json!(srgb));
    }
    match widget.second {
        None => {}
        Some(SecondDerivative::Trapezoid(corners)) => {
            keys.insert("second".to_owned(), json!(corners));
        }
        Some(SecondDerivative::Bell { middle, sigma }) => {
            keys.insert("second".to_owned(), middle.into());
            keys.insert("sigma_second".to_owned(), sigma.into());
        }
    }
    Value::Object(keys)
}
