//! MetaImage files that are wrong, and the errors that say so.
#![cfg(feature = "files")]

use crate::encode;
use crate::files;

use encode::{ascii, bytes_of, extremes, zlib};
use files::{Folder, message, numbers};
use stratavox::volume::VoxelType;

/// A header of 3 x 2 x 1 voxels without its last line.
fn header(element_type: &str) -> String {
    format!(
        "ObjectType = Image\nNDims = 3\nDimSize = 3 2 1\nElementSpacing = 1 2 3\nElementType = {element_type}\n"
    )
}

fn attached(header: &str, data: &[u8]) -> Vec<u8> {
    [header.as_bytes(), b"ElementDataFile = LOCAL\n", data].concat()
}

#[test]
fn a_list_or_a_row_of_files_that_is_short_is_refused() {
    let folder = Folder::new();
    for name in ["s1", "s2", "s3"] {
        folder.write(name, [0; 6]);
    }
    let text = "NDims = 3\nDimSize = 3 2 3\nElementType = MET_UCHAR\nElementDataFile = ";
    for (data_file, part) in [
        ("LIST\ns1\ns2\n", "found `2`"),
        ("LIST\ns1\ns2\ns3\ns3\n", "found `4`"),
        ("LIST\ns1\ns2\nabsent\n", "absent"),
        ("LIST\ns1\ns2\ns3", "line end"),
        ("LIST 9\ns1\n", "LIST"),
        ("s%d 1 2 1\n", "found `2`"),
        ("s%d 1 3 0\n", "template"),
        ("s%d 2 4 1\n", "s4"),
        ("s%s 1 3 1\n", "template"),
        ("absent.raw\n", "absent.raw"),
        ("\n", "ElementDataFile"),
    ] {
        let error = folder.refused("a.mhd", format!("{text}{data_file}"));
        assert!(error.contains(part), "{data_file:?}: {error}");
    }
    folder.write("s3", [0; 5]);
    let error = folder.refused("a.mhd", format!("{text}LIST\ns1\ns2\ns3\n"));
    assert!(
        error.contains("s3: metaimage data: the header promises 6 bytes of voxels, found 5"),
        "{error}"
    );
}

#[test]
fn a_file_cut_anywhere_is_refused_and_the_error_says_where() {
    let folder = Folder::new();
    let values = extremes(VoxelType::I16);
    let bytes = bytes_of(&values, VoxelType::I16, false);
    let order = "BinaryDataByteOrderMSB = False\n";
    let text = header("MET_SHORT") + order;
    let compressed = zlib(&bytes);
    let sized = format!(
        "CompressedData = True\nCompressedDataSize = {}\n",
        compressed.len()
    );
    let mut cuts = 0;
    for file in [
        attached(&text, &bytes),
        attached(&(text.clone() + "CompressedData = True\n"), &compressed),
        attached(&(text.clone() + &sized), &compressed),
        attached(&(text.clone() + "BinaryData = False\n"), &ascii(&values)),
    ] {
        folder.read("a.mha", &file).unwrap();
        for cut in 0..file.len() {
            let error = folder.refused("a.mha", &file[..cut]);
            assert!(
                cut == 0 || error.contains("metaimage"),
                "cut at {cut}: {error}"
            );
            cuts += 1;
        }
    }
    assert!(cuts > 500, "only {cuts} cuts");
    folder.write("a.raw", bytes);
    let file = text + "ElementDataFile = a.raw\n";
    for cut in 0..file.len() - 1 {
        folder.refused("a.mhd", &file[..cut]);
    }
    folder
        .read("a.mhd", &file[..file.len() - 1])
        .expect("a name without line end");
}

#[test]
fn a_field_that_says_what_cannot_be_is_refused_by_name() {
    let folder = Folder::new();
    let base = [
        ("NDims", "3"),
        ("DimSize", "3 2 1"),
        ("ElementSpacing", "1 1 1"),
        ("Offset", "0 0 0"),
        ("TransformMatrix", "1 0 0 0 1 0 0 0 1"),
        ("BinaryData", "True"),
        ("BinaryDataByteOrderMSB", "False"),
        ("HeaderSize", "0"),
        ("ElementNumberOfChannels", "1"),
        ("ElementToIntensityFunctionSlope", "1"),
        ("ElementToIntensityFunctionOffset", "0"),
        ("ElementType", "MET_UCHAR"),
    ];
    let hostile = [
        "",
        "-1",
        "-2",
        "nan",
        "inf",
        "-inf",
        "2147483648",
        "4294967295",
        "4294967296",
        "9223372036854775807",
        "18446744073709551615",
        "1e308",
        "1e-308",
        "x",
        "1 1",
        "\u{1b}[2J",
    ];
    let mut refused = 0;
    for (at, (name, _)) in base.iter().enumerate() {
        for value in hostile {
            let count = base[at].1.split(' ').count();
            for value in [value.to_owned(), vec![value; count].join(" ")] {
                let text: String = base
                    .iter()
                    .map(|(field, good)| {
                        let value = if field == name { value.as_str() } else { good };
                        format!("{field} = {value}\n")
                    })
                    .collect();
                match folder.read("a.mha", attached(&text, &[7; 6])) {
                    Err(error) => {
                        let error = message(&error);
                        let named = error.contains(name)
                            || [
                                "TransformMatrix",
                                "sizes",
                                "cannot hold",
                                "promises",
                                "needs",
                            ]
                            .iter()
                            .any(|word| error.contains(word));
                        assert!(named, "{name} = {value:?}: {error}");
                        assert!(!error.contains('\u{1b}'), "{name}: {error:?}");
                        refused += 1;
                    }
                    Ok((header, piece)) => {
                        assert_eq!(
                            numbers(&piece.voxels),
                            [7.0; 6],
                            "{name} = {value}: {header:?}"
                        );
                        assert!(
                            header.world_from_voxel.inverse().is_finite(),
                            "{name} = {value}"
                        );
                    }
                }
            }
        }
    }
    assert!(refused > 250, "only {refused} refused");
    for (text, part) in [
        (
            "NDims = 3\nDimSize = 3 2 1\nElementType = MET_UCHAR\n",
            "`ElementDataFile`",
        ),
        (
            "NDims = 3\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
            "`DimSize`",
        ),
        (
            "DimSize = 3 2 1\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
            "`NDims`",
        ),
        (
            "NDims = 3\nDimSize = 3 2 1\nElementDataFile = LOCAL\n",
            "`ElementType`",
        ),
        (
            "NDims = 5\nDimSize = 1 1 1 1 1\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
            "NDims",
        ),
        (
            "ObjectType = Tube\nNDims = 3\nDimSize = 3 2 1\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
            "Tube",
        ),
        (
            "NDims = 3\nNDims = 3\nDimSize = 3 2 1\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
            "at most one",
        ),
        (
            "NDims = 3\nDimSize = 3 2 1\nElementType = MET_OTHER\nElementDataFile = LOCAL\n",
            "MET_OTHER",
        ),
    ] {
        let error = folder.refused("a.mha", text);
        assert!(error.contains(part), "{text}: {error}");
    }
}

#[test]
fn compressed_data_of_another_length_than_promised_is_refused() {
    let folder = Folder::new();
    let text = header("MET_UCHAR") + "CompressedData = True\n";
    for (length, part) in [
        (5, "promises 6 bytes of voxels, found 5"),
        (7, "promises 6 bytes of voxels, found 7"),
    ] {
        let error = folder.refused("a.mha", attached(&text, &zlib(&vec![1; length])));
        assert!(error.contains(part), "{error}");
    }
    let error = folder.refused("a.mha", attached(&text, b"no zlib at all"));
    assert!(error.contains("damaged"), "{error}");
    let too_large = text.clone() + "CompressedDataSize = 99\n";
    let error = folder.refused("a.mha", attached(&too_large, &zlib(&[1; 6])));
    assert!(error.contains("CompressedDataSize"), "{error}");
    // Such files exist. The stream is whole, so nothing is lost by reading it to its own end.
    let too_small = text + "CompressedDataSize = 3\n";
    let (header, piece) = folder
        .read("a.mha", attached(&too_small, &zlib(&[1; 6])))
        .unwrap();
    assert_eq!(numbers(&piece.voxels), [1.0; 6]);
    assert!(
        header.notes.join("; ").contains("CompressedDataSize is 3"),
        "{:?}",
        header.notes
    );
}
