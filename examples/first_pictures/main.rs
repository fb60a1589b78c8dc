//! Draws volumes as `stratavox render` does without a flag, and measures the pictures.
//!
//! ```text
//! first_pictures PROGRAM PAGE COMMIT INPUT...     an INPUT may end in ,variable=NAME
//! ```
//!
//! Writes PAGE; the pictures stay in `target/first-pictures` of the current folder.

mod measure;
mod page;

use measure::Program;
use std::{error::Error, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [program, page, commit, inputs @ ..] = words.as_slice() else {
        return Err("wanted: PROGRAM PAGE COMMIT INPUT...".into());
    };
    let pictures = Path::new("target/first-pictures");
    std::fs::create_dir_all(pictures)?;
    let program = Program::new(Path::new(program), pictures);
    let mut measured = Vec::new();
    for (index, input) in inputs.iter().enumerate() {
        eprintln!("{} of {}: {input}", index + 1, inputs.len());
        let row = program.measure(input);
        measured.push(row.map_err(|error| format!("{input}: {error}"))?);
    }
    std::fs::write(page, page::page(&measured, commit))?;
    Ok(())
}
