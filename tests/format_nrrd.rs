//! NRRD files, attached and detached, in every type and encoding.
#![cfg(feature = "files")]

#[path = "shared/encode.rs"]
mod encode;
#[path = "shared/files.rs"]
mod files;
#[path = "shared/truth.rs"]
mod truth;

use encode::{ascii, bytes_of, bzip2, extremes, gzip, hex};
use files::{Folder, message, numbers};
use glam::{DVec3, dvec3};
use stratavox::format;
use stratavox::volume::{Format, Header, Limits, Pick, VoxelBox, VoxelType};

/// Every name of every type, from the definition of the format.
const TYPES: [(VoxelType, &[&str]); 10] = [
    (VoxelType::I8, &["signed char", "int8", "int8_t"]),
    (
        VoxelType::U8,
        &["uchar", "unsigned char", "uint8", "uint8_t"],
    ),
    (
        VoxelType::I16,
        &[
            "short",
            "short int",
            "signed short",
            "signed short int",
            "int16",
            "int16_t",
        ],
    ),
    (
        VoxelType::U16,
        &[
            "ushort",
            "unsigned short",
            "unsigned short int",
            "uint16",
            "uint16_t",
        ],
    ),
    (VoxelType::I32, &["int", "signed int", "int32", "int32_t"]),
    (
        VoxelType::U32,
        &["uint", "unsigned int", "uint32", "uint32_t"],
    ),
    (
        VoxelType::I64,
        &[
            "longlong",
            "long long",
            "long long int",
            "signed long long",
            "signed long long int",
            "int64",
            "int64_t",
        ],
    ),
    (
        VoxelType::U64,
        &[
            "ulonglong",
            "unsigned long long",
            "unsigned long long int",
            "uint64",
            "uint64_t",
        ],
    ),
    (VoxelType::F32, &["float"]),
    (VoxelType::F64, &["double"]),
];

fn attached(header: &str, data: &[u8]) -> Vec<u8> {
    [b"NRRD0005\n", header.as_bytes(), b"\n", data].concat()
}

/// 3 x 2 x 1 bytes, raw, without space.
const SMALL: &str = "type: uchar\ndimension: 3\nsizes: 3 2 1\nencoding: raw\n";

#[test]
fn every_type_in_every_encoding_and_byte_order_gives_its_numbers() {
    let folder = Folder::new();
    let mut tried = 0;
    for (stored, names) in TYPES {
        let values = extremes(stored);
        for big in [false, true] {
            let bytes = bytes_of(&values, stored, big);
            for (encodings, data) in [
                (&["raw"][..], bytes.clone()),
                (&["gzip", "gz"], gzip(&bytes)),
                (&["bzip2", "bz2"], bzip2(&bytes)),
                (&["hex"], hex(&bytes)),
                (&["ascii", "text", "txt"], ascii(&values)),
            ] {
                for encoding in encodings {
                    for name in names {
                        let endian = if big { "big" } else { "little" };
                        let text = format!(
                            "type: {name}\ndimension: 3\nsizes: 3 2 1\nspacings: 1 2 3\nendian: {endian}\nencoding: {encoding}\n"
                        );
                        let (found, piece) = folder.read("a.nrrd", attached(&text, &data)).unwrap();
                        assert_eq!((found.format, found.stored), (Format::Nrrd, stored));
                        assert_eq!(found.dims, [3, 2, 1]);
                        let wanted: Vec<f32> = values.iter().map(|&n| n as f32).collect();
                        assert_eq!(numbers(&piece.voxels), wanted, "{text}");
                        let changed = values.iter().filter(|&&n| (n as f32) as i128 != n).count();
                        assert_eq!(piece.loss.changed, changed as u64, "{text}");
                        tried += 1;
                    }
                }
            }
        }
    }
    assert_eq!(
        tried,
        40 * 2 * 9,
        "names of types, byte orders, names of encodings"
    );
}

#[test]
fn a_float_that_is_no_number_stays_none() {
    let folder = Folder::new();
    let values = [
        f32::NAN,
        f32::INFINITY,
        -0.0,
        f32::MIN_POSITIVE / 2.0,
        1.5,
        f32::MAX,
    ];
    let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
    let text = "type: float\ndimension: 3\nsizes: 3 2 1\nendian: little\nencoding: ";
    for (encoding, data) in [
        ("raw\n", bytes),
        (
            "ascii\n",
            b"nan inf -0 5.877471754111438e-39 1.5 3.4028235e38\n".to_vec(),
        ),
    ] {
        let (_, piece) = folder
            .read("a.nrrd", attached(&(text.to_owned() + encoding), &data))
            .unwrap();
        let bits: Vec<u32> = numbers(&piece.voxels).iter().map(|x| x.to_bits()).collect();
        assert_eq!(bits, values.map(f32::to_bits), "{encoding}");
    }
}

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
            let source = format::open(&path, &Limits::default())
                .unwrap_or_else(|e| panic!("{text}: {}", message(&e)));
            let header = source.header();
            let shape = (header.dims, header.times, header.components);
            assert_eq!(shape, ([4, 3, 2], 3, 2), "{text}");
            let pick = Pick {
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
                Pick {
                    time: 3,
                    component: 0,
                },
                Pick {
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

#[test]
fn voxels_may_lie_in_other_files_one_or_many_behind_lines_and_bytes() {
    let folder = Folder::new();
    let slices: Vec<Vec<u8>> = (0..4).map(|k| (10 * k..10 * k + 6).collect()).collect();
    let all = slices.concat();
    folder.write("all.raw", &all);
    folder.write("junk.raw", [b"one\ntwo\r\nxyz", &all[..]].concat());
    folder.write("tail.raw", [b"any length", &all[..], b"tail"].concat());
    folder.write(
        "junk.gz",
        [b"a line\n", &gzip(&[b"xyz", &all[..]].concat())[..]].concat(),
    );
    folder.write("junk.bz2", bzip2(&[b"xyz", &all[..]].concat()));
    folder.write("all.hex", [b"xyz", &hex(&all)[..]].concat());
    for (k, slice) in slices.iter().enumerate() {
        folder.write(&format!("s.{}", 8 + k), slice);
        folder.write(&format!("s{:03}.gz", 9 - 3 * k), gzip(slice));
    }
    folder.write("low half", slices[..2].concat());
    folder.write("high half", slices[2..].concat());
    let wanted: Vec<f32> = all.iter().map(|&n| n.into()).collect();
    let text = "type: uchar\ndimension: 3\nsizes: 3 2 4\nencoding: ";
    for rest in [
        "raw\ndata file: all.raw\n",
        "raw\ndatafile: ./all.raw\n\nbytes that nobody reads",
        "raw\ndata file: all.raw",
        "raw\nline skip: 2\nbyte skip: 3\ndata file: junk.raw\n",
        "raw\nlineskip: 1\nbyteskip: -5\ndata file: tail.raw\n",
        "gzip\nline skip: 1\nbyte skip: 3\ndata file: junk.gz\n",
        "bzip2\nbyte skip: 3\ndata file: junk.bz2\n",
        "hex\nbyte skip: 3\ndata file: all.hex\n",
        "raw\ndata file: s.%d 8 11 1\n",
        "raw\ndata file: s.%d 8 11 1 2\n",
        "gz\ndata file: s%03d.gz 9 0 -3\n",
        "raw\ndata file: LIST\ns.8\ns.9\ns.10\ns.11\n",
        "raw\ndata file: LIST 2\ns.8\r\ns.9\ns.10\ns.11\n\nand more",
        "raw\ndata file: LIST 3\nlow half\nhigh half\n",
        "raw\ndata file: LIST 3\nall.raw\n",
    ] {
        let header = format!("NRRD0004\n{text}{rest}");
        let (found, piece) = folder
            .read("a.nhdr", &header)
            .unwrap_or_else(|e| panic!("{rest}: {}", message(&e)));
        assert_eq!(found.dims, [3, 2, 4]);
        assert_eq!(numbers(&piece.voxels), wanted, "{rest}");
    }
    let attached_last = attached(
        &(SMALL.to_owned() + "byte skip: -1\n"),
        &[1, 2, 3, 4, 5, 6, 7, 8],
    );
    let (_, piece) = folder.read("a.nrrd", attached_last).unwrap();
    assert_eq!(numbers(&piece.voxels), [3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);

    // A box that lies in the last files opens those only.
    let text = format!("NRRD0004\n{text}raw\ndata file: s.%d 8 11 1\n");
    let source = format::open(&folder.write("a.nhdr", text), &Limits::default()).unwrap();
    std::fs::remove_file(folder.path("s.8")).unwrap();
    let region = VoxelBox {
        min: [1, 0, 1],
        max: [3, 2, 4],
    };
    let found = numbers(&source.read(Pick::default(), region).unwrap().voxels);
    let wanted = [11, 12, 14, 15, 21, 22, 24, 25, 31, 32, 34, 35].map(|n| n as f32);
    assert_eq!(found, wanted);
}

#[test]
fn files_that_do_not_fit_the_array_are_refused() {
    let folder = Folder::new();
    for name in ["s1", "s2", "s3"] {
        folder.write(name, [0; 6]);
    }
    let text = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 3\nencoding: raw\n";
    for (rest, part) in [
        ("data file: LIST\ns1\ns2\n", "wanted 3 files, found `2`"),
        (
            "data file: LIST\ns1\ns2\ns3\ns1\n",
            "wanted 3 files, found `4`",
        ),
        ("data file: LIST\ns1\ns2\nabsent\n", "absent"),
        ("data file: LIST\ns1\ns2\ns3", "line end"),
        ("data file: LIST 9\ns1\n", "pieces"),
        ("data file: LIST 3\ns1\ns2\n", "divides 3"),
        ("data file: SKIPLIST\n1 s1\n1 s2\n1 s3\n", "SKIPLIST"),
        ("data file: s%d 1 2 1\n", "wanted 3 files, found `2`"),
        ("data file: s%d 1 3 0\n", "template"),
        ("data file: s%d 1 3\n", "template"),
        ("data file: s%d 2 4 1\n", "s4"),
        ("data file: s%d 1 3 1 7\n", "pieces"),
        (
            "data file: s%d 1 9000000000000000000 1\n",
            "found `9000000000000000000`",
        ),
        ("data file: absent.raw\n", "absent.raw"),
        ("data file:\n", "data file"),
        ("data file: s1\n", "promises 18 bytes of voxels, found 6"),
        ("byte skip: 99\ndata file: s%d 1 3 1\n", "s1: nrrd data"),
        ("line skip: 1\ndata file: s%d 1 3 1\n", "line skip"),
        ("line skip: -1\ndata file: s%d 1 3 1\n", "line skip"),
        ("byte skip: 1.5\ndata file: s%d 1 3 1\n", "byte skip"),
        (
            "byte skip: -9\ndata file: s%d 1 3 1\n",
            "promises 14 bytes of voxels, found 6",
        ),
    ] {
        let error = folder.refused("a.nhdr", format!("{text}{rest}"));
        assert!(error.contains(part), "{rest:?}: {error}");
    }
    let text = text.replace("encoding: raw", "encoding: gzip");
    let error = folder.refused(
        "a.nhdr",
        format!("{text}byte skip: -1\ndata file: s%d 1 3 1\n"),
    );
    assert!(error.contains("byte skip"), "{error}");
    // The voxels stand last in the file, but a header is no voxels.
    let cut = attached(&(SMALL.to_owned() + "byte skip: -1\n"), &[1, 2, 3, 4, 5]);
    let error = folder.refused("a.nrrd", cut);
    assert!(
        error.contains("promises 6 bytes of voxels, found 5"),
        "{error}"
    );
    let few = Limits {
        max_files: 2,
        ..Limits::default()
    };
    let path = folder.write("a.nhdr", format!("{text}data file: s%d 1 3 1\n"));
    let error = format::open(&path, &few).err().unwrap().to_string();
    assert!(error.contains("at most 2 files"), "{error}");
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

#[test]
fn a_file_cut_anywhere_is_refused_and_the_error_says_where() {
    let folder = Folder::new();
    let values: Vec<i128> = (0..24).map(|k| k * 1000 - 9000).collect();
    let bytes = bytes_of(&values, VoxelType::I16, true);
    let text = "type: short\ndimension: 3\nsizes: 3 2 4\nspacings: 1 1 1.25\nendian: big\n";
    let mut cuts = 0;
    for (encoding, data) in [
        ("raw", bytes.clone()),
        ("gzip", gzip(&bytes)),
        ("bzip2", bzip2(&bytes)),
        ("ascii", ascii(&values)),
        ("hex", hex(&bytes)),
    ] {
        let file = attached(&format!("{text}encoding: {encoding}\n"), &data);
        folder.read("a.nrrd", &file).unwrap();
        // The line end behind the last hexadecimal digit carries nothing.
        let whole = file.len() - usize::from(encoding == "hex");
        for cut in 0..whole {
            let error = folder.refused("a.nrrd", &file[..cut]);
            assert!(
                cut == 0 || error.contains("nrrd"),
                "{encoding} cut at {cut}: {error}"
            );
            if cut + data.len() > file.len() {
                let says = ["promises", "damaged"]
                    .iter()
                    .any(|word| error.contains(word));
                assert!(says, "{encoding} cut at {cut}: {error}");
            }
            cuts += 1;
        }
    }
    assert!(cuts > 700, "only {cuts} cuts");
    folder.write("a.raw", &bytes);
    for (k, slice) in bytes.chunks(12).enumerate() {
        folder.write(&format!("s{}", k + 9), slice);
        folder.write(&format!("s{}", k), slice);
        folder.write("s", slice);
    }
    for data_file in ["a.raw\n", "s%d 9 12 1\n", "LIST\ns9\ns10\ns11\ns12\n"] {
        let file = format!("NRRD0004\n{text}encoding: raw\ndata file: {data_file}");
        folder.read("a.nhdr", &file).unwrap();
        for cut in 0..file.len() - 1 {
            let error = folder.refused("a.nhdr", &file[..cut]);
            assert!(
                cut == 0 || error.contains("nrrd"),
                "{data_file} cut at {cut}: {error}"
            );
        }
        let cut = folder.read("a.nhdr", &file[..file.len() - 1]);
        assert_eq!(cut.is_ok(), !data_file.starts_with("LIST"), "{data_file}");
    }
}

#[test]
fn a_field_that_says_what_cannot_be_is_refused_by_name() {
    let folder = Folder::new();
    let base = [
        ("type", "uchar"),
        ("dimension", "3"),
        ("sizes", "3 2 1"),
        ("encoding", "raw"),
        ("endian", "little"),
        ("byte skip", "0"),
        ("line skip", "0"),
        ("kinds", "domain domain domain"),
        ("space", "LPS"),
        ("space directions", "(1,0,0) (0,1,0) (0,0,1)"),
        ("space origin", "(0,0,0)"),
        ("spacings", "1 1 1"),
        ("axis mins", "0 0 0"),
        ("data file", "a.raw"),
    ];
    folder.write("a.raw", [7; 6]);
    let hostile = [
        "",
        "0",
        "-1",
        "-2",
        "2",
        "17",
        "nan",
        "inf",
        "-inf",
        "2147483648",
        "4294967295",
        "4294967296",
        "9223372036854775807",
        "18446744073709551615",
        "18446744073709551616",
        "1e308",
        "1e-308",
        "x",
        "(",
        "()",
        "(1,0,0)",
        "(1,0)",
        "(nan,0,0)",
        "(inf,0,0) (0,1,0) (0,0,1)",
        "(1,0,0) (1,0,0) (0,0,1)",
        "none none none",
        "nan nan nan",
        "\u{1b}[2J\u{202e}",
    ];
    let (mut refused, mut read) = (0, 0);
    for (name, good) in base {
        let count = good.split(' ').count();
        for value in hostile {
            for value in [value.to_owned(), vec![value; count].join(" ")] {
                let lines = base.iter().map(|(field, good)| {
                    let value = if *field == name { value.as_str() } else { good };
                    format!("{field}: {value}\n")
                });
                let text: String = lines.collect();
                match folder.read("a.nhdr", format!("NRRD0005\n{text}")) {
                    Err(error) => {
                        let error = message(&error);
                        // `space directions` of another length may be told by the number of `none`.
                        let words = [
                            name,
                            "space axes",
                            "sizes",
                            "promises",
                            "space directions",
                            "needs",
                        ];
                        let named = words.iter().any(|word| error.contains(word));
                        assert!(named, "{name}: {value:?}: {error}");
                        assert!(
                            error.chars().all(|c| matches!(c, ' '..='~')),
                            "{name}: {error:?}"
                        );
                        refused += 1;
                    }
                    Ok((header, piece)) => {
                        assert_eq!(
                            numbers(&piece.voxels),
                            [7.0; 6],
                            "{name}: {value}: {header:?}"
                        );
                        assert!(
                            header.world_from_voxel.inverse().is_finite(),
                            "{name}: {value}"
                        );
                        read += 1;
                    }
                }
            }
        }
    }
    println!("{refused} refused, {read} read");
    assert!(refused > 500, "only {refused} refused");
    for required in ["type", "dimension", "sizes", "encoding"] {
        let lines = SMALL
            .lines()
            .filter(|line| !line.starts_with(&format!("{required}:")));
        let text: String = lines.map(|line| format!("{line}\n")).collect();
        let error = folder.refused("a.nrrd", attached(&text, &[0; 6]));
        assert!(error.contains(&format!("has no `{required}`")), "{error}");
    }
    let wide = SMALL.replace("uchar", "short");
    let error = folder.refused("a.nrrd", attached(&wide, &[0; 12]));
    assert!(error.contains("has no `endian`"), "{error}");
    for (extra, part) in [
        ("type: uchar\n", "`type`: wanted at most one line"),
        ("no colon here\n", "header line"),
        (
            "space directions: (1,0,0) (0,1,0) (0,0,1)\n",
            "`space` or `space dimension`",
        ),
        ("space: LPS\nspace dimension: 3\n", "not both"),
        (
            "space: LPS\nspace directions: (1,0,0) (0,1,0)\n",
            "3 vectors",
        ),
    ] {
        let error = folder.refused("a.nrrd", attached(&format!("{SMALL}{extra}"), &[0; 6]));
        assert!(error.contains(part), "{extra}: {error}");
    }
    for (from, to, part) in [
        ("uchar", "block", "type `block` is not supported"),
        ("uchar", "char", "`type`"),
        ("uchar", "half", "`type`"),
        ("raw", "zrl", "encoding `zrl` is not supported"),
    ] {
        let error = folder.refused("a.nrrd", attached(&SMALL.replace(from, to), &[0; 6]));
        assert!(error.contains(part), "{to}: {error}");
    }
}

#[test]
fn the_real_nrrds_are_what_their_manifest_says() {
    let entries = truth::entries("nrrd");
    for entry in &entries {
        let id = entry["id"].as_str().unwrap();
        let found = truth::check(entry, None);
        let volume = &entry["volume"];
        let list = |value: &serde_json::Value| -> Vec<f64> {
            value
                .as_array()
                .unwrap()
                .iter()
                .map(|x| x.as_f64().unwrap())
                .collect()
        };
        let wanted = if volume["space_directions"].is_array() {
            assert_eq!(volume["space"], "left-posterior-superior", "{id}");
            let columns: Vec<Vec<f64>> = volume["space_directions"]
                .as_array()
                .unwrap()
                .iter()
                .map(list)
                .collect();
            let origin = list(&volume["space_origin"]);
            std::array::from_fn(|row| {
                let sign = if row < 2 { -1.0 } else { 1.0 };
                [
                    columns[0][row],
                    columns[1][row],
                    columns[2][row],
                    origin[row],
                ]
                .map(|x| sign * x)
            })
        } else {
            let spacing = list(&volume["spacing"]);
            let left_handed = volume["space"] == "3D-left-handed";
            std::array::from_fn(|row| {
                let mut columns = [0.0; 4];
                columns[row] = if left_handed && row == 2 {
                    -spacing[row]
                } else {
                    spacing[row]
                };
                columns
            })
        };
        // The manifest has six digits behind the point.
        truth::same_affine(id, found, wanted, 1e-6);
    }
    if truth::folder().is_some() {
        assert_eq!(entries.len(), 8, "files compared");
    }
}
