//! Numbers of 8 and 16 bits by their bits: what depends on a stored number alone is made once for each code, and looked up.
//!
//! ```text
//! code = the bits of a stored number, read as an unsigned one          256 of them, or 65 536
//! ```

use super::{VoxelType, Voxels};
use half::f16;

/// The codes of voxels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Codes<'a> {
    /// Of numbers of 8 bits.
    Bytes(&'a [u8]),
    /// Of numbers of 16 bits.
    Words(&'a [u16]),
}

impl Voxels {
    /// The code of each number; `None` of numbers of 32 bits, which have too many.
    pub fn codes(&self) -> Option<Codes<'_>> {
        match self {
            Self::U8(v) => Some(Codes::Bytes(v)),
            Self::I8(v) => Some(Codes::Bytes(bytemuck::cast_slice(v))),
            Self::U16(v) => Some(Codes::Words(v)),
            Self::I16(v) => Some(Codes::Words(bytemuck::cast_slice(v))),
            Self::F16(v) => Some(Codes::Words(bytemuck::cast_slice(v))),
            Self::F32(_) => None,
        }
    }
}

impl<'a> Codes<'a> {
    /// Bits of a code.
    pub fn bits(self) -> u32 {
        match self {
            Self::Bytes(_) => 8,
            Self::Words(_) => 16,
        }
    }

    /// How many codes there can be.
    pub fn count(self) -> usize {
        1 << self.bits()
    }

    /// The codes as they lie in memory.
    pub fn as_bytes(self) -> &'a [u8] {
        match self {
            Self::Bytes(codes) => codes,
            Self::Words(codes) => bytemuck::cast_slice(codes),
        }
    }

    /// Of each voxel what stands for its code in `table`.
    ///
    /// # Panics
    /// Where the table is shorter than there are codes.
    pub fn look_up<T: Copy>(self, table: &[T]) -> Vec<T> {
        let table = &table[..self.count()];
        match self {
            Self::Bytes(codes) => codes.iter().map(|&c| table[usize::from(c)]).collect(),
            Self::Words(codes) => codes.iter().map(|&c| table[usize::from(c)]).collect(),
        }
    }
}

impl VoxelType {
    /// The stored number that has a code.
    ///
    /// # Panics
    /// For numbers of 32 bits and more.
    pub(crate) fn number_of(self, code: u16) -> f32 {
        let low = code as u8;
        match self {
            Self::U8 => low.into(),
            Self::I8 => (low as i8).into(),
            Self::U16 => code.into(),
            Self::I16 => (code as i16).into(),
            Self::F16 => f16::from_bits(code).to_f32(),
            Self::U32 | Self::I32 | Self::U64 | Self::I64 | Self::F32 | Self::F64 => {
                panic!("numbers of 32 bits and more have no codes")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_stored_number_is_the_number_of_its_code() {
        let all = 0..=u16::MAX;
        let bytes = 0..=u8::MAX;
        for voxels in [
            Voxels::U8(bytes.clone().collect()),
            Voxels::I8(bytes.map(|b| b as i8).collect()),
            Voxels::U16(all.clone().collect()),
            Voxels::I16(all.clone().map(|w| w as i16).collect()),
            Voxels::F16(all.map(f16::from_bits).collect()),
        ] {
            let codes = voxels.codes().expect("8 or 16 bits");
            let numbers = (0..codes.count()).map(|c| voxels.voxel_type().number_of(c as u16));
            let numbers: Vec<u32> = numbers.map(f32::to_bits).collect();
            let found: Vec<u32> = codes.look_up(&numbers);
            let stored = (0..voxels.len()).map(|i| voxels.stored(i).to_bits());
            assert_eq!(
                found,
                stored.collect::<Vec<_>>(),
                "{:?}",
                voxels.voxel_type()
            );
        }
        assert_eq!(Voxels::F32(vec![1.0]).codes(), None);
    }
}
