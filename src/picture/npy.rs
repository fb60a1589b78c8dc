//! NumPy's array files, format 1.0 (NEP 1): a header of text, then numbers, the last axis fastest.

use super::compare::{Image, Numbers};
use super::read::PictureProblem;

const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";

/// The bytes of a file of little-endian f32 with axes of `shape`.
pub(super) fn encode(numbers: &[f32], shape: &[u32]) -> Vec<u8> {
    let shape: Vec<String> = shape.iter().map(u32::to_string).collect();
    let shape = shape.join(", ");
    let mut text = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({shape}), }}");
    // The numbers begin at a multiple of 64 bytes; the text ends in a line feed.
    let before = MAGIC.len() + 2;
    let padded = (before + text.len() + 1).next_multiple_of(64) - before;
    text.extend(std::iter::repeat_n(' ', padded - 1 - text.len()));
    text.push('\n');
    let mut bytes = Vec::with_capacity(before + padded + 4 * numbers.len());
    bytes.extend_from_slice(MAGIC);
    // At most three numbers of ten digits: the text is far shorter than 64 KiB.
    bytes.extend_from_slice(&(padded as u16).to_le_bytes());
    bytes.extend_from_slice(text.as_bytes());
    bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

/// The pixels of a file of f32 `[H, W, 4]`, or the numbers of one of `[H, W]`.
pub(super) fn decode(bytes: &[u8]) -> Result<Image, PictureProblem> {
    let invalid =
        |field: &'static str, wanted: &'static str, found: &str| PictureProblem::Invalid {
            format: "npy",
            field,
            wanted,
            found: shown(found),
        };
    let rest = bytes
        .strip_prefix(MAGIC)
        .ok_or_else(|| invalid("version", "1.0", "another one"))?;
    let (text, data) = rest
        .split_at_checked(2)
        .and_then(|(length, rest)| {
            rest.split_at_checked(u16::from_le_bytes([length[0], length[1]]).into())
        })
        .ok_or_else(|| invalid("header", "as many bytes as it says", "the end of the file"))?;
    let text = std::str::from_utf8(text).map_err(|_| invalid("header", "text", "other bytes"))?;
    let field = |name: &'static str, wanted: &'static str| {
        let after = text.split_once(&format!("'{name}':"));
        after
            .map(|(_, after)| after.trim_start())
            .ok_or_else(|| invalid(name, wanted, text))
    };
    let descr = field("descr", "'<f4'")?;
    if !descr.starts_with("'<f4'") {
        return Err(invalid("descr", "'<f4'", descr));
    }
    let order = field("fortran_order", "False")?;
    if !order.starts_with("False") {
        return Err(invalid("fortran_order", "False", order));
    }
    let wanted = "(H, W, 4) or (H, W)";
    let text = field("shape", wanted)?;
    let inside = text.strip_prefix('(').and_then(|text| text.split_once(')'));
    let (inside, _) = inside.ok_or_else(|| invalid("shape", wanted, text))?;
    let shape: Result<Vec<u64>, _> = inside.split(',').map(|n| n.trim().parse()).collect();
    let (height, width, channels) = match shape.as_deref() {
        Ok(&[height, width, 4]) => (height, width, 4),
        Ok(&[height, width]) => (height, width, 1),
        _ => return Err(invalid("shape", wanted, inside)),
    };
    let (width, height) = PictureProblem::check_size("npy", width, height)?;
    let wanted_bytes = u64::from(width) * u64::from(height) * channels * 4;
    if data.len() as u64 != wanted_bytes {
        return Err(PictureProblem::Size {
            format: "npy",
            wanted_bytes,
            found_bytes: data.len() as u64,
        });
    }
    let numbers = data
        .as_chunks::<4>()
        .0
        .iter()
        .map(|&x| f32::from_le_bytes(x));
    let (pixels, numbers) = if channels == 4 {
        let numbers: Vec<f32> = numbers.collect();
        (numbers.as_chunks::<4>().0.to_vec(), Numbers::Premultiplied)
    } else {
        (
            numbers.map(|x| [x, 0.0, 0.0, 0.0]).collect(),
            Numbers::Plain,
        )
    };
    Ok(Image {
        width,
        height,
        pixels,
        numbers,
    })
}

/// The beginning of a field, on one line.
fn shown(text: &str) -> String {
    let beginning = text.chars().take(40);
    beginning.filter(|c| !c.is_control()).collect()
}
