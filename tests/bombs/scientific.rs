//! HDF5, NetCDF, Zarr, DICOM and GRIB: chunks, frames and fields that are not what they are said to be.

use crate::Bombs;
use crate::dicom::Dicom;
use crate::streams::{long_zlib, zstd};
use serde_json::{Value, json};
use std::path::Path;

pub fn fixture(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures")
        .join(name);
    std::fs::read(&path).unwrap_or_else(|e| panic!("{name}: {e}"))
}

pub fn add(bombs: &mut Bombs) {
    hdf5(bombs);
    netcdf(bombs);
    zarr(bombs);
    dicom(bombs);
    grib(bombs);
}

/// Every place of `part`.
fn places(bytes: &[u8], part: &[u8]) -> Vec<usize> {
    let found = bytes.windows(part.len()).enumerate();
    let places: Vec<usize> = found
        .filter(|(_, at)| *at == part)
        .map(|(k, _)| k)
        .collect();
    assert!(!places.is_empty(), "{part:02x?} is not there");
    places
}

/// With other bytes at each place of `part`.
fn replaced(mut bytes: Vec<u8>, part: &[u8], by: &[u8]) -> Vec<u8> {
    for at in places(&bytes, part) {
        bytes[at..at + by.len()].copy_from_slice(by);
    }
    bytes
}

/// With `chunk` as the first chunk of each B-tree of `axes` axes (HDF5 file format, III.A.1, version 1).
fn with_chunk(mut bytes: Vec<u8>, axes: usize, chunk: &[u8]) -> Vec<u8> {
    const OF_CHUNKS_AND_LEAF: [u8; 2] = [1, 0];
    let address = bytes.len() as u64;
    for at in places(&bytes, b"TREE") {
        if bytes[at + 4..at + 6] == OF_CHUNKS_AND_LEAF {
            let key = at + 24;
            bytes[key..key + 4].copy_from_slice(&(chunk.len() as u32).to_le_bytes());
            let child = key + 8 + 8 * (axes + 1);
            bytes[child..child + 8].copy_from_slice(&address.to_le_bytes());
        }
    }
    bytes.extend(chunk);
    let end = bytes.len() as u64;
    // The end of file address of superblock version 0.
    bytes[40..48].copy_from_slice(&end.to_le_bytes());
    bytes
}

fn words(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

fn hdf5(bombs: &mut Bombs) {
    let plain = fixture("hdf5/zstd.h5");
    let bomb = with_chunk(plain.clone(), 3, &zstd());
    bombs.folder.write("zstd.h5", bomb);
    for variable in ["plain", "shuffled"] {
        bombs.run(
            "zstd.h5",
            &format!("info zstd.h5 --variable {variable}"),
            "Zstandard",
        );
    }
    bombs.volume(
        "deflate.h5",
        with_chunk(fixture("hdf5/earliest.h5"), 3, &long_zlib()),
        "",
    );
    // Sides of a chunk, and the bytes of its numbers, in the layout message.
    let chunks = words(&[2, 2, 3, 2]);
    for (name, side) in [("chunks.h5", 0x7fff_ffff), ("chunk.h5", 1024)] {
        let lying = replaced(plain.clone(), &chunks, &words(&[side, side, side]));
        bombs.folder.write(name, with_chunk(lying, 3, &zstd()));
        let command = format!("info {name} --variable plain");
        bombs.run(name, &command, "chunks of at most");
    }
    let sides: Vec<u8> = [3_u64, 4, 5].iter().flat_map(|n| n.to_le_bytes()).collect();
    let many: Vec<u8> = [1_u64 << 40; 3]
        .iter()
        .flat_map(|n| n.to_le_bytes())
        .collect();
    bombs.volume("sides.h5", replaced(plain, &sides, &many), "");
}

fn netcdf(bombs: &mut Bombs) {
    bombs.volume(
        "zstd.nc",
        with_chunk(fixture("netcdf/zstd.nc"), 3, &zstd()),
        "Zstandard",
    );
    let classic = fixture("netcdf/classic.nc");
    let longitudes = b"\0\0\0\x03lon\0\0\0\0\x04";
    let many = b"\0\0\0\x03lon\0\x7f\xff\xff\xff";
    bombs.volume("sides.nc", replaced(classic.clone(), longitudes, many), "");
    let mut records = classic.clone();
    // 2^32 - 2 records: all ones would say that nobody knows.
    records[4..8].copy_from_slice(&[0xff, 0xff, 0xff, 0xfe]);
    bombs.volume("records.nc", records, "");
    let mut names = classic;
    names[12..20].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    bombs.volume("names.nc", names, "");
}

/// A store of the fixtures, with changes to its JSON and this as each of its chunks.
fn store(bombs: &mut Bombs, name: &str, of: &str, changes: &[(&str, Value)], chunk: Option<&[u8]>) {
    let root = bombs.folder.path(name);
    for (key, mut bytes) in crate::zarr::files(of) {
        let path = root.join(&key);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        let is_header = key.ends_with(".zarray") || key.ends_with("zarr.json");
        if is_header {
            let mut header: Value = serde_json::from_slice(&bytes).expect("JSON");
            for (pointer, value) in changes {
                *header.pointer_mut(pointer).expect("a field") = value.clone();
            }
            bytes = header.to_string().into_bytes();
        } else if let (Some(chunk), false) = (chunk, key.ends_with(".zattrs")) {
            bytes = chunk.to_vec();
        }
        std::fs::write(path, bytes).expect("a file");
    }
    bombs.run(name, &format!("info {name}"), "");
}

fn zarr(bombs: &mut Bombs) {
    store(bombs, "zlib.zarr", "v2-zlib", &[], Some(&long_zlib()));
    store(bombs, "zstd.zarr", "v2-zstd", &[], Some(&zstd()));
    let zeros = crate::encode::bzip2(&vec![0; 64 << 20]);
    store(bombs, "bz2.zarr", "v2-bz2", &[], Some(&zeros));
    // 2 GiB of numbers, and nothing behind them.
    let lz4 = [0x7fff_ffff_u32.to_le_bytes().as_slice(), &[0xff; 64]].concat();
    store(bombs, "lz4.zarr", "v2-lz4", &[], Some(&lz4));
    let blosc = [
        &[2_u8, 1, 1, 2][..],
        &words(&[0x7fff_ffff, 0x7fff_ffff, 80]),
        &[0; 64],
    ]
    .concat();
    store(bombs, "blosc.zarr", "v2-blosc-lz4-1", &[], Some(&blosc));
    let huge = json!([1_u64 << 20, 1_u64 << 20, 1_u64 << 20]);
    let both = [("/shape", huge.clone()), ("/chunks", huge)];
    store(bombs, "chunks.zarr", "v2-zlib", &both, None);
    // Where each of eight chunks begins, and how many bytes it has.
    let mut index = [0_u64, 1 << 62].repeat(8);
    index[2] = 1 << 62;
    let mut index: Vec<u8> = index.iter().flat_map(|n| n.to_le_bytes()).collect();
    index.extend(crc32c(&index).to_le_bytes());
    store(bombs, "shards.zarr", "v3-shards-end", &[], Some(&index));
    let sides = json!([1_u64 << 31, 1_u64 << 31, 4]);
    let chunks = [("/chunk_grid/configuration/chunk_shape", sides)];
    store(bombs, "shapes.zarr", "v3-shards-end", &chunks, None);
    let deep = format!("{}1{}", "[".repeat(30_000), "]".repeat(30_000));
    std::fs::create_dir(bombs.folder.path("deep.zarr")).expect("a folder");
    bombs.folder.write("deep.zarr/zarr.json", deep);
    bombs.run("deep.zarr", "info deep.zarr", "");
}

/// RFC 3720, appendix B.4.
fn crc32c(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            (sum >> 1) ^ (0x82f6_3b78 * (sum & 1))
        })
    })
}

fn dicom(bombs: &mut Bombs) {
    let slice = Dicom::slice(0, [0.0; 3]);
    let sized = |frames: &str| {
        let mut file = slice.clone();
        file.u16(0x0028_0010, 65535).u16(0x0028_0011, 65535);
        file.text(0x0028_0008, b"IS", frames);
        file.bytes()
    };
    bombs.volume("frames.dcm", sized("2147483647"), "");
    bombs.volume("frame.dcm", sized("1"), "");
    let mut long = slice.bytes();
    let at = places(&long, &[0xe0, 0x7f, 0x10, 0]);
    long[at[0] + 8..at[0] + 12].copy_from_slice(&0xffff_fff0_u32.to_le_bytes());
    bombs.volume("length.dcm", long, "");
    let head = slice.bytes();
    // Sequences of items of sequences, none of which ends.
    let open = [
        &[0x40, 0, 0x75, 0xa2, b'S', b'Q', 0, 0, 255, 255, 255, 255][..],
        &[0xfe, 0xff, 0, 0xe0, 255, 255, 255, 255],
    ];
    bombs.volume(
        "nested.dcm",
        [&head[..at[0]], &open.concat().repeat(50_000)].concat(),
        "",
    );

    let deflated = fixture("dicom/deflated_i16.dcm");
    let syntax = places(&deflated, b"1.2.840.10008.1.2.1.99")[0];
    // The header of a stream of zlib is two bytes; that of deflate has none.
    let stream = long_zlib();
    let bytes = [&deflated[..syntax + 22], &stream[2..]].concat();
    bombs.volume("deflated.dcm", bytes, "");

    let rle = fixture("dicom/rle_u8.dcm");
    bombs.volume(
        "rle.dcm",
        replaced(rle, &columns(&fixture("dicom/rle_u8.dcm")), &wide()),
        "",
    );
    let jpeg2000 = fixture("dicom/j2k_u8.dcm");
    // SIZ: marker, length, capabilities, then the sides of the picture.
    let siz = places(&jpeg2000, &[0xff, 0x4f, 0xff, 0x51])[0] + 8;
    let mut sides = jpeg2000.clone();
    sides[siz..siz + 8].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    bombs.volume("siz.dcm", sides, "");
    bombs.volume(
        "j2k.dcm",
        replaced(jpeg2000.clone(), &columns(&jpeg2000), &wide()),
        "",
    );
    let jpeg = fixture("dicom/jpeg_baseline.dcm");
    let frame = places(&jpeg, &[0xff, 0xc0])[0] + 5;
    let mut sides = jpeg;
    sides[frame..frame + 4].copy_from_slice(&[0xff; 4]);
    bombs.volume("jpeg.dcm", sides, "");
}

/// The element Columns, explicit and little-endian.
fn columns(file: &[u8]) -> Vec<u8> {
    let at = places(file, &[0x28, 0, 0x11, 0, b'U', b'S', 2, 0])[0];
    file[at..at + 10].to_vec()
}

fn wide() -> Vec<u8> {
    [&[0x28, 0, 0x11, 0, b'U', b'S', 2, 0][..], &[0xff, 0xff]].concat()
}

/// Without the feature the format is refused by its name.
fn grib(bombs: &mut Bombs) {
    let message = fixture("grib/simple_11.grib2");
    // Section 3: its length, number, source, then the number of points; template 3.0 has the sides at 31.
    let grid = message[16..].to_vec();
    let first = 16 + u32::from_be_bytes(grid[..4].try_into().expect("four")) as usize;
    let mut points = message.clone();
    for at in [first + 6, first + 30, first + 34] {
        points[at..at + 4].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff]);
    }
    bombs.volume("points.grib2", points, "");
    let mut length = message;
    length[8..16].copy_from_slice(&(u64::MAX / 2).to_be_bytes());
    bombs.volume("length.grib2", length, "");
}
