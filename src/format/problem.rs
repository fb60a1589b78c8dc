//! Sentences about files: text that comes from a file is escaped and cut before it gets into one.

use crate::volume::{Problem, ReadError};
use std::path::Path;

/// The longest piece of a file that an error repeats.
const LONGEST_QUOTE: usize = 80;

/// `text` with everything but printable ASCII escaped, and its end cut off where it is long.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        if escaped.len() >= LONGEST_QUOTE {
            escaped.push_str("...");
            break;
        }
        match c {
            ' '..='~' => escaped.push(c),
            _ => escaped.extend(c.escape_default()),
        }
    }
    escaped
}

/// A field that says something that cannot be. `found` comes from the file.
pub(crate) fn invalid(
    format: &'static str,
    field: &str,
    wanted: impl Into<String>,
    found: &str,
) -> Problem {
    Problem::Invalid {
        format,
        field: escape(field),
        wanted: wanted.into(),
        found: format!("`{}`", escape(found)),
    }
}

/// A field that must be there is not.
pub(crate) fn missing(format: &'static str, field: &str) -> Problem {
    Problem::Missing {
        format,
        field: field.to_owned(),
    }
}

/// A valid file that we do not read. `what` holds nothing unescaped from the file.
pub(crate) fn unsupported(format: &'static str, what: impl Into<String>) -> Problem {
    Problem::Unsupported {
        format,
        what: what.into(),
    }
}

/// The system would not let us.
pub(crate) fn io(doing: &'static str) -> impl FnOnce(std::io::Error) -> Problem {
    move |cause| Problem::Io { doing, cause }
}

/// Says in which file the problem is.
pub(crate) fn at(path: &Path) -> impl FnOnce(Problem) -> ReadError + '_ {
    move |problem| ReadError {
        path: path.to_owned(),
        problem,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_of_a_file_cannot_move_the_cursor_or_flood_the_terminal() {
        let hostile = "\u{1b}[2J\u{7}\u{202e}\n\r\0é".to_owned() + &"x".repeat(70_000);
        let escaped = escape(&hostile);
        assert!(escaped.len() < 2 * LONGEST_QUOTE, "{} long", escaped.len());
        assert!(
            escaped.chars().all(|c| matches!(c, ' '..='~')),
            "{escaped:?}"
        );
        assert!(
            escaped.starts_with("\\u{1b}[2J\\u{7}\\u{202e}\\n\\r\\u{0}\\u{e9}"),
            "{escaped}"
        );
    }
}
