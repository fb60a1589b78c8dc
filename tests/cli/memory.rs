//! What is refused, or reduced, where the memory is not there.

use super::person::Folder;
use serde_json::Value;
use std::fs::{self, File};
use std::io::Write;

const SIDE: u64 = 320;

/// 64 MiB of zeros that take no room on the disk, with one voxel that is not zero.
fn large(folder: &Folder) {
    use std::io::{Seek, SeekFrom};
    let mut file = File::create(folder.path("large.raw")).expect("a file");
    file.set_len(SIDE * SIDE * SIDE * 2).expect("a length");
    file.seek(SeekFrom::Start(SIDE * SIDE * SIDE))
        .expect("a seek");
    file.write_all(&[255, 3]).expect("a voxel");
}

#[test]
fn a_volume_without_room_is_refused_before_it_is_read_and_reduced_where_that_is_wanted() {
    let folder = Folder::new();
    large(&folder);
    let words = format!(
        "render large.raw --raw {SIDE}x{SIDE}x{SIDE},u16 --mode mip -o a.png --size 48x48 --device reference --max-memory 40M"
    );
    let ran = folder.run(&words);
    ran.assert_refused(6, &["large.raw", "62.5 MiB", "--fit"]);
    let ran = folder.run(&format!("{words} --fit"));
    ran.assert_done();
    let wanted = "reduced from 320 x 320 x 320 to 160 x 160 x 160 voxels";
    assert!(ran.err.contains(wanted), "{}", ran.err);
}

/// Peak of the host beside the device, in bytes, for a picture of `file`.
fn peak_beside_device(folder: &Folder, words: &str) -> u64 {
    let ran = folder.run(&format!("{words} --timings t.json --force"));
    ran.assert_done();
    let text = fs::read_to_string(folder.path("t.json")).expect("timings");
    let timings: Value = serde_json::from_str(&text).expect("JSON");
    let number = |key: &str| timings[key].as_u64().expect(key);
    println!(
        "{words}: peak {} device {}",
        number("peak_rss_bytes"),
        number("device_bytes")
    );
    // On a CPU driver the texture lies in the process: 16 bits a voxel, all of them written.
    number("peak_rss_bytes").saturating_sub(number("device_bytes").min(2 * SIDE.pow(3)))
}

#[cfg(target_os = "linux")]
#[test]
fn the_host_holds_little_more_than_the_voxels() {
    let folder = Folder::new();
    large(&folder);
    let voxels = SIDE.pow(3) * 2;
    let words = format!(
        "render large.raw --raw {SIDE}x{SIDE}x{SIDE},u16 -o a.png --size 64x64 --samples-per-voxel 0.1"
    );
    // A driver that compiles a shader for the first time holds 20 MB more: not what this is about.
    peak_beside_device(&folder, &words);
    let peak = peak_beside_device(&folder, &words);
    assert!(peak <= voxels * 13 / 10 + 200_000_000, "{peak}");

    let mut packed = flate2::write::GzEncoder::new(
        File::create(folder.path("large.nrrd.part")).expect("a file"),
        flate2::Compression::fast(),
    );
    let mut plain = File::open(folder.path("large.raw")).expect("a file");
    std::io::copy(&mut plain, &mut packed).expect("compressed");
    packed.finish().expect("compressed");
    let header = format!(
        "NRRD0004\ntype: ushort\ndimension: 3\nsizes: {SIDE} {SIDE} {SIDE}\nencoding: gzip\nendian: little\n\n"
    );
    let data = fs::read(folder.path("large.nrrd.part")).expect("a file");
    folder.file("large.nrrd", [header.as_bytes(), &data].concat());
    let words = "render large.nrrd -o a.png --size 64x64 --samples-per-voxel 0.1";
    let peak = peak_beside_device(&folder, words);
    assert!(peak <= voxels * 23 / 10 + 200_000_000, "{peak}");
}

#[test]
fn files_of_strangers_get_tight_limits() {
    let folder = Folder::new();
    let header = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n";
    folder.file("far.nhdr", format!("{header}data file: far.raw\n"));
    folder.file("far.raw", [1, 2, 3, 4, 5, 6, 7, 8]);
    folder.file("near.nrrd", [header.as_bytes(), b"\n12345678"].concat());
    folder.run("info far.nhdr").assert_done();
    folder.run("info near.nrrd --untrusted").assert_done();
    let ran = folder.run("info far.nhdr --untrusted");
    ran.assert_refused(3, &["far.nhdr", "names another file", "untrusted"]);

    let file = File::create(folder.path("b.raw")).expect("a file");
    file.set_len(1100 << 20).expect("a length");
    let words = "info b.raw --raw 1100x1024x1024,u8 --untrusted --max-memory 64G";
    folder
        .run(words)
        .assert_refused(6, &["b.raw", "1073741824"]);
}

/// A header and so many zeros, packed: a file a thousand times smaller than its volume.
fn zeros(folder: &Folder, name: &str, header: &[u8], bytes: u64, at_front: bool) {
    let file = File::create(folder.path(name)).expect("a file");
    let mut out = std::io::BufWriter::new(file);
    if !at_front {
        out.write_all(header).expect("a header");
    }
    let mut packed = flate2::write::GzEncoder::new(out, flate2::Compression::fast());
    if at_front {
        packed.write_all(header).expect("a header");
    }
    let plain = [0; 1 << 16];
    let mut left = bytes;
    while left > 0 {
        let now = left.min(plain.len() as u64);
        packed.write_all(&plain[..now as usize]).expect("zeros");
        left -= now;
    }
    packed.finish().expect("compressed");
}

/// Peak memory of `info`, in bytes, as the shell's limit of the address space allows it: more is refused by the system.
#[cfg(target_os = "linux")]
fn info_below(folder: &Folder, file: &str, limit_kib: u64) {
    let program = env!("CARGO_BIN_EXE_stratavox");
    let ran = std::process::Command::new("sh")
        .arg("-c")
        .arg(format!(
            "ulimit -v {limit_kib} && exec {program} info {file} --json"
        ))
        .current_dir(folder.path("."))
        .output()
        .expect("a shell");
    let err = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{file}: {:?} {err}", ran.status);
    let report: Value = serde_json::from_slice(&ran.stdout).expect("JSON");
    assert_eq!((&report["min"], &report["max"]), (&0.0.into(), &0.0.into()));
}

#[cfg(target_os = "linux")]
#[test]
fn info_takes_half_a_gigabyte_whatever_the_volume() {
    let folder = Folder::new();
    // 1.1 GB each; STRATAVOX_INFO_GB=12 is the long run.
    let gigabytes =
        std::env::var("STRATAVOX_INFO_GB").map_or(1, |word| word.parse().expect("a number"));
    let slices = 512 * gigabytes;
    let bytes = 1024 * 1024 * 2 * slices;
    let nrrd = format!(
        "NRRD0004\ntype: ushort\ndimension: 3\nsizes: 1024 1024 {slices}\nencoding: gzip\nendian: little\n\n"
    );
    zeros(&folder, "a.nrrd", nrrd.as_bytes(), bytes, false);
    let mut nifti = vec![0; 352];
    for (at, number) in [(0, 348_i32), (76, 0)] {
        nifti[at..at + 4].copy_from_slice(&number.to_le_bytes());
    }
    for (k, size) in [3, 1024, 1024, slices as i16].into_iter().enumerate() {
        nifti[40 + 2 * k..42 + 2 * k].copy_from_slice(&size.to_le_bytes());
        nifti[76 + 4 * k..80 + 4 * k].copy_from_slice(&1_f32.to_le_bytes());
    }
    nifti[70..74].copy_from_slice(&[4, 0, 16, 0]);
    nifti[108..112].copy_from_slice(&352_f32.to_le_bytes());
    nifti[344..348].copy_from_slice(b"n+1\0");
    zeros(&folder, "a.nii.gz", &nifti, bytes, true);
    let raw = File::create(folder.path("a.raw")).expect("a file");
    raw.set_len(bytes).expect("a length");
    for file in [
        "a.nrrd".to_owned(),
        "a.nii.gz".to_owned(),
        format!("a.raw --raw 1024x1024x{slices},u16"),
    ] {
        info_below(&folder, &file, 512 << 10);
    }
}

#[test]
fn a_size_of_memory_is_read_or_refused() {
    let folder = Folder::new();
    for word in ["lots", "-1G", "0"] {
        let ran = folder.run(&format!("info phantom:fog,n=8 --max-memory={word}"));
        ran.assert_refused(2, &["--max-memory", "512M"]);
    }
}
