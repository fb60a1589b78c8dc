//! Shapefiles as ESRI's description of 1998 has them.
#![allow(dead_code, reason = "each test program uses a part of it")]

/// Lines of longitudes and latitudes.
pub type Lines = Vec<Vec<[f64; 2]>>;

/// A file of shapes of one type, each of several parts; a shape without parts has no form. Behind places stand heights and
/// measures where the type has them.
pub fn shapefile(kind: i32, shapes: &[Lines]) -> Vec<u8> {
    let mut records = Vec::new();
    for (index, shape) in shapes.iter().enumerate() {
        let content = record(kind, shape);
        records.extend((index as i32 + 1).to_be_bytes());
        records.extend((content.len() as i32 / 2).to_be_bytes());
        records.extend(content);
    }
    let mut file = Vec::new();
    file.extend(9994_i32.to_be_bytes());
    file.extend([0; 20]);
    file.extend(((100 + records.len()) as i32 / 2).to_be_bytes());
    file.extend(1000_i32.to_le_bytes());
    file.extend(kind.to_le_bytes());
    file.extend([0; 64]);
    file.extend(records);
    file
}

fn record(kind: i32, shape: &Lines) -> Vec<u8> {
    if shape.is_empty() {
        return 0_i32.to_le_bytes().to_vec();
    }
    let points: Vec<[f64; 2]> = shape.iter().flatten().copied().collect();
    let end = |k: usize, pick: fn(f64, f64) -> f64| {
        points.iter().map(|p| p[k]).reduce(pick).unwrap_or_default()
    };
    let mut content = kind.to_le_bytes().to_vec();
    for number in [
        end(0, f64::min),
        end(1, f64::min),
        end(0, f64::max),
        end(1, f64::max),
    ] {
        content.extend(number.to_le_bytes());
    }
    content.extend((shape.len() as i32).to_le_bytes());
    content.extend((points.len() as i32).to_le_bytes());
    let mut first = 0_i32;
    for part in shape {
        content.extend(first.to_le_bytes());
        first += part.len() as i32;
    }
    for number in points.iter().flatten() {
        content.extend(number.to_le_bytes());
    }
    // Heights of Z types, measures of both.
    let arrays = match kind {
        13 | 15 => 2,
        23 | 25 => 1,
        _ => 0,
    };
    for _ in 0..arrays {
        content.extend([0; 16]);
        content.extend(points.iter().flat_map(|_| 7.5_f64.to_le_bytes()));
    }
    content
}
