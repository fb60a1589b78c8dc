//! Every field of a header set to numbers that readers stumble over: 0, 1, -1, the greatest and the one before, NaN,
//! infinity, powers of two at the ends of integers. Each is an error, or a volume that the file's bytes can hold.
//!
//! Nothing is left out for the sake of time, as cuts are: all fields take all numbers in each run, so there is no long one.

use crate::survive::{Base, LIMITS, read_all};
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};
use stratavox::volume::ReadError;

/// What a read may take beyond the volume.
const BESIDE_BYTES: usize = 64 << 20;

/// A small file takes a millisecond.
const LONGEST: Duration = Duration::from_secs(2);

/// A byte of Deflate holds at most so many.
const MOST_EXPANSION: u64 = 1032;

const TEXTS: [&str; 10] = [
    "0",
    "1",
    "-1",
    "18446744073709551615",
    "18446744073709551614",
    "nan",
    "inf",
    "2147483648",
    "4294967296",
    "9223372036854775808",
];

/// The numbers in so many bytes, without those that are the same.
fn words(width: usize) -> Vec<Vec<u8>> {
    let top = 1_u64 << (8 * width - 1);
    let greatest = top | (top - 1);
    let mut numbers = vec![0, 1, greatest, greatest - 1, top, top - 1];
    match width {
        4 => numbers.extend([f32::NAN, f32::INFINITY].map(|n| u64::from(n.to_bits()))),
        8 => {
            numbers.extend([f64::NAN, f64::INFINITY].map(f64::to_bits));
            numbers.extend([1 << 31, 1 << 32]);
        }
        _ => {}
    }
    numbers
        .into_iter()
        .map(|number| number.to_le_bytes()[..width].to_vec())
        .collect()
}

/// A header's bytes with each word of `widths` bytes changed in turn.
fn with_words(bytes: &[u8], header: Range<usize>, widths: &[usize], is_big: bool) -> Vec<Vec<u8>> {
    let mut changed = Vec::new();
    for &width in widths {
        for at in header.clone().step_by(width) {
            for mut word in words(width) {
                if is_big {
                    word.reverse();
                }
                let mut bytes = bytes.to_vec();
                let Some(place) = bytes.get_mut(at..at + width) else {
                    continue;
                };
                place.copy_from_slice(&word);
                changed.push(bytes);
            }
        }
    }
    changed
}

/// A text with each of its numbers changed in turn.
fn with_numbers(text: &[u8]) -> Vec<Vec<u8>> {
    let is_digit = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-');
    let mut changed = Vec::new();
    let starts =
        (0..text.len()).filter(|&i| is_digit(&text[i]) && (i == 0 || !is_digit(&text[i - 1])));
    for start in starts {
        let digits = text[start..]
            .iter()
            .take_while(|byte| is_digit(byte))
            .count();
        for number in TEXTS {
            changed.push([&text[..start], number.as_bytes(), &text[start + digits..]].concat());
        }
    }
    changed
}

/// What became of the fields of one format.
struct Swept {
    format: &'static str,
    cases: usize,
    refused: usize,
    most_bytes: usize,
    longest: Duration,
}

impl Swept {
    fn new(format: &'static str) -> Self {
        Self {
            format,
            cases: 0,
            refused: 0,
            most_bytes: 0,
            longest: Duration::ZERO,
        }
    }

    /// Reads a changed file of `present` bytes with `read`; the whole one has `whole` voxels.
    fn read(
        &mut self,
        changed: &[u8],
        [whole, present]: [u64; 2],
        read: impl FnOnce() -> Result<u64, ReadError>,
    ) {
        crate::memory::start();
        let start = Instant::now();
        let outcome = catch_unwind(AssertUnwindSafe(read));
        let (took, bytes) = (start.elapsed(), crate::memory::peak_since_start());
        self.cases += 1;
        self.most_bytes = self.most_bytes.max(bytes);
        self.longest = self.longest.max(took);
        let failed = |what: &str| -> ! {
            let kept = std::env::temp_dir().join(format!("stratavox-field-{}", self.format));
            std::fs::write(&kept, changed).expect("a file");
            panic!(
                "{} case {}: {what}; kept as {kept:?}",
                self.format, self.cases
            );
        };
        match outcome {
            Err(_) => failed("a panic"),
            Ok(Err(_)) => self.refused += 1,
            Ok(Ok(voxels)) if voxels > whole.max(MOST_EXPANSION * present) => {
                failed(&format!("{voxels} voxels in {present} bytes"))
            }
            Ok(Ok(_)) => {}
        }
        if bytes > LIMITS.max_bytes as usize + BESIDE_BYTES {
            failed(&format!("{bytes} bytes of memory"));
        }
        if took > LONGEST {
            failed(&format!("{took:?}"));
        }
    }

    /// Puts each of `changes` in the place of the first file of `base`.
    fn sweep(&mut self, base: &Base, changes: Vec<Vec<u8>>) {
        let folder = crate::files::Folder::new();
        for (name, bytes) in base {
            folder.write(name, bytes);
        }
        let whole = read_all(&folder, base).unwrap_or_else(|e| panic!("{}: {e}", self.format));
        let beside: usize = base[1..].iter().map(|(_, bytes)| bytes.len()).sum();
        for changed in changes {
            folder.write(base[0].0, &changed);
            let present = (changed.len() + beside) as u64;
            self.read(&changed, [whole, present], || read_all(&folder, base));
        }
    }

    /// Prints the counts; fewer than `least` cases, or fields that are all passed over, are a failure.
    fn end(self, least: usize) -> usize {
        let Self {
            format,
            cases,
            refused,
            most_bytes,
            longest,
        } = self;
        println!(
            "{format}: {cases} fields, {refused} refused, {most_bytes} bytes of memory, {longest:?} at most"
        );
        assert!(cases >= least, "{format}: {cases} cases, wanted {least}");
        assert!(
            refused > cases / 20,
            "{format}: {refused} of {cases} refused"
        );
        cases
    }
}

fn fixture(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures")
        .join(name);
    std::fs::read(path).expect("a fixture")
}

/// Reads each changed header of a file whose header is text, `end` bytes long.
fn text(swept: &mut Swept, name: &'static str, bytes: Vec<u8>, end: usize) {
    let changes = with_numbers(&bytes[..end])
        .into_iter()
        .map(|header| [&header, &bytes[end..]].concat())
        .collect();
    swept.sweep(&vec![(name, bytes)], changes);
}

fn binary(
    swept: &mut Swept,
    name: &'static str,
    bytes: Vec<u8>,
    header: Range<usize>,
    widths: &[usize],
    is_big: bool,
) {
    let changes = with_words(&bytes, header, widths, is_big);
    swept.sweep(&vec![(name, bytes)], changes);
}

fn npy() -> usize {
    let mut swept = Swept::new("npy");
    for name in [
        "npy/f8-le.npy",
        "npy/i2-be.npy",
        "npy/times.npy",
        "npy/colors.npy",
        "npy/fortran-times.npy",
    ] {
        let bytes = fixture(name);
        let end = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
        let changes = with_numbers(&bytes[10..end]).into_iter().map(|text| {
            let length = (text.len() as u16).to_le_bytes();
            [&bytes[..8], &length, &text, &bytes[end..]].concat()
        });
        let changes = changes
            .chain(with_words(&bytes, 0..12, &[1, 2], false))
            .collect();
        swept.sweep(&vec![("a.npy", bytes)], changes);
    }
    swept.end(500)
}

fn netcdf() -> usize {
    let mut swept = Swept::new("netcdf");
    for name in ["netcdf/classic.nc", "netcdf/offset64.nc"] {
        binary(&mut swept, "a.nc", fixture(name), 0..600, &[4], true);
    }
    binary(
        &mut swept,
        "a.nc",
        fixture("netcdf/cdf5.nc"),
        0..800,
        &[4, 8],
        true,
    );
    binary(
        &mut swept,
        "a.nc",
        fixture("netcdf/packed.nc"),
        0..512,
        &[2, 4],
        false,
    );
    swept.end(2000)
}

fn raw() -> usize {
    let mut swept = Swept::new("raw");
    let sidecars = [
        r#"{"file": "a.raw", "dims": [5, 4, 3], "type": "i16", "endian": "little", "spacing": [1, 2, 0.5], "header_bytes": 2}"#,
        r#"{"file": "a.raw", "dims": [61, 1, 2], "type": "u8", "spacing": [0.5, 0.25, 3]}"#,
    ];
    for sidecar in sidecars {
        let voxels: Vec<u8> = (0..122).collect();
        let base = vec![("a.json", sidecar.into()), ("a.raw", voxels)];
        swept.sweep(&base, with_numbers(sidecar.as_bytes()));
    }
    swept.end(150)
}

#[cfg(feature = "zarr")]
fn zarr() -> usize {
    let mut swept = Swept::new("zarr");
    for name in [
        "v2-zlib",
        "v2-blosc-lz4-1",
        "v2-delta-f8",
        "v3-shards-start",
        "v3-transpose",
        "ngff-0.4",
        "ngff-0.5",
        "weather-v2",
        "weather-v3",
    ] {
        let parts = crate::zarr::files(name);
        let store = crate::zarr::Store::of(name);
        let read = || {
            let source = stratavox::format::open(&store.path(), &Default::default(), &LIMITS)?;
            let header = source.header();
            assert!(header.world_from_voxel.inverse().is_finite(), "{header:?}");
            source.read(Default::default(), header.whole())?;
            Ok(header.voxel_count())
        };
        let whole = read().unwrap_or_else(|e: ReadError| panic!("{name}: {e}"));
        // Chunks that are absent stand for voxels of one value, as many as the limits allow.
        let most = whole.max(LIMITS.max_bytes);
        for (key, bytes) in parts.iter().filter(|(_, bytes)| bytes.starts_with(b"{")) {
            for changed in with_numbers(bytes) {
                store.write(key, &changed);
                swept.read(&changed, [most, 0], read);
            }
            store.write(key, bytes);
        }
    }
    swept.end(1000)
}

fn others() -> usize {
    let mut cases = 0;
    let mut swept = Swept::new("nifti");
    let header = crate::nifti::Nifti::new(4, 16);
    binary(
        &mut swept,
        "a.nii",
        header.with(&[1; 12]),
        0..352,
        &[2, 4],
        false,
    );
    cases += swept.end(1500);
    let mut swept = Swept::new("tiff");
    for name in ["tiff/raw-u2-le.tif", "tiff/tiles-u2.tif"] {
        let bytes = fixture(name);
        let ifd = u32::from_le_bytes([bytes[4], bytes[5], bytes[6], bytes[7]]) as usize;
        let count = usize::from(u16::from_le_bytes([bytes[ifd], bytes[ifd + 1]]));
        let end = ifd + 2 + 12 * count + 4;
        let mut changes = with_words(&bytes, 0..8, &[2, 4], false);
        changes.extend(with_words(&bytes, ifd..end, &[2], false));
        changes.extend(with_words(&bytes, ifd + 2..end, &[4], false));
        swept.sweep(&vec![("a.tif", bytes)], changes);
    }
    cases += swept.end(1000);
    let mut swept = Swept::new("hdf5");
    binary(
        &mut swept,
        "a.h5",
        fixture("hdf5/earliest.h5"),
        0..768,
        &[1, 2, 4, 8],
        false,
    );
    cases += swept.end(2000);
    let mut swept = Swept::new("grib");
    binary(
        &mut swept,
        "a.grib2",
        fixture("grib/simple_11.grib2"),
        0..190,
        &[1, 4],
        true,
    );
    cases += swept.end(1000);
    let mut swept = Swept::new("nrrd");
    let header = "NRRD0005\ntype: short\ndimension: 3\nspace dimension: 3\nsizes: 5 4 3\n\
        space directions: (1.5,0,0) (0,1.5,0.25) (0,0,2)\nspace origin: (1,-2,3)\nendian: little\n\
        encoding: raw\n\n";
    text(
        &mut swept,
        "a.nrrd",
        [header.as_bytes(), &[1; 120]].concat(),
        header.len(),
    );
    cases += swept.end(150);
    let mut swept = Swept::new("metaimage");
    let header = "NDims = 3\nBinaryDataByteOrderMSB = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n\
        Offset = 1 -2 3\nElementSpacing = 1 1 2.5\nDimSize = 5 4 3\nElementNumberOfChannels = 1\n\
        ElementType = MET_SHORT\nElementDataFile = LOCAL\n";
    text(
        &mut swept,
        "a.mha",
        [header.as_bytes(), &[1; 120]].concat(),
        header.len(),
    );
    cases += swept.end(150);
    let mut swept = Swept::new("vtk");
    let bytes = fixture("vtk/type-int16-binary-42.vtk");
    let mark = b"LOOKUP_TABLE";
    let end = bytes
        .windows(mark.len())
        .position(|part| part == mark)
        .expect("a header");
    text(&mut swept, "a.vtk", bytes, end);
    cases + swept.end(100)
}

#[test]
fn a_field_of_any_number_is_refused_or_read_within_the_file() {
    let begun = Instant::now();
    let mut cases = npy() + netcdf() + raw() + others();
    #[cfg(feature = "zarr")]
    {
        cases += zarr();
    }
    println!("{cases} fields in {:.0} s", begun.elapsed().as_secs_f64());
    assert!(cases >= 6000, "{cases} fields");
}
