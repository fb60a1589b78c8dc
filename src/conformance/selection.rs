//! Which cases a run is of, and in which order.
//!
//! ```text
//! the list -> of the profile, meant by the filter and by no exclusion -> in the order of the case list -> a shard
//! ```

use super::case::{Case, Profile};
use super::glob::matches;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// A choice among all cases.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Selection {
    /// Cases of this profile and of those within it.
    pub profile: Profile,
    /// A pattern over their names.
    pub filter: String,
    /// Names or patterns in the order in which the cases run; all cases in the order of the list where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub caselist: Vec<String>,
    /// Names or patterns of cases that do not run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub exclude: Vec<String>,
    /// Part `shard[0]`, counted from 1, of `shard[1]`: every `shard[1]`th case.
    pub shard: [u32; 2],
}

impl Selection {
    /// All cases of a profile.
    pub fn all(profile: Profile) -> Self {
        Self {
            profile,
            filter: "*".to_owned(),
            caselist: Vec::new(),
            exclude: Vec::new(),
            shard: [1, 1],
        }
    }

    /// Whether cases of the profile are left out.
    pub fn is_part(&self) -> bool {
        *self != Self::all(self.profile)
    }

    /// The cases, each once, in the order in which they run.
    pub fn of<'c>(&self, list: &'c [Case]) -> Vec<&'c Case> {
        let is_excluded = |case: &&Case| self.exclude.iter().any(|one| matches(one, &case.name));
        let of_profile = list.iter().filter(|case| case.profile <= self.profile);
        let meant = of_profile.filter(|case| matches(&self.filter, &case.name));
        let mut left: Vec<Option<&Case>> =
            meant.filter(|case| !is_excluded(case)).map(Some).collect();
        let ordered = match self.caselist.is_empty() {
            true => left.into_iter().flatten().collect(),
            false => in_order(&self.caselist, &mut left),
        };
        let [part, parts] = self.shard.map(|n| n as usize);
        ordered.into_iter().skip(part - 1).step_by(parts).collect()
    }
}

/// The cases of each line in turn. A case that two lines mean stands where the first of them is.
fn in_order<'c>(lines: &[String], left: &mut [Option<&'c Case>]) -> Vec<&'c Case> {
    let places: HashMap<&str, usize> = left
        .iter()
        .enumerate()
        .filter_map(|(place, case)| Some(((*case)?.name.as_str(), place)))
        .collect();
    let mut ordered = Vec::new();
    for line in lines {
        if is_pattern(line) {
            let is_meant = |case: &mut &Case| matches(line, &case.name);
            ordered.extend(left.iter_mut().filter_map(|case| case.take_if(is_meant)));
        } else if let Some(&place) = places.get(line.as_str()) {
            ordered.extend(left[place].take());
        }
    }
    ordered
}

fn is_pattern(line: &str) -> bool {
    line.contains(['*', '?', '|'])
}

/// The names and patterns of a file of them, each with the number of its line, from 1: one a line, nothing behind `#`.
pub fn lines(text: &str) -> Vec<(usize, &str)> {
    let all = text.lines().enumerate();
    all.map(|(i, line)| (i + 1, line.split('#').next().unwrap_or_default().trim()))
        .filter(|(_, line)| !line.is_empty())
        .collect()
}

/// Of `lines` those that mean no case of the profile: the number of each, and what is wrong with it.
pub fn unmatched(lines: &[(usize, &str)], list: &[Case], profile: Profile) -> Vec<(usize, String)> {
    let is_of = |case: &&Case| case.profile <= profile;
    let problem = |&(number, line): &(usize, &str)| {
        let mut meant = list.iter().filter(|case| matches(line, &case.name));
        let problem = match (meant.clone().any(|case| is_of(&case)), meant.next()) {
            (true, _) => return None,
            (false, Some(case)) => format!(
                "{line} is of profile {}, and this run of {}",
                case.profile.word(),
                profile.word()
            ),
            (false, None) => format!("there is no case {line}"),
        };
        Some((number, problem))
    };
    lines.iter().filter_map(problem).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list() -> Vec<Case> {
        let case = |name: &str| {
            Case::new(name, |_| {
                Err(super::super::case::Stop::Suite("not run".to_owned()))
            })
        };
        let mut list: Vec<Case> = ["a.one", "a.two", "b.one", "b.two"].map(case).into();
        list.push(case("b.three").of(Profile::Full));
        list
    }

    fn names(selection: &Selection) -> Vec<String> {
        let list = list();
        let chosen = selection.of(&list);
        chosen.iter().map(|case| case.name.clone()).collect()
    }

    #[test]
    fn a_case_list_gives_the_order_and_each_case_once() {
        let mut selection = Selection::all(Profile::Baseline);
        selection.caselist = ["b.two", "a.*", "b.one", "*"].map(str::to_owned).into();
        assert_eq!(names(&selection), ["b.two", "a.one", "a.two", "b.one"]);
        selection.shard = [2, 3];
        assert_eq!(names(&selection), ["a.one"]);
        selection.shard = [1, 1];
        selection.filter = "*.one".to_owned();
        assert_eq!(names(&selection), ["a.one", "b.one"]);
        selection.exclude = vec!["a.?ne".to_owned()];
        assert_eq!(names(&selection), ["b.one"]);
    }

    #[test]
    fn lines_are_counted_with_those_that_say_nothing() {
        let text = "# a list\r\n\r\n a.one \r\nb.* # all\n#\nb.three\nc\n";
        let lines = lines(text);
        assert_eq!(lines, [(3, "a.one"), (4, "b.*"), (6, "b.three"), (7, "c")]);
        let wrong = unmatched(&lines, &list(), Profile::Baseline);
        let numbers: Vec<usize> = wrong.iter().map(|(number, _)| *number).collect();
        assert_eq!(numbers, [6, 7], "{wrong:?}");
        assert!(wrong[0].1.contains("profile full"), "{wrong:?}");
    }
}
