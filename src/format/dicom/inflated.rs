//! The data set of a deflated file (DICOM PS3.5 section A.5), inflated as it is read: none of it is kept.

use super::DICOM;
use crate::format::convert::to_u64;
use crate::format::problem::io;
use crate::volume::{Limits, Problem};
use flate2::read::DeflateDecoder;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};

/// Reads as a file of `length` bytes. Going back inflates from the beginning.
pub(super) struct Inflated {
    file: File,
    /// Where the deflated bytes begin.
    start: u64,
    decoder: DeflateDecoder<BufReader<File>>,
    position: u64,
    length: u64,
}

impl Inflated {
    /// The data set that begins at `start`, inflated once to know its length.
    ///
    /// # Errors
    /// A damaged stream, and one that holds more than a header and a volume may have.
    pub(super) fn new(file: File, start: u64, limits: &Limits) -> Result<Self, Problem> {
        let most = limits
            .max_bytes
            .saturating_add(to_u64(limits.max_header_bytes));
        let begin = || begun(&file, start).map_err(io("looking for the data set"));
        let mut whole = begin()?.take(most.saturating_add(1));
        let length = io::copy(&mut whole, &mut io::sink()).map_err(|cause| Problem::Damaged {
            format: DICOM,
            encoding: "deflate",
            decoded_bytes: 0,
            cause: cause.to_string(),
        })?;
        if length > most {
            return Err(Problem::Limit {
                what: "the inflated data set".to_owned(),
                wanted_bytes: length,
                limit_bytes: most,
            });
        }
        Ok(Self {
            decoder: begin()?,
            file,
            start,
            position: 0,
            length,
        })
    }

    /// Bytes of the data set.
    pub(super) fn length(&self) -> u64 {
        self.length
    }
}

fn begun(file: &File, start: u64) -> io::Result<DeflateDecoder<BufReader<File>>> {
    // The copy has its place in the file in common with the original: it is set here for both.
    let mut file = file.try_clone()?;
    file.seek(SeekFrom::Start(start))?;
    Ok(DeflateDecoder::new(BufReader::new(file)))
}

impl Read for Inflated {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let count = self.decoder.read(bytes)?;
        self.position = self.position.saturating_add(to_u64(count));
        Ok(count)
    }
}

impl Seek for Inflated {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let wanted = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::End(by) => self.length.checked_add_signed(by),
            SeekFrom::Current(by) => self.position.checked_add_signed(by),
        };
        let wanted = wanted.ok_or(io::ErrorKind::InvalidInput)?;
        if wanted < self.position {
            self.decoder = begun(&self.file, self.start)?;
            self.position = 0;
        }
        let ahead = wanted.saturating_sub(self.position);
        io::copy(&mut self.by_ref().take(ahead), &mut io::sink())?;
        Ok(wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn deflated(bytes: &[u8], start: usize) -> File {
        let mut file = tempfile::tempfile().expect("a file");
        file.write_all(&vec![7; start]).expect("bytes");
        let fast = flate2::Compression::fast();
        let mut encoder = flate2::write::DeflateEncoder::new(file, fast);
        encoder.write_all(bytes).expect("bytes");
        encoder.finish().expect("bytes")
    }

    #[test]
    fn any_place_has_the_bytes_of_the_data_set() {
        let bytes: Vec<u8> = (0..100_000_u32)
            .map(|k| (k.wrapping_mul(k) / 7) as u8)
            .collect();
        let file = deflated(&bytes, 132);
        let mut inflated = Inflated::new(file, 132, &Limits::default()).expect("a data set");
        assert_eq!(inflated.length(), to_u64(bytes.len()));
        for at in [0, 99_990, 5, 70_000, 70_010, 69_999] {
            inflated.seek(SeekFrom::Start(to_u64(at))).expect("a place");
            let mut found = [0; 10];
            inflated.read_exact(&mut found).expect("bytes");
            assert_eq!(found, bytes[at..at + 10], "{at}");
        }
        assert_eq!(
            inflated.seek(SeekFrom::Current(-9)).expect("a place"),
            70_000
        );
        let mut rest = Vec::new();
        inflated.seek(SeekFrom::End(-3)).expect("a place");
        inflated.read_to_end(&mut rest).expect("bytes");
        assert_eq!(rest, bytes[99_997..]);
    }

    #[test]
    fn a_data_set_beyond_the_limits_is_refused() {
        let limits = Limits {
            max_bytes: 10,
            max_header_bytes: 5,
            ..Limits::default()
        };
        let refused = Inflated::new(deflated(&[0; 16], 0), 0, &limits);
        let error = refused.err().expect("refused").to_string();
        assert!(error.contains("inflated data set"), "{error}");
        Inflated::new(deflated(&[0; 15], 0), 0, &limits).expect("a data set");
    }
}
