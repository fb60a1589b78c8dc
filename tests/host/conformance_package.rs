//! Packages are looked through as ones that somebody handed in, and two are compared. No device is asked.

use serde_json::Value;
use stratavox::conformance::case::{Case, Profile};
use stratavox::conformance::difference::Difference;
use stratavox::conformance::measurement::{Bound, Measurement, Worst};
use stratavox::conformance::need::Found;
use stratavox::conformance::record::{Asked, Build, DeviceRecord, Package, Record, Stress};
use stratavox::conformance::report::{html, junit, qpa};
use stratavox::conformance::selection::Selection;
use stratavox::conformance::tree::cases;
use stratavox::conformance::verdict::Verdict;

fn device() -> DeviceRecord {
    DeviceRecord {
        name: "a <device>".into(),
        kind: "cpu".into(),
        driver: "a driver".into(),
        driver_id: 0,
        driver_info: "1.2.3".into(),
        driver_version: 1,
        vulkan: "1.3.0".into(),
        vendor_id: 1,
        device_id: 2,
        uuid: "00".into(),
        ..DeviceRecord::default()
    }
}

fn whole(list: &[Case], change: impl FnOnce(&mut Vec<Record>)) -> Package {
    let all = Selection::all(Profile::Baseline).of(list).into_iter();
    let passed = |case: &Case| Record {
        command: format!("stratavox conformance --filter {} --seed 1", case.name),
        ..Record::unmeasured(&case.name, case.profile, Verdict::Pass, String::new())
    };
    let mut records = all.map(passed).collect();
    change(&mut records);
    let asked = Asked {
        selection: Selection::all(Profile::Baseline),
        seed: 1,
        limits: "device".into(),
        repeat: 1,
        in_process: false,
        stress: None,
    };
    let build = Build {
        commit: "0123456789".into(),
        cargo_lock_sha256: "0".repeat(64),
    };
    Package::new(list, build, asked, Some(device()), records, 1.0)
}

/// As it comes out of a file.
fn read(package: &Package) -> Package {
    serde_json::from_str(&serde_json::to_string_pretty(package).unwrap()).unwrap()
}

#[test]
fn a_whole_package_has_nothing_to_complain_of_and_each_change_is_named() {
    let list = cases();
    let good = read(&whole(&list, |_| {}));
    assert_eq!(good.complaints(&list), [""; 0]);
    let named = |package: Package, word: &str| {
        let complaints = package.complaints(&list);
        assert!(
            complaints.iter().any(|c| c.contains(word)),
            "{word}: {complaints:?}"
        );
    };
    named(
        whole(&list, |records| drop(records.pop())),
        "the run ended before all",
    );
    named(
        whole(&list, |records| records[0].command.clear()),
        "no command line",
    );
    named(
        whole(&list, |records| {
            records[0].verdict = Verdict::ExpectedFailure
        }),
        "expected_failure",
    );
    named(
        whole(&list, |records| records.push(records[0].clone())),
        "stands 2 times",
    );
    named(
        whole(&list, |records| records[0].name = "other".into()),
        "is no case of this list",
    );
    named(
        whole(&list, |records| records[0].verdict = Verdict::Crash),
        "crash",
    );
    named(
        whole(&list, |records| records[0].verdict = Verdict::NotSupported),
        "nothing named",
    );
    let changed = |change: fn(&mut Package)| {
        let mut package = good.clone();
        change(&mut package);
        package
    };
    named(
        changed(|p| p.cases[0].verdict = Verdict::QualityWarning),
        "it was changed",
    );
    named(changed(|p| p.cases[0].checked += 1), "it was changed");
    named(changed(|p| p.suite = "0.0.0".into()), "made by suite");
    named(changed(|p| p.list_sha256.clear()), "list of cases");
    named(changed(|p| p.device = None), "no device");
    named(changed(|p| drop(p.cases.pop())), "is missing");
    named(
        changed(|p| p.asked.selection.shard = [1, 2]),
        "a part of the profile",
    );
    named(
        changed(|p| p.asked.selection.exclude = vec!["probe.math.exp".into()]),
        "a part of the profile",
    );
    named(changed(|p| p.asked.selection.shard = [0, 0]), "part 0 of 0");
    named(
        changed(|p| p.asked.limits = "vulkan-minimum".into()),
        "lowered",
    );
    // Times alone may differ.
    let mut later = good.clone();
    later.seconds = 99.0;
    later.cases[0].ms = 99.0;
    assert_eq!(later.complaints(&list), [""; 0]);
}

#[test]
fn what_a_device_lacks_is_named_in_a_package() {
    let list = cases();
    let lacking = Found {
        name: "timelineSemaphore".into(),
        wanted: "enabled".into(),
        device_says: "not supported".into(),
        device_has: false,
        library_says: "not supported".into(),
        library_has: false,
    };
    let package = whole(&list, |records| {
        records[0].verdict = Verdict::NotSupported;
        records[0].needs = vec![lacking];
    });
    assert_eq!(package.complaints(&list), [""; 0]);
}

#[test]
fn two_packages_differ_where_they_say_other_things() {
    let list = cases();
    let a = whole(&list, |_| {});
    assert!(Difference::of(&a, &a).agrees());
    let b = whole(&list, |records| {
        records[3].verdict = Verdict::Fail;
        records[5].worst = Some(Worst {
            ratio: 0.5,
            ..Worst::default()
        });
        records.pop();
    });
    let difference = Difference::of(&a, &b);
    assert!(!difference.agrees());
    assert_eq!(difference.verdicts.len(), 1, "{}", difference.text());
    assert_eq!(difference.alone.len(), 1);
    assert_eq!(difference.margins.len(), 1);
    assert_eq!(difference.same, a.cases.len() - 3);
}

#[test]
fn names_of_devices_and_reasons_cannot_break_a_report() {
    let list = cases();
    let package = whole(&list, |records| {
        records[0].verdict = Verdict::Fail;
        records[0].reason = "a < b & \"c\" \u{1b}[0m".into();
        records[1].verdict = Verdict::Timeout;
        records[2].verdict = Verdict::NotSupported;
    });
    for text in [html(&package), junit(&package)] {
        assert!(text.contains("a &lt;device&gt;"), "the device");
        assert!(
            text.contains("a &lt; b &amp; &quot;c&quot; ?[0m"),
            "the reason"
        );
    }
    let xml = junit(&package);
    assert!(xml.contains("failures=\"1\" errors=\"1\" skipped=\"1\""));
    assert_eq!(xml.matches("<testcase").count(), package.cases.len());
}

#[test]
fn a_test_log_has_a_document_a_case_and_nothing_in_it_looks_like_a_line_of_the_log() {
    let list = cases();
    let package = whole(&list, |records| {
        records[0].verdict = Verdict::Fail;
        records[0].reason = "a < b\n#endTestCaseResult".into();
        records[1].verdict = Verdict::Waived;
        records[2].verdict = Verdict::ExpectedFailure;
        records[2].baseline = Some(Verdict::Crash);
    });
    let log = qpa(&package);
    assert!(log.starts_with("#sessionInfo releaseName stratavox-"));
    assert!(log.contains("#sessionInfo releaseId 0x01234567\n"));
    assert!(log.trim_end().ends_with("#endSession"));
    let of = |mark: &str| log.lines().filter(|line| line.starts_with(mark)).count();
    for mark in ["#beginTestCaseResult ", "#endTestCaseResult"] {
        assert_eq!(of(mark), package.cases.len(), "{mark}");
    }
    let status = |case: &Record| {
        let begin = format!("#beginTestCaseResult {}\n", case.name);
        let document = log.split(&begin).nth(1).expect("the case");
        let status = document.split("StatusCode=\"").nth(1).expect("a result");
        status.split('"').next().expect("a word").to_owned()
    };
    let found: Vec<String> = package.cases[..4].iter().map(status).collect();
    assert_eq!(found, ["Fail", "Waiver", "Crash", "Pass"]);
}

#[test]
fn branches_of_two_packages_count_the_same_numbers_and_the_worst() {
    let list = cases();
    let with = |ratio: f64, hash: &str| {
        whole(&list, |records| {
            for record in records.iter_mut().take(3) {
                record.found_sha256 = hash.repeat(64);
            }
            records[1].found_sha256 = "c".repeat(64);
            records[0].worst = Some(Worst {
                ratio,
                ..Worst::default()
            });
        })
    };
    let (a, b) = (with(0.25, "a"), with(0.5, "b"));
    let difference = Difference::of(&a, &b);
    let words: Vec<&str> = list[0].name.split('.').take(2).collect();
    let branch = difference.branches[&words.join(".")];
    // Of the others no number is known: they are not the same.
    assert_eq!((branch.same_numbers, branch.worst), (1, [0.25, 0.5]));
    let all: usize = difference
        .branches
        .values()
        .map(|branch| branch.cases)
        .sum();
    assert_eq!(all, a.cases.len());
    let line = format!(
        "| `{}` | {} | 1 | 0.250 | 0.500 |",
        words.join("."),
        branch.cases
    );
    assert!(difference.text().contains(&line), "{}", difference.text());
}

#[test]
fn the_hash_is_of_what_was_found_in_its_order() {
    let hash = |numbers: [f64; 2]| {
        let mut found = Measurement::new(Bound::default(), 1);
        numbers
            .iter()
            .for_each(|&number| found.take(String::new, 1.0, number, 1.0));
        found.found_sha256()
    };
    assert_eq!(hash([1.0, 2.0]), hash([1.0, 2.0]));
    for other in [[2.0, 1.0], [1.0 + f64::EPSILON, 2.0], [-1.0, 2.0]] {
        assert_ne!(hash([1.0, 2.0]), hash(other), "{other:?}");
    }
    let none = Measurement::new(Bound::default(), 1);
    assert_eq!(none.found_sha256(), "");
}

/// Where `value` is not what `schema` says, as far as names of fields go.
fn unlike(root: &Value, schema: &Value, value: &Value, at: &str, found: &mut Vec<String>) {
    if let Some(name) = schema["$ref"].as_str() {
        let schema = &root["$defs"][name.rsplit('/').next().expect("a name")];
        return unlike(root, schema, value, at, found);
    }
    match value {
        Value::Object(fields) => {
            for name in schema["required"].as_array().into_iter().flatten() {
                let name = name.as_str().expect("a name");
                if !fields.contains_key(name) {
                    found.push(format!("{at}: no {name}"));
                }
            }
            for (name, value) in fields {
                match (&schema["properties"][name], &schema["additionalProperties"]) {
                    (Value::Null, Value::Bool(false)) => found.push(format!("{at}: {name}")),
                    (Value::Null, other) => unlike(root, other, value, name, found),
                    (schema, _) => unlike(root, schema, value, name, found),
                }
            }
        }
        Value::Array(items) => {
            for value in items {
                unlike(root, &schema["items"], value, at, found);
            }
        }
        Value::String(word) => {
            let words = schema["enum"].as_array();
            if words.is_some_and(|words| !words.iter().any(|one| one == word)) {
                found.push(format!("{at}: {word}"));
            }
        }
        _ => {}
    }
}

#[test]
fn the_schema_names_all_that_a_package_has() {
    let list = cases();
    let mut package = whole(&list, |records| {
        let record = &mut records[0];
        record.verdict = Verdict::ExpectedFailure;
        record.reason = "a reason".into();
        record.baseline = Some(Verdict::Fail);
        record.weak_bound = true;
        record.unexpected_pass = true;
        record.runs = vec![Verdict::Fail, Verdict::Pass];
        record.worst = Some(Worst::default());
        record.bound = Some(Bound::default());
        record.found_sha256 = "0".repeat(64);
        record.pictures = vec!["a.png".into()];
        record.validation_messages = vec!["a message".into()];
        records.pop();
    });
    let stress = Stress {
        queues: 1,
        threads: 2,
    };
    package.asked.stress = Some(stress);
    package.asked.selection.caselist = vec!["*".into()];
    package.asked.selection.exclude = vec!["a".into()];
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/conformance-schema.json");
    let schema = std::fs::read_to_string(page).expect("the schema");
    let schema: Value = serde_json::from_str(&schema).expect("JSON");
    let mut found = Vec::new();
    let value = serde_json::to_value(&package).expect("JSON");
    unlike(&schema, &schema, &value, "package", &mut found);
    assert_eq!(found, [""; 0]);
    let number = &schema["properties"]["stratavox_conformance"]["const"];
    assert_eq!(number, package.stratavox_conformance);
}
