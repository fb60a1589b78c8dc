//! What is done of a file of bricks, a line of text for each row of them: who was stopped goes on behind the last.
//!
//! ```text
//! row HOLES LARGEST SUM COUNT CLAMPED NOT_FINITE ROUNDED [BEGINS BYTES CODING LOW HIGH CRC] ... end
//! ```
//!
//! Floats are their bits, so that nothing is lost on the way. Lines count as far as the bricks that they speak of are
//! in the file, compared by their checksums: whatever a kill or the loss of power leaves behind that is written again.

use super::Selection;
use super::bricks::SIDE;
use super::numbers::Tally;
use crate::format::bricked::{Coding, Entry, FRONT_BYTES, Level, checksum};
use crate::format::convert::to_u64;
use crate::volume::Difference;
use std::collections::VecDeque;
use std::io::{self, Read, Seek, SeekFrom};
use std::str::{FromStr, SplitWhitespace};

/// Neighbours along x that were written together, and what was known behind them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    pub entries: Vec<Entry>,
    /// Of these bricks alone to the level before.
    pub apart: Difference,
    /// Of all rows until here.
    pub tally: Tally,
    pub has_holes: bool,
}

/// The bricks of an unfinished file that are whole.
#[derive(Clone, Debug, Default)]
pub struct DoneBricks {
    pub(super) rows: VecDeque<Row>,
    end_bytes: u64,
}

impl DoneBricks {
    /// Those of the lines that were noted as `file` was written. Lines behind one that is torn, or whose bricks are not
    /// in the file as they were written, count for nothing.
    ///
    /// # Errors
    /// Where the file cannot be read.
    pub fn read<'a>(
        lines: impl IntoIterator<Item = &'a str>,
        file: &mut (impl Read + Seek),
    ) -> io::Result<Self> {
        let mut done = Self {
            rows: VecDeque::new(),
            end_bytes: FRONT_BYTES,
        };
        for row in lines.into_iter().map_while(Row::of_line) {
            let Some(end) = end_of(&row, done.end_bytes, file)? else {
                break;
            };
            done.end_bytes = end;
            done.rows.push_back(row);
        }
        Ok(done)
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.rows.iter().map(|row| row.entries.len()).sum()
    }

    /// In how many lines they were noted.
    pub fn rows(&self) -> usize {
        self.rows.len()
    }

    /// Where the last of them ends in the file: what lies behind is to be cut off.
    pub fn end_bytes(&self) -> u64 {
        self.end_bytes
    }

    /// True where no voxel of the source is wanted any more: coarser levels are made of finer ones.
    pub fn holds_all_voxels(&self, selection: &Selection) -> bool {
        let bricks = Level::new(selection.region.dims()).brick_count(SIDE);
        let wanted = [&selection.times, &selection.components]
            .into_iter()
            .fold(bricks, |n, range| n.saturating_mul(to_u64(range.len())));
        to_u64(self.count()) >= wanted
    }
}

/// Where the bricks of a row end, if they are there.
fn end_of(row: &Row, begins: u64, file: &mut (impl Read + Seek)) -> io::Result<Option<u64>> {
    let mut end = begins;
    file.seek(SeekFrom::Start(begins))?;
    for entry in &row.entries {
        let mut bytes = Vec::new();
        file.take(entry.bytes.into()).read_to_end(&mut bytes)?;
        let is_there = entry.begins == end && to_u64(bytes.len()) == u64::from(entry.bytes);
        if !is_there || checksum(&bytes) != entry.checksum {
            return Ok(None);
        }
        end = end.saturating_add(entry.bytes.into());
    }
    Ok(Some(end))
}

impl Row {
    pub(super) fn line(&self) -> String {
        let (largest, sum, count) = self.apart.parts();
        let Tally {
            clamped,
            not_finite,
            rounded,
        } = self.tally;
        let holes = u64::from(self.has_holes);
        let [largest, sum] = [largest, sum].map(f64::to_bits);
        let mut words = vec![holes, largest, sum, count, clamped, not_finite, rounded];
        for entry in &self.entries {
            let [low, high] = [entry.low, entry.high].map(f32::to_bits);
            words.push(entry.begins);
            let coding = entry.coding.word();
            words.extend([entry.bytes, coding, low, high, entry.checksum].map(u64::from));
        }
        let words: Vec<String> = words.iter().map(u64::to_string).collect();
        format!("row {} end", words.join(" "))
    }

    /// `None` of a line that is torn.
    fn of_line(line: &str) -> Option<Self> {
        // A number may lose its end and still be one.
        let words = line.strip_prefix("row ")?.strip_suffix(" end")?;
        let mut words = words.split_whitespace();
        let has_holes = next::<u64>(&mut words)? != 0;
        let largest = f64::from_bits(next(&mut words)?);
        let sum = f64::from_bits(next(&mut words)?);
        let apart = Difference::of_parts(largest, sum, next(&mut words)?);
        let tally = Tally {
            clamped: next(&mut words)?,
            not_finite: next(&mut words)?,
            rounded: next(&mut words)?,
        };
        let mut entries = Vec::new();
        while let Some(begins) = words.next() {
            entries.push(Entry {
                begins: begins.parse().ok()?,
                bytes: next(&mut words)?,
                coding: Coding::of_word(next(&mut words)?)?,
                low: f32::from_bits(next(&mut words)?),
                high: f32::from_bits(next(&mut words)?),
                checksum: next(&mut words)?,
            });
        }
        Some(Self {
            entries,
            apart,
            tally,
            has_holes,
        })
    }
}

fn next<N: FromStr>(words: &mut SplitWhitespace) -> Option<N> {
    words.next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_keeps_every_bit_and_a_torn_one_is_none() {
        let entry = Entry {
            begins: u64::MAX,
            bytes: 7,
            coding: Coding::Lz4,
            low: -0.0,
            high: f32::INFINITY,
            checksum: u32::MAX,
        };
        let row = Row {
            entries: vec![entry, Entry { low: 0.1, ..entry }],
            apart: Difference::of_parts(0.1, 1e300, 3),
            tally: Tally {
                clamped: 1,
                not_finite: 2,
                rounded: 3,
            },
            has_holes: true,
        };
        let line = row.line();
        assert_eq!(Row::of_line(&line), Some(row));
        for end in 0..line.len() {
            assert_eq!(Row::of_line(&line[..end]), None, "{}", &line[..end]);
        }
    }
}
