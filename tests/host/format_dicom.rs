//! Real DICOM folders against what is known of them.
#![cfg(feature = "dicom")]

use crate::truth;

#[test]
fn real_folders_give_the_volumes_that_the_manifest_describes() {
    let mut read = Vec::new();
    for entry in truth::entries("dicom") {
        let id = entry["id"].as_str().unwrap();
        let affine = truth::check(&entry, None);
        // Positions and spacing as the manifest lists them, in LPS: x and y change their signs.
        let volume = &entry["volume"];
        let number = |key: &str, k: usize| volume[key][k].as_f64().unwrap();
        let step = volume["slice_distance_along_normal"]["median"]
            .as_f64()
            .unwrap();
        let [rows, columns] = [0, 1].map(|k| number("pixel_spacing_row_col", k));
        let first = [0, 1, 2].map(|k| number("first_position", k));
        let wanted = [
            [-columns, 0.0, 0.0, -first[0]],
            [0.0, -rows, 0.0, -first[1]],
            [0.0, 0.0, step, first[2]],
        ];
        truth::same_affine(id, affine, wanted, 1e-9);
        read.push(id.to_owned());
    }
    read.sort();
    if truth::folder().is_some() {
        assert_eq!(read, ["dicom-ct-head", "dicom-ct-torso", "dicom-pet"]);
    }
}
