//! Patterns over the names of cases: `*` stands for any run of characters, `?` for one, `|` between patterns for
//! either.

/// Whether `name` is one of those that `pattern` means.
pub fn matches(pattern: &str, name: &str) -> bool {
    let either = |pattern: &str| matches_one(pattern.as_bytes(), name.as_bytes());
    pattern.split('|').any(either)
}

/// Goes back to the last `*` alone: all before it has found its place already.
fn matches_one(pattern: &[u8], name: &[u8]) -> bool {
    let (mut p, mut n) = (0, 0);
    let mut star: Option<(usize, usize)> = None;
    while n < name.len() {
        match pattern.get(p) {
            Some(b'*') => {
                star = Some((p, n));
                p += 1;
            }
            Some(&c) if c == b'?' || c == name[n] => {
                p += 1;
                n += 1;
            }
            _ => match star {
                Some((at, taken)) => {
                    star = Some((at, taken + 1));
                    p = at + 1;
                    n = taken + 1;
                }
                None => return false,
            },
        }
    }
    pattern[p..].iter().all(|&c| c == b'*')
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn stars_take_any_run_and_bars_stand_between_patterns() {
        for (pattern, name, wanted) in [
            ("*", "a.b", true),
            ("a.*", "a.b.c", true),
            ("a.*", "b.a.c", false),
            ("*.c", "a.b.c", true),
            ("*b*b", "abab", true),
            ("*b*b", "aba", false),
            ("a?c", "abc", true),
            ("a?c", "ac", false),
            ("x|a*", "abc", true),
            ("", "", true),
            ("", "a", false),
            ("a", "ab", false),
        ] {
            assert_eq!(matches(pattern, name), wanted, "{pattern} {name}");
        }
    }
}
