//! An open HDF5 file as [`Arrays`].

use super::HDF5;
use super::chunks::{ChunkBytes, filter_name, filters};
use crate::format::cf::{Arrays, Attributes, Contents, Dimension, Kind, Value, Variable};
use crate::format::convert::{Builder, Endian, piece_of, to_u64};
use crate::format::fence::fenced;
use crate::format::place::open_regular;
use crate::format::problem::{escape, invalid, unsupported};
use crate::volume::{Limits, Piece, Problem, VoxelType};
use hdf5_reader::error::{ByteOrder, Error};
use hdf5_reader::group::Group;
use hdf5_reader::{
    Attribute, Dataset, Datatype, FileStorage, H5Type, Hdf5File, OpenOptions, SliceInfo,
    SliceInfoElem,
};
use std::path::Path;
use std::sync::Arc;

/// An open file, and what its data sets are.
pub(crate) struct Hdf5 {
    file: Hdf5File,
    contents: Contents,
    /// Of the data sets that were read.
    pub(in crate::format) chunk_bytes: ChunkBytes,
}

/// Groups below each other, and data sets, beyond which no file is looked through.
const MAX_DEPTH: usize = 32;
const MAX_OBJECTS: usize = 10_000;

/// Chunks that are kept decoded.
const CACHE_BYTES: u64 = 64 << 20;

impl Hdf5 {
    /// Opens without looking for data sets. Gives the file's length too.
    pub(in crate::format) fn open(path: &Path, limits: &Limits) -> Result<(Self, u64), Problem> {
        let (file, metadata) = open_regular(path)?;
        let file_bytes = metadata.len();
        let bytes = |bytes: u64| usize::try_from(bytes).unwrap_or(usize::MAX);
        let chunk_bytes = ChunkBytes::default();
        let file = fenced(HDF5, "superblock", || {
            let storage = FileStorage::from_file(file)
                .map_err(|error| problem_of(HDF5, "superblock", &error))?;
            let options = OpenOptions::default()
                .with_chunk_cache_bytes(bytes(CACHE_BYTES.min(limits.max_bytes)))
                .with_max_chunk_bytes(bytes(limits.max_bytes))
                .with_max_read_bytes(bytes(limits.max_bytes))
                .with_max_object_header_bytes(limits.max_header_bytes)
                .with_filter_registry(filters(&chunk_bytes));
            Hdf5File::from_storage_with_options(Arc::new(storage), options)
                .map_err(|error| problem_of(HDF5, "superblock", &error))
        })?;
        // The library refuses such files too: what is missing could be voxels.
        let promised = file.superblock().eof_address;
        if promised > file_bytes {
            return Err(Problem::Invalid {
                format: HDF5,
                field: "end of file address".to_owned(),
                wanted: format!("a file of {promised} bytes"),
                found: format!("{file_bytes} bytes"),
            });
        }
        let hdf5 = Self {
            file,
            contents: Contents {
                path: path.to_owned(),
                format: HDF5,
                variables: Vec::new(),
                attributes: Attributes::default(),
            },
            chunk_bytes,
        };
        Ok((hdf5, file_bytes))
    }

    /// True for what the NetCDF library wrote: it leaves attributes of its own.
    pub(super) fn is_netcdf(&self) -> Result<bool, Problem> {
        fenced(HDF5, "root group", || {
            let root = self.file.root_group();
            let root = root.map_err(|error| problem_of(HDF5, "root group", &error))?;
            let marks = ["_NCProperties", "_nc3_strict"];
            // An attribute that cannot be read says nothing.
            let of_root = root.attributes().unwrap_or_default();
            if of_root
                .iter()
                .any(|attribute| marks.contains(&attribute.name.as_str()))
            {
                return Ok(true);
            }
            let ending = self
                .contents
                .path
                .extension()
                .and_then(|ending| ending.to_str());
            if ending
                .is_some_and(|e| matches!(e.to_ascii_lowercase().as_str(), "nc" | "nc4" | "cdf"))
            {
                return Ok(true);
            }
            let (_, datasets) = root
                .members()
                .map_err(|error| problem_of(HDF5, "root group", &error))?;
            let marks = ["_Netcdf4Dimid", "_Netcdf4Coordinates"];
            Ok(datasets.iter().take(MAX_OBJECTS).any(|dataset| {
                let attributes = dataset.attributes();
                attributes
                    .iter()
                    .any(|attribute| marks.contains(&attribute.name.as_str()))
            }))
        })
    }

    /// With all data sets that the root group leads to.
    pub(super) fn listed(mut self, limits: &Limits) -> Result<Self, Problem> {
        let variables = fenced(HDF5, "groups", || {
            let root = self.file.root_group();
            let root = root.map_err(|error| problem_of(HDF5, "root group", &error))?;
            let mut found = Vec::new();
            let mut seen = vec![root.address()];
            list(&root, "", 0, &mut seen, &mut found)?;
            Ok(found)
        })?;
        let text: u64 = variables
            .iter()
            .map(|variable| to_u64(variable.name.len()))
            .sum();
        if text > to_u64(limits.max_header_bytes) {
            return Err(Problem::Limit {
                what: "the names of data sets".to_owned(),
                wanted_bytes: text,
                limit_bytes: to_u64(limits.max_header_bytes),
            });
        }
        self.contents.variables = variables;
        Ok(self)
    }

    /// A data set whose chunks may be read. `format` is the word of errors.
    pub(in crate::format) fn dataset(
        &self,
        format: &'static str,
        name: &str,
    ) -> Result<Dataset, Problem> {
        let found = self.file.dataset(name);
        let dataset = found.map_err(|error| problem_of(format, name, &error))?;
        self.chunk_bytes.admit(&dataset, format, name)?;
        Ok(dataset)
    }
}

/// Data sets of a group and those below it. Groups may hold one another: each is entered once.
fn list(
    group: &Group,
    prefix: &str,
    depth: usize,
    seen: &mut Vec<u64>,
    found: &mut Vec<Variable>,
) -> Result<(), Problem> {
    let (groups, datasets) = group.members().map_err(|error| {
        problem_of(
            HDF5,
            if prefix.is_empty() {
                "root group"
            } else {
                prefix
            },
            &error,
        )
    })?;
    for dataset in datasets {
        if found.len() >= MAX_OBJECTS {
            return Err(unsupported(
                HDF5,
                format!("a file of more than {MAX_OBJECTS} data sets"),
            ));
        }
        found.push(variable(&dataset, prefix));
    }
    for group in groups {
        if seen.contains(&group.address()) {
            continue;
        }
        if depth >= MAX_DEPTH || seen.len() >= MAX_OBJECTS {
            let what = format!(
                "a file of more than {MAX_DEPTH} groups below each other, or {MAX_OBJECTS} of them,"
            );
            return Err(unsupported(HDF5, what));
        }
        seen.push(group.address());
        let prefix = format!("{prefix}{}/", group.name());
        list(&group, &prefix, depth.saturating_add(1), seen, found)?;
    }
    Ok(())
}

fn variable(dataset: &Dataset, prefix: &str) -> Variable {
    let name = dataset.name().rsplit('/').next().unwrap_or("");
    let dimensions = dataset.shape().iter().enumerate();
    Variable {
        name: format!("{prefix}{name}"),
        dimensions: dimensions
            .map(|(k, &size)| Dimension {
                name: k.to_string(),
                size,
            })
            .collect(),
        kind: kind(dataset.dtype()),
        attributes: Attributes(dataset.attributes().iter().filter_map(attribute).collect()),
    }
}

fn kind(datatype: &Datatype) -> Kind {
    Kind::Numbers(match *datatype {
        Datatype::FixedPoint { size, signed, .. } => match (size, signed) {
            (1, false) => VoxelType::U8,
            (1, true) => VoxelType::I8,
            (2, false) => VoxelType::U16,
            (2, true) => VoxelType::I16,
            (4, false) => VoxelType::U32,
            (4, true) => VoxelType::I32,
            (8, false) => VoxelType::U64,
            (8, true) => VoxelType::I64,
            _ => return Kind::Other,
        },
        Datatype::FloatingPoint { size, .. } => match size {
            2 => VoxelType::F16,
            4 => VoxelType::F32,
            8 => VoxelType::F64,
            _ => return Kind::Other,
        },
        Datatype::String { .. } => return Kind::Text,
        _ => return Kind::Other,
    })
}

/// An attribute of numbers or of text; others say nothing to us.
fn attribute(attribute: &Attribute) -> Option<(String, Value)> {
    macro_rules! numbers {
        ($($size:literal $is_signed:literal $number:ty),*) => {
            match &attribute.datatype {
                $(Datatype::FixedPoint { size: $size, signed: $is_signed, .. } => {
                    attribute.read_1d::<$number>().ok()?.into_iter().map(|n| n as f64).collect()
                })*
                Datatype::FloatingPoint { size: 4, .. } => {
                    attribute.read_1d::<f32>().ok()?.into_iter().map(f64::from).collect()
                }
                Datatype::FloatingPoint { size: 8, .. } => attribute.read_1d::<f64>().ok()?,
                _ => return Some((attribute.name.clone(), Value::Text(attribute.read_string().ok()?))),
            }
        };
    }
    let numbers: Vec<f64> = numbers!(
        1 false u8, 1 true i8, 2 false u16, 2 true i16, 4 false u32, 4 true i32, 8 false u64, 8 true i64
    );
    Some((attribute.name.clone(), Value::Numbers(numbers)))
}

/// A number of 16 bits, which the crate has no type for.
#[derive(Clone, Copy)]
struct Half([u8; 2]);

impl H5Type for Half {
    fn hdf5_type() -> Datatype {
        Datatype::FloatingPoint {
            size: 2,
            byte_order: ByteOrder::LittleEndian,
        }
    }

    fn from_bytes(bytes: &[u8], datatype: &Datatype) -> hdf5_reader::error::Result<Self> {
        match (bytes.first_chunk::<2>(), datatype) {
            (
                Some(&[a, b]),
                Datatype::FloatingPoint {
                    size: 2,
                    byte_order,
                },
            ) => Ok(Self(match byte_order {
                ByteOrder::LittleEndian => [a, b],
                ByteOrder::BigEndian => [b, a],
            })),
            _ => Err(Error::InvalidData("no number of 16 bits".to_owned())),
        }
    }

    fn element_size(_: &Datatype) -> usize {
        2
    }
}

/// The decoder's error in our words. What it does not support is a valid file.
pub(crate) fn problem_of(format: &'static str, what: &str, error: &Error) -> Problem {
    match error {
        Error::Context { source, .. } => problem_of(format, what, source),
        Error::Io(cause) => Problem::Io {
            doing: "reading the file",
            cause: std::io::Error::new(cause.kind(), cause.to_string()),
        },
        Error::UnsupportedFilter(name) => unsupported(format, filter_name(name)),
        Error::UnsupportedEncoding(what) => unsupported(format, escape(what)),
        Error::UnsupportedDatatypeClass(class) => {
            unsupported(format, format!("a type of class {class}"))
        }
        // Class 3 of the HDF5 format specification, IV.A.2.i.
        Error::UnsupportedLayoutClass(3) => {
            unsupported(format, "a virtual data set, whose numbers are in others,")
        }
        Error::Other(cause) if cause.starts_with("external raw data file") => {
            unsupported(format, "a data set whose numbers are in another file")
        }
        other => invalid(format, what, "bytes that are in order", &other.to_string()),
    }
}

impl Arrays for Hdf5 {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(
        &self,
        variable: &Variable,
        start: &[u64],
        count: &[u64],
        stored: VoxelType,
    ) -> Result<Piece, Problem> {
        let name = variable.name.as_str();
        let ends = start.iter().zip(count);
        let selection = SliceInfo {
            selections: ends
                .map(|(&start, &count)| SliceInfoElem::Slice {
                    start,
                    end: start.saturating_add(count),
                    step: 1,
                })
                .collect(),
        };
        fenced(HDF5, name, || {
            let dataset = self.dataset(HDF5, name)?;
            macro_rules! read {
                ($number:ty) => {{
                    let found = dataset.read_slice::<$number>(&selection);
                    let array = found.map_err(|error| problem_of(HDF5, name, &error))?;
                    piece_of(array.as_slice().unwrap_or(&[]), stored)
                }};
            }
            match stored {
                VoxelType::U8 => read!(u8),
                VoxelType::I8 => read!(i8),
                VoxelType::U16 => read!(u16),
                VoxelType::I16 => read!(i16),
                VoxelType::U32 => read!(u32),
                VoxelType::I32 => read!(i32),
                VoxelType::U64 => read!(u64),
                VoxelType::I64 => read!(i64),
                VoxelType::F32 => read!(f32),
                VoxelType::F64 => read!(f64),
                VoxelType::F16 => {
                    let found = dataset.read_slice::<Half>(&selection);
                    let array = found.map_err(|error| problem_of(HDF5, name, &error))?;
                    let bytes: Vec<u8> = array.iter().flat_map(|half| half.0).collect();
                    let mut builder = Builder::new(stored, Endian::Little, array.len());
                    builder.push(&bytes, 1)?;
                    Ok(builder.finish())
                }
            }
        })
    }
}
