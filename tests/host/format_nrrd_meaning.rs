//! What the header of a NRRD says about its voxels: which axis is what, where they lie, in which units.
#![cfg(feature = "files")]

use crate::encode;
use crate::files;

use encode::{ascii, bytes_of, bzip2, gzip, hex};
use files::{Folder, message, numbers};
use glam::{DVec3, dvec3};
use stratavox::format;
use stratavox::volume::{Header, Limits, TimeComponent, VolumeSelection, VoxelBox, VoxelType};

fn attached(header: &str, data: &[u8]) -> Vec<u8> {
    [b"NRRD0005\n", header.as_bytes(), b"\n", data].concat()
}

/// 3 x 2 x 1 bytes, raw, without space.
const SMALL: &str = "type: uchar\ndimension: 3\nsizes: 3 2 1\nencoding: raw\n";

/// Numbers that say where they stand: time, z, y, x, component from the left; axes in the order of `roles`.
fn labelled(roles: &str) -> (Vec<i128>, String) {
    let size = |role| match role {
        'c' => 2,
        'x' => 4,
        'y' | 't' => 3,
        _ => 2,
    };
    let mut values = vec![0_i128];
    for role in roles.chars() {
        let weight = 10_i128.pow("cxyzt".find(role).unwrap() as u32);
        let place = |k: i128| {
            values
                .iter()
                .map(move |value| value + k * weight)
                .collect::<Vec<_>>()
        };
        values = (0..size(role)).flat_map(place).collect();
    }
    let sizes: Vec<String> = roles.chars().map(|role| size(role).to_string()).collect();
    (values, sizes.join(" "))
}

#[test]
fn one_time_one_component_and_one_box_can_be_picked_wherever_the_axes_stand() {
    let folder = Folder::new();
    for (roles, kinds) in [
        ("cxyzt", "kinds: vector domain domain domain time\n"),
        ("xyzct", "kinds: space space space complex time\n"),
        ("tcxyz", "kinds: time 2-vector domain domain domain\n"),
        ("cxyzt", "kinds: list domain domain domain list\n"),
        (
            "cxyzt",
            "spacings: nan 1 1 1 nan\nkinds: vector ??? ??? ??? ???\n",
        ),
        (
            "cxyzt",
            "space: right-anterior-superior\nspace directions: none (1,0,0) (0,1,0) (0,0,1) none\n",
        ),
        (
            "cxyzt",
            "space: RAST\nspace directions: none (1,0,0,0) (0,1,0,0) (0,0,1,0) (0,0,0,9)\n",
        ),
        ("xcytz", "kinds: domain vector domain time domain\n"),
    ] {
        let (values, sizes) = labelled(roles);
        let bytes = bytes_of(&values, VoxelType::U16, true);
        for (encoding, data) in [
            ("raw", bytes.clone()),
            ("gzip", gzip(&bytes)),
            ("bzip2", bzip2(&bytes)),
            ("ascii", ascii(&values)),
            ("hex", hex(&bytes)),
        ] {
            let text = format!(
                "type: ushort\ndimension: 5\nsizes: {sizes}\nendian: big\nencoding: {encoding}\n{kinds}"
            );
            let path = folder.write("a.nrrd", attached(&text, &data));
            let source = format::open(&path, &VolumeSelection::default(), &Limits::default())
                .unwrap_or_else(|e| panic!("{text}: {}", message(&e)));
            let header = source.header();
            let shape = (header.dims, header.times, header.components);
            assert_eq!(shape, ([4, 3, 2], 3, 2), "{text}");
            let pick = TimeComponent {
                time: 2,
                component: 1,
            };
            let region = VoxelBox {
                min: [1, 1, 0],
                max: [3, 3, 2],
            };
            let found = numbers(&source.read(pick, region).unwrap().voxels);
            let wanted = [20111, 20121, 20211, 20221, 21111, 21121, 21211, 21221];
            assert_eq!(found, wanted.map(|n| n as f32), "{text}");
            let whole = numbers(&source.read(pick, header.whole()).unwrap().voxels);
            assert_eq!(
                (whole.len(), whole[0], whole[23]),
                (24, 20001.0, 21231.0),
                "{text}"
            );
            for wrong in [
                TimeComponent {
                    time: 3,
                    component: 0,
                },
                TimeComponent {
                    time: 0,
                    component: 2,
                },
            ] {
                assert!(source.read(wrong, region).is_err(), "{wrong:?}");
            }
            let beyond = VoxelBox {
                min: [0; 3],
                max: [4, 3, 3],
            };
            assert!(source.read(pick, beyond).is_err());
            let empty = VoxelBox {
                min: [1; 3],
                max: [1; 3],
            };
            assert!(source.read(pick, empty).is_err());
        }
    }
}

#[test]
fn axes_of_which_nothing_is_said_are_guessed_and_the_guess_is_noted() {
    let folder = Folder::new();
    for (sizes, dims, times, components) in [
        ("5", [5, 1, 1], 1, 1),
        ("5 6", [5, 6, 1], 1, 1),
        ("3 6 7", [3, 6, 7], 1, 1),
        ("5 6 7 8", [5, 6, 7], 8, 1),
        ("3 6 7 8", [6, 7, 8], 1, 3),
        ("3 6 7 8 9", [6, 7, 8], 9, 3),
    ] {
        let axes = sizes.split(' ').count();
        let count: usize = sizes
            .split(' ')
            .map(|n| n.parse::<usize>().unwrap())
            .product();
        let text = format!("type: uchar\ndimension: {axes}\nsizes: {sizes}\nencoding: raw\n");
        let (header, _) = folder
            .read("a.nrrd", attached(&text, &vec![0; count]))
            .unwrap();
        assert_eq!(
            (header.dims, header.times, header.components),
            (dims, times, components),
            "{sizes}"
        );
        let noted = header
            .notes
            .iter()
            .any(|note| note.contains("does not say"));
        assert_eq!(noted, axes > 3, "{:?}", header.notes);
    }
    let text = "type: uchar\ndimension: 4\nsizes: 5 2 2 2\nencoding: raw\nkinds: list domain domain domain\n";
    let components = |text: &str| {
        let (header, _) = folder.read("a.nrrd", attached(text, &[0; 40])).unwrap();
        (header.times, header.components)
    };
    assert_eq!(components(text), (1, 5));
    let sequence = format!("{text}axis 0 index type:=numeric\n");
    assert_eq!(components(&sequence), (5, 1), "a sequence of images");
}

/// Where the centre of a voxel lies.
fn center(header: &Header, index: [f64; 3]) -> DVec3 {
    header
        .world_from_voxel
        .transform_point3(DVec3::from_array(index) + 0.5)
}

#[test]
fn every_space_ends_in_ras_and_what_is_not_anatomical_is_noted() {
    let folder = Folder::new();
    let placed = "space directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (10,20,30)\n";
    for (names, signs, note) in [
        (
            &["right-anterior-superior", "RAS", "right anterior superior"][..],
            [1.0, 1.0, 1.0],
            None,
        ),
        (&["left-anterior-superior", "LAS"], [-1.0, 1.0, 1.0], None),
        (
            &["left-posterior-superior", "LPS", "Left-Posterior-Superior"],
            [-1.0, -1.0, 1.0],
            None,
        ),
        (
            &["scanner-xyz", "3D-right-handed"],
            [1.0, 1.0, 1.0],
            Some("as they stand"),
        ),
        (&["3D-left-handed"], [1.0, 1.0, -1.0], Some("turned round")),
    ] {
        for name in names {
            let text = format!("{SMALL}space: {name}\n{placed}");
            let (header, _) = folder.read("a.nrrd", attached(&text, &[0; 6])).unwrap();
            let signs = DVec3::from_array(signs);
            assert_eq!(
                center(&header, [0.0; 3]),
                signs * dvec3(10.0, 20.0, 30.0),
                "{name}"
            );
            assert_eq!(
                center(&header, [2.0, 1.0, 1.0]),
                signs * dvec3(14.0, 23.0, 34.0),
                "{name}"
            );
            match note {
                Some(note) => assert!(
                    header.notes.iter().any(|n| n.contains(note)),
                    "{:?}",
                    header.notes
                ),
                None => assert_eq!(header.notes, [""; 0], "{name}"),
            }
        }
    }
    let text = format!("{SMALL}space dimension: 3\n{placed}space units: \"um\" \"um\" \"um\"\n");
    let (header, _) = folder.read("a.nrrd", attached(&text, &[0; 6])).unwrap();
    assert_eq!(center(&header, [0.0; 3]), dvec3(10.0, 20.0, 30.0));
    let notes = header.notes.join("; ");
    assert!(
        notes.contains("RAS+ as they stand") && notes.contains("um"),
        "{notes}"
    );
}

#[test]
fn oblique_directions_become_columns_of_the_affine() {
    let folder = Folder::new();
    let text = format!(
        "{SMALL}space: LPS\nspace directions: (0.6, 0.8, 0) (-0.8,0.6,0)\t(0.25,0,2)\nspace origin: ( 1,-2 , 3)\n"
    );
    let (header, _) = folder.read("a.nrrd", attached(&text, &[0; 6])).unwrap();
    let columns = header.world_from_voxel.matrix3;
    assert_eq!(columns.x_axis, dvec3(-0.6, -0.8, 0.0));
    assert_eq!(columns.y_axis, dvec3(0.8, -0.6, 0.0));
    assert_eq!(columns.z_axis, dvec3(-0.25, 0.0, 2.0));
    let error = (center(&header, [0.0; 3]) - dvec3(-1.0, 2.0, 3.0)).length();
    assert!(error < 1e-15, "{error}");
}

#[test]
fn without_a_space_spacings_and_axis_mins_place_the_volume_and_that_is_noted() {
    let folder = Folder::new();
    for (fields, first, step) in [
        ("", [0.0; 3], [1.0; 3]),
        ("spacings: 2 3 4\n", [0.0; 3], [2.0, 3.0, 4.0]),
        // Cell-centred: the minimum is the edge of the first cell, half a step before its centre.
        (
            "spacings: 2 3 4\naxis mins: 10 0 0\n",
            [11.0, 1.5, 2.0],
            [2.0, 3.0, 4.0],
        ),
        (
            "axis mins: 0 0 0\naxismaxs: 6 2 5\n",
            [1.0, 0.5, 2.5],
            [2.0, 1.0, 5.0],
        ),
        (
            "axis mins: 1 1 1\naxis maxs: 7 5 9\ncenterings: node node cell\n",
            [1.0, 1.0, 5.0],
            [3.0, 4.0, 8.0],
        ),
        ("spacings: nan nan nan\n", [0.0; 3], [1.0; 3]),
    ] {
        let (header, _) = folder
            .read("a.nrrd", attached(&format!("{SMALL}{fields}"), &[0; 6]))
            .unwrap();
        assert_eq!(
            center(&header, [0.0; 3]),
            DVec3::from_array(first),
            "{fields}"
        );
        let moved = center(&header, [1.0; 3]) - center(&header, [0.0; 3]);
        assert_eq!(moved, DVec3::from_array(step), "{fields}");
        let notes = header.notes.join("; ");
        assert!(notes.contains("RAS+ as they stand"), "{notes}");
        let assumed = fields.is_empty() || fields.contains("nan");
        assert_eq!(notes.contains("1 is taken"), assumed, "{fields}: {notes}");
    }
}

#[test]
fn values_are_hounsfield_units_only_where_the_file_says_so() {
    let folder = Folder::new();
    for (fields, wanted) in [
        ("", false),
        ("sample units: HU\n", true),
        ("sample units: mm\n", false),
        ("modality:=CT\n", true),
        ("modality:=MR\n", false),
        ("DICOM_0008_0060_Modality:=CT\n", true),
    ] {
        let text = format!(
            "type: short\ndimension: 3\nsizes: 3 1 1\nencoding: raw\nendian: little\n{fields}"
        );
        let (header, _) = folder.read("a.nrrd", attached(&text, &[0; 6])).unwrap();
        assert_eq!(header.hounsfield, wanted, "{fields}");
    }
    let (header, _) = folder
        .read(
            "a.nrrd",
            attached(&format!("{SMALL}modality:=CT\n"), &[0; 6]),
        )
        .unwrap();
    assert!(!header.hounsfield, "eight bits");
}

#[test]
fn what_the_format_allows_beside_is_taken_or_noted() {
    let folder = Folder::new();
    let text = format!(
        "# a comment: with a colon\n{SMALL}content: a: b := c\nlabels: \"x\" \"y z\" \"\"\nunits: \"mm\" \"mm\" \"mm\"\n\
         thicknesses: nan nan 2\nnumber: 6\nmin: 0\nmax: 9\nold min: -5\nold max: 5\nblock size: 1\n\
         type:=not the field\nmy key:=a: value\nmystery: ?\nriddle: ?\n"
    );
    let (header, _) = folder.read("a.nrrd", attached(&text, &[0; 6])).unwrap();
    let notes = header.notes.join("; ");
    assert!(
        notes.contains("2 header lines") && notes.contains("mystery"),
        "{notes}"
    );
    assert!(notes.contains("quantized from -5 to 5"), "{notes}");
    let windows = attached(&text, &[0; 6]);
    let windows = String::from_utf8(windows).unwrap().replace('\n', "\r\n");
    folder
        .read("a.nrrd", windows)
        .expect("line ends of Windows");
    let (header, _) = folder.read("a.nrrd", attached(SMALL, &[0; 9])).unwrap();
    assert!(
        header
            .notes
            .join("; ")
            .contains("3 bytes behind the voxels"),
        "{:?}",
        header.notes
    );
    for magic in ["NRRD00.01", "NRRD0001", "NRRD0006"] {
        let file = [magic.as_bytes(), b"\n", SMALL.as_bytes(), b"\n", &[0; 6]].concat();
        folder.read("a.nrrd", file).expect(magic);
    }
}
