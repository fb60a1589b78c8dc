//! Stored numbers of a grid, x fastest, then y, then z.

use half::f16;

/// The type of the numbers in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
#[allow(missing_docs, reason = "the names say it")]
pub enum VoxelType {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F16,
    F32,
    F64,
}

impl VoxelType {
    /// Size of one number in a file.
    pub fn bytes(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 | Self::F16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::U64 | Self::I64 | Self::F64 => 8,
        }
    }

    /// The word of the command line and of `info --json`: `u8`, `i16`, `f32`, ...
    pub fn name(self) -> &'static str {
        match self {
            Self::U8 => "u8",
            Self::I8 => "i8",
            Self::U16 => "u16",
            Self::I16 => "i16",
            Self::U32 => "u32",
            Self::I32 => "i32",
            Self::U64 => "u64",
            Self::I64 => "i64",
            Self::F16 => "f16",
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }

    /// True for f16, f32 and f64.
    pub fn is_float(self) -> bool {
        matches!(self, Self::F16 | Self::F32 | Self::F64)
    }

    /// True where [`Voxels`] keeps every value of this type exactly.
    pub fn is_kept_exactly(self) -> bool {
        !matches!(
            self,
            Self::U32 | Self::I32 | Self::U64 | Self::I64 | Self::F64
        )
    }
}

/// Stored numbers in memory. 32- and 64-bit integers and f64 have become f32 on the way here.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Voxels {
    U8(Vec<u8>),
    I8(Vec<i8>),
    U16(Vec<u16>),
    I16(Vec<i16>),
    F16(Vec<f16>),
    F32(Vec<f32>),
}

impl Voxels {
    /// How many numbers there are.
    pub fn len(&self) -> usize {
        match self {
            Self::U8(v) => v.len(),
            Self::I8(v) => v.len(),
            Self::U16(v) => v.len(),
            Self::I16(v) => v.len(),
            Self::F16(v) => v.len(),
            Self::F32(v) => v.len(),
        }
    }

    /// True for no numbers at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The type in memory.
    pub fn voxel_type(&self) -> VoxelType {
        match self {
            Self::U8(_) => VoxelType::U8,
            Self::I8(_) => VoxelType::I8,
            Self::U16(_) => VoxelType::U16,
            Self::I16(_) => VoxelType::I16,
            Self::F16(_) => VoxelType::F16,
            Self::F32(_) => VoxelType::F32,
        }
    }

    /// The stored number at `index`; every type fits an f32 exactly.
    pub fn stored(&self, index: usize) -> f32 {
        match self {
            Self::U8(v) => v[index].into(),
            Self::I8(v) => v[index].into(),
            Self::U16(v) => v[index].into(),
            Self::I16(v) => v[index].into(),
            Self::F16(v) => v[index].to_f32(),
            Self::F32(v) => v[index],
        }
    }
}

/// A type of number that [`Voxels`] keeps.
pub(super) trait Stored: Copy + Default + PartialOrd {
    fn to_f32(self) -> f32;
    fn is_finite(self) -> bool;
    /// `fill` as this type; `None` where no voxel of this type can be equal to it.
    fn from_fill(fill: f64) -> Option<Self>;
}

macro_rules! stored_integer {
    ($($integer:ident)*) => {$(
        impl Stored for $integer {
            fn to_f32(self) -> f32 {
                self.into()
            }
            fn is_finite(self) -> bool {
                true
            }
            fn from_fill(fill: f64) -> Option<Self> {
                let nearest = fill as $integer;
                (f64::from(nearest) == fill).then_some(nearest)
            }
        }
    )*};
}

stored_integer!(u8 i8 u16 i16);

impl Stored for f16 {
    fn to_f32(self) -> f32 {
        self.to_f32()
    }
    fn is_finite(self) -> bool {
        self.is_finite()
    }
    fn from_fill(fill: f64) -> Option<Self> {
        Some(Self::from_f64(fill)).filter(|fill| fill.is_finite())
    }
}

// Numbers of 32 and 64 bits were rounded to f32; the fill is rounded in the same way to meet them.
impl Stored for f32 {
    fn to_f32(self) -> f32 {
        self
    }
    fn is_finite(self) -> bool {
        self.is_finite()
    }
    fn from_fill(fill: f64) -> Option<Self> {
        Some(fill as f32).filter(|fill| fill.is_finite())
    }
}

/// `$body` with `$numbers` bound to the vector inside, whatever its type.
macro_rules! with_numbers {
    ($voxels:expr, $numbers:ident => $body:expr) => {
        match $voxels {
            $crate::volume::Voxels::U8($numbers) => $body,
            $crate::volume::Voxels::I8($numbers) => $body,
            $crate::volume::Voxels::U16($numbers) => $body,
            $crate::volume::Voxels::I16($numbers) => $body,
            $crate::volume::Voxels::F16($numbers) => $body,
            $crate::volume::Voxels::F32($numbers) => $body,
        }
    };
}
pub(super) use with_numbers;
