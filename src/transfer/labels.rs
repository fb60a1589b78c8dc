//! What labels are called and how they look, from the files in which people keep that.
//!
//! | file | a line, or key |
//! |---|---|
//! | JSON of `cli.md` | `"labels": [[value, "name", r, g, b, a], ...]`, numbers from 0 to 1; or `color` and `opacity` |
//! | ITK-SNAP label description | `index r g b alpha visible mesh "name"`, colours to 255, the rest to 1 |
//! | Slicer colour table, FreeSurfer | `index name r g b a`, all to 255; a table in which every `a` is 0 counts them as opaque |
//! | list of names | `index name`, and what follows is not looked at |
//!
//! In text files `#` begins a comment. A JSON file may also say `"mask": true`, by which labels of opacity 0 hide what
//! lies there, and `"dim": [label, ...]` with `"dim_share": 0.2`, by which what lies there is faint and grey.

use super::automatic::label_color;
use super::law::MAX_OPACITY;
use super::{
    ColorPoint, FileProblem, Interpolation, OpacityPoint, TransferFunction,
    transfer_function_from_json,
};
use crate::color::{decode_srgb, encode_srgb};
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// Opacity of a label of which none is said, per 1/512 of the diagonal.
const OPACITY: f64 = 0.05;

/// Names, colours and opacities of labels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LabelTable {
    /// By their number; one that is not here is not shown, where any is.
    pub labels: BTreeMap<i64, Label>,
    /// Labels of opacity 0 hide what lies there.
    pub hides: bool,
    /// What lies where these labels are is faint and grey.
    pub dimmed: Vec<i64>,
    /// What is left of the opacity and of the colour of these, 0 to 1.
    pub dim: Option<f64>,
    /// Of labels whose opacity is not said, per 1/512 of the diagonal, 0 to 1; .05 where this is `None`.
    pub opacity: Option<f64>,
    /// The function that was stated, in the place of labels.
    function: Option<TransferFunction>,
}

/// One label.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Label {
    /// May be empty.
    pub name: String,
    /// sRGB, 0 to 1.
    pub srgb: Option<[f64; 3]>,
    /// Per reference length, 0 to 1.
    pub opacity: Option<f64>,
}

impl LabelTable {
    /// The table that a file states.
    ///
    /// # Errors
    /// A line or a field that cannot be read, by its number or name.
    pub fn parse(text: &[u8]) -> Result<Self, FileProblem> {
        let text = String::from_utf8_lossy(text);
        let text = text.trim_start_matches('\u{feff}');
        if text.trim_start().starts_with('{') {
            return from_json(text);
        }
        let mut labels = BTreeMap::new();
        for (number, line) in (1..).zip(text.lines()) {
            let line = line.split('#').next().unwrap_or_default().trim();
            if line.is_empty() {
                continue;
            }
            let (index, label) = from_line(line).ok_or_else(|| wrong_line(number, line))?;
            if labels.insert(index, label).is_some() {
                return Err(FileProblem::Field {
                    field: format!("line {number}"),
                    wanted: "each label once",
                    found: index.to_string(),
                });
            }
        }
        if labels.is_empty() {
            return Err(FileProblem::Field {
                field: "the file".into(),
                wanted: "lines such as `1 name`",
                found: "none".into(),
            });
        }
        let is_freesurfer = labels.values().all(|label| label.opacity == Some(0.0));
        if is_freesurfer {
            labels
                .values_mut()
                .for_each(|label| label.opacity = Some(1.0));
            labels.remove(&0);
        }
        Ok(Self {
            labels,
            ..Self::default()
        })
    }

    /// The same function of labels of which some are hidden and some dimmed, for a volume of labels shown alone: what
    /// is dimmed has so much of its extinction, and of what its colour is more than grey.
    pub fn cut(
        mut function: TransferFunction,
        is_shown: impl Fn(i64) -> bool,
        is_dimmed: impl Fn(i64) -> bool,
        dim: f64,
    ) -> TransferFunction {
        for (color, point) in function.color.iter_mut().zip(&mut function.opacity) {
            // A label rules the values that round to it.
            let label = (color.value + 0.5).round() as i64;
            if !is_shown(label) {
                point.opacity = 0.0;
            } else if is_dimmed(label) {
                let transmittance = 1.0 - point.opacity.min(MAX_OPACITY);
                point.opacity = 1.0 - transmittance.powf(dim);
                let [r, g, b] = color.srgb.map(decode_srgb);
                let grey = 0.2126 * r + 0.7152 * g + 0.0722 * b;
                color.srgb = [r, g, b].map(|c| encode_srgb(grey + dim * (c - grey)));
            }
        }
        function
    }

    /// What the labels that are `present` look like, with [`Self::opacity`] where no label has one; `diagonal` is the world length of the grid's diagonal.
    pub fn function(&self, present: impl Iterator<Item = i64>, diagonal: f64) -> TransferFunction {
        let opacity = self.opacity.unwrap_or(OPACITY);
        let looks = |label: i64| match (&self.function, self.labels.get(&label)) {
            (Some(function), _) => (function.srgb(label as f64), function.opacity(label as f64)),
            (None, Some(known)) => (
                known.srgb.unwrap_or_else(|| label_color(label)),
                known
                    .opacity
                    .unwrap_or(if label == 0 { 0.0 } else { opacity }),
            ),
            (None, None) if self.labels.is_empty() && label != 0 => (label_color(label), opacity),
            (None, None) => ([0.0; 3], 0.0),
        };
        // A label rules the values that round to it.
        let looks = present.map(|label| (label as f64 - 0.5, looks(label)));
        let points = looks.map(|(value, (srgb, opacity))| {
            (ColorPoint { value, srgb }, OpacityPoint { value, opacity })
        });
        let (color, opacity) = points.unzip();
        let own = self.function.as_ref().and_then(|f| f.reference_length);
        TransferFunction {
            color,
            opacity,
            reference_length: own.or(Some(diagonal / 512.0)),
            interpolation: Interpolation::Step,
            gradient_transfer: None,
            medium: None,
        }
    }
}

fn from_json(text: &str) -> Result<LabelTable, FileProblem> {
    let mut keys: Map<String, Value> =
        serde_json::from_str(text).map_err(|cause| FileProblem::Json(cause.to_string()))?;
    let hides = match keys.remove("mask") {
        None => false,
        Some(Value::Bool(hides)) => hides,
        Some(found) => return Err(wrong("mask", "true or false", &found)),
    };
    let dimmed = match keys.remove("dim") {
        None => Vec::new(),
        Some(found) => labels_in(&found).ok_or_else(|| wrong("dim", "a list of labels", &found))?,
    };
    let dim = keys.remove("dim_share").map(|found| {
        let share = found.as_f64().and_then(fraction);
        share.ok_or_else(|| wrong("dim_share", "a number from 0 to 1", &found))
    });
    let dim = dim.transpose()?;
    let Some(rows) = keys.remove("labels") else {
        let function = transfer_function_from_json(Value::Object(keys).to_string().as_bytes())?;
        return Ok(LabelTable {
            hides,
            dimmed,
            dim,
            function: Some(function),
            ..LabelTable::default()
        });
    };
    if keys.get("stratavox_transfer_function") != Some(&Value::from(1)) {
        let found = keys
            .remove("stratavox_transfer_function")
            .unwrap_or_default();
        return Err(wrong(
            "stratavox_transfer_function",
            "1, the only version",
            &found,
        ));
    }
    let known = ["stratavox_transfer_function", "interpolation"];
    if let Some(key) = keys.keys().find(|key| !known.contains(&key.as_str())) {
        return Err(FileProblem::Json(format!(
            "unknown key `{key}` beside `labels`"
        )));
    }
    if keys
        .get("interpolation")
        .is_some_and(|found| found != "step")
    {
        return Err(wrong(
            "interpolation",
            "\"step\", as labels have no values between them",
            &keys["interpolation"],
        ));
    }
    let mut labels = BTreeMap::new();
    let list = rows.as_array().filter(|rows| !rows.is_empty());
    let list = list.ok_or_else(|| wrong("labels", "a list of at least one label", &rows))?;
    for (i, row) in list.iter().enumerate() {
        let field = format!("labels[{i}]");
        let found = from_row(row);
        let (index, label) = found.ok_or_else(|| {
            wrong(
                &field,
                "[value, \"name\", r, g, b, opacity], the last four from 0 to 1",
                row,
            )
        })?;
        if labels.insert(index, label).is_some() {
            return Err(wrong(&field, "each label once", row));
        }
    }
    Ok(LabelTable {
        labels,
        hides,
        dimmed,
        dim,
        opacity: None,
        function: None,
    })
}

fn labels_in(found: &Value) -> Option<Vec<i64>> {
    found.as_array()?.iter().map(Value::as_i64).collect()
}

fn from_row(row: &Value) -> Option<(i64, Label)> {
    let [index, name, numbers @ ..] = row.as_array()?.as_slice() else {
        return None;
    };
    let fraction = |found: &Value| found.as_f64().filter(|x| (0.0..=1.0).contains(x));
    let numbers: Vec<f64> = numbers.iter().map(fraction).collect::<Option<_>>()?;
    let [r, g, b, opacity] = numbers[..] else {
        return None;
    };
    let label = Label {
        name: name.as_str()?.to_owned(),
        srgb: Some([r, g, b]),
        opacity: Some(opacity),
    };
    Some((index.as_i64()?, label))
}

fn from_line(line: &str) -> Option<(i64, Label)> {
    let (index, rest) = line.split_once(char::is_whitespace)?;
    let index = index.parse().ok()?;
    let rest = rest.trim();
    let label = snap(rest).or_else(|| table(rest)).or_else(|| named(rest))?;
    Some((index, label))
}

/// `r g b alpha visible mesh "name"`.
fn snap(rest: &str) -> Option<Label> {
    let (numbers, name) = rest.split_once('"')?;
    let numbers: Vec<f64> = numbers
        .split_whitespace()
        .map(|n| n.parse().ok())
        .collect::<Option<_>>()?;
    let [r, g, b, alpha, visible, _mesh] = numbers[..] else {
        return None;
    };
    Some(Label {
        name: name.trim_end_matches('"').to_owned(),
        srgb: Some(bytes([r, g, b])?),
        opacity: Some(if visible == 0.0 {
            0.0
        } else {
            fraction(alpha)?
        }),
    })
}

/// `name r g b a`.
fn table(rest: &str) -> Option<Label> {
    let words: Vec<&str> = rest.split_whitespace().collect();
    let [name @ .., r, g, b, a] = words.as_slice() else {
        return None;
    };
    let number = |word: &&str| word.parse::<f64>().ok();
    let srgb = bytes([number(r)?, number(g)?, number(b)?])?;
    let [opacity, ..] = bytes([number(a)?; 3])?;
    (!name.is_empty()).then(|| Label {
        name: name.join(" "),
        srgb: Some(srgb),
        opacity: Some(opacity),
    })
}

/// `name ...`.
fn named(rest: &str) -> Option<Label> {
    let name = rest.split_whitespace().next()?;
    // A number is no name: the line was meant to be something else.
    name.parse::<f64>().is_err().then(|| Label {
        name: name.trim_matches('"').to_owned(),
        ..Label::default()
    })
}

fn bytes(numbers: [f64; 3]) -> Option<[f64; 3]> {
    let fits = numbers.iter().all(|n| (0.0..=255.0).contains(n));
    fits.then(|| numbers.map(|n| n / 255.0))
}

fn fraction(number: f64) -> Option<f64> {
    (0.0..=1.0).contains(&number).then_some(number)
}

fn wrong_line(number: usize, line: &str) -> FileProblem {
    FileProblem::Field {
        field: format!("line {number}"),
        wanted: "`1 name`, `1 name r g b a` or `1 r g b alpha visible mesh \"name\"`",
        found: shortened(line),
    }
}

fn wrong(field: &str, wanted: &'static str, found: &Value) -> FileProblem {
    FileProblem::Field {
        field: field.to_owned(),
        wanted,
        found: shortened(&found.to_string()),
    }
}

/// Its beginning says enough, and nothing in it steers a terminal.
fn shortened(text: &str) -> String {
    let start: String = text.chars().take(60).collect();
    start.escape_debug().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> LabelTable {
        LabelTable::parse(text.as_bytes()).expect("a table")
    }

    fn label(name: &str, srgb: [f64; 3], opacity: f64) -> Label {
        Label {
            name: name.into(),
            srgb: Some(srgb),
            opacity: Some(opacity),
        }
    }

    #[test]
    fn every_kind_of_file_says_the_same() {
        let wanted = BTreeMap::from([
            (1, label("left", [1.0, 0.0, 0.0], 1.0)),
            (7, label("right", [0.0, 1.0, 0.0], 0.0)),
        ]);
        for text in [
            "# ITK-SNAP\n1 255 0 0 1 1 1 \"left\"\n7 0 255 0 1 0 1 \"right\"\n",
            "1 left 255 0 0 255\r\n7 right 0 255 0 0\r\n",
            r#"{"stratavox_transfer_function":1,"interpolation":"step",
                "labels":[[1,"left",1,0,0,1],[7,"right",0,1,0,0]]}"#,
        ] {
            assert_eq!(parsed(text).labels, wanted, "{text}");
        }
        let names = parsed("1 left 2001\n7 right 2002\n");
        let found: Vec<_> = names.labels.values().map(|label| &label.name).collect();
        assert_eq!(found, ["left", "right"]);
        assert_eq!(names.labels[&1].srgb, None);
    }

    #[test]
    fn a_table_without_any_opacity_is_one_of_transparency() {
        let found = parsed("0 Unknown 0 0 0 0\n2 White-Matter 245 245 245 0\n");
        assert_eq!(found.labels.len(), 1);
        assert_eq!(found.labels[&2].opacity, Some(1.0));
    }

    #[test]
    fn a_function_in_steps_is_asked_for_each_label() {
        let table = parsed(
            r#"{"stratavox_transfer_function":1,"interpolation":"step","mask":true,
                "color":[[0,0,0,0],[2,1,0,0]],"opacity":[[0,0],[2,0.5]]}"#,
        );
        assert!(table.hides);
        let function = table.function([0, 1, 2, 3].into_iter(), 512.0);
        let opacities = [0, 1, 2, 3].map(|label| function.opacity(f64::from(label)));
        assert_eq!(opacities, [0.0, 0.0, 0.5, 0.5]);
    }

    #[test]
    fn labels_that_a_table_does_not_name_are_not_shown() {
        let function = parsed("2 b 255 0 0 255\n").function([1, 2, 3].into_iter(), 512.0);
        let opacities = [1, 2, 3].map(|label| function.opacity(f64::from(label)));
        assert_eq!(opacities, [0.0, 1.0, 0.0]);
        let all = LabelTable::default().function([0, 1, 2].into_iter(), 512.0);
        assert_eq!(all.opacity(0.0), 0.0);
        assert!(all.opacity(1.0) > 0.0 && all.srgb(1.0) != all.srgb(2.0));
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (text, word) in [
            ("", "lines such as"),
            ("1 a\n1 b\n", "line 2"),
            ("x y\n", "line 1"),
            ("1 2 3\n", "line 1"),
            ("{", "line 1 column"),
            (
                r#"{"labels":[[1,"a",0,0,0,1]]}"#,
                "stratavox_transfer_function",
            ),
            (
                r#"{"stratavox_transfer_function":1,"labels":[]}"#,
                "`labels`",
            ),
            (
                r#"{"stratavox_transfer_function":1,"labels":[[1,"a",0,0,2,1]]}"#,
                "labels[0]",
            ),
            (
                r#"{"stratavox_transfer_function":1,"labels":[[1.5,"a",0,0,1,1]]}"#,
                "labels[0]",
            ),
            (
                r#"{"stratavox_transfer_function":1,"mask":1,"labels":[[1,"a",0,0,1,1]]}"#,
                "`mask`",
            ),
            (r#"{"stratavox_transfer_function":1,"lables":[]}"#, "lables"),
            (
                r#"{"stratavox_transfer_function":1,"dim":[1.5],"labels":[[1,"a",0,0,1,1]]}"#,
                "`dim`",
            ),
            (
                r#"{"stratavox_transfer_function":1,"dim_share":2,"labels":[[1,"a",0,0,1,1]]}"#,
                "`dim_share`",
            ),
        ] {
            let problem = LabelTable::parse(text.as_bytes())
                .expect_err(text)
                .to_string();
            assert!(problem.contains(word), "{text}: {problem}");
        }
    }
}
