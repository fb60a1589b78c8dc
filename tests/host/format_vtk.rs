//! Legacy VTK files: every type in words and bytes by VTK's own writer, arrays of points and cells, and what is
//! refused.
#![cfg(feature = "files")]

use crate::files;
use crate::vtk;

use files::{Folder, numbers};
use glam::{DVec3, dvec3};
use stratavox::format;
use stratavox::volume::{ComponentKind, Limits, VolumeSelection, VoxelType, Voxels};

/// Structured points of 3 x 2 x 1.
fn file(kind: &str, rest: &str) -> String {
    format!(
        "# vtk DataFile Version 3.0\na title\n{kind}\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 1\n\
         SPACING 2 3 4\nORIGIN 10 20 30\n{rest}"
    )
}

#[test]
fn every_way_of_writing_gives_the_numbers_that_vtk_reads() {
    let count = vtk::check_all("vtk");
    println!("{count} arrays compared");
    assert!(count >= 40, "{count}");
}

#[test]
fn arrays_are_variables_with_active_scalars_first_and_a_time_has_its_name() {
    for name in [
        "several-ascii-42.vtk",
        "several-binary-42.vtk",
        "several-ascii-51.vtk",
        "several-binary-51.vtk",
    ] {
        let path = vtk::folder("vtk").join(name);
        let source = format::open(&path, &VolumeSelection::default(), &Limits::default()).unwrap();
        assert_eq!(source.header().variables[0], "s", "{name}");
        assert_eq!(source.header().variables.len(), 4, "{name}");
        assert_eq!(source.header().time_names, ["2.5"], "{name}");
    }
}

#[test]
fn old_keywords_lookup_tables_and_fields_are_understood() {
    let folder = Folder::new();
    let text = file(
        "ASCII",
        "POINT_DATA 6\nSCALARS my%20value unsigned_short 1\nLOOKUP_TABLE mine\n1 2 3\n4 5 6\n\
         LOOKUP_TABLE mine 2\n0 0 0 1\n1 1 1 1\nNORMALS n float\n0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1\n\
         FIELD f 2\nfew 1 2 int\n7 8\nsix 1 6 double\n1.5 2 3 4 5 6\nCELL_DATA 2\nSCALARS c char\nLOOKUP_TABLE default\n-1 1\n",
    )
    .replace("SPACING", "ASPECT_RATIO");
    let (header, read) = folder.read("a.vtk", &text).unwrap();
    assert_eq!(header.variables, ["my value", "n", "six", "c"]);
    assert_eq!(header.stored, VoxelType::U16);
    assert_eq!(read.voxels, Voxels::U16(vec![1, 2, 3, 4, 5, 6]));
    let at = |x: f64| header.world_from_voxel.transform_point3(dvec3(x, 0.5, 0.5));
    assert_eq!(
        (at(0.5), at(1.5)),
        (dvec3(10.0, 20.0, 30.0), dvec3(12.0, 20.0, 30.0))
    );

    let wanted = VolumeSelection {
        variable: Some("c".to_owned()),
        ..VolumeSelection::default()
    };
    let path = folder.path("a.vtk");
    let source = format::open(&path, &wanted, &Limits::default()).unwrap();
    let header = source.header();
    assert_eq!((header.dims, header.stored), ([2, 1, 1], VoxelType::I8));
    let at = header
        .world_from_voxel
        .transform_point3(dvec3(0.5, 0.5, 0.5));
    assert_eq!(at, dvec3(11.0, 21.5, 30.0));
}

#[test]
fn an_extent_says_where_the_first_point_lies() {
    let folder = Folder::new();
    let text = file(
        "ASCII",
        "POINT_DATA 6\nSCALARS s int\nLOOKUP_TABLE default\n1 2 3 4 5 6\n",
    )
    .replace("DIMENSIONS 3 2 1", "EXTENT 4 6 -1 0 7 7");
    let (header, _) = folder.read("a.vtk", &text).unwrap();
    assert_eq!(header.dims, [3, 2, 1]);
    let first = header.world_from_voxel.transform_point3(DVec3::splat(0.5));
    let at = |index: DVec3| dvec3(10.0, 20.0, 30.0) + index * dvec3(2.0, 3.0, 4.0);
    assert_eq!(first, at(dvec3(4.0, -1.0, 7.0)));
}

#[test]
fn colors_are_bytes_in_binary_files_and_fractions_in_words() {
    let folder = Folder::new();
    let bytes: Vec<u8> = (0..24).collect();
    let head = file("BINARY", "POINT_DATA 6\nCOLOR_SCALARS rgba 4\n");
    let (header, read) = folder
        .read("a.vtk", [head.as_bytes(), &bytes, b"\n"].concat())
        .unwrap();
    assert_eq!(
        (header.meaning, header.stored),
        (ComponentKind::Rgba, VoxelType::U8)
    );
    assert_eq!(numbers(&read.voxels), [0.0, 4.0, 8.0, 12.0, 16.0, 20.0]);
    let words = "0 0.5 1\n".repeat(6);
    let text = file(
        "ASCII",
        &format!("POINT_DATA 6\nCOLOR_SCALARS rgb 3\n{words}"),
    );
    let (header, _) = folder.read("a.vtk", &text).unwrap();
    assert_eq!(
        (header.meaning, header.stored),
        (ComponentKind::Rgb, VoxelType::U8)
    );
    let words = text
        .replace("rgb 3", "grey 1")
        .replace("0 0.5 1\n", "0.498 ");
    let (header, read) = folder.read("a.vtk", words + "\n").unwrap();
    assert_eq!(header.meaning, ComponentKind::Numbers);
    assert_eq!(read.voxels, Voxels::U8(vec![127; 6]));
    let error = folder.refused("a.vtk", text.replace("0.5", "1.5"));
    assert!(error.contains("`1.5` is no fraction of 1"), "{error}");
}

#[test]
fn other_data_sets_types_and_versions_are_refused_by_name() {
    let folder = Folder::new();
    let good = file(
        "ASCII",
        "POINT_DATA 6\nSCALARS s int\nLOOKUP_TABLE default\n1 2 3 4 5 6\n",
    );
    folder.read("a.vtk", &good).unwrap();
    for (from, to, word) in [
        ("STRUCTURED_POINTS", "RECTILINEAR_GRID", "RECTILINEAR_GRID"),
        (
            "STRUCTURED_POINTS",
            "UNSTRUCTURED_GRID",
            "unstructured grids are not read; resample with vtkResampleToImage to .vti",
        ),
        ("STRUCTURED_POINTS", "POLYDATA", "POLYDATA"),
        ("STRUCTURED_POINTS", "MINE", "`MINE`"),
        ("Version 3.0", "Version 9.0", "version 9.0"),
        ("Version 3.0", "Version x", "version"),
        ("ASCII", "OTHER", "ASCII or BINARY"),
        ("DIMENSIONS 3 2 1", "DIMENSIONS 3 2 0", "DIMENSIONS"),
        ("DIMENSIONS 3 2 1", "DIMENSIONS 3 2 2", "POINT_DATA"),
        (
            "DIMENSIONS 3 2 1",
            "DIMENSIONS 2147483647 2147483647 2147483647",
            "DIMENSIONS",
        ),
        ("SPACING 2 3 4", "SPACING 2 0 4", "SPACING"),
        ("SPACING 2 3 4", "SPACING 2 nan 4", "SPACING"),
        ("int", "string", "string"),
        ("int", "quadruple", "`quadruple`"),
        ("LOOKUP_TABLE default\n", "", "LOOKUP_TABLE"),
        ("1 2 3 4 5 6\n", "1 2 3 4 5\n", "6 numbers"),
        ("1 2 3 4 5 6\n", "1 2 3 4 5 6", "6 numbers"),
        ("1 2 3 4 5 6", "1 2 x 4 5 6", "`x` is no i32"),
        ("POINT_DATA 6", "DATA 6", "POINT_DATA"),
    ] {
        let error = folder.refused("a.vtk", good.replacen(from, to, 1));
        assert!(error.contains(word), "{to}: {error}");
    }
    folder.refused("b.vtk", "hello\n");
    folder.refused("b.vtr", "<VTKFile type=\"RectilinearGrid\"></VTKFile>");
}

#[test]
fn a_file_cut_anywhere_is_refused() {
    let folder = Folder::new();
    let head = file(
        "BINARY",
        "POINT_DATA 6\nSCALARS s short 1\nLOOKUP_TABLE default\n",
    );
    let binary = [head.as_bytes(), &[1; 12]].concat();
    let words = file(
        "ASCII",
        "POINT_DATA 6\nSCALARS s int\nLOOKUP_TABLE default\n10 20 30 40 50 60\n",
    );
    let mut tried = 0;
    for bytes in [binary, words.into_bytes()] {
        folder.read("a.vtk", &bytes).unwrap();
        for length in 0..bytes.len() {
            folder.refused("a.vtk", &bytes[..length]);
            tried += 1;
        }
    }
    println!("{tried} cuts");
    assert!(tried > 300);
}
