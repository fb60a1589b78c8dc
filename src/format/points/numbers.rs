//! Numbers of any type as f64.

use crate::format::convert::Endian;
use crate::format::file_source::FileSource;
use crate::volume::{ReadError, Source, TimeComponent, VoxelType};
use half::f16;

/// One number; NaN where there are too few bytes. Whole numbers over 2^53 are rounded.
pub(super) fn decoded(bytes: &[u8], stored: VoxelType, endian: Endian) -> f64 {
    let mut all = [0_u8; 8];
    let Some(bytes) = bytes.get(..stored.bytes()) else {
        return f64::NAN;
    };
    for (to, from) in all.iter_mut().zip(bytes) {
        *to = *from;
    }
    if endian == Endian::Big
        && let Some(number) = all.get_mut(..stored.bytes())
    {
        number.reverse();
    }
    let [a, b, c, d, ..] = all;
    match stored {
        VoxelType::U8 => a.into(),
        VoxelType::I8 => i8::from_le_bytes([a]).into(),
        VoxelType::U16 => u16::from_le_bytes([a, b]).into(),
        VoxelType::I16 => i16::from_le_bytes([a, b]).into(),
        VoxelType::U32 => u32::from_le_bytes([a, b, c, d]).into(),
        VoxelType::I32 => i32::from_le_bytes([a, b, c, d]).into(),
        #[allow(clippy::cast_precision_loss, reason = "said above")]
        VoxelType::U64 => u64::from_le_bytes(all) as f64,
        #[allow(clippy::cast_precision_loss, reason = "said above")]
        VoxelType::I64 => i64::from_le_bytes(all) as f64,
        VoxelType::F16 => f16::from_le_bytes([a, b]).into(),
        VoxelType::F32 => f32::from_le_bytes([a, b, c, d]).into(),
        VoxelType::F64 => f64::from_le_bytes(all),
    }
}

/// All numbers of one component, not rounded as voxels are.
pub(super) fn component(source: &FileSource, component: u32) -> Result<Vec<f64>, ReadError> {
    let header = source.header();
    let pick = TimeComponent { time: 0, component };
    let bytes = source.read_bytes(pick, header.whole())?.unwrap_or_default();
    let each = bytes.chunks_exact(header.stored.bytes());
    Ok(each
        .map(|number| decoded(number, header.stored, Endian::Little))
        .collect())
}
