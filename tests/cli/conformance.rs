//! `stratavox conformance` as a person and a server of continuous integration meet it.

use crate::person::{Folder, Ran};
use serde_json::Value;
use std::collections::BTreeSet;

/// Two small cases, and one that draws.
const FEW: &str = "probe.math.exp|probe.math.sqrt|raycast.ray.mip.ramp.nearest.f32.orthographic";
const DRAWN: &str = "raycast.ray.mip.ramp.nearest.f32.orthographic";

fn run(folder: &Folder, words: &str) -> (Ran, Value) {
    let ran = folder.run(&format!(
        "conformance --filter {FEW} --json a.json --force {words}"
    ));
    let text =
        std::fs::read_to_string(folder.path("a.json")).unwrap_or_else(|_| panic!("{ran:#?}"));
    (ran, serde_json::from_str(&text).expect("JSON"))
}

fn verdicts(package: &Value) -> Vec<(&str, &str)> {
    let cases = package["cases"].as_array().expect("cases");
    let pair = |case| {
        let of = |key: &str| -> &str {
            let case: &Value = case;
            case[key].as_str().expect("a word")
        };
        (of("name"), of("verdict"))
    };
    cases.iter().map(pair).collect()
}

#[test]
fn cases_have_names_of_their_own_and_the_baseline_is_a_part_of_all() {
    let folder = Folder::new();
    let list = |words: &str| {
        let ran = folder.run(&format!("conformance --list {words}"));
        ran.assert_done();
        let names: Vec<String> = ran.out.lines().map(str::to_owned).collect();
        let set: BTreeSet<String> = names.iter().cloned().collect();
        assert_eq!(set.len(), names.len(), "names that stand twice");
        set
    };
    let (baseline, full) = (list(""), list("--profile full"));
    assert!(baseline.len() > 500 && baseline.is_subset(&full) && full.len() > baseline.len());
    let parts = ["1/3", "2/3", "3/3"].map(|part| list(&format!("--shard {part}")));
    let together: BTreeSet<String> = parts.iter().flatten().cloned().collect();
    assert_eq!(
        parts.iter().map(BTreeSet::len).sum::<usize>(),
        baseline.len()
    );
    assert_eq!(together, baseline);
}

#[test]
fn what_cannot_be_asked_exits_2() {
    let folder = Folder::new();
    for (words, named) in [
        ("--filter nobody.knows", "nobody.knows"),
        ("--shard 4/3", "4/3"),
        ("--shard 0/3", "0/3"),
        ("--timeout 0", "--timeout"),
        ("--jobs 0", "--jobs"),
        ("--profile most", "most"),
    ] {
        let ran = folder.run(&format!("conformance {words}"));
        assert_eq!(ran.code, 2, "{words}: {ran:#?}");
        assert!(ran.err.contains(named), "{words}: {ran:#?}");
    }
    let ran = folder.run("conformance --device nobodys-card --filter probe.math.exp");
    ran.assert_refused(5, &["nobodys-card"]);
    folder.file("w.json", "{}");
    let ran = folder.run("conformance --waivers w.json --filter probe.math.exp");
    ran.assert_refused(3, &["w.json", "stratavox_waivers"]);
}

#[test]
fn a_run_is_written_as_records_for_a_server_and_as_a_page_and_is_the_same_twice() {
    let folder = Folder::new();
    let (ran, first) = run(&folder, "--junit a.xml --html page");
    ran.assert_done();
    assert_eq!(first["summary"]["pass"], 3, "{first}");
    for case in first["cases"].as_array().expect("cases") {
        assert!(
            case["bound"]["derivation"]
                .as_str()
                .is_some_and(|text| text.len() > 80),
            "{case}"
        );
        assert_eq!(case["found_sha256"].as_str().map(str::len), Some(64));
        let ratio = case["worst"]["ratio"].as_f64().expect("a ratio");
        assert!(ratio > 0.0 && ratio <= 1.0, "{case}");
    }
    let xml = std::fs::read_to_string(folder.path("a.xml")).expect("a.xml");
    assert!(
        xml.contains("tests=\"3\" failures=\"0\" errors=\"0\" skipped=\"0\""),
        "{xml}"
    );
    let page = std::fs::read_to_string(folder.path("page/index.html")).expect("a page");
    assert!(page.contains(DRAWN) && page.contains("subTexelPrecisionBits"));
    let names: Vec<&str> = verdicts(&first).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["probe.math.exp", "probe.math.sqrt", DRAWN]);
    for jobs in ["1", "2", "16"] {
        let (_, again) = run(&folder, &format!("--jobs {jobs}"));
        assert_eq!(first["content_sha256"], again["content_sha256"], "{jobs}");
    }
    let (_, other) = run(&folder, "--seed 2");
    assert_ne!(first["content_sha256"], other["content_sha256"]);
    // A part of the profile is no package.
    let ran = folder.run("conformance verify a.json");
    assert!(
        ran.code == 1 && ran.out.contains("is a part of the profile"),
        "{ran:#?}"
    );
    folder
        .run("conformance verify --partial a.json")
        .assert_done();
    folder.run("conformance diff a.json a.json").assert_done();
}

#[test]
fn what_dies_hangs_or_babbles_is_one_record_and_the_rest_go_on() {
    let folder = Folder::new();
    for (trouble, verdict, reason) in [
        ("abort", "crash", "signal 6"),
        ("exit", "crash", "exit code 3"),
        ("hang", "timeout", "not done after"),
        ("babble", "internal_error", "no record"),
        ("lose-device", "device_lost", "asked for"),
        ("fail", "fail", "asked for"),
    ] {
        let (ran, package) = run(
            &folder,
            &format!("--timeout 5 --fault probe.math.sqrt={trouble}"),
        );
        assert_eq!(ran.code, 1, "{trouble}: {ran:#?}");
        let found = verdicts(&package);
        let wanted = [
            ("probe.math.exp", "pass"),
            ("probe.math.sqrt", verdict),
            (DRAWN, "pass"),
        ];
        let found: BTreeSet<_> = found.into_iter().collect();
        assert_eq!(found, BTreeSet::from(wanted), "{trouble}");
        let cases = package["cases"].as_array().expect("cases");
        let case = cases
            .iter()
            .find(|case| case["name"] == "probe.math.sqrt")
            .expect("it");
        assert!(
            case["reason"]
                .as_str()
                .is_some_and(|text| text.contains(reason)),
            "{case}"
        );
        assert!(ran.err.contains("probe.math.sqrt"), "{ran:#?}");
    }
}

#[test]
fn a_case_that_passes_when_run_again_is_told_as_a_flake_and_stays_a_failure() {
    let folder = Folder::new();
    let (ran, package) = run(&folder, "--fault probe.math.exp=flake");
    assert_eq!(ran.code, 1, "{ran:#?}");
    let cases = package["cases"].as_array().expect("cases");
    let case = cases
        .iter()
        .find(|case| case["name"] == "probe.math.exp")
        .expect("it");
    assert_eq!(case["runs"], serde_json::json!(["fail", "pass"]), "{case}");
    assert!(
        case["reason"]
            .as_str()
            .is_some_and(|text| text.contains("flaky")),
        "{case}"
    );
}

#[test]
fn a_failure_is_shown_with_its_pictures() {
    let folder = Folder::new();
    let (ran, package) = run(&folder, &format!("--html page --fault {DRAWN}=fail"));
    assert_eq!(ran.code, 1, "{ran:#?}");
    let cases = package["cases"].as_array().expect("cases");
    let case = cases.iter().find(|case| case["name"] == DRAWN).expect("it");
    let pictures = case["pictures"].as_array().expect("pictures");
    assert_eq!(pictures.len(), 3, "{case}");
    let page = std::fs::read_to_string(folder.path("page/index.html")).expect("a page");
    for picture in pictures {
        let name = picture.as_str().expect("a name");
        assert!(page.contains(name), "{name}");
        let bytes = std::fs::read(folder.path(&format!("page/{name}"))).expect("a picture");
        assert!(bytes.starts_with(b"\x89PNG"), "{name}");
    }
}

#[test]
fn what_is_known_is_waived_and_told_where_it_does_not_come() {
    let folder = Folder::new();
    let waiver = |cases: &str| {
        let text = format!(
            r#"{{"stratavox_waivers": 1, "waivers": [{{"cases": "{cases}", "driver": "*", "verdicts": ["crash"],
            "reason": "known", "link": "https://example.org/1", "expires": "2999-12-31"}}]}}"#
        );
        folder.file("w.json", text);
    };
    waiver("probe.math.sqrt");
    let (ran, package) = run(&folder, "--waivers w.json --fault probe.math.sqrt=abort");
    ran.assert_done();
    assert!(
        verdicts(&package).contains(&("probe.math.sqrt", "waived")),
        "{package}"
    );
    waiver("probe.math.*");
    let (ran, package) = run(&folder, "--waivers w.json --fault probe.math.sqrt=abort");
    ran.assert_done();
    assert!(ran.out.contains("probe.math.exp passes"), "{ran:#?}");
    assert_eq!(package["summary"]["waived"], 1);
}
