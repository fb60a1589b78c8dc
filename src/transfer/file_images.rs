//! Images over value and gradient in a transfer function file: rows of numbers, rows of colours, or a PNG beside it.
//!
//! ```text
//! "rows": [[0, 0.5], [1, 0]]               shares, the smallest gradients first
//! "rows": ["ff000080ffffff00", ...]        cells rrggbbaa: sRGB and share, the smallest gradients first
//! "file": "boundaries.png"                 8 bits a channel; its lowest row has the smallest gradients
//! ```

use super::field::{FRACTION, Fields, list, number, wrong};
use super::{Cells, FileProblem};
use serde_json::{Value, json};
use std::path::Path;

const MAX_CELLS: usize = 65_536;
const ROWS: &str = "a list of rows, those of the smallest gradients first: numbers, or text with rrggbbaa for each cell";
const HEX: &str = "rrggbbaa in hexadecimal digits for each cell, as many as in the first row";
const FILE: &str = "the name of a PNG file in the folder of this one";
const PIXELS: &str = "a PNG file of 8 bits a channel and at most 65536 pixels";

/// The cells that the fields state, and how many are in a row. `folder` is where files are looked for.
pub(super) fn cells(
    fields: &mut Fields,
    folder: Option<&Path>,
) -> Result<(usize, Cells), FileProblem> {
    let field = fields.name("file");
    match fields.optional("file") {
        None => rows(fields),
        Some(found) => {
            if let Some(rows) = fields.optional("rows") {
                let wanted = "no such key beside `file`";
                return Err(wrong(&fields.name("rows"), wanted, &rows));
            }
            file(&field, &found, folder)
        }
    }
}

fn rows(fields: &mut Fields) -> Result<(usize, Cells), FileProblem> {
    let found = fields.take("rows", ROWS)?;
    let field = fields.name("rows");
    let rows = list(&field, &found, ROWS, (4096, "at most 4096 rows"))?;
    let (columns, cells) = match rows[0].as_str() {
        Some(text) => (text.len() / 8, Cells::Rgba(colors(&field, rows)?)),
        None => {
            let shares = shares(&field, rows)?;
            (shares.len() / rows.len(), Cells::Shares(shares))
        }
    };
    if cells.count() > MAX_CELLS {
        return Err(FileProblem::Field {
            field,
            wanted: "at most 65536 cells",
            found: cells.count().to_string(),
        });
    }
    Ok((columns, cells))
}

fn shares(field: &str, rows: &[Value]) -> Result<Vec<f64>, FileProblem> {
    let columns = rows[0].as_array().map_or(0, Vec::len);
    let mut cells = Vec::new();
    for (y, row) in rows.iter().enumerate() {
        let place = format!("{field}[{y}]");
        let Some(row) = row
            .as_array()
            .filter(|row| !row.is_empty() && row.len() == columns)
        else {
            return Err(wrong(&place, "a row of as many numbers as the first", row));
        };
        for (x, cell) in row.iter().enumerate() {
            cells.push(number(&format!("{place}[{x}]"), cell, FRACTION)?);
        }
    }
    Ok(cells)
}

fn colors(field: &str, rows: &[Value]) -> Result<Vec<[u8; 4]>, FileProblem> {
    let length = rows[0].as_str().map_or(0, str::len);
    let mut cells = Vec::new();
    for (y, row) in rows.iter().enumerate() {
        let refused = || wrong(&format!("{field}[{y}]"), HEX, row);
        let digits = row.as_str().map(str::as_bytes).ok_or_else(refused)?;
        if digits.is_empty() || digits.len() != length {
            return Err(refused());
        }
        let (of_cells, []) = digits.as_chunks::<8>() else {
            return Err(refused());
        };
        for digits in of_cells {
            cells.push(color(digits).ok_or_else(refused)?);
        }
    }
    Ok(cells)
}

fn color(digits: &[u8; 8]) -> Option<[u8; 4]> {
    let digit = |at: usize| char::from(digits[at]).to_digit(16).map(|digit| digit as u8);
    let mut codes = [0; 4];
    for (i, code) in codes.iter_mut().enumerate() {
        *code = 16 * digit(2 * i)? + digit(2 * i + 1)?;
    }
    Some(codes)
}

fn file(field: &str, found: &Value, folder: Option<&Path>) -> Result<(usize, Cells), FileProblem> {
    let refused = |wanted: &'static str, found: String| FileProblem::Field {
        field: field.to_owned(),
        wanted,
        found,
    };
    let name = found.as_str().ok_or_else(|| wrong(field, FILE, found))?;
    // What a file of a stranger names lies beside it and nowhere else.
    let is_name = Path::new(name).file_name().is_some_and(|last| last == name);
    if !is_name {
        return Err(wrong(field, FILE, found));
    }
    let Some(folder) = folder else {
        let wanted = "`rows`: a function that stands in no file has no folder to look in";
        return Err(refused(wanted, name.to_owned()));
    };
    let path = folder.join(name);
    let bytes = super::file::read_limited(&path)
        .map_err(|problem| refused(PIXELS, format!("{}: {problem}", path.display())))?;
    let (columns, mut cells) = decode(&bytes).map_err(|found| refused(PIXELS, found))?;
    // The top row of a picture comes first, the smallest gradients lie at its foot.
    let rows: Vec<_> = cells.chunks(columns).rev().map(<[_]>::to_vec).collect();
    cells = rows.concat();
    Ok((columns, Cells::Rgba(cells)))
}

/// Pixels across, and all of them, the top row first; else what was found in their place.
#[cfg(feature = "png")]
fn decode(bytes: &[u8]) -> Result<(usize, Vec<[u8; 4]>), String> {
    use image::{DynamicImage, ImageDecoder, codecs::png::PngDecoder};
    let broken = |cause: image::ImageError| cause.to_string();
    let decoder = PngDecoder::new(std::io::Cursor::new(bytes)).map_err(broken)?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > MAX_CELLS as u64 {
        return Err(format!("one of {width} x {height} pixels"));
    }
    let color = decoder.color_type();
    if color.bytes_per_pixel() > color.channel_count() {
        return Err("one of 16 bits a channel".to_owned());
    }
    // Grey, palettes and fewer than 8 bits become red, green, blue and alpha here.
    let codes = DynamicImage::from_decoder(decoder).map_err(broken)?;
    let codes = codes.into_rgba8().into_raw();
    Ok((width as usize, codes.as_chunks::<4>().0.to_vec()))
}

#[cfg(not(feature = "png"))]
fn decode(_: &[u8]) -> Result<(usize, Vec<[u8; 4]>), String> {
    Err("a build that reads no PNG: it has no feature `png`".to_owned())
}

/// The rows of a file that states such cells.
pub(super) fn rows_to_json(columns: usize, cells: &Cells) -> Value {
    let columns = columns.max(1);
    match cells {
        Cells::Shares(shares) => json!(shares.chunks(columns).collect::<Vec<_>>()),
        Cells::Rgba(colors) => {
            let cell = |[r, g, b, a]: &[u8; 4]| format!("{r:02x}{g:02x}{b:02x}{a:02x}");
            let row = |row: &[[u8; 4]]| row.iter().map(cell).collect::<String>();
            json!(colors.chunks(columns).map(row).collect::<Vec<_>>())
        }
    }
}
