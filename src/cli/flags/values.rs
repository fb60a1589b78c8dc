//! What flags of colour ask of names and of volumes.

use crate::transfer::{Colormap, Preset};

/// A sentence with all its causes.
pub fn with_causes(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text = format!("{text}: {error}");
        cause = error.source();
    }
    text
}

pub fn preset(name: &str) -> Result<String, String> {
    let names = Preset::ALL.map(Preset::name);
    if names.contains(&name) {
        Ok(name.to_owned())
    } else {
        Err(format!(
            "no preset {name:?}; there are {}",
            names.join(", ")
        ))
    }
}

/// A word of `--colormap` that is right.
pub fn colormap(text: &str) -> Result<String, String> {
    text.parse().map(|map: Colormap| map.to_string())
}
