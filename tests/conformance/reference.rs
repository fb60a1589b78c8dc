//! The CPU reference judged by the closed forms that judge devices: cases of pictures with no device under them.

use stratavox::conformance::case::{Case, Profile};
use stratavox::conformance::judge::judge;
use stratavox::conformance::test_bed::{Draw, TestBed};
use stratavox::conformance::tree::cases;
use stratavox::conformance::verdict::Verdict;
use stratavox::offscreen::reference;

/// Cases whose answer is not the reference's own, of the baseline.
fn is_closed(case: &Case) -> bool {
    let of_driver = ["probe.", "reference."]
        .iter()
        .any(|tree| case.name.starts_with(tree));
    !of_driver && case.profile == Profile::Baseline
}

fn judged(draw: Draw) {
    let mut bed = TestBed::without_device(1, draw);
    let (mut count, mut wrong) = (0, Vec::new());
    for case in cases().iter().filter(|case| is_closed(case)) {
        let (record, _) = judge(case, &mut bed);
        count += 1;
        if record.verdict != Verdict::Pass {
            wrong.push(format!(
                "{}: {} {}",
                case.name, record.verdict, record.reason
            ));
        }
    }
    assert!(count > 500, "only {count} cases");
    assert!(wrong.is_empty(), "{} of {count}: {wrong:#?}", wrong.len());
}

#[test]
fn the_f32_reference_passes_every_closed_form() {
    judged(reference::render::<f32>);
}

#[test]
fn the_f64_reference_passes_every_closed_form() {
    judged(reference::render::<f64>);
}
