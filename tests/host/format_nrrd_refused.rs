//! NRRD files that are wrong, and the errors that say so.
#![cfg(feature = "files")]

use crate::encode;
use crate::files;

use encode::{ascii, bytes_of, bzip2, gzip, hex};
use files::{Folder, message, numbers};
use stratavox::format;
use stratavox::volume::{Limits, VolumeSelection, VoxelType};

fn attached(header: &str, data: &[u8]) -> Vec<u8> {
    [b"NRRD0005\n", header.as_bytes(), b"\n", data].concat()
}

/// 3 x 2 x 1 bytes, raw, without space.
const SMALL: &str = "type: uchar\ndimension: 3\nsizes: 3 2 1\nencoding: raw\n";

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
    let error = format::open(&path, &VolumeSelection::default(), &few)
        .err()
        .unwrap()
        .to_string();
    assert!(error.contains("at most 2 files"), "{error}");
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
