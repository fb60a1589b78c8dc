//! Runs of `stratavox conformance` as those who write drivers want them: lists of cases, repetitions, debuggers, and
//! comparisons with the last time.

use crate::person::{Folder, Ran};
use serde_json::Value;

const EXP: &str = "probe.math.exp";
const SQRT: &str = "probe.math.sqrt";
const DRAWN: &str = "raycast.ray.mip.ramp.nearest.f32.orthographic";

fn package(folder: &Folder, name: &str) -> Value {
    let text = std::fs::read_to_string(folder.path(name)).expect(name);
    serde_json::from_str(&text).expect("JSON")
}

/// Runs cases one after the other and reads the package.
fn run(folder: &Folder, words: &str) -> (Ran, Value) {
    let ran = folder.run(&format!(
        "conformance --json a.json --force --jobs 1 {words}"
    ));
    assert!(folder.path("a.json").exists(), "{ran:#?}");
    (ran, package(folder, "a.json"))
}

fn names(package: &Value) -> Vec<&str> {
    let cases = package["cases"].as_array().expect("cases").iter();
    cases.filter_map(|case| case["name"].as_str()).collect()
}

fn case<'p>(package: &'p Value, name: &str) -> &'p Value {
    let mut cases = package["cases"].as_array().expect("cases").iter();
    let found = cases.find(|case| case["name"] == name);
    found.unwrap_or_else(|| panic!("{name} in {package}"))
}

#[test]
fn a_case_list_is_run_in_its_order_without_what_is_excluded() {
    let folder = Folder::new();
    folder.file(
        "list",
        "# of mine\nprobe.math.sqrt\n\nprobe.math.ex*  # exp, exp2\nprobe.math.sqrt\n",
    );
    folder.file("not", "probe.math.exp2\nno.such.case\n");
    let (ran, first) = run(&folder, "--caselist list --exclude not");
    ran.assert_done();
    assert!(
        ran.err.contains("not, line 2") && ran.err.contains("no.such.case"),
        "{ran:#?}"
    );
    assert_eq!(names(&first), [SQRT, EXP]);
    folder
        .run("conformance verify --partial a.json")
        .assert_done();
    let listed = folder.run("conformance --list --caselist list --filter *sqrt|*exp --shard 2/2");
    assert_eq!(listed.out, "probe.math.exp\n", "{listed:#?}");

    folder.file("wrong", "probe.math.sqrt\nprobe.math.sqr\n");
    let ran = folder.run("conformance --caselist wrong");
    ran.assert_refused(3, &["wrong", "line 2", "probe.math.sqr"]);
    folder.file("full", "relation.sum.slices_3d.xray.perspective\n");
    let ran = folder.run("conformance --caselist full");
    assert!(ran.code == 3 && ran.err.contains("line 1"), "{ran:#?}");
    folder.file("empty", "# none\n");
    let ran = folder.run("conformance --caselist empty");
    ran.assert_refused(3, &["empty", "names no case"]);
}

#[test]
fn a_record_says_the_command_that_runs_it_again() {
    let folder = Folder::new();
    let words =
        format!("--filter {EXP} --seed 7 --limits vulkan-minimum --device cpu --timeout 50");
    let (ran, first) = run(&folder, &words);
    ran.assert_done();
    let command = case(&first, EXP)["command"].as_str().expect("a command");
    assert_eq!(
        command,
        "stratavox conformance --filter probe.math.exp --seed 7 --device cpu --limits vulkan-minimum --timeout 50"
    );
    let words = command.strip_prefix("stratavox conformance").expect("ours");
    let (ran, again) = run(&folder, words);
    ran.assert_done();
    assert_eq!(
        case(&first, EXP)["found_sha256"],
        case(&again, EXP)["found_sha256"]
    );
    let (ran, _) = run(&folder, &format!("--filter {EXP} --fault {EXP}=fail"));
    assert!(
        ran.err
            .contains("again: stratavox conformance --filter probe.math.exp --seed 1"),
        "{ran:#?}"
    );
}

#[test]
fn in_process_there_is_no_worker_and_the_numbers_are_the_same() {
    let folder = Folder::new();
    let filter = format!("--filter {EXP}|{SQRT} --json b.json");
    folder
        .run(&format!("conformance {filter} --in-process"))
        .assert_done();
    let alone = package(&folder, "b.json");
    let (_, worked) = run(&folder, &format!("--filter {EXP}|{SQRT}"));
    for name in [EXP, SQRT] {
        let [a, b] = [&alone, &worked].map(|package| &case(package, name)["found_sha256"]);
        assert_eq!(a, b, "{name}");
    }
    assert_eq!(alone["asked"]["in_process"], true);
    assert_eq!(alone["device"], worked["device"]);
    // What ends a worker ends the whole run here.
    let words = format!("conformance --filter {EXP} --in-process --fault {EXP}=exit --json c.json");
    let ran = folder.run(&words);
    assert_eq!(ran.code, 3, "{ran:#?}");
    assert!(!folder.path("c.json").exists());
    let ran = folder.run("conformance --in-process --jobs 2");
    assert_eq!(ran.code, 2, "{ran:#?}");
}

#[test]
fn repeated_cases_that_say_other_things_fail_and_stop_on_fail_ends_the_run() {
    let folder = Folder::new();
    let filter = "--filter probe.math.*";
    let (ran, good) = run(&folder, &format!("--filter {EXP}|{SQRT} --repeat 3"));
    ran.assert_done();
    assert_eq!(good["asked"]["repeat"], 3);
    let (ran, flaky) = run(
        &folder,
        &format!("{filter} --repeat 3 --stop-on-fail --fault {SQRT}=flake"),
    );
    assert_eq!(ran.code, 1, "{ran:#?}");
    let record = case(&flaky, SQRT);
    assert_eq!(record["runs"], serde_json::json!(["fail", "pass", "pass"]));
    let all = folder.run(&format!("conformance --list {filter}"));
    let before = all.out.lines().take_while(|name| *name != SQRT).count();
    assert_eq!(names(&flaky).len(), before + 1, "{ran:#?}");
    assert!(before + 1 < all.out.lines().count());
    assert_eq!(flaky["is_partial"], true);
    let ran = folder.run("conformance verify --partial a.json");
    assert!(
        ran.code == 1 && ran.out.contains("ended before all"),
        "{ran:#?}"
    );
}

#[test]
fn a_test_log_and_junit_say_each_verdict_by_its_name() {
    let folder = Folder::new();
    let words =
        format!("conformance --filter {EXP}|{SQRT} --qpa a.qpa --junit a.xml --fault {SQRT}=abort");
    let ran = folder.run(&words);
    assert_eq!(ran.code, 1, "{ran:#?}");
    let log = std::fs::read_to_string(folder.path("a.qpa")).expect("a.qpa");
    let crashed = log
        .split("#beginTestCaseResult probe.math.sqrt\n")
        .nth(1)
        .expect("the case");
    assert!(
        crashed.contains("<Result StatusCode=\"Crash\">ended by signal 6"),
        "{log}"
    );
    assert!(log.contains("CasePath=\"probe.math.exp\" CaseType=\"SelfValidate\""));
    let xml = std::fs::read_to_string(folder.path("a.xml")).expect("a.xml");
    for verdict in ["pass", "crash"] {
        let property = format!("<property name=\"verdict\" value=\"{verdict}\"/>");
        assert!(xml.contains(&property), "{xml}");
    }
    let ran = folder.run(&words);
    ran.assert_refused(4, &["a.xml", "it exists"]);
}

#[test]
fn failures_of_the_baseline_are_expected_and_others_are_regressions() {
    let folder = Folder::new();
    let filter = format!("--filter {EXP}|{SQRT}");
    let (ran, _) = run(&folder, &format!("{filter} --fault {EXP}=fail"));
    assert_eq!(ran.code, 1, "{ran:#?}");
    std::fs::rename(folder.path("a.json"), folder.path("last.json")).expect("renamed");
    let beside = format!("{filter} --baseline last.json");

    let (ran, same) = run(&folder, &format!("{beside} --fault {EXP}=fail"));
    ran.assert_done();
    assert_eq!(case(&same, EXP)["verdict"], "expected_failure");
    assert_eq!(case(&same, EXP)["baseline"], "fail");
    // Nobody is told that a device which fails is well.
    let ran = folder.run("conformance verify --partial a.json");
    assert!(
        ran.code == 1 && ran.out.contains("expected_failure"),
        "{ran:#?}"
    );
    // It is a baseline itself.
    std::fs::copy(folder.path("a.json"), folder.path("same.json")).expect("copied");
    let (ran, _) = run(
        &folder,
        &format!("{filter} --baseline same.json --fault {EXP}=fail"),
    );
    ran.assert_done();

    let (ran, worse) = run(&folder, &format!("{beside} --fault *=fail"));
    assert_eq!(ran.code, 1, "{ran:#?}");
    assert_eq!(case(&worse, SQRT)["verdict"], "fail");
    assert!(ran.out.contains("regression: probe.math.sqrt"), "{ran:#?}");
    let (ran, _) = run(&folder, &format!("{beside} --fault {EXP}=abort"));
    assert!(
        ran.code == 1 && ran.out.contains("other failure: probe.math.exp"),
        "{ran:#?}"
    );
    let (ran, _) = run(&folder, &beside);
    ran.assert_done();
    assert!(ran.out.contains("fixed: probe.math.exp"), "{ran:#?}");

    let ran = folder.run(&format!("conformance {beside} --seed 2"));
    ran.assert_refused(3, &["last.json", "seed", "wanted 2", "found 1"]);
}

#[test]
fn a_package_says_what_it_was_made_by_and_of_which_device() {
    let folder = Folder::new();
    let (ran, package) = run(&folder, &format!("--filter {EXP}"));
    ran.assert_done();
    let commit = package["build"]["commit"].as_str().expect("a commit");
    assert!(commit == "unknown" || commit.len() >= 40, "{commit}");
    let lock = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.lock")).expect("it");
    let hash = <sha2::Sha256 as sha2::Digest>::digest(lock);
    let hash: String = hash.iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(package["build"]["cargo_lock_sha256"], hash);
    let device = &package["device"];
    assert_eq!(device["features"]["synchronization2"], true);
    assert_eq!(device["extensions_enabled"], serde_json::json!([]));
    assert!(
        device["extensions_available"]
            .as_array()
            .is_some_and(|all| !all.is_empty())
    );
    for limit in [
        "maxTimelineSemaphoreValueDifference",
        "subPixelPrecisionBits",
        "memoryHeaps[0].size",
        "maxFramebufferWidth",
    ] {
        assert!(device["limits"][limit].is_u64(), "{limit}: {device}");
    }
}

#[test]
fn a_dump_has_shaders_with_their_text_buffers_and_pictures() {
    let folder = Folder::new();
    let words = format!("conformance --filter {EXP}|{DRAWN} --dump d");
    folder.run(&words).assert_done();
    let read =
        |path: &str| std::fs::read(folder.path(path)).unwrap_or_else(|e| panic!("{path}: {e}"));
    let text = |path: &str| String::from_utf8(read(path)).expect("text");
    assert!(read(&format!("d/{EXP}/probe_math.spv")).starts_with(&0x0723_0203u32.to_le_bytes()));
    assert!(text(&format!("d/{EXP}/probe_math.wgsl")).contains("fn main("));
    let commands = text(&format!("d/{EXP}/commands.txt"));
    for wanted in [
        "load probe/math",
        "dispatch probe/math: [",
        "write `",
        "read `",
        "submitted",
    ] {
        assert!(commands.contains(wanted), "{wanted}: {commands}");
    }
    let record: Value = serde_json::from_str(&text(&format!("d/{EXP}/record.json"))).expect("JSON");
    assert_eq!(record["name"], EXP);
    // Each file that the list names is there, and as long as it says.
    let files = commands
        .lines()
        .filter_map(|line| line.split_once(" bytes from byte "));
    let mut count = 0;
    for (before, after) in files {
        let bytes: usize = before
            .rsplit(' ')
            .next()
            .and_then(|n| n.parse().ok())
            .expect("a number");
        let name = after.split(", ").nth(1).expect("a name");
        assert_eq!(read(&format!("d/{EXP}/{name}")).len(), bytes, "{name}");
        count += 1;
    }
    assert!(count >= 2, "{commands}");
    for picture in ["expected", "found", "difference"] {
        assert!(read(&format!("d/{DRAWN}/{picture}.npy")).starts_with(b"\x93NUMPY"));
    }
    let left = std::fs::read_dir(folder.path("d")).expect("d").count();
    assert_eq!(left, 2);
    folder
        .run(&words)
        .assert_refused(4, &["probe.math.exp", "it exists"]);
    folder
        .run(&format!("{words} --force --in-process"))
        .assert_done();
}

#[test]
fn under_stress_each_thread_finds_what_one_has_found_alone() {
    let folder = Folder::new();
    // Those that submit by themselves are among them.
    let filter = format!("--filter {EXP}|{DRAWN}|probe.relay.submissions|probe.timeline_semaphore");
    let words = format!("{filter} --stress 2,3");
    let ran = folder.run(&format!("conformance {words} --json b.json"));
    ran.assert_done();
    let together = package(&folder, "b.json");
    assert_eq!(together["asked"]["stress"]["threads"], 3);
    let queues = together["asked"]["stress"]["queues"]
        .as_u64()
        .expect("a number");
    assert_eq!(ran.err.contains("take turns"), queues < 2, "{ran:#?}");
    let (_, alone) = run(&folder, &filter);
    for name in names(&alone) {
        let [a, b] = [&alone, &together].map(|package| &case(package, name)["found_sha256"]);
        assert_eq!(a, b, "{name}");
    }
    let ran = folder.run(&format!(
        "conformance {words} --json c.json --fault {EXP}=flake"
    ));
    assert_eq!(ran.code, 1, "{ran:#?}");
    let other = package(&folder, "c.json");
    let record = case(&other, EXP);
    assert_eq!(
        record["runs"],
        serde_json::json!(["fail", "pass", "pass", "pass"])
    );
    assert!(
        record["reason"]
            .as_str()
            .is_some_and(|text| text.contains("under stress, thread 0"))
    );
    let ran = folder.run(&format!("conformance --filter {EXP} --stress 2"));
    assert!(
        ran.code == 2 && ran.err.contains("QUEUES,THREADS"),
        "{ran:#?}"
    );
}

#[test]
fn what_is_too_large_for_a_device_is_not_supported_by_the_name_of_the_limit() {
    let folder = Folder::new();
    let [image, buffer] = [
        "probe.limits.large_image_3d.depth",
        "probe.limits.buffer_beyond_4_gib",
    ];
    let (ran, package) = run(
        &folder,
        &format!("--profile large --filter {image}|{buffer}"),
    );
    ran.assert_done();
    assert_eq!(case(&package, image)["verdict"], "pass");
    let record = case(&package, buffer);
    if record["verdict"] != "pass" {
        assert_eq!(record["verdict"], "not_supported", "{record}");
        let needs = record["needs"].as_array().expect("needs");
        assert!(
            needs
                .iter()
                .any(|need| need["device_has"] == false && need["name"].is_string())
        );
    }
    let command = case(&package, image)["command"]
        .as_str()
        .expect("a command");
    assert!(command.contains("--profile full"), "{command}");
    folder
        .run("conformance verify --partial a.json")
        .assert_done();
}
