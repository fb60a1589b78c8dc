//! Every pair of features of the command line is drawn or refused, as `docs/pairs.md` says.

mod features;
mod inputs;
mod page;
mod rules;
mod sweep;

use page::Counts;
use rules::RULES;
use sweep::Outcome;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/pairs.md");

/// Of the pairs that mean something so many are drawn at least.
const LEAST_SHARE: f64 = 0.85;

/// The outcomes, all of them right.
fn outcomes(is_known: impl Fn(usize, usize) -> bool) -> Vec<Vec<Outcome>> {
    let found = sweep::outcomes(is_known);
    let wrong = found.iter().flatten().filter_map(|outcome| match outcome {
        Outcome::Wrong(what) => Some(what.as_str()),
        _ => None,
    });
    let wrong: Vec<_> = wrong.collect();
    assert!(
        wrong.is_empty(),
        "{} pairs:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
    found
}

/// Fails where a rule is the reason of no pair, or too few pairs are drawn.
fn check(found: &[Vec<Outcome>]) {
    for (i, rule) in RULES.iter().enumerate() {
        let is_needed = found.iter().flatten().any(|one| page::is_of(one, i));
        assert!(is_needed, "nothing is refused by the rule {:?}", rule.says);
    }
    let counts = Counts::of(found);
    println!(
        "{} pairs drawn, {} with a flag more, {} without a meaning, {} not built",
        counts.drawn, counts.with_more, counts.meaningless, counts.not_built
    );
    assert!(counts.share() >= LEAST_SHARE, "{:.3}", counts.share());
}

#[test]
fn every_pair_is_drawn_or_refused_for_a_reason() {
    let kept = std::fs::read_to_string(PAGE).expect("docs/pairs.md");
    // A picture takes longer than a refusal: of what the page calls drawn one of eight is, so that each feature is drawn with
    // some others (`make pairs` draws all).
    let is_left = |first, second| (first + 3 * second) % 8 != 0;
    let found =
        outcomes(|first, second| is_left(first, second) && page::says_drawn(&kept, first, second));
    check(&found);
    let made = page::page(&found);
    let lines = made.lines().zip(kept.lines());
    let other: Vec<_> = lines.filter(|(made, kept)| made != kept).collect();
    assert!(made == kept, "docs/pairs.md is old: make pairs\n{other:#?}");
}

#[test]
#[ignore = "writes docs/pairs.md: make pairs"]
fn write_the_page() {
    let found = outcomes(|_, _| false);
    std::fs::write(PAGE, page::page(&found)).expect("docs/pairs.md");
    check(&found);
}
