//! The word of `--field`: `kernel`, `kernel:12.5`, `kernel,density`, `kernel:12.5,density`.

use super::numbers::positive;
use crate::points::Quantity;
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// Which field of points; without a radius it is by the distances of neighbours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct FieldWord {
    /// World length.
    pub radius: Option<f64>,
    /// What is made of the points within it.
    pub quantity: Quantity,
}

impl FromStr for FieldWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = || {
            format!(
                "wanted kernel, kernel:R with a length R over 0, or one of them and ,density, found {text:?}"
            )
        };
        let (kernel, quantity) = match text.split_once(',') {
            None => (text, Quantity::Mean),
            Some((kernel, "density")) => (kernel, Quantity::Density),
            Some(_) => return Err(wanted()),
        };
        let radius = match kernel.split_once(':') {
            None if kernel == "kernel" => None,
            Some(("kernel", radius)) => Some(positive(radius).map_err(|_| wanted())?),
            _ => return Err(wanted()),
        };
        Ok(Self { radius, quantity })
    }
}

impl fmt::Display for FieldWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("kernel")?;
        if let Some(radius) = self.radius {
            write!(f, ":{radius}")?;
        }
        match self.quantity {
            Quantity::Mean => Ok(()),
            Quantity::Density => f.write_str(",density"),
        }
    }
}

impl TryFrom<String> for FieldWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<FieldWord> for String {
    fn from(word: FieldWord) -> Self {
        word.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_is_a_kernel_with_a_radius_of_means_or_a_density() {
        for (text, radius, quantity) in [
            ("kernel", None, Quantity::Mean),
            ("kernel:12.5", Some(12.5), Quantity::Mean),
            ("kernel,density", None, Quantity::Density),
            ("kernel:1e-7,density", Some(1e-7), Quantity::Density),
        ] {
            let word: FieldWord = text.parse().expect("a word");
            assert_eq!(word, FieldWord { radius, quantity }, "{text}");
            assert_eq!(word.to_string().parse(), Ok(word), "{text}");
        }
        for text in [
            "",
            "kernel:",
            "kernel:0",
            "kernel:-1",
            "kernel:nan",
            "idw",
            "kernel,mean",
            "kernel:2,density,",
            "12",
        ] {
            let error = text.parse::<FieldWord>().expect_err(text);
            assert!(error.contains("kernel:R"), "{error}");
        }
    }
}
