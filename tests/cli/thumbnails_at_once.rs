//! Stages that run at once: pictures and films are those of one after the other, whoever is faster; an interrupt ends
//! all stages; memory does not grow with the number of volumes.

use crate::person::Folder;
use crate::thumbnails::{nrrd, pictures};
use serde_json::Value;
use std::{collections::BTreeMap, fs};

const SMALL: &str = "--size 24x18 --device reference";

#[test]
fn times_are_read_one_by_one_where_there_is_memory_for_one() {
    let folder = Folder::new();
    for (name, more) in [("turn", "--turntable 7"), ("times", "")] {
        let film = format!(
            "animate phantom:storm,n=16,variable=u,times=4 --mode mip --times {more} {SMALL} -o"
        );
        folder.run(&format!("{film} {name}-a/%d.png")).assert_done();
        // A time is 6 KiB; between two of them lies a third.
        let bytes = if more.is_empty() { "10K" } else { "30K" };
        let ran = folder.run(&format!("{film} {name}-b/%d.png --max-memory {bytes}"));
        ran.assert_done();
        assert!(ran.err.contains("memory for one time alone"), "{ran:#?}");
        let [all, one] = ["a", "b"].map(|end| pictures_of(&folder, &format!("{name}-{end}")));
        assert!(all == one && !all.is_empty(), "{name}");
    }
}

#[test]
fn two_devices_draw_what_one_draws() {
    let folder = Folder::new();
    fs::create_dir(folder.path("in")).expect("a folder");
    for seed in 0..9 {
        folder.file(&format!("in/v{seed}.nrrd"), nrrd(6 + seed % 4, seed));
    }
    let words = "thumbnails in --size 24x18 -o";
    folder.run(&format!("{words} one")).assert_done();
    folder
        .run(&format!("{words} two --device 0 --device 0"))
        .assert_done();
    let (one, two) = (pictures(&folder.path("one")), pictures(&folder.path("two")));
    assert_eq!(one.len(), 9);
    assert!(one == two, "pictures of two devices differ");
    // A device is no other for what it drew before.
    for seed in [0, 5] {
        let words = format!("render in/v{seed}.nrrd --size 24x18 -o one.png --force");
        folder.run(&words).assert_done();
        let alone = fs::read(folder.path("one.png")).expect("a picture");
        assert!(one[&format!("v{seed}.png")] == alone, "v{seed}");
    }

    let film = "animate phantom:head,n=12 --turntable 7 --size 24x18 -o";
    folder.run(&format!("{film} a/%d.png")).assert_done();
    folder
        .run(&format!("{film} b/%d.png --device 0 --device 0"))
        .assert_done();
    assert!(
        pictures_of(&folder, "a") == pictures_of(&folder, "b"),
        "frames of two devices differ"
    );
    let storm = "animate phantom:storm,n=12,variable=u,times=5 --mode mip --times --size 24x18 -o";
    folder.run(&format!("{storm} c/%d.png")).assert_done();
    let ran = folder.run(&format!(
        "{storm} d/%d.png --device 0 --device 0 --timings t.json"
    ));
    ran.assert_done();
    assert!(
        pictures_of(&folder, "c") == pictures_of(&folder, "d"),
        "times of two devices differ"
    );
    let timings = fs::read(folder.path("t.json")).expect("timings");
    let timings: Value = serde_json::from_slice(&timings).expect("JSON");
    assert_eq!(timings["frames"].as_array().map(Vec::len), Some(5));
    assert!(timings["samples"].as_u64() > Some(0));
    // The same device is the same film.
    fs::remove_file(folder.path("d/3.png")).expect("removed");
    folder
        .run(&format!("{storm} d/%d.png --resume --device 0 --device 0"))
        .assert_done();
    assert!(pictures_of(&folder, "c") == pictures_of(&folder, "d"));
}

/// `make second` has two drivers, which see the hardware's filter differently.
#[test]
fn two_drivers_share_a_film_and_each_frame_is_that_of_one_of_them() {
    let folder = Folder::new();
    let there = folder.run("devices").out;
    let drivers = ["llvmpipe", "SwiftShader"];
    if !drivers.iter().all(|driver| there.contains(driver)) {
        println!("skipped: {drivers:?} are not both here");
        return;
    }
    let film = "animate phantom:head,n=64 --turntable 12 --size 96x96";
    let of_one = drivers.map(|driver| {
        let words = format!("{film} --device {driver} -o {driver}/%02d.png");
        folder.run(&words).assert_done();
        pictures_of(&folder, driver)
    });
    folder
        .run(&format!(
            "{film} --device llvmpipe --device SwiftShader -o both/%02d.png --timings t.json"
        ))
        .assert_done();
    let both = pictures_of(&folder, "both");
    assert_eq!(both.len(), 12);
    for (name, picture) in &both {
        let is_of_one = of_one.iter().any(|one| one[name] == *picture);
        assert!(is_of_one, "{name} is of neither driver");
    }
    let timings = fs::read_to_string(folder.path("t.json")).expect("timings");
    assert!(
        drivers.iter().all(|driver| timings.contains(driver)),
        "{timings}"
    );
}

fn pictures_of(folder: &Folder, name: &str) -> BTreeMap<String, Vec<u8>> {
    let mut all = pictures(&folder.path(name));
    all.retain(|name, _| name.ends_with(".png"));
    all
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_whole_pictures_and_resume_draws_the_rest() {
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};
    let folder = Folder::new();
    fs::create_dir(folder.path("in")).expect("a folder");
    for seed in 0..20 {
        folder.file(&format!("in/v{seed:02}.nrrd"), nrrd(5, seed));
    }
    let words = "thumbnails in -o out --size 72x72 --device reference";
    let mut child = folder
        .command(&format!("{words} --progress json"))
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let stderr = BufReader::new(child.stderr.take().expect("a pipe"));
    let mut lines = stderr.lines().map_while(Result::ok);
    assert!(
        lines.any(|line| line.contains("\"done\":3,")),
        "nothing is drawn"
    );
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.expect("kill runs").success());
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    let there = pictures(&folder.path("out"));
    assert!((3..20).contains(&there.len()), "{}", there.len());
    for (name, bytes) in there.iter().filter(|(name, _)| name.ends_with(".png")) {
        let picture = image::load_from_memory(bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!((picture.width(), picture.height()), (72, 72), "{name}");
    }
    folder.run(&format!("{words} --resume")).assert_done();
    assert_eq!(pictures_of(&folder, "out").len(), 20);
}

/// The most memory that the program had with these words, in bytes.
#[cfg(target_os = "linux")]
fn peak_of(folder: &Folder, words: &str) -> u64 {
    let mut child = folder.command(words).spawn().expect("the program runs");
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0;
    let code = loop {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kib = line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok());
        peak = peak.max(1024 * kib.unwrap_or(0));
        if let Some(status) = child.try_wait().expect("a child") {
            break status.code();
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    };
    assert_eq!(code, Some(0), "{words}");
    peak
}

#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_grow_with_the_number_of_volumes() {
    const SIDE: usize = 128;
    let folder = Folder::new();
    let header = format!(
        "NRRD0004\ntype: ushort\ndimension: 3\nsizes: {SIDE} {SIDE} {SIDE}\nendian: little\nencoding: raw\ndata file: "
    );
    // Voxels of zeros take no room on the disk, and in memory as much as others.
    let volume_bytes = (SIDE.pow(3) * 2) as u64;
    for (name, count) in [("few", 4), ("many", 40)] {
        fs::create_dir(folder.path(name)).expect("a folder");
        for k in 0..count {
            let data = fs::File::create(folder.path(&format!("{name}/{k}.bin"))).expect("a file");
            data.set_len(volume_bytes).expect("a length");
            folder.file(&format!("{name}/{k}.nhdr"), format!("{header}{k}.bin\n"));
        }
    }
    let words = "--size 16x16 --samples-per-voxel 0.1 --window 0,1 --progress none -o";
    let few = peak_of(&folder, &format!("thumbnails few {words} a"));
    let many = peak_of(&folder, &format!("thumbnails many {words} b"));
    println!("peak of 4 volumes: {few}, of 40: {many}");
    // 36 volumes more, each in memory and as a texture, would be 72 times as much as one.
    assert!(many <= few + 6 * volume_bytes, "{many}, of few {few}");
}
