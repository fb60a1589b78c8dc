//! Names inside files that lead out of their folder: no reader follows one, whatever the format; and where limits
//! are those for untrusted files, none opens a second file at all.
#![cfg(all(feature = "formats", unix))]

use crate::files;
use crate::tiff;

use files::{Folder, message, numbers};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use stratavox::format;
use stratavox::volume::{Limits, ReadError, TimeComponent, VolumeSelection};

/// What lies outside would be read as this.
const OUTSIDE: u8 = 77;
const INSIDE: u8 = 5;

/// A slice of eight voxels.
fn slice(number: u8) -> Vec<u8> {
    tiff::file(&[tiff::Page::gray(4, 2, vec![number; 8])], None)
}

/// Two slices, the second one in another file.
fn ome(name: &str) -> Vec<u8> {
    let xml = format!(
        r#"<?xml version="1.0"?><OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06" UUID="urn:uuid:1">
<Image ID="Image:0"><Pixels ID="Pixels:0" DimensionOrder="XYZCT" Type="uint8" SizeX="4" SizeY="2" SizeZ="2" SizeC="1" SizeT="1">
<TiffData IFD="0" FirstZ="0" PlaneCount="1"/><TiffData IFD="0" FirstZ="1" PlaneCount="1"><UUID FileName="{name}">urn:uuid:2</UUID></TiffData>
</Pixels></Image></OME>"#
    );
    let page = tiff::Page::gray(4, 2, vec![INSIDE; 8]).described(&xml);
    tiff::file(&[page], None)
}

/// A header of every format that names files, for the voxels in `name`.
fn headers(name: &str) -> Vec<(&'static str, Vec<u8>)> {
    let nrrd = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 2 1\nencoding: raw\nbyte skip: -1\ndata file: ";
    let metaimage =
        "NDims = 3\nDimSize = 4 2 1\nElementType = MET_UCHAR\nHeaderSize = -1\nElementDataFile = ";
    vec![
        ("a.nhdr", format!("{nrrd}{name}\n").into()),
        ("a.nhdr", format!("{nrrd}LIST\n{name}\n").into()),
        ("a.mhd", format!("{metaimage}{name}\n").into()),
        ("a.mhd", format!("{metaimage}LIST\n{name}\n").into()),
        ("a.ome.tif", ome(name)),
    ]
}

/// A folder beside a file that is none of its business, which links lead to.
fn prison() -> (Folder, PathBuf) {
    let all = Folder::new();
    all.write("outside", slice(OUTSIDE));
    std::fs::create_dir_all(all.path("in/sub")).unwrap();
    all.write("in/inside", slice(INSIDE));
    symlink("../outside", all.path("in/link")).unwrap();
    symlink("..", all.path("in/up")).unwrap();
    let folder = all.path("in");
    (all, folder)
}

fn read(path: &Path, limits: &Limits) -> Result<Vec<f32>, ReadError> {
    let source = format::open(path, &VolumeSelection::default(), limits)?;
    let piece = source.read(TimeComponent::default(), source.header().whole())?;
    Ok(numbers(&piece.voxels))
}

fn error(path: &Path, limits: &Limits) -> String {
    match read(path, limits) {
        Ok(found) => panic!("{} gives {found:?}", path.display()),
        Err(error) => message(&error),
    }
}

#[test]
fn no_name_in_a_header_leads_out_of_its_folder() {
    let (all, folder) = prison();
    let outside = all.path("outside").display().to_string();
    let names = [
        outside.as_str(),
        "../outside",
        "./../outside",
        "sub/../../outside",
        "link",
        "up/outside",
        "up/in/../outside",
        "up/in/up/outside",
        "//dev/zero",
        "sub/../inside",
    ];
    let mut refused = 0;
    for name in names {
        for (file, bytes) in headers(name) {
            let path = folder.join(file);
            std::fs::write(&path, bytes).unwrap();
            let text = error(&path, &Limits::default());
            assert!(text.contains("folder"), "{file} {name}: {text}");
            refused += 1;
        }
    }
    println!("{refused} names refused");
    assert!(refused >= 40);
    // A name that stays inside is read, or the above would prove nothing.
    for (file, bytes) in headers("inside") {
        let path = folder.join(file);
        std::fs::write(&path, bytes).unwrap();
        let found = read(&path, &Limits::default());
        found.unwrap_or_else(|e| panic!("{file}: {}", message(&e)));
        let text = error(&path, &Limits::UNTRUSTED);
        assert!(text.contains("names another file"), "{file}: {text}");
    }
}

#[test]
fn no_key_of_a_zarr_store_leads_out_of_it() {
    let array = r#"{"zarr_format": 2, "shape": [2, 2, 2], "chunks": [2, 2, 2], "dtype": "|u1",
        "compressor": null, "fill_value": 3, "order": "C", "filters": null}"#;
    let store = |folder: &Folder, name: &str| {
        let path = folder.path(name);
        std::fs::create_dir_all(&path).unwrap();
        std::fs::write(path.join(".zarray"), array).unwrap();
        std::fs::write(path.join("0.0.0"), [OUTSIDE; 8]).unwrap();
    };
    let folder = Folder::new();
    store(&folder, "outside");
    store(&folder, "image/inside");
    std::fs::write(folder.path("image/.zgroup"), r#"{"zarr_format": 2}"#).unwrap();
    symlink("../outside", folder.path("image/link")).unwrap();
    symlink("..", folder.path("image/up")).unwrap();
    let outside = folder.path("outside").display().to_string();
    let mut refused = 0;
    let image = folder.path("image");
    let names = [
        &outside,
        "../outside",
        "./../outside",
        "link",
        "up/outside",
        "inside/../../outside",
    ];
    for limits in [Limits::default(), Limits::UNTRUSTED] {
        let with = |name: &str| {
            let attributes = format!(
                r#"{{"multiscales": [{{"version": "0.4", "axes": [{{"name": "z", "type": "space"}},
                {{"name": "y", "type": "space"}}, {{"name": "x", "type": "space"}}], "datasets": [{{"path": "{name}",
                "coordinateTransformations": [{{"type": "scale", "scale": [1, 1, 1]}}]}}]}}]}}"#
            );
            std::fs::write(image.join(".zattrs"), attributes).unwrap();
        };
        for name in names {
            with(name);
            error(&image, &limits);
            refused += 1;
        }
        with("inside");
        assert_eq!(read(&image, &limits).unwrap(), [f32::from(OUTSIDE); 8]);
        // A chunk that is a link to another store's.
        store(&folder, "chunks");
        std::fs::remove_file(folder.path("chunks/0.0.0")).unwrap();
        symlink("../outside/0.0.0", folder.path("chunks/0.0.0")).unwrap();
        error(&folder.path("chunks"), &limits);
        refused += 1;
    }
    println!("{refused} keys refused");
    assert!(refused >= 14);
}

#[test]
fn hdf5_never_opens_what_its_links_and_external_data_sets_name() {
    let (_all, folder) = prison();
    let bytes = std::fs::read("tests/fixtures/hdf5/escapes.h5").unwrap();
    let path = folder.join("a.h5");
    std::fs::write(&path, bytes).unwrap();
    for limits in [Limits::default(), Limits::UNTRUSTED] {
        for k in 0..4 {
            for kind in ["link", "raw"] {
                let wanted = VolumeSelection {
                    variable: Some(format!("{kind}{k}")),
                    ..VolumeSelection::default()
                };
                let found = format::open(&path, &wanted, &limits).and_then(|source| {
                    source.read(TimeComponent::default(), source.header().whole())
                });
                let text = message(&found.expect_err("no other file is read"));
                let part = if kind == "raw" { "not supported" } else { kind };
                assert!(text.contains(part), "{kind}{k}: {text}");
            }
        }
    }
}

#[test]
fn a_folder_of_strangers_holds_no_links() {
    let dicom = std::fs::read("tests/fixtures/dicom/implicit_i16.dcm").unwrap();
    for (ending, bytes) in [("tif", slice(OUTSIDE)), ("dcm", dicom)] {
        let all = Folder::new();
        let outside = all.write("outside", &bytes);
        let folder = all.path("in");
        std::fs::create_dir(&folder).unwrap();
        symlink(outside, folder.join(format!("s1.{ending}"))).unwrap();
        // People keep data sets as links into a store of them.
        read(&folder, &Limits::default()).unwrap_or_else(|e| panic!("{}", message(&e)));
        let text = error(&folder, &Limits::UNTRUSTED);
        assert!(text.contains("links"), "{text}");
    }
}

#[test]
fn dicom_files_without_an_ending_are_not_hidden_by_a_tiff_beside_them() {
    let dicom = std::fs::read("tests/fixtures/dicom/implicit_i16.dcm").unwrap();
    let folder = Folder::new();
    folder.write("IM0001", dicom);
    folder.write("report.tif", slice(OUTSIDE));
    let source = format::open(
        &folder.path("."),
        &VolumeSelection::default(),
        &Limits::default(),
    )
    .unwrap();
    assert_eq!(source.header().format.name(), "dicom");
}
