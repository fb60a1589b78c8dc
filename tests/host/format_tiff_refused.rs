//! TIFFs that are refused: by the name of what is not read, and lies before anything is allocated for them.

use crate::files::{Folder, message};
use crate::tiff::Page;
use crate::tiff::Value::{Bytes, Long, Longs, Short};
use std::path::Path;
use stratavox::format;
use stratavox::volume::{Limits, ReadError, TimeComponent, VolumeSelection};

fn gray() -> Page {
    Page::gray(3, 2, vec![1, 2, 3, 4, 5, 6])
}

/// The message, and that little memory was taken.
#[track_caller]
fn refused(name: &str, bytes: &[u8]) -> String {
    let folder = Folder::new();
    let path = folder.write(name, bytes);
    refused_at(&path)
}

#[track_caller]
fn refused_at(path: &Path) -> String {
    crate::memory::start();
    let result = read_all(path);
    let peak = crate::memory::peak_since_start();
    assert!(peak < 16 << 20, "{peak} bytes of memory");
    match result {
        Ok(count) => panic!("{count} voxels were read"),
        Err(error) => message(&error),
    }
}

fn read_all(path: &Path) -> Result<usize, ReadError> {
    let source = format::open(path, &VolumeSelection::default(), &Limits::default())?;
    let mut count = 0;
    for time in 0..source.header().times {
        for component in 0..source.header().components {
            let pick = TimeComponent { time, component };
            count += source.read(pick, source.header().whole())?.voxels.len();
        }
    }
    Ok(count)
}

#[test]
fn what_is_not_read_is_refused_by_its_name() {
    let cases = [
        (259, Short(2), "compression 2 (CCITT Huffman)"),
        (259, Short(4), "compression 4 (CCITT fax group 4)"),
        (259, Short(6), "compression 6 (JPEG of the old kind)"),
        (259, Short(34712), "(JPEG 2000)"),
        (259, Short(34925), "(LZMA)"),
        (259, Short(50001), "(WebP)"),
        (259, Short(50002), "(JPEG XL)"),
        (258, Short(12), "12 bits per sample (unsigned)"),
        (258, Short(24), "24 bits per sample"),
        (266, Short(2), "FillOrder 2"),
        (339, Short(5), "complex numbers"),
        (262, Short(4), "a transparency mask"),
        (262, Short(5), "CMYK"),
        (262, Short(8), "CIE L*a*b*"),
        (262, Short(32803), "a color filter array"),
        (262, Short(34892), "linear raw light"),
        (32997, Long(4), "several layers (ImageDepth)"),
    ];
    for (tag, value, words) in &cases {
        let bytes = crate::tiff::file(&[gray().with(*tag, value.clone())], None);
        let message = refused("a.tif", &bytes);
        assert!(message.contains(words), "{tag}: {message}");
        assert!(message.contains("not supported"), "{tag}: {message}");
    }
    let truncated = gray().described("{\"shape\": [2, 2, 3], \"truncated\": true}");
    let message = refused("a.tif", &crate::tiff::file(&[truncated], None));
    assert!(
        message.contains("only the first page has a directory"),
        "{message}"
    );
    let ycbcr = Page::gray(1, 2, vec![0; 6])
        .with(277, Short(3))
        .with(262, Short(6));
    let message = refused("a.tif", &crate::tiff::file(&[ycbcr], None));
    assert!(message.contains("YCbCr colors outside JPEG"), "{message}");
    println!("{} features", cases.len() + 2);
}

#[test]
fn an_entry_that_cannot_be_is_refused_by_its_name() {
    let big = u32::MAX;
    let cases = [
        (256, Long(0), "ImageWidth"),
        (256, Long(big), "a strip of the page needs"),
        (257, Long(0), "ImageLength"),
        (257, Long(65_535), ""),
        (258, Short(0), "BitsPerSample"),
        (258, Short(65), "BitsPerSample"),
        (259, Short(999), "Compression"),
        (262, Short(77), "PhotometricInterpretation"),
        (273, Long(big), "StripOffsets"),
        (273, Longs(vec![8, 9]), "StripOffsets"),
        (277, Short(0), "SamplesPerPixel"),
        (277, Short(5000), "SamplesPerPixel"),
        (277, Short(2), ""),
        (278, Long(0), "RowsPerStrip"),
        (278, Long(1), "StripOffsets"),
        (279, Long(5), "promises 6 bytes"),
        (284, Short(3), "PlanarConfiguration"),
        (339, Short(9), "SampleFormat"),
        (324, Longs(vec![8]), "TileWidth"),
        (262, Short(2), "SamplesPerPixel"),
        (262, Short(3), "ColorMap"),
    ];
    for (tag, value, words) in &cases {
        let bytes = crate::tiff::file(&[gray().with(*tag, value.clone())], None);
        let message = refused("a.tif", &bytes);
        assert!(message.contains(words), "{tag} {value:?}: {message}");
        let is_named = message.contains("tiff") || message.contains("the limit is");
        assert!(is_named, "{tag} {value:?}: {message}");
    }
    for tag in [256, 257] {
        let message = refused("a.tif", &crate::tiff::file(&[gray().without(tag)], None));
        assert!(message.contains("found `none`"), "{tag}: {message}");
    }
    println!("{} entries", cases.len() + 2);
}

#[test]
fn pages_that_differ_are_refused_by_the_number_of_the_first_that_does() {
    let others = [
        Page::gray(2, 3, vec![0; 6]),
        gray()
            .with(258, Short(16))
            .with(256, Long(1))
            .with(278, Long(2)),
        gray().with(339, Short(2)),
        gray().with(262, Short(0)),
    ];
    for other in others {
        let bytes = crate::tiff::file(&[gray(), gray(), other, gray()], None);
        let message = refused("a.tif", &bytes);
        assert!(
            message.contains("field `page 2`: wanted 3 x 2 pixels"),
            "{message}"
        );
    }
}

#[test]
fn pages_that_go_round_or_never_end_are_refused() {
    for (count, back) in [(1, 0), (3, 0), (3, 1), (3, 2)] {
        let bytes = crate::tiff::file(&vec![gray(); count], Some(back));
        let message = refused("a.tif", &bytes);
        assert!(message.contains("pages that come to an end"), "{message}");
    }
    let limits = Limits {
        max_files: 10,
        ..Limits::default()
    };
    let folder = Folder::new();
    let path = folder.write("a.tif", crate::tiff::file(&vec![gray(); 11], None));
    let error = format::open(&path, &VolumeSelection::default(), &limits)
        .err()
        .unwrap();
    assert!(
        message(&error).contains("at most 10 pages"),
        "{}",
        message(&error)
    );
    // 65 537 directories without entries.
    let mut bytes = b"II\x2a\0\x08\0\0\0".to_vec();
    for _ in 0..65_537 {
        let next = bytes.len() as u32 + 6;
        bytes.extend([0, 0]);
        bytes.extend(next.to_le_bytes());
    }
    let message = refused("a.tif", &bytes);
    assert!(message.contains("at most 65536 pages"), "{message}");
}

#[test]
fn sizes_that_lie_are_refused_before_memory_is_asked_for() {
    let deflated = crate::encode::zlib(&[0; 100_000]);
    let strip = |compression: u16, strip: Vec<u8>| Page {
        strip: strip.clone(),
        ..Page::gray(65_535, 65_535, strip).with(259, Short(compression))
    };
    let tile = gray()
        .without(278)
        .without(279)
        .with(322, Long(65_535))
        .with(323, Long(65_535))
        .with(324, Long(8))
        .with(325, Long(6));
    let wide = tile
        .clone()
        .with(322, Long(u32::MAX))
        .with(323, Long(u32::MAX));
    let jpeg = |width: u16, height: u16| {
        let mut bytes = b"\xff\xd8\xff\xc0\0\x0b\x08".to_vec();
        bytes.extend(height.to_be_bytes());
        bytes.extend(width.to_be_bytes());
        bytes.extend(b"\x01\x01\x11\0\xff\xda\0\x08\x01\x01\0\0\x3f\0\0\xff\xd9");
        Page::gray(3, 2, bytes).with(259, Short(7))
    };
    let mut lies = vec![
        crate::tiff::file(&[strip(1, vec![0; 6])], None),
        crate::tiff::file(&[strip(5, vec![0; 6])], None),
        crate::tiff::file(&[strip(8, deflated.clone())], None),
        crate::tiff::file(&[strip(32773, vec![0x81; 100])], None),
        crate::tiff::file(&[strip(7, vec![0xff, 0xd8])], None),
        crate::tiff::file(&[jpeg(65_535, 65_535)], None),
        crate::tiff::file(&[jpeg(3, 65_535)], None),
        crate::tiff::file(&[jpeg(0, 2)], None),
        crate::tiff::file(std::slice::from_ref(&tile), None),
        crate::tiff::file(&[wide], None),
        crate::tiff::file(&[tile.with(259, Short(8))], None),
        crate::tiff::file(&[strip(8, deflated.clone()).with(277, Short(4000))], None),
    ];
    // 65 535 pages of the same strip of 100 000 pixels: 6.5 GB from a small file.
    let page = Page::gray(1000, 100, vec![7; 100_000]);
    let alias = Page {
        strip: Vec::new(),
        ..page.clone().with(273, Long(8))
    };
    let mut pages = vec![alias; 65_000];
    pages[0] = page;
    lies.push(crate::tiff::file(&pages, None));
    for (index, bytes) in lies.iter().enumerate() {
        println!("{index}: {}", refused("a.tif", bytes));
    }
}

#[test]
fn a_damaged_deflate_strip_is_found_by_its_checksum() {
    let plain: Vec<u8> = (0..600_u32).map(|i| (i * i % 251) as u8).collect();
    let packed = crate::encode::zlib(&plain);
    let page = Page::gray(30, 20, packed.clone()).with(259, Short(8));
    let folder = Folder::new();
    folder
        .read(
            "a.tif",
            crate::tiff::file(std::slice::from_ref(&page), None),
        )
        .unwrap();
    let mut harmless = 0;
    for at in 0..packed.len() {
        let mut strip = packed.clone();
        strip[at] ^= 0x10;
        let bytes = crate::tiff::file(
            &[Page {
                strip,
                ..page.clone()
            }],
            None,
        );
        match folder.read("a.tif", bytes) {
            Err(error) => assert!(message(&error).contains("deflate"), "byte {at}: {error}"),
            // The last bits before the checksum may be padding.
            Ok((_, piece)) => {
                assert_eq!(
                    piece.voxels,
                    stratavox::volume::Voxels::U8(plain.clone()),
                    "byte {at}"
                );
                harmless += 1;
            }
        }
    }
    assert!(harmless <= 1, "{harmless} flips were not seen");
    println!("{} bytes", packed.len());
}

fn ome(pixels: &str, inside: &str) -> Vec<u8> {
    let xml = format!(
        "<?xml version=\"1.0\"?><OME UUID=\"urn:uuid:1\"><Image ID=\"Image:0\"><Pixels DimensionOrder=\"XYZCT\" \
         SizeX=\"3\" SizeY=\"2\" {pixels}>{inside}</Pixels></Image></OME>"
    );
    crate::tiff::file(&[gray().described(&xml), gray()], None)
}

#[test]
fn ome_that_lies_is_refused() {
    let folder = Folder::new();
    let sizes = "SizeZ=\"2\" SizeC=\"1\" SizeT=\"1\"";
    folder.read("a.ome.tif", ome(sizes, "<TiffData/>")).unwrap();
    for (sizes, inside, words) in [
        (
            "SizeZ=\"3\" SizeC=\"1\" SizeT=\"1\"",
            "<TiffData/>",
            "a page for each Z, C and T",
        ),
        (
            "SizeZ=\"4294967295\" SizeC=\"4294967295\" SizeT=\"4294967295\"",
            "<TiffData/>",
            "at most 65536 pages",
        ),
        ("SizeZ=\"0\" SizeC=\"1\" SizeT=\"1\"", "", "SizeZ"),
        ("SizeZ=\"-1\" SizeC=\"1\" SizeT=\"1\"", "", "SizeZ"),
        ("SizeZ=\"2\" SizeC=\"1\"", "", "SizeT"),
        (sizes, "<TiffData IFD=\"0\"/>", "a page for each Z, C and T"),
        (sizes, "<TiffData IFD=\"7\"/>", "2 pages"),
        (
            sizes,
            "<TiffData IFD=\"18446744073709551615\" PlaneCount=\"18446744073709551615\"/>",
            "",
        ),
        (
            sizes,
            "<TiffData IFD=\"0\" PlaneCount=\"18446744073709551615\"/>",
            "TiffData",
        ),
        (
            sizes,
            "<TiffData FirstZ=\"1\" PlaneCount=\"2\"/>",
            "inside SizeZ",
        ),
        (
            sizes,
            "<TiffData FirstC=\"1\" PlaneCount=\"1\"/>",
            "inside SizeZ",
        ),
        (sizes, "<TiffData IFD=\"x\"/>", "IFD"),
        (sizes, "<BinData Length=\"3\">AAAA</BinData>", "BinData"),
        ("SizeX=\"9\" SizeZ=\"2\" SizeC=\"1\" SizeT=\"1\"", "", ""),
        (sizes, "<TiffData", "OME-XML"),
        (sizes, "</Pixels><Pixels>", ""),
    ] {
        let message = refused("a.ome.tif", &ome(sizes, inside));
        assert!(message.contains(words), "{sizes} {inside}: {message}");
    }
    let other_order = |order: &str| {
        let text = String::from_utf8_lossy(&ome(sizes, "")).contains("XYZCT");
        assert!(text);
        let xml = format!(
            "<OME><Image><Pixels DimensionOrder=\"{order}\" SizeX=\"3\" SizeY=\"2\" {sizes}/></Image></OME>"
        );
        crate::tiff::file(&[gray().described(&xml), gray()], None)
    };
    for order in ["", "XY", "ZCTXY", "XYZZZ", "XYZCTT"] {
        let message = refused("a.ome.tif", &other_order(order));
        assert!(message.contains("DimensionOrder"), "{order}: {message}");
    }
}

#[test]
fn xml_that_expands_or_nests_without_end_is_refused() {
    let page = |xml: &str| crate::tiff::file(&[gray().described(xml)], None);
    let dtd = "<?xml version=\"1.0\"?><!DOCTYPE OME [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]><OME>&b;</OME>";
    assert!(refused("a.tif", &page(dtd)).contains("OME-XML with a DTD"));
    let deep = format!("<OME>{}", "<a>".repeat(100_000));
    assert!(refused("a.tif", &page(&deep)).contains("32 deep"));
    let many: String = (0..300).map(|i| format!(" a{i}=\"1\"")).collect();
    let many = format!("<OME{many}></OME>");
    assert!(refused("a.tif", &page(&many)).contains("more than 256"));
    let entity = "<OME UUID=\"&b;\"></OME>";
    assert!(refused("a.tif", &page(entity)).contains("OME-XML"));
    let other = "<OME><BinaryOnly MetadataFile=\"x.companion.ome\" UUID=\"y\"/></OME>";
    assert!(refused("a.tif", &page(other)).contains("OME-XML in another file (`x.companion.ome`)"));
    let long = format!("<OME>{}</OME>", " ".repeat(2 << 20));
    assert!(refused("a.tif", &page(&long)).contains("the limit is"));
    assert!(refused("a.tif", &page("<OME></OME>")).contains("an Image with Pixels"));
}

#[test]
fn pages_in_other_files_stay_in_the_folder() {
    let outside = Folder::new();
    let secret = outside.write("secret.tif", crate::tiff::file(&[gray()], None));
    let folder = Folder::new();
    let mut tried = 0;
    for name in [
        secret.to_str().unwrap(),
        "../secret.tif",
        "/dev/zero",
        "sub/../../secret.tif",
        "",
        ".",
        "missing.tif",
    ] {
        let sizes = "SizeZ=\"2\" SizeC=\"1\" SizeT=\"1\"";
        let inside = format!(
            "<TiffData IFD=\"0\" FirstZ=\"0\"><UUID FileName=\"a.ome.tif\">urn:uuid:1</UUID></TiffData>\
             <TiffData IFD=\"0\" FirstZ=\"1\"><UUID FileName=\"{name}\">urn:uuid:2</UUID></TiffData>"
        );
        let path = folder.write("a.ome.tif", ome(sizes, &inside));
        let message = refused_at(&path);
        assert!(
            message.contains("FileName") || message.contains("folder"),
            "{name}: {message}"
        );
        tried += 1;
    }
    println!("{tried} names");
}

#[test]
fn a_folder_is_read_where_all_its_slices_fit_and_is_left_to_others_where_it_is_theirs() {
    let slice = |value: u8| crate::tiff::file(&[Page::gray(3, 2, vec![value; 6])], None);
    let folder = Folder::new();
    for number in [1_u8, 2, 10] {
        folder.write(&format!("s{number}.TIFF"), slice(number));
    }
    folder.write("notes.txt", "hello");
    let source = format::open(
        &folder.path(""),
        &VolumeSelection::default(),
        &Limits::default(),
    )
    .unwrap();
    assert_eq!(source.header().dims, [3, 2, 3]);
    let notes = source.header().notes.join("\n");
    assert!(
        notes.contains("1 other files of the folder are not read"),
        "{notes}"
    );
    let voxels = source
        .read(TimeComponent::default(), source.header().whole())
        .unwrap()
        .voxels;
    let layers: Vec<f32> = crate::files::numbers(&voxels)
        .into_iter()
        .step_by(6)
        .collect();
    assert_eq!(layers, [1.0, 2.0, 10.0]);

    folder.write(
        "s3.tif",
        crate::tiff::file(&[Page::gray(2, 3, vec![0; 6])], None),
    );
    let message = refused_at(&folder.path(""));
    assert!(
        message.contains("s3.tif") && message.contains("wanted 3 x 2 pixels"),
        "{message}"
    );
    folder.write("s3.tif", crate::tiff::file(&[gray(), gray()], None));
    let message = refused_at(&folder.path(""));
    assert!(
        message.contains("s3.tif") && message.contains("one page in each file"),
        "{message}"
    );
    folder.write("s3.tif", slice(3));
    for theirs in ["a.dcm", "DICOMDIR", ".zgroup", "zarr.json"] {
        let path = folder.write(theirs, "x");
        let message = refused_at(&folder.path(""));
        assert!(!message.contains("tiff field"), "{theirs}: {message}");
        std::fs::remove_file(path).unwrap();
    }
    read_all(&folder.path("")).unwrap();
}

#[test]
fn a_file_cut_anywhere_is_an_error() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/tiff");
    let folder = Folder::new();
    let mut cuts = 0;
    for name in [
        "raw-u2-be.tif",
        "big-be.tif",
        "lzw-u2-p2-be.tif",
        "deflate-f4-p3.tif",
        "packbits-u2.tif",
        "strips-u2.tif",
        "rgb-planar.tif",
        "bits-1.tif",
        "jpeg-ycbcr.tif",
        "ome-rgb.ome.tif",
    ] {
        let whole = std::fs::read(fixtures.join(name)).unwrap();
        let path = folder.write("a.tif", &whole);
        let count = read_all(&path).unwrap();
        let mut needed = whole.len();
        for cut in (0..whole.len()).rev() {
            let path = folder.write("a.tif", &whole[..cut]);
            match read_all(&path) {
                // Some bytes of padding at the end belong to nothing.
                Ok(found) => {
                    assert!(
                        needed == cut + 1 && whole.len() - cut < 40,
                        "{name} cut at {cut}"
                    );
                    assert_eq!(found, count, "{name} cut at {cut}");
                    needed = cut;
                }
                Err(_) => cuts += 1,
            }
        }
    }
    println!("{cuts} cuts");
}

#[test]
fn a_description_that_is_no_text_is_no_harm() {
    let folder = Folder::new();
    let page = gray().with(270, Bytes(vec![0xff, 0xfe, 0, 1, 2]));
    folder
        .read("a.tif", crate::tiff::file(&[page], None))
        .unwrap();
    let page =
        gray().described("ImageJ=1\nimages=4294967295\nslices=4294967295\nframes=4294967295\n");
    let message = refused("a.tif", &crate::tiff::file(&[page], None));
    assert!(message.contains("tiff"), "{message}");
}
