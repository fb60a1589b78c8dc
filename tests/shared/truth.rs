//! Real volumes and what is known about them: `manifest.json` in the folder that `STRATAVOX_DATA` names.
#![allow(dead_code, reason = "each test uses a part of it")]

use serde_json::Value;
use sha2::{Digest, Sha256};
use std::path::PathBuf;
use stratavox::format;
use stratavox::volume::{Limits, TimeComponent, VolumeSelection, Voxels};

/// The folder of real volumes, if there is one.
pub fn folder() -> Option<PathBuf> {
    let folder = match std::env::var_os("STRATAVOX_DATA") {
        Some(folder) => PathBuf::from(folder),
        None => PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data"),
    };
    let found = folder.join("manifest.json").is_file();
    if !found {
        println!("skipped: no data");
    }
    found.then_some(folder)
}

/// The entries of a kind, in the manifest's words.
pub fn entries(kind: &str) -> Vec<Value> {
    let Some(folder) = folder() else {
        return Vec::new();
    };
    let text = std::fs::read_to_string(folder.join("manifest.json")).unwrap();
    // JSON has no NaN; the file has some, in entries of other kinds.
    let manifest: Value = serde_json::from_str(&text.replace("NaN", "null")).unwrap();
    let all = manifest["entries"].as_array().unwrap().iter();
    all.filter(|entry| entry["kind"] == kind).cloned().collect()
}

/// Compares dims, type, minimum, maximum, mean and the SHA-256 of the stored voxels of one entry.
/// Only the first `known_voxels` count, where the manifest speaks of zeros in place of the others.
/// Gives the affine of voxel centres, row-major.
pub fn check(entry: &Value, known_voxels: Option<usize>) -> [[f64; 4]; 3] {
    let id = entry["id"].as_str().unwrap();
    let path = folder().unwrap().join(entry["path"].as_str().unwrap());
    let source = format::open(&path, &VolumeSelection::default(), &Limits::default())
        .unwrap_or_else(|e| panic!("{id}: {e}"));
    let header = source.header();
    println!("{id}: {header:?}");
    let volume = &entry["volume"];
    assert_eq!(
        Value::from(header.dims.to_vec()),
        volume["dims_xyz"],
        "{id}"
    );
    assert_eq!((header.times, header.components), (1, 1), "{id}");
    let dtype = match volume["dtype"].as_str().unwrap() {
        "uint8" => "u8",
        "int16" => "i16",
        "uint16" => "u16",
        other => other,
    };
    assert_eq!(header.stored.name(), dtype, "{id}");

    let piece = source
        .read(TimeComponent::default(), header.whole())
        .unwrap();
    assert!(piece.loss.is_none(), "{id}: {:?}", piece.loss);
    let count = piece.voxels.len();
    let known_voxels = known_voxels.unwrap_or(count);
    let known = |i: usize| {
        if i < known_voxels {
            piece.voxels.stored(i)
        } else {
            0.0
        }
    };
    let numbers = || (0..count).map(|i| f64::from(known(i)));
    let stored = &volume["stored"];
    let minimum = numbers().fold(f64::INFINITY, f64::min);
    let maximum = numbers().fold(f64::NEG_INFINITY, f64::max);
    assert_eq!(Some(minimum), stored["min"].as_f64(), "{id}: minimum");
    assert_eq!(Some(maximum), stored["max"].as_f64(), "{id}: maximum");
    // The sum of at most 2^26 16-bit numbers is exact in f64, so only the division rounds.
    let mean = numbers().sum::<f64>() / count as f64;
    let wanted = stored["mean"].as_f64().unwrap();
    assert!(
        (mean - wanted).abs() <= 1e-12 * wanted.abs(),
        "{id}: mean {mean}, not {wanted}"
    );

    let mut bytes: Vec<u8> = match &piece.voxels {
        Voxels::U8(v) => v.clone(),
        Voxels::U16(v) => v.iter().flat_map(|n| n.to_le_bytes()).collect(),
        Voxels::I16(v) => v.iter().flat_map(|n| n.to_le_bytes()).collect(),
        other => panic!("{id}: {:?} is not expected", other.voxel_type()),
    };
    let known_bytes = known_voxels * header.stored.bytes();
    bytes
        .iter_mut()
        .skip(known_bytes)
        .for_each(|byte| *byte = 0);
    let digest = Sha256::digest(&bytes);
    let digest: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(
        Some(digest.as_str()),
        volume["voxel_sha256"].as_str(),
        "{id}: voxels"
    );

    let center = |index: [f64; 3]| {
        let point = glam::DVec3::from_array(index) + glam::DVec3::splat(0.5);
        header.world_from_voxel.transform_point3(point)
    };
    let first = center([0.0; 3]);
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        .map(center)
        .map(|p| p - first);
    std::array::from_fn(|row| [x[row], y[row], z[row], first[row]])
}

/// Compares two affines; `tolerance` is what the manifest's digits leave open.
pub fn same_affine(id: &str, found: [[f64; 4]; 3], wanted: [[f64; 4]; 3], tolerance: f64) {
    for (row, (found, wanted)) in found.iter().zip(&wanted).enumerate() {
        for (found, wanted) in found.iter().zip(wanted) {
            let error = (found - wanted).abs();
            assert!(error <= tolerance, "{id} row {row}: {found}, not {wanted}");
        }
    }
}
