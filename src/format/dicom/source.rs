//! A [`Source`] over the pictures of a series: decodes the slices of the wanted box, one at a time.

use super::DICOM;
use super::dataset::Stream;
use super::file::PictureFile;
use super::layout::Layout;
use super::picture::Picture;
use super::pixels::Frames;
use crate::format::convert::{Builder, Endian, bytes_in_memory, to_u64};
use crate::format::problem::at;
use crate::volume::{
    Header, Limits, Piece, Problem, ReadError, Source, TimeComponent, VoxelBox, VoxelType,
};
use std::path::{Path, PathBuf};

/// The pictures of a series in their order.
#[derive(Debug)]
pub(super) struct DicomSource {
    pub path: PathBuf,
    pub header: Header,
    pub files: Vec<PictureFile>,
    /// Where the frames of each file are.
    pub frames: Vec<Frames>,
    pub pictures: Vec<Picture>,
    /// For each time each slice; none where a picture is missing.
    pub order: Vec<Option<usize>>,
    pub kept: Kept,
    pub limits: Limits,
}

/// What becomes of stored numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kept {
    /// They stay; a missing slice is full of the fill value.
    Stored,
    /// They become f32, so that what is missing can be NaN.
    Floats,
    /// Each slice has its own rescale: values are kept as f32.
    Values,
}

/// Numbers that are reserved before the first picture is decoded.
const BELIEVED_NUMBERS: usize = 1 << 24;

/// A file that is open, so that the next frame need not open it again.
struct Open {
    file: usize,
    stream: Box<dyn Stream>,
}

impl DicomSource {
    fn count(&self, region: VoxelBox) -> Result<usize, Problem> {
        let count = (0..3).try_fold(1_u64, |product, k| {
            let side = region.max.get(k)?.checked_sub(*region.min.get(k)?)?;
            product.checked_mul(side.into())
        });
        let each = to_u64(bytes_in_memory(self.header.stored));
        let wanted_bytes = count
            .and_then(|count| count.checked_mul(each))
            .unwrap_or(u64::MAX);
        count
            .filter(|_| wanted_bytes <= self.limits.max_bytes)
            .and_then(|count| usize::try_from(count).ok())
            .ok_or(Problem::Limit {
                what: "the volume".to_owned(),
                wanted_bytes,
                limit_bytes: self.limits.max_bytes,
            })
    }

    fn check(&self, pick: TimeComponent, region: VoxelBox) -> Result<(), Problem> {
        let sides = region.min.iter().zip(&region.max).zip(&self.header.dims);
        let inside = sides
            .into_iter()
            .all(|((min, max), size)| min < max && max <= size);
        if inside && pick.time < self.header.times && pick.component < self.header.components {
            return Ok(());
        }
        Err(Problem::Invalid {
            format: DICOM,
            field: "box".to_owned(),
            wanted: format!(
                "a box inside {:?}, a time below {} and a component below {}",
                self.header.dims, self.header.times, self.header.components
            ),
            found: format!("{:?} to {:?}, {pick:?}", region.min, region.max),
        })
    }

    /// Which picture a slice is.
    fn picture(&self, time: u32, slice: u32) -> Option<&Picture> {
        let [_, _, slices] = self.header.dims;
        let index = u64::from(time)
            .saturating_mul(slices.into())
            .saturating_add(slice.into());
        let picture = self
            .order
            .get(usize::try_from(index).ok()?)
            .copied()
            .flatten()?;
        self.pictures.get(picture)
    }

    /// The samples of one picture, of the layout's stored type.
    fn samples(&self, picture: &Picture, open: &mut Option<Open>) -> Result<Vec<u8>, ReadError> {
        let (Some(file), Some(frames)) =
            (self.files.get(picture.file), self.frames.get(picture.file))
        else {
            return Ok(Vec::new());
        };
        let mut opened = match open.take() {
            Some(open) if open.file == picture.file => open,
            _ => Open {
                file: picture.file,
                stream: file.open(&self.limits)?,
            },
        };
        let samples = frames.read(file, opened.stream.as_mut(), picture.frame, &self.limits);
        *open = Some(opened);
        samples.map_err(at(&file.path))
    }

    /// The number that stands where there is no picture.
    fn nothing(&self) -> f64 {
        match self.kept {
            Kept::Stored => self.header.fill.unwrap_or(0.0),
            _ => f64::NAN,
        }
    }

    /// Appends the wanted part of one slice.
    fn push_slice(
        &self,
        builder: &mut Builder,
        slice: Option<(&Picture, &[u8])>,
        component: u32,
        region: VoxelBox,
    ) -> Result<(), ReadError> {
        let ([x0, y0, _], [x1, y1, _]) = (region.min, region.max);
        let width = usize::try_from(x1.saturating_sub(x0)).unwrap_or(usize::MAX);
        for y in y0..y1 {
            let Some((picture, samples)) = slice else {
                let number = encode(self.nothing(), self.header.stored);
                let row: Vec<u8> = number
                    .iter()
                    .copied()
                    .cycle()
                    .take(width.saturating_mul(number.len()))
                    .collect();
                builder.push(&row, 1).map_err(at(&self.path))?;
                continue;
            };
            let Some(file) = self.files.get(picture.file) else {
                continue;
            };
            let row = row(samples, &file.layout, component, [x0, y], width);
            let row: Vec<u8> = match self.kept {
                Kept::Stored if file.padding.is_none() => row,
                _ => self.converted(&row, file, picture),
            };
            builder.push(&row, 1).map_err(at(&self.path))?;
        }
        Ok(())
    }

    /// Stored numbers to those that are kept; padding to what stands for no data.
    fn converted(&self, row: &[u8], file: &PictureFile, picture: &Picture) -> Vec<u8> {
        let stored = file.layout.stored();
        let keep = |number: f64| match (self.kept, file.padding) {
            (_, Some([low, high])) if (low..=high).contains(&number) => self.nothing(),
            (Kept::Values, _) => number * picture.rescale.slope + picture.rescale.intercept,
            _ => number,
        };
        row.chunks_exact(stored.bytes())
            .flat_map(|bytes| encode(keep(decode(bytes, stored)), self.header.stored))
            .collect()
    }
}

/// Samples of one component of a part of a row.
fn row(samples: &[u8], layout: &Layout, component: u32, [x, y]: [u32; 2], width: usize) -> Vec<u8> {
    let sample_bytes = layout.stored().bytes();
    let pixel_bytes = u64::from(layout.color.samples()).saturating_mul(layout.sample_bytes());
    let start = u64::from(y)
        .saturating_mul(layout.columns.into())
        .saturating_add(x.into())
        .saturating_mul(pixel_bytes);
    let start = usize::try_from(start).unwrap_or(usize::MAX);
    let pixel_bytes = usize::try_from(pixel_bytes).unwrap_or(usize::MAX);
    let end = start.saturating_add(width.saturating_mul(pixel_bytes));
    let row = samples.get(start..end).unwrap_or(&[]);
    let skip = usize::try_from(component)
        .unwrap_or(usize::MAX)
        .saturating_mul(sample_bytes);
    row.chunks_exact(pixel_bytes.max(1))
        .flat_map(|pixel| pixel.iter().skip(skip).take(sample_bytes).copied())
        .collect()
}

/// A stored little-endian number; the types of layouts only.
fn decode(bytes: &[u8], stored: VoxelType) -> f64 {
    macro_rules! number {
        ($type:ty) => {
            bytes
                .first_chunk()
                .map_or(0.0, |bytes| <$type>::from_le_bytes(*bytes).into())
        };
    }
    match stored {
        VoxelType::U8 => number!(u8),
        VoxelType::I8 => number!(i8),
        VoxelType::U16 => number!(u16),
        VoxelType::I16 => number!(i16),
        VoxelType::U32 => number!(u32),
        VoxelType::I32 => number!(i32),
        VoxelType::F64 => number!(f64),
        _ => number!(f32),
    }
}

/// The bytes of a number, little-endian. The number is one of the type, or the type is f32.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a number that the type holds, or rounding to f32, which is what is wanted"
)]
fn encode(number: f64, stored: VoxelType) -> Vec<u8> {
    match stored {
        VoxelType::U8 => vec![number as u8],
        VoxelType::I8 => (number as i8).to_le_bytes().to_vec(),
        VoxelType::U16 => (number as u16).to_le_bytes().to_vec(),
        VoxelType::I16 => (number as i16).to_le_bytes().to_vec(),
        VoxelType::U32 => (number as u32).to_le_bytes().to_vec(),
        VoxelType::I32 => (number as i32).to_le_bytes().to_vec(),
        VoxelType::F64 => number.to_le_bytes().to_vec(),
        _ => (number as f32).to_le_bytes().to_vec(),
    }
}

impl Source for DicomSource {
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
        self.check(pick, region).map_err(at(&self.path))?;
        let wanted = self.count(region).map_err(at(&self.path))?;
        let mut builder = Builder::new(self.header.stored, Endian::Little, wanted);
        builder
            .reserve(wanted.min(BELIEVED_NUMBERS))
            .map_err(at(&self.path))?;
        let mut open = None;
        let ([_, _, z0], [_, _, z1]) = (region.min, region.max);
        for z in z0..z1 {
            let samples = match self.picture(pick.time, z) {
                Some(picture) => Some((picture, self.samples(picture, &mut open)?)),
                None => None,
            };
            let slice = samples
                .as_ref()
                .map(|(picture, samples)| (*picture, samples.as_slice()));
            self.push_slice(&mut builder, slice, pick.component, region)?;
        }
        if builder.len() != wanted {
            let bytes =
                |count: usize| to_u64(count).saturating_mul(to_u64(self.header.stored.bytes()));
            return Err(at(&self.path)(Problem::Size {
                format: DICOM,
                wanted_bytes: bytes(wanted),
                found_bytes: bytes(builder.len()),
            }));
        }
        Ok(builder.finish())
    }
}
