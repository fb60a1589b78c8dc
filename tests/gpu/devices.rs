//! Which devices there are, which one is taken, and what is kept on disk for it.

use crate::gpu_shared::*;
use std::{fs, path::PathBuf, process::Command};
use stratavox::gpu::*;

fn new(choice: &DeviceChoice) -> Result<Headless, Error> {
    let options = Options {
        pipeline_cache: PipelineCache::Off,
        ..Options::default()
    };
    Headless::new(choice, &options)
}

#[test]
fn every_device_is_listed_with_what_it_can_do() {
    let devices = list_devices().unwrap();
    assert!(!devices.is_empty(), "no device, and no error");
    for device in &devices {
        println!("{device:#?}");
        let asked: Vec<_> = device.findings.iter().map(|f| f.requirement).collect();
        assert_eq!(asked, REQUIREMENTS, "everything was looked for");
        assert!(
            device.memory_bytes > 0,
            "{} has no memory",
            device.identity.name
        );
    }
    let kinds: Vec<_> = devices.iter().map(|device| device.identity.kind).collect();
    assert!(kinds.is_sorted(), "{kinds:?}");
    let first = devices
        .iter()
        .find(|device| device.is_usable())
        .expect("a usable device");
    assert_eq!(headless().gpu().identity(), &first.identity);
}

#[test]
fn a_device_is_found_by_each_kind_of_word() {
    let devices = list_devices().unwrap();
    for (index, device) in devices
        .iter()
        .enumerate()
        .filter(|(_, device)| device.is_usable())
    {
        let name = device.identity.name.to_uppercase();
        assert_eq!(
            new(&DeviceChoice::Name(name))
                .unwrap()
                .gpu()
                .identity()
                .name,
            device.identity.name
        );
        assert_eq!(
            new(&DeviceChoice::Index(index)).unwrap().gpu().identity(),
            &device.identity
        );
        let uuid = new(&DeviceChoice::Uuid(device.identity.uuid)).unwrap();
        assert_eq!(uuid.gpu().identity().uuid, device.identity.uuid);
    }
    match new(&DeviceChoice::Cpu) {
        Ok(cpu) => assert!(cpu.gpu().is_cpu(), "{:?}", cpu.gpu()),
        Err(error) => println!("skipped: {error}"),
    }
}

#[test]
fn a_device_that_is_not_there_is_refused_with_a_list_of_those_that_are() {
    let first = &list_devices().unwrap()[0];
    let cases = [
        (
            DeviceChoice::Name("no such device".into()),
            "name `no such device`",
        ),
        (DeviceChoice::Index(99), "index 99"),
        (
            DeviceChoice::Uuid([0xab; 16]),
            "uuid abababababababababababababababab",
        ),
    ];
    for (choice, wanted) in cases {
        let found = new(&choice)
            .map(|_| ())
            .expect_err("no such device")
            .to_string();
        let listed = format!(
            "0: {} ({})",
            first.identity.name,
            first.identity.kind.name()
        );
        assert!(found.contains(wanted) && found.contains(&listed), "{found}");
    }
}

#[test]
fn a_machine_without_a_driver_is_told_so() {
    const TEST: &str = "devices::a_machine_without_a_driver_is_told_so";
    if std::env::var_os("STRATAVOX_TEST_CHILD").is_some() {
        for refused in [
            list_devices().map(|_| ()),
            new(&DeviceChoice::Default).map(|_| ()),
        ] {
            println!("refused: {}", refused.expect_err("no driver"));
        }
        return;
    }
    let child = Command::new(std::env::current_exe().unwrap())
        .args([TEST, "--exact", "--nocapture"])
        .env("VK_DRIVER_FILES", "/nonexistent.json")
        .env("VK_ICD_FILENAMES", "/nonexistent.json")
        .env("STRATAVOX_TEST_CHILD", "1")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&child.stdout);
    let wanted =
        "refused: no Vulkan device: the loader works, but no installed driver offers a device";
    assert_eq!(said.matches(wanted).count(), 2, "{said}");
}

/// A folder of this test's own, empty at first.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&folder);
        Self(folder)
    }

    fn files(&self) -> Vec<PathBuf> {
        fs::read_dir(&self.0).map_or_else(
            |_| Vec::new(),
            |files| files.map(|file| file.unwrap().path()).collect(),
        )
    }

    /// Makes a device and a pipeline on it, with the cache in this folder.
    fn run(&self) {
        let pipeline_cache = PipelineCache::Folder(self.0.clone());
        let options = Options {
            pipeline_cache,
            ..Options::default()
        };
        let headless = Headless::new(&DeviceChoice::Default, &options).unwrap();
        ComputePipeline::new(headless.gpu(), &ramp()).unwrap();
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn pipelines_are_kept_in_one_file_a_device_and_a_second_run_leaves_it_as_it_is() {
    let folder = Folder::new("gpu_cache_kept");
    folder.run();
    let files = folder.files();
    assert_eq!(files.len(), 1, "{files:?}");
    let first = fs::read(&files[0]).unwrap();
    assert!(first.starts_with(b"stratavox pipelines 1\n"), "{first:?}");
    let written = fs::metadata(&files[0]).unwrap().modified().unwrap();
    folder.run();
    assert_eq!(folder.files(), files);
    let is_same = fs::read(&files[0]).unwrap() == first;
    let is_untouched = fs::metadata(&files[0]).unwrap().modified().unwrap() == written;
    assert!(
        !is_same || is_untouched,
        "the same bytes were written again"
    );
}

#[test]
fn a_corrupt_cache_file_is_replaced_and_stops_nothing() {
    let folder = Folder::new("gpu_cache_corrupt");
    folder.run();
    let file = folder.files().remove(0);
    let good = fs::read(&file).unwrap();
    let mut flipped = good.clone();
    *flipped.last_mut().unwrap() ^= 1;
    for corrupt in [&b""[..], b"not ours", &good[..good.len() - 1], &flipped] {
        fs::write(&file, corrupt).unwrap();
        folder.run();
        let found = fs::read(&file).unwrap();
        assert!(
            found.len() >= good.len() && found != corrupt,
            "{} bytes",
            found.len()
        );
        assert_eq!(folder.files(), std::slice::from_ref(&file));
    }
}

#[test]
fn a_cache_folder_that_cannot_be_made_stops_nothing() {
    let folder = Folder::new("gpu_cache_blocked");
    fs::create_dir_all(folder.0.parent().unwrap()).unwrap();
    fs::write(&folder.0, "a file where the folder should be").unwrap();
    folder.run();
    assert_eq!(
        fs::read(&folder.0).unwrap(),
        b"a file where the folder should be"
    );
    fs::remove_file(&folder.0).unwrap();
}
