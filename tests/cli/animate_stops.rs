//! A film that is stopped: by Ctrl-C, by a kill at any moment. What is there is whole, and `--resume` ends where
//! an uninterrupted run does, byte for byte.

use crate::person::{Folder, Ran};
use std::{
    collections::BTreeMap,
    fs,
    io::{BufRead, BufReader},
    path::Path,
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

const FILM: &str =
    "animate phantom:head,n=24 --mode mip --turntable 24 --size 96x72 --device reference";

/// Names and bytes of what lies in a folder, journals left out.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let Ok(entries) = fs::read_dir(folder) else {
        return BTreeMap::new();
    };
    let named = entries.map(|entry| {
        let path = entry.expect("an entry").path();
        (
            path.file_name()
                .expect("a name")
                .to_string_lossy()
                .into_owned(),
            path,
        )
    });
    named
        .filter(|(name, _)| !name.ends_with(".journal"))
        .map(|(name, path)| (name, fs::read(&path).expect("a file")))
        .collect()
}

/// Numbers from 0 to 1 that are the same in every run (Knuth's MMIX generator).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn spawn(folder: &Folder, words: &str) -> Child {
    let mut command = folder.command(words);
    command.stderr(Stdio::null()).stdout(Stdio::null());
    command.spawn().expect("the program runs")
}

/// Kills the film `output` at `kills` random moments, goes on with it, and compares it with an uninterrupted one.
fn killed_and_resumed(kills: u32, output: &str, of: impl Fn(&Folder) -> BTreeMap<String, Vec<u8>>) {
    let whole = Folder::new();
    let start = Instant::now();
    whole.run(&format!("{FILM} -o {output}")).assert_done();
    let takes = start.elapsed();
    let wanted = of(&whole);
    assert!(!wanted.is_empty());
    let mut random = Random(7);
    let (mut in_between, mut again) = (0, 0);
    for kill in 0..kills {
        let folder = Folder::new();
        let mut child = spawn(&folder, &format!("{FILM} -o {output}"));
        std::thread::sleep(takes.mul_f64(random.next()));
        child.kill().expect("killed");
        let ended = child.wait().expect("an end").success();
        let there = of(&folder);
        for (name, bytes) in there.iter().filter(|(name, _)| !name.starts_with('.')) {
            assert!(
                wanted.get(name) == Some(bytes),
                "kill {kill}: {name} is not whole"
            );
        }
        let is_between = !ended
            && fs::read_dir(folder.path("."))
                .expect("a folder")
                .next()
                .is_some();
        in_between += u32::from(is_between);
        // Every third film is killed twice.
        if kill % 3 == 0 && is_between {
            let mut child = spawn(&folder, &format!("{FILM} -o {output} --resume"));
            std::thread::sleep(takes.mul_f64(0.5 * random.next()));
            child.kill().expect("killed");
            child.wait().expect("an end");
            again += 1;
        }
        let ran = folder.run(&format!("{FILM} -o {output} --resume"));
        let is_whole = ran.err.contains("it exists");
        assert!(ran.code == 0 || is_whole, "kill {kill}: {ran:?}");
        assert!(
            of(&folder) == wanted,
            "kill {kill}: {:?}",
            of(&folder).keys()
        );
    }
    println!(
        "{kills} kills of {output} ({in_between} in the middle, {again} killed again): all resumed to the same bytes"
    );
    // How many depends on what else the machine does; none would have tried nothing.
    assert!(in_between > 0, "none of {kills} kills hit the middle");
}

#[cfg(debug_assertions)]
const SMALL_FILM: &str =
    "animate phantom:fog,n=8 --mode mip --turntable 24 --size 16x12 --device reference";

/// Stops the film `output` after each number of frames from 1 to 20, goes on with it, and compares.
#[cfg(debug_assertions)]
fn stopped_after_each_frame(output: &str) {
    let whole = Folder::new();
    whole
        .run(&format!("{SMALL_FILM} -o {output}"))
        .assert_done();
    let frames_of = |folder: &Folder| {
        let hidden = fs::read_dir(folder.path("."))
            .expect("a folder")
            .map(|entry| entry.expect("an entry").path())
            .find(|path| path.is_dir());
        contents(&hidden.expect("a folder of frames"))
    };
    let wanted = |folder: &Folder| match output.contains('/') {
        true => contents(&folder.path("frames")),
        false => contents_of_files(&folder.path(".")),
    };
    for frames in 1..=20 {
        let folder = Folder::new();
        let mut command = folder.command(&format!("{SMALL_FILM} -o {output}"));
        command.env("STRATAVOX_STOP_AFTER_FRAMES", frames.to_string());
        let ended = command.output().expect("the program runs");
        assert_eq!(ended.status.code(), None, "frame {frames}: {ended:?}");
        // Another thread may have written its frame, which is not in the journal yet.
        let there = frames_of(&folder).len();
        assert!(
            (frames..24).contains(&there),
            "{there} frames after {frames}"
        );
        assert!(output.contains('/') || !folder.path(output).exists());
        let ran = folder.run(&format!("{SMALL_FILM} -o {output} --resume"));
        ran.assert_done();
        assert!(wanted(&folder) == wanted(&whole), "stopped after {frames}");
    }
    println!("{output}: stopped after each of 20 frames, resumed to the same bytes");
}

#[cfg(debug_assertions)]
#[test]
fn a_film_stopped_after_any_frame_goes_on_to_the_same_bytes() {
    for output in ["frames/%04d.png", "film.gif"] {
        stopped_after_each_frame(output);
    }
}

#[test]
fn a_sequence_killed_at_8_moments_goes_on_to_the_same_bytes() {
    killed_and_resumed(8, "frames/%04d.png", |folder| {
        contents(&folder.path("frames"))
    });
}

#[test]
fn a_film_killed_at_some_moments_goes_on_to_the_same_bytes() {
    for output in ["film.gif", "film.apng"] {
        let of = |folder: &Folder| {
            let mut there = contents_of_files(&folder.path("."));
            // Frames on the way lie in a hidden folder; the film itself is whole or not there.
            there.retain(|name, _| !name.starts_with('.'));
            there
        };
        killed_and_resumed(4, output, of);
    }
}

fn contents_of_files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path());
    let files = entries.filter(|path| path.is_file());
    files
        .map(|path| {
            (
                path.file_name()
                    .expect("a name")
                    .to_string_lossy()
                    .into_owned(),
                fs::read(&path).expect("a file"),
            )
        })
        .collect()
}

/// Starts a film too long to end, waits for some frames, and sends it a signal.
fn interrupted(folder: &Folder, words: &str, signal: &str) -> Duration {
    let mut child = folder
        .command(words)
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let stderr = BufReader::new(child.stderr.take().expect("a pipe"));
    let third = stderr
        .lines()
        .map_while(Result::ok)
        .find(|line| line.contains("\"done\":3,"));
    assert!(third.is_some(), "the program draws nothing");
    let start = Instant::now();
    let kill = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .status();
    assert!(kill.expect("kill runs").success());
    let status = child.wait().expect("an end");
    assert_eq!(status.code(), Some(130), "{signal}: {status:?}");
    start.elapsed()
}

const LONG: &str =
    "animate phantom:head,n=24 --turntable 5000 --size 64x48 --device reference --progress json";

#[test]
fn an_interrupt_leaves_whole_frames_and_no_half_film() {
    let folder = Folder::new();
    for (signal, output) in [("-INT", "a/%d.png"), ("-TERM", "b/%d.png")] {
        let took = interrupted(&folder, &format!("{LONG} -o {output}"), signal);
        println!("{signal}: an end after {took:?}");
        let frames = contents(&folder.path(&output[..1]));
        assert!(frames.len() >= 3, "{:?}", frames.keys());
        for (name, bytes) in &frames {
            let decoder = png::Decoder::new(std::io::Cursor::new(bytes.as_slice()));
            let mut reader = decoder
                .read_info()
                .unwrap_or_else(|e| panic!("{name}: {e}"));
            let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
            reader
                .next_frame(&mut pixels)
                .unwrap_or_else(|e| panic!("{name}: {e}"));
        }
    }
    interrupted(&folder, &format!("{LONG} -o film.gif"), "-INT");
    assert!(!folder.path("film.gif").exists());
    let ran = folder.run(&format!("{LONG} -o film.gif --progress none"));
    ran.assert_refused(2, &["--progress"]);
    let ran = folder.run(&LONG.replace("--progress json", "-o film.gif"));
    ran.assert_refused(4, &["of 5000 frames are there", "--resume"]);
}

/// A film of 4 frames whose last one is missing.
fn stopped(folder: &Folder) {
    folder.file("a.raw", (0..64).map(|i| 3 * i).collect::<Vec<u8>>());
    folder.run(STOPPED).assert_done();
    fs::remove_file(folder.path("3.png")).expect("a frame");
}

const STOPPED: &str =
    "animate a.raw --raw 4x4x4,u8 --turntable 4 --size 16x12 --device reference -o %d.png";

#[test]
fn a_changed_scene_or_input_is_refused_with_the_reason() {
    let folder = Folder::new();
    stopped(&folder);
    let before = contents(&folder.path("."));
    let refused = |words: &str, said: &[&str]| {
        folder
            .run(&format!("{words} --resume"))
            .assert_refused(2, said);
        assert!(contents(&folder.path(".")) == before, "{words}");
    };
    refused(
        &format!("{STOPPED} --zoom 2"),
        &["scene.camera.zoom", "was null, is 2.0", "--force"],
    );
    refused(&STOPPED.replace("16x12", "16x16"), &["scene.picture.size"]);
    refused(
        &STOPPED.replace("turntable 4", "turntable 5"),
        &["frames", "was 4, is 5"],
    );
    refused(
        &format!("{STOPPED} --bit-depth 16"),
        &["bits", "was 8, is 16"],
    );
    refused(&STOPPED.replace("4x4x4", "2x8x4"), &["header"]);

    // Other voxels: a later change of the file is enough to doubt it.
    std::thread::sleep(Duration::from_millis(20));
    folder.file("a.raw", (0..64).map(|i| 189 - 3 * i).collect::<Vec<u8>>());
    let ran = folder.run(&format!("{STOPPED} --resume"));
    ran.assert_refused(2, &["input"]);
    // By force it begins anew.
    folder
        .run(&format!("{STOPPED} --resume --force"))
        .assert_done();
    assert!(contents(&folder.path("."))["0.png"] != before["0.png"]);
}

#[test]
fn other_voxels_behind_the_same_header_are_found() {
    let folder = Folder::new();
    let head = "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\n\
                ElementByteOrderMSB = False\nElementDataFile = b.raw\n";
    folder.file("b.mhd", head);
    folder.file("b.raw", (0..64).collect::<Vec<u8>>());
    let film = "animate b.mhd --turntable 3 --size 16x12 --device reference -o %d.png";
    folder.run(film).assert_done();
    fs::remove_file(folder.path("1.png")).expect("a frame");
    folder.file("b.raw", (64..128).collect::<Vec<u8>>());
    folder
        .run(&format!("{film} --resume"))
        .assert_refused(2, &["other voxels"]);
}

#[test]
fn only_what_is_missing_or_damaged_is_drawn_again() {
    let folder = Folder::new();
    stopped(&folder);
    let stamp = |name: &str| {
        fs::metadata(folder.path(name))
            .and_then(|data| data.modified())
            .expect("a time")
    };
    let third = folder.run(STOPPED);
    third.assert_refused(4, &["4 of 4 frames are there", "--resume"]);
    let whole = {
        let folder = Folder::new();
        stopped(&folder);
        folder.run(&format!("{STOPPED} --resume")).assert_done();
        contents(&folder.path("."))
    };
    let first = stamp("0.png");
    folder.file("1.png", "damaged");
    folder.run(&format!("{STOPPED} --resume")).assert_done();
    assert!(contents(&folder.path(".")) == whole);
    assert_eq!(stamp("0.png"), first, "a whole frame was drawn again");
    let again: Ran = folder.run(&format!("{STOPPED} --resume"));
    again.assert_done();
    assert!(again.err.contains("all frames are there"), "{again:?}");
}
