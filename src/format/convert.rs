//! Bytes of a file to [`Voxels`]: byte order, and rounding to f32 where a type has no room in memory.

use crate::volume::{Piece, PrecisionLoss, Problem, VoxelType, Voxels};
use half::f16;

/// The order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Endian {
    Little,
    Big,
}

impl Endian {
    /// That of numbers in memory.
    #[cfg(feature = "netcdf")]
    pub(crate) const NATIVE: Self = if cfg!(target_endian = "big") {
        Self::Big
    } else {
        Self::Little
    };
}

/// Voxels that grow as bytes come in. Memory follows the bytes that came, not what a header promised.
pub(crate) struct Builder {
    stored: VoxelType,
    endian: Endian,
    wanted: usize,
    voxels: Voxels,
    loss: PrecisionLoss,
}

/// Bytes of one number in memory.
pub(crate) fn bytes_in_memory(stored: VoxelType) -> usize {
    stored.bytes().min(4)
}

impl Builder {
    /// For `wanted` numbers of the type `stored`.
    pub(crate) fn new(stored: VoxelType, endian: Endian, wanted: usize) -> Self {
        let voxels = match stored {
            VoxelType::U8 => Voxels::U8(Vec::new()),
            VoxelType::I8 => Voxels::I8(Vec::new()),
            VoxelType::U16 => Voxels::U16(Vec::new()),
            VoxelType::I16 => Voxels::I16(Vec::new()),
            VoxelType::F16 => Voxels::F16(Vec::new()),
            VoxelType::U32
            | VoxelType::I32
            | VoxelType::U64
            | VoxelType::I64
            | VoxelType::F32
            | VoxelType::F64 => Voxels::F32(Vec::new()),
        };
        Self {
            stored,
            endian,
            wanted,
            voxels,
            loss: PrecisionLoss::default(),
        }
    }

    /// Makes room for `count` numbers more, at most for all that are wanted.
    pub(crate) fn reserve(&mut self, count: usize) -> Result<(), Problem> {
        let left = self.wanted.saturating_sub(self.voxels.len());
        let count = count.min(left);
        match &mut self.voxels {
            Voxels::U8(v) => v.try_reserve_exact(count),
            Voxels::I8(v) => v.try_reserve_exact(count),
            Voxels::U16(v) => v.try_reserve_exact(count),
            Voxels::I16(v) => v.try_reserve_exact(count),
            Voxels::F16(v) => v.try_reserve_exact(count),
            Voxels::F32(v) => v.try_reserve_exact(count),
        }
        .map_err(|_| Problem::Limit {
            what: "the voxels".to_owned(),
            wanted_bytes: to_u64(self.wanted).saturating_mul(to_u64(bytes_in_memory(self.stored))),
            limit_bytes: to_u64(self.voxels.len())
                .saturating_mul(to_u64(bytes_in_memory(self.stored))),
        })
    }

    /// Appends every `stride`th number of `bytes`, beginning with the first. `stride` is at least 1.
    pub(crate) fn push(&mut self, bytes: &[u8], stride: usize) -> Result<(), Problem> {
        let step = stride.saturating_mul(self.stored.bytes()).max(1);
        let count = bytes.len().div_ceil(step);
        if self.voxels.len().saturating_add(count) > self.capacity() {
            // Doubling keeps the number of copies small, and the limit keeps it exact at the end.
            self.reserve(count.max(self.voxels.len()))?;
        }
        let big = self.endian == Endian::Big;
        let loss = &mut self.loss;
        // One arm a type: the compiler makes each a tight loop.
        macro_rules! append {
            ($out:expr, $number:ty, $keep:expr) => {{
                const BYTES: usize = size_of::<$number>();
                let read = |bytes: &[u8; BYTES]| {
                    if big {
                        <$number>::from_be_bytes(*bytes)
                    } else {
                        <$number>::from_le_bytes(*bytes)
                    }
                };
                if stride == 1 {
                    $out.extend(bytes.as_chunks::<BYTES>().0.iter().map(read).map($keep));
                } else {
                    $out.extend(
                        bytes
                            .chunks(step)
                            .filter_map(|chunk| chunk.first_chunk::<BYTES>())
                            .map(read)
                            .map($keep),
                    );
                }
            }};
        }
        match (&mut self.voxels, self.stored) {
            (Voxels::U8(out), _) => append!(out, u8, |x| x),
            (Voxels::I8(out), _) => append!(out, i8, |x| x),
            (Voxels::U16(out), _) => append!(out, u16, |x| x),
            (Voxels::I16(out), _) => append!(out, i16, |x| x),
            (Voxels::F16(out), _) => append!(out, f16, |x| x),
            (Voxels::F32(out), VoxelType::U32) => {
                append!(out, u32, |x: u32| round_float(x.into(), loss))
            }
            (Voxels::F32(out), VoxelType::I32) => {
                append!(out, i32, |x: i32| round_float(x.into(), loss))
            }
            (Voxels::F32(out), VoxelType::U64) => append!(out, u64, |x: u64| round(x.into(), loss)),
            (Voxels::F32(out), VoxelType::I64) => append!(out, i64, |x: i64| round(x.into(), loss)),
            (Voxels::F32(out), VoxelType::F64) => append!(out, f64, |x| round_float(x, loss)),
            (Voxels::F32(out), _) => append!(out, f32, |x| x),
        }
        Ok(())
    }

    /// How many numbers there are.
    pub(crate) fn len(&self) -> usize {
        self.voxels.len()
    }

    pub(crate) fn finish(self) -> Piece {
        Piece {
            voxels: self.voxels,
            loss: self.loss,
        }
    }

    fn capacity(&self) -> usize {
        match &self.voxels {
            Voxels::U8(v) => v.capacity(),
            Voxels::I8(v) => v.capacity(),
            Voxels::U16(v) => v.capacity(),
            Voxels::I16(v) => v.capacity(),
            Voxels::F16(v) => v.capacity(),
            Voxels::F32(v) => v.capacity(),
        }
    }
}

/// The nearest f32. Every 64-bit integer fits an i128, so the distance is exact.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "rounding is what this is for; an f32 of at most 2^64 fits an i128"
)]
pub(crate) fn round(x: i128, loss: &mut PrecisionLoss) -> f32 {
    let kept = x as f32;
    let distance = (kept as i128).saturating_sub(x).unsigned_abs();
    if distance != 0 {
        loss.changed = loss.changed.saturating_add(1);
        loss.worst = loss.worst.max(distance as f64);
    }
    kept
}

/// The nearest f32; 32-bit integers come this way too, an f64 holds each of them exactly.
#[allow(
    clippy::cast_possible_truncation,
    reason = "rounding is what this is for"
)]
pub(crate) fn round_float(x: f64, loss: &mut PrecisionLoss) -> f32 {
    let kept = x as f32;
    let back = f64::from(kept);
    // An infinity is equal to itself and a NaN stays one: neither is a change.
    if back != x && !x.is_nan() {
        loss.changed = loss.changed.saturating_add(1);
        loss.worst = loss.worst.max((back - x).abs());
    }
    kept
}

/// One number; NaN where there are too few bytes. Whole numbers over 2^53 are rounded.
pub(crate) fn decoded(bytes: &[u8], stored: VoxelType, endian: Endian) -> f64 {
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

/// No machine has a usize beyond 64 bits.
pub(crate) fn to_u64(n: usize) -> u64 {
    u64::try_from(n).unwrap_or(u64::MAX)
}

/// Numbers in memory, as voxels of the type `stored`.
#[cfg(feature = "netcdf")]
pub(crate) fn piece_of<T: bytemuck::NoUninit>(
    numbers: &[T],
    stored: VoxelType,
) -> Result<Piece, Problem> {
    let mut builder = Builder::new(stored, Endian::NATIVE, numbers.len());
    builder.push(bytemuck::cast_slice(numbers), 1)?;
    Ok(builder.finish())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn converted(stored: VoxelType, endian: Endian, bytes: &[u8], stride: usize) -> Piece {
        let mut builder = Builder::new(stored, endian, bytes.len());
        builder.push(bytes, stride).unwrap();
        builder.finish()
    }

    #[test]
    fn each_number_that_rounding_changes_is_counted_and_the_worst_distance_kept() {
        let numbers = [0_u32, 16_777_216, 16_777_217, u32::MAX];
        let bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_be_bytes()).collect();
        let piece = converted(VoxelType::U32, Endian::Big, &bytes, 1);
        assert_eq!(
            piece.voxels,
            Voxels::F32(vec![0.0, 16_777_216.0, 16_777_216.0, 4_294_967_296.0])
        );
        assert_eq!(
            piece.loss,
            PrecisionLoss {
                changed: 2,
                worst: 1.0
            }
        );

        let numbers = [f64::NAN, f64::INFINITY, 0.5, 0.1, 1e300];
        let bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        let loss = converted(VoxelType::F64, Endian::Little, &bytes, 1).loss;
        assert_eq!(loss.changed, 2, "0.1 and 1e300");
        assert_eq!(loss.worst, f64::INFINITY);

        let bytes = (u64::MAX - 1).to_le_bytes();
        let loss = converted(VoxelType::U64, Endian::Little, &bytes, 1).loss;
        assert_eq!(
            loss,
            PrecisionLoss {
                changed: 1,
                worst: 2.0
            }
        );
    }

    #[test]
    fn a_stride_takes_every_nth_number_in_either_byte_order() {
        let bytes = [1, 2, 0, 0, 3, 4, 0, 0, 5, 6];
        let little = converted(VoxelType::U16, Endian::Little, &bytes, 2).voxels;
        assert_eq!(little, Voxels::U16(vec![0x0201, 0x0403, 0x0605]));
        let big = converted(VoxelType::I16, Endian::Big, &bytes, 2).voxels;
        assert_eq!(big, Voxels::I16(vec![0x0102, 0x0304, 0x0506]));
    }
}
