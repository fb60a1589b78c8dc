//! Real volumes: `info` says what their manifest says, and a render without a flag shows something.
//!
//! The folder is that of `STRATAVOX_DATA`, else `../shared/data` beside the checkout.

use crate::person::Folder;
use serde_json::Value;
use std::{
    fs,
    path::{Path, PathBuf},
};

const FORMATS: [&str; 3] = ["nrrd", "metaimage", "nifti"];

fn data() -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    let folder = std::env::var_os("STRATAVOX_DATA").map_or_else(beside, PathBuf::from);
    let found = folder.join("manifest.json").is_file();
    if !found {
        println!("skipped: no data in {}", folder.display());
    }
    found.then_some(folder)
}

/// (path, what the manifest says of the volume) of every file that we read.
fn volumes(folder: &Path) -> Vec<(PathBuf, Value)> {
    let text = fs::read_to_string(folder.join("manifest.json")).expect("a manifest");
    // Python writes NaN where JSON has no word for it; no volume of ours has one there.
    let manifest: Value = serde_json::from_str(&text.replace(": NaN", ": null")).expect("JSON");
    let entries = manifest["entries"].as_array().expect("a list").iter();
    let ours = entries.filter(|entry| FORMATS.contains(&entry["kind"].as_str().unwrap_or("")));
    let found: Vec<_> = ours
        .map(|entry| {
            (
                folder.join(entry["path"].as_str().expect("a path")),
                entry["volume"].clone(),
            )
        })
        .collect();
    assert!(found.len() >= 15, "only {} volumes", found.len());
    found
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
    list.iter()
        .map(|number| number.as_f64().expect("a number"))
        .collect()
}

#[track_caller]
fn assert_near(path: &Path, what: &str, found: f64, wanted: f64, allowed: f64) {
    let off = (found - wanted).abs();
    assert!(
        off <= allowed,
        "{}: {what} is {found}, wanted {wanted}",
        path.display()
    );
}

#[test]
fn info_says_what_the_manifest_says() {
    let Some(data) = data() else { return };
    let folder = Folder::new();
    for (path, wanted) in volumes(&data) {
        let ran = folder.run(&format!("info --json {}", path.display()));
        ran.assert_done();
        let found: Value = serde_json::from_str(&ran.out).expect("JSON");

        let dims = numbers(&wanted["dims_xyz"]);
        assert_eq!(numbers(&found["dims"]), dims[..3], "{}", path.display());
        let times = dims.get(3).copied().unwrap_or(1.0);
        assert_near(
            &path,
            "times",
            found["times"].as_f64().expect("a count"),
            times,
            0.0,
        );
        let short = match wanted["dtype"].as_str().expect("a type") {
            "uint8" => "u8",
            "int16" => "i16",
            "uint16" => "u16",
            "float32" => "f32",
            other => panic!("{other}"),
        };
        assert_eq!(found["type"], short, "{}", path.display());
        // The manifest keeps six decimals.
        for (k, (&is, &should)) in numbers(&found["spacing"])
            .iter()
            .zip(&numbers(&wanted["spacing"]))
            .enumerate()
        {
            assert_near(&path, &format!("spacing {k}"), is, should, 1e-6);
        }
        for key in ["min", "max"] {
            let should = wanted["stored"][key].as_f64().expect("a number");
            assert_near(
                &path,
                key,
                found[key].as_f64().expect("a number"),
                should,
                0.0,
            );
        }
        // The frog's header says 2067 bytes less than there are, and the manifest was made by a reader that
        // believes it and leaves the rest zero. This is the sum of all of its voxels.
        let mean = if path.ends_with("frogtissue.mhd") {
            12_279_472.0 / dims.iter().product::<f64>()
        } else {
            wanted["stored"]["mean"].as_f64().expect("a number")
        };
        // Sums of some million numbers in f64, in another order.
        assert_near(
            &path,
            "mean",
            found["mean"].as_f64().expect("a number"),
            mean,
            1e-9 * mean.abs().max(1.0),
        );
        let rows = wanted["affine_ras"]
            .as_array()
            .map(Vec::as_slice)
            .unwrap_or_default();
        for (r, row) in rows.iter().enumerate() {
            for (c, &should) in numbers(row).iter().enumerate() {
                let is = numbers(&found["world_from_voxel"][r])[c];
                assert_near(&path, &format!("affine {r} {c}"), is, should, 1e-5);
            }
        }
    }
}

#[test]
fn a_render_without_a_flag_is_neither_blank_nor_saturated() {
    let Some(data) = data() else { return };
    let folder = Folder::new();
    for (path, _) in volumes(&data) {
        let ran = folder.run(&format!(
            "render {} -o a.npy --force --size 128x96",
            path.display()
        ));
        ran.assert_done();
        let bytes = fs::read(folder.path("a.npy")).expect("a picture");
        let pixels = &bytes[bytes.len() - 128 * 96 * 16..];
        let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().expect("four bytes"));
        // Straight grey of the pixels that show something.
        let grey: Vec<f32> = pixels
            .chunks_exact(16)
            .map(|pixel| [0, 4, 8, 12].map(|at| number(&pixel[at..at + 4])))
            .filter(|pixel| pixel[3] > 0.02)
            .map(|[r, g, b, a]| (r + g + b) / (3.0 * a))
            .collect();
        let count = grey.len() as f32;
        let covered = count / (128.0 * 96.0);
        let white = grey.iter().filter(|&&g| g > 0.99).count() as f32 / count;
        let mean = grey.iter().sum::<f32>() / count;
        let deviation = (grey.iter().map(|g| (g - mean) * (g - mean)).sum::<f32>() / count).sqrt();
        let shown = format!(
            "{}: {covered:.3} covered, {white:.3} white, mean {mean:.3}, deviation {deviation:.4}",
            path.display()
        );
        println!("{shown}");
        assert!(covered > 0.02, "blank: {shown}");
        assert!(white < 0.5, "saturated: {shown}");
        assert!(deviation > 0.01, "flat: {shown}");
    }
}

/// The letters R and L are burnt into this scan on the patient's right and left; R has the more voxels, 49 959
/// of value 255 against 31 760. In the file x runs to the patient's right.
#[test]
fn left_is_left() {
    let Some(data) = data() else { return };
    let scan = data.join("mri-avg152-be/avg152T1_RL_nifti.nii.gz");
    let folder = Folder::new();
    // From above, anterior up, the patient's right is right; from below it is left, as radiologists look.
    for (view, right_is_right) in [("superior", true), ("inferior", false)] {
        let ran = folder.run(&format!(
            "render {} -o a.npy --force --size 96x96 --mode mip --view {view}",
            scan.display()
        ));
        ran.assert_done();
        let bytes = fs::read(folder.path("a.npy")).expect("a picture");
        let pixels = bytes[bytes.len() - 96 * 96 * 16..].chunks_exact(16);
        let is_white =
            |pixel: &[u8]| f32::from_le_bytes([pixel[0], pixel[1], pixel[2], pixel[3]]) > 0.99;
        let mut white = [0, 0];
        for (i, pixel) in pixels.enumerate() {
            white[usize::from(i % 96 >= 48)] += u32::from(is_white(pixel));
        }
        let [left, right] = white;
        assert!(
            left + right > 200,
            "{view}: only {left} + {right} white pixels"
        );
        let found = right as f32 > 1.2 * left as f32;
        let mirrored = left as f32 > 1.2 * right as f32;
        assert!(
            if right_is_right { found } else { mirrored },
            "{view}: {left} white pixels on the left, {right} on the right"
        );
    }
}
