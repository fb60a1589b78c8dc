//! VTK XML files that are wrong: cut, with fields that lie, with markup that grows, with blocks that are not what
//! their sizes say.
#![cfg(feature = "files")]

use crate::encode;
use crate::files;
use crate::vtk;

use encode::zlib;
use files::{Folder, message};
use stratavox::format;
use stratavox::volume::{Limits, Problem, VolumeSelection};

/// Six bytes in words.
const GOOD: &str = "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n\
  <ImageData WholeExtent=\"0 2 0 1 0 0\" Origin=\"1 2 3\" Spacing=\"1 1 1\" Direction=\"1 0 0 0 1 0 0 0 1\">\n\
  <Piece Extent=\"0 2 0 1 0 0\">\n<PointData Scalars=\"s\">\n\
  <DataArray type=\"UInt8\" Name=\"s\" NumberOfComponents=\"1\" format=\"ascii\">1 2 3 4 5 6</DataArray>\n\
  </PointData>\n</Piece>\n</ImageData>\n</VTKFile>\n";

#[test]
fn a_file_cut_anywhere_is_refused() {
    let folder = Folder::new();
    let mut tried = 0;
    for name in [
        "ascii-none-u32-le.vti",
        "binary-none-u32-le.vti",
        "binary-lz4-u64-be.vti",
        "appended-none-u32-be.vti",
        "appended-zlib-u32-le.vti",
        "appended64-zlib-u64-le.vti",
        "appended64-none-u32-le.vti",
        "several.vti",
        "pieces.vti",
    ] {
        let bytes = std::fs::read(vtk::folder("vti").join(name)).unwrap();
        folder.read(name, &bytes).unwrap();
        // The last byte is a line end that carries nothing.
        for length in 0..bytes.len() - 1 {
            folder.refused(name, &bytes[..length]);
            tried += 1;
        }
    }
    println!("{tried} cuts");
    assert!(tried > 5000, "{tried}");
}

#[test]
fn each_attribute_with_a_number_that_cannot_be_is_refused_or_read_whole() {
    let folder = Folder::new();
    let numbers = [
        "",
        "0",
        "1",
        "-1",
        "2",
        "nan",
        "inf",
        "-inf",
        "1e30",
        "1e308",
        "2147483647",
        "2147483648",
        "4294967295",
        "9223372036854775807",
        "18446744073709551616",
        "0.5",
        "x",
        "1 2",
        "&lt;",
        "&#0;",
    ];
    let base =
        std::fs::read_to_string(vtk::folder("vti").join("appended64-zlib-u32-le.vti")).unwrap();
    let mut tried = 0;
    for text in [GOOD.to_owned(), base] {
        let (_, whole) = folder.read("a.vti", &text).unwrap();
        let quotes: Vec<usize> = text.match_indices('"').map(|(at, _)| at).collect();
        for pair in quotes.chunks_exact(2) {
            let value = &text[pair[0] + 1..pair[1]];
            let words: Vec<&str> = value.split(' ').collect();
            for place in 0..words.len() {
                for number in numbers {
                    let mut words = words.clone();
                    words[place] = number;
                    let changed = text[..=pair[0]].to_owned() + &words.join(" ") + &text[pair[1]..];
                    if let Ok((header, read)) = folder.read("a.vti", &changed) {
                        assert!(header.world_from_voxel.is_finite(), "{changed}");
                        assert_eq!(read.voxels.len(), whole.voxels.len(), "{changed}");
                    }
                    tried += 1;
                }
            }
        }
    }
    println!("{tried} fields");
    assert!(tried > 1000, "{tried}");
}

#[test]
fn what_is_wrong_is_named() {
    let folder = Folder::new();
    folder.read("a.vti", GOOD).unwrap();
    for (from, to, word) in [
        ("\"ImageData\"", "\"PImageData\"", "PImageData"),
        ("\"ImageData\"", "\"RectilinearGrid\"", "RectilinearGrid"),
        (
            "\"ImageData\"",
            "\"UnstructuredGrid\"",
            "unstructured grids are not read; resample with vtkResampleToImage to .vti",
        ),
        ("UInt32\">", "UInt16\">", "header_type"),
        ("LittleEndian", "MiddleEndian", "byte_order"),
        (
            "UInt32\">",
            "UInt32\" compressor=\"vtkLZMADataCompressor\">",
            "LZMA",
        ),
        ("UInt32\">", "UInt32\" compressor=\"mine\">", "compressor"),
        ("WholeExtent=\"0 2 0 1 0 0\"", "", "WholeExtent"),
        ("WholeExtent=\"0 2", "WholeExtent=\"0 3", "Piece"),
        (
            "WholeExtent=\"0 2 0 1 0 0\"",
            "WholeExtent=\"0 -1 0 1 0 0\"",
            "WholeExtent",
        ),
        ("Piece Extent=\"0 2", "Piece Extent=\"0 3", "Piece Extent"),
        ("Spacing=\"1 1 1\"", "Spacing=\"1 0 1\"", "Spacing"),
        (
            "Direction=\"1 0 0 0 1 0",
            "Direction=\"1 0 0 1 0 0",
            "Spacing",
        ),
        ("Spacing=", "TimeValues=\"1 2\" Spacing=", "TimeValues"),
        ("\"UInt8\"", "\"Bit\"", "Bit"),
        ("\"UInt8\"", "\"Complex\"", "`Complex`"),
        (
            "NumberOfComponents=\"1\"",
            "NumberOfComponents=\"0\"",
            "NumberOfComponents",
        ),
        ("\"ascii\"", "\"appended\"", "AppendedData"),
        ("\"ascii\"", "\"words\"", "format"),
        (
            "1 2 3 4 5 6",
            "10 20 30 40 50",
            "promises 6 bytes of voxels, found 5",
        ),
        (
            "1 2 3 4 5 6",
            "1 2 3 4 5 6 7",
            "promises 6 bytes of voxels, found 7",
        ),
        ("1 2 3 4 5 6", "1 2 3 4 5 256", "`256` is no u8"),
        ("1 2 3 4 5 6", "1 2", "cannot hold"),
        ("1 2 3 4 5 6", "", "text inside DataArray"),
        ("1 2 3 4 5 6", "1 2 3 <!-- x --> 4 5 6", "two places"),
        ("1 2 3 4 5 6", "<![CDATA[1 2 3 4 5 6]]>", "CDATA"),
        ("</Piece>", "", "markup"),
        ("</VTKFile>", "</VTKFile", "cut"),
        (
            "<Piece",
            "<!DOCTYPE a [<!ENTITY b \"c\">]><Piece",
            "DOCTYPE",
        ),
        (
            "<VTKFile",
            "<!DOCTYPE a SYSTEM \"/etc/passwd\"><VTKFile",
            "DOCTYPE",
        ),
        ("Name=\"s\"", "Name=\"&b;\"", "DataArray"),
        ("Name=\"s\"", "Name=\"s\" Name=\"t\"", "DataArray"),
    ] {
        let changed = GOOD.replacen(from, to, 1);
        assert_ne!(changed, GOOD, "{from}");
        let error = folder.refused("a.vti", changed);
        assert!(error.contains(word), "{to}: {error}");
    }
    let lzma = format::open(
        &vtk::folder("vti").join("lzma.vti"),
        &VolumeSelection::default(),
        &Limits::default(),
    );
    let error = message(&lzma.err().expect("no reader of LZMA"));
    assert!(error.contains("LZMA"), "{error}");
}

#[test]
fn markup_that_nests_or_repeats_without_end_is_stopped() {
    let folder = Folder::new();
    let wrapped = |inside: String| format!("<VTKFile type=\"ImageData\">{inside}</VTKFile>");
    let attributes: String = (0..300).map(|n| format!(" a{n}=\"\"")).collect();
    for (inside, word) in [
        (
            "<a>".repeat(33) + &"</a>".repeat(33),
            "32 elements inside each other",
        ),
        ("<a>".repeat(200_000), "32 elements inside each other"),
        ("<a/>".repeat(100_000), "65536 elements"),
        (format!("<a{attributes}/>"), "256 attributes"),
        (
            format!("<a b=\"{}\"/>", "x".repeat(2 << 20)),
            "limit is 1048576",
        ),
        (format!("<{}", "x".repeat(2 << 20)), "limit is 1048576"),
        (
            format!("<!-- {} -->", "x".repeat(2 << 20)),
            "limit is 1048576",
        ),
    ] {
        let error = folder.refused("a.vti", wrapped(inside));
        assert!(error.contains(word), "{error}");
    }
    // Text does not count: the numbers of a large volume in words are no markup.
    let numbers = "1 ".repeat(1 << 20);
    let large = GOOD
        .replace("0 2 0 1 0 0", "0 1023 0 1023 0 0")
        .replace("1 2 3 4 5 6", &numbers);
    let (_, read) = folder.read("a.vti", large).unwrap();
    assert_eq!(read.voxels.len(), 1 << 20);
}

/// Six bytes appended raw, compressed, with these sizes before them.
fn blocks(compressor: &str, sizes: &[u32], data: &[u8]) -> Vec<u8> {
    let head = GOOD
        .replace(
            "UInt32\">",
            &format!("UInt32\" compressor=\"{compressor}\">"),
        )
        .replace("\"ascii\">1 2 3 4 5 6", "\"appended\" offset=\"0\">")
        .replace("</VTKFile>\n", "<AppendedData encoding=\"raw\">\n_");
    let sizes: Vec<u8> = sizes.iter().flat_map(|n| n.to_le_bytes()).collect();
    [
        head.as_bytes(),
        &sizes,
        data,
        b"</AppendedData>\n</VTKFile>\n",
    ]
    .concat()
}

#[test]
fn sizes_of_blocks_that_lie_are_refused_before_anything_is_made_for_them() {
    let folder = Folder::new();
    let whole = zlib(&[1, 2, 3, 4, 5, 6]);
    let (first, last) = (zlib(&[1, 2, 3, 4]), zlib(&[5, 6]));
    let size = |data: &[u8]| data.len() as u32;
    let zlib_name = "vtkZLibDataCompressor";
    let two = [first.as_slice(), &last].concat();
    let good = [2, 4, 2, size(&first), size(&last)];
    let (_, read) = folder
        .read("a.vti", blocks(zlib_name, &good, &two))
        .unwrap();
    assert_eq!(
        read.voxels,
        stratavox::volume::Voxels::U8(vec![1, 2, 3, 4, 5, 6])
    );
    // No last block of its own: all are alike.
    folder
        .read("a.vti", blocks(zlib_name, &[1, 6, 0, size(&whole)], &whole))
        .unwrap();
    let max = u32::MAX;
    let mut tried = 0;
    for sizes in [
        [0, 4, 2, size(&first), size(&last)],
        [1, 4, 2, size(&first), size(&last)],
        [3, 4, 2, size(&first), size(&last)],
        [max, 4, 2, size(&first), size(&last)],
        [2, 0, 6, size(&first), size(&last)],
        [2, 5, 1, size(&first), size(&last)],
        [2, 3, 3, size(&first), size(&last)],
        [2, 2, 4, size(&first), size(&last)],
        [2, max, 2, size(&first), size(&last)],
        [2, 4, max, size(&first), size(&last)],
        [2, 4, 2, 0, size(&last)],
        [2, 4, 2, size(&first) - 1, size(&last)],
        [2, 4, 2, size(&first) + 1, size(&last)],
        [2, 4, 2, max, size(&last)],
        [2, 4, 2, size(&first), max],
        [2, 4, 2, size(&first), size(&last) - 1],
        [2, 4, 2, size(&last), size(&first)],
    ] {
        let error = folder.refused("a.vti", blocks(zlib_name, &sizes, &two));
        assert!(error.contains("vti data"), "{sizes:?}: {error}");
        tried += 1;
    }
    // LZ4: six letters as they are, then the same with sizes or bytes that are wrong.
    let lz4 = lz4_flex::block::compress(&[1, 2, 3, 4, 5, 6]);
    let lz4_name = "vtkLZ4DataCompressor";
    let sizes = [1, 6, 0, size(&lz4)];
    folder
        .read("a.vti", blocks(lz4_name, &sizes, &lz4))
        .unwrap();
    for at in 0..lz4.len() {
        for value in [0, 1, 0x10, 0x7f, 0xf0, 0xff] {
            let mut changed = lz4.clone();
            changed[at] = value;
            let bytes = blocks(lz4_name, &sizes, &changed);
            // LZ4 blocks have no checksum: a letter may change, the count may not.
            if let Ok((_, read)) = folder.read("a.vti", bytes) {
                assert_eq!(read.voxels.len(), 6);
            }
            tried += 1;
        }
    }
    assert!(tried > 50, "{tried}");
}

#[test]
fn a_volume_that_the_bytes_cannot_hold_is_refused_when_the_file_is_opened() {
    let folder = Folder::new();
    let mut tried = 0;
    for name in [
        "ascii-none-u32-le.vti",
        "binary-none-u32-le.vti",
        "binary-zlib-u64-le.vti",
        "appended-none-u64-le.vti",
        "appended64-lz4-u32-le.vti",
    ] {
        let bytes = std::fs::read(vtk::folder("vti").join(name)).unwrap();
        for extent in [
            "0 65534 0 65534 0 65534",
            "0 2147483647 0 2147483647 0 2147483647",
            "0 999 0 999 0 999",
        ] {
            let from = b"\"2 6 -1 2 3 5\"";
            let mut changed = bytes.clone();
            while let Some(at) = changed
                .windows(from.len())
                .position(|window| window == from)
            {
                changed.splice(at..at + from.len(), format!("\"{extent}\"").bytes());
            }
            let path = folder.write(name, &changed);
            let error = format::open(&path, &VolumeSelection::default(), &Limits::default());
            let error = error.err().unwrap_or_else(|| panic!("{name} {extent}"));
            assert!(
                !matches!(error.problem, Problem::Io { .. }),
                "{}",
                message(&error)
            );
            tried += 1;
        }
    }
    assert_eq!(tried, 15);
}
