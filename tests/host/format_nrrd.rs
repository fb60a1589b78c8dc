//! NRRD files, attached and detached, in every type and encoding, and the real ones.
#![cfg(feature = "files")]

use crate::encode;
use crate::files;
use crate::truth;

use encode::{ascii, bytes_of, bzip2, extremes, gzip, hex};
use files::{Folder, message, numbers};
use stratavox::format;
use stratavox::volume::{Format, Limits, TimeComponent, VolumeSelection, VoxelBox, VoxelType};

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
    let source = format::open(
        &folder.write("a.nhdr", text),
        &VolumeSelection::default(),
        &Limits::default(),
    )
    .unwrap();
    std::fs::remove_file(folder.path("s.8")).unwrap();
    let region = VoxelBox {
        min: [1, 0, 1],
        max: [3, 2, 4],
    };
    let found = numbers(
        &source
            .read(TimeComponent::default(), region)
            .unwrap()
            .voxels,
    );
    let wanted = [11, 12, 14, 15, 21, 22, 24, 25, 31, 32, 34, 35].map(|n| n as f32);
    assert_eq!(found, wanted);
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
