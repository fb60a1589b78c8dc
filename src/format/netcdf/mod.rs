//! NetCDF: classic (CDF-1), 64-bit offset (CDF-2), 64-bit data (CDF-5), and NetCDF-4, which is HDF5.
//!
//! By the NetCDF file format specifications, docs.unidata.ucar.edu/netcdf-c, appendix B and C. The bytes are
//! decoded by the crate `netcdf-reader`, which is young: every call is fenced, and given limits. What the
//! variables mean is [`super::cf`]'s.

mod length;

use super::cf::{self, Arrays, Attributes, Contents, Dimension, Kind, Value, Variable};
use super::convert::piece_of;
use super::fence::fenced;
use super::hdf5::{Hdf5, filters, problem_of as hdf5_problem};
use super::place::open_regular;
use super::points::{PointColumns, PointFile, sampled};
use super::problem::{at, escape, invalid, unsupported};
use crate::volume::{
    Format, Limits, Piece, Problem, ReadError, Source, VolumeSelection, VoxelType,
};
use netcdf_reader::{
    Error, NcAttrValue, NcAttribute, NcFile, NcGroup, NcOpenOptions, NcSliceInfo, NcSliceInfoElem,
    NcType, NcVariable,
};
use std::path::Path;
use std::sync::Arc;

/// The word of errors.
const NETCDF: &str = "netcdf";

/// True for a file of the classic formats; a NetCDF-4 file begins as HDF5 does.
pub(super) fn recognizes(first: &[u8]) -> bool {
    matches!(first, [b'C', b'D', b'F', 1 | 2 | 5, ..])
}

/// Opens a variable of a file of the classic formats.
pub(super) fn open(
    path: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    opened(path, None, wanted, limits)
}

/// Opens a variable of a NetCDF-4 file.
pub(super) fn open_hdf5(
    path: &Path,
    hdf5: Hdf5,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    opened(path, Some(hdf5), wanted, limits)
}

fn opened(
    path: &Path,
    hdf5: Option<Hdf5>,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let (file, file_bytes) = NetCdf::open(path, hdf5, limits).map_err(at(path))?;
    if cf::is_sampled(&file) {
        let columns = PointColumns {
            value: wanted.variable.clone(),
            ..PointColumns::default()
        };
        return Ok(Box::new(sampled::open(&file, &columns, limits)?));
    }
    cf::open(Arc::new(file), file_bytes, Format::NetCdf, wanted, limits)
}

/// Opens the samples of a file that says that it has samples.
pub(super) fn open_samples(
    path: &Path,
    columns: &PointColumns,
    limits: &Limits,
) -> Result<PointFile, ReadError> {
    let file = open_either(path, limits).map_err(at(path))?;
    if !cf::is_sampled(&file) {
        let wanted = "`featureType` of samples, such as point: this is a grid";
        return Err(at(path)(invalid(NETCDF, "featureType", wanted, "none")));
    }
    sampled::open(&file, columns, limits)
}

/// True for a file that says that it has samples, and can be opened.
pub(super) fn holds_samples(path: &Path, limits: &Limits) -> bool {
    open_either(path, limits).is_ok_and(|file| cf::is_sampled(&file))
}

/// A file of the classic formats, or of NetCDF-4.
fn open_either(path: &Path, limits: &Limits) -> Result<NetCdf, Problem> {
    let first = super::first_bytes(path)?;
    let hdf5 = match super::hdf5::recognizes(&first) {
        true => Some(Hdf5::open(path, limits)?.0),
        false => None,
    };
    Ok(NetCdf::open(path, hdf5, limits)?.0)
}

/// An open file, and what its variables are.
struct NetCdf {
    file: NcFile,
    /// The same file without the meaning of NetCDF, where it has chunks.
    hdf5: Option<Hdf5>,
    contents: Contents,
}

/// Chunks that are kept decoded.
const CACHE_BYTES: u64 = 64 << 20;

/// A variable of more numbers or strings is no coordinate.
const MAX_SMALL: u64 = 1 << 24;

impl NetCdf {
    fn open(path: &Path, hdf5: Option<Hdf5>, limits: &Limits) -> Result<(Self, u64), Problem> {
        let (file, metadata) = open_regular(path)?;
        let bytes = |bytes: u64| usize::try_from(bytes).unwrap_or(usize::MAX);
        let options = NcOpenOptions {
            chunk_cache_bytes: bytes(CACHE_BYTES.min(limits.max_bytes)),
            max_chunk_bytes: bytes(limits.max_bytes),
            max_read_bytes: bytes(limits.max_bytes),
            max_object_header_bytes: limits.max_header_bytes,
            filter_registry: hdf5.as_ref().map(|hdf5| filters(&hdf5.chunk_bytes)),
            ..NcOpenOptions::default()
        };
        fenced(NETCDF, "header", || {
            let storage = netcdf_reader::FileStorage::from_file(file)
                .map_err(|error| hdf5_problem(NETCDF, "header", &error))?;
            let file = NcFile::from_storage_with_options(Arc::new(storage), options)
                .map_err(|error| problem_of("header", &error))?;
            let root = file
                .root_group()
                .map_err(|error| problem_of("header", &error))?;
            length::check(file.format(), &root.variables, metadata.len())?;
            let mut variables = Vec::new();
            list(root, "", &mut variables);
            let attributes = attributes(&root.attributes);
            let open = Self {
                contents: Contents {
                    path: path.to_owned(),
                    format: NETCDF,
                    variables,
                    attributes,
                },
                file,
                hdf5,
            };
            Ok((open, metadata.len()))
        })
    }

    /// Refuses a variable whose chunks cannot be, before one is read.
    fn check_chunks(&self, name: &str) -> Result<(), Problem> {
        match &self.hdf5 {
            Some(hdf5) => hdf5.dataset(NETCDF, name).map(drop),
            None => Ok(()),
        }
    }
}

fn list(group: &NcGroup, prefix: &str, found: &mut Vec<Variable>) {
    found.extend(
        group
            .variables
            .iter()
            .map(|inside| variable(inside, prefix)),
    );
    for inner in &group.groups {
        let name = inner
            .name
            .trim_matches('/')
            .rsplit('/')
            .next()
            .unwrap_or("");
        list(inner, &format!("{prefix}{name}/"), found);
    }
}

fn variable(inside: &NcVariable, prefix: &str) -> Variable {
    let dimensions = inside.dimensions.iter();
    Variable {
        name: format!("{prefix}{}", inside.name),
        dimensions: dimensions
            .map(|dimension| Dimension {
                name: dimension.name.clone(),
                size: dimension.size,
            })
            .collect(),
        kind: kind(&inside.dtype),
        attributes: attributes(&inside.attributes),
    }
}

fn kind(nc_type: &NcType) -> Kind {
    Kind::Numbers(match nc_type {
        NcType::Byte => VoxelType::I8,
        NcType::UByte => VoxelType::U8,
        NcType::Short => VoxelType::I16,
        NcType::UShort => VoxelType::U16,
        NcType::Int => VoxelType::I32,
        NcType::UInt => VoxelType::U32,
        NcType::Int64 => VoxelType::I64,
        NcType::UInt64 => VoxelType::U64,
        NcType::Float => VoxelType::F32,
        NcType::Double => VoxelType::F64,
        NcType::Char | NcType::String => return Kind::Text,
        NcType::Enum { .. }
        | NcType::Compound { .. }
        | NcType::Opaque { .. }
        | NcType::Array { .. }
        | NcType::VLen { .. } => return Kind::Other,
    })
}

fn attributes(list: &[NcAttribute]) -> Attributes {
    let value = |value: &NcAttrValue| match value {
        NcAttrValue::Chars(text) => Some(Value::Text(text.clone())),
        NcAttrValue::Strings(texts) => Some(Value::Text(texts.join(" "))),
        other => other.as_f64_vec().map(Value::Numbers),
    };
    let pairs = list
        .iter()
        .filter_map(|attribute| Some((attribute.name.clone(), value(&attribute.value)?)));
    Attributes(pairs.collect())
}

/// The decoder's error in our words. What it does not support is a valid file.
fn problem_of(what: &str, error: &Error) -> Problem {
    match error {
        Error::Hdf5(error) => hdf5_problem(NETCDF, what, error),
        Error::Io(cause) => Problem::Io {
            doing: "reading the file",
            cause: std::io::Error::new(cause.kind(), cause.to_string()),
        },
        Error::UnsupportedFeature(what) => unsupported(NETCDF, escape(what)),
        Error::UnsupportedVersion(version) => unsupported(NETCDF, format!("version {version}")),
        other => invalid(NETCDF, what, "bytes that are in order", &other.to_string()),
    }
}

fn check_small(variable: &Variable) -> Result<(), Problem> {
    let count = variable.count();
    if count <= MAX_SMALL {
        return Ok(());
    }
    let wanted = format!("a coordinate of at most {MAX_SMALL} points");
    Err(invalid(NETCDF, &variable.name, wanted, &count.to_string()))
}

impl Arrays for NetCdf {
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
        let selection = NcSliceInfo {
            selections: ends
                .map(|(&start, &count)| NcSliceInfoElem::Slice {
                    start,
                    end: start.saturating_add(count),
                    step: 1,
                })
                .collect(),
        };
        // A type that is read as unsigned is stored as the signed one.
        let Kind::Numbers(in_file) = variable.kind else {
            return Err(unsupported(NETCDF, "a variable that holds no numbers"));
        };
        fenced(NETCDF, name, || {
            self.check_chunks(name)?;
            macro_rules! read {
                ($number:ty) => {{
                    let found = self.file.read_variable_slice::<$number>(name, &selection);
                    let array = found.map_err(|error| problem_of(name, &error))?;
                    piece_of(array.as_slice().unwrap_or(&[]), stored)
                }};
            }
            match in_file {
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
                VoxelType::F16 => Err(unsupported(NETCDF, "16-bit floats")),
            }
        })
    }

    fn numbers(&self, variable: &Variable) -> Result<Vec<f64>, Problem> {
        check_small(variable)?;
        let name = variable.name.as_str();
        fenced(NETCDF, name, || {
            self.check_chunks(name)?;
            let found = self.file.read_variable_as_f64(name);
            let array = found.map_err(|error| problem_of(name, &error))?;
            Ok(array.iter().copied().collect())
        })
    }

    fn texts(&self, variable: &Variable) -> Result<Vec<String>, Problem> {
        check_small(variable)?;
        let name = variable.name.as_str();
        fenced(NETCDF, name, || {
            self.check_chunks(name)?;
            let found = self.file.read_variable_as_strings(name);
            found.map_err(|error| problem_of(name, &error))
        })
    }
}
