//! What is refused, or reduced, where the memory is not there.

use super::person::Folder;
use serde_json::Value;
use std::fs::{self, File};

const SIDE: u64 = 320;

/// 64 MiB of zeros that take no room on the disk, with one voxel that is not zero.
fn large(folder: &Folder) {
    use std::io::{Seek, SeekFrom, Write};
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

#[test]
fn a_size_of_memory_is_read_or_refused() {
    let folder = Folder::new();
    for word in ["lots", "-1G", "0"] {
        let ran = folder.run(&format!("info phantom:fog,n=8 --max-memory={word}"));
        ran.assert_refused(2, &["--max-memory", "512M"]);
    }
}
