//! VTK ImageData: every way of writing that VTK's own writer has, arrays of points and cells, pieces, and the real
//! files.
#![cfg(feature = "files")]

use crate::files;
use crate::truth;
use crate::vtk;

use files::{Folder, message, numbers};
use glam::dvec3;
use stratavox::format;
use stratavox::volume::{
    ComponentKind, Limits, TimeComponent, VolumeSelection, VoxelBox, VoxelType, Voxels,
};

/// An image of bytes in words; `extent` is that of the only piece.
fn file(image: &str, data: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<!-- a comment -->\n<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\">\n\
         <ImageData {image}>\n{data}\n</ImageData>\n</VTKFile>\n"
    )
}

fn array(attributes: &str, numbers: &str) -> String {
    format!("<DataArray type=\"UInt8\" format=\"ascii\" {attributes}>{numbers}</DataArray>")
}

fn piece(extent: &str, points: &str) -> String {
    format!("<Piece Extent=\"{extent}\"><PointData Scalars=\"s\">{points}</PointData></Piece>")
}

#[test]
fn every_way_of_writing_gives_the_numbers_that_vtk_reads() {
    let count = vtk::check_all("vti");
    println!("{count} arrays compared");
    assert!(count >= 70, "{count}");
}

#[test]
fn real_files_are_what_the_manifest_says_and_agree_with_each_other() {
    let mut tried = 0;
    for entry in truth::entries("vti") {
        let [x, y, z] = [0, 1, 2].map(|k| entry["volume"]["spacing"][k].as_f64().unwrap());
        let found = truth::check(&entry, None);
        let wanted = [[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0]];
        truth::same_affine(entry["id"].as_str().unwrap(), found, wanted, 1e-12);
        tried += 1;
    }
    assert!(tried == 2 || truth::folder().is_none(), "{tried} files");
    let Some(folder) = truth::folder() else {
        return;
    };
    let open = |name: &str| {
        let path = folder.join("vti-headsq").join(name);
        format::open(&path, &VolumeSelection::default(), &Limits::default()).unwrap()
    };
    let (all, every_second) = (open("headsq.vti"), open("headsq-inline.vti"));
    for z in 0..47 {
        let slice = |z: u32| VoxelBox {
            min: [0, 0, z],
            max: [64, 64, z + 1],
        };
        let wanted = all.read(TimeComponent::default(), slice(2 * z)).unwrap();
        let found = every_second
            .read(TimeComponent::default(), slice(z))
            .unwrap();
        assert_eq!(found, wanted, "slice {z}");
    }
}

#[test]
fn a_box_and_a_component_of_any_encoding_are_those_of_the_whole() {
    let region = VoxelBox {
        min: [1, 2, 1],
        max: [4, 3, 3],
    };
    let pick = TimeComponent {
        time: 0,
        component: 2,
    };
    let mut tried = 0;
    for name in ["several.vti", "several64.vti", "several-inline.vti"] {
        let wanted = VolumeSelection {
            variable: Some("flow".to_owned()),
            ..VolumeSelection::default()
        };
        let path = vtk::folder("vti").join(name);
        let source = format::open(&path, &wanted, &Limits::default()).unwrap();
        let whole = numbers(&source.read(pick, source.header().whole()).unwrap().voxels);
        let part = numbers(&source.read(pick, region).unwrap().voxels);
        let mut wanted = Vec::new();
        for z in 1..3 {
            for x in 1..4 {
                wanted.push(whole[x + 5 * (2 + 4 * z)]);
            }
        }
        assert_eq!(part, wanted, "{name}");
        tried += 1;
    }
    assert_eq!(tried, 3);
}

#[test]
fn arrays_are_variables_with_the_active_scalars_first_and_a_time_has_its_name() {
    for name in ["several.vti", "several64.vti", "several-inline.vti"] {
        let path = vtk::folder("vti").join(name);
        let open = |wanted: &VolumeSelection| format::open(&path, wanted, &Limits::default());
        let source = open(&VolumeSelection::default()).unwrap();
        let header = source.header();
        assert_eq!(header.variables, ["a", "b", "flow", "b (cells)"], "{name}");
        assert_eq!(header.time_names, ["0.1"], "{name}");
        let wanted = VolumeSelection {
            variable: Some("who".to_owned()),
            ..VolumeSelection::default()
        };
        let error = message(&open(&wanted).err().expect("no such array"));
        assert!(error.contains("b, a, flow, b (cells)"), "{error}");
    }
}

#[test]
fn cells_lie_between_points_and_a_flat_axis_keeps_its_plane() {
    let folder = Folder::new();
    let data = "<Piece Extent=\"10 12 0 1 5 5\"><CellData>".to_owned()
        + &array("Name=\"c\"", "7 8")
        + "</CellData></Piece>";
    let image = "WholeExtent=\"10 12 0 1 5 5\" Origin=\"1 2 3\" Spacing=\"2 4 8\"";
    let (header, read) = folder.read("a.vti", file(image, &data)).unwrap();
    assert_eq!(header.dims, [2, 1, 1]);
    assert_eq!(read.voxels, Voxels::U8(vec![7, 8]));
    let center = header
        .world_from_voxel
        .transform_point3(dvec3(0.5, 0.5, 0.5));
    assert_eq!(
        center,
        dvec3(1.0 + 2.0 * 10.5, 2.0 + 4.0 * 0.5, 3.0 + 8.0 * 5.0)
    );
    assert!(
        header.notes.iter().any(|note| note.contains("cells")),
        "{:?}",
        header.notes
    );
}

#[test]
fn a_direction_turns_the_axes_and_no_patient_is_invented() {
    let folder = Folder::new();
    let image = "WholeExtent=\"0 1 0 0 0 0\" Origin=\"1 2 3\" Spacing=\"2 4 8\" Direction=\"0 -1 0 1 0 0 0 0 1\"";
    let data = piece("0 1 0 0 0 0", &array("Name=\"s\"", "1 2"));
    let (header, _) = folder.read("a.vti", file(image, &data)).unwrap();
    let center = |x: f64| header.world_from_voxel.transform_point3(dvec3(x, 0.5, 0.5));
    assert_eq!(center(0.5), dvec3(1.0, 2.0, 3.0));
    assert_eq!(center(1.5), dvec3(1.0, 4.0, 3.0));
    let notes = &header.notes;
    assert!(
        notes.iter().any(|note| note.contains("as they stand")),
        "{notes:?}"
    );
}

#[test]
fn pieces_are_put_together_and_a_hole_between_them_is_an_error() {
    let folder = Folder::new();
    let image = "WholeExtent=\"0 2 0 1 0 0\"";
    let left = piece("0 1 0 1 0 0", &array("Name=\"s\"", "1 2 4 5"));
    let right = piece("1 2 0 1 0 0", &array("Name=\"s\"", "2 3 5 6\n"));
    let (header, read) = folder
        .read("a.vti", file(image, &(left.clone() + &right)))
        .unwrap();
    assert_eq!(header.dims, [3, 2, 1]);
    assert_eq!(read.voxels, Voxels::U8(vec![1, 2, 3, 4, 5, 6]));
    let empty = "<Piece Extent=\"0 -1 0 -1 0 -1\"/>";
    let apart = piece("2 2 0 1 0 0", &array("Name=\"s\"", "3 6"));
    let (_, read) = folder
        .read("a.vti", file(image, &(left.clone() + empty + &apart)))
        .unwrap();
    assert_eq!(read.voxels, Voxels::U8(vec![1, 2, 3, 4, 5, 6]));

    let error = folder.refused("a.vti", file(image, &left));
    assert!(error.contains("[2, 0, 0] to [3, 2, 1]"), "{error}");
    let other = piece("1 2 0 1 0 0", &array("Name=\"t\"", "2 3 5 6"));
    let error = folder.refused("a.vti", file(image, &(left.clone() + &other)));
    assert!(error.contains("the array s"), "{error}");
    let other = right.replace("UInt8", "Int8");
    let error = folder.refused("a.vti", file(image, &(left + &other)));
    assert!(error.contains("`type`"), "{error}");
}

#[test]
fn text_may_stand_beside_the_keys_that_vtk_adds_and_marks_are_no_variables() {
    let folder = Folder::new();
    let key = "<InformationKey name=\"L2\" location=\"x\" length=\"2\"><Value index=\"0\">3</Value></InformationKey>";
    let data = piece(
        "0 1 0 0 0 0",
        &(array("Name=\"vtkGhostType\"", "0 0") + &array("Name=\"s\"", &format!("\n 1 2 {key}\n"))),
    );
    let (header, read) = folder
        .read("a.vti", file("WholeExtent=\"0 1 0 0 0 0\"", &data))
        .unwrap();
    assert_eq!(read.voxels, Voxels::U8(vec![1, 2]));
    assert_eq!(header.variables, ["s"]);
    assert_eq!(
        (header.stored, header.meaning),
        (VoxelType::U8, ComponentKind::Numbers)
    );
    let notes = &header.notes;
    assert!(
        notes.iter().any(|note| note.contains("vtkGhostType")),
        "{notes:?}"
    );
}
