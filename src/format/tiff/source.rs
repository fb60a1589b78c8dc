//! A [`Source`] over the pages of TIFF files: decodes the chunks that a wanted box touches, one page at a time.

use super::TIFF;
use super::chunk;
use super::ifd::Reader;
use super::page::{Color, Look, Page};
use super::palette::Palette;
use super::samples::{self, Band};
use crate::format::convert::{Builder, Endian, to_u64};
use crate::format::problem::{at, invalid};
use crate::format::request::wanted_count;
use crate::volume::{Header, Limits, Piece, Problem, ReadError, Source, TimeComponent, VoxelBox};
use std::path::{Path, PathBuf};

/// Where a page is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PageAt {
    /// Index of the file.
    pub file: usize,
    /// Where its directory is in that file.
    pub ifd: u64,
    /// Its number in that file, counted from 0: for messages.
    pub number: usize,
}

/// A volume made of pages that look alike.
#[derive(Debug)]
pub(super) struct PageSource {
    pub path: PathBuf,
    pub header: Header,
    pub files: Vec<PathBuf>,
    /// The page of each z, fastest, channel and time.
    pub pages: Vec<PageAt>,
    /// Channels that are pages of their own; a page of several samples has one.
    pub channels: u32,
    pub look: Look,
    /// True where numbers that stand for colors of a map are read themselves.
    pub keeps_numbers: bool,
    pub limits: Limits,
}

impl PageSource {
    fn page_at(&self, z: u32, pick: TimeComponent) -> Option<PageAt> {
        let channel = if self.channels > 1 { pick.component } else { 0 };
        let index = u64::from(pick.time)
            .checked_mul(self.channels.into())?
            .checked_add(channel.into())?
            .checked_mul(self.header.dims[2].into())?
            .checked_add(z.into())?;
        self.pages.get(usize::try_from(index).ok()?).copied()
    }

    /// Appends the rows of one page.
    fn read_page(
        &self,
        reader: &mut Reader,
        place: PageAt,
        sample: u32,
        region: VoxelBox,
        builder: &mut Builder,
    ) -> Result<(), Problem> {
        let directory = reader.directory(place.ifd)?;
        let page = Page::read(reader, &directory, &self.limits)?;
        if page.look != self.look {
            let wanted = "what was there when the file was opened";
            let found = format!("another page {}", place.number);
            return Err(invalid(TIFF, "page", wanted, &found));
        }
        let palette = match self.look.color {
            Color::Palette if !self.keeps_numbers => {
                Some(Palette::read(reader, &directory, self.look.bits)?)
            }
            _ => None,
        };
        // An index stands for all three colors.
        let stored_sample = if palette.is_some() { 0 } else { sample };
        let [x0, y0, _] = region.min;
        let [x1, y1, _] = region.max;
        let height = page.chunk_height.max(1);
        let first_row = y0.checked_div(height).unwrap_or(0);
        let last_row = y1.saturating_sub(1).checked_div(height).unwrap_or(0);
        for row in first_row..=last_row {
            let top = row.saturating_mul(height);
            let rows = y0.saturating_sub(top)..y1.saturating_sub(top).min(height);
            let mut band = Band::new(x0..x1, rows, self.look.stored);
            let first = x0.checked_div(page.chunk_width).unwrap_or(0);
            let last = x1
                .saturating_sub(1)
                .checked_div(page.chunk_width)
                .unwrap_or(0);
            for column in first..=last {
                let index = samples::chunk_index(&page, column, row, stored_sample);
                let pixels = chunk::pixels(reader, &page, index)?;
                band.take(&page, column, &pixels, stored_sample)?;
            }
            if let Some(palette) = &palette {
                let bytes = band.through(palette, sample, self.header.stored);
                push(builder, &bytes, Endian::Little, self.header.stored)?;
            } else {
                push(builder, &band.bytes, band.endian, self.header.stored)?;
            }
        }
        Ok(())
    }
}

/// Appends numbers; the builder was made for little-endian ones.
fn push(
    builder: &mut Builder,
    bytes: &[u8],
    endian: Endian,
    stored: crate::volume::VoxelType,
) -> Result<(), Problem> {
    match endian {
        Endian::Little => builder.push(bytes, 1),
        Endian::Big => {
            let mut turned = bytes.to_vec();
            for number in turned.chunks_exact_mut(stored.bytes()) {
                number.reverse();
            }
            builder.push(&turned, 1)
        }
    }
}

impl Source for PageSource {
    fn path(&self) -> &Path {
        &self.path
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn reads_whole_rows(&self) -> bool {
        true
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let max_bytes = self.limits.max_bytes;
        let wanted =
            wanted_count(TIFF, &self.header, pick, region, max_bytes).map_err(at(&self.path))?;
        let mut builder = Builder::new(self.header.stored, Endian::Little, wanted);
        builder
            .reserve(wanted.min(BELIEVED_NUMBERS))
            .map_err(at(&self.path))?;
        let sample = if self.channels > 1 { 0 } else { pick.component };
        let mut open: Option<(usize, Reader)> = None;
        for z in region.min[2]..region.max[2] {
            let place = self
                .page_at(z, pick)
                .ok_or_else(|| invalid(TIFF, "page", "a page of each layer", "none"))
                .map_err(at(&self.path))?;
            let path = self.files.get(place.file).unwrap_or(&self.path);
            let mut reader = match open.take() {
                Some((file, reader)) if file == place.file => reader,
                _ => Reader::open(path).map_err(at(path))?,
            };
            self.read_page(&mut reader, place, sample, region, &mut builder)
                .map_err(at(path))?;
            open = Some((place.file, reader));
        }
        if builder.len() != wanted {
            let bytes = to_u64(self.header.stored.bytes());
            return Err(at(&self.path)(Problem::Size {
                format: TIFF,
                wanted_bytes: to_u64(wanted).saturating_mul(bytes),
                found_bytes: to_u64(builder.len()).saturating_mul(bytes),
            }));
        }
        Ok(builder.finish())
    }
}

/// Numbers that are reserved before the first page is decoded.
const BELIEVED_NUMBERS: usize = 1 << 24;
