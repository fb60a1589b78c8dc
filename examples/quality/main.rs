//! Measures how good and how fast pictures are, and prints Markdown tables: those of `docs/quality.md`.
//!
//! ```text
//! cargo run --release --example quality              all tables
//! cargo run --release --example quality filters      one of them
//! ```

mod filters;
mod marschner_lobb;
mod normals;
mod popping;
mod studio;
mod wood_grain;

use std::error::Error;

/// Prints one table.
type Table = fn() -> Result<(), Box<dyn Error>>;

const TABLES: &[(&str, Table)] = &[
    ("filters", filters::print),
    ("normals", normals::print),
    ("popping", popping::print),
    ("wood-grain", wood_grain::print),
];

fn main() -> Result<(), Box<dyn Error>> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    if let Some(word) = wanted
        .iter()
        .find(|word| TABLES.iter().all(|t| t.0 != **word))
    {
        let known: Vec<_> = TABLES.iter().map(|table| table.0).collect();
        return Err(format!("no table `{word}`; there are: {}", known.join(", ")).into());
    }
    let tables = TABLES.iter();
    for (name, print) in tables.filter(|t| wanted.is_empty() || wanted.iter().any(|w| w == t.0)) {
        println!("\n## {name}\n");
        print()?;
    }
    Ok(())
}
