//! Mutated files: no panic, no memory in proportion to a lie, no volume out of bytes that are not there.
//!
//! `STRATAVOX_MUTATIONS` is the number of mutations of each reader; where it is not set 5 000, 20 000 in long sweeps. The same number
//! gives the same mutations; a failure prints the number of the one that failed and keeps its file.

use crate::encode::{ascii, bytes_of, bzip2, gzip, hex, zlib};
use crate::files::Folder;
use crate::memory;
use crate::mutate::{Random, mutate};
use crate::survive::{Base, read_all, survive};
use std::panic::{AssertUnwindSafe, catch_unwind};
use stratavox::volume::VoxelType;

const COUNT: usize = 5 * 4 * 3;

fn values() -> Vec<i128> {
    (0..COUNT as i128).map(|k| k * 541 - 9000).collect()
}

fn nrrd_header(kind: &str, encoding: &str) -> String {
    format!(
        "NRRD0005\n# c\ntype: {kind}\ndimension: 4\nspace: left-posterior-superior\nsizes: 1 5 4 3\n\
         space directions: none (1.5,0,0) (0,1.5,0.25) (0,0,2)\nkinds: vector domain domain domain\n\
         space origin: (1,-2,3)\nendian: little\nencoding: {encoding}\nmodality:=CT\n"
    )
}

fn metaimage_header(kind: &str, fields: &str) -> String {
    format!(
        "ObjectType = Image\nNDims = 3\nBinaryDataByteOrderMSB = False\n{fields}\
         TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 1 -2 3\nElementSpacing = 1 1 2.5\nDimSize = 5 4 3\n\
         ElementNumberOfChannels = 1\nElementType = {kind}\nElementDataFile = "
    )
}

#[test]
fn nrrd_survives_mutations() {
    let short = bytes_of(&values(), VoxelType::I16, false);
    let double = bytes_of(&values(), VoxelType::F64, false);
    let attached = |header: String, data: &[u8]| -> Base {
        vec![("a.nrrd", [header.as_bytes(), b"\n", data].concat())]
    };
    survive(
        "nrrd",
        &[
            attached(nrrd_header("short", "raw"), &short),
            attached(nrrd_header("double", "raw"), &double),
            attached(nrrd_header("short", "gzip"), &gzip(&short)),
            attached(nrrd_header("double", "bzip2"), &bzip2(&double)),
            attached(nrrd_header("short", "ascii"), &ascii(&values())),
            attached(nrrd_header("short", "hex"), &hex(&short)),
        ],
    );
}

#[test]
fn bricks_survive_mutations() {
    use stratavox::format::write::{
        NumberType, Selection, VolumeFormat, WriteVolumeOptions, write_volume,
    };
    let folder = Folder::new();
    let short = bytes_of(&values(), VoxelType::I16, false);
    let header = nrrd_header("short", "raw");
    let path = folder.write("a.nrrd", [header.as_bytes(), b"\n", &short[..]].concat());
    let source = stratavox::format::open(&path, &Default::default(), &Default::default());
    let source = source.expect("readable");
    let mut file = std::io::Cursor::new(Vec::new());
    let options = WriteVolumeOptions {
        format: VolumeFormat::Bricks,
        numbers: NumberType::Stored,
        compress: true,
    };
    let all = Selection::all(source.header());
    write_volume(source.as_ref(), &all, &options, &mut file, &mut |_, _| {}).expect("written");
    survive("bricks", &[vec![("a.svb", file.into_inner())]]);
}

#[test]
fn nhdr_survives_mutations() {
    let short = bytes_of(&values(), VoxelType::I16, false);
    let slices: Vec<&[u8]> = short.chunks(short.len() / 3).collect();
    let header = |encoding: &str, rest: &str| (nrrd_header("short", encoding) + rest).into_bytes();
    survive(
        "nhdr",
        &[
            vec![
                (
                    "a.nhdr",
                    header("raw", "byte skip: 3\nline skip: 1\ndata file: a.raw\n"),
                ),
                ("a.raw", [b"line\nxyz", &short[..]].concat()),
            ],
            vec![
                ("b.nhdr", header("raw", "data file: s%02d 7 9 1\n")),
                ("s07", slices[0].to_vec()),
                ("s08", slices[1].to_vec()),
                ("s09", slices[2].to_vec()),
            ],
            vec![
                ("c.nhdr", header("gz", "data file: LIST 3\nz1\nz2\nz3\n")),
                ("z1", gzip(slices[0])),
                ("z2", gzip(slices[1])),
                ("z3", gzip(slices[2])),
            ],
            vec![
                ("d.nhdr", header("raw", "byte skip: -1\ndata file: a.raw\n")),
                ("a.raw", short.clone()),
            ],
        ],
    );
}

#[test]
fn mha_survives_mutations() {
    let short = bytes_of(&values(), VoxelType::I16, false);
    let long = bytes_of(&values(), VoxelType::I64, false);
    let attached = |header: String, data: &[u8]| -> Base {
        vec![("a.mha", [header.as_bytes(), b"LOCAL\n", data].concat())]
    };
    let sized = format!(
        "CompressedData = True\nCompressedDataSize = {}\n",
        zlib(&short).len()
    );
    survive(
        "mha",
        &[
            attached(metaimage_header("MET_SHORT", ""), &short),
            attached(
                metaimage_header("MET_LONG_LONG", "HeaderSize = -1\n"),
                &long,
            ),
            attached(metaimage_header("MET_SHORT", &sized), &zlib(&short)),
            attached(
                metaimage_header("MET_SHORT", "BinaryData = False\n"),
                &ascii(&values()),
            ),
        ],
    );
}

#[test]
fn mhd_survives_mutations() {
    let short = bytes_of(&values(), VoxelType::I16, false);
    let slices: Vec<&[u8]> = short.chunks(short.len() / 3).collect();
    let header =
        |fields: &str, rest: &str| (metaimage_header("MET_SHORT", fields) + rest).into_bytes();
    survive(
        "mhd",
        &[
            vec![
                ("a.mhd", header("HeaderSize = 3\n", "a.raw\n")),
                ("a.raw", [b"xyz", &short[..]].concat()),
            ],
            vec![
                ("b.mhd", header("", "s%02d 7 9 1\n")),
                ("s07", slices[0].to_vec()),
                ("s08", slices[1].to_vec()),
                ("s09", slices[2].to_vec()),
            ],
            vec![
                (
                    "c.mhd",
                    header("CompressedData = True\n", "LIST\nz1\nz2\nz3\n"),
                ),
                ("z1", zlib(slices[0])),
                ("z2", zlib(slices[1])),
                ("z3", zlib(slices[2])),
            ],
        ],
    );
}

/// 5 x 4 x 3 voxels with everything that a reader looks at.
fn nifti_header(version: u8, datatype: i16, bitpix: i16) -> crate::nifti::Nifti {
    crate::nifti::Nifti {
        version,
        dim: [4, 5, 4, 3, 1, 0, 0, 0],
        pixdim: [-1.0, 1.5, 1.5, 2.0, 1.0, 0.0, 0.0, 0.0],
        scl_slope: 2.0,
        scl_inter: -3.0,
        qform_code: 1,
        quatern: [0.5, 0.5, 0.5],
        sform_code: 1,
        srow: [
            [1.5, 0.0, 0.0, 9.0],
            [0.0, 1.5, 0.5, 8.0],
            [0.0, 0.0, 2.0, 7.0],
        ],
        units: 3,
        ..crate::nifti::Nifti::new(datatype, bitpix)
    }
}

#[test]
fn nifti_survives_mutations() {
    let short = |big| bytes_of(&values(), VoxelType::I16, big);
    let double = bytes_of(&values(), VoxelType::F64, false);
    let big = crate::nifti::Nifti {
        big_endian: true,
        ..nifti_header(1, 4, 16)
    };
    let pair = |version: u8| crate::nifti::Nifti {
        is_single_file: false,
        ..nifti_header(version, 4, 16)
    };
    survive(
        "nifti",
        &[
            vec![("a.nii", nifti_header(1, 4, 16).with(&short(false)))],
            vec![("a.nii", big.with(&short(true)))],
            vec![("a.nii", nifti_header(2, 64, 64).with(&double))],
            vec![(
                "b.nii.gz",
                gzip(&nifti_header(1, 4, 16).with(&short(false))),
            )],
            vec![("b.nii.gz", gzip(&nifti_header(2, 64, 64).with(&double)))],
            // Without the four bytes behind the header, which carry nothing here.
            vec![
                ("c.hdr", pair(1).bytes()[..348].to_vec()),
                ("c.img", short(false)),
            ],
            vec![
                ("d.hdr", pair(2).bytes()[..540].to_vec()),
                ("d.img.gz", gzip(&short(false))),
            ],
        ],
    );
}

#[test]
#[cfg(feature = "json")]
fn raw_survives_mutations() {
    let sidecar = r#"{"file": "a.raw", "dims": [5, 4, 3], "type": "i16", "endian": "little", "header_bytes": 2}"#;
    let short = bytes_of(&values(), VoxelType::I16, false);
    survive(
        "raw",
        &[vec![
            ("a.json", sidecar.as_bytes().to_vec()),
            ("a.raw", [b"xy", &short[..]].concat()),
        ]],
    );
}

#[test]
#[cfg(feature = "netcdf")]
fn netcdf_survives_mutations() {
    let file = |name: &'static str| -> Base { vec![(name, fixture("netcdf", name))] };
    survive(
        "netcdf",
        &[
            file("classic.nc"),
            file("offset64.nc"),
            file("cdf5.nc"),
            file("packed.nc"),
            file("order.nc"),
            file("uneven.nc"),
        ],
    );
}

#[test]
#[cfg(feature = "netcdf")]
fn hdf5_survives_mutations() {
    let file = |name: &'static str| -> Base { vec![(name, fixture("hdf5", name))] };
    survive(
        "hdf5",
        &[file("earliest.h5"), file("latest.h5"), file("kinds.h5")],
    );
}

/// A file that another program wrote.
#[cfg(feature = "netcdf")]
fn fixture(format: &str, name: &str) -> Vec<u8> {
    let root = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let path = root.join("tests/fixtures").join(format).join(name);
    std::fs::read(path).expect("a fixture")
}

/// A file of VTK's own writer, without the line end behind it.
fn written_by_vtk(format: &str, name: &'static str) -> Base {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    let mut bytes = std::fs::read(path.join(format).join(name)).expect("a fixture");
    while bytes.ends_with(b"\n") {
        bytes.pop();
    }
    vec![(name, bytes)]
}

#[test]
fn vti_survives_mutations() {
    let names = [
        "ascii-none-u32-le.vti",
        "binary-none-u64-le.vti",
        "binary-zlib-u32-be.vti",
        "appended-none-u32-le.vti",
        "appended-lz4-u64-le.vti",
        "appended-zlib-u32-le.vti",
        "appended64-none-u64-be.vti",
        "appended64-lz4-u32-le.vti",
        "several.vti",
        "pieces.vti",
        "cells.vti",
        "vectors.vti",
    ];
    survive("vti", &names.map(|name| written_by_vtk("vti", name)));
}

#[test]
fn vtk_survives_mutations() {
    let with_end = |name| {
        let mut base = written_by_vtk("vtk", name);
        // Without its line end the last number could have lost digits.
        base[0].1.push(b'\n');
        base
    };
    survive(
        "vtk",
        &[
            with_end("type-int16-ascii-42.vtk"),
            with_end("type-float64-ascii-51.vtk"),
            written_by_vtk("vtk", "type-int16-binary-51.vtk"),
            written_by_vtk("vtk", "type-float64-binary-51.vtk"),
        ],
    );
}

/// Files of points have a loop of their own: the volume of their means may have more voxels than they have bytes, and a table
/// that is cut behind a row is a table.
#[test]
fn points_survive_mutations() {
    let table = "x_km,y_m,depth_km,v,std,weight\r\n0,\"0\",0,1,.5,1\r\n5,0,0,2,.5,1\r\n9,,0,3,.5,1\r\n9,0,0,3,.5,1\r\n";
    let degrees = "# c\nlon\tlat\tpressure_hPa\tname\tv\n0\t0\t500\ta\t1\n1\t0\t500\tb\t2\n";
    let head = |encoding| {
        format!(
            "ply\nformat {encoding} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property float v\nend_header\n"
        )
    };
    let words = head("ascii") + "0 0 0 1\n5 0 0 2\n9 0 0 3\n";
    let numbers: [[f32; 4]; 3] = [[0., 0., 0., 1.], [5., 0., 0., 2.], [9., 0., 0., 3.]];
    let bytes = |big: bool| -> Vec<u8> {
        let all = numbers.iter().flatten();
        all.flat_map(|n| {
            if big {
                n.to_be_bytes()
            } else {
                n.to_le_bytes()
            }
        })
        .collect()
    };
    let little = [head("binary_little_endian").into_bytes(), bytes(false)].concat();
    let big = [head("binary_big_endian").into_bytes(), bytes(true)].concat();
    let array = |name: &str, components: u32, numbers: &str| {
        format!(
            "<DataArray type=\"Float32\" Name=\"{name}\" NumberOfComponents=\"{components}\">{numbers}</DataArray>"
        )
    };
    let vtp = format!(
        "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"3\"><PointData>{}</PointData><Points>{}</Points>\
         </Piece></PolyData></VTKFile>",
        array("v", 1, "1 2 3 "),
        array("Points", 3, "0 0 0 5 0 0 9 0 0 "),
    );
    let bases: [Base; 6] = [
        vec![("a.csv", table.into())],
        vec![("a.tsv", degrees.into())],
        vec![("a.ply", words.into_bytes())],
        vec![("b.ply", little)],
        vec![("c.ply", big)],
        vec![("a.vtp", vtp.into_bytes())],
    ];
    let count = crate::survive::mutations();
    let folder = Folder::new();
    let (mut refused, mut read) = (0_u64, 0_u64);
    for number in 0..count {
        let base = &bases[(number % bases.len() as u64) as usize];
        let (name, bytes) = &base[0];
        let (mutated, mutation) = mutate(bytes, &mut Random::new(number));
        folder.write(name, &mutated);
        memory::start();
        let outcome = catch_unwind(AssertUnwindSafe(|| read_all(&folder, base)));
        let peak = memory::peak_since_start();
        let said = || format!("points mutation {number}: {mutation:?} of {name}");
        assert!(peak < 64 << 20, "{}: {peak} bytes", said());
        match outcome.unwrap_or_else(|_| panic!("{}: a panic", said())) {
            Ok(voxels) => {
                assert!(voxels <= 64 * 64 * 64, "{}: {voxels} voxels", said());
                read += 1;
            }
            Err(_) => refused += 1,
        }
    }
    println!("points: {count} mutations, {refused} refused, {read} read");
    assert!(
        refused > count / 4 && read > 0,
        "{refused} refused, {read} read"
    );
}

/// Files of an independent writer, tests/fixtures.
fn unpadded(format: &str, name: &'static str) -> Base {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    let mut bytes = std::fs::read(path.join(format).join(name)).unwrap();
    let folder = Folder::new();
    // Padding at the end belongs to nothing: without it every cut is a loss.
    loop {
        let shorter = vec![(name, bytes[..bytes.len() - 1].to_vec())];
        folder.write(name, &shorter[0].1);
        if read_all(&folder, &shorter).is_err() {
            return vec![(name, bytes)];
        }
        bytes.pop();
    }
}

#[test]
fn npy_survives_mutations() {
    let names = [
        "u2-be.npy",
        "f8-le.npy",
        "v3.npy",
        "colors.npy",
        "fortran-times.npy",
    ];
    survive("npy", &names.map(|name| unpadded("npy", name)));
}

#[test]
#[cfg(feature = "tiff")]
fn tiff_survives_mutations() {
    let names = [
        "raw-u2-be.tif",
        "big-be.tif",
        "lzw-u2-p2-be.tif",
        "deflate-f4-p3.tif",
        "packbits-u2.tif",
        "strips-lzw-be.tif",
        "tiles-deflate-p2-be.tif",
        "bits-1.tif",
        "rgb-planar.tif",
        "palette-u1.tif",
        "jpeg-ycbcr.tif",
        "jpeg-gray-tiles.tif",
        "thumbnails.tif",
    ];
    survive("tiff", &names.map(|name| unpadded("tiff", name)));
}

#[test]
#[cfg(feature = "tiff")]
fn ome_and_imagej_survive_mutations() {
    let names = [
        "ome-tzcyx.ome.tif",
        "ome-rgb.ome.tif",
        "ome-two.ome.tif",
        "imagej-hyper.tif",
        "imagej-rgb.tif",
    ];
    survive("ome", &names.map(|name| unpadded("tiff", name)));
}
