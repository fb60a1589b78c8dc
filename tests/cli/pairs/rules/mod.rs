//! Why pairs are refused: by what the program says, whether the pair means nothing or is not built, and what it would cost.

mod classification;
mod modes;
mod paths;
mod points;
mod scattering;
mod sections;
mod several;
mod streams;
mod techniques;

use std::sync::LazyLock;

/// A kind of refusal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// No picture could be both.
    NoMeaning,
    /// A picture could be both; the reason says what it would cost.
    NotBuilt,
    /// Drawn with these words more, which the program asks for.
    NeedsMore(&'static str),
}

/// A reason for pairs.
pub struct Rule {
    /// Its kind.
    pub class: Class,
    /// A part of what the program says.
    pub says: &'static str,
    /// One of the pair is one of these features; any where there are none.
    pub of: &'static [&'static str],
    /// The reason.
    pub why: &'static str,
}

const fn no_meaning(says: &'static str, why: &'static str) -> Rule {
    Rule {
        class: Class::NoMeaning,
        says,
        of: &[],
        why,
    }
}

const fn not_built(says: &'static str, why: &'static str) -> Rule {
    Rule {
        class: Class::NotBuilt,
        ..no_meaning(says, why)
    }
}

const fn needs(says: &'static str, more: &'static str, why: &'static str) -> Rule {
    Rule {
        class: Class::NeedsMore(more),
        ..no_meaning(says, why)
    }
}

const fn of(features: &'static [&'static str], rule: Rule) -> Rule {
    Rule {
        of: features,
        ..rule
    }
}

/// All of them; the first that fits is the reason of a pair.
pub static RULES: LazyLock<Vec<&'static Rule>> = LazyLock::new(|| {
    let files = [
        sections::RULES,
        scattering::RULES,
        modes::RULES,
        paths::RULES,
        techniques::RULES,
        classification::RULES,
        several::RULES,
        points::RULES,
        streams::RULES,
    ];
    files.into_iter().flatten().collect()
});
