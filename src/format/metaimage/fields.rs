//! The lines of a MetaImage header: `Name = value`, of which `ElementDataFile` is the last.
//!
//! MetaIO documentation, docs.itk.org/en/latest/learn/metaio.html, "Reference: Tags of MetaImage".

use super::METAIMAGE;
use crate::format::place::open_regular;
use crate::format::problem::{invalid, missing};
use crate::format::text::{Lines, integers, numbers};
use crate::volume::Problem;
use std::collections::BTreeMap;
use std::io::BufReader;
use std::path::Path;

/// A header taken apart.
#[derive(Debug, Default)]
pub(super) struct Fields {
    values: BTreeMap<String, String>,
    /// Names behind `ElementDataFile = LIST`.
    pub listed_files: Vec<String>,
    /// Where the data begins of a file that is its own `ElementDataFile`.
    pub header_bytes: u64,
    /// True where the file stops inside the last line of the header.
    pub is_cut: bool,
}

impl Fields {
    /// Reads a header, at most `limit_bytes` of it.
    pub(super) fn read(path: &Path, limit_bytes: usize) -> Result<Self, Problem> {
        let (file, _) = open_regular(path)?;
        let mut lines = Lines::new(BufReader::new(file), limit_bytes);
        let mut fields = Self::default();
        while let Some(line) = lines.next()? {
            if line.text.trim().is_empty() {
                continue;
            }
            let Some((name, value)) = line.text.split_once(['=', ':']) else {
                let wanted = "`Name = value`";
                return Err(invalid(METAIMAGE, "header line", wanted, &line.text));
            };
            let (name, value) = (name.trim(), value.trim());
            let is_last = name == "ElementDataFile";
            if fields
                .values
                .insert(name.to_owned(), value.to_owned())
                .is_some()
            {
                let wanted = "at most one line of this field";
                return Err(invalid(METAIMAGE, name, wanted, value));
            }
            if is_last {
                fields.is_cut = !line.ended;
                break;
            }
        }
        fields.header_bytes = lines.position();
        if fields.data_file()?.starts_with("LIST") {
            while let Some(line) = lines.next()? {
                fields.is_cut |= !line.ended;
                let name = line.text.trim();
                if !name.is_empty() {
                    fields.listed_files.push(name.to_owned());
                }
            }
        }
        Ok(fields)
    }

    /// What stands behind the field, if it is there.
    pub(super) fn get(&self, name: &str) -> Option<&str> {
        self.values.get(name).map(String::as_str)
    }

    /// What stands behind a field that must be there.
    pub(super) fn required(&self, name: &str) -> Result<&str, Problem> {
        self.get(name).ok_or_else(|| missing(METAIMAGE, name))
    }

    /// Where the voxels are.
    pub(super) fn data_file(&self) -> Result<&str, Problem> {
        self.required("ElementDataFile")
    }

    /// A field of `count` numbers; of several names for one thing the last that is there counts.
    pub(super) fn numbers(
        &self,
        names: &[&str],
        count: usize,
    ) -> Result<Option<Vec<f64>>, Problem> {
        let found = names
            .iter()
            .rev()
            .find_map(|name| Some((name, self.get(name)?)));
        let Some((name, text)) = found else {
            return Ok(None);
        };
        numbers(text)
            .filter(|all| all.len() == count && all.iter().all(|x| x.is_finite()))
            .map(Some)
            .ok_or_else(|| invalid(METAIMAGE, name, format!("{count} finite numbers"), text))
    }

    /// A field of one number.
    pub(super) fn number(&self, name: &str) -> Result<Option<f64>, Problem> {
        let all = self.numbers(&[name], 1)?;
        Ok(all.and_then(|all| all.first().copied()))
    }

    /// A field of one whole number.
    pub(super) fn integer(&self, name: &str) -> Result<Option<i64>, Problem> {
        let Some(text) = self.get(name) else {
            return Ok(None);
        };
        integers(text)
            .and_then(|all| <[i64; 1]>::try_from(all).ok())
            .map(|[number]| Some(number))
            .ok_or_else(|| invalid(METAIMAGE, name, "a whole number", text))
    }

    /// A field that says yes or no; MetaIO looks at the first letter.
    pub(super) fn flag(&self, name: &str) -> Result<Option<bool>, Problem> {
        match self.get(name) {
            None => Ok(None),
            Some(text) => match text.chars().next() {
                Some('T' | 't' | '1') => Ok(Some(true)),
                Some('F' | 'f' | '0') => Ok(Some(false)),
                _ => Err(invalid(METAIMAGE, name, "True or False", text)),
            },
        }
    }
}
