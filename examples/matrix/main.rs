//! Prints `docs/matrix.md`: which techniques, modes, filters and features go together.
//!
//! ```text
//! cargo run --example matrix > docs/matrix.md
//! ```

mod cells;
mod page;

fn main() {
    print!(
        "{}",
        page::page(&cells::Matter::new(|volume| cells::DENOISE.denoised(volume)))
    );
}
