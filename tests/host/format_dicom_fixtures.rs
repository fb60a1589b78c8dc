//! Files that pydicom wrote, in every transfer syntax that we claim, against what pydicom reads from them.
//!
//! `tests/fixtures/dicom/make.py` wrote the files and `expected.json`.
#![cfg(feature = "dicom")]

use crate::files;

use files::message;
use glam::DVec3;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use stratavox::format;
use stratavox::volume::{Limits, Source, TimeComponent, VolumeSelection, Voxels};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/dicom")
}

fn expected() -> serde_json::Map<String, Value> {
    let text = std::fs::read_to_string(folder().join("expected.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn open(path: &Path) -> Result<Box<dyn Source>, String> {
    format::open(path, &VolumeSelection::default(), &Limits::default()).map_err(|e| message(&e))
}

/// All numbers, component fastest, then x, y, z, time; as bytes, little-endian.
fn bytes(source: &dyn Source) -> Vec<u8> {
    let header = source.header();
    let mut all = Vec::new();
    for time in 0..header.times {
        let parts: Vec<Vec<Vec<u8>>> = (0..header.components)
            .map(|component| {
                let piece = source
                    .read(TimeComponent { time, component }, header.whole())
                    .unwrap();
                (0..piece.voxels.len())
                    .map(|i| number(&piece.voxels, i))
                    .collect()
            })
            .collect();
        for voxel in 0..parts[0].len() {
            all.extend(parts.iter().flat_map(|part| part[voxel].clone()));
        }
    }
    all
}

fn number(voxels: &Voxels, i: usize) -> Vec<u8> {
    match voxels {
        Voxels::U8(v) => v[i].to_le_bytes().to_vec(),
        Voxels::I8(v) => v[i].to_le_bytes().to_vec(),
        Voxels::U16(v) => v[i].to_le_bytes().to_vec(),
        Voxels::I16(v) => v[i].to_le_bytes().to_vec(),
        Voxels::F32(v) => v[i].to_le_bytes().to_vec(),
        Voxels::F16(_) => panic!("no file holds f16"),
    }
}

fn check(path: &Path, name: &str, wanted: &Value) -> Result<(), String> {
    let source = open(path)?;
    let header = source.header();
    let same = |what: &str, found: Value, wanted: &Value| match found == *wanted {
        true => Ok(()),
        false => Err(format!("{what} {found}, not {wanted}; {:?}", header.notes)),
    };
    same("dims", header.dims.to_vec().into(), &wanted["dims"])?;
    same("type", header.stored.name().into(), &wanted["type"])?;
    same(
        "components",
        header.components.into(),
        &wanted["components"],
    )?;
    same(
        "times",
        header.times.into(),
        wanted.get("times").unwrap_or(&1.into()),
    )?;
    if let Some(names) = wanted.get("time_names") {
        same("times", header.time_names.clone().into(), names)?;
    }
    if let Some(affine) = wanted.get("affine") {
        let at = |p: [f64; 3]| {
            header
                .world_from_voxel
                .transform_point3(DVec3::from_array(p) + 0.5)
        };
        let first = at([0.0; 3]);
        let steps = [[1., 0., 0.], [0., 1., 0.], [0., 0., 1.]].map(|p| at(p) - first);
        for (row, wanted) in affine.as_array().unwrap().iter().enumerate() {
            let found = [steps[0][row], steps[1][row], steps[2][row], first[row]];
            for (found, wanted) in found.iter().zip(wanted.as_array().unwrap()) {
                if (found - wanted.as_f64().unwrap()).abs() > 1e-9 {
                    return Err(format!("row {row} of the affine {found}, not {wanted}"));
                }
            }
        }
    }
    let bytes = bytes(source.as_ref());
    let Some(lossy) = wanted.get("lossy") else {
        let digest: String = Sha256::digest(&bytes)
            .iter()
            .map(|b| format!("{b:02x}"))
            .collect();
        return same("voxels", digest.into(), &wanted["sha256"]);
    };
    let found: Vec<i64> = match header.stored.bytes() {
        1 => bytes.iter().map(|&b| b.into()).collect(),
        _ => bytes
            .chunks(2)
            .map(|b| i16::from_le_bytes([b[0], b[1]]).into())
            .collect(),
    };
    let numbers = wanted["numbers"]
        .as_array()
        .unwrap()
        .iter()
        .map(|n| n.as_i64().unwrap());
    let worst = found
        .iter()
        .zip(numbers.clone())
        .map(|(a, b)| (a - b).abs())
        .max();
    println!("{name}: lossy, at most {worst:?} from the other decoder");
    match (found.len() == numbers.count(), worst <= lossy.as_i64()) {
        (true, true) => Ok(()),
        _ => Err(format!("{worst:?} apart, {lossy} allowed")),
    }
}

#[test]
fn every_transfer_syntax_gives_the_numbers_that_pydicom_reads() {
    let mut wrong = Vec::new();
    let mut tried = 0;
    for (name, wanted) in expected()
        .iter()
        .filter(|(_, wanted)| wanted.get("refused").is_none())
    {
        let outcome = check(&folder().join(format!("{name}.dcm")), name, wanted);
        wrong.extend(outcome.err().map(|error| format!("{name}: {error}")));
        tried += 1;
    }
    println!("{tried} files");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(tried >= 45, "{tried} files");
}

#[test]
fn what_is_not_read_is_refused_by_its_name() {
    let mut tried = 0;
    for (name, wanted) in expected() {
        let Some(parts) = wanted.get("refused") else {
            continue;
        };
        let source = open(&folder().join(format!("{name}.dcm")));
        let outcome = source.and_then(|source| {
            let all = source.header().whole();
            source
                .read(TimeComponent::default(), all)
                .map_err(|e| message(&e))
        });
        let error = outcome.expect_err(&name);
        for part in parts.as_array().unwrap() {
            assert!(error.contains(part.as_str().unwrap()), "{name}: {error}");
        }
        tried += 1;
    }
    assert_eq!(tried, 6);
}
