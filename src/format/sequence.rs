//! Numbered file names: `slice%03d.raw 1 20 1`, a printf template with first, last and step.

use super::text::integers;

/// Names made of a template and a running number.
#[derive(Debug)]
pub(crate) struct Sequence {
    template: String,
    first: i64,
    step: i64,
    count: u64,
}

impl Sequence {
    /// The numbers from `first` towards `last`, both included. `None` where the step leads nowhere.
    pub(crate) fn new(template: &str, first: i64, last: i64, step: i64) -> Option<Self> {
        let steps = last.checked_sub(first)?.checked_div(step)?;
        Some(Self {
            template: template.to_owned(),
            first,
            step,
            count: u64::try_from(steps).ok()?.checked_add(1)?,
        })
    }

    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// The names, one after the other; `None` for a template that is not understood.
    pub(crate) fn names(&self) -> impl Iterator<Item = Option<String>> + '_ {
        (0..self.count).map(|index| {
            let index = i64::try_from(index).ok()?;
            let number = self.first.checked_add(self.step.checked_mul(index)?)?;
            expand(&self.template, number)
        })
    }
}

/// `template` and up to four whole numbers behind it, split at white space.
pub(crate) fn template_and_numbers(text: &str) -> Option<(&str, Vec<i64>)> {
    let (template, rest) = text.split_once([' ', '\t']).unwrap_or((text, ""));
    let numbers = integers(rest)?;
    (numbers.len() <= 4).then_some((template, numbers))
}

/// True where `template` asks for a number: `%d`, `%03d`, but not `%%d`.
pub(crate) fn asks_for_a_number(template: &str) -> bool {
    expand(template, 0).is_some_and(|name| Some(name) != expand(template, 1))
}

/// The name for one number. One of `%d %i %u` with an optional width, zero-padded or not; `%%` means `%`.
pub(crate) fn expand(template: &str, number: i64) -> Option<String> {
    const WIDEST: usize = 32;
    let mut name = String::new();
    let mut rest = template;
    let mut used = false;
    while let Some((plain, tail)) = rest.split_once('%') {
        name.push_str(plain);
        if let Some(tail) = tail.strip_prefix('%') {
            name.push('%');
            rest = tail;
            continue;
        }
        let conversion = tail.find(|c: char| !c.is_ascii_digit())?;
        let (width, tail) = tail.split_at_checked(conversion)?;
        rest = tail.strip_prefix(['d', 'i', 'u'])?;
        let zeros = width.starts_with('0');
        let width: usize = if width.is_empty() {
            0
        } else {
            width.parse().ok()?
        };
        if used || width > WIDEST {
            return None;
        }
        used = true;
        name.push_str(&if zeros {
            format!("{number:0width$}")
        } else {
            format!("{number:width$}")
        });
    }
    name.push_str(rest);
    used.then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(template: &str, first: i64, last: i64, step: i64) -> Vec<String> {
        let sequence = Sequence::new(template, first, last, step).unwrap();
        sequence.names().map(Option::unwrap).collect()
    }

    #[test]
    fn names_are_those_that_printf_makes() {
        assert_eq!(
            names("a%03d.raw", 8, 12, 2),
            ["a008.raw", "a010.raw", "a012.raw"]
        );
        assert_eq!(names("%d", 2, 0, -1), ["2", "1", "0"]);
        assert_eq!(names("100%%_%3i", 5, 6, 9), ["100%_  5"]);
        assert_eq!(names("x%04u", -7, -7, 1), ["x-007"]);
    }

    #[test]
    fn a_template_that_printf_would_take_for_something_else_is_refused() {
        for template in [
            "%s",
            "%n",
            "%d%d",
            "%99999999d",
            "%",
            "%5",
            "%-3d",
            "%ld",
            "é%",
        ] {
            assert!(expand(template, 1).is_none(), "{template}");
            assert!(!asks_for_a_number(template), "{template}");
        }
        assert!(asks_for_a_number("slice%02d"));
        assert!(!asks_for_a_number("100%%d"));
    }

    #[test]
    fn a_step_that_leads_nowhere_is_refused() {
        assert!(Sequence::new("%d", 1, 5, 0).is_none());
        assert!(Sequence::new("%d", 1, 5, -1).is_none());
        assert!(Sequence::new("%d", i64::MIN, i64::MAX, 1).is_none());
        assert_eq!(Sequence::new("%d", 1, 93, 1).unwrap().count(), 93);
    }
}
