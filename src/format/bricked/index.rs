//! The index of a file of bricks: what is in it, and where.

use super::BRICKS;
use super::lines::Lines;
use crate::format::convert::to_u64;
use crate::format::problem::{self, invalid, missing};
use crate::volume::{Format, Header, Limits, Problem, Rescale, TimeComponent, VoxelBox};
use glam::{DAffine3, DVec3};
use std::io::{Read, Seek, SeekFrom};

/// The first bytes.
pub(crate) const MAGIC: &[u8] = b"stratavox bricks";

/// Bytes before the first brick: the magic, where the index begins, how long it is.
pub(crate) const FRONT_BYTES: u64 = 32;

/// Bytes of an entry.
const ENTRY_BYTES: u64 = 28;

/// The number of the format that this is.
const VERSION: &str = "1";

/// Neighbours beyond which no reader looks.
const MOST_HALO: u32 = 16;

/// What a file holds.
#[derive(Clone, Debug)]
pub(crate) struct Index {
    /// Of level 0.
    pub header: Header,
    /// Voxels of its own along each side of a brick.
    pub side: u32,
    /// Voxels of its neighbours on each side.
    pub halo: u32,
    pub has_holes: bool,
    pub levels: Vec<Level>,
}

/// One resolution.
#[derive(Clone, Debug)]
pub(crate) struct Level {
    pub dims: [u32; 3],
    /// Largest and root-mean-square difference of stored numbers to level 0.
    pub error: [f64; 2],
    /// Of each time, component and brick.
    pub entries: Vec<Entry>,
}

/// One brick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Entry {
    pub begins: u64,
    pub bytes: u32,
    pub coding: Coding,
    /// Smallest and largest valid stored number; NaN where none is.
    pub low: f32,
    pub high: f32,
    /// CRC-32 of its bytes.
    pub checksum: u32,
}

/// CRC-32, as gzip has it.
pub(crate) fn checksum(bytes: &[u8]) -> u32 {
    let mut crc = flate2::Crc::new();
    crc.update(bytes);
    crc.sum()
}

/// How the numbers of a brick are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coding {
    /// One number that all are.
    Same,
    /// As they are.
    Plain,
    /// A block of LZ4.
    Lz4,
}

impl Coding {
    const ALL: [Self; 3] = [Self::Same, Self::Plain, Self::Lz4];

    pub(crate) fn of_word(word: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|known| known.word() == word)
    }

    pub(crate) fn word(self) -> u32 {
        match self {
            Self::Same => 0,
            Self::Plain => 1,
            Self::Lz4 => 2,
        }
    }
}

impl Level {
    /// One without bricks yet.
    pub(crate) fn new(dims: [u32; 3]) -> Self {
        Self {
            dims,
            error: [0.0; 2],
            entries: Vec::new(),
        }
    }

    pub(crate) fn whole(&self) -> VoxelBox {
        VoxelBox {
            min: [0; 3],
            max: self.dims,
        }
    }

    pub(crate) fn voxel_count(&self) -> u64 {
        let count = |product: u64, &n: &u32| product.saturating_mul(n.into());
        self.dims.iter().fold(1, count)
    }

    /// How many bricks there are along each axis.
    pub(crate) fn counts(&self, side: u32) -> [u32; 3] {
        self.dims.map(|n| n.div_ceil(side.max(1)))
    }

    pub(crate) fn brick_count(&self, side: u32) -> u64 {
        let count = |product: u64, n: u32| product.saturating_mul(n.into());
        self.counts(side).into_iter().fold(1, count)
    }
}

impl Index {
    /// What level `k` of this volume is like: half as many voxels along each axis each time.
    pub(crate) fn header_of(&self, level: u32) -> Header {
        let dims = self.levels.get(level as usize).map(|level| level.dims);
        let scale = DAffine3::from_scale(DVec3::splat(f64::from(level).exp2()));
        Header {
            dims: dims.unwrap_or(self.header.dims),
            levels: u32::try_from(self.levels.len()).unwrap_or(u32::MAX),
            #[allow(clippy::arithmetic_side_effects, reason = "f64: nothing wraps")]
            world_from_voxel: self.header.world_from_voxel * scale,
            ..self.header.clone()
        }
    }

    /// Largest and root-mean-square difference of values to level 0; `None` of level 0 itself.
    pub(crate) fn error_of(&self, level: u32) -> Option<[f64; 2]> {
        let found = self.levels.get(level as usize).filter(|_| level > 0)?;
        let slope = self.header.rescale.slope.abs();
        Some(found.error.map(|error| error.mul_add(slope, 0.0)))
    }

    /// The bricks of one time and component, x fastest.
    pub(crate) fn entries_of(&self, level: u32, pick: TimeComponent) -> Option<&[Entry]> {
        let found = self.levels.get(level as usize)?;
        let count = usize::try_from(found.brick_count(self.side)).ok()?;
        let volume = u64::from(pick.time)
            .checked_mul(self.header.components.into())?
            .checked_add(pick.component.into())?;
        let first = usize::try_from(volume).ok()?.checked_mul(count)?;
        found.entries.get(first..first.checked_add(count)?)
    }

    /// The index as it stands in a file.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let header = &self.header;
        let rows = header.world_from_voxel.to_cols_array();
        let words = |numbers: &[f64]| {
            let words: Vec<String> = numbers.iter().map(|n| format!("{n:?}")).collect();
            words.join(" ")
        };
        let whole = |numbers: &[u32]| {
            let words: Vec<String> = numbers.iter().map(u32::to_string).collect();
            words.join(" ")
        };
        let yes = |is: bool| if is { "yes" } else { "no" };
        let mut text = String::new();
        let mut line = |key: &str, words: &str| {
            text.push_str(key);
            text.push_str(": ");
            // A line ends where the file's words do.
            text.extend(words.chars().filter(|c| !c.is_control()));
            text.push('\n');
        };
        line("version", VERSION);
        line("dims", &whole(&header.dims));
        line("type", header.stored.name());
        line("components", &header.components.to_string());
        line("times", &header.times.to_string());
        line("side", &self.side.to_string());
        line("halo", &self.halo.to_string());
        line("world_from_voxel", &words(&rows));
        line(
            "rescale",
            &words(&[header.rescale.slope, header.rescale.intercept]),
        );
        if let Some(fill) = header.fill {
            line("fill", &words(&[fill]));
        }
        if let Some(unit) = &header.unit {
            line("unit", unit);
        }
        line("hounsfield", yes(header.hounsfield));
        line("labels", yes(header.is_labels));
        line("earth", yes(header.is_earth));
        // Files of older versions have none of these lines.
        if let Some(name) = &header.long_name {
            line("long_name", name);
        }
        if header.is_patient {
            line("patient", yes(true));
        }
        if let Some(metres) = header.length_metres {
            line("length_metres", &words(&[metres]));
        }
        if header.degree_lengths != [None; 2] {
            let lengths = header.degree_lengths.map(|length| length.unwrap_or(0.0));
            line("degree_lengths", &words(&lengths));
        }
        line("holes", yes(self.has_holes));
        for level in &self.levels {
            line(
                "level",
                &format!("{} {}", whole(&level.dims), words(&level.error)),
            );
        }
        text.push('\n');
        let mut bytes = text.into_bytes();
        for entry in self.levels.iter().flat_map(|level| &level.entries) {
            bytes.extend(entry.begins.to_le_bytes());
            bytes.extend(entry.bytes.to_le_bytes());
            bytes.extend(entry.coding.word().to_le_bytes());
            bytes.extend(entry.low.to_le_bytes());
            bytes.extend(entry.high.to_le_bytes());
            bytes.extend(entry.checksum.to_le_bytes());
        }
        bytes
    }

    /// Reads the index of a file of so many bytes, and compares what it says with what is there.
    pub(crate) fn read(
        file: &mut (impl Read + Seek),
        file_bytes: u64,
        limits: &Limits,
    ) -> Result<Self, Problem> {
        let reading = problem::io("reading the index");
        let mut front = [0; 32];
        let got = file
            .seek(SeekFrom::Start(0))
            .and_then(|_| file.read_exact(&mut front));
        got.map_err(reading)?;
        let number = |from: usize| {
            let bytes = front.get(from..).and_then(<[u8]>::first_chunk::<8>);
            bytes.map_or(0, |bytes| u64::from_le_bytes(*bytes))
        };
        let (begins, bytes) = (number(16), number(24));
        if [begins, bytes] == [0; 2] {
            return Err(missing(
                BRICKS,
                "an end: whoever wrote the file was stopped",
            ));
        }
        let end = begins.checked_add(bytes);
        if begins < FRONT_BYTES || end != Some(file_bytes) {
            return Err(Problem::Size {
                format: BRICKS,
                wanted_bytes: end.unwrap_or(u64::MAX),
                found_bytes: file_bytes,
            });
        }
        if bytes > limits.max_bytes {
            return Err(Problem::Limit {
                what: "the index".to_owned(),
                wanted_bytes: bytes,
                limit_bytes: limits.max_bytes,
            });
        }
        file.seek(SeekFrom::Start(begins))
            .map_err(problem::io("looking for the index"))?;
        let mut index = Vec::new();
        file.take(bytes)
            .read_to_end(&mut index)
            .map_err(problem::io("reading the index"))?;
        Self::parse(&index, begins, limits)
    }

    fn parse(bytes: &[u8], index_begins: u64, limits: &Limits) -> Result<Self, Problem> {
        let most = limits.max_header_bytes.min(bytes.len());
        let head = bytes.get(..most).unwrap_or_default();
        let end = head.windows(2).position(|pair| pair == b"\n\n");
        let end = end.ok_or_else(|| missing(BRICKS, "an empty line behind the header"))?;
        let text = String::from_utf8_lossy(bytes.get(..end).unwrap_or_default());
        let table = bytes.get(end.saturating_add(2)..).unwrap_or_default();
        let mut lines = Lines::of(&text)?;
        match lines.take("version")?.as_str() {
            VERSION => {}
            other => {
                let what = format!("version {}", problem::escape(other));
                return Err(problem::unsupported(BRICKS, what));
            }
        }
        let stored = lines.stored()?;
        let mut header = Header::new(
            Format::Bricks,
            lines.whole("dims")?,
            stored,
            DAffine3::IDENTITY,
        );
        header.components = lines.positive("components")?;
        header.times = lines.positive("times")?;
        header.world_from_voxel = lines.affine()?;
        let [slope, intercept] = lines.numbers(
            "rescale",
            "a finite slope that is not zero, and a finite number",
        )?;
        header.rescale = Rescale { slope, intercept };
        if !slope.is_normal() {
            let wanted = "a finite slope that is not zero, and a finite number";
            return Err(invalid(BRICKS, "rescale", wanted, &slope.to_string()));
        }
        header.fill = match lines.values.contains_key("fill") {
            true => Some(lines.numbers::<1>("fill", "a finite number")?[0]),
            false => None,
        };
        header.unit = lines.values.remove("unit");
        header.hounsfield = lines.yes("hounsfield")?;
        header.is_labels = lines.yes("labels")?;
        header.is_earth = lines.yes("earth")?;
        header.long_name = lines.values.remove("long_name");
        header.is_patient = lines.values.contains_key("patient") && lines.yes("patient")?;
        header.length_metres = match lines.values.contains_key("length_metres") {
            true => Some(lines.numbers::<1>("length_metres", "a number of metres")?[0]),
            false => None,
        };
        if lines.values.contains_key("degree_lengths") {
            let wanted = "two lengths, 0 where there is none";
            let lengths = lines.numbers::<2>("degree_lengths", wanted)?;
            header.degree_lengths = lengths.map(|length| (length > 0.0).then_some(length));
        }
        let mut index = Self {
            side: lines.positive("side")?,
            halo: lines.positive("halo")?,
            has_holes: lines.yes("holes")?,
            levels: Vec::new(),
            header,
        };
        if index.halo > MOST_HALO {
            let found = index.halo.to_string();
            return Err(invalid(BRICKS, "halo", format!("1 to {MOST_HALO}"), &found));
        }
        index.add_levels(&lines.levels, table, index_begins)?;
        Ok(index)
    }

    fn add_levels(
        &mut self,
        lines: &[String],
        table: &[u8],
        index_begins: u64,
    ) -> Result<(), Problem> {
        let volumes = u64::from(self.header.components).saturating_mul(self.header.times.into());
        let mut rest = table;
        let mut dims = self.header.dims;
        for (nth, line) in lines.iter().enumerate() {
            let wanted = "three sizes, those before halved, and two finite numbers";
            let wrong = || invalid(BRICKS, "level", wanted, line);
            let words: Vec<&str> = line.split(' ').collect();
            let [x, y, z, largest, rms] = words[..] else {
                return Err(wrong());
            };
            let found = [x, y, z].map(|word| word.parse::<u32>().unwrap_or(0));
            if nth > 0 {
                dims = dims.map(|n| n.div_ceil(2));
            }
            let error = [largest, rms].map(|word| word.parse::<f64>().unwrap_or(f64::NAN));
            if found != dims || !error.iter().all(|error| error.is_finite()) {
                return Err(wrong());
            }
            let mut level = Level {
                dims,
                error,
                entries: Vec::new(),
            };
            let count = level.brick_count(self.side).saturating_mul(volumes);
            let bytes = count.saturating_mul(ENTRY_BYTES);
            let of_level = usize::try_from(bytes).ok();
            let Some((entries, more)) = of_level.and_then(|n| rest.split_at_checked(n)) else {
                return Err(Problem::Size {
                    format: BRICKS,
                    wanted_bytes: bytes,
                    found_bytes: to_u64(rest.len()),
                });
            };
            rest = more;
            for entry in entries.as_chunks::<28>().0 {
                level.entries.push(entry_of(entry, index_begins)?);
            }
            self.levels.push(level);
        }
        if self.levels.is_empty() {
            return Err(missing(BRICKS, "level"));
        }
        if !rest.is_empty() {
            return Err(Problem::Size {
                format: BRICKS,
                wanted_bytes: to_u64(table.len().saturating_sub(rest.len())),
                found_bytes: to_u64(table.len()),
            });
        }
        Ok(())
    }
}

fn entry_of(bytes: &[u8; 28], index_begins: u64) -> Result<Entry, Problem> {
    let word = |from: usize| {
        let word = bytes.get(from..).and_then(<[u8]>::first_chunk::<4>);
        word.map_or(0, |word| u32::from_le_bytes(*word))
    };
    let begins = u64::from(word(4)) << 32 | u64::from(word(0));
    let (length, coding) = (word(8), word(12));
    let is_inside = begins >= FRONT_BYTES
        && begins
            .checked_add(length.into())
            .is_some_and(|end| end <= index_begins);
    let found = format!("bytes {begins} to {begins} + {length}");
    if !is_inside {
        let wanted = "a place between the front and the index";
        return Err(invalid(BRICKS, "begins", wanted, &found));
    }
    let known = Coding::of_word(coding);
    let coding = known.ok_or_else(|| {
        let wanted = "0, 1 or 2";
        invalid(BRICKS, "coding", wanted, &coding.to_string())
    })?;
    Ok(Entry {
        begins,
        bytes: length,
        coding,
        low: f32::from_bits(word(16)),
        high: f32::from_bits(word(20)),
        checksum: word(24),
    })
}
