//! Transfer functions in files: the JSON of `cli.md`, "Transfer function file", and `docs/transfer-functions.md`.

use super::field::{points, wrong};
use super::file_medium::{MediumKeys, medium_to_json};
use super::file_widgets::{GradientKeys, gradient_transfer, gradient_transfer_to_json, materials};
use super::{ColorPoint, Interpolation, MediumPoint, OpacityPoint, TransferFunction};
use crate::color::encode_srgb;
use serde::Deserialize;
use serde_json::Value;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The largest file that is read.
pub const MAX_FILE_BYTES: u64 = 1 << 20;
/// A shader searches the points one by one.
pub const MAX_POINTS: usize = 4096;
const VERSION: u64 = 1;

/// What went wrong with a transfer function file, and with which one.
#[derive(Debug, thiserror::Error)]
#[error("cannot read transfer function {}: {problem}", path.display())]
pub struct FileError {
    /// The file.
    pub path: PathBuf,
    /// What was found there.
    #[source]
    pub problem: FileProblem,
}

/// What can be wrong with a transfer function file.
#[derive(Debug, thiserror::Error)]
pub enum FileProblem {
    /// The system would not let us.
    #[error("the file cannot be read")]
    Io(#[source] std::io::Error),
    /// Longer than any transfer function is.
    #[error("the file has more than {MAX_FILE_BYTES} bytes")]
    TooLong,
    /// Not JSON, or a key that is unknown, doubled or missing; with line and column.
    #[error("{0}")]
    Json(String),
    /// Not XML as it is read here.
    #[error("XML: {0}")]
    Xml(String),
    /// No kind of file that is known here; says what it is instead.
    #[error(
        "it is {0}; transfer functions of stratavox, 3D Slicer, ParaView, Inviwo, Voreen and VAPOR and rows of points are read"
    )]
    Unknown(String),
    /// A file of another program that is wrong, or says what cannot be taken over.
    #[error("{origin}: {problem}")]
    Foreign {
        /// What the file is.
        origin: &'static str,
        /// What is wrong with it.
        problem: String,
    },
    /// Matter that would scatter more light than meets it.
    #[error(
        "field `{field}`: albedo over 1 at value {value}: light would grow; wanted 0 to 1, found {found}"
    )]
    Grows {
        /// As in `albedo[3][1]`.
        field: String,
        /// Where.
        value: f64,
        /// What stands there.
        found: f64,
    },
    /// A field says something that cannot be.
    #[error("field `{field}`: wanted {wanted}, found {found}")]
    Field {
        /// As in `opacity[3][1]`.
        field: String,
        /// What would do.
        wanted: &'static str,
        /// What stands there.
        found: String,
    },
}

/// The transfer function in the file at `path`.
pub fn read_transfer_function(path: &Path) -> Result<TransferFunction, FileError> {
    let of_file = |problem| FileError {
        path: path.to_owned(),
        problem,
    };
    let text = read_limited(path).map_err(of_file)?;
    transfer_function_in(&text, path.parent()).map_err(of_file)
}

/// The bytes of a file that is not too long.
pub(super) fn read_limited(path: &Path) -> Result<Vec<u8>, FileProblem> {
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes))
        .map_err(FileProblem::Io)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(FileProblem::TooLong);
    }
    Ok(bytes)
}

/// The transfer function that `text` states. It names no other file, because it stands in no folder.
pub fn transfer_function_from_json(text: &[u8]) -> Result<TransferFunction, FileProblem> {
    transfer_function_in(text, None)
}

/// The transfer function that the text of a file in `folder` states.
pub(super) fn transfer_function_in(
    text: &[u8],
    folder: Option<&Path>,
) -> Result<TransferFunction, FileProblem> {
    let keys: Keys =
        serde_json::from_slice(text).map_err(|cause| FileProblem::Json(cause.to_string()))?;
    if keys.stratavox_transfer_function.as_u64() != Some(VERSION) {
        let found = &keys.stratavox_transfer_function;
        return Err(wrong(
            "stratavox_transfer_function",
            "1, the only version",
            found,
        ));
    }
    let reference_length = match &keys.reference_length {
        None => None,
        Some(found) => match found.as_f64().filter(|&x| x > 0.0 && x.is_finite()) {
            None => return Err(wrong("reference_length", "a positive number", found)),
            length => length,
        },
    };
    if let Some(found) = keys
        .preintegrated
        .as_ref()
        .filter(|found| !found.is_boolean())
    {
        return Err(wrong("preintegrated", "true or false", found));
    }
    if let Some(found) = &keys.materials {
        return of_materials(&keys, found, reference_length);
    }
    let interpolation = match &keys.interpolation {
        None => Interpolation::Linear,
        Some(found) => match found.as_str() {
            Some("linear") => Interpolation::Linear,
            Some("step") => Interpolation::Step,
            _ => return Err(wrong("interpolation", "\"linear\" or \"step\"", found)),
        },
    };
    let medium_keys = MediumKeys {
        extinction: &keys.extinction,
        albedo: &keys.albedo,
        emission: &keys.emission,
        phase: &keys.phase,
    };
    let mut medium = medium_keys.medium()?;
    keys.check_beside_medium()?;
    let gradient_keys = GradientKeys {
        gradient_opacity: keys.gradient_opacity,
        steepest: keys.steepest,
        widgets: keys.widgets,
    };
    let gradient_transfer = gradient_transfer(gradient_keys, folder)?;
    // Widgets may be all there is, each in a colour of its own.
    let widgets = gradient_transfer
        .iter()
        .flat_map(|gradient_transfer| &gradient_transfer.widgets);
    let (mut has_widgets, mut all_have_colors) = (false, true);
    for widget in widgets {
        has_widgets = true;
        all_have_colors &= widget.has_color();
    }
    let color = match &keys.color {
        Some(found) => points("color", "[value, r, g, b]", found)?,
        None if has_widgets && all_have_colors => vec![[0.0; 4]],
        None => match medium.as_ref().map(|medium| &medium.albedo) {
            Some(albedo) if !albedo.is_empty() => albedo.iter().map(as_color).collect(),
            _ => return Err(missing("color")),
        },
    };
    let extinction = medium.as_mut().map(|m| std::mem::take(&mut m.extinction));
    let extinction = extinction.filter(|points| !points.is_empty());
    let opacity = match &keys.opacity {
        _ if extinction.is_some() => Vec::new(),
        Some(found) => points("opacity", "[value, opacity]", found)?,
        None if has_widgets => vec![[color[0][0], 0.0]],
        None => return Err(missing("opacity")),
    };
    let color = color.into_iter().map(|[value, r, g, b]| ColorPoint {
        value,
        srgb: [r, g, b],
    });
    let opacity = opacity
        .into_iter()
        .map(|[value, opacity]| OpacityPoint { value, opacity });
    let function = TransferFunction {
        color: color.collect(),
        opacity: opacity.collect(),
        reference_length,
        interpolation,
        gradient_transfer,
        medium: medium.map(Box::new),
    };
    Ok(match extinction {
        Some(points) => function.with_extinction(points),
        None => function,
    })
}

/// What scatters in a colour is seen in it.
fn as_color(point: &MediumPoint) -> [f64; 4] {
    let [r, g, b] = point.linear.map(encode_srgb);
    [point.value, r, g, b]
}

/// `materials` say colour and opacity, and between their corners everything is a straight line.
fn of_materials(
    keys: &Keys,
    found: &Value,
    reference_length: Option<f64>,
) -> Result<TransferFunction, FileProblem> {
    let others = [
        ("color", &keys.color),
        ("opacity", &keys.opacity),
        ("interpolation", &keys.interpolation),
        ("gradient_opacity", &keys.gradient_opacity),
        ("steepest", &keys.steepest),
        ("widgets", &keys.widgets),
        ("extinction", &keys.extinction),
        ("albedo", &keys.albedo),
        ("emission", &keys.emission),
        ("phase", &keys.phase),
    ];
    for (key, other) in others {
        if let Some(other) = other {
            return Err(wrong(key, "no such key beside `materials`", other));
        }
    }
    materials(found, reference_length)
}

fn missing(key: &str) -> FileProblem {
    FileProblem::Json(format!("missing field `{key}`"))
}

/// The text of a file that states `function`; reading it gives the same function back.
pub fn transfer_function_to_json(function: &TransferFunction) -> String {
    let row = |numbers: &[f64]| format!("    {}", Value::from(numbers));
    let color = function.color.iter();
    let color = color.map(|p| row(&[p.value, p.srgb[0], p.srgb[1], p.srgb[2]]));
    let opacity = function.opacity.iter().map(|p| row(&[p.value, p.opacity]));
    let medium = function.medium.as_deref();
    let opacity = match medium.is_some_and(|medium| !medium.extinction.is_empty()) {
        true => String::new(),
        false => {
            let rows = opacity.collect::<Vec<_>>().join(",\n");
            format!("  \"opacity\": [\n{rows}\n  ],\n")
        }
    };
    let length = function.reference_length;
    let length = length.map(|length| format!("  \"reference_length\": {},\n", Value::from(length)));
    let interpolation = match function.interpolation {
        Interpolation::Linear => "linear",
        Interpolation::Step => "step",
    };
    format!(
        "{{\n  \"stratavox_transfer_function\": {VERSION},\n  \"color\": [\n{}\n  ],\n{}{}{}{}  \"interpolation\": \"{interpolation}\"\n}}\n",
        color.collect::<Vec<_>>().join(",\n"),
        opacity,
        length.unwrap_or_default(),
        function
            .gradient_transfer
            .as_ref()
            .map(gradient_transfer_to_json)
            .unwrap_or_default(),
        medium.map(medium_to_json).unwrap_or_default(),
    )
}

/// serde refuses unknown, doubled and missing keys; what stands behind them is checked here, by name.
#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an object with stratavox_transfer_function, color and opacity"
)]
struct Keys {
    stratavox_transfer_function: Value,
    #[serde(default)]
    color: Option<Value>,
    #[serde(default)]
    opacity: Option<Value>,
    #[serde(default)]
    materials: Option<Value>,
    #[serde(default)]
    reference_length: Option<Value>,
    #[serde(default)]
    interpolation: Option<Value>,
    #[serde(default)]
    gradient_opacity: Option<Value>,
    #[serde(default)]
    steepest: Option<Value>,
    #[serde(default)]
    widgets: Option<Value>,
    #[serde(default)]
    preintegrated: Option<Value>,
    #[serde(default)]
    extinction: Option<Value>,
    #[serde(default)]
    albedo: Option<Value>,
    #[serde(default)]
    emission: Option<Value>,
    #[serde(default)]
    phase: Option<Value>,
}

impl Keys {
    /// Extinction is instead of opacity, and matter that scatters is one of the value alone.
    fn check_beside_medium(&self) -> Result<(), FileProblem> {
        let medium = [&self.extinction, &self.albedo, &self.emission, &self.phase];
        let has_medium = medium.iter().any(|key| key.is_some());
        let wanted = "no such key beside `extinction`, `albedo`, `emission` and `phase`";
        for (key, found) in [
            ("gradient_opacity", &self.gradient_opacity),
            ("widgets", &self.widgets),
        ] {
            if let (Some(found), true) = (found, has_medium) {
                return Err(wrong(key, wanted, found));
            }
        }
        match (&self.opacity, &self.extinction) {
            (Some(found), Some(_)) => {
                Err(wrong("opacity", "no such key beside `extinction`", found))
            }
            _ => Ok(()),
        }
    }
}
