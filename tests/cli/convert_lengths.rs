//! Lengths of a volume in another format are the same lengths, in metres.

use crate::person::Folder;
use stratavox::{
    format,
    volume::{Limits, VolumeSelection},
};

/// Metres of the first step and of the corner, of a file.
fn metres(folder: &Folder, name: &str) -> [f64; 2] {
    let source = format::open(
        &folder.path(name),
        &VolumeSelection::default(),
        &Limits::default(),
    )
    .unwrap_or_else(|e| panic!("{name}: {e}"));
    let header = source.header();
    let unit = header.length_metres.expect("a unit");
    let place = header.world_from_voxel;
    [
        unit * place.matrix3.x_axis.length(),
        unit * place.translation.length(),
    ]
}

#[test]
fn lengths_stay_the_same_in_metres_whatever_the_format_can_say() {
    let folder = Folder::new();
    let mut compared = 0;
    for (unit, is_named) in [("mm", true), ("um", true), ("km", true), ("furlong", false)] {
        let head = format!(
            "NRRD0004\ntype: uint8\ndimension: 3\nspace: right-anterior-superior\nsizes: 2 2 2\n\
             space directions: (3,0,0) (0,3,0) (0,0,3)\nspace units: \"{unit}\" \"{unit}\" \"{unit}\"\n\
             space origin: (5,6,7)\nendian: little\nencoding: raw\n\n"
        );
        folder.file("in.nrrd", [head.as_bytes(), &[1; 8]].concat());
        for ending in ["nrrd", "nii", "mha"] {
            let ran = folder.run(&format!("convert in.nrrd -o out.{ending} --force"));
            ran.assert_done();
            let is_said = ran.err.contains("written in millimetres");
            let is_changed = is_named && unit != "mm" && ending != "nrrd";
            assert_eq!(is_said, is_changed, "{unit} {ending}: {}", ran.err);
            assert!(!ran.err.contains("those of a patient"), "{}", ran.err);
            if !is_named {
                continue;
            }
            let (wanted, found) = (
                metres(&folder, "in.nrrd"),
                metres(&folder, &format!("out.{ending}")),
            );
            for (wanted, found) in wanted.into_iter().zip(found) {
                assert!(
                    (found / wanted - 1.0).abs() < 1e-6,
                    "{unit} {ending}: {found}, not {wanted}"
                );
            }
            compared += 1;
        }
    }
    assert_eq!(compared, 9);
}

#[test]
fn axes_of_no_patient_are_said_to_be_written_as_those_of_one() {
    let folder = Folder::new();
    for (ending, is_said) in [("nrrd", true), ("nii", true), ("npy", false)] {
        let ran = folder.run(&format!("convert phantom:fog,n=8 -o out.{ending}"));
        ran.assert_done();
        assert_eq!(
            ran.err.contains("those of a patient"),
            is_said,
            "{}",
            ran.err
        );
    }
}
