//! What the metadata of an array say, in either version of Zarr: shape, chunks, numbers, codecs.

use super::ZARR;
use super::codec::Codec;
use super::json::{Object, number, wrong};
use crate::format::convert::{Builder, Endian, to_u64};
use crate::format::problem::{invalid, unsupported};
use crate::volume::{Limits, Piece, Problem, VoxelType};
use half::f16;
use serde_json::Value;

/// An array. Every list has one entry an axis, slowest first.
#[derive(Clone, Debug)]
pub(super) struct Array {
    /// Where in the store; empty for the store itself.
    pub path: String,
    /// Numbers along each axis; none is zero.
    pub shape: Vec<u64>,
    pub stored: VoxelType,
    /// The files of the array.
    pub chunk: Vec<u64>,
    pub keys: Keys,
    /// How what lies in a file is written; of an array in shards, one chunk of a shard.
    pub codecs: Codecs,
    pub shards: Option<Shards>,
    pub fill: Fill,
    /// Names of the axes, where the file gives them.
    pub dimension_names: Option<Vec<String>>,
    pub attributes: Object,
}

/// How the bytes of a chunk become numbers.
#[derive(Clone, Debug)]
pub(super) struct Codecs {
    /// The axes of the array in the order in which they lie in the bytes, slowest first.
    pub order: Vec<usize>,
    pub endian: Endian,
    /// From the numbers to the file.
    pub bytes: Vec<Codec>,
}

/// Files that hold several chunks each, and an index of them.
#[derive(Clone, Debug)]
pub(super) struct Shards {
    /// Numbers of one of the chunks along each axis.
    pub chunk: Vec<u64>,
    pub index_endian: Endian,
    pub index_has_checksum: bool,
    pub index_at_end: bool,
}

/// How a chunk's place becomes the name of its file.
#[derive(Clone, Debug)]
pub(super) struct Keys {
    /// True for `c/0/1`, false for `0/1`.
    pub prefixed: bool,
    pub separator: char,
}

/// The number that stands where a chunk is not there.
#[derive(Clone, Debug)]
pub(super) struct Fill {
    /// Little-endian, as many as the type has.
    pub bytes: Vec<u8>,
    pub number: f64,
    /// False where the file says that there is none.
    pub is_given: bool,
}

impl Array {
    /// Axes.
    pub(super) fn rank(&self) -> usize {
        self.shape.len()
    }

    /// The box that is decoded at once.
    pub(super) fn unit(&self) -> &[u64] {
        self.shards
            .as_ref()
            .map_or(&self.chunk, |shards| &shards.chunk)
    }

    /// Decoded bytes of what is decoded at once.
    pub(super) fn unit_bytes(&self) -> u64 {
        bytes_of(self.unit(), self.stored)
    }

    /// The name of the file of one chunk.
    pub(super) fn key(&self, chunk: &[u64]) -> String {
        let mut parts: Vec<String> = chunk.iter().map(u64::to_string).collect();
        if self.keys.prefixed {
            parts.insert(0, "c".to_owned());
        } else if parts.is_empty() {
            parts.push("0".to_owned());
        }
        let name = parts.join(&self.keys.separator.to_string());
        match self.path.as_str() {
            "" => name,
            path => format!("{path}/{name}"),
        }
    }

    /// One number of the fill value as it is kept in memory.
    pub(super) fn fill_piece(&self) -> Result<Piece, Problem> {
        let mut builder = Builder::new(self.stored, Endian::Little, 1);
        builder.push(&self.fill.bytes, 1)?;
        Ok(builder.finish())
    }

    /// The rules that hold in both versions.
    pub(super) fn check(self, limits: &Limits) -> Result<Self, Problem> {
        let rank = self.rank();
        let sides = |sides: &[u64]| format!("{sides:?}");
        if self.shape.contains(&0) {
            let wanted = "no axis without numbers";
            return Err(invalid(ZARR, "shape", wanted, &sides(&self.shape)));
        }
        if to_u64(rank) > MOST_AXES || bytes_of(&self.shape, self.stored) == u64::MAX {
            let wanted = format!("at most {MOST_AXES} axes and 2^64 bytes");
            return Err(invalid(ZARR, "shape", wanted, &sides(&self.shape)));
        }
        for chunk in [&self.chunk[..], self.unit()] {
            if chunk.len() != rank || chunk.contains(&0) {
                let wanted = format!("{rank} numbers above 0, one an axis");
                return Err(invalid(ZARR, "chunk shape", wanted, &sides(chunk)));
            }
        }
        let divides = |(shard, chunk): (&u64, &u64)| shard.checked_rem(*chunk) == Some(0);
        if !self.chunk.iter().zip(self.unit()).all(divides) {
            let wanted = format!("numbers that divide those of a shard, {:?}", self.chunk);
            return Err(invalid(ZARR, "chunk shape", wanted, &sides(self.unit())));
        }
        if self.unit_bytes() > limits.max_bytes {
            return Err(Problem::Limit {
                what: format!("one chunk of {:?} numbers", self.unit()),
                wanted_bytes: self.unit_bytes(),
                limit_bytes: limits.max_bytes,
            });
        }
        let names = self.dimension_names.as_ref();
        if names.is_some_and(|names| names.len() != rank) {
            let wanted = format!("{rank} names, one an axis");
            let found = format!("{:?}", names.unwrap_or(&Vec::new()));
            return Err(invalid(ZARR, "dimension names", wanted, &found));
        }
        Ok(self)
    }
}

/// More axes than any file has.
const MOST_AXES: u64 = 16;

/// Bytes of a box, `u64::MAX` where they are more.
pub(super) fn bytes_of(sides: &[u64], stored: VoxelType) -> u64 {
    sides.iter().fold(to_u64(stored.bytes()), |product, &side| {
        product.saturating_mul(side)
    })
}

impl Fill {
    /// The fill value of either version for numbers of the type `stored`; null is none.
    pub(super) fn of(value: &Value, stored: VoxelType) -> Result<Self, Problem> {
        let fail = || {
            let wanted = format!("a number that a {} holds", stored.name());
            wrong("fill_value", wanted, value)
        };
        if value.is_null() {
            return Ok(Self {
                bytes: vec![0; stored.bytes()],
                number: 0.0,
                is_given: false,
            });
        }
        let bytes = if let Some(hex) = value.as_str().and_then(|word| word.strip_prefix("0x")) {
            // Version 3: the bits of a number, the most significant first.
            let bits = u64::from_str_radix(hex, 16).map_err(|_| fail())?;
            let all = bits.to_le_bytes();
            let (used, unused) = all.split_at_checked(stored.bytes()).ok_or_else(fail)?;
            if unused.iter().any(|&byte| byte != 0) || !stored.is_float() {
                return Err(fail());
            }
            used.to_vec()
        } else if stored.is_float() {
            float_bytes(number(value).ok_or_else(fail)?, stored)
        } else {
            integer_bytes(integer(value).ok_or_else(fail)?, stored).ok_or_else(fail)?
        };
        let number = match stored {
            VoxelType::U64 => bytes
                .first_chunk()
                .map(|bytes| u64::from_le_bytes(*bytes) as f64),
            _ => number_of(&bytes, stored),
        };
        Ok(Self {
            bytes,
            number: number.ok_or_else(fail)?,
            is_given: true,
        })
    }
}

/// The whole number that a fill value is; yes and no count.
fn integer(value: &Value) -> Option<i128> {
    match value {
        Value::Bool(yes) => Some(i128::from(*yes)),
        _ => value
            .as_i64()
            .map(i128::from)
            .or_else(|| value.as_u64().map(i128::from))
            .or_else(|| crate::format::text::whole(value.as_f64()?).map(i128::from)),
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "rounding to the type of the array is what this is for"
)]
fn float_bytes(number: f64, stored: VoxelType) -> Vec<u8> {
    match stored {
        VoxelType::F16 => f16::from_f64(number).to_le_bytes().to_vec(),
        VoxelType::F32 => (number as f32).to_le_bytes().to_vec(),
        _ => number.to_le_bytes().to_vec(),
    }
}

/// Little-endian; `None` where the type does not hold the number.
fn integer_bytes(number: i128, stored: VoxelType) -> Option<Vec<u8>> {
    macro_rules! bytes {
        ($integer:ty) => {
            <$integer>::try_from(number).ok()?.to_le_bytes().to_vec()
        };
    }
    Some(match stored {
        VoxelType::U8 => bytes!(u8),
        VoxelType::I8 => bytes!(i8),
        VoxelType::U16 => bytes!(u16),
        VoxelType::I16 => bytes!(i16),
        VoxelType::U32 => bytes!(u32),
        VoxelType::I32 => bytes!(i32),
        VoxelType::U64 => bytes!(u64),
        VoxelType::I64 => bytes!(i64),
        VoxelType::F16 | VoxelType::F32 | VoxelType::F64 => return None,
    })
}

/// The number that little-endian bytes begin with, as near as an f64 comes.
#[allow(
    clippy::cast_precision_loss,
    reason = "coordinates and fill values beyond 2^53 are rounded"
)]
pub(super) fn number_of(bytes: &[u8], stored: VoxelType) -> Option<f64> {
    macro_rules! first {
        ($number:ty) => {
            <$number>::from_le_bytes(*bytes.first_chunk()?)
        };
    }
    Some(match stored {
        VoxelType::U8 => first!(u8).into(),
        VoxelType::I8 => first!(i8).into(),
        VoxelType::U16 => first!(u16).into(),
        VoxelType::I16 => first!(i16).into(),
        VoxelType::U32 => first!(u32).into(),
        VoxelType::I32 => first!(i32).into(),
        VoxelType::U64 => first!(u64) as f64,
        VoxelType::I64 => first!(i64) as f64,
        VoxelType::F16 => first!(f16).into(),
        VoxelType::F32 => first!(f32).into(),
        VoxelType::F64 => first!(f64),
    })
}

/// A valid thing that we do not read, by its name in the file.
pub(super) fn not_read(what: &str, name: &str) -> Problem {
    unsupported(
        ZARR,
        format!("{what} `{}`", crate::format::problem::escape(name)),
    )
}
