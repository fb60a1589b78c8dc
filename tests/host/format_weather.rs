//! Real NetCDF and HDF5 files against the manifest: dims, type, smallest, largest and mean value, SHA-256 of the
//! stored numbers.
#![cfg(feature = "netcdf")]

use crate::truth;

use serde_json::Value;
use sha2::{Digest, Sha256};
use stratavox::format;
use stratavox::volume::{Limits, Statistics, TimeComponent, VolumeSelection, Voxels};

fn check(entry: &Value, variable: &Value) {
    let id = entry["id"].as_str().unwrap();
    let name = variable["name"].as_str().unwrap();
    let path = truth::folder()
        .unwrap()
        .join(entry["path"].as_str().unwrap());
    let wanted = VolumeSelection {
        variable: Some(name.to_owned()),
        as_stored: true,
        ..VolumeSelection::default()
    };
    let source = format::open(&path, &wanted, &Limits::default()).unwrap();
    let header = source.header();
    let mut shape: Vec<u64> = header.dims.iter().rev().map(|&n| n.into()).collect();
    if header.times > 1 {
        shape.insert(0, header.times.into());
    }
    if header.components > 1 {
        shape.push(header.components.into());
    }
    assert_eq!(Value::from(shape), variable["shape_zyx"], "{id} {name}");
    assert_eq!(header.stored.name(), "f32", "{id} {name}");
    let components = header.components as usize;
    let count = header.voxel_count() as usize;
    let mut bytes = vec![0; 4 * count * components * header.times as usize];
    for time in 0..header.times {
        for component in 0..header.components {
            let piece = source
                .read(TimeComponent { time, component }, header.whole())
                .unwrap();
            let Voxels::F32(numbers) = piece.voxels else {
                panic!("{id} {name}: no floats");
            };
            for (i, number) in numbers.iter().enumerate() {
                let at = (time as usize * count + i) * components + component as usize;
                bytes[4 * at..][..4].copy_from_slice(&number.to_le_bytes());
            }
        }
    }
    let digest: String = Sha256::digest(&bytes)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    assert_eq!(
        Some(digest.as_str()),
        variable["voxel_sha256"].as_str(),
        "{id} {name}"
    );
    let statistics =
        Statistics::of(source.as_ref(), 0..header.components, &Limits::default()).unwrap();
    let stored = &variable["stored"];
    assert_eq!(Some(statistics.min), stored["min"].as_f64(), "{id} {name}");
    assert_eq!(Some(statistics.max), stored["max"].as_f64(), "{id} {name}");
    let mean = stored["mean"].as_f64().unwrap();
    let error = (statistics.mean - mean).abs();
    // Sums of some hundred thousand numbers in f64, in another order.
    assert!(
        error <= 1e-9 * mean.abs(),
        "{id} {name}: mean {}, not {mean}",
        statistics.mean
    );
    assert_eq!(
        statistics.valid_count,
        (count * components) as u64 * u64::from(header.times)
    );
}

#[test]
fn real_files_hold_what_the_manifest_says() {
    let mut checked = 0;
    for kind in ["netcdf", "hdf5"] {
        for entry in truth::entries(kind) {
            for variable in entry["variables"].as_array().unwrap() {
                check(&entry, variable);
                checked += 1;
            }
        }
    }
    println!("{checked} variables checked");
    assert!(checked >= 16 || truth::folder().is_none(), "{checked}");
}
