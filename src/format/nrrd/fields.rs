//! The lines of a NRRD header: `field: description`, `key:=value`, `# comment`, up to an empty line.
//!
//! Definition of the format: teem.sourceforge.net/nrrd/format.html, sections 1, 3 and 5.

use super::NRRD;
use crate::format::place::open_regular;
use crate::format::problem::{escape, invalid, missing};
use crate::format::text::Lines;
use crate::volume::Problem;
use std::collections::BTreeMap;
use std::io::BufReader;
use std::path::Path;

/// Field names with their spaces; they may be written without, in any case.
const NAMES: [&str; 30] = [
    "axis maxs",
    "axis mins",
    "block size",
    "byte skip",
    "centerings",
    "content",
    "data file",
    "dimension",
    "encoding",
    "endian",
    "kinds",
    "labels",
    "line skip",
    "max",
    "measurement frame",
    "min",
    "number",
    "old max",
    "old min",
    "sample units",
    "sizes",
    "space",
    "space dimension",
    "space directions",
    "space origin",
    "space units",
    "spacings",
    "thicknesses",
    "type",
    "units",
];

/// A header taken apart.
#[derive(Debug, Default)]
pub(super) struct Fields {
    values: BTreeMap<&'static str, String>,
    /// Names behind `data file: LIST`.
    pub listed_files: Vec<String>,
    /// True where a key/value pair says that the modality is CT.
    pub modality_is_ct: bool,
    /// True where key/value pairs number the elements of a list axis, as those of an image sequence.
    pub list_is_sequence: bool,
    /// Lines of the form `field: description` whose field the format does not know, and the first such field.
    pub unknown: Option<(usize, String)>,
    /// Where the data of an attached header begins.
    pub header_bytes: u64,
}

impl Fields {
    /// Reads a header, at most `limit_bytes` of it.
    pub(super) fn read(path: &Path, limit_bytes: usize) -> Result<Self, Problem> {
        let (file, _) = open_regular(path)?;
        let mut lines = Lines::new(BufReader::new(file), limit_bytes);
        let mut fields = Self::default();
        let magic = lines.next()?.map(|line| line.text).unwrap_or_default();
        if !is_magic(&magic) {
            let wanted = "NRRD0001 to NRRD0006 in the first line";
            return Err(invalid(NRRD, "magic", wanted, &magic));
        }
        let mut closed = false;
        let mut last = None;
        while let Some(line) = lines.next()? {
            if line.text.is_empty() && line.ended {
                closed = true;
                break;
            }
            let name = fields.take(&line.text)?.unwrap_or("header");
            last = Some((name, line.ended));
        }
        fields.header_bytes = lines.position();
        if !closed {
            fields.may_end_without_an_empty_line(last)?;
        }
        Ok(fields)
    }

    /// A detached header may end with the file. A last line without its end may have lost digits; only of a
    /// single file's name can we tell, since the shorter name is then that of no file.
    fn may_end_without_an_empty_line(
        &self,
        last: Option<(&'static str, bool)>,
    ) -> Result<(), Problem> {
        let cut = |field: &str, wanted: &str| {
            Err(Problem::Invalid {
                format: NRRD,
                field: field.to_owned(),
                wanted: wanted.to_owned(),
                found: "the end of the file".to_owned(),
            })
        };
        if self.get("data file").is_none() {
            return cut("header", "a `data file` line, or an empty line and data");
        }
        match last {
            Some(("data file", false)) | Some((_, true)) | None => Ok(()),
            Some((name, false)) => cut(name, "a line end behind the last line"),
        }
    }

    /// Takes one line; gives the field's name where it was one.
    fn take(&mut self, line: &str) -> Result<Option<&'static str>, Problem> {
        if self.get("data file").is_some_and(is_list) {
            self.listed_files.push(line.trim().to_owned());
            return Ok(Some("listed file"));
        }
        if line.starts_with('#') {
            return Ok(None);
        }
        let pair = line.split_once(":=");
        if let Some((word, description)) = line.split_once(':')
            && let Some(name) = known(word)
            && pair.is_none_or(|(key, _)| key != word)
        {
            let description = description.trim_matches([' ', '\t']);
            if self.values.insert(name, description.to_owned()).is_some() {
                let wanted = "at most one line of this field";
                return Err(invalid(NRRD, name, wanted, description));
            }
            return Ok(Some(name));
        }
        if let Some((key, value)) = pair {
            self.take_pair(key, value);
            return Ok(None);
        }
        match line.split_once(':') {
            Some((word, _)) => {
                let (count, _) = self.unknown.get_or_insert_with(|| (0, escape(word)));
                *count = count.saturating_add(1);
                Ok(None)
            }
            None => {
                let wanted = "`field: description`, `key:=value` or `# comment`";
                Err(invalid(NRRD, "header line", wanted, line))
            }
        }
    }

    fn take_pair(&mut self, key: &str, value: &str) {
        let key = key.to_ascii_lowercase();
        // `modality`, or as some converters of DICOM write it, `0008_0060_Modality`.
        self.modality_is_ct |= key.ends_with("modality") && value.trim() == "CT";
        self.list_is_sequence |= key.starts_with("multivolume.") || key.ends_with(" index type");
    }

    /// What stands behind the field, if it is there.
    pub(super) fn get(&self, name: &str) -> Option<&str> {
        self.values.get(name).map(String::as_str)
    }

    /// What stands behind a field that must be there.
    pub(super) fn required(&self, name: &str) -> Result<&str, Problem> {
        self.get(name).ok_or_else(|| missing(NRRD, name))
    }
}

/// True for `LIST`, alone or with a dimension.
pub(super) fn is_list(data_file: &str) -> bool {
    let word = data_file.split_ascii_whitespace().next();
    matches!(word, Some("LIST" | "SKIPLIST"))
}

fn is_magic(line: &str) -> bool {
    line == "NRRD00.01"
        || line
            .strip_prefix("NRRD000")
            .is_some_and(|version| matches!(version, "1" | "2" | "3" | "4" | "5" | "6"))
}

fn known(word: &str) -> Option<&'static str> {
    let squeezed = |text: &str| text.replace(' ', "").to_ascii_lowercase();
    let word = squeezed(word);
    let word = if word == "centers" {
        "centerings"
    } else {
        &word
    };
    NAMES.into_iter().find(|name| squeezed(name) == word)
}
