//! The decoded bytes of all parts as one stream that is read forward.

use super::convert::to_u64;
use super::data::{Data, FoundPart};
use super::decode::Encoding;
use super::place::open_regular;
use super::problem::{self, at};
use crate::volume::{Problem, ReadError};
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};

/// Reads forward through the parts, opening only those that are asked for.
pub(crate) struct Stream<'a> {
    data: &'a Data,
    open: Option<OpenPart<'a>>,
    buffer: Vec<u8>,
}

struct OpenPart<'a> {
    index: u64,
    part: &'a FoundPart,
    reader: Reader,
    /// Decoded bytes given so far, the skipped ones counted.
    position: u64,
}

enum Reader {
    Raw(std::fs::File),
    Encoded(Box<dyn Read>),
}

impl<'a> Stream<'a> {
    pub(crate) fn new(data: &'a Data) -> Self {
        Self {
            data,
            open: None,
            buffer: Vec::new(),
        }
    }

    /// `length` bytes from byte `start` on; `start` never goes back. `length` is small: the bytes are kept.
    pub(crate) fn read_at(&mut self, start: u64, length: u64) -> Result<&[u8], ReadError> {
        let data = self.data;
        let mut buffer = std::mem::take(&mut self.buffer);
        buffer.resize(usize::try_from(length).unwrap_or(usize::MAX), 0);
        let mut start = start;
        let mut rest = buffer.as_mut_slice();
        while !rest.is_empty() {
            let part_bytes = data.part_bytes.max(1);
            let index = start.checked_div(part_bytes).unwrap_or(0);
            let within = start.checked_rem(part_bytes).unwrap_or(0);
            let available = part_bytes.saturating_sub(within);
            let count = usize::try_from(available)
                .unwrap_or(usize::MAX)
                .min(rest.len());
            let (now, later) = rest.split_at_mut(count);
            self.part(index)?.read_at(data, within, now)?;
            rest = later;
            start = start.saturating_add(to_u64(count));
        }
        self.buffer = buffer;
        Ok(&self.buffer)
    }

    /// Sees to it that the part read last ends where the header says, checksums included.
    pub(crate) fn finish(&mut self) -> Result<(), ReadError> {
        match self.open.take() {
            Some(part) => part.finish(self.data),
            None => Ok(()),
        }
    }

    fn part(&mut self, index: u64) -> Result<&mut OpenPart<'a>, ReadError> {
        if self.open.as_ref().is_some_and(|open| open.index != index) {
            self.finish()?;
        }
        match &mut self.open {
            Some(open) => Ok(open),
            closed => Ok(closed.insert(OpenPart::new(self.data, index)?)),
        }
    }
}

impl<'a> OpenPart<'a> {
    fn new(data: &'a Data, index: u64) -> Result<Self, ReadError> {
        let part = usize::try_from(index)
            .ok()
            .and_then(|index| data.parts.get(index))
            .or(data.parts.last())
            .ok_or_else(|| {
                at(std::path::Path::new(""))(Problem::Missing {
                    format: data.format,
                    field: "data file".to_owned(),
                })
            })?;
        let reader = open(data, part).map_err(at(&part.path))?;
        Ok(Self {
            index,
            part,
            reader,
            position: 0,
        })
    }

    /// Fills `out` from byte `within` of the part's voxels.
    fn read_at(&mut self, data: &Data, within: u64, out: &mut [u8]) -> Result<(), ReadError> {
        let target = within.saturating_add(self.part.skip_bytes);
        let skip = target.saturating_sub(self.position);
        self.skip(data, skip).map_err(at(&self.part.path))?;
        self.fill(data, out).map_err(at(&self.part.path))
    }

    fn skip(&mut self, data: &Data, mut count: u64) -> Result<(), Problem> {
        if let Reader::Raw(file) = &mut self.reader {
            if count > 0 {
                let relative = i64::try_from(count).unwrap_or(i64::MAX);
                file.seek(SeekFrom::Current(relative))
                    .map_err(problem::io("skipping bytes of the data file"))?;
                self.position = self.position.saturating_add(count);
            }
            return Ok(());
        }
        let mut sink = [0; 1 << 14];
        while count > 0 {
            let length = usize::try_from(count).unwrap_or(usize::MAX).min(sink.len());
            let Some(now) = sink.get_mut(..length) else {
                break;
            };
            self.fill(data, now)?;
            count = count.saturating_sub(to_u64(length));
        }
        Ok(())
    }

    fn fill(&mut self, data: &Data, out: &mut [u8]) -> Result<(), Problem> {
        let mut rest = out;
        while !rest.is_empty() {
            let count = self.read(data, rest)?;
            if count == 0 {
                return Err(self.ends_early(data));
            }
            rest = rest.get_mut(count..).unwrap_or_default();
        }
        Ok(())
    }

    fn read(&mut self, data: &Data, out: &mut [u8]) -> Result<usize, Problem> {
        loop {
            let result = match &mut self.reader {
                Reader::Raw(file) => file.read(out),
                Reader::Encoded(decoder) => decoder.read(out),
            };
            let error = match result {
                Ok(count) => {
                    self.position = self.position.saturating_add(to_u64(count));
                    return Ok(count);
                }
                Err(error) => error,
            };
            return Err(match error.kind() {
                ErrorKind::Interrupted => continue,
                ErrorKind::UnexpectedEof => self.ends_early(data),
                ErrorKind::InvalidData => Problem::Damaged {
                    format: data.format,
                    encoding: data.encoding.name(),
                    decoded_bytes: self.position,
                    cause: error.to_string(),
                },
                _ => problem::io("reading the voxels")(error),
            });
        }
    }

    fn ends_early(&self, data: &Data) -> Problem {
        Problem::Size {
            format: data.format,
            wanted_bytes: data.part_bytes.saturating_add(self.part.skip_bytes),
            found_bytes: self.position,
        }
    }

    /// Reads to the end of an encoded part: a checksum stands last, and what is too much is as wrong as too little.
    fn finish(mut self, data: &Data) -> Result<(), ReadError> {
        if matches!(self.reader, Reader::Raw(_)) {
            return Ok(());
        }
        let part = self.part;
        let end = data.part_bytes.saturating_add(part.skip_bytes);
        let left = end.saturating_sub(self.position);
        self.skip(data, left).map_err(at(&part.path))?;
        let mut more = [0; 1 << 10];
        let extra = self.read(data, &mut more).map_err(at(&part.path))?;
        if extra > 0 {
            return Err(self.ends_early(data)).map_err(at(&part.path));
        }
        Ok(())
    }
}

fn open(data: &Data, part: &FoundPart) -> Result<Reader, Problem> {
    let (mut file, _) = open_regular(&part.path)?;
    file.seek(SeekFrom::Start(part.offset))
        .map_err(problem::io("skipping bytes of the data file"))?;
    Ok(match data.encoding {
        Encoding::Raw => Reader::Raw(file),
        _ => {
            let input = BufReader::with_capacity(1 << 16, file.take(part.encoded_bytes));
            Reader::Encoded(data.encoding.decode(input, data.stored))
        }
    })
}
