//! Headers that promise more voxels, bytes, files or lines than there are.

use crate::Bombs;
use crate::nifti::Nifti;
use std::fs::File;

const NRRD: &str = "NRRD0004\ntype: ushort\nendian: little\n";

pub fn add(bombs: &mut Bombs) {
    nrrd(bombs);
    metaimage(bombs);
    nifti(bombs);
    numpy(bombs);
    vtk(bombs);
    raw(bombs);
    bricks(bombs);
    special(bombs);
}

fn nrrd(bombs: &mut Bombs) {
    let sizes = |sizes: &str, rest: &str| format!("{NRRD}dimension: 3\nsizes: {sizes}\n{rest}");
    let raw = "encoding: raw\n\nabcdef";
    bombs.volume("raw.nrrd", sizes("65535 65535 65535", raw), "");
    let beyond = "18446744073709551615 18446744073709551615 2";
    bombs.volume("overflow.nrrd", sizes(beyond, raw), "sizes");
    bombs.volume(
        "ascii.nrrd",
        sizes("65535 65535 4", "encoding: ascii\n\n1 2 3"),
        "",
    );
    bombs.volume(
        "hex.nrrd",
        sizes("65535 65535 4", "encoding: hex\n\n0102"),
        "",
    );
    let pattern = "encoding: raw\ndata file: part%d.raw 1 4000000000 1\n";
    bombs.volume("pattern.nhdr", sizes("2 2 4000000000", pattern), "");
    let skip = "encoding: raw\nbyte skip: 18446744073709551615\n\nabc";
    bombs.volume("skip.nrrd", sizes("3 2 1", skip), "");
    let lines = "line skip: 9000000000000000000\nencoding: raw\n\nabc";
    bombs.volume("lines.nrrd", sizes("3 2 1", lines), "");
    let comments = format!("{NRRD}{}", "# a comment\n".repeat(200_000));
    bombs.volume("comments.nrrd", comments, "");
}

fn metaimage(bombs: &mut Bombs) {
    let head = "ObjectType = Image\nNDims = 3\nElementType = MET_USHORT\n";
    let local = "ElementDataFile = LOCAL\nabcdef";
    let size = "DimSize = 65535 65535 65535\n";
    bombs.volume("raw.mha", format!("{head}{size}{local}"), "");
    let compressed = "CompressedData = True\nCompressedDataSize = 18446744073709551615\n";
    bombs.volume(
        "compressed.mha",
        format!("{head}{size}{compressed}{local}"),
        "",
    );
    let axes = "9 ".repeat(100_000);
    bombs.volume(
        "axes.mha",
        format!("NDims = 100000\nDimSize = {axes}\n{local}"),
        "",
    );
}

fn nifti(bombs: &mut Bombs) {
    let mut largest = Nifti::new(64, 64);
    largest.dim = [7, 32767, 32767, 32767, 32767, 32767, 32767, 32767];
    bombs.volume("dims.nii", largest.with(b"abc"), "");
    let mut second = largest.clone();
    second.version = 2;
    second.dim = [7, i64::MAX, i64::MAX, 2, 1, 1, 1, 1];
    bombs.volume("dims2.nii", second.with(b"abc"), "");
    second.dim = [200, 3, 2, 1, 1, 1, 1, 1];
    bombs.volume("rank.nii", second.with(b"abc"), "");
    let mut far = Nifti::new(2, 8);
    far.vox_offset = 1e30;
    bombs.volume("offset.nii", far.with(b"abcdef"), "");
    far.vox_offset = 1e12;
    bombs.volume(
        "offset.nii.gz",
        crate::encode::gzip(&far.with(b"abcdef")),
        "",
    );
}

fn numpy(bombs: &mut Bombs) {
    let file = |version: u8, length: u32, header: &str| {
        let mut bytes = b"\x93NUMPY".to_vec();
        bytes.extend([version, 0]);
        bytes.extend(&length.to_le_bytes()[..if version == 1 { 2 } else { 4 }]);
        bytes.extend(header.as_bytes());
        bytes
    };
    let header = |shape: &str| {
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}\n");
        file(2, header.len() as u32, &header)
    };
    bombs.volume(
        "shape.npy",
        header("(4294967295, 4294967295, 4294967295)"),
        "",
    );
    bombs.volume(
        "axes.npy",
        header(&format!("({})", "2,".repeat(20_000))),
        "",
    );
    bombs.volume("header.npy", file(2, u32::MAX, "{'descr': '<f8'"), "");
}

fn vtk(bombs: &mut Bombs) {
    let head = "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET STRUCTURED_POINTS\n";
    let size = "DIMENSIONS 65535 65535 65535\nORIGIN 0 0 0\nSPACING 1 1 1\n";
    let data = "POINT_DATA 281462092005375\nSCALARS a double 1\nLOOKUP_TABLE default\nabc";
    bombs.volume("dims.vtk", format!("{head}{size}{data}"), "");
    bombs.volume(
        "ascii.vtk",
        format!("{head}{size}{data}").replace("BINARY", "ASCII"),
        "",
    );
}

fn raw(bombs: &mut Bombs) {
    bombs.folder.write("lie.raw", b"abcdef");
    let sidecar =
        r#"{"dims": [65535, 65535, 65535], "type": "u16", "endian": "little", "file": "lie.raw"}"#;
    bombs.folder.write("lie.raw.json", sidecar);
    bombs.run("lie.raw", "info lie.raw.json", "");
    bombs.run("lie.raw", "info lie.raw --raw 65535x65535x65535,f64", "");
}

/// A file of ours with other numbers in its index.
fn bricks(bombs: &mut Bombs) {
    let folder = bombs.folder.path(".");
    let made = crate::limited::run(&folder, "convert phantom:fog,n=16 -o good.svb", 4 << 20);
    assert_eq!(made.code, Some(0), "{made:?}");
    let good = std::fs::read(bombs.folder.path("good.svb")).expect("bricks");
    let text = String::from_utf8_lossy(&good).into_owned();
    let at = good.windows(8).position(|part| part == b"dims: 16");
    let at = at.unwrap_or_else(|| panic!("no dims: {text}"));
    let mut lying = good.clone();
    lying[at + 6..at + 8].copy_from_slice(b"99");
    bombs.volume("dims.svb", lying, "");
    let mut far = good;
    // Where the index begins, and how long it is.
    far[24..32].copy_from_slice(&(1_u64 << 60).to_le_bytes());
    bombs.volume("index.svb", far, "");
}

/// What is no file, and what takes no room on the disk.
fn special(bombs: &mut Bombs) {
    bombs.run("/dev/zero", "info /dev/zero", "a device");
    let pipe = std::process::Command::new("mkfifo")
        .arg(bombs.folder.path("pipe.nrrd"))
        .status();
    assert!(pipe.expect("mkfifo").success());
    bombs.run("pipe.nrrd", "info pipe.nrrd", "a pipe");
    let sparse = |name: &str| {
        let file = File::create(bombs.folder.path(name)).expect("a file");
        file.set_len(16 << 30).expect("a length");
    };
    for name in [
        "sparse",
        "sparse.json",
        "sparse.nrrd",
        "sparse.dcm",
        "sparse.vti",
    ] {
        sparse(name);
    }
    for name in [
        "sparse",
        "sparse.json",
        "sparse.nrrd",
        "sparse.dcm",
        "sparse.vti",
    ] {
        bombs.run(name, &format!("info {name}"), "");
    }
}
