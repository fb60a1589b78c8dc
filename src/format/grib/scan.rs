//! The messages of a file: every section's number and length, compared with the file before a decoder sees it.

use super::lat_lon::{self, LatLon};
use super::product::{self, Product};
use super::section::{Place, Section};
use super::{GRIB, MAGIC, guard, refusal};
use crate::format::place::open_regular;
use crate::format::problem::{invalid, io};
use crate::volume::{Limits, Problem};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// One field of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Field {
    pub grid: LatLon,
    pub product: Product,
    pub packing: Place,
    /// `None` where every point has a number.
    pub bitmap: Option<Place>,
    pub data: Place,
}

/// All fields of a file.
pub(super) struct Scan {
    pub fields: Vec<Field>,
    /// Why fields are left out, and how many.
    pub left_out: BTreeMap<String, u32>,
}

/// More octets of a section tell nothing that we ask.
const HEAD: u32 = 128;

const END: &[u8; 4] = b"7777";

/// Reads the heads of all sections.
pub(super) fn scan(path: &Path, limits: &Limits) -> Result<Scan, Problem> {
    let (file, metadata) = open_regular(path)?;
    let mut scanner = Scanner {
        input: BufReader::new(file),
        at: 0,
        end: metadata.len(),
        limits,
        scan: Scan {
            fields: Vec::new(),
            left_out: BTreeMap::new(),
        },
        count: 0,
    };
    while scanner.skip_zeros()? {
        scanner.message()?;
    }
    Ok(scanner.scan)
}

struct Scanner<'a> {
    input: BufReader<File>,
    at: u64,
    end: u64,
    limits: &'a Limits,
    scan: Scan,
    count: usize,
}

/// What holds for the fields that follow.
#[derive(Default)]
struct State {
    grid: Option<Result<LatLon, String>>,
    product: Option<Result<Product, String>>,
    packing: Option<(Place, Section)>,
    /// The outer `None` before any section 6.
    bitmap: Option<Option<Place>>,
    /// The bitmap that "as before" means.
    last_bitmap: Option<Place>,
}

impl Scanner<'_> {
    fn read(&mut self, length: u32) -> Result<Vec<u8>, Problem> {
        let mut octets = Vec::new();
        let wanted = u64::from(length);
        let found = self.input.by_ref().take(wanted).read_to_end(&mut octets);
        found.map_err(io("reading sections"))?;
        if u32::try_from(octets.len()) != Ok(length) {
            let wanted = format!("{length} octets at {}", self.at);
            return Err(invalid(GRIB, "file", wanted, &octets.len().to_string()));
        }
        self.at = self.at.saturating_add(wanted);
        Ok(octets)
    }

    fn go_to(&mut self, at: u64) -> Result<(), Problem> {
        let step = i64::try_from(at).ok().zip(i64::try_from(self.at).ok());
        let moved = match step {
            Some((to, from)) => self.input.seek_relative(to.saturating_sub(from)),
            None => self.input.seek(SeekFrom::Start(at)).map(|_| ()),
        };
        moved.map_err(io("reading sections"))?;
        self.at = at;
        Ok(())
    }

    /// Zeros between messages, and behind the last, fill blocks. False at the end of the file.
    fn skip_zeros(&mut self) -> Result<bool, Problem> {
        while self.at < self.end {
            if self.read(1)? != [0] {
                self.go_to(self.at.saturating_sub(1))?;
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn message(&mut self) -> Result<(), Problem> {
        let start = self.at;
        let indicator = Section {
            number: 0,
            octets: self.read(16)?,
        };
        if !indicator.octets.starts_with(MAGIC) {
            let wanted = format!("a message at octet {start}");
            let found = String::from_utf8_lossy(&indicator.octets);
            return Err(invalid(GRIB, "section 0", wanted, &found));
        }
        let edition = indicator.u8(8)?;
        if edition != 2 {
            return Err(refusal(edition));
        }
        let length = u64::from(indicator.u32(9)?) << 32 | u64::from(indicator.u32(13)?);
        let end = start.checked_add(length).filter(|end| *end <= self.end);
        let end = end.filter(|_| length >= 20).ok_or_else(|| {
            let wanted = format!("20 to {} octets", self.end.saturating_sub(start));
            invalid(GRIB, "length of a message", wanted, &length.to_string())
        })?;
        let sections_end = end.saturating_sub(4);
        let discipline = indicator.u8(7)?;
        let mut state = State::default();
        let mut identification = None;
        let mut last = 0;
        while self.at < sections_end {
            let (section, place) = self.section(sections_end)?;
            if !follows(last, section.number) {
                let wanted = format!("a section that follows section {last}");
                let found = section.number.to_string();
                return Err(invalid(GRIB, "number of a section", wanted, &found));
            }
            last = section.number;
            match &identification {
                None => identification = Some(section),
                Some(identification) => {
                    self.take(&mut state, discipline, identification, section, place)?;
                }
            }
            self.go_to(place.start.saturating_add(place.length.into()))?;
        }
        if last != 7 {
            let wanted = "section 7 before the end of the message";
            return Err(invalid(
                GRIB,
                "number of a section",
                wanted,
                &last.to_string(),
            ));
        }
        let found = self.read(4)?;
        if found != END {
            let found = String::from_utf8_lossy(&found);
            return Err(invalid(GRIB, "section 8", "7777", &found));
        }
        Ok(())
    }

    /// The head of the section here, which must end before `end`.
    fn section(&mut self, end: u64) -> Result<(Section, Place), Problem> {
        let start = self.at;
        let room = end.saturating_sub(start);
        let wrong = |found: u64| {
            let wanted = format!("5 to {room} octets at {start}");
            invalid(GRIB, "length of a section", wanted, &found.to_string())
        };
        if room < 5 {
            return Err(wrong(room));
        }
        let mut octets = self.read(5)?;
        let head = Section {
            number: 0,
            octets: octets.clone(),
        };
        let (length, number) = (head.u32(1)?, head.u8(5)?);
        if length < 5 || u64::from(length) > room {
            return Err(wrong(length.into()));
        }
        octets.extend(self.read(length.min(HEAD).saturating_sub(5))?);
        Ok((Section { number, octets }, Place { start, length }))
    }

    fn take(
        &mut self,
        state: &mut State,
        discipline: u8,
        identification: &Section,
        section: Section,
        place: Place,
    ) -> Result<(), Problem> {
        match section.number {
            3 => state.grid = Some(lat_lon::grid(&section, self.limits)?),
            4 => state.product = Some(product::product(discipline, identification, &section)?),
            5 => state.packing = Some((place, section)),
            6 => {
                let bitmap = match section.u8(6)? {
                    0 => Some(place),
                    255 => None,
                    254 => Some(state.last_bitmap.ok_or_else(|| {
                        let wanted = "a bitmap before one that is the same";
                        invalid(GRIB, "section 6", wanted, "none")
                    })?),
                    other => {
                        let wanted = "a bitmap of its own, that of the field before, or none";
                        return Err(invalid(GRIB, "section 6", wanted, &other.to_string()));
                    }
                };
                state.last_bitmap = bitmap.or(state.last_bitmap);
                state.bitmap = Some(bitmap);
            }
            7 => self.field(state, place)?,
            _ => {}
        }
        Ok(())
    }

    fn field(&mut self, state: &State, data: Place) -> Result<(), Problem> {
        self.count = self.count.saturating_add(1);
        if self.count > self.limits.max_files {
            let wanted = format!("at most {} fields", self.limits.max_files);
            return Err(invalid(GRIB, "messages", wanted, "more"));
        }
        let (Some(grid), Some(product), Some((packing, section)), Some(bitmap)) =
            (&state.grid, &state.product, &state.packing, state.bitmap)
        else {
            let wanted = "sections 3, 4, 5 and 6 before section 7";
            return Err(invalid(GRIB, "section 7", wanted, "fewer"));
        };
        let mut leave = |why: &String| {
            let count = self.scan.left_out.entry(why.clone()).or_insert(0);
            *count = count.saturating_add(1);
            Ok(())
        };
        let (grid, product) = match (grid, product) {
            (Ok(grid), Ok(product)) => (*grid, *product),
            (Err(why), _) | (_, Err(why)) => return leave(why),
        };
        if let Some(why) = guard::refused(section)? {
            return leave(&why);
        }
        guard::check(section, grid.points(), bitmap, data)?;
        self.scan.fields.push(Field {
            grid,
            product,
            packing: *packing,
            bitmap,
            data,
        });
        Ok(())
    }
}

/// The order of sections; those from 2, 3 and 4 on may repeat.
fn follows(last: u8, next: u8) -> bool {
    match last {
        1 => matches!(next, 2 | 3),
        7 => matches!(next, 2..=4),
        _ => next == last.saturating_add(1),
    }
}
