//! Streams that unpack to gigabytes.

use crate::Bombs;
use crate::encode::{bzip2, gzip, zlib};
use crate::nifti::Nifti;
use crate::tiff::{Page, Value};

/// Bytes that come out of each stream.
pub const UNPACKED: usize = 2 << 30;
const PART: usize = 16 << 20;

/// Copies of a member that unpacks to 16 MiB of zeros.
fn members(member: &[u8]) -> Vec<u8> {
    member.repeat(UNPACKED / PART)
}

/// One Zstandard frame of blocks that each repeat a byte, RFC 8878, 3.1.1.
pub fn zstd() -> Vec<u8> {
    const BLOCK: usize = 128 << 10;
    let mut frame = vec![0x28, 0xb5, 0x2f, 0xfd];
    // No content size, no checksum; a window of 8 MiB.
    frame.extend([0, (23 - 10) << 3]);
    let blocks = UNPACKED / BLOCK;
    for block in 0..blocks {
        let header = (BLOCK << 3) | (1 << 1) | usize::from(block + 1 == blocks);
        frame.extend(&(header as u32).to_le_bytes()[..3]);
        frame.push(0);
    }
    frame
}

/// One zlib stream of zeros, RFC 1950: a part that ends at a byte, many times, then an empty last block and Adler-32.
pub fn long_zlib() -> Vec<u8> {
    let mut encoder = flate2::Compress::new(flate2::Compression::best(), false);
    let mut part = Vec::with_capacity(PART);
    let flush = flate2::FlushCompress::Full;
    encoder
        .compress_vec(&vec![0; PART], &mut part, flush)
        .expect("zeros");
    let mut stream = vec![0x78, 0xda];
    stream.extend(part.repeat(UNPACKED / PART));
    stream.extend([3, 0]);
    let sums = [(UNPACKED % 65521) as u16, 1];
    stream.extend(sums.iter().flat_map(|sum| sum.to_be_bytes()));
    stream
}

/// Codes of TIFF's LZW: each adds a string one longer than the one before.
pub fn lzw() -> Vec<u8> {
    let (mut bytes, mut held, mut bits) = (Vec::new(), 0_u32, 0);
    let mut put = |code: u32, width: u32| {
        held = (held << width) | code;
        bits += width;
        while bits >= 8 {
            bits -= 8;
            bytes.push((held >> bits) as u8);
            held &= (1 << bits) - 1;
        }
    };
    for _ in 0..UNPACKED / (7 << 20) {
        put(256, 9);
        put(0, 9);
        for code in 258..4094 {
            // The width changes one code early.
            put(code, 32 - u32::leading_zeros(code + 1).min(23));
        }
    }
    put(257, 12);
    put(0, 7);
    bytes
}

pub fn add(bombs: &mut Bombs) {
    let zeros = vec![0; PART];
    let nrrd = |encoding: &str, sizes: &str, data: &[u8]| {
        let head = format!(
            "NRRD0004\ntype: uchar\ndimension: 3\nsizes: {sizes}\nencoding: {encoding}\n\n"
        );
        [head.as_bytes(), data].concat()
    };
    let gzipped = members(&gzip(&zeros));
    let bzipped = members(&bzip2(&zeros));
    let long = long_zlib();
    bombs.volume("small.gzip.nrrd", nrrd("gzip", "3 2 1", &gzipped), "");
    bombs.volume("small.bzip2.nrrd", nrrd("bzip2", "3 2 1", &bzipped), "");
    bombs.volume(
        "large.gzip.nrrd",
        nrrd("gzip", "65535 65535 65535", &gzip(b"ab")),
        "",
    );
    bombs.volume(
        "large.bzip2.nrrd",
        nrrd("bzip2", "65535 65535 65535", &bzip2(b"ab")),
        "",
    );
    // A volume of 2 GiB, and a limit below it: the file is right.
    bombs
        .folder
        .write("right.nrrd", nrrd("gzip", "2048 1024 1024", &gzipped));
    let limit = "--max-memory 64M --device reference --size 16x16";
    bombs.run(
        "right.nrrd",
        &format!("render right.nrrd -o a.png {limit}"),
        "memory",
    );
    bombs.run(
        "right.nrrd",
        "convert right.nrrd -o a.nrrd --max-memory 64M",
        "memory",
    );

    let mha = "NDims = 3\nDimSize = 3 2 1\nElementType = MET_UCHAR\nCompressedData = True\n";
    let mha = [mha.as_bytes(), b"ElementDataFile = LOCAL\n", &long].concat();
    bombs.volume("zlib.mha", mha, "");

    let nifti = Nifti::new(2, 8).with(&[0; 6]);
    bombs.volume("small.nii.gz", [gzip(&nifti), gzipped].concat(), "");

    vti(bombs, &long);

    let page = |compression: u16, strip: Vec<u8>| {
        let page = Page::gray(4, 4, strip).with(259, Value::Short(compression));
        crate::tiff::file(&[page], None)
    };
    bombs.volume("deflate.tif", page(8, long), "");
    bombs.harmless("lzw.tif", page(5, lzw()));
    bombs.volume("zstd.tif", page(50000, zstd()), "");
    bombs.harmless("packbits.tif", page(32773, [0x81, 0].repeat(1 << 20)));
}

/// Compressed blocks of VTK: how many, their size, that of the last, then of each compressed.
fn vti(bombs: &mut Bombs, long: &[u8]) {
    let file = |compressor: &str, header: &[u64], data: &[u8]| {
        let head = format!(
            "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
             compressor=\"{compressor}\"><ImageData WholeExtent=\"0 3 0 3 0 3\" Origin=\"0 0 0\" Spacing=\"1 1 1\">\
             <Piece Extent=\"0 3 0 3 0 3\"><PointData Scalars=\"a\"><DataArray type=\"UInt8\" Name=\"a\" \
             format=\"appended\" offset=\"0\"/></PointData></Piece></ImageData>\
             <AppendedData encoding=\"raw\">_"
        );
        let numbers: Vec<u8> = header.iter().flat_map(|n| n.to_le_bytes()).collect();
        let tail: &[u8] = b"</AppendedData></VTKFile>";
        [head.as_bytes(), &numbers, data, tail].concat()
    };
    let zlib_words = "vtkZLibDataCompressor";
    let length = long.len() as u64;
    bombs.volume(
        "stream.vti",
        file(zlib_words, &[1, 64, 0, length], long),
        "",
    );
    bombs.volume(
        "blocks.vti",
        file(zlib_words, &[1 << 60, 64, 0, 9], &zlib(b"a")),
        "",
    );
    bombs.volume(
        "size.vti",
        file(zlib_words, &[1, 1 << 50, 0, 9], &zlib(b"a")),
        "",
    );
    bombs.volume(
        "lz4.vti",
        file("vtkLZ4DataCompressor", &[1, 1 << 50, 0, 9], &[0xff; 99]),
        "",
    );
    bombs.volume(
        "xz.vti",
        file("vtkLZMADataCompressor", &[1, 1 << 50, 0, 9], &[0xfd; 99]),
        "LZMA",
    );
    // Literals 1, then a match of the byte before, 255 for each byte of its length.
    let mut matched = vec![0x1f, 0, 1, 0];
    matched.extend(vec![255; 8 << 20]);
    matched.extend([0, 0x50, 0, 0, 0, 0, 0]);
    let length = matched.len() as u64;
    bombs.volume(
        "match.vti",
        file("vtkLZ4DataCompressor", &[1, 64, 0, length], &matched),
        "",
    );
}
