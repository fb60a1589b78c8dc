//! One file: what its header says about its pixels, by DICOM PS3.3 section C.7.6.3 and PS3.10 section 7.1.

use super::DICOM;
use super::dataset::{Elements, PixelPlace, Stream};
use super::fields::DataSet;
use super::inflated::Inflated;
use super::layout::Layout;
use super::syntax::Syntax;
use super::tags::*;
use crate::format::convert::to_u64;
use crate::format::place;
use crate::format::problem::{at, escape, io, missing};
use crate::volume::{Limits, Problem, ReadError};
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Where the letters `DICM` stand.
const PREAMBLE_BYTES: usize = 128;

/// True where `DICM` stands after 128 bytes that may be anything.
pub(in crate::format) fn recognizes(first: &[u8]) -> bool {
    has_preamble(first)
}

/// True where a file begins with elements of group 2 or 8 at once, as old ones do. So few bytes are little proof:
/// to be asked after all other formats.
pub(in crate::format) fn recognizes_bare(first: &[u8]) -> bool {
    bare_syntax(first).is_some()
}

fn has_preamble(first: &[u8]) -> bool {
    first
        .get(PREAMBLE_BYTES..)
        .is_some_and(|rest| rest.starts_with(b"DICM"))
}

/// How the elements of a file without `DICM` are written.
fn bare_syntax(first: &[u8]) -> Option<Syntax> {
    let [group, 0, number, 0, kind_or_length @ ..] = first.first_chunk::<8>()? else {
        return None;
    };
    let is_first = matches!(
        (group, number),
        (8, 0 | 1 | 5 | 8 | 0x12 | 0x13 | 0x14 | 0x16 | 0x18) | (2, 0..=0x10)
    );
    let kind = kind_or_length.first_chunk::<2>()?;
    let is_explicit = matches!(
        kind,
        b"UL" | b"UI" | b"CS" | b"DA" | b"TM" | b"OB" | b"SH" | b"LO"
    );
    let is_implicit =
        matches!(kind_or_length, [length, 0, 0, 0] if *length <= 64 && length % 2 == 0);
    match (is_first, is_explicit, is_implicit) {
        (true, true, _) => Some(Syntax::EXPLICIT),
        (true, false, true) => Some(Syntax::IMPLICIT),
        _ => None,
    }
}

/// The picture or pictures of one file.
#[derive(Clone, Debug)]
pub(super) struct PictureFile {
    pub path: PathBuf,
    pub syntax: Syntax,
    /// Where the data set begins; a deflated one is inflated from here.
    pub start: u64,
    pub place: PixelPlace,
    /// Bytes of the file, or of the inflated data set.
    pub length: u64,
    pub layout: Layout,
    /// For each frame where it begins in the fragments, if a table in the header says so.
    pub frame_offsets: Option<Vec<u64>>,
    /// Stored numbers, from and to, that stand for no data.
    pub padding: Option<[f64; 2]>,
    /// What odd and harmless thing there is about the file.
    pub note: Option<String>,
}

/// What a file turned out to be.
pub(super) enum Found {
    Picture(Box<PictureFile>, DataSet),
    /// A picture that we do not read, and why: that matters only where its series is wanted.
    Refused(ReadError, DataSet),
    /// DICOM without pixels: a report, a list of files, a presentation state.
    Other,
}

/// Reads all of a file but its pixels.
pub(super) fn scan(path: &Path, limits: &Limits) -> Result<Found, ReadError> {
    scan_file(path, limits).map_err(at(path))
}

fn scan_file(path: &Path, limits: &Limits) -> Result<Found, Problem> {
    let (mut stream, mut length) = open_file(path)?;
    let first = {
        let mut first = Vec::new();
        let head = to_u64(PREAMBLE_BYTES).saturating_add(8);
        (&mut stream)
            .take(head)
            .read_to_end(&mut first)
            .map_err(io("reading the first bytes"))?;
        first
    };
    let mut start = if has_preamble(&first) {
        to_u64(PREAMBLE_BYTES).saturating_add(4)
    } else {
        0
    };
    stream
        .seek(SeekFrom::Start(start))
        .map_err(io("reading the first bytes"))?;
    // The group that says how the rest is written is itself always explicit and little-endian.
    let bare = if start == 0 {
        bare_syntax(&first)
    } else {
        None
    };
    if start == 0 && bare.is_none() {
        let what = ": this is no DICOM file, whatever its name says".to_owned();
        return Err(Problem::UnknownFormat(what));
    }
    let mut syntax = bare.unwrap_or(Syntax::IMPLICIT);
    let (mut refused, mut meta_class) = (None, None);
    if start != 0 || first.starts_with(&[2, 0]) {
        let elements = Elements::new(
            &mut stream,
            start,
            length,
            Syntax::EXPLICIT,
            limits.max_header_bytes,
        );
        let (meta, end) = elements.read_group(2)?;
        start = end;
        meta_class = meta.text(MEDIA_STORAGE_SOP_CLASS_UID);
        let uid = meta
            .text(TRANSFER_SYNTAX_UID)
            .ok_or_else(|| missing(DICOM, &name(TRANSFER_SYNTAX_UID)))?;
        // Whatever the pixels are, the data set around fragments is explicit.
        (syntax, refused) = match Syntax::of(&uid) {
            Ok(syntax) => (syntax, None),
            Err(problem) if uid.starts_with("1.2.840.10008.1.2.4.") => {
                (Syntax::EXPLICIT, Some(problem))
            }
            Err(problem) => return Err(problem),
        };
    }
    let mut position = start;
    let mut stream: Box<dyn Stream> = match syntax.is_deflated {
        true => {
            let inflated = Inflated::new(stream.into_inner(), start, limits)?;
            (position, length) = (0, inflated.length());
            Box::new(inflated)
        }
        false => Box::new(stream),
    };
    let elements = Elements::new(
        &mut stream,
        position,
        length,
        syntax,
        limits.max_header_bytes,
    );
    let (set, place) = elements.read()?;
    let Some(place) = place else {
        return match must_be_a_picture(meta_class, &set) {
            true => Err(missing(DICOM, &name(PIXEL_DATA))),
            false => Ok(Found::Other),
        };
    };
    let layout = match (refused, Layout::of(&set, place.tag)) {
        (None, Ok(layout)) => layout,
        (Some(problem), _) | (None, Err(problem)) => {
            return Ok(Found::Refused(at(path)(problem), set));
        }
    };
    let file = PictureFile {
        path: path.to_owned(),
        syntax,
        start,
        place,
        length,
        layout,
        padding: padding(&set, &layout)?,
        frame_offsets: set.u64s(EXTENDED_OFFSET_TABLE),
        note: note_on_preamble(path, &first),
    };
    Ok(Found::Picture(Box::new(file), set))
}

/// A file whose pixels are missing is damaged, not of another kind, where its class or its size says so,
/// and where it has no class, which all objects have.
fn must_be_a_picture(meta_class: Option<String>, set: &DataSet) -> bool {
    let class = set.text(SOP_CLASS_UID).or(meta_class).unwrap_or_default();
    let of_storage = class.strip_prefix("1.2.840.10008.5.1.4.1.1.").unwrap_or("");
    let kind = of_storage.split('.').next().unwrap_or("");
    // X-rays, CT, ultrasound, secondary capture, fluoroscopy, NM, PET, cameras; of other kinds the pictures alone.
    let is_picture = matches!(
        kind,
        "1" | "2" | "3" | "6" | "7" | "12" | "13" | "14" | "20" | "30" | "77" | "128" | "130"
    ) || matches!(
        of_storage,
        "4" | "4.1" | "4.3" | "4.4" | "66.4" | "66.8" | "481.1" | "481.2"
    );
    is_picture || class.is_empty() || set.has(ROWS)
}

/// Padding has the sign of pixels, whatever the type of its attribute.
fn padding(set: &DataSet, layout: &Layout) -> Result<Option<[f64; 2]>, Problem> {
    if layout.is_float || layout.color.samples() > 1 {
        return Ok(None);
    }
    let number = |tag| {
        let number = set.u16(tag)?;
        Ok(number.map(|n| match layout.is_signed {
            true => f64::from(n.cast_signed()),
            false => f64::from(n),
        }))
    };
    let value = number(PIXEL_PADDING_VALUE)?;
    let limit = number(PIXEL_PADDING_RANGE_LIMIT)?;
    let bits = f64::from(layout.bits_stored).exp2();
    let (least, most) = if layout.is_signed {
        (-bits / 2.0, bits / 2.0 - 1.0)
    } else {
        (0.0, bits - 1.0)
    };
    let range = value.map(|value| {
        [
            value.min(limit.unwrap_or(value)),
            value.max(limit.unwrap_or(value)),
        ]
    });
    // Padding that no pixel can hold pads nothing.
    Ok(range.filter(|[low, _]| (least..=most).contains(low)))
}

/// The 128 bytes before a data set can make the file something else at the same time.
fn note_on_preamble(path: &Path, first: &[u8]) -> Option<String> {
    let other = match first {
        [b'M', b'Z', ..] | [0x7f, b'E', b'L', b'F', ..] => "a program",
        [b'I', b'I', 42, 0, ..] | [b'M', b'M', 0, 42, ..] => "a TIFF file",
        _ => return None,
    };
    let name = path
        .file_name()
        .map(|name| escape(&name.to_string_lossy()))
        .unwrap_or_default();
    Some(format!(
        "{name} begins as {other} does and is read as DICOM"
    ))
}

fn open_file(path: &Path) -> Result<(BufReader<File>, u64), Problem> {
    let (file, metadata) = place::open_regular(path)?;
    Ok((BufReader::new(file), metadata.len()))
}

impl PictureFile {
    /// The bytes that `place` speaks of: the file, or the inflated data set.
    pub(super) fn open(&self, limits: &Limits) -> Result<Box<dyn Stream>, ReadError> {
        self.open_stream(limits).map_err(at(&self.path))
    }

    fn open_stream(&self, limits: &Limits) -> Result<Box<dyn Stream>, Problem> {
        let (stream, _) = open_file(&self.path)?;
        if !self.syntax.is_deflated {
            return Ok(Box::new(stream));
        }
        let inflated = Inflated::new(stream.into_inner(), self.start, limits)?;
        Ok(Box::new(inflated))
    }
}
