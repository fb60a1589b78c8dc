//! The suite proves itself: each fault of a driver is caught by the case that is named for it.
//!
//! The table of `docs/conformance.md` is written by `BLESS=1` (and the test then fails).
//! Slices in 16-bit floats have faults of their own, on a device of the least limits.

use crate::driver_faults::{
    ANSWERS, CLAMPED_FAULTS, FAULTS, Fault, PROBE_FAULTS, SCATTER_FAULTS, SPLAT_FAULTS,
    VOXEL_FAULTS, WARP_FAULTS, faulty, tell, told,
};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::{Mutex, PoisonError};
use stratavox::conformance::case::Case;
use stratavox::conformance::glob::matches;
use stratavox::conformance::judge::judge;
use stratavox::conformance::record::Record;
use stratavox::conformance::test_bed::TestBed;
use stratavox::conformance::tree::cases;
use stratavox::conformance::verdict::Verdict;
use stratavox::gpu::{Caps, DeviceChoice, Headless, Options, PipelineCache, Validation};

/// One lie at a time is told in a process.
static ONE: Mutex<()> = Mutex::new(());

fn bed(caps: Caps) -> TestBed {
    TestBed::new(1, move |lower| {
        let options = Options {
            caps: lower(caps),
            pipeline_cache: PipelineCache::Off,
            validation: Validation::Off,
        };
        // SAFETY: its functions are Vulkan's, or lie within what Vulkan allows.
        unsafe { Headless::through(faulty, &DeviceChoice::Default, &options) }
    })
}

/// The first case that a pattern means and that does not say what it says without the fault, or why there is none.
fn caught<'c>(
    all: &'c [Case],
    pattern: &str,
    fault: Fault,
    caps: Caps,
    healthy: &mut BTreeMap<String, Verdict>,
) -> Result<(&'c str, Record), String> {
    let is_meant = |case: &&Case| matches(pattern, &case.name);
    let mut missed = String::new();
    for case in all.iter().filter(is_meant) {
        let truth = *healthy.entry(case.name.clone()).or_insert_with(|| {
            tell(None);
            judge(case, &mut bed(caps)).0.verdict
        });
        tell(Some(fault));
        let record = judge(case, &mut bed(caps)).0;
        let is_told = told() > 0;
        tell(None);
        if !truth.is_good() || !is_told || record.verdict == Verdict::InternalError {
            let Record { name, reason, .. } = record;
            return Err(format!(
                "{name}: told {is_told}, {truth} without it, {reason}"
            ));
        }
        if record.verdict != truth {
            return Ok((&case.name, record));
        }
        let _ = write!(missed, "{} is {truth}; ", case.name);
    }
    Err(missed)
}

#[test]
fn every_lie_is_caught_and_the_page_says_by_what() {
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let all = cases();
    let mut healthy = BTreeMap::new();
    let mut table = String::from("| Fault | caught by | verdict |\n|---|---|---|\n");
    let mut missed = Vec::new();
    let tables = [
        FAULTS,
        WARP_FAULTS,
        SPLAT_FAULTS,
        VOXEL_FAULTS,
        ANSWERS,
        SCATTER_FAULTS,
        PROBE_FAULTS,
    ];
    for (what, fault, pattern) in tables.into_iter().flatten() {
        match caught(&all, pattern, *fault, Caps::UNLIMITED, &mut healthy) {
            Ok((name, record)) => {
                println!("{what}: {}", record.reason);
                let _ = writeln!(table, "| {what} | `{name}` | {} |", record.verdict);
            }
            Err(why) => missed.push(format!("{what}: {why}")),
        }
    }
    assert!(missed.is_empty(), "not caught: {missed:#?}");
    assert!(FAULTS.len() >= 40, "only {} lies", FAULTS.len());
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/conformance.md");
    let page = std::fs::read_to_string(path).expect("docs/conformance.md");
    const MARKS: [&str; 2] = [
        "<!-- injected faults -->\n",
        "<!-- end of injected faults -->",
    ];
    let [begin, end] = MARKS.map(|mark| page.find(mark).expect("the marks of the table"));
    let begin = begin + MARKS[0].len();
    if page[begin..end] != table {
        if std::env::var_os("BLESS").is_some() {
            let page = format!("{}{table}{}", &page[..begin], &page[end..]);
            std::fs::write(path, page).expect("written");
        }
        panic!("the table of docs/conformance.md is old: BLESS=1 writes it");
    }
}

#[test]
fn lies_about_slices_in_16_bit_floats_are_caught() {
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let all = cases();
    let mut healthy = BTreeMap::new();
    for (what, fault, pattern) in CLAMPED_FAULTS {
        match caught(&all, pattern, *fault, Caps::VULKAN_MINIMUM, &mut healthy) {
            Ok((_, record)) => {
                println!("{what}: {}", record.reason);
                assert_eq!(record.verdict, Verdict::Fail, "{what}: {record:?}");
            }
            Err(why) => panic!("{what} is not caught: {why}"),
        }
    }
    assert!(healthy.values().all(|verdict| *verdict == Verdict::Pass));
}
