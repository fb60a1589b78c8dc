//! Real volumes: `info` says what their manifest says, and a render without a flag shows something.
//!
//! The folder is that of `STRATAVOX_DATA`, else `../shared/data` beside the checkout.

use crate::person::Folder;
use serde_json::Value;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Entries of which `info` has no array to compare: the file, the exit code, and what is said.
const OTHERS: [(&str, &str, i32, &str); 2] = [
    // Scattered points, no volume.
    (
        "points-quakes",
        "points-quakes/earthquakes.csv",
        0,
        "1707 points were read",
    ),
    ("met-grib", "met-ifs-ml/tuv_pl.grib", 3, "grib: edition 1"),
];

/// Arrays, one for each variable of each entry: of the manifest's 32 entries, 26 hold one, 4 hold 18 in all.
const ARRAYS: usize = 26 + 18;

/// The folder, where it is there.
pub fn data() -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    let folder = std::env::var_os("STRATAVOX_DATA").map_or_else(beside, PathBuf::from);
    let found = folder.join("manifest.json").is_file();
    if !found {
        println!("skipped: no data in {}", folder.display());
    }
    found.then_some(folder)
}

/// One array of the manifest.
struct Array {
    id: String,
    /// As the command line has it: the path, and the variable where there are several.
    input: String,
    wanted: Value,
}

/// The arrays of every entry. An entry without one must be known as such.
fn arrays(folder: &Path) -> Vec<Array> {
    let text = fs::read_to_string(folder.join("manifest.json")).expect("a manifest");
    // Python writes NaN where JSON has no word for it; no number that is compared is one.
    let manifest: Value = serde_json::from_str(&text.replace(": NaN", ": null")).expect("JSON");
    let mut found = Vec::new();
    for entry in manifest["entries"].as_array().expect("a list") {
        let id = entry["id"].as_str().expect("an id").to_owned();
        let path = folder.join(entry["path"].as_str().expect("a path"));
        let variables = entry["variables"].as_array().map(Vec::as_slice);
        let refused = OTHERS.iter().any(|&(name, ..)| name == id);
        match (entry["volume"].is_object(), variables) {
            (true, None) => found.push(Array {
                id,
                input: path.display().to_string(),
                wanted: entry["volume"].clone(),
            }),
            (false, Some(variables)) => {
                found.extend(variables.iter().map(|variable| Array {
                    id: id.clone(),
                    input: format!(
                        "{} --variable {}",
                        path.display(),
                        variable["name"].as_str().expect("a name")
                    ),
                    wanted: variable.clone(),
                }));
            }
            _ => assert!(refused, "{id}: neither a volume nor known to be none"),
        }
    }
    found
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
    list.iter()
        .map(|number| number.as_f64().expect("a number"))
        .collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[track_caller]
fn assert_near(array: &Array, what: &str, found: f64, wanted: f64, allowed: f64) {
    let off = (found - wanted).abs();
    assert!(
        off <= allowed,
        "{}: {what} is {found}, wanted {wanted}",
        array.input
    );
}

/// Dimensions as the manifest has them, x first, without the numbers of a vector.
fn extents(wanted: &Value) -> Vec<f64> {
    let mut extents = numbers(&wanted["shape_zyx"]);
    extents.reverse();
    if wanted["components"]
        .as_f64()
        .is_some_and(|count| count > 1.0)
    {
        extents.remove(0);
    }
    extents
}

/// Spacing as the manifest has it, in the words of each producer; none where the file says none.
fn spacing(wanted: &Value) -> Vec<f64> {
    let given = numbers(&wanted["spacing"]);
    if !given.is_empty() {
        return given[..3].to_vec();
    }
    if let Some(along) = wanted["slice_distance_along_normal"]["median"].as_f64() {
        let [row, column] = numbers(&wanted["pixel_spacing_row_col"])[..] else {
            panic!("two numbers");
        };
        return vec![column, row, along];
    }
    let micrometres = numbers(&wanted["element_size_um_zyx"]);
    micrometres.iter().rev().map(|um| um / 1000.0).collect()
}

#[test]
fn info_says_what_the_manifest_says() {
    let Some(data) = data() else { return };
    let folder = Folder::new();
    let arrays = arrays(&data);
    assert_eq!(arrays.len(), ARRAYS, "arrays to compare");
    for array in &arrays {
        let wanted = &array.wanted;
        let extents = extents(wanted);
        // What follows x, y, z and time is a member of an ensemble: each is a volume of its own.
        let members = extents.get(4).map_or(1, |&count| count as usize);
        let found: Vec<Value> = (0..members)
            .map(|member| {
                let member = match members {
                    1 => String::new(),
                    _ => format!("[number={member}]"),
                };
                let ran = folder.run(&format!("info --json {}{member}", array.input));
                ran.assert_done();
                serde_json::from_str(&ran.out).expect("JSON")
            })
            .collect();
        for one in &found {
            assert_form(array, one, &extents);
        }
        let numbers = match &wanted["physical"] {
            Value::Null => &wanted["stored"],
            physical => physical,
        };
        let all = |key: &str| {
            found
                .iter()
                .map(|one| number(&one[key]))
                .collect::<Vec<_>>()
        };
        let lowest = all("min").into_iter().fold(f64::INFINITY, f64::min);
        let highest = all("max").into_iter().fold(f64::NEG_INFINITY, f64::max);
        let mean = all("mean").iter().sum::<f64>() / members as f64;
        assert_near(array, "min", lowest, number(&numbers["min"]), 0.0);
        assert_near(array, "max", highest, number(&numbers["max"]), 0.0);
        // The frog's header says 2067 bytes less than there are, and the manifest was made by a reader that
        // believes it and leaves the rest zero. This is the sum of all of its voxels.
        let wanted_mean = match array.id.as_str() {
            "label-frog" => 12_279_472.0 / extents.iter().product::<f64>(),
            _ => number(&numbers["mean"]),
        };
        // Sums of some million numbers in f64, in another order.
        let allowed = 1e-9 * wanted_mean.abs().max(1.0);
        assert_near(array, "mean", mean, wanted_mean, allowed);
        if let Some(missing) = wanted["missing_count"].as_f64() {
            let found = all("fill_count").iter().sum();
            assert_near(array, "fill_count", found, missing, 0.0);
        }
    }
    println!("{} arrays compared", arrays.len());
}

/// What `info --json` says of type, dimensions and place.
#[track_caller]
fn assert_form(array: &Array, found: &Value, extents: &[f64]) {
    let wanted = &array.wanted;
    assert_eq!(numbers(&found["dims"]), extents[..3], "{}", array.input);
    let times = extents.get(3).copied().unwrap_or(1.0);
    assert_near(array, "times", number(&found["times"]), times, 0.0);
    let components = wanted["components"].as_f64().unwrap_or(1.0);
    let is = number(&found["components"]);
    assert_near(array, "components", is, components, 0.0);
    let short = match wanted["dtype"].as_str().expect("a type") {
        "uint8" => "u8",
        "int16" => "i16",
        "uint16" => "u16",
        "float32" => "f32",
        other => panic!("{other}"),
    };
    assert_eq!(found["type"], short, "{}", array.input);
    // The manifest keeps six decimals.
    let spacing = spacing(wanted);
    for (k, (&is, &should)) in numbers(&found["spacing"]).iter().zip(&spacing).enumerate() {
        assert_near(array, &format!("spacing {k}"), is, should, 1e-6);
    }
    let rows = wanted["affine_ras"].as_array();
    for (r, row) in rows.into_iter().flatten().enumerate() {
        for (c, &should) in numbers(row).iter().enumerate() {
            let is = numbers(&found["world_from_voxel"][r])[c];
            assert_near(array, &format!("affine {r} {c}"), is, should, 1e-5);
        }
    }
    // DICOM is LPS: x and y turn round.
    let first = numbers(&wanted["first_position"]);
    for (r, (&should, sign)) in first.iter().zip([-1.0, -1.0, 1.0]).enumerate() {
        let is = numbers(&found["world_from_voxel"][r])[3];
        assert_near(array, &format!("position {r}"), is, sign * should, 1e-6);
    }
}

#[test]
fn what_is_no_array_is_named() {
    let Some(data) = data() else { return };
    let folder = Folder::new();
    for (id, path, code, said) in OTHERS {
        let ran = folder.run(&format!("info {}", data.join(path).display()));
        assert_eq!(ran.code, code, "{id}: {}", ran.err);
        let all = format!("{}{}", ran.out, ran.err);
        assert!(all.contains(said), "{id}: {all}");
    }
}

#[test]
fn a_render_without_a_flag_is_neither_blank_nor_saturated() {
    let Some(data) = data() else { return };
    let folder = Folder::new();
    for Array { input, .. } in arrays(&data) {
        let ran = folder.run(&format!("render {input} -o a.npy --force --size 128x96"));
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
            "{input}: {covered:.3} covered, {white:.3} white, mean {mean:.3}, deviation {deviation:.4}"
        );
        println!("{shown}");
        // Five beads in the middle of a tall box are the least that any of them shows.
        assert!(covered > 0.004, "blank: {shown}");
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
