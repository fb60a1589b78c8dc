//! Files that VTK wrote, and what VTK reads from them: `expected.json` beside `make.py`.
#![allow(dead_code, reason = "each test uses a part of it")]

use serde_json::Value;
use std::path::PathBuf;
use stratavox::format;
use stratavox::volume::{ComponentKind, Header, Limits, TimeComponent, VolumeSelection};

/// The folder of files of a format.
pub fn folder(format: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures")
        .join(format)
}

/// Compares every array of the table with what we read. Gives how many were compared.
pub fn check_all(format: &str) -> usize {
    let text = std::fs::read_to_string(folder(format).join("expected.json")).expect("a table");
    let table: Value = serde_json::from_str(&text).expect("JSON");
    let table = table.as_object().expect("a table");
    for (key, expected) in table {
        check(format, key, expected);
    }
    table.len()
}

fn check(format: &str, key: &str, expected: &Value) {
    let file = key.split(':').next().expect("a name");
    let wanted = VolumeSelection {
        variable: key.split_once(':').map(|(_, name)| name.to_owned()),
        ..VolumeSelection::default()
    };
    let path = folder(format).join(file);
    let source =
        format::open(&path, &wanted, &Limits::default()).unwrap_or_else(|e| panic!("{key}: {e}"));
    let header = source.header();
    assert_eq!(header.format.name(), format, "{key}");
    assert_eq!(Value::from(header.dims.to_vec()), expected["dims"], "{key}");
    assert_eq!(header.components, expected["components"], "{key}");
    assert_eq!(header.stored.name(), expected["type"], "{key}");
    assert!(
        header.variables[0].starts_with(expected["name"].as_str().unwrap()),
        "{key}"
    );
    let meaning = match expected["meaning"].as_str() {
        Some("vector") => ComponentKind::Vector,
        Some("rgb") => ComponentKind::Rgb,
        Some("rgba") => ComponentKind::Rgba,
        _ if header.variables[0] == "flow" => ComponentKind::Vector,
        _ => ComponentKind::Numbers,
    };
    assert_eq!(header.meaning, meaning, "{key}");
    first_point(key, header, expected);
    for component in 0..header.components {
        let pick = TimeComponent { time: 0, component };
        let piece = source
            .read(pick, header.whole())
            .unwrap_or_else(|e| panic!("{key}: {e}"));
        let (mut sum, mut weighted) = (0.0, 0.0);
        for index in 0..piece.voxels.len() {
            let value = f64::from(piece.voxels.stored(index));
            sum += value;
            weighted += value * (index % 97) as f64;
        }
        let at = component as usize;
        assert_eq!(expected["sums"][at], sum, "{key} component {component}");
        assert_eq!(
            expected["weighted"][at], weighted,
            "{key} component {component}"
        );
    }
}

/// The point with the lowest indices lies where VTK puts it; for cells, at the corner of the grid.
fn first_point(key: &str, header: &Header, expected: &Value) {
    let is_cell = expected["cells"] == true;
    let corner = if is_cell { 0.0 } else { 0.5 };
    let found = header
        .world_from_voxel
        .transform_point3(glam::DVec3::splat(corner));
    for k in 0..3 {
        let wanted = expected["first_point"][k].as_f64().unwrap();
        assert!(
            (found[k] - wanted).abs() < 1e-9,
            "{key}: {found} axis {k}, not {wanted}"
        );
    }
}
