//! NumPy arrays, `.npy`: a Python literal that names type, order and shape, and the numbers behind it.
//!
//! numpy.org/doc/stable/reference/generated/numpy.lib.format.html, versions 1.0, 2.0 and 3.0:
//!
//! ```text
//! 93 'NUMPY' major minor length(u16 | u32, little-endian) {'descr': '<f4', 'fortran_order': False, 'shape': (z, y, x), }
//! ```
//!
//! An array has no names for its axes, so their number gives them: [y, x], [z, y, x], [t, z, y, x] or
//! [t, c, z, y, x]. Bytes whose last axis has 3 or 4 entries, in arrays of three axes and more, are colours. Whether
//! an array is in C or in Fortran order says only how it lies in memory.

mod fortran;
mod literal;

use super::convert::{Endian, to_u64};
use super::data::{Data, Part, Promise, Start};
use super::decode::Encoding;
use super::file_source::FileSource;
use super::geometry::world_from_voxel;
use super::place::{first_bytes, open_regular};
use super::problem::{at, escape, invalid, missing, unsupported};
use super::select::{Axis, Role};
use crate::volume::{ComponentKind, Format, Header, Limits, Problem, ReadError, Source, VoxelType};
use fortran::FortranSource;
use glam::DVec3;
use literal::Literal;
use std::path::Path;

/// The word of errors.
pub(super) const NPY: &str = "npy";

const MAGIC: &[u8] = b"\x93NUMPY";

/// True where a file begins as every `.npy` does.
pub(super) fn recognizes(first: &[u8]) -> bool {
    first.starts_with(MAGIC)
}

/// Opens an array.
pub(super) fn open(path: &Path, limits: &Limits) -> Result<Box<dyn Source>, ReadError> {
    let (text, data_begins) = text(path, limits.max_header_bytes).map_err(at(path))?;
    let literal = literal::parse(&text).map_err(at(path))?;
    let kind = Kind::of(&literal).map_err(at(path))?;
    let array = Array::of(&literal, kind.stored).map_err(at(path))?;
    let header = header(&array, kind, literal.fortran_order).map_err(at(path))?;
    let data = Data::find(promise(path, kind, array.axes, data_begins), path)?;
    let file = FileSource::new(path, header, data, limits);
    Ok(match literal.fortran_order {
        true => Box::new(FortranSource::new(file, limits.max_bytes)),
        false => Box::new(file),
    })
}

fn promise(path: &Path, kind: Kind, axes: Vec<Axis>, data_begins: u64) -> Promise {
    Promise {
        format: NPY,
        stored: kind.stored,
        endian: kind.endian,
        encoding: Encoding::Raw,
        axes,
        parts: vec![Part {
            path: path.to_owned(),
            start: Start::Skip {
                file_bytes: data_begins,
                decoded_bytes: 0,
            },
            encoded_bytes: None,
        }],
    }
}

/// What a header says, for those who know what its axes are.
pub(super) struct Plain {
    pub stored: VoxelType,
    pub shape: Vec<u64>,
    /// True where the first axis lies closest in memory.
    pub fortran_order: bool,
    kind: Kind,
    data_begins: u64,
}

impl Plain {
    pub(super) fn open(path: &Path, limits: &Limits) -> Result<Self, Problem> {
        let (text, data_begins) = text(path, limits.max_header_bytes)?;
        let literal = literal::parse(&text)?;
        let kind = Kind::of(&literal)?;
        Ok(Self {
            stored: kind.stored,
            shape: literal.shape,
            fortran_order: literal.fortran_order,
            kind,
            data_begins,
        })
    }

    /// As a person writes it.
    pub(super) fn shape_text(&self) -> String {
        literal::shape_text(&self.shape)
    }

    /// The numbers, seen to be there; the fastest axis first.
    pub(super) fn data(&self, path: &Path, axes: Vec<Axis>) -> Result<Data, ReadError> {
        Data::find(promise(path, self.kind, axes, self.data_begins), path)
    }
}

/// The literal, and where the numbers begin.
fn text(path: &Path, limit_bytes: usize) -> Result<(String, u64), Problem> {
    let (mut file, _) = open_regular(path)?;
    let limit = to_u64(limit_bytes).saturating_add(12);
    let bytes = first_bytes(&mut file, limit)?;
    let version = bytes.get(6..8).ok_or_else(|| missing(NPY, "version"))?;
    let (length, begins) = match version {
        [1, 0] => {
            let length = bytes.get(8..).and_then(|b| b.first_chunk());
            (length.map(|b| u32::from(u16::from_le_bytes(*b))), 10_usize)
        }
        [2 | 3, 0] => {
            let length = bytes.get(8..).and_then(|b| b.first_chunk());
            (length.map(|b| u32::from_le_bytes(*b)), 12)
        }
        _ => {
            let found = format!("{version:?}");
            let wanted = "1.0, 2.0 or 3.0";
            return Err(invalid(NPY, "version", wanted, &found));
        }
    };
    let length = length.ok_or_else(|| missing(NPY, "header length"))?;
    let too_long = Problem::Limit {
        what: "the header".to_owned(),
        wanted_bytes: length.into(),
        limit_bytes: to_u64(limit_bytes),
    };
    let length = match usize::try_from(length) {
        Ok(length) if length <= limit_bytes => length,
        _ => return Err(too_long),
    };
    let ends = begins.saturating_add(length);
    let text = bytes.get(begins..ends).ok_or_else(|| {
        let found = format!("{} bytes of it", bytes.len().saturating_sub(begins));
        invalid(NPY, "header length", "a header as long as it says", &found)
    })?;
    Ok((String::from_utf8_lossy(text).into_owned(), to_u64(ends)))
}

/// What `descr` says.
#[derive(Clone, Copy)]
struct Kind {
    stored: VoxelType,
    endian: Endian,
    is_bool: bool,
}

impl Kind {
    fn of(literal: &Literal) -> Result<Self, Problem> {
        let text = literal.descr.as_str();
        let wrong = || invalid(NPY, "descr", "a type such as '<f4' or '|u1'", text);
        let order = text.chars().next().ok_or_else(wrong)?;
        let kind = text.get(order.len_utf8()..).ok_or_else(wrong)?;
        let stored = match kind {
            "b1" | "u1" => VoxelType::U8,
            "i1" => VoxelType::I8,
            "u2" => VoxelType::U16,
            "i2" => VoxelType::I16,
            "u4" => VoxelType::U32,
            "i4" => VoxelType::I32,
            "u8" => VoxelType::U64,
            "i8" => VoxelType::I64,
            "f2" => VoxelType::F16,
            "f4" => VoxelType::F32,
            "f8" => VoxelType::F64,
            _ => {
                let what = match kind.chars().next() {
                    Some('c') => "complex numbers",
                    Some('f') => "floats of more than 64 bits",
                    Some('O') => "Python objects",
                    Some('S' | 'a' | 'U') => "text",
                    Some('V') => "structured or void types",
                    Some('M' | 'm') => "dates and durations",
                    _ => return Err(wrong()),
                };
                let what = format!("{what} (descr `{}`)", escape(text));
                return Err(unsupported(NPY, what));
            }
        };
        let endian = match order {
            '<' => Endian::Little,
            '>' => Endian::Big,
            '|' if stored.bytes() == 1 => Endian::Little,
            _ => return Err(wrong()),
        };
        Ok(Self {
            stored,
            endian,
            is_bool: kind == "b1",
        })
    }
}

/// The stored array.
struct Array {
    /// As they lie in memory, the fastest first.
    axes: Vec<Axis>,
    /// The first space axis in memory first.
    dims: [u32; 3],
    components: u32,
    times: u32,
    is_color: bool,
    /// As a person writes them: `z, y, x`.
    words: String,
}

impl Array {
    fn of(literal: &Literal, stored: VoxelType) -> Result<Self, Problem> {
        let wrong = |wanted: &str| invalid(NPY, "shape", wanted, &literal.shape_text());
        let mut sizes = literal
            .shape
            .iter()
            .map(|&n| u32::try_from(n).ok().filter(|&n| n > 0))
            .collect::<Option<Vec<u32>>>()
            .ok_or_else(|| wrong("sizes from 1 to 2^32 - 1"))?;
        let is_color = stored == VoxelType::U8
            && literal.descr.ends_with("u1")
            && sizes.len() >= 3
            && matches!(sizes.last(), Some(3 | 4));
        let mut names = match (is_color, sizes.len()) {
            (false, 2) => vec!["y", "x"],
            (false, 3) => vec!["z", "y", "x"],
            (false, 4) => vec!["t", "z", "y", "x"],
            (false, 5) => vec!["t", "c", "z", "y", "x"],
            (true, 3) => vec!["y", "x", "color"],
            (true, 4) => vec!["z", "y", "x", "color"],
            (true, 5) => vec!["t", "z", "y", "x", "color"],
            _ => return Err(wrong("2 to 5 axes")),
        };
        let words = names.join(", ");
        // Space is [z, y, x] in both orders, and x, y, z from the fastest on in one, z, y, x in the other.
        let space = match literal.fortran_order {
            true => ["z", "y", "x"],
            false => {
                sizes.reverse();
                names.reverse();
                ["x", "y", "z"]
            }
        };
        let mut array = Self {
            axes: Vec::new(),
            dims: [1; 3],
            components: 1,
            times: 1,
            is_color,
            words,
        };
        for (name, size) in names.into_iter().zip(sizes) {
            let role = match name {
                "t" => Role::Time,
                "c" | "color" => Role::Component,
                _ => Role::Space(space.iter().position(|&axis| axis == name).unwrap_or(0)),
            };
            match role {
                Role::Component => array.components = size,
                Role::Time => array.times = size,
                Role::Space(k) => {
                    if let Some(dim) = array.dims.get_mut(k) {
                        *dim = size;
                    }
                }
            }
            array.axes.push(Axis {
                role,
                size: size.into(),
            });
        }
        Ok(array)
    }
}

fn header(array: &Array, kind: Kind, fortran_order: bool) -> Result<Header, Problem> {
    let world_from_voxel = world_from_voxel(DVec3::AXES, DVec3::splat(0.5))
        .ok_or_else(|| invalid(NPY, "shape", "steps that span a volume", ""))?;
    let mut notes = vec![
        format!("the axes of the array are taken as [{}]", array.words),
        "the file gives no spacing: 1 is taken".to_owned(),
    ];
    if fortran_order {
        notes.push(
            "the array is in Fortran order: its first axis is that of the shape's first number all the same".to_owned(),
        );
    }
    // The last of the shape.
    let row = match fortran_order {
        true => array.axes.last(),
        false => array.axes.first(),
    };
    let row = row.filter(|row| array.axes.len() == 2 && (4..=6).contains(&row.size));
    if let Some(Axis { size, .. }) = row {
        notes.push(format!(
            "rows of {size} numbers are an image here; --points takes them as scattered points, x, y, z, value[, std[, weight]]"
        ));
    }
    if kind.is_bool {
        notes.push("booleans are read as 0 and 1".to_owned());
    }
    Ok(Header {
        components: array.components,
        times: array.times,
        meaning: match (array.is_color, array.components) {
            (true, 3) => ComponentKind::Rgb,
            (true, _) => ComponentKind::Rgba,
            (false, _) => ComponentKind::Numbers,
        },
        notes,
        ..Header::new(Format::Npy, array.dims, kind.stored, world_from_voxel)
    })
}
