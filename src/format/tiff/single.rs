//! One file: its chain of pages, and what the first page says about all.

use super::TIFF;
use super::ifd::{self, Directory, Reader};
use super::length::Spacing;
use super::page::Page;
use super::source::PageAt;
use crate::format::problem::invalid;
use crate::volume::{Limits, Problem};
use std::collections::BTreeSet;
use std::path::Path;

/// A file and where its pages are.
#[derive(Debug)]
pub(super) struct Single {
    pub reader: Reader,
    /// The directory of each page.
    pub pages: Vec<u64>,
    /// The number of each page in the file.
    numbers: Vec<usize>,
}

impl Single {
    /// Follows the chain of directories to its end.
    pub(super) fn open(path: &Path, limits: &Limits) -> Result<Self, Problem> {
        let mut reader = Reader::open(path)?;
        let mut seen = BTreeSet::new();
        let mut pages = Vec::new();
        let mut next = reader.first_ifd;
        while next != 0 {
            if !seen.insert(next) {
                let wanted = "pages that come to an end";
                let found = format!("page {} again", pages.len());
                return Err(invalid(TIFF, "next directory", wanted, &found));
            }
            if pages.len() >= limits.max_files {
                let wanted = format!("at most {} pages", limits.max_files);
                return Err(invalid(TIFF, "pages", wanted, "more"));
            }
            pages.push(next);
            next = reader.directory(next)?.next;
        }
        if pages.is_empty() {
            return Err(invalid(TIFF, "first directory", "a page", "none"));
        }
        let numbers = (0..pages.len()).collect();
        Ok(Self {
            reader,
            pages,
            numbers,
        })
    }

    /// The pages as those of the file of this index.
    pub(super) fn places(&self, file: usize) -> impl Iterator<Item = PageAt> + '_ {
        let pages = self.pages.iter().zip(&self.numbers);
        pages.map(move |(&ifd, &number)| PageAt { file, ifd, number })
    }

    fn first_directory(&mut self) -> Result<Directory, Problem> {
        let at = self.pages.first().copied().unwrap_or(0);
        self.reader.directory(at)
    }

    /// One page; of one that is not there, that there is none.
    pub(super) fn page(&mut self, index: u64, limits: &Limits) -> Result<Page, Problem> {
        let at = usize::try_from(index)
            .ok()
            .and_then(|index| self.pages.get(index));
        let count = self.pages.len();
        let &at = at.ok_or_else(|| {
            let wanted = format!("one of {count} pages");
            invalid(TIFF, "page", wanted, &index.to_string())
        })?;
        let directory = self.reader.directory(at)?;
        Page::read(&mut self.reader, &directory, limits)
    }

    /// The first page's description; UTF-8, or else Latin-1.
    pub(super) fn description(&mut self, limits: &Limits) -> Result<String, Problem> {
        let directory = self.first_directory()?;
        let limit = limits.max_header_bytes;
        let bytes = self
            .reader
            .blob(&directory, ifd::IMAGE_DESCRIPTION, limit)?
            .unwrap_or_default();
        let end = bytes.iter().position(|&byte| byte == 0);
        let text = bytes.get(..end.unwrap_or(bytes.len())).unwrap_or_default();
        Ok(match std::str::from_utf8(text) {
            Ok(text) => text.to_owned(),
            Err(_) => text.iter().copied().map(char::from).collect(),
        })
    }

    /// Leaves out pages that say that they are thumbnails, smaller copies or masks of others.
    pub(super) fn skip_small_copies(&mut self, notes: &mut Vec<String>) -> Result<(), Problem> {
        let mut kept = Vec::new();
        let mut skipped = Vec::new();
        for place in self.places(0).collect::<Vec<_>>() {
            let directory = self.reader.directory(place.ifd)?;
            let bits = self.reader.integer(&directory, ifd::NEW_SUBFILE_TYPE)?;
            let old = self.reader.integer(&directory, ifd::SUBFILE_TYPE)?;
            // Bit 0: a smaller copy; bit 2: a mask. The older tag calls a smaller copy 2.
            let is_copy = bits.is_some_and(|bits| bits & 5 != 0) || old == Some(2);
            match is_copy {
                true => skipped.push(place.number),
                false => kept.push(place),
            }
        }
        if kept.is_empty() {
            return Ok(());
        }
        if let Some(first) = skipped.first() {
            notes.push(format!(
                "{} pages (the first is page {first}) are smaller copies or masks of others: they are left out",
                skipped.len()
            ));
        }
        self.pages = kept.iter().map(|place| place.ifd).collect();
        self.numbers = kept.iter().map(|place| place.number).collect();
        Ok(())
    }

    /// Pixels per unit of length along x and y, whatever the unit is.
    pub(super) fn resolution(&mut self) -> Result<[Option<f64>; 2], Problem> {
        let directory = self.first_directory()?;
        let x = self.reader.fraction(&directory, ifd::X_RESOLUTION)?;
        let y = self.reader.fraction(&directory, ifd::Y_RESOLUTION)?;
        Ok([x, y])
    }

    /// The size of a pixel, where the file gives it in inches or centimetres: in millimetres.
    #[allow(clippy::arithmetic_side_effects, reason = "floats")]
    pub(super) fn spacing(&mut self) -> Result<Spacing, Problem> {
        let directory = self.first_directory()?;
        let unit = self.reader.integer(&directory, ifd::RESOLUTION_UNIT)?;
        let [x, y] = self.resolution()?;
        Ok(match (unit.unwrap_or(2), x, y) {
            (2, Some(x), Some(y)) => Spacing {
                steps: [Some(25.4 / x), Some(25.4 / y), None],
                unit: Some("mm"),
            },
            (3, Some(x), Some(y)) => Spacing {
                steps: [Some(10.0 / x), Some(10.0 / y), None],
                unit: Some("mm"),
            },
            // Without a unit the two only say how wide a pixel is for its height.
            (1, Some(x), Some(y)) if x != y => Spacing {
                steps: [Some(1.0), Some(x / y), Some(1.0)],
                unit: None,
            },
            _ => Spacing::default(),
        })
    }
}
