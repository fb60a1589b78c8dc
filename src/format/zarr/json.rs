//! The JSON of Zarr: objects whose fields are looked up by name and type.
//!
//! Python writes `NaN` and `Infinity` where JSON has no such numbers; here they are read as words.

use super::ZARR;
use crate::format::problem::{invalid, missing};
use crate::volume::Problem;
use serde_json::{Map, Value};

/// An object of JSON.
pub(super) type Object = Map<String, Value>;

/// The object that `bytes` are.
pub(super) fn object(bytes: &[u8]) -> Result<Object, Problem> {
    let found = serde_json::from_slice::<Value>(bytes)
        .or_else(|_| serde_json::from_slice(&with_quoted_numbers(bytes)));
    match found {
        Ok(Value::Object(object)) => Ok(object),
        Ok(other) => Err(wrong("metadata", "a JSON object", &other)),
        Err(error) => Err(invalid(
            ZARR,
            "metadata",
            "a JSON object",
            &error.to_string(),
        )),
    }
}

/// The same text with quotes around the words that Python writes for numbers.
fn with_quoted_numbers(bytes: &[u8]) -> Vec<u8> {
    const WORDS: [&[u8]; 3] = [b"-Infinity", b"Infinity", b"NaN"];
    let mut quoted = Vec::new();
    let mut rest = bytes;
    let mut in_string = false;
    while let Some((&byte, tail)) = rest.split_first() {
        let word = WORDS.iter().find(|word| rest.starts_with(word));
        match (byte, word) {
            (b'\\', _) if in_string => {
                quoted.extend(rest.iter().take(2));
                rest = tail.get(1..).unwrap_or(&[]);
                continue;
            }
            (b'"', _) => in_string = !in_string,
            (_, Some(word)) if !in_string => {
                quoted.push(b'"');
                quoted.extend_from_slice(word);
                quoted.push(b'"');
                rest = rest.get(word.len()..).unwrap_or(&[]);
                continue;
            }
            _ => {}
        }
        quoted.push(byte);
        rest = tail;
    }
    quoted
}

/// The sentence about a field that holds something else than was wanted.
pub(super) fn wrong(field: &str, wanted: impl Into<String>, found: &Value) -> Problem {
    invalid(ZARR, field, wanted, &found.to_string())
}

/// A field that must be there.
pub(super) fn required<'a>(object: &'a Object, field: &str) -> Result<&'a Value, Problem> {
    object.get(field).ok_or_else(|| missing(ZARR, field))
}

/// A field that may be left out or null.
pub(super) fn optional<'a>(object: &'a Object, field: &str) -> Option<&'a Value> {
    object.get(field).filter(|value| !value.is_null())
}

/// A field of text.
pub(super) fn text<'a>(object: &'a Object, field: &str) -> Result<&'a str, Problem> {
    let value = required(object, field)?;
    value.as_str().ok_or_else(|| wrong(field, "text", value))
}

/// A field that is an object; an empty one where it is left out.
pub(super) fn child(object: &Object, field: &str) -> Result<Object, Problem> {
    match optional(object, field) {
        None => Ok(Object::new()),
        Some(Value::Object(child)) => Ok(child.clone()),
        Some(other) => Err(wrong(field, "a JSON object", other)),
    }
}

/// A list of whole numbers.
pub(super) fn sizes(value: &Value, field: &str) -> Result<Vec<u64>, Problem> {
    let all = value.as_array().map(|all| all.iter().map(Value::as_u64));
    all.and_then(Iterator::collect).ok_or_else(|| {
        wrong(
            field,
            "a list of whole numbers that are not negative",
            value,
        )
    })
}

/// A list of words.
pub(super) fn words(value: &Value) -> Option<Vec<String>> {
    let word = |value: &Value| value.as_str().map(str::to_owned);
    value.as_array()?.iter().map(word).collect()
}

/// A number, written as one or as one of Python's words.
pub(super) fn number(value: &Value) -> Option<f64> {
    match value {
        Value::String(word) => match word.as_str() {
            "NaN" => Some(f64::NAN),
            "Infinity" => Some(f64::INFINITY),
            "-Infinity" => Some(f64::NEG_INFINITY),
            _ => None,
        },
        _ => value.as_f64(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_json_lacks_are_read_outside_of_strings_only() {
        let read = object(br#"{"a": NaN, "b": [-Infinity, Infinity], "NaN \" NaN": "x NaN"}"#);
        let read = read.unwrap();
        assert!(number(&read["a"]).unwrap().is_nan());
        assert_eq!(number(&read["b"][0]), Some(f64::NEG_INFINITY));
        assert_eq!(number(&read["b"][1]), Some(f64::INFINITY));
        assert_eq!(read["NaN \" NaN"], "x NaN");
        assert!(object(b"NaN").is_err());
        assert!(object(b"{\"a\": Nan}").is_err());
    }
}
