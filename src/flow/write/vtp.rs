//! Lines as VTK PolyData: XML with the numbers behind it as they are (VTK file formats, "XML file formats", PolyData).
//!
//! ```text
//! points      x y z (f64);   of each its value, `time` and `speed`
//! polylines   connectivity, offsets (i64);   of each `seed`, and `cause` and `cause_before`: why it ends and begins, by number
//! block       bytes (u64), numbers, little-endian
//! ```

use super::LineValues;
use crate::flow::line::{Line, Vertex};
use std::io::{self, Write};

/// An array of the file.
struct Array {
    kind: &'static str,
    name: String,
    components: usize,
    bytes: Vec<u8>,
}

fn floats(name: &str, components: usize, numbers: impl Iterator<Item = f64>) -> Array {
    Array {
        kind: "Float64",
        name: name.to_owned(),
        components,
        bytes: numbers.flat_map(f64::to_le_bytes).collect(),
    }
}

fn integers(name: &str, numbers: impl Iterator<Item = i64>) -> Array {
    Array {
        kind: "Int64",
        name: name.to_owned(),
        components: 1,
        bytes: numbers.flat_map(i64::to_le_bytes).collect(),
    }
}

fn bytes(name: &str, numbers: impl Iterator<Item = u8>) -> Array {
    Array {
        kind: "UInt8",
        name: name.to_owned(),
        components: 1,
        bytes: numbers.collect(),
    }
}

/// Writes the pieces of all lines, each a polyline.
///
/// # Errors
/// What `out` says.
pub fn write_vtp(lines: &[Line], values: &LineValues, out: &mut impl Write) -> io::Result<()> {
    let pieces: Vec<(&Line, std::ops::Range<usize>)> = lines
        .iter()
        .flat_map(|line| line.piece_ranges().map(move |range| (line, range)))
        .collect();
    let mut all: Vec<&Vertex> = Vec::new();
    for (line, range) in &pieces {
        all.extend(&line.vertices[range.clone()]);
    }
    let mut point_data = Vec::new();
    if values.name != "speed" {
        let numbers = lines
            .iter()
            .zip(&values.numbers)
            .flat_map(|(line, numbers)| {
                line.piece_ranges()
                    .flat_map(|range| numbers[range].iter().copied())
            });
        point_data.push(floats(&values.name, 1, numbers));
    }
    point_data.push(floats("speed", 1, all.iter().map(|v| v.speed)));
    point_data.push(floats("time", 1, all.iter().map(|v| v.time)));
    let number = |end: Option<crate::flow::End>| end.map_or(0, crate::flow::End::number);
    let cell_data = vec![
        integers("seed", pieces.iter().map(|(line, _)| line.seed as i64)),
        bytes("cause", pieces.iter().map(|(line, _)| number(line.ends[1]))),
        bytes(
            "cause_before",
            pieces.iter().map(|(line, _)| number(line.ends[0])),
        ),
    ];
    let points = vec![floats(
        "Points",
        3,
        all.iter().flat_map(|v| v.place.to_array()),
    )];
    let mut end = 0;
    let offsets = pieces.iter().map(|(_, range)| {
        end += range.len() as i64;
        end
    });
    let polylines = vec![
        integers("connectivity", 0..all.len() as i64),
        integers("offsets", offsets),
    ];

    writeln!(out, r#"<?xml version="1.0"?>"#)?;
    writeln!(
        out,
        r#"<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#
    )?;
    writeln!(out, "<PolyData>")?;
    writeln!(
        out,
        r#"<Piece NumberOfPoints="{}" NumberOfVerts="0" NumberOfLines="{}" NumberOfStrips="0" NumberOfPolys="0">"#,
        all.len(),
        pieces.len()
    )?;
    let mut offset = 0;
    let scalars = format!(r#" Scalars="{}""#, escaped(&values.name));
    let sections = [
        ("PointData", scalars.as_str(), &point_data),
        ("CellData", "", &cell_data),
        ("Points", "", &points),
        ("Lines", "", &polylines),
    ];
    for (section, attributes, arrays) in sections {
        writeln!(out, "<{section}{attributes}>")?;
        for array in arrays {
            writeln!(
                out,
                r#"<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{offset}"/>"#,
                array.kind,
                escaped(&array.name),
                array.components
            )?;
            offset += 8 + array.bytes.len();
        }
        writeln!(out, "</{section}>")?;
    }
    writeln!(
        out,
        "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">"
    )?;
    write!(out, "_")?;
    for (_, _, arrays) in sections {
        for array in arrays {
            out.write_all(&(array.bytes.len() as u64).to_le_bytes())?;
            out.write_all(&array.bytes)?;
        }
    }
    writeln!(out, "\n</AppendedData>\n</VTKFile>")
}

/// A name as the value of an attribute.
fn escaped(name: &str) -> String {
    let mut text = String::new();
    for letter in name.chars().filter(|letter| !letter.is_control()) {
        match letter {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '"' => text.push_str("&quot;"),
            other => text.push(other),
        }
    }
    text
}
