//! Folders of DICOM slices: what becomes of their order, their gaps, their tilt, their times and their values.
#![cfg(feature = "dicom")]

use crate::dicom;
use crate::files;

use dicom::{COLUMNS, Dicom, ROWS, center, is_noted, open, read, series, slice_numbers, words};
use files::{Folder, message, numbers};
use glam::dvec3;
use stratavox::format;
use stratavox::volume::{Limits, TimeComponent, VolumeSelection, VoxelBox, VoxelType};

#[test]
fn slices_stand_where_they_lie_whatever_their_names_and_numbers_say() {
    // Rows and columns of an oblique slice, and its normal.
    let (row, column) = (dvec3(0.6, 0.8, 0.0), dvec3(0.0, 0.0, -1.0));
    let normal = row.cross(column);
    let first = dvec3(11.0, -7.0, 30.0);
    let folder = series(5, |k, slice| {
        let position = first + normal * (1.25 * k as f64);
        slice.text(0x0020_0032, b"DS", &words(&position.to_array()));
        slice.text(
            0x0020_0037,
            b"DS",
            &words(&[row.to_array(), column.to_array()].concat()),
        );
    });
    let source = open(&folder).unwrap();
    let header = source.header();
    assert_eq!((header.dims, header.stored), ([6, 4, 5], VoxelType::I16));
    let wanted: Vec<f32> = (0..5).flat_map(slice_numbers).collect();
    assert_eq!(read(source.as_ref(), 0), wanted);
    let ras = dvec3(-1.0, -1.0, 1.0);
    for (index, lps) in [
        ([0.0, 0.0, 0.0], first),
        ([5.0, 0.0, 0.0], first + row * 7.5),
        ([0.0, 3.0, 0.0], first + column * 6.0),
        ([0.0, 0.0, 4.0], first + normal * 5.0),
    ] {
        let found = center(header, index);
        assert!(found.distance(lps * ras) < 1e-9, "{index:?}: {found}");
    }
    assert!(header.notes.is_empty(), "{:?}", header.notes);
    // A box is cut out of what all is.
    let region = VoxelBox {
        min: [2, 1, 3],
        max: [5, 3, 5],
    };
    let piece = source.read(TimeComponent::default(), region).unwrap();
    let inside = |x: usize, y: usize, z: usize| wanted[(z * ROWS + y) * COLUMNS + x];
    let cut: Vec<f32> = (3..5)
        .flat_map(|z| (1..3).flat_map(move |y| (2..5).map(move |x| inside(x, y, z))))
        .collect();
    assert_eq!(numbers(&piece.voxels), cut);
}

#[test]
fn a_missing_slice_holds_no_data_and_nothing_moves() {
    let folder = series(12, |_, _| {});
    // Slice 4 has this name.
    std::fs::remove_file(folder.path("2.dcm")).unwrap();
    let source = open(&folder).unwrap();
    let header = source.header();
    assert_eq!((header.dims, header.stored), ([6, 4, 12], VoxelType::F32));
    assert!(
        is_noted(header, "1 slice is missing") && is_noted(header, "between 8.dcm and 9.dcm"),
        "{:?}",
        header.notes
    );
    let found = read(source.as_ref(), 0);
    for (k, slice) in found.chunks(ROWS * COLUMNS).enumerate() {
        match k {
            4 => assert!(slice.iter().all(|n| n.is_nan()), "{slice:?}"),
            _ => assert_eq!(slice, slice_numbers(k), "slice {k}"),
        }
    }
    assert_eq!(center(header, [0.0, 0.0, 11.0]), dvec3(10.0, -20.0, 27.5));
    // Where padding says what no data is, the numbers stay what they are.
    let folder = series(3, |k, slice| {
        let height = [0.0, 2.5, 7.5][k];
        slice.text(0x0020_0032, b"DS", &words(&[0.0, 0.0, height]));
        slice.put(0x0028_0120, b"SS", (-2000_i16).to_le_bytes().to_vec());
    });
    let source = open(&folder).unwrap();
    assert_eq!(
        (source.header().stored, source.header().fill),
        (VoxelType::I16, Some(-2000.0))
    );
    let found = read(source.as_ref(), 0);
    assert!(found[48..72].iter().all(|&n| n == -2000.0), "{found:?}");
}

#[test]
fn steps_that_no_grid_has_are_refused_with_the_names_of_two_files() {
    let at = |heights: [f64; 6]| {
        series(6, move |k, slice| {
            slice.text(0x0020_0032, b"DS", &words(&[0.0, 0.0, heights[k]]));
        })
    };
    for (heights, parts) in [
        (
            [0.0, 1.0, 2.0, 3.0, 8.0, 9.0],
            ["5 mm between 8.dcm and 2.dcm", "each 1 mm"],
        ),
        (
            [0.0, 1.0, 2.0, 3.4, 4.4, 5.4],
            ["between 1.dcm and 8.dcm", "each 1 mm"],
        ),
        (
            [0.0, 5.0, 10.0, 20.0, 30.0, 40.0],
            ["10 mm between", "ImagePositionPatient"],
        ),
    ] {
        let error = open(&at(heights)).err().expect("refused");
        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    }
    // What rounding does to positions is no gap.
    let source = open(&at([0.0, 0.6, 1.2, 1.9, 2.5, 3.1])).unwrap();
    assert_eq!(source.header().dims, [6, 4, 6]);
    assert!(
        is_noted(source.header(), "beside even steps"),
        "{:?}",
        source.header().notes
    );
}

#[test]
fn a_tilted_gantry_gives_a_sheared_grid() {
    let shift = 2.5 * 20_f64.to_radians().tan();
    let folder = series(5, |k, slice| {
        slice.text(
            0x0020_0032,
            b"DS",
            &words(&[0.0, shift * k as f64, 2.5 * k as f64]),
        );
    });
    let source = open(&folder).unwrap();
    let header = source.header();
    let step = center(header, [0.0, 0.0, 1.0]) - center(header, [0.0; 3]);
    assert!(step.distance(dvec3(0.0, -shift, 2.5)) < 1e-9, "{step}");
    assert!(
        is_noted(header, "tilted 20.00 degrees"),
        "{:?}",
        header.notes
    );
}

#[test]
fn slices_that_do_not_belong_together_are_refused_with_both_names() {
    for (tag, text, part) in [
        (0x0020_0037, "1\\0\\0\\0\\0\\-1", "ImageOrientationPatient"),
        (0x0028_0030, "2\\2", "PixelSpacing"),
        (0x0020_0032, "", "ImagePositionPatient"),
    ] {
        let folder = series(4, |k, slice| {
            if k == 2 {
                slice.text(tag, b"DS", text);
            }
        });
        let error = open(&folder).err().expect("refused");
        assert!(
            error.contains("/1.dcm") && error.contains("0.dcm") && error.contains(part),
            "{error}"
        );
    }
    for (tag, number, part) in [
        (0x0028_0010, 2, "6 x 2"),
        (0x0028_0011, 3, "3 x 4"),
        (0x0028_0103, 0, "unsigned"),
        (0x0028_0101, 12, "12 of 16"),
    ] {
        let folder = series(4, |k, slice| {
            if k == 2 {
                slice
                    .u16(tag, number)
                    .u16(0x0028_0102, if number == 12 { 11 } else { 15 });
            }
        });
        let error = open(&folder).err().expect("refused");
        assert!(
            error.contains("/1.dcm") && error.contains("as in 0.dcm") && error.contains(part),
            "{error}"
        );
    }
    // In the plane of another slice, but beside it.
    let folder = series(4, |k, slice| {
        if k == 2 {
            slice.text(0x0020_0032, b"DS", "-4\\20\\2.5");
        }
    });
    let error = open(&folder).err().expect("refused");
    assert!(error.contains("6 mm beside it"), "{error}");
}

#[test]
fn the_same_picture_twice_is_taken_once_and_another_in_its_place_is_refused() {
    let folder = series(4, |_, _| {});
    std::fs::copy(folder.path("1.dcm"), folder.path("copy.dcm")).unwrap();
    let source = open(&folder).unwrap();
    assert_eq!(source.header().dims, [6, 4, 4]);
    assert!(
        is_noted(source.header(), "1 pictures are in the folder twice"),
        "{:?}",
        source.header().notes
    );
    let other = Dicom::slice(9, [-10.0, 20.0, 5.0]);
    folder.write("copy.dcm", other.bytes());
    let error = open(&folder).err().expect("refused");
    assert!(
        error.contains("copy.dcm") && error.contains("1.dcm"),
        "{error}"
    );
}

#[test]
fn without_positions_the_numbers_of_the_pictures_decide() {
    let folder = series(4, |_, slice| {
        slice.without(0x0020_0032).text(0x0018_0050, b"DS", "3");
    });
    let source = open(&folder).unwrap();
    // Numbers fall where heights rise.
    let wanted: Vec<f32> = (0..4).rev().flat_map(slice_numbers).collect();
    assert_eq!(read(source.as_ref(), 0), wanted);
    assert!(is_noted(source.header(), "stacked by their numbers"));
    let step = center(source.header(), [0.0, 0.0, 1.0]) - center(source.header(), [0.0; 3]);
    assert_eq!(step, dvec3(0.0, 0.0, 3.0));
}

#[test]
fn pictures_of_one_place_are_times_by_what_tells_them_apart() {
    let b_value = |time: usize| (1000.0 * time as f64).to_le_bytes().to_vec();
    for (tag, kind, values, names) in [
        (
            0x0020_0100,
            b"IS",
            [b"1".to_vec(), b"2".to_vec()],
            ["1", "2"],
        ),
        (
            0x0018_9087,
            b"FD",
            [b_value(0), b_value(1)],
            ["0 s/mm2", "1000 s/mm2"],
        ),
        (
            0x0018_0081,
            b"DS",
            [b"30".to_vec(), b"80".to_vec()],
            ["30 ms", "80 ms"],
        ),
        (
            0x0008_0032,
            b"TM",
            [b"115959.5".to_vec(), b"120001".to_vec()],
            ["0 s", "1.5 s"],
        ),
    ] {
        // The later time comes first, by name and by number.
        let folder = series(6, |k, slice| {
            slice.text(
                0x0020_0032,
                b"DS",
                &words(&[0.0, 0.0, 2.0 * (k % 3) as f64]),
            );
            slice.put(tag, kind, values[1 - k / 3].clone());
        });
        let source = open(&folder).unwrap();
        let header = source.header();
        assert_eq!((header.dims, header.times), ([6, 4, 3], 2), "{names:?}");
        assert_eq!(header.time_names, names);
        for (time, slices) in [(0, 3..6), (1, 0..3)] {
            let wanted: Vec<f32> = slices.flat_map(slice_numbers).collect();
            assert_eq!(read(source.as_ref(), time), wanted, "{names:?}");
        }
    }
    // One time lacks a slice.
    let folder = series(6, |k, slice| {
        slice.text(
            0x0020_0032,
            b"DS",
            &words(&[0.0, 0.0, 2.0 * (k % 3) as f64]),
        );
        slice.text(0x0020_0100, b"IS", &format!("{}", k / 3));
    });
    std::fs::remove_file(folder.path("9.dcm")).unwrap();
    let error = open(&folder).err().expect("refused");
    assert!(error.contains("as many pictures as where"), "{error}");
}

#[test]
fn each_series_is_listed_and_the_wanted_one_is_read() {
    let folder = series(5, |k, slice| {
        let uid = if k < 3 { "1.2.7" } else { "1.2.5" };
        slice
            .text(0x0020_000e, b"UI", uid)
            .text(0x0008_103e, b"LO", &format!("of {uid}"));
    });
    std::fs::create_dir(folder.path("deeper")).unwrap();
    folder.write(
        "deeper/report",
        Dicom::slice(0, [0.0; 3])
            .without(0x7fe0_0010)
            .without(0x0028_0010)
            .text(0x0008_0016, b"UI", "1.2.840.10008.5.1.4.1.1.88.11")
            .bytes(),
    );
    folder.write(
        "deeper/slice",
        Dicom::slice(5, [-10.0, 20.0, 12.5])
            .text(0x0020_000e, b"UI", "1.2.5")
            .bytes(),
    );
    folder.write("notes.txt", "no picture");
    let open = |series: Option<&str>| {
        let wanted = VolumeSelection {
            series: series.map(str::to_owned),
            ..VolumeSelection::default()
        };
        format::open(&folder.path(""), &wanted, &Limits::default())
    };
    for (wanted, first) in [
        (None, "1.2.5"),
        (Some("1.2.5"), "1.2.5"),
        (Some("1.2.7"), "1.2.7"),
    ] {
        let source = open(wanted).unwrap();
        let header = source.header();
        let listed: Vec<_> = header
            .series
            .iter()
            .map(|s| (s.uid.as_str(), s.description.as_str(), s.pictures))
            .collect();
        assert_eq!((listed.len(), listed[0].0), (2, first), "{listed:?}");
        assert!(
            listed.contains(&("1.2.5", "of 1.2.5", 3))
                && listed.contains(&("1.2.7", "of 1.2.7", 3)),
            "{listed:?}"
        );
        assert!(
            is_noted(header, "1 files with DICOM but no picture")
                && is_noted(header, "1 files that are not DICOM")
        );
        assert_eq!(header.dims, [6, 4, 3]);
    }
    let error = open(Some("1.2.6"))
        .err()
        .map(|e| message(&e))
        .expect("refused");
    assert!(
        error.contains("one of") && error.contains("1.2.5") && error.contains("1.2.7"),
        "{error}"
    );
    // One that cannot be read does not matter where another is wanted.
    let mut coded = Dicom::slice(0, [0.0; 3]);
    coded.syntax = "1.2.840.10008.1.2.4.80".to_owned();
    folder.write("coded", coded.text(0x0020_000e, b"UI", "1.2.9").bytes());
    assert_eq!(open(Some("1.2.7")).unwrap().header().series.len(), 3);
    let error = open(Some("1.2.9"))
        .err()
        .map(|e| message(&e))
        .expect("refused");
    assert!(error.contains("JPEG-LS Lossless"), "{error}");
}

#[test]
fn a_film_without_positions_is_times_of_one_slice() {
    let mut film = Dicom::slice(0, [0.0; 3]);
    let numbers: Vec<u8> = (0..3)
        .flat_map(slice_numbers)
        .flat_map(|n| (n as i16).to_le_bytes())
        .collect();
    film.without(0x0020_0032)
        .without(0x0020_0037)
        .text(0x0028_0008, b"IS", "3")
        .text(0x0018_1063, b"DS", "40");
    film.put(0x0028_0009, b"AT", vec![0x18, 0, 0x63, 0x10])
        .put(0x7fe0_0010, b"OW", numbers);
    let folder = Folder::new();
    let path = folder.write("film", film.bytes());
    let source = format::open(&path, &VolumeSelection::default(), &Limits::default()).unwrap();
    let header = source.header();
    assert_eq!((header.dims, header.times), ([6, 4, 1], 3));
    assert_eq!(header.time_names, ["0 ms", "40 ms", "80 ms"]);
    assert_eq!(read(source.as_ref(), 2), slice_numbers(2));
}
