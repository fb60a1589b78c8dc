//! The pairs as a page of Markdown.

use super::{
    features::FEATURES,
    inputs::Input,
    rules::{Class, RULES},
    sweep::Outcome,
};
use std::fmt::Write as _;

const HEAD: &str = "# Pairs of features

Every pair of features of the command line: whether it is drawn, and why not. Printed by `make pairs`, which runs the program for
each pair on a volume of 20^3 voxels; `tests/cli/pairs` holds this page against what the program does, of pairs that are drawn for one of
eight, and wants that a picture is not empty and that both features change it. [matrix.md](matrix.md) has every feature in every technique, mode and filter.

What holds without a flag is no feature: ray casting, composites, the linear filter and perspective are in all pairs without a flag
for them. The mode `minip` goes with what `mip` goes with, and `attenuated-mip` with what `lmip` goes with.
";

const LEGEND: &str = "
`+` is drawn, a number alone is refused for the reason of that number, in bold where it is not built, and `+` with a number is drawn with
the words of that reason; `.` is no pair, since a command line has one of both, or no input has both.
";

/// The page.
pub fn page(found: &[Vec<Outcome>]) -> String {
    let mut text = HEAD.to_owned();
    text.push_str(&totals(found));
    text.push_str("\n## Features\n\n");
    for (i, feature) in FEATURES.iter().enumerate() {
        let words = Input::Head.fill(feature.words);
        let words = match words.as_str() {
            "" => String::new(),
            words => format!(": `{words}`"),
        };
        writeln!(text, "{}. {}{words}", i + 1, feature.name).expect("text");
    }
    text.push_str("\n## Table\n");
    text.push_str(LEGEND);
    let numbers: Vec<_> = (1..FEATURES.len()).map(|n| n.to_string()).collect();
    write!(
        text,
        "\n| | {} |\n|---|{}\n",
        numbers.join(" | "),
        "---|".repeat(numbers.len())
    )
    .expect("text");
    for (i, row) in found.iter().enumerate().skip(1) {
        let cells: Vec<_> = row.iter().map(cell).collect();
        writeln!(
            text,
            "| {} {} | {} |",
            i + 1,
            FEATURES[i].name,
            cells.join(" | ")
        )
        .expect("text");
    }
    text.push_str("\n## Reasons\n\n");
    for (i, rule) in RULES.iter().enumerate() {
        let kind = match rule.class {
            Class::NoMeaning => "no meaning".to_owned(),
            Class::NotBuilt => "not built".to_owned(),
            Class::NeedsMore(more) => format!("drawn with `{more}`"),
        };
        let count = found
            .iter()
            .flatten()
            .filter(|outcome| is_of(outcome, i))
            .count();
        let of = if count == 1 { "pair" } else { "pairs" };
        writeln!(text, "{}. *{kind}*, {count} {of}: {}", i + 1, rule.why).expect("text");
    }
    text
}

/// Whether the page says of a pair that it is drawn as it stands. Features are found by their names: the page may be older than
/// their numbers.
pub fn says_drawn(page: &str, first: usize, second: usize) -> bool {
    let row_of = |line: &str| -> Option<(usize, String, Vec<String>)> {
        let mut cells = line.strip_prefix("| ")?.split(" | ");
        let (number, name) = cells.next()?.split_once(' ')?;
        let cells = cells.map(|cell| cell.trim_end_matches(" |").to_owned());
        Some((number.parse().ok()?, name.to_owned(), cells.collect()))
    };
    let rows: Vec<_> = page.lines().filter_map(row_of).collect();
    let row = |i: usize| rows.iter().find(|(_, name, _)| name == FEATURES[i].name);
    let (Some((_, _, cells)), Some((number, ..))) = (row(first), row(second)) else {
        return false;
    };
    cells.get(number - 1).is_some_and(|cell| cell == "+")
}

/// True where a rule is the reason.
pub fn is_of(outcome: &Outcome, rule: usize) -> bool {
    matches!(outcome, Outcome::Refused(i) | Outcome::DrawnWith(i) if *i == rule)
}

/// How many pairs there are of each kind.
pub struct Counts {
    /// Drawn as they stand.
    pub drawn: usize,
    /// Drawn with words more.
    pub with_more: usize,
    /// Without a meaning.
    pub meaningless: usize,
    /// Not built.
    pub not_built: usize,
}

impl Counts {
    /// Of what was found.
    pub fn of(found: &[Vec<Outcome>]) -> Self {
        let count = |is: fn(&Outcome) -> bool| found.iter().flatten().filter(|one| is(one)).count();
        let is_class = |outcome: &Outcome, class| matches!(outcome, Outcome::Refused(rule) if RULES[*rule].class == class);
        let of_class = |class| {
            found
                .iter()
                .flatten()
                .filter(|one| is_class(one, class))
                .count()
        };
        Self {
            drawn: count(|one| *one == Outcome::Drawn),
            with_more: count(|one| matches!(one, Outcome::DrawnWith(_))),
            meaningless: of_class(Class::NoMeaning),
            not_built: of_class(Class::NotBuilt),
        }
    }

    /// Drawn, of those that mean something.
    pub fn share(&self) -> f64 {
        let drawn = self.drawn + self.with_more;
        drawn as f64 / (drawn + self.not_built) as f64
    }
}

fn totals(found: &[Vec<Outcome>]) -> String {
    let counts = Counts::of(found);
    let Counts {
        drawn,
        with_more,
        meaningless,
        not_built,
    } = counts;
    let all = drawn + with_more + meaningless + not_built;
    let percent = |part: f64| format!("{:.1} %", 100.0 * part);
    let of_all = percent((drawn + with_more) as f64 / all as f64);
    format!(
        "\n| | pairs |\n|---|---|\n| all | {all} |\n| drawn | {drawn} |\n| drawn with a flag more, which the program asks for | {with_more} |\n\
         | refused: no meaning | {meaningless} |\n| refused: not built | {not_built} |\n\
         | drawn, of those with a meaning | {} |\n| drawn, of all | {of_all} |\n",
        percent(counts.share())
    )
}

fn cell(outcome: &Outcome) -> String {
    match outcome {
        Outcome::NoPair => ".".to_owned(),
        Outcome::Drawn => "+".to_owned(),
        Outcome::DrawnWith(rule) => format!("+{}", rule + 1),
        Outcome::Refused(rule) if RULES[*rule].class == Class::NotBuilt => {
            format!("**{}**", rule + 1)
        }
        Outcome::Refused(rule) => (rule + 1).to_string(),
        Outcome::Wrong(_) => "?".to_owned(),
    }
}
