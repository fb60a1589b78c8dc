//! The numbers of vertices, in words or bytes.

use crate::format::convert::{Endian, decoded, to_u64};
use crate::format::place::open_regular;
use crate::format::ply::{Element, Encoding, Head, PLY};
use crate::format::points::gathered::{Gathered, Row};
use crate::format::points::roles::Roles;
use crate::format::problem::{self, invalid, unsupported};
use crate::format::text::number;
use crate::volume::{Limits, Problem, VoxelType};
use glam::DVec3;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// Gathers the vertices, seen to be there.
pub(super) fn read(
    path: &Path,
    head: &Head,
    vertices: &Element,
    roles: &Roles,
    limits: &Limits,
    gathered: &mut Gathered,
) -> Result<(), Problem> {
    let (mut file, metadata) = open_regular(path)?;
    file.seek(SeekFrom::Start(head.data_begins))
        .map_err(problem::io("going to the vertices"))?;
    let present = metadata.len().saturating_sub(head.data_begins);
    let before = head.elements.iter().take_while(|e| e.name != "vertex");
    let before: Vec<&Element> = before.collect();
    let input = BufReader::new(file);
    match head.encoding {
        Encoding::Words => {
            let lines = before.iter().map(|element| element.count);
            let skipped = lines.fold(0_u64, u64::saturating_add);
            let words = Words {
                input,
                line: head.lines,
                most_bytes: limits.max_header_bytes,
            };
            check_words(vertices, skipped, present)?;
            words.read(vertices, skipped, roles, gathered)
        }
        Encoding::LittleEndian => {
            let start = Start::of(&before, vertices, present)?;
            start.read(input, Endian::Little, vertices, roles, gathered)
        }
        Encoding::BigEndian => {
            let start = Start::of(&before, vertices, present)?;
            start.read(input, Endian::Big, vertices, roles, gathered)
        }
    }
}

/// The row of a vertex whose properties are known.
fn row(roles: &Roles, property: impl Fn(usize) -> f64) -> Row {
    Row {
        place: DVec3::from_array(roles.places.map(&property)),
        value: property(roles.value.index),
        std: roles.std.as_ref().map(|column| property(column.index)),
        weight: roles.weight.as_ref().map(|column| property(column.index)),
    }
}

/// A digit and a space or line end for each number, and a line end for each line before.
fn check_words(vertices: &Element, skipped: u64, present: u64) -> Result<(), Problem> {
    let properties = to_u64(vertices.properties.len()).max(1);
    let least = vertices
        .count
        .saturating_mul(properties)
        .saturating_mul(2)
        .saturating_add(skipped);
    size(least, present)
}

fn size(wanted_bytes: u64, found_bytes: u64) -> Result<(), Problem> {
    if wanted_bytes <= found_bytes {
        return Ok(());
    }
    let found = format!("{found_bytes} bytes behind the header");
    let wanted = format!("at least the {wanted_bytes} bytes that it promises");
    Err(invalid(PLY, "element vertex", wanted, &found))
}

/// Lines of numbers.
struct Words {
    input: BufReader<File>,
    line: u64,
    most_bytes: usize,
}

impl Words {
    fn read(
        mut self,
        vertices: &Element,
        skipped: u64,
        roles: &Roles,
        gathered: &mut Gathered,
    ) -> Result<(), Problem> {
        for _ in 0..skipped {
            self.line()?;
        }
        let wanted = vertices.properties.len();
        for _ in 0..vertices.count {
            let text = self.line()?;
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            if words.len() != wanted {
                let field = format!("line {}", self.line);
                let wanted = format!("{wanted} numbers, one a property");
                return Err(invalid(PLY, &field, wanted, &words.len().to_string()));
            }
            let property = |index: usize| {
                let word = words.get(index);
                word.and_then(|word| number(word)).unwrap_or(f64::NAN)
            };
            gathered.push(row(roles, property))?;
        }
        Ok(())
    }

    /// The next line, which has an end: without one it may have lost digits.
    fn line(&mut self) -> Result<String, Problem> {
        self.line = self.line.saturating_add(1);
        let mut bytes = Vec::new();
        self.input
            .by_ref()
            .take(to_u64(self.most_bytes).saturating_add(1))
            .read_until(b'\n', &mut bytes)
            .map_err(problem::io("reading the vertices"))?;
        if bytes.len() > self.most_bytes {
            return Err(Problem::Limit {
                what: "a line".to_owned(),
                wanted_bytes: to_u64(bytes.len()),
                limit_bytes: to_u64(self.most_bytes),
            });
        }
        if bytes.last() != Some(&b'\n') {
            let field = format!("line {}", self.line);
            let found = String::from_utf8_lossy(&bytes).into_owned();
            return Err(invalid(PLY, &field, "a line with its end", &found));
        }
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}

/// Where vertices of bytes begin, and how long they are.
struct Start {
    skip_bytes: u64,
    row_bytes: usize,
}

impl Start {
    fn of(before: &[&Element], vertices: &Element, present: u64) -> Result<Self, Problem> {
        let skip = before.iter().try_fold(0_u64, |sum, element| {
            Some(sum.saturating_add(element.bytes()?.saturating_mul(element.count)))
        });
        let skip_bytes = skip.ok_or_else(|| {
            unsupported(
                PLY,
                "an element of lists before the vertices of a binary file",
            )
        })?;
        let row_bytes = vertices.bytes().unwrap_or(0);
        let wanted = vertices.count.saturating_mul(row_bytes);
        size(skip_bytes.saturating_add(wanted), present)?;
        Ok(Self {
            skip_bytes,
            row_bytes: usize::try_from(row_bytes).unwrap_or(0),
        })
    }

    fn read(
        &self,
        mut input: BufReader<File>,
        endian: Endian,
        vertices: &Element,
        roles: &Roles,
        gathered: &mut Gathered,
    ) -> Result<(), Problem> {
        let reading = "reading the vertices";
        let skip = i64::try_from(self.skip_bytes).unwrap_or(i64::MAX);
        input.seek_relative(skip).map_err(problem::io(reading))?;
        let places = places(vertices);
        let mut bytes = vec![0; self.row_bytes];
        for _ in 0..vertices.count {
            input.read_exact(&mut bytes).map_err(problem::io(reading))?;
            let property = |index: usize| {
                let found = places.get(index);
                found.map_or(f64::NAN, |&(start, stored)| {
                    decoded(bytes.get(start..).unwrap_or_default(), stored, endian)
                })
            };
            gathered.push(row(roles, property))?;
        }
        Ok(())
    }
}

/// Where in a vertex each property stands, and its type.
fn places(vertices: &Element) -> Vec<(usize, VoxelType)> {
    let mut start = 0_usize;
    let types = vertices.properties.iter().map(|p| p.stored);
    types
        .map(|stored| {
            let place = (start, stored);
            start = start.saturating_add(stored.bytes());
            place
        })
        .collect()
}
