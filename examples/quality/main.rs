//! Measures what pictures are worth, on the device of this machine, and prints tables in Markdown:
//!
//! ```text
//! cargo run --release --example quality -- popping wood-grain
//! ```

mod popping;
mod studio;
mod wood_grain;

use std::error::Error;

/// A word of the command line and what it prints.
type Measure = fn() -> Result<(), Box<dyn Error>>;

const MEASURES: &[(&str, Measure)] = &[
    ("popping", popping::print),
    ("wood-grain", wood_grain::print),
];

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let names = MEASURES.iter().map(|(name, _)| *name).collect::<Vec<_>>();
    if let Some(word) = words.iter().find(|word| !names.contains(&word.as_str())) {
        return Err(format!("no measure `{word}`: there are {}", names.join(", ")).into());
    }
    for (name, print) in MEASURES {
        if words.is_empty() || words.iter().any(|word| word == name) {
            print()?;
        }
    }
    Ok(())
}
