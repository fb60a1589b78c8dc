//! The `omero` of an image: names, colours and windows of its channels.

use super::json::{Object, number};
use crate::volume::Channel;
use serde_json::Value;

/// The channels, where the file describes as many as there are; nameless ones where there are several.
pub(super) fn channels(facts: &Object, count: u32) -> Option<Vec<Channel>> {
    let count = usize::try_from(count).ok()?;
    let described = facts
        .get("omero")
        .and_then(|omero| omero.get("channels"))
        .and_then(Value::as_array)
        .filter(|list| list.len() == count);
    match described {
        Some(list) => Some(list.iter().map(channel).collect()),
        None => (2..=MOST_CHANNELS)
            .contains(&count)
            .then(|| vec![Channel::default(); count]),
    }
}

/// More things than a microscope sees: components of another kind.
const MOST_CHANNELS: usize = 1024;

fn channel(value: &Value) -> Channel {
    let name = value.get("label").and_then(Value::as_str);
    let color = value.get("color").and_then(Value::as_str);
    let end = |name| number(value.get("window")?.get(name)?);
    let window = end("start").zip(end("end"));
    Channel {
        name: name.map(crate::format::problem::escape).unwrap_or_default(),
        srgb: color.and_then(srgb),
        window: window
            .filter(|(low, high)| low.is_finite() && high.is_finite() && low < high)
            .map(|(low, high)| [low, high]),
    }
}

/// `RRGGBB`, six hexadecimal digits.
fn srgb(text: &str) -> Option<[f32; 3]> {
    let digits = text.trim_start_matches('#');
    if digits.len() != 6 || !digits.is_ascii() {
        return None;
    }
    let [_, red, green, blue] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
    Some([red, green, blue].map(|level| f32::from(level) / 255.0))
}
